//! The polynomial through the samples of one step: its integral, its extremes, its crossings of a level, its fall.
//!
//! What is asked of a cycle (a highest pressure, a mean film, a share of time) is found step by step on what the integrator knows of
//! each step, so that it depends on nothing but the steps.

/// Places in `[0, 1]` at which a step is sampled, both ends among them, and the weights that belong to them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rule {
    /// Places, ascending, from 0 to 1.
    pub nodes: &'static [f64],
    /// Weights of the quadrature; their sum is 1.
    pub weights: &'static [f64],
    /// Barycentric weights of the interpolation.
    barycentric: &'static [f64],
    /// How far the polynomial can rise above the highest sample, as a part of the range of all: half of the Lebesgue constant less one, rounded up.
    pub overshoot: f64,
}

/// `(1 - sqrt(3/7)) / 2`.
const INNER: f64 = 0.172_673_164_646_011_43;

/// Five points of Lobatto: exact for the integral of polynomials to degree 7, and through any of degree 4, which dense output has.
pub const LOBATTO: Rule = Rule {
    nodes: &[0.0, INNER, 0.5, 1.0 - INNER, 1.0],
    weights: &[1.0 / 20.0, 49.0 / 180.0, 16.0 / 45.0, 49.0 / 180.0, 1.0 / 20.0],
    barycentric: &[7.0 / 8.0, -49.0 / 24.0, 7.0 / 3.0, -49.0 / 24.0, 7.0 / 8.0],
    // A Lebesgue constant of 1.636.
    overshoot: 0.32,
};

/// Both ends and the middle: exact for the integral of polynomials to degree 3.
pub const SIMPSON: Rule = Rule {
    nodes: &[0.0, 0.5, 1.0],
    weights: &[1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0],
    barycentric: &[2.0, -4.0, 2.0],
    // 5/4; and what is rounded.
    overshoot: 0.125 + 1e-9,
};

/// Both ends and a straight line between them.
pub const TRAPEZIUM: Rule =
    Rule { nodes: &[0.0, 1.0], weights: &[0.5, 0.5], barycentric: &[-1.0, 1.0], overshoot: 0.0 };

/// Parts of a step in which turning points and crossings are looked for; a polynomial of degree 4 turns three times at most.
const PARTS: usize = 16;
/// Most steps to a turning point: Newton's method, with halvings where that leaves the bracket.
const TURNING_STEPS: usize = 60;
/// Halvings that bring a sixteenth of a step to its rounding.
const HALVINGS: u32 = 50;

impl Rule {
    /// The polynomial through `values`, one per node, at `x` in `[0, 1]`.
    #[must_use]
    pub fn value(&self, values: &[f64], x: f64) -> f64 {
        let (mut above, mut below) = (0.0, 0.0);
        for ((node, weight), value) in self.nodes.iter().zip(self.barycentric).zip(values) {
            let away = x - node;
            if away == 0.0 {
                return *value;
            }
            let share = weight / away;
            above += share * value;
            below += share;
        }
        above / below
    }

    /// Mean of `values` over the step.
    #[must_use]
    pub fn mean(&self, values: &[f64]) -> f64 {
        self.weights.iter().zip(values).map(|(w, v)| w * v).sum()
    }

    /// Where the polynomial is highest, and its value there, when that is above `floor`.
    #[must_use]
    pub fn maximum(&self, values: &[f64], floor: f64) -> Option<(f64, f64)> {
        let (low, high) = span(values);
        if high + self.overshoot * (high - low) <= floor {
            return None;
        }
        let x = Curve::new(self.nodes, values).highest();
        let mut best = (x, self.value(values, x));
        // A straight line or a jump: the samples themselves.
        for (x, v) in self.nodes.iter().zip(values) {
            if *v > best.1 {
                best = (*x, *v);
            }
        }
        (best.1 > floor).then_some(best)
    }

    /// Where the polynomial is lowest, and its value there, when that is below `ceiling`.
    #[must_use]
    pub fn minimum(&self, values: &[f64], ceiling: f64) -> Option<(f64, f64)> {
        let mut turned = [0.0; MAX_NODES];
        for (t, v) in turned.iter_mut().zip(values) {
            *t = -v;
        }
        self.maximum(&turned[..values.len()], -ceiling).map(|(x, v)| (x, -v))
    }

    /// Calls `cross` at every place where the polynomial goes through `level`, in order, with whether it rises there.
    pub fn crossings(&self, values: &[f64], level: f64, mut cross: impl FnMut(f64, bool)) {
        let (low, high) = span(values);
        let reach = self.overshoot * (high - low);
        if low - reach > level || high + reach <= level {
            return;
        }
        let above = |x: f64| self.value(values, x) > level;
        let mut before = above(0.0);
        for k in 1..=PARTS {
            let (mut a, mut b) = ((k - 1) as f64 / PARTS as f64, k as f64 / PARTS as f64);
            let now = above(b);
            if now == before {
                continue;
            }
            for _ in 0..HALVINGS {
                let middle = 0.5 * (a + b);
                if above(middle) == before { a = middle } else { b = middle }
            }
            cross(b, now);
            before = now;
        }
    }

    /// How much the polynomial goes down over the step: the sum of all its falls, positive. Samples that only rise, or only fall, are taken
    /// by their ends.
    #[must_use]
    pub fn fall(&self, values: &[f64]) -> f64 {
        let (first, last) = (values[0], values[values.len() - 1]);
        if values.is_sorted() || values.is_sorted_by(|a, b| a >= b) {
            return (first - last).max(0.0);
        }
        let curve = Curve::new(self.nodes, values);
        if let Some(x) = curve.vertex() {
            let turn = self.value(values, x);
            return (first - turn).max(0.0) + (turn - last).max(0.0);
        }
        let at = |k: usize| curve.value(k as f64 / PARTS as f64);
        let (mut sum, mut from) = (0.0, first);
        let (mut before, mut now) = (first, at(1));
        for k in 1..PARTS {
            let next = at(k + 1);
            if (now - before) * (next - now) <= 0.0 && now != before {
                let (a, b) = ((k - 1) as f64 / PARTS as f64, (k + 1) as f64 / PARTS as f64);
                let x = curve.turn(a, b, if now > before { 1.0 } else { -1.0 });
                let turn = self.value(values, x.unwrap_or(k as f64 / PARTS as f64));
                sum += (from - turn).max(0.0);
                from = turn;
            }
            (before, now) = (now, next);
        }
        sum + (from - last).max(0.0)
    }
}

/// The polynomial through samples in Newton's form, whose derivatives are at hand.
struct Curve {
    nodes: &'static [f64],
    /// Divided differences.
    c: [f64; MAX_NODES],
}

impl Curve {
    fn new(nodes: &'static [f64], values: &[f64]) -> Self {
        let mut c = [0.0; MAX_NODES];
        c[..values.len()].copy_from_slice(values);
        for order in 1..nodes.len() {
            for k in (order..nodes.len()).rev() {
                c[k] = (c[k] - c[k - 1]) / (nodes[k] - nodes[k - order]);
            }
        }
        Self { nodes, c }
    }

    /// Where the parabola through three samples turns, or the end of the step where it turns nowhere in it; of another number of samples nothing.
    fn vertex(&self) -> Option<f64> {
        let &[a, b, _] = self.nodes else { return None };
        let [_, first, second, ..] = self.c;
        let x = 0.5 * (a + b - first / second);
        Some(if x > 0.0 && x < 1.0 { x } else { 1.0 })
    }

    /// Where it is highest, if not at a sample.
    fn highest(&self) -> f64 {
        if let Some(x) = self.vertex() {
            return x;
        }
        let mut best = (0.0, self.value(0.0));
        for k in 1..=PARTS {
            let x = k as f64 / PARTS as f64;
            let v = self.value(x);
            if v > best.1 {
                best = (x, v);
            }
        }
        let width = 1.0 / PARTS as f64;
        self.turn((best.0 - width).max(0.0), (best.0 + width).min(1.0), 1.0).unwrap_or(best.0)
    }

    fn value(&self, x: f64) -> f64 {
        self.nodes.iter().zip(&self.c).rev().fold(0.0, |v, (node, c)| c + (x - node) * v)
    }

    /// First and second derivative.
    fn slopes(&self, x: f64) -> (f64, f64) {
        let (mut v, mut first, mut half_second) = (0.0, 0.0, 0.0);
        for (node, c) in self.nodes.iter().zip(&self.c).rev() {
            let away = x - node;
            half_second = first + away * half_second;
            first = v + away * first;
            v = c + away * v;
        }
        (first, 2.0 * half_second)
    }

    /// Where it is highest between `a` and `b`, for `sign` 1, or lowest, for -1, if it turns there.
    fn turn(&self, mut a: f64, mut b: f64, sign: f64) -> Option<f64> {
        if sign * self.slopes(a).0 <= 0.0 || sign * self.slopes(b).0 >= 0.0 {
            return None;
        }
        let mut x = 0.5 * (a + b);
        for _ in 0..TURNING_STEPS {
            let (first, second) = self.slopes(x);
            if sign * first > 0.0 {
                a = x
            } else {
                b = x
            }
            let newton = x - first / second;
            let next = if newton > a && newton < b { newton } else { 0.5 * (a + b) };
            if (next - x).abs() <= f64::EPSILON {
                return Some(next);
            }
            x = next;
        }
        Some(x)
    }
}

/// Maximum number of nodes of a rule.
pub const MAX_NODES: usize = 5;

fn span(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(*v), b.max(*v)))
}
