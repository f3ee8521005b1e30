//! The cycle that is recorded, step by step.

use std::f64::consts::PI;

use gudgeon_core::EvalError;
use gudgeon_core::result::{Column, Series};
use gudgeon_numerics::ode::{Flow, StepView};
use gudgeon_numerics::panel::Rule;

use super::{Follower, Pack, Wanted};
use crate::gas_ledger::GasLedger;
use crate::measure::{Measures, Peak};
use crate::rows::Rows;
use crate::watch::Watch;

/// Follows the recorded cycle step by step: measures it, closes its balances, and keeps the rows of its series.
pub(super) struct Sampler {
    pub rows: Rows,
    pub measures: Measures,
    y: Vec<f64>,
    q: Vec<f64>,
    pub failure: Option<EvalError>,
    impulse: Vec<[f64; 2]>,
    work: Vec<[f64; 2]>,
    start: Vec<(f64, f64)>,
    end: Vec<(f64, f64)>,
    /// Crank angles \[deg\] and the film on the liner there.
    pub liner: Vec<(u32, Vec<f64>)>,
    pub watch: Watch,
    pub gas_ledger: GasLedger,
}

impl Sampler {
    pub fn new(pack: &mut Pack, wanted: &Wanted<'_>, rule: Rule) -> Self {
        let n = pack.n_rings();
        let mut measures = Measures::new(pack, rule, wanted.seat);
        let (theta, value) = pack.cylinder.highest();
        measures.cylinder = Peak { theta, value };
        Self {
            rows: Rows::new(pack, wanted.series_step),
            measures,
            y: vec![0.0; pack.layout.n],
            q: vec![0.0; pack.layout.quads()],
            failure: None,
            impulse: vec![[0.0; 2]; n],
            work: vec![[0.0; 2]; n],
            start: vec![(0.0, 0.0); n],
            end: vec![(0.0, 0.0); n],
            liner: Vec::new(),
            watch: Watch::new(pack),
            gas_ledger: GasLedger::default(),
        }
    }

    /// Samples the dense output of a step; at its ends and in its middle all forces, for Simpson's rule on impulse and work and on what limits did.
    fn measure(&mut self, pack: &mut Pack, v: &dyn StepView) -> Result<(), EvalError> {
        let (t0, t1) = (v.t0(), v.t1());
        let last = self.measures.nodes().len() - 1;
        let half = last / 2;
        for (k, x) in self.measures.nodes().iter().enumerate() {
            let t = if k == last { t1 } else { t0 + x * (t1 - t0) };
            v.interpolate(t, &mut self.y);
            v.interpolate_quad(t, &mut self.q);
            if (pack.plan.axial || pack.plan.film) && k.is_multiple_of(half) {
                if !pack.is_at(t, &self.y) {
                    pack.evaluate_in_step(t, &self.y)?;
                }
                let weight = if k == half { 4.0 } else { 1.0 };
                self.close(pack, weight * (t1 - t0) / pack.omega / 6.0);
                self.watch.look(pack, weight * (t1 - t0) / 6.0);
            } else {
                pack.look(t, &self.y)?;
            }
            self.measures.sample(k, pack, pack.layout.passed(&self.q));
            self.gas_ledger.sample(&*pack.gas);
        }
        self.measures.step(pack, t0, t1);
        for (i, e) in self.end.iter_mut().enumerate() {
            *e = momentum(pack, i);
        }
        Ok(())
    }

    /// Adds the forces of the instant over `dt` \[s\] to impulse and work.
    fn close(&mut self, pack: &Pack, dt: f64) {
        for i in 0..pack.n_rings() {
            if pack.layout.motion[i].is_empty() {
                continue;
            }
            let (r, velocity) = (&pack.at.rings[i], pack.at.places[i].v);
            let a = &r.axial;
            let parts = [a.gas, a.inertia, a.gravity, a.film, a.damping, r.reaction, a.expander];
            let sum: f64 = parts.iter().sum();
            let magnitude: f64 = parts.iter().map(|p| p.abs()).sum();
            self.impulse[i][0] += dt * sum;
            self.impulse[i][1] += dt * magnitude;
            self.work[i][0] += dt * sum * velocity;
            self.work[i][1] += dt * parts.iter().map(|p| (p * velocity).abs()).sum::<f64>();
        }
    }

    pub fn balance(&self, pack: &Pack) -> (Option<f64>, Option<f64>) {
        if pack.layout.motion.iter().all(|m| m.is_empty()) {
            return (None, None);
        }
        let worst = |sums: &[[f64; 2]], change: &dyn Fn(usize) -> f64| {
            sums.iter()
                .enumerate()
                .filter(|(_, s)| s[1] > 0.0)
                .map(|(i, s)| ((s[0] - change(i)) / s[1]).abs())
                .fold(0.0, f64::max)
        };
        let momentum = worst(&self.impulse, &|i| self.end[i].0 - self.start[i].0);
        let energy = worst(&self.work, &|i| self.end[i].1 - self.start[i].1);
        (Some(energy), Some(momentum))
    }
}

impl Follower for Sampler {
    fn begin(&mut self, pack: &mut Pack, theta: f64, y: &[f64]) -> Result<(), EvalError> {
        pack.evaluate(theta, y)?;
        self.rows.start(pack, y);
        self.gas_ledger.sample(&*pack.gas);
        for (i, s) in self.start.iter_mut().enumerate() {
            *s = momentum(pack, i);
        }
        Ok(())
    }

    fn step(&mut self, pack: &mut Pack, v: &dyn StepView) -> Flow {
        self.rows.step(pack, v);
        match self.measure(pack, v) {
            Ok(()) => Flow::Continue,
            Err(e) => {
                self.failure = Some(e);
                Flow::Stop
            }
        }
    }

    /// Keeps the film on the liner at every dead centre.
    fn booked(&mut self, pack: &Pack, theta: f64) {
        let turns = theta / PI;
        if let Some(oil) = &pack.oil_pack
            && (turns - turns.round()).abs() < 1e-9
        {
            self.liner.push((turns.round() as u32 * 180, oil.liner().1));
        }
    }
}

/// The film on the liner at the dead centres over the height above the lowest place of the pin.
pub(super) fn liner_table(pack: &Pack, films: Vec<(u32, Vec<f64>)>) -> Option<Series> {
    let oil = pack.oil_pack.as_ref()?;
    let lowest = pack.y_tdc - pack.kinematics.stroke();
    let z = oil.liner().0.into_iter().map(|z| z - lowest).collect();
    let column = |name: String, unit: &str, values| Column { name, unit: unit.into(), values };
    Some(Series {
        axis: column("height".into(), "m", z),
        columns: films.into_iter().map(|(deg, f)| column(format!("film_at_{deg}"), "m", f)).collect(),
    })
}

/// Momentum and kinetic energy of ring `i` relative to the piston.
fn momentum(pack: &Pack, i: usize) -> (f64, f64) {
    let (m, v) = (pack.geo.rings[i].mass, pack.at.places[i].v);
    (m * v, 0.5 * m * v * v)
}
