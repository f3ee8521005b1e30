//! A function of a crank angle as short polynomials, for those who ask it a hundred thousand times.

use std::f64::consts::PI;

use gudgeon_numerics::linalg::{lu_factor, lu_solve};

/// Patches per turn: the functions of a crank vary over a tenth of a turn at the fastest.
const PER_TURN: usize = 512;
/// Coefficients of a patch.
const TERMS: usize = 7;
/// Points besides the nodes at which a polynomial must agree with its function, over the patch from -1 to 1.
const CHECKED: [f64; 3] = [-0.93, -0.27, 0.65];
/// By this part of the function's largest value.
const AGREE: f64 = 1e-13;

/// A periodic function; patches are made when they are first asked for. Where no polynomial agrees (a valve opens there), the function
/// itself answers.
#[derive(Debug, Clone)]
pub struct Patches {
    per_radian: f64,
    scale: f64,
    kinds: Vec<Kind>,
    terms: Vec<[f64; TERMS]>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Unknown,
    Smooth,
    Itself,
}

/// The nodes of a patch: those of Lobatto and Chebyshev, ends included.
fn node(i: usize) -> f64 {
    -(PI * i as f64 / (TERMS - 1) as f64).cos()
}

impl Patches {
    /// Of `f` with a period of `turns` turns.
    pub fn new(turns: usize, f: impl Fn(f64) -> f64) -> Self {
        let count = PER_TURN * turns.next_power_of_two();
        let period = 2.0 * PI * turns.next_power_of_two() as f64;
        let sampled = (0..64).map(|i| f(period * (f64::from(i) + 0.37) / 64.0).abs());
        Self {
            per_radian: count as f64 / period,
            scale: sampled.fold(0.0, f64::max),
            kinds: vec![Kind::Unknown; count],
            terms: vec![[0.0; TERMS]; count],
        }
    }

    /// Patch of an angle and the place in it, from -1 to 1.
    fn place(&self, at: f64) -> (usize, f64) {
        let u = at * self.per_radian;
        // The floor, which is no machine instruction everywhere.
        let i = u as i64 - i64::from(u < 0.0);
        ((i & (self.kinds.len() as i64 - 1)) as usize, 2.0 * (u - i as f64) - 1.0)
    }

    /// Value at an angle.
    pub fn value(&mut self, at: f64, f: impl Fn(f64) -> f64) -> f64 {
        let (i, t) = self.place(at);
        match self.kinds[i] {
            Kind::Smooth => value(&self.terms[i], t),
            Kind::Itself => f(at),
            Kind::Unknown => {
                self.make(i, &f);
                f(at)
            }
        }
    }

    /// Derivative by the angle; that of a polynomial near the function even where it is not smooth.
    pub fn slope(&mut self, at: f64, f: impl Fn(f64) -> f64) -> f64 {
        let (i, t) = self.place(at);
        if self.kinds[i] == Kind::Unknown {
            self.make(i, &f);
        }
        2.0 * self.per_radian * slope(&self.terms[i], t)
    }

    fn make(&mut self, i: usize, f: &impl Fn(f64) -> f64) {
        let angle = |t: f64| (i as f64 + 0.5 * (t + 1.0)) / self.per_radian;
        let mut matrix = [0.0; TERMS * TERMS];
        let mut terms = [0.0; TERMS];
        for r in 0..TERMS {
            terms[r] = f(angle(node(r)));
            for c in 0..TERMS {
                matrix[r * TERMS + c] = node(r).powi(c as i32);
            }
        }
        let mut pivots = [0; TERMS];
        let solved = lu_factor(&mut matrix, TERMS, &mut pivots).is_ok();
        if solved {
            lu_solve(&matrix, TERMS, &pivots, &mut terms);
        }
        self.terms[i] = terms;
        let agrees = CHECKED.iter().all(|t| (value(&terms, *t) - f(angle(*t))).abs() <= AGREE * self.scale);
        self.kinds[i] = if solved && agrees { Kind::Smooth } else { Kind::Itself };
    }
}

fn value(c: &[f64; TERMS], t: f64) -> f64 {
    let s = t * t;
    // Two short sums that do not wait for each other.
    let even = c[0] + s * (c[2] + s * (c[4] + s * c[6]));
    let odd = c[1] + s * (c[3] + s * c[5]);
    even + t * odd
}

fn slope(c: &[f64; TERMS], t: f64) -> f64 {
    (1..TERMS).rev().fold(0.0, |sum, k| sum * t + k as f64 * c[k])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_function_with_a_corner_is_itself_there_and_a_polynomial_elsewhere() {
        // Smooth but for a corner at 1.234, period two turns.
        let f = |a: f64| {
            let a = a.rem_euclid(4.0 * PI);
            1e4 * ((0.5 * a).sin() / (1.2 + a.cos()) + 0.1 * (a - 1.234).max(0.0) * (4.0 * PI - a))
        };
        let mut p = Patches::new(2, f);
        for k in 0..40_000 {
            let at = -20.0 + 0.001 * f64::from(k);
            // Twice: the patch is made first, and used then.
            p.value(at, f);
            let error = (p.value(at, f) - f(at)).abs();
            // What a patch promises, and the rounding of the angle by a slope of 2e4 per radian.
            assert!(error < 1.5 * AGREE * p.scale + 2e4 * 4e-15, "{at}: {error:e}");
        }
        let itself = p.kinds.iter().filter(|k| **k == Kind::Itself).count();
        // The corner and the jump of the slope where the period ends, which touch two patches each at most.
        assert!((1..=4).contains(&itself), "{itself}");
        // The derivative of sin(a/2)/(1.2 + cos a) at 0.5 in closed form; interpolation loses the sixth power of the patch.
        let exact = 1e4
            * (0.5 * 0.25_f64.cos() / (1.2 + 0.5_f64.cos())
                + 0.25_f64.sin() * 0.5_f64.sin() / (1.2 + 0.5_f64.cos()).powi(2));
        assert!((p.slope(0.5, f) / exact - 1.0).abs() < 1e-9);
    }
}
