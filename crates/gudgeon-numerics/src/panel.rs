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
}

/// `(1 - sqrt(3/7)) / 2`.
const INNER: f64 = 0.172_673_164_646_011_43;

/// Five points of Lobatto: exact for the integral of polynomials to degree 7, and through any of degree 4, which dense output has.
pub const LOBATTO: Rule = Rule {
    nodes: &[0.0, INNER, 0.5, 1.0 - INNER, 1.0],
    weights: &[1.0 / 20.0, 49.0 / 180.0, 16.0 / 45.0, 49.0 / 180.0, 1.0 / 20.0],
    barycentric: &[7.0 / 8.0, -49.0 / 24.0, 7.0 / 3.0, -49.0 / 24.0, 7.0 / 8.0],
};

/// Both ends and a straight line between them.
pub const TRAPEZIUM: Rule = Rule { nodes: &[0.0, 1.0], weights: &[0.5, 0.5], barycentric: &[-1.0, 1.0] };

/// How far a polynomial through samples can rise above the highest of them, as a part of the range they span: half of the Lebesgue
/// constant of five points of Lobatto (1.636) less one.
const OVERSHOOT: f64 = 0.32;
/// Parts of a step in which turning points and crossings are looked for; a polynomial of degree 4 turns three times at most.
const PARTS: usize = 16;
/// Steps of golden section: from an eighth of the step to below its rounding in the value at a turning point.
const GOLDEN_STEPS: u32 = 38;
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

    /// Where the polynomial is highest, and its value there, when that is above `least`.
    #[must_use]
    pub fn highest(&self, values: &[f64], least: f64) -> Option<(f64, f64)> {
        let (low, high) = span(values);
        if high + OVERSHOOT * (high - low) <= least {
            return None;
        }
        let mut best = (0.0, values[0]);
        for k in 1..=PARTS {
            let x = k as f64 / PARTS as f64;
            let v = self.value(values, x);
            if v > best.1 {
                best = (x, v);
            }
        }
        let width = 1.0 / PARTS as f64;
        let turn = self.turn(values, ((best.0 - width).max(0.0), (best.0 + width).min(1.0)), 1.0);
        if turn.1 > best.1 {
            best = turn;
        }
        // A straight line or a jump: the samples themselves.
        for (x, v) in self.nodes.iter().zip(values) {
            if *v > best.1 {
                best = (*x, *v);
            }
        }
        (best.1 > least).then_some(best)
    }

    /// Where the polynomial is lowest, and its value there, when that is below `most`.
    #[must_use]
    pub fn lowest(&self, values: &[f64], most: f64) -> Option<(f64, f64)> {
        let mut turned = [0.0; MOST_NODES];
        for (t, v) in turned.iter_mut().zip(values) {
            *t = -v;
        }
        self.highest(&turned[..values.len()], -most).map(|(x, v)| (x, -v))
    }

    /// Calls `cross` at every place where the polynomial goes through `level`, in order, with whether it rises there.
    pub fn crossings(&self, values: &[f64], level: f64, mut cross: impl FnMut(f64, bool)) {
        let (low, high) = span(values);
        let reach = OVERSHOOT * (high - low);
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
        let at = |k: usize| self.value(values, k as f64 / PARTS as f64);
        let (mut sum, mut from) = (0.0, first);
        let (mut before, mut now) = (first, at(1));
        for k in 1..PARTS {
            let next = at(k + 1);
            if (now - before) * (next - now) <= 0.0 && now != before {
                let bracket = ((k - 1) as f64 / PARTS as f64, (k + 1) as f64 / PARTS as f64);
                let turn = self.turn(values, bracket, if now > before { 1.0 } else { -1.0 }).1;
                sum += (from - turn).max(0.0);
                from = turn;
            }
            (before, now) = (now, next);
        }
        sum + (from - last).max(0.0)
    }

    /// The extreme between `a` and `b`, the highest for `sign` 1, the lowest for -1, by golden section.
    fn turn(&self, values: &[f64], (mut a, mut b): (f64, f64), sign: f64) -> (f64, f64) {
        const RATIO: f64 = 0.618_033_988_749_894_8;
        let f = |x: f64| sign * self.value(values, x);
        let (mut c, mut d) = (b - RATIO * (b - a), a + RATIO * (b - a));
        let (mut fc, mut fd) = (f(c), f(d));
        for _ in 0..GOLDEN_STEPS {
            if fc > fd {
                (b, d, fd) = (d, c, fc);
                c = b - RATIO * (b - a);
                fc = f(c);
            } else {
                (a, c, fc) = (c, d, fd);
                d = a + RATIO * (b - a);
                fd = f(d);
            }
        }
        if fc > fd { (c, sign * fc) } else { (d, sign * fd) }
    }
}

/// Nodes of the largest rule.
pub const MOST_NODES: usize = 5;

fn span(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(*v), b.max(*v)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sampled(f: impl Fn(f64) -> f64) -> Vec<f64> {
        LOBATTO.nodes.iter().map(|x| f(*x)).collect()
    }

    #[test]
    fn integrates_degree_seven_and_interpolates_degree_four() {
        for degree in 0..=7 {
            let v = sampled(|x| x.powi(degree));
            // Rounding of five products of numbers below 1.
            assert!((LOBATTO.mean(&v) - 1.0 / f64::from(degree + 1)).abs() < 2e-15, "{degree}");
        }
        let p = |x: f64| 1.0 - 3.0 * x + x * x - 7.0 * x.powi(3) + 5.0 * x.powi(4);
        for k in 0..=100 {
            let x = f64::from(k) / 100.0;
            // Barycentric weights of the order of one: a few units of rounding of coefficients up to 7.
            assert!((LOBATTO.value(&sampled(p), x) - p(x)).abs() < 2e-14, "{x}");
        }
        assert_eq!(TRAPEZIUM.value(&[1.0, 3.0], 0.25), 1.5);
    }

    #[test]
    fn extremes_lie_between_the_samples() {
        // Turns at 0.3 and 0.83, between nodes.
        let p = |x: f64| x * (3.0 * 0.3 * 0.83 - 1.5 * (0.3 + 0.83) * x + x * x);
        let v = sampled(p);
        let (x, top) = LOBATTO.highest(&v, -1.0).expect("above");
        // A turning point is known to the root of the rounding of the value, the value to its rounding.
        assert!((x - 0.3).abs() < 1e-7 && (top - p(0.3)).abs() < 1e-15, "{x} {top}");
        let down: Vec<f64> = v.iter().map(|v| -v).collect();
        assert_eq!(LOBATTO.lowest(&down, 1.0), Some((x, -top)));
        // The end is lower than where it turns back up.
        assert_eq!(LOBATTO.lowest(&v, 1.0), Some((0.0, 0.0)));
        assert_eq!(LOBATTO.highest(&v, top + 1e-9), None);
        assert_eq!(TRAPEZIUM.highest(&[1.0, 4.0], 0.0), Some((1.0, 4.0)));
        assert_eq!(TRAPEZIUM.lowest(&[1.0, 4.0], 2.0), Some((0.0, 1.0)));
    }

    #[test]
    fn the_bound_that_spares_the_search_holds() {
        // The worst samples for the overshoot: both signs of the Lebesgue function.
        for bits in 0..32_u32 {
            let v: Vec<f64> = (0..5).map(|k| f64::from((bits >> k) & 1)).collect();
            let top = (0..=2000).map(|k| LOBATTO.value(&v, f64::from(k) / 2000.0)).fold(f64::MIN, f64::max);
            assert!(top <= 1.0 + OVERSHOOT, "{bits}: {top}");
        }
    }

    #[test]
    fn crossings_are_located_and_directed() {
        let p = |x: f64| (x - 0.2) * (x - 0.55) * (x - 0.9);
        let mut seen = Vec::new();
        LOBATTO.crossings(&sampled(p), 0.0, |x, up| seen.push((x, up)));
        assert_eq!(seen.iter().map(|s| s.1).collect::<Vec<_>>(), [true, false, true]);
        for ((x, _), root) in seen.iter().zip([0.2, 0.55, 0.9]) {
            // Rounding of the value, 1e-17, over its slope there, 0.1 or more.
            assert!((x - root).abs() < 1e-14, "{x}");
        }
        LOBATTO.crossings(&sampled(p), 1.0, |x, _| panic!("{x}"));
    }

    #[test]
    fn falls_add_up() {
        let p = |x: f64| x * (3.0 * 0.3 * 0.83 - 1.5 * (0.3 + 0.83) * x + x * x);
        // Rounding of values below 1.
        assert!((LOBATTO.fall(&sampled(p)) - (p(0.3) - p(0.83))).abs() < 1e-15);
        assert_eq!(LOBATTO.fall(&sampled(|x| x)), 0.0);
        assert_eq!(TRAPEZIUM.fall(&[3.0, 1.0]), 2.0);
    }
}
