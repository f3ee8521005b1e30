use std::f64::consts::PI;

use gudgeon_core::kinds::{
    Line, LinearCoupling, OrderResponse, Torsion, TorsionAnswer, TorsionCtx, TorsionOut, TorsionSpec,
};
use gudgeon_core::quantity::{Positive, Ratio, quantity};
use gudgeon_core::{BuildError, EvalError};
use gudgeon_numerics::linalg::{Complex, lu_factor, lu_solve};
use serde::{Deserialize, Serialize};

use crate::forcing::Order;
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

#[typetag::serde(name = "harmonic_balance")]
impl TorsionSpec for HarmonicBalance {
    fn build(&self, ctx: &TorsionCtx<'_>) -> Result<Box<dyn Torsion>, BuildError> {
        let mut steady = Steady::new(ctx)?;
        if self.tolerance.si() < 1e-14 {
            return Err(BuildError::at("tolerance", "cannot be below 1e-14"));
        }
        let base = 2.0 * PI / ctx.period;
        for o in &steady.excitation.orders {
            let k = o.order / base;
            if (k - k.round()).abs() > 1e-6 {
                let what = format!("order {} is no multiple of {base}: the motion is not periodic", o.order);
                return Err(BuildError::at("model", what).help("use `orders` for gears of any ratio"));
            }
        }
        let harmonics = ((ctx.orders / base) + 1e-9).floor() as usize;
        // Taking the torques of a round apart goes with the square of the harmonics.
        let places = active(ctx.line).len();
        if harmonics == 0 || harmonics > 4000 || harmonics * harmonics * places > 25_000_000 {
            let what = format!(
                "{harmonics} harmonics of {places} nonlinear places; between 1 and 4000 are possible, and less for many places"
            );
            return Err(BuildError::at("orders", what));
        }
        // Every harmonic has an order, even where nothing excites it yet.
        let n = ctx.line.nodes.len();
        let old = std::mem::take(&mut steady.excitation.orders);
        steady.excitation.orders = (1..=harmonics)
            .map(|k| Order { order: k as f64 * base, torque: vec![Complex::default(); n] })
            .collect();
        for o in old {
            let k = (o.order / base).round() as usize;
            if (1..=harmonics).contains(&k) {
                steady.excitation.orders[k - 1].torque.clone_from(&o.torque);
            }
        }
        // The linear excitation must not hold the inertia torque twice: it is part of what is evaluated here.
        for t in ctx.line.throws.iter().filter(|t| !t.inertia.is_constant()) {
            let ratio = ctx.line.nodes[t.node].ratio;
            let per = (1.0 / base).round() as usize;
            let step = ratio.abs() / base;
            if (step - step.round()).abs() > 1e-6 {
                return Err(BuildError::at("model", "a geared throw does not repeat with the cycle"));
            }
            let c = crate::forcing::inertia_series(t, harmonics / per.max(1));
            for (k, c) in c.iter().enumerate().skip(1) {
                let at = (k as f64 * step).round() as usize;
                if at <= harmonics {
                    let (sin, cos) = (k as f64 * t.phase).sin_cos();
                    let square = (ctx.speed * ratio) * (ctx.speed * ratio);
                    let mut a = *c * Complex::new(cos * square, sin * square);
                    if ratio < 0.0 {
                        a.im = -a.im;
                    }
                    let s = &mut steady.excitation.orders[at - 1].torque[t.node];
                    *s = *s - a;
                }
            }
        }
        // Products of three harmonics are still resolved.
        let samples = (8 * harmonics).next_power_of_two().max(64);
        Ok(Box::new(Solver {
            tolerance: self.tolerance.si(),
            rounds: self.rounds.max(2),
            base,
            harmonics,
            samples,
            balance: ctx.balance,
            // The tree keeps these, whatever the mean torque turns out to be.
            tangents: (ctx.line.links.iter().zip(&steady.mean_torque))
                .map(|(l, mean)| l.coupling.linear(0.0, *mean))
                .collect(),
            steady,
        }))
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

#[derive(Debug)]
struct Solver {
    tolerance: f64,
    rounds: usize,
    base: f64,
    harmonics: usize,
    samples: usize,
    balance: usize,
    /// Laws of the links as the linear line has them.
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

    /// Motion of the `active` nodes; nothing for the others.
    fn waves(&self, orders: &[OrderResponse], active: &[usize], table: &[(f64, f64)]) -> Vec<Wave> {
        let m = self.samples;
        let omega = self.steady.speed * self.base;
        let mean = &self.steady.mean_angle;
        (0..mean.len())
            .map(|node| {
                if active.binary_search(&node).is_err() {
                    return Wave::default();
                }
                let mut w = Wave { x: vec![mean[node]; m], v: vec![0.0; m], a: vec![0.0; m] };
                for (k, o) in orders.iter().enumerate() {
                    let [re, im] = o.angle[node];
                    if re == 0.0 && im == 0.0 {
                        continue;
                    }
                    let rate = (k + 1) as f64 * omega;
                    for s in 0..m {
                        let (sin, cos) = table[(k + 1) * s % m];
                        let (x, y) = (re * cos - im * sin, re * sin + im * cos);
                        w.x[s] += x;
                        w.v[s] -= rate * y;
                        w.a[s] -= rate * rate * x;
                    }
                }
                w
            })
            .collect()
    }

    /// Orders of what is given over the cycle.
    fn transform(&self, f: &[f64], table: &[(f64, f64)]) -> Vec<Complex> {
        let m = self.samples;
        (0..=self.harmonics)
            .map(|k| {
                let factor = if k == 0 { 1.0 } else { 2.0 } / m as f64;
                let mut c = Complex::default();
                for (s, f) in f.iter().enumerate() {
                    let (sin, cos) = table[k * s % m];
                    c = c + Complex::new(f * cos, -f * sin);
                }
                c * Complex::new(factor, 0.0)
            })
            .collect()
    }

    fn rest(&self, waves: &[Wave], table: &[(f64, f64)]) -> Rest {
        let (m, n) = (self.samples, waves.len());
        let line = &self.steady.line;
        let cycle = 2.0 * PI / self.base;
        let mut force = vec![vec![0.0; m]; n];
        for t in &line.throws {
            let ratio = line.nodes[t.node].ratio;
            let w = &waves[t.node];
            let f = &mut force[t.node];
            for s in 0..m {
                let even = ratio * cycle * s as f64 / m as f64;
                let at = even + w.x[s];
                if !t.ends.is_empty() {
                    f[s] += t.gas_torque(at, at) - t.gas_torque(even, even);
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
            for (o, c) in out.nodes.iter_mut().zip(self.transform(f, table)) {
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
            let c = self.transform(&over, table);
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
        let (m, n) = (self.samples, self.steady.tree.len());
        let table: Vec<(f64, f64)> = (0..m).map(|s| (2.0 * PI * s as f64 / m as f64).sin_cos()).collect();
        // Only nodes with something nonlinear have unknowns.
        let line = &self.steady.line;
        let active = active(line);
        let flat = |r: &[Vec<Complex>]| -> Vec<f64> {
            r.iter().flat_map(|o| active.iter().flat_map(|&i| [o[i].re, o[i].im])).collect()
        };
        let unflat = |v: &[f64]| -> Vec<Vec<Complex>> {
            v.chunks(2 * active.len().max(1))
                .map(|c| {
                    let mut o = vec![Complex::default(); n];
                    for (i, z) in active.iter().zip(c.chunks(2)) {
                        o[*i] = Complex::new(z[0], z[1]);
                    }
                    o
                })
                .collect()
        };
        let size = 2 * active.len() * (self.harmonics + 1);
        let mut x = vec![0.0; size];
        let (mut xs, mut fs): (Vec<Vec<f64>>, Vec<Vec<f64>>) = (Vec::new(), Vec::new());
        let base_mean = self.steady.excitation.mean.clone();
        let scale = self
            .steady
            .excitation
            .orders
            .iter()
            .flat_map(|o| o.torque.iter().map(|t| t.abs()))
            .fold(base_mean.iter().map(|m| m.abs()).fold(0.0, f64::max), f64::max);
        let mut solutions = 0;
        let mut change = f64::INFINITY;
        let mut rounds = 0;
        let mut best: Vec<OrderResponse> = Vec::new();
        let mut rest = Rest::default();
        while rounds < self.rounds {
            rounds += 1;
            let extra = if active.is_empty() {
                vec![vec![Complex::default(); n]; self.harmonics + 1]
            } else {
                unflat(&x)
            };
            // Mean state under the mean of the rest.
            let mean: Vec<f64> = base_mean.iter().zip(&extra[0]).map(|(m, e)| m + e.re).collect();
            let (torque, angle, hold) =
                crate::steady::mean_state(&self.steady.line, &self.steady.tree, &mean, self.balance);
            (self.steady.mean_torque, self.steady.mean_angle, self.steady.balance_torque) =
                (torque, angle, hold);
            let orders = self.solve(&extra)?;
            solutions += self.harmonics as u64;
            if active.is_empty() {
                best = orders;
                change = 0.0;
                break;
            }
            let waves = self.waves(&orders, &active, &table);
            rest = self.rest(&waves, &table);
            let g = flat(&rest.nodes);
            if g.iter().any(|v| !v.is_finite()) {
                return Err(EvalError::fatal("harmonic_balance", "the iteration leaves all bounds"));
            }
            let f: Vec<f64> = g.iter().zip(&x).map(|(g, x)| g - x).collect();
            let largest = g.iter().map(|v| v.abs()).fold(scale, f64::max);
            change = f.iter().map(|v| v.abs()).fold(0.0, f64::max) / largest.max(f64::MIN_POSITIVE);
            best = orders;
            if change <= self.tolerance {
                break;
            }
            xs.push(x.clone());
            fs.push(f.clone());
            if xs.len() > DEPTH + 1 {
                xs.remove(0);
                fs.remove(0);
            }
            x = accelerated(&xs, &fs);
        }
        if change > self.tolerance {
            return Err(EvalError::fatal(
                "harmonic_balance",
                format!(
                    "no periodic motion after {rounds} rounds: torques still change by {change:.1e} of the largest; a resonance is near, or the motion has a period of its own"
                ),
            ));
        }
        self.complete(&mut best, &rest);
        out.orders = best;
        out.counters.insert("time_steps".into(), 0);
        out.counters.insert("rounds".into(), rounds as u64);
        out.counters.insert("linear_solutions".into(), solutions);
        self.steady.describe(out);
        Ok(())
    }
}

/// Next iterate by Anderson's method: the combination of what was tried whose remainder is least, plus that remainder.
fn accelerated(xs: &[Vec<f64>], fs: &[Vec<f64>]) -> Vec<f64> {
    let last = xs.len() - 1;
    let (x, f) = (&xs[last], &fs[last]);
    let plain = || x.iter().zip(f).map(|(x, f)| x + f).collect::<Vec<f64>>();
    if last == 0 {
        return plain();
    }
    // Orthonormal differences of the remainders (modified Gram-Schmidt, twice), newest first.
    let mut q: Vec<Vec<f64>> = Vec::new();
    let mut used: Vec<usize> = Vec::new();
    for i in (0..last).rev() {
        let mut d: Vec<f64> = fs[i + 1].iter().zip(&fs[i]).map(|(a, b)| a - b).collect();
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
        used.push(i);
    }
    let k = q.len();
    // Q has the differences as R = Qᵀ ΔF, upper triangular in the order of use.
    let mut r = vec![0.0; k * k];
    let mut rhs: Vec<f64> = q.iter().map(|e| dot(e, f)).collect();
    for (c, &i) in used.iter().enumerate() {
        let d: Vec<f64> = fs[i + 1].iter().zip(&fs[i]).map(|(a, b)| a - b).collect();
        for (row, e) in q.iter().enumerate() {
            r[row * k + c] = dot(e, &d);
        }
    }
    let mut pivots = vec![0; k];
    if lu_factor(&mut r, k, &mut pivots).is_err() {
        return plain();
    }
    lu_solve(&r, k, &pivots, &mut rhs);
    let mut next = plain();
    for (gamma, &i) in rhs.iter().zip(&used) {
        for j in 0..next.len() {
            next[j] -= gamma * ((xs[i + 1][j] - xs[i][j]) + (fs[i + 1][j] - fs[i][j]));
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
