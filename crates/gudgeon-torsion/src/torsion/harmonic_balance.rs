use std::collections::VecDeque;
use std::f64::consts::PI;

use gudgeon_core::kinds::{
    Line, LineThrow, LinearCoupling, OrderResponse, Torsion, TorsionAnswer, TorsionCtx, TorsionOut,
    TorsionSpec,
};
use gudgeon_core::quantity::{Positive, Ratio, quantity};
use gudgeon_core::{BuildError, EvalError};
use gudgeon_numerics::linalg::{Complex, lu_factor, lu_solve};
use serde::{Deserialize, Serialize};

use super::Orders;
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
/// evaluated over the cycle and taken apart into orders again. The iteration is accelerated (walker2011) and ends when the torques of
/// two rounds agree to `tolerance`.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HarmonicBalance {
    /// Change of the torques at which it ends, by the largest torque.
    #[serde(default = "tolerance")]
    pub tolerance: Ratio<Positive>,
    /// Most rounds.
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

gudgeon_core::register_model! {
    HarmonicBalance, kind: "torsion", name: "harmonic_balance",
    summary: "periodic motion with variable inertia and nonlinear couplings, by orders",
    equations: "(K + i omega C - omega^2 J) a_n = T_n + T_nl,n;  T_nl = dQ - (I - I_m) theta'' - I' theta'^2/2",
    validity: "Constant mean speed; all orders multiples of one. One periodic motion, not the choice between several.",
    references: ["gomes2021", "walker2011"],
    example: "tolerance = 1e-10\n",
}

impl HarmonicBalance {
    /// Itself, where a line has something that models by independent orders leave out.
    pub(crate) fn if_it_has_more(self, line: &Line) -> Option<Box<dyn TorsionSpec>> {
        (!active(line).is_empty()).then(|| Box::new(self) as Box<dyn TorsionSpec>)
    }
}

#[typetag::serde(name = "harmonic_balance")]
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
        // Taking the torques of a round apart goes with the square of the harmonics.
        let places = active.len();
        if harmonics == 0 || harmonics > 4000 || harmonics * harmonics * places > 25_000_000 {
            let what = format!(
                "{harmonics} harmonics of {places} nonlinear places; between 1 and 4000 are possible, and less for many places"
            );
            return Err(BuildError::at("orders", what));
        }
        // The moving masses are part of what is evaluated here.
        steady.whole_orders_without_masses(base, harmonics);
        // Products of three harmonics are still resolved.
        let samples = (8 * harmonics).next_power_of_two().max(64);
        let cycle = ctx.period;
        let at_even = |t: &LineThrow| -> Vec<f64> {
            let ratio = ctx.line.nodes[t.node].ratio;
            (0..if t.ends.is_empty() { 0 } else { samples })
                .map(|s| {
                    let even = ratio * cycle * s as f64 / samples as f64;
                    t.gas_torque(even, even)
                })
                .collect()
        };
        let mut solver = Solver {
            tolerance: self.tolerance.si(),
            rounds: self.rounds.max(2),
            base,
            harmonics,
            samples,
            table: (0..samples).map(|s| (2.0 * PI * s as f64 / samples as f64).sin_cos()).collect(),
            even: ctx.line.throws.iter().map(at_even).collect(),
            x: vec![0.0; 2 * active.len() * (harmonics + 1)],
            active,
            pairs: VecDeque::with_capacity(DEPTH + 1),
            tangents: Vec::new(),
            steady,
        };
        solver.take_tangents();
        Ok(Box::new(solver))
    }
    fn answers(&self) -> TorsionAnswer {
        TorsionAnswer::Periodic
    }
}

/// Nodes with something that is not linear, ascending.
fn active(line: &Line) -> Vec<usize> {
    let mut nodes: Vec<usize> = line.throws.iter().map(|t| t.node).collect();
    nodes.extend(line.drives.iter().filter(|d| !d.drive.is_linear()).map(|d| d.node));
    nodes.extend(line.links.iter().filter(|l| !l.coupling.is_linear()).flat_map(|l| l.nodes));
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// Rounds that the acceleration remembers.
const DEPTH: usize = 24;
/// Round from which it only counts those of its own speed.
const STALE: usize = 12;

#[derive(Debug)]
struct Solver {
    tolerance: f64,
    rounds: usize,
    base: f64,
    harmonics: usize,
    /// Points over the cycle, a power of two.
    samples: usize,
    /// Sine and cosine at these points.
    table: Vec<(f64, f64)>,
    /// Gas torque of each throw at these points of even rotation.
    even: Vec<Vec<f64>>,
    /// Nodes that have unknowns.
    active: Vec<usize>,
    /// Torques on these nodes that the linear line does not have, as the last run found them.
    x: Vec<f64>,
    /// Differences of iterates and of their remainders, newest first: those of one speed serve at the next, where little is different.
    pairs: VecDeque<[Vec<f64>; 2]>,
    /// Laws of the links as the linear line has them: the tree keeps these, whatever the mean torque turns out to be.
    tangents: Vec<LinearCoupling>,
    steady: Steady,
}

/// What the linear line leaves out, in orders from 0: torques by order and node, and those of each nonlinear link by order.
#[derive(Debug, Default)]
struct Rest {
    nodes: Vec<Vec<Complex>>,
    links: Vec<(usize, Vec<Complex>)>,
}

/// Motion of one node over the cycle: deviation from the mean rotation, its first and second derivative in time.
#[derive(Debug, Clone, Default)]
struct Wave {
    x: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
}

impl Solver {
    fn solve(&mut self, extra: &[Vec<Complex>]) -> Result<Vec<OrderResponse>, EvalError> {
        let mut out = Vec::with_capacity(self.harmonics);
        for k in 0..self.harmonics {
            let mut o = self.steady.excitation.orders[k].clone();
            for (t, e) in o.torque.iter_mut().zip(&extra[k + 1]) {
                *t = *t + *e;
            }
            out.push(self.steady.respond(&o)?);
        }
        Ok(out)
    }

    /// Laws of the links about the mean torques of the linear line.
    fn take_tangents(&mut self) {
        self.tangents = (self.steady.line.links.iter().zip(&self.steady.mean_torque))
            .map(|(l, mean)| l.coupling.linear(0.0, *mean))
            .collect();
    }

    /// Motion of the active nodes; nothing for the others.
    fn waves(&self, orders: &[OrderResponse]) -> Vec<Wave> {
        let m = self.samples;
        let omega = self.steady.speed * self.base;
        let mean = &self.steady.mean_angle;
        let mut waves = vec![Wave::default(); mean.len()];
        for &node in &self.active {
            let mut w = Wave { x: vec![mean[node]; m], v: vec![0.0; m], a: vec![0.0; m] };
            for (k, o) in orders.iter().enumerate() {
                let [re, im] = o.angle[node];
                if re == 0.0 && im == 0.0 {
                    continue;
                }
                let rate = (k + 1) as f64 * omega;
                let mut at = 0;
                for s in 0..m {
                    let (sin, cos) = self.table[at];
                    let (x, y) = (re * cos - im * sin, re * sin + im * cos);
                    w.x[s] += x;
                    w.v[s] -= rate * y;
                    w.a[s] -= rate * rate * x;
                    at = (at + k + 1) & (m - 1);
                }
            }
            waves[node] = w;
        }
        waves
    }

    /// Orders of what is given over the cycle.
    fn transform(&self, f: &[f64]) -> Vec<Complex> {
        let m = self.samples;
        (0..=self.harmonics)
            .map(|k| {
                let factor = if k == 0 { 1.0 } else { 2.0 } / m as f64;
                let (mut re, mut im, mut at) = (0.0, 0.0, 0);
                for f in f {
                    let (sin, cos) = self.table[at];
                    re += f * cos;
                    im -= f * sin;
                    at = (at + k) & (m - 1);
                }
                Complex::new(re * factor, im * factor)
            })
            .collect()
    }

    fn rest(&self, waves: &[Wave]) -> Rest {
        let (m, n) = (self.samples, waves.len());
        let line = &self.steady.line;
        let cycle = 2.0 * PI / self.base;
        let mut force = vec![vec![0.0; m]; n];
        for (t, at_even) in line.throws.iter().zip(&self.even) {
            let ratio = line.nodes[t.node].ratio;
            let w = &waves[t.node];
            let f = &mut force[t.node];
            for s in 0..m {
                let even = ratio * cycle * s as f64 / m as f64;
                let at = even + w.x[s];
                if !t.ends.is_empty() {
                    f[s] += t.gas_torque(at, at) - at_even[s];
                }
                if !t.inertia.is_constant() {
                    let (j, dj) = t.inertia.inertia(at + t.phase);
                    let speed = self.steady.speed * ratio + w.v[s];
                    f[s] -= (j - t.inertia.mean()) * w.a[s] + 0.5 * dj * speed * speed;
                }
            }
        }
        for d in line.drives.iter().filter(|d| !d.drive.is_linear()) {
            let ratio = line.nodes[d.node].ratio;
            let w = &waves[d.node];
            let speed = self.steady.speed * ratio;
            for (s, f) in force[d.node].iter_mut().enumerate() {
                let even = ratio * cycle * s as f64 / m as f64 + d.phase;
                let mean = d.drive.torque(even, speed);
                let here = d.drive.torque(even + w.x[s], speed + w.v[s]);
                *f += d.factor * (here.torque - mean.torque - mean.slope * w.v[s]);
            }
        }
        let mut out =
            Rest { nodes: vec![vec![Complex::default(); n]; self.harmonics + 1], links: Vec::new() };
        for (node, f) in force.iter().enumerate().filter(|(_, f)| f.iter().any(|f| *f != 0.0)) {
            for (o, c) in out.nodes.iter_mut().zip(self.transform(f)) {
                o[node] = c;
            }
        }
        let mut over = vec![0.0; m];
        for (l, link) in line.links.iter().enumerate().filter(|(_, l)| !l.coupling.is_linear()) {
            let [a, b] = link.nodes;
            let gear = line.nodes[a].ratio / line.nodes[b].ratio;
            let mean_torque = self.steady.mean_torque[l];
            let tangent = self.tangents[l];
            let rest = link.coupling.static_twist(mean_torque);
            for (s, over) in over.iter_mut().enumerate() {
                let twist = waves[a].x[s] - gear * waves[b].x[s];
                let rate = waves[a].v[s] - gear * waves[b].v[s];
                let linear = mean_torque + tangent.stiffness * (twist - rest) + tangent.damping * rate;
                *over = link.coupling.torque(twist, rate).torque - linear;
            }
            let c = self.transform(&over);
            for (o, c) in out.nodes.iter_mut().zip(&c) {
                o[a] = o[a] - *c;
                o[b] = o[b] + *c * Complex::new(gear, 0.0);
            }
            out.links.push((l, c));
        }
        out
    }

    /// Puts what nonlinear links carry beside their tangents into their torques, and their loss.
    fn complete(&mut self, orders: &mut [OrderResponse], rest: &Rest) {
        let line = &self.steady.line;
        for (l, c) in &rest.links {
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

impl Torsion for Solver {
    fn run(&mut self, out: &mut TorsionOut) -> Result<(), EvalError> {
        let warm = self.x.iter().any(|x| *x != 0.0);
        let mut rounds = 0;
        let first = self.iterate(&mut rounds);
        let found = match first {
            // The motion of another speed may be a bad start.
            Err(_) if warm => {
                self.forget();
                self.iterate(&mut rounds)
            }
            other => other,
        };
        if found.is_err() {
            self.forget();
        }
        let (mut orders, rest) = found?;
        self.complete(&mut orders, &rest);
        out.orders = orders;
        out.counters.insert("time_steps".into(), 0);
        out.counters.insert("rounds".into(), rounds);
        out.counters.insert("linear_solutions".into(), rounds * self.harmonics as u64);
        self.steady.describe(out);
        Ok(())
    }
    fn set_speed(&mut self, speed: f64) -> Result<(), EvalError> {
        self.steady.set_speed(speed);
        self.take_tangents();
        Ok(())
    }
}

impl Solver {
    /// The next run starts from nothing.
    fn forget(&mut self) {
        self.x.fill(0.0);
        self.pairs.clear();
    }

    /// The unknowns as torques by order and node.
    fn spread(&self) -> Vec<Vec<Complex>> {
        let n = self.steady.tree.len();
        self.x
            .chunks(2 * self.active.len())
            .map(|c| {
                let mut o = vec![Complex::default(); n];
                for (i, z) in self.active.iter().zip(c.chunks(2)) {
                    o[*i] = Complex::new(z[0], z[1]);
                }
                o
            })
            .collect()
    }

    /// Rounds from the unknowns as they stand to the periodic motion and what the linear line leaves out of it.
    fn iterate(&mut self, rounds: &mut u64) -> Result<(Vec<OrderResponse>, Rest), EvalError> {
        let mut last: Option<[Vec<f64>; 2]> = None;
        let base_mean = self.steady.excitation.mean.clone();
        let given = self.steady.excitation.orders.iter().flat_map(|o| &o.torque).map(|t| t.abs());
        let scale = given.chain(base_mean.iter().map(|m| m.abs())).fold(f64::MIN_POSITIVE, f64::max);
        let mut change = f64::INFINITY;
        for round in 0..self.rounds {
            *rounds += 1;
            if round == STALE {
                // What another speed left does not help here.
                self.pairs.truncate(round - 1);
            }
            let extra = self.spread();
            // Mean state under the mean of the rest.
            let mean: Vec<f64> = base_mean.iter().zip(&extra[0]).map(|(m, e)| m + e.re).collect();
            self.steady.take_mean(&mean);
            let orders = self.solve(&extra)?;
            let rest = self.rest(&self.waves(&orders));
            let g: Vec<f64> = rest
                .nodes
                .iter()
                .flat_map(|o| self.active.iter().flat_map(|&i| [o[i].re, o[i].im]))
                .collect();
            if g.iter().any(|v| !v.is_finite()) {
                return Err(EvalError::fatal("harmonic_balance", "the iteration leaves all bounds"));
            }
            let f: Vec<f64> = g.iter().zip(&self.x).map(|(g, x)| g - x).collect();
            let largest = g.iter().map(|v| v.abs()).fold(scale, f64::max);
            change = f.iter().map(|v| v.abs()).fold(0.0, f64::max) / largest;
            if change <= self.tolerance {
                return Ok((orders, rest));
            }
            if let Some([x, old]) = last.take() {
                let moved = self.x.iter().zip(&x).map(|(a, b)| a - b).collect();
                let changed = f.iter().zip(&old).map(|(a, b)| a - b).collect();
                self.pairs.push_front([moved, changed]);
                self.pairs.truncate(DEPTH);
            }
            let next = accelerated(&self.x, &f, &self.pairs);
            last = Some([std::mem::replace(&mut self.x, next), f]);
        }
        Err(EvalError::fatal(
            "harmonic_balance",
            format!(
                "no periodic motion at {:.6} rpm after {} rounds: torques still change by {change:.1e} of the largest; a resonance is near, or the motion has a period of its own",
                self.steady.speed * 30.0 / PI,
                self.rounds
            ),
        ))
    }
}

/// Next iterate by Anderson's method: the combination of what was tried whose remainder is least, plus that remainder. `pairs` are
/// differences of iterates and of their remainders, newest first.
fn accelerated(x: &[f64], f: &[f64], pairs: &VecDeque<[Vec<f64>; 2]>) -> Vec<f64> {
    let plain = || x.iter().zip(f).map(|(x, f)| x + f).collect::<Vec<f64>>();
    // Orthonormal differences of the remainders (modified Gram-Schmidt, twice), newest first.
    let mut q: Vec<Vec<f64>> = Vec::new();
    let mut used: Vec<&[Vec<f64>; 2]> = Vec::new();
    for pair in pairs {
        let mut d = pair[1].clone();
        let before = norm(&d);
        for _ in 0..2 {
            for e in &q {
                let s = dot(e, &d);
                d.iter_mut().zip(e).for_each(|(d, e)| *d -= s * e);
            }
        }
        let after = norm(&d);
        if after <= 1e-10 * before || before == 0.0 {
            continue;
        }
        d.iter_mut().for_each(|d| *d /= after);
        q.push(d);
        used.push(pair);
    }
    let k = q.len();
    if k == 0 {
        return plain();
    }
    // Q has the differences as R = Qᵀ ΔF, upper triangular in the order of use.
    let mut r = vec![0.0; k * k];
    let mut rhs: Vec<f64> = q.iter().map(|e| dot(e, f)).collect();
    for (c, pair) in used.iter().enumerate() {
        for (row, e) in q.iter().enumerate().take(c + 1) {
            r[row * k + c] = dot(e, &pair[1]);
        }
    }
    let mut pivots = vec![0; k];
    if lu_factor(&mut r, k, &mut pivots).is_err() {
        return plain();
    }
    lu_solve(&r, k, &pivots, &mut rhs);
    let mut next = plain();
    for (gamma, [moved, changed]) in rhs.iter().zip(used) {
        for ((next, x), f) in next.iter_mut().zip(moved).zip(changed) {
            *next -= gamma * (x + f);
        }
    }
    next
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}
