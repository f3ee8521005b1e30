//! Newton's method on the torques of all orders at once.

use std::f64::consts::PI;

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{LinearCoupling, Torsion, TorsionOut};
use gudgeon_numerics::gmres::Gmres;
use gudgeon_numerics::linalg::Complex;

use super::nonlinear::NonlinearTorques;
use super::solved_speeds::SolvedSpeeds;
use crate::receptance::Receptance;
use crate::steady::Steady;

/// Vectors that a linear solution may use.
const VECTORS: usize = 200;
/// Rounds in which Newton's method must halve what is left: where it does not, it circles.
const STALLED: usize = 20;
/// Growth of the remainder by which a step is not taken, and how often it is halved then.
const GROWTH: f64 = 1.5;
const HALVINGS: usize = 8;
/// First fraction of the torques beyond the linear line when all at once is too much, and the minimum by which it is raised.
const FIRST: f64 = 0.25;
const MINIMUM: f64 = 1.0 / 1024.0;

#[derive(Debug)]
pub(super) struct Solver {
    pub(super) tolerance: f64,
    pub(super) rounds: usize,
    pub(super) base: f64,
    pub(super) nonlinear: NonlinearTorques,
    pub(super) receptance: Receptance,
    pub(super) gmres: Gmres,
    /// Torques on the active nodes that the linear line does not have, by node and order with the mean.
    pub(super) x: Vec<Complex>,
    /// Angles of the active nodes in the same order.
    pub(super) angle: Vec<Complex>,
    /// Change of mean angles by mean torques on the active nodes, a row for each angle; of the mean torques of the links in the same way.
    pub(super) angle_by_torque: Vec<f64>,
    pub(super) link_by_torque: Vec<f64>,
    /// Laws of the links as the linear line has them, at its mean torques: the tree keeps these.
    pub(super) tangents: Vec<LinearCoupling>,
    pub(super) solved_speeds: SolvedSpeeds,
    /// Fraction of the torques beyond the linear line that is asked for.
    pub(super) fraction: f64,
    pub(super) steady: Steady,
}

impl Torsion for Solver {
    fn run(&mut self, out: &mut TorsionOut) -> Result<(), EvalError> {
        self.linearise_links();
        self.receptance.factor(&mut self.steady, self.base, self.nonlinear.harmonics);
        let speed = self.steady.speed;
        self.solved_speeds.extrapolate(speed, &mut self.x);
        let mut cost = Cost::default();
        let mut found = self.iterate(&mut cost);
        if found.is_err() && !self.solved_speeds.is_empty() {
            // The motion of another speed may be a bad start.
            self.x.fill(Complex::default());
            found = self.iterate(&mut cost);
        }
        if let Err(e) = found {
            self.continuation(&mut cost, e)?;
        }
        self.solved_speeds.keep(speed, &self.x);
        let rest = self.nonlinear.link_torques_beside_tangents();
        let mut orders = self.responses()?;
        self.add_nonlinear_torques(&mut orders, &rest);
        out.orders = orders.as_slice().into();
        out.counters.insert("time_steps".into(), 0);
        out.counters.insert("rounds".into(), cost.rounds);
        out.counters.insert("linear_solutions".into(), cost.solutions);
        self.steady.describe(out);
        Ok(())
    }
    fn set_speed(&mut self, speed: f64) -> Result<(), EvalError> {
        self.steady.set_speed(speed);
        Ok(())
    }
}

/// What a run has cost.
#[derive(Debug, Default)]
pub(super) struct Cost {
    pub rounds: u64,
    /// Orders solved.
    pub solutions: u64,
}

impl Solver {
    /// Of a line with the first order `base`, whose motion repeats after `period` \[rad\] and whose torques without those of the moving
    /// masses are in `steady`.
    pub fn new(steady: Steady, [tolerance, base, period]: [f64; 3], harmonics: usize, rounds: usize) -> Self {
        let nonlinear = NonlinearTorques::new(&steady.line, period, harmonics);
        let unknowns = nonlinear.active.len() * nonlinear.orders();
        Self {
            tolerance,
            rounds,
            base,
            nonlinear,
            receptance: Receptance::default(),
            gmres: Gmres::default(),
            x: vec![Complex::default(); unknowns],
            angle: vec![Complex::default(); unknowns],
            angle_by_torque: Vec::new(),
            link_by_torque: Vec::new(),
            tangents: Vec::new(),
            solved_speeds: SolvedSpeeds::default(),
            fraction: 1.0,
            steady,
        }
    }

    /// Laws of the links about the mean torques of the linear line.
    fn linearise_links(&mut self) {
        self.tangents = (self.steady.line.links.iter().zip(&self.steady.mean_torque))
            .map(|(l, mean)| l.coupling.linear(0.0, *mean))
            .collect();
    }

    /// Raises the share of the torques beyond the linear line from nothing to the whole, each solution the start of the next.
    fn continuation(&mut self, cost: &mut Cost, failed: EvalError) -> Result<(), EvalError> {
        self.x.fill(Complex::default());
        let (mut reached, mut step) = (0.0, FIRST);
        while reached < 1.0 {
            let start = self.x.clone();
            self.fraction = (reached + step).min(1.0);
            let found = self.iterate(cost);
            let share = std::mem::replace(&mut self.fraction, 1.0);
            if found.is_ok() {
                (reached, step) = (share, 2.0 * step);
                continue;
            }
            self.x = start;
            step *= 0.5;
            if step < MINIMUM {
                return Err(failed);
            }
        }
        Ok(())
    }

    /// Newton's method from the torques as they stand.
    fn iterate(&mut self, cost: &mut Cost) -> Result<(), EvalError> {
        let base_mean = self.steady.excitation.mean.clone();
        let given = self.steady.excitation.orders.iter().flat_map(|o| &o.torque).map(|t| t.abs());
        let scale = given.chain(base_mean.iter().map(|m| m.abs())).fold(f64::MIN_POSITIVE, f64::max);
        let n = self.x.len();
        let mut g = vec![Complex::default(); n];
        let (mut rest, mut step) = (vec![0.0; 2 * n], vec![0.0; 2 * n]);
        let (mut last, mut halved) = (f64::INFINITY, 0);
        let mut change = f64::INFINITY;
        let mut before = f64::INFINITY;
        for round in 0..self.rounds {
            if round % STALLED == STALLED - 1 {
                if last > 0.5 * before {
                    break;
                }
                before = last;
            }
            cost.rounds += 1;
            cost.solutions += self.nonlinear.harmonics as u64;
            self.evaluate(&base_mean, &mut g)?;
            change = self.change(&g, scale);
            if change <= self.tolerance {
                return Ok(());
            }
            let grows = !change.is_finite() || change > GROWTH * last;
            if grows && halved < HALVINGS && last.is_finite() {
                // Back half of the step.
                halved += 1;
                self.add(&step, -0.5_f64.powi(halved as i32));
                continue;
            }
            if change > GROWTH * last {
                return Err(self.fails(change, cost.rounds));
            }
            if !change.is_finite() {
                return Err(EvalError::fatal("harmonic_balance", "the iteration leaves all bounds"));
            }
            (last, halved) = (change, 0);
            for (r, (g, x)) in rest.chunks_exact_mut(2).zip(g.iter().zip(&self.x)) {
                (r[0], r[1]) = (g.re - x.re, g.im - x.im);
            }
            self.linearise(&base_mean, scale);
            // A vector of the Krylov space costs less than another evaluation; what is beyond the square of the change is lost anyway.
            let forcing = (0.3 * self.tolerance / change).max((0.01 * change).min(0.01));
            self.newton_step(&rest, &mut step, forcing, cost);
            self.add(&step, 1.0);
        }
        Err(self.fails(change, cost.rounds))
    }

    /// Maximum difference between the torques `g` of a motion and those that made it, relative to the maximum torque.
    fn change(&self, g: &[Complex], scale: f64) -> f64 {
        let sizes = g.iter().map(|g| g.abs()).fold(0.0, larger);
        let misses = g.iter().zip(&self.x).map(|(g, x)| (*g - *x).abs()).fold(0.0, larger);
        misses / sizes.max(scale)
    }

    /// Adds a part of a step to the torques.
    fn add(&mut self, step: &[f64], part: f64) {
        for (x, d) in self.x.iter_mut().zip(step.chunks_exact(2)) {
            *x = *x + Complex::new(part * d[0], part * d[1]);
        }
    }

    fn fails(&self, change: f64, rounds: u64) -> EvalError {
        let what = format!(
            "no periodic motion at {:.6} rpm after {rounds} rounds: torques still change by {change:.1e} of the largest; a resonance is near, or the motion has a period of its own",
            self.steady.speed * 30.0 / PI
        );
        EvalError::fatal("harmonic_balance", what)
    }

    /// Solves `step - (change of the torques by step) = rest` to a part `forcing` of it.
    fn newton_step(&mut self, rest: &[f64], step: &mut [f64], forcing: f64, cost: &mut Cost) {
        let mut gmres = std::mem::take(&mut self.gmres);
        let kept = self.x.clone();
        let mut made = vec![Complex::default(); kept.len()];
        gmres.solve(rest, step, forcing, VECTORS, |v, out| {
            self.x.iter_mut().zip(v.chunks_exact(2)).for_each(|(x, v)| *x = Complex::new(v[0], v[1]));
            self.torque_change(&mut made);
            for (o, (x, g)) in out.chunks_exact_mut(2).zip(self.x.iter().zip(&made)) {
                (o[0], o[1]) = (x.re - g.re, x.im - g.im);
            }
        });
        cost.solutions += (gmres.iterations * self.nonlinear.harmonics) as u64;
        self.x = kept;
        self.gmres = gmres;
    }
}

/// The larger of two numbers; what is no number stays.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}
