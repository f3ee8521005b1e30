//! Results of a followed cycle and of the cycles beside it, which its derivatives tell.

use gudgeon_core::EvalError;
use gudgeon_core::result::{Gradient, Value};
use gudgeon_numerics::linalg::dot;
use gudgeon_numerics::panel::LOBATTO;
use gudgeon_scene::RunError;
use indexmap::IndexMap;

use super::super::{Pack, Wanted};
use super::Orbit;
use super::variation::Trail;
use crate::around::Varied;
use crate::measure::{Measures, Peak};
use crate::record::Totals;
use crate::results::{self, Meter};

/// Results at the orbit, and their derivatives.
pub fn results(
    pack: &mut Pack,
    wanted: &Wanted<'_>,
    meter: &Meter,
    varied: &mut [Varied],
    trail: &Trail,
    orbit: &Orbit,
) -> Result<IndexMap<String, Gradient>, RunError> {
    let mut shift = Shift { trail, orbit, input: None };
    let own = shift.measure(pack, wanted, *meter)?;
    let of_the_case = own.into_iter().filter(|(name, _)| name != SEARCH);
    let mut out: IndexMap<String, Gradient> = of_the_case.map(|(k, v)| (k, Gradient::new(v))).collect();
    for (k, v) in varied.iter_mut().enumerate() {
        shift.input = Some((k, v.step));
        let there = shift.measure(&mut v.pack, wanted, v.meter)?;
        for (name, g) in &mut out {
            let defined = is_continuous(&g.value);
            g.by.push(there.get(name).filter(|_| defined).map(|r| (r.value - g.value.value) / v.step));
        }
    }
    Ok(out)
}

/// A result that tells of the search of the orbit and nothing of the case.
const SEARCH: &str = "periodicity_error";

/// Places of extremes are as smooth as the slope of an interpolation: they have no derivative that could be relied on.
fn is_continuous(value: &Value) -> bool {
    value.unit != "deg"
}

/// The orbit, or one beside it.
struct Shift<'a> {
    trail: &'a Trail,
    orbit: &'a Orbit,
    /// The input that is higher, and by how much.
    input: Option<(usize, f64)>,
}

impl Shift<'_> {
    /// What is added to the start of the followed cycle.
    fn weights(&self) -> Vec<f64> {
        let m = self.trail.columns - self.trail.n;
        let mut weights = self.orbit.away.clone();
        if let Some((k, step)) = self.input {
            for (r, w) in weights.iter_mut().enumerate() {
                *w += step * self.orbit.slopes[r * m + k];
            }
        }
        weights
    }

    /// The results of `pack` on this orbit.
    fn measure(
        &self,
        pack: &mut Pack,
        wanted: &Wanted<'_>,
        meter: Meter,
    ) -> Result<IndexMap<String, Value>, RunError> {
        let trail = self.trail;
        let (nodes, weights) = (LOBATTO.nodes.len(), self.weights());
        let (column, step) = self.input.map_or((0, 0.0), |(k, step)| (trail.n + k, step));
        let mut measures = Measures::new(pack, LOBATTO, wanted.seat);
        let (theta, value) = pack.cylinder.highest();
        measures.cylinder = Peak { theta, value };
        let shift = |x: &mut [f64], state: &[f64], slopes: &[f64]| {
            for ((x, s), row) in x.iter_mut().zip(state).zip(slopes.chunks_exact(trail.columns)) {
                *x = s + dot(&row[..trail.n], &weights) + step * row[column];
            }
        };
        // The states and the quadrature that is looked at on the way; of the others only the end counts.
        let mut x = vec![0.0; trail.n + 1];
        let states = trail.states.chunks_exact(trail.rows);
        let mut points = states.zip(trail.slopes.chunks_exact(trail.rows * trail.columns));
        for (t0, t1) in &trail.steps {
            for (k, node) in LOBATTO.nodes.iter().enumerate() {
                let Some((state, slopes)) = points.next() else { break };
                shift(&mut x, state, slopes);
                let theta = if k + 1 == nodes { *t1 } else { t0 + node * (t1 - t0) };
                let (y, q) = x.split_at(trail.n);
                let at = |source: EvalError| RunError::Eval { theta_deg: theta.to_degrees(), source };
                pack.look(theta, y).map_err(at)?;
                measures.sample(k, pack, q.iter().copied());
            }
            measures.step(pack, *t0, *t1);
        }
        let last = trail.states.len().saturating_sub(trail.rows);
        let mut end = vec![0.0; trail.rows];
        shift(&mut end, &trail.states[last..], &trail.slopes[last * trail.columns..]);
        let q = &end[trail.n..];
        let totals = Totals::of_cycle(pack, q);
        Ok(results::Cycle { totals, measures }.results(pack, meter))
    }
}
