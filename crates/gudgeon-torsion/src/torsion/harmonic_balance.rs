use std::f64::consts::PI;

use gudgeon_core::kinds::{
    Line, LinearCoupling, OrderResponse, Torsion, TorsionAnswer, TorsionCtx, TorsionOut, TorsionSpec,
};
use gudgeon_core::quantity::{Positive, Ratio, quantity};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_numerics::gmres::Gmres;
use gudgeon_numerics::linalg::Complex;
use serde::{Deserialize, Serialize};

use super::Orders;
use crate::beyond::{Beyond, active};
use crate::receptance::Receptance;
use crate::steady::Steady;

/// The periodic motion at constant mean speed with all that is not linear: variable inertia with its velocity-squared term, gas torques and
/// drives at the true angle and speed, couplings that stiffen.
///
/// Each order is solved by elimination along the tree; what the linear line does not have is put on its right-hand side,
///
/// ```text
/// T_nl = Q(α) - Q(α₀) - (I(α) - Ī) θ'' - ½ I'(α) θ'²,   α = angle of the throw;
/// of a coupling: its torque less that of its tangent at the mean torque,
/// ```
///
/// evaluated over the cycle and taken apart into orders again. That is an equation for the torques of all orders at once, solved by
/// Newton's method; its linear systems are known by what they do to a motion and solved in a Krylov space (saad1986). It ends when the
/// torques of a motion are those that made it, to `tolerance`.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HarmonicBalance {
    /// Change of the torques at which it ends, by the largest torque.
    #[serde(default = "tolerance")]
    #[schemars(extend("x-refine" = { "group": "tolerance", "factor": 0.1 }))]
    pub tolerance: Ratio<Positive>,
    /// Most evaluations of the motion.
    #[serde(default = "rounds")]
    #[schemars(range(min = 1, max = 100_000))]
    pub rounds: usize,
}

fn tolerance() -> Ratio<Positive> {
    quantity(1e-10)
}
fn rounds() -> usize {
    300
}

impl Default for HarmonicBalance {
    fn default() -> Self {
        Self { tolerance: tolerance(), rounds: rounds() }
    }
}

impl HarmonicBalance {
    /// Itself, where a line has something that models by independent orders leave out.
    pub(crate) fn if_it_has_more(self, line: &Line) -> Option<Box<dyn TorsionSpec>> {
        (!active(line).is_empty()).then(|| Box::new(self) as Box<dyn TorsionSpec>)
    }
}

#[register_model(
    name = "harmonic_balance",
    summary = "periodic motion with variable inertia and nonlinear couplings, by orders",
    equations = "(K + i omega C - omega^2 J) a_n = T_n + T_nl,n;  T_nl = dQ - (I - I_m) theta'' - I' theta'^2/2",
    validity = "Constant mean speed; all orders multiples of one. One periodic motion, not the choice between several.",
    references = ["gomes2021", "saad1986"],
    example = "tolerance = 1e-10\n",
)]
impl TorsionSpec for HarmonicBalance {
    fn build(&self, ctx: &TorsionCtx<'_>) -> Result<Box<dyn Torsion>, BuildError> {
        if self.tolerance.si() < 1e-14 {
            return Err(BuildError::at("tolerance", "cannot be below 1e-14"));
        }
        let active = active(ctx.line);
        if active.is_empty() {
            // What is linear is solved once, whatever its orders are.
            return Orders {}.build(ctx);
        }
        let mut steady = Steady::new(ctx)?;
        let base = 2.0 * PI / ctx.period;
        let whole = |step: f64| (step - step.round()).abs() <= 1e-6;
        for o in &steady.excitation.orders {
            if !whole(o.order / base) {
                let what = format!("order {} is no multiple of {base}: the motion is not periodic", o.order);
                return Err(BuildError::at("model", what).help("use `orders` for gears of any ratio"));
            }
        }
        for t in ctx.line.throws.iter().filter(|t| !t.inertia.is_constant()) {
            if !whole(ctx.line.nodes[t.node].ratio.abs() / base) {
                let what = "a geared throw does not repeat with the cycle";
                return Err(BuildError::at("model", what).help("use `orders` for gears of any ratio"));
            }
        }
        let harmonics = ((ctx.orders / base) + 1e-9).floor() as usize;
        // The Krylov space holds many motions at once.
        let places = active.len();
        if harmonics == 0 || harmonics > 4000 || harmonics * harmonics * places > 25_000_000 {
            let what = format!(
                "{harmonics} harmonics of {places} nonlinear places; between 1 and 4000 are possible, and less for many places"
            );
            return Err(BuildError::at("orders", what));
        }
        // The moving masses are part of what is evaluated here.
        steady.whole_orders_without_masses(base, harmonics);
        let unknowns = places * (harmonics + 1);
        Ok(Box::new(Solver {
            tolerance: self.tolerance.si(),
            rounds: self.rounds.max(2),
            base,
            beyond: Beyond::new(ctx.line, ctx.period, harmonics),
            receptance: Receptance::default(),
            gmres: Gmres::default(),
            x: vec![Complex::default(); unknowns],
            angle: vec![Complex::default(); unknowns],
            give: Vec::new(),
            load: Vec::new(),
            tangents: Vec::new(),
            known: Known::default(),
            share: 1.0,
            steady,
        }))
    }
    fn answers(&self) -> TorsionAnswer {
        TorsionAnswer::Periodic
    }
}

/// Vectors that a linear solution may use.
const VECTORS: usize = 200;
/// Rounds in which Newton's method must halve what is left: where it does not, it circles.
const STALLED: usize = 20;
/// Growth of the remainder by which a step is not taken, and how often it is halved then.
const GROWTH: f64 = 1.5;
const HALVINGS: usize = 8;
/// First share of the torques beyond the linear line when all at once is too much, and the least by which it is raised.
const FIRST: f64 = 0.25;
const LEAST: f64 = 1.0 / 1024.0;

#[derive(Debug)]
struct Solver {
    tolerance: f64,
    rounds: usize,
    base: f64,
    beyond: Beyond,
    receptance: Receptance,
    gmres: Gmres,
    /// Torques on the active nodes that the linear line does not have, by node and order with the mean.
    x: Vec<Complex>,
    /// Angles of the active nodes in the same order.
    angle: Vec<Complex>,
    /// Change of mean angles by mean torques on the active nodes, a row for each angle; of the mean torques of the links in the same way.
    give: Vec<f64>,
    load: Vec<f64>,
    /// Laws of the links as the linear line has them: the tree keeps these, whatever the mean torque turns out to be.
    tangents: Vec<LinearCoupling>,
    known: Known,
    /// Share of the torques beyond the linear line that is asked for.
    share: f64,
    steady: Steady,
}

/// Torques at speeds that were solved.
#[derive(Debug, Default)]
struct Known {
    /// Speed, when it was put here, torques; ascending.
    at: Vec<(f64, u64, Vec<Complex>)>,
    count: u64,
}

/// Numbers that are kept, and the fewest speeds.
const ROOM: usize = 1 << 19;
const KEPT: usize = 24;
/// Speeds that a guess goes through, and their distance by that of the nearest.
const THROUGH: usize = 8;
const NEAR: f64 = 10.0;
/// Sum of the weights up to which a guess is worth more than the nearest speed.
const TRUSTED: f64 = 300.0;

impl Known {
    fn keep(&mut self, speed: f64, x: &[Complex]) {
        self.count += 1;
        if self.at.len() >= KEPT.max(ROOM / x.len().max(1)) {
            let oldest = (0..self.at.len()).min_by_key(|i| self.at[*i].1);
            oldest.map(|i| self.at.remove(i));
        }
        let place = self.at.partition_point(|k| k.0 < speed);
        let own = (speed, self.count, x.to_vec());
        match self.at.get_mut(place) {
            Some(old) if old.0 == speed => *old = own,
            _ => self.at.insert(place, own),
        }
    }

    /// The speeds next to one, nearest first.
    fn near(&self, speed: f64) -> Vec<usize> {
        let mut above = self.at.partition_point(|k| k.0 < speed);
        let mut below = above;
        let mut near = Vec::with_capacity(THROUGH);
        while near.len() < THROUGH.min(self.at.len()) {
            let up = self.at.get(above).map_or(f64::INFINITY, |k| k.0 - speed);
            let down = if below > 0 { speed - self.at[below - 1].0 } else { f64::INFINITY };
            if up <= down {
                near.push(above);
                above += 1;
            } else {
                below -= 1;
                near.push(below);
            }
        }
        near
    }

    /// The polynomial through the torques at the nearest speeds.
    fn guess(&self, speed: f64, x: &mut [Complex]) {
        x.fill(Complex::default());
        let near: Vec<&(f64, u64, Vec<Complex>)> = self.near(speed).iter().map(|i| &self.at[*i]).collect();
        let Some(first) = near.first() else { return };
        let reach = NEAR * (first.0 - speed).abs();
        let mut count = near.iter().take_while(|k| (k.0 - speed).abs() <= reach).count();
        let weights = |count: usize| -> Vec<f64> {
            let part = |i: usize, j: usize| (speed - near[j].0) / (near[i].0 - near[j].0);
            (0..count).map(|i| (0..count).filter(|j| *j != i).map(|j| part(i, j)).product()).collect()
        };
        while count > 1 && weights(count).iter().map(|w: &f64| w.abs()).sum::<f64>() > TRUSTED {
            count -= 1;
        }
        for (w, (_, _, known)) in weights(count.max(1)).into_iter().zip(&near) {
            let w = Complex::new(w, 0.0);
            x.iter_mut().zip(known).for_each(|(x, k)| *x = *x + w * *k);
        }
    }
}

impl Torsion for Solver {
    fn run(&mut self, out: &mut TorsionOut) -> Result<(), EvalError> {
        self.take_tangents();
        self.receptance.factor(&mut self.steady, self.base, self.beyond.harmonics);
        let speed = self.steady.speed;
        self.known.guess(speed, &mut self.x);
        let mut work = Work::default();
        let mut found = self.iterate(&mut work);
        if found.is_err() && !self.known.at.is_empty() {
            // The motion of another speed may be a bad start.
            self.x.fill(Complex::default());
            found = self.iterate(&mut work);
        }
        if let Err(e) = found {
            self.by_degrees(&mut work, e)?;
        }
        self.known.keep(speed, &self.x);
        let rest = self.beyond.beside_tangents();
        out.orders = self.responses()?;
        self.complete(&mut out.orders, &rest);
        out.counters.insert("time_steps".into(), 0);
        out.counters.insert("rounds".into(), work.rounds);
        out.counters.insert("linear_solutions".into(), work.solutions);
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
struct Work {
    rounds: u64,
    /// Orders solved.
    solutions: u64,
}

impl Solver {
    /// Laws of the links about the mean torques of the linear line.
    fn take_tangents(&mut self) {
        self.tangents = (self.steady.line.links.iter().zip(&self.steady.mean_torque))
            .map(|(l, mean)| l.coupling.linear(0.0, *mean))
            .collect();
    }

    /// Raises the share of the torques beyond the linear line from nothing to the whole, each solution the start of the next.
    fn by_degrees(&mut self, work: &mut Work, failed: EvalError) -> Result<(), EvalError> {
        self.x.fill(Complex::default());
        let (mut reached, mut step) = (0.0, FIRST);
        while reached < 1.0 {
            let start = self.x.clone();
            self.share = (reached + step).min(1.0);
            let found = self.iterate(work);
            let share = std::mem::replace(&mut self.share, 1.0);
            if found.is_ok() {
                (reached, step) = (share, 2.0 * step);
                continue;
            }
            self.x = start;
            step *= 0.5;
            if step < LEAST {
                return Err(failed);
            }
        }
        Ok(())
    }

    /// Newton's method from the torques as they stand.
    fn iterate(&mut self, work: &mut Work) -> Result<(), EvalError> {
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
            work.rounds += 1;
            work.solutions += self.beyond.harmonics as u64;
            self.evaluate(&base_mean, &mut g)?;
            let sizes = g.iter().map(|g| g.abs()).fold(0.0, larger);
            let misses = g.iter().zip(&self.x).map(|(g, x)| (*g - *x).abs()).fold(0.0, larger);
            change = misses / sizes.max(scale);
            if change <= self.tolerance {
                return Ok(());
            }
            let bad = !change.is_finite();
            if (bad || change > GROWTH * last) && halved < HALVINGS && last.is_finite() {
                // Back half of the step.
                halved += 1;
                let part = 0.5_f64.powi(halved as i32);
                for (x, d) in self.x.iter_mut().zip(step.chunks_exact(2)) {
                    *x = *x - Complex::new(part * d[0], part * d[1]);
                }
                continue;
            }
            if change > GROWTH * last {
                return Err(self.fails(change, work.rounds));
            }
            if bad {
                return Err(EvalError::fatal("harmonic_balance", "the iteration leaves all bounds"));
            }
            (last, halved) = (change, 0);
            for (r, (g, x)) in rest.chunks_exact_mut(2).zip(g.iter().zip(&self.x)) {
                (r[0], r[1]) = (g.re - x.re, g.im - x.im);
            }
            self.linearise(&base_mean, scale);
            // A vector of the Krylov space costs less than another evaluation; what is beyond the square of the change is lost anyway.
            let forcing = (0.3 * self.tolerance / change).max((0.01 * change).min(0.01));
            self.newton_step(&rest, &mut step, forcing, work);
            for (x, d) in self.x.iter_mut().zip(step.chunks_exact(2)) {
                *x = *x + Complex::new(d[0], d[1]);
            }
        }
        Err(self.fails(change, work.rounds))
    }

    fn fails(&self, change: f64, rounds: u64) -> EvalError {
        let what = format!(
            "no periodic motion at {:.6} rpm after {rounds} rounds: torques still change by {change:.1e} of the largest; a resonance is near, or the motion has a period of its own",
            self.steady.speed * 30.0 / PI
        );
        EvalError::fatal("harmonic_balance", what)
    }

    /// The motion under the torques `x`, and the torques that it makes.
    fn evaluate(&mut self, base_mean: &[f64], g: &mut [Complex]) -> Result<(), EvalError> {
        self.take_mean(base_mean);
        self.spread(true);
        self.solved()?;
        for (i, node) in self.beyond.active.iter().enumerate() {
            let at = i * self.beyond.orders();
            self.angle[at] = Complex::new(self.steady.mean_angle[*node], 0.0);
        }
        let omega = self.steady.speed * self.base;
        self.beyond.take_motion(&self.angle, omega);
        self.beyond.torques(&self.steady, &self.tangents, g);
        g.iter_mut().for_each(|g| *g = *g * Complex::new(self.share, 0.0));
        Ok(())
    }

    /// The mean state under the mean torques in `x`.
    fn take_mean(&mut self, base_mean: &[f64]) {
        let mut mean = base_mean.to_vec();
        for (i, node) in self.beyond.active.iter().enumerate() {
            mean[*node] += self.x[i * self.beyond.orders()].re;
        }
        self.steady.take_mean(&mean);
    }

    /// Puts torques of `x`, with those that are given where `given` says so, in the place of the right-hand sides.
    fn spread(&mut self, given: bool) {
        let (tree, m) = (&self.steady.tree, self.beyond.harmonics);
        let [re, im] = &mut self.receptance.field;
        if given {
            for (k, o) in self.steady.excitation.orders.iter().enumerate() {
                for p in 0..tree.len() {
                    let t = o.torque[tree.node[p]];
                    (re[p * m + k], im[p * m + k]) = (tree.ratio[p] * t.re, tree.ratio[p] * t.im);
                }
            }
        } else {
            re.fill(0.0);
            im.fill(0.0);
        }
        for (own, node) in self.x.chunks_exact(m + 1).zip(&self.beyond.active) {
            let p = tree.position[*node];
            let ratio = tree.ratio[p];
            for (k, x) in own[1..].iter().enumerate() {
                re[p * m + k] += ratio * x.re;
                im[p * m + k] += ratio * x.im;
            }
        }
    }

    /// Solves what [`Self::spread`] put there: the angles of the active nodes.
    fn solved(&mut self) -> Result<(), EvalError> {
        let m = self.beyond.harmonics;
        if let Err((k, _)) = self.receptance.solve(&mut self.steady) {
            // The careful elimination says it in its own words.
            let order = self.steady.excitation.orders[k].clone();
            self.steady.respond(&order)?;
            return Err(EvalError::fatal("harmonic_balance", "an undamped resonance is hit"));
        }
        let (tree, [re, im]) = (&self.steady.tree, &self.receptance.field);
        for (own, node) in self.angle.chunks_exact_mut(m + 1).zip(&self.beyond.active) {
            let p = tree.position[*node];
            let ratio = tree.ratio[p];
            for (k, x) in own[1..].iter_mut().enumerate() {
                *x = Complex::new(ratio * re[p * m + k], ratio * im[p * m + k]);
            }
        }
        Ok(())
    }

    /// Derivatives at the motion of the last evaluation.
    fn linearise(&mut self, base_mean: &[f64], scale: f64) {
        self.beyond.take_slopes(&self.steady, &self.tangents);
        let active = &self.beyond.active;
        let (n, links) = (active.len(), self.tangents.len());
        self.give.resize(n * n, 0.0);
        self.load.resize(links * n, 0.0);
        let [angle, torque] = [self.steady.mean_angle.clone(), self.steady.mean_torque.clone()];
        let mut mean = base_mean.to_vec();
        for (i, node) in active.iter().enumerate() {
            mean[*node] += self.x[i * self.beyond.orders()].re;
        }
        // The mean state goes straight with the torque, but for couplings that stiffen.
        let h = 1e-3 * scale;
        for j in 0..n {
            let before = mean[active[j]];
            mean[active[j]] = before + h;
            self.steady.take_mean(&mean);
            mean[active[j]] = before;
            for (i, node) in active.iter().enumerate() {
                self.give[i * n + j] = (self.steady.mean_angle[*node] - angle[*node]) / h;
            }
            for l in 0..links {
                self.load[l * n + j] = (self.steady.mean_torque[l] - torque[l]) / h;
            }
        }
        (self.steady.mean_angle, self.steady.mean_torque) = (angle, torque);
    }

    /// Solves `step - (change of the torques by step) = rest` to a part `forcing` of it.
    fn newton_step(&mut self, rest: &[f64], step: &mut [f64], forcing: f64, work: &mut Work) {
        let mut gmres = std::mem::take(&mut self.gmres);
        let kept = self.x.clone();
        let mut made = vec![Complex::default(); kept.len()];
        gmres.solve(rest, step, forcing, VECTORS, |v, out| {
            self.x.iter_mut().zip(v.chunks_exact(2)).for_each(|(x, v)| *x = Complex::new(v[0], v[1]));
            self.moved(&mut made);
            for (o, (x, g)) in out.chunks_exact_mut(2).zip(self.x.iter().zip(&made)) {
                (o[0], o[1]) = (x.re - g.re, x.im - g.im);
            }
        });
        work.solutions += (gmres.iterations * self.beyond.harmonics) as u64;
        self.x = kept;
        self.gmres = gmres;
    }

    /// What torques `x` beside those of the last evaluation change in the torques.
    fn moved(&mut self, made: &mut [Complex]) {
        let orders = self.beyond.orders();
        let n = self.beyond.active.len();
        self.spread(false);
        // The evaluation before has met no resonance in the same systems.
        if self.solved().is_err() {
            made.fill(Complex::default());
            return;
        }
        let by = |matrix: &[f64], i: usize, x: &[Complex]| -> f64 {
            (0..n).map(|j| matrix[i * n + j] * x[j * orders].re).sum()
        };
        for i in 0..n {
            self.angle[i * orders] = Complex::new(by(&self.give, i, &self.x), 0.0);
        }
        let load: Vec<f64> = (0..self.tangents.len()).map(|l| by(&self.load, l, &self.x)).collect();
        let omega = self.steady.speed * self.base;
        self.beyond.change(&self.angle, omega, &load, made);
        made.iter_mut().for_each(|g| *g = *g * Complex::new(self.share, 0.0));
    }

    /// The whole answer of each order.
    fn responses(&mut self) -> Result<Vec<OrderResponse>, EvalError> {
        let orders = self.beyond.orders();
        let mut out = Vec::with_capacity(orders);
        for k in 1..orders {
            let mut o = self.steady.excitation.orders[k - 1].clone();
            for (i, node) in self.beyond.active.iter().enumerate() {
                o.torque[*node] = o.torque[*node] + self.x[i * orders + k];
            }
            out.push(self.steady.respond(&o)?);
        }
        Ok(out)
    }

    /// Puts what nonlinear links carry beside their tangents into their torques, and their loss.
    fn complete(&mut self, orders: &mut [OrderResponse], rest: &[(usize, Vec<Complex>)]) {
        let line = &self.steady.line;
        for (l, c) in rest {
            let [a, b] = line.links[*l].nodes;
            let gear = line.nodes[a].ratio / line.nodes[b].ratio;
            self.steady.mean_torque[*l] += c[0].re;
            for (o, c) in orders.iter_mut().zip(&c[1..]) {
                let t = &mut o.torque[*l];
                *t = [t[0] + c.re, t[1] + c.im];
                // Mean of torque times rate of twist: an order may take power from another, the sum is the loss.
                let twist = [o.angle[a][0] - gear * o.angle[b][0], o.angle[a][1] - gear * o.angle[b][1]];
                let rate = o.order * self.steady.speed;
                o.heat[*l] = 0.5 * rate * (t[1] * twist[0] - t[0] * twist[1]);
            }
        }
    }
}

/// The larger of two numbers; what is no number stays.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}
