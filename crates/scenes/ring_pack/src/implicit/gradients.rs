//! Derivatives of the results of a cycle by inputs, through the periodic orbit.
//!
//! The periodic state `y0(p)` is the fixed point of the map of a cycle, `Φ(y0, p) = y0`. With `M = ∂Φ/∂y0`
//!
//! ```text
//! dy0/dp = (I - M)⁻¹ ∂Φ/∂p,      S(θ) = ∂y/∂y0 dy0/dp + ∂y/∂p,      R' = (R(y + ε S, p + ε) - R(y, p))/ε
//! ```
//!
//! One cycle at a tight tolerance carries `∂y/∂y0` and `∂y/∂p` along its steps ([`variation`]). The first order of what is left to the orbit,
//! `(I - M)⁻¹ (Φ(y0) - y0)`, is added to the trajectory; where it is large the cycle is followed once more from there. Results are then measured on
//! the trajectories `y` and `y + ε S` by the code that measures every cycle ([`measured`]), whatever they are made of: integrals, extremes, areas
//! of the geometry. No model knows of any of it: what an input changes is told by a second pack, built from the case with that input a little higher.

mod measured;
mod variation;

use gudgeon_core::quantity::quantity;
use gudgeon_core::result::{Gradients, Note};
use gudgeon_numerics::linalg::{lu_factor, lu_solve_rows};
use gudgeon_numerics::{EvalError, Stopped};
use gudgeon_scene::{GradientError, RunError};
use indexmap::IndexMap;

use super::approach::approach;
use super::search::{self, not_periodic};
use super::{Cycle, Implicit, Pack, RingIntegrator, Wanted, orbit_options, stopped};
use crate::around::{Around, Varied};
use variation::Variation;

/// Tolerance of the cycle along which derivatives are followed, where the case does not ask for a tighter one.
const TOLERANCE: f64 = 4e-7;
/// A distance from the orbit beyond which the cycle is followed once more from where the orbit is thought to be, in the scales of the cycle.
const NEAR: f64 = 1e-3;
/// Most cycles that are followed.
const MOST: usize = 4;
/// A distance from the orbit above which the derivatives are told with a caution.
const FAR: f64 = 1e-2;

pub(super) fn gradients(
    s: &Implicit,
    pack: &mut Pack,
    start: f64,
    wanted: &Wanted<'_>,
    around: Around<'_>,
    progress: &mut dyn FnMut(f64) -> Result<(), Stopped>,
) -> Result<Gradients, GradientError> {
    fits(pack, around.varied)?;
    let options = orbit_options(s, pack);
    let begun = approach(s, pack, start, wanted, &mut |done| progress(0.5 * done))?;
    let led = begun.led();
    let mut searching = |done: f64| progress(0.5 * (led + (1.0 - led) * done));
    let mut cycle = Cycle::new(s, pack, wanted, &mut searching);
    let mut y = cycle.begin_at(begun);
    let report = cycle.close(&mut y, &options)?;
    if report.period != 1 {
        let what = format!("the cycle repeats only every {} cycles", report.period);
        return Err(GradientError::NoMethod(what));
    }
    let mut counters = search::counters(&cycle.stats);
    counters.insert("cycles".into(), report.cycles as u64);
    let tolerance = s.tolerance.si().min(TOLERANCE);
    let tight = Implicit { tolerance: quantity(tolerance), integrator: RingIntegrator::Rodas5p, ..s.clone() };
    let mut notes = Vec::new();
    if !report.converged {
        notes.push(not_periodic(report.error_estimate, options.tolerance, report.cycles));
    }
    pack.follow_passages(true);
    around.varied.iter_mut().for_each(|v| v.pack.follow_passages(true));
    let mut following = |done: f64| progress(0.5 + 0.5 * done);
    for k in 1.. {
        let mut cycle = Cycle::new(&tight, pack, wanted, &mut following);
        let mut followed = Variation::new(&cycle, around.varied, tolerance);
        let end = cycle.follow(&y, tolerance, &mut followed)?;
        let orbit = Orbit::of(&y, &end, &followed).map_err(|source| RunError::Model { source })?;
        let away = distance(cycle.pack, &orbit.away);
        count(&mut counters, &cycle, &followed, k);
        if away <= NEAR || k == MOST {
            if away > FAR {
                notes.push(far(away));
            }
            let trail = followed.trail();
            let results =
                measured::results(cycle.pack, wanted, &around.meter, around.varied, &trail, &orbit)?;
            return Ok(Gradients { method: METHOD.into(), inputs: Vec::new(), results, counters, notes });
        }
        y.iter_mut().zip(&orbit.away).for_each(|(y, d)| *y += d);
    }
    unreachable!("the last cycle returns")
}

/// How these derivatives are found, for people.
const METHOD: &str = "variational equations along the cycle, implicit function at the periodic orbit";

fn far(away: f64) -> Note {
    let text = format!(
        "the derivatives were followed along a cycle that is {away:.1e} from the periodic one, in the scales of its states; tighten `solver.periodicity`"
    );
    Note::caution("gradients_off_the_orbit", text).amount("distance", away, "1")
}

/// Whether derivatives can be followed along a cycle of this pack, and the others have its states.
fn fits(pack: &Pack, varied: &[Varied]) -> Result<(), GradientError> {
    let none = |why: &str| Err(GradientError::NoMethod(why.into()));
    if pack.decision_interval().is_some() {
        return none("the axial motion is decided in steps, on which nothing depends continuously");
    }
    if pack.oil_pack.is_some() {
        return none("oil is followed on the liner, in cells that it fills one after the other");
    }
    let same =
        |p: &Pack| p.layout.n == pack.layout.n && p.cylinder.kinks().len() == pack.cylinder.kinks().len();
    if varied.iter().any(|v| !same(&v.pack)) {
        return none("an input changes which states there are or how many kinks the cylinder pressure has");
    }
    Ok(())
}

/// Largest component of `d` in the scales in which cycles are compared.
fn distance(pack: &Pack, d: &[f64]) -> f64 {
    d.iter().zip(&pack.layout.states).map(|(d, s)| (d / s.cycle_scale).abs()).fold(0.0, f64::max)
}

/// Adds the work of a followed cycle.
fn count(counters: &mut IndexMap<String, u64>, cycle: &Cycle<'_>, followed: &Variation<'_>, k: usize) {
    for (name, n) in search::counters(&cycle.stats) {
        *counters.entry(name).or_insert(0) += n;
    }
    let own = [("rhs", followed.work.instants), ("jacobians", followed.work.jacobians)];
    for (name, n) in own {
        *counters.entry(name.to_owned()).or_insert(0) += n;
    }
    *counters.entry("instants_beside".into()).or_insert(0) += followed.work.beside;
    counters.insert("cycles_followed".into(), k as u64);
}

/// The periodic orbit beside a followed cycle.
struct Orbit {
    /// The distance of its start from that of the cycle.
    away: Vec<f64>,
    /// Derivatives of its start by the inputs, a row for each state.
    slopes: Vec<f64>,
}

impl Orbit {
    /// From the cycle that led from `y` to `end`: one factorisation of `I - M`.
    fn of(y: &[f64], end: &[f64], followed: &Variation<'_>) -> Result<Self, EvalError> {
        let (n, columns, ends) = (y.len(), followed.columns, &followed.ends);
        let m = columns - n;
        let mut matrix: Vec<f64> = (0..n * n).map(|k| -ends[k / n * columns + k % n]).collect();
        let mut b = vec![0.0; n * (m + 1)];
        for r in 0..n {
            matrix[r * n + r] += 1.0;
            b[r * (m + 1)..][..m].copy_from_slice(&ends[r * columns + n..][..m]);
            b[r * (m + 1) + m] = end[r] - y[r];
        }
        let mut pivots = vec![0; n];
        lu_factor(&mut matrix, n, &mut pivots).map_err(|e| {
            EvalError::fatal(
                "ring_pack",
                format!("the periodic state is not isolated, it has no derivatives ({e})"),
            )
        })?;
        lu_solve_rows(&matrix, n, &pivots, &mut b, m + 1);
        let rows = b.chunks_exact(m + 1);
        let away = rows.clone().map(|row| row[m]).collect();
        Ok(Self { away, slopes: rows.flat_map(|row| &row[..m]).copied().collect() })
    }
}

impl Cycle<'_> {
    /// One cycle from `y` with its derivatives; its end.
    fn follow(&mut self, y: &[f64], tolerance: f64, v: &mut Variation<'_>) -> Result<Vec<f64>, RunError> {
        let mut end = y.to_vec();
        self.integrate(&mut end, tolerance, Some(v)).map_err(stopped)?;
        let period = self.pack.period();
        let at = |theta: f64| move |source| RunError::Eval { theta_deg: theta.to_degrees(), source };
        if let Some(source) = v.failure.take() {
            return Err(at(self.pack.at.theta)(source));
        }
        self.pack.start_modes(period, &mut end).map_err(at(period))?;
        v.end(self.pack);
        Ok(end)
    }
}
