//! Roots of scalar functions: bracketed, safeguarded, with their iteration counts.

use crate::elementary;
use std::convert::Infallible;

/// Why a root was not returned.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum RootError<E = Infallible> {
    /// The function has the same sign at both ends.
    #[error("no sign change: f({lo}) = {f_lo}, f({hi}) = {f_hi}")]
    NoBracket {
        /// Lower end.
        lo: f64,
        /// Upper end.
        hi: f64,
        /// Value at the lower end.
        f_lo: f64,
        /// Value at the upper end.
        f_hi: f64,
    },
    /// The function returned a NaN.
    #[error("not a number at {x}")]
    NotANumber {
        /// Where.
        x: f64,
    },
    /// The iteration limit was reached; only possible when the function is not a function (depends on hidden state).
    #[error("no convergence after {iterations} iterations, bracket [{lo}, {hi}]")]
    NoConvergence {
        /// Iterations done.
        iterations: u32,
        /// Lower end of what is left.
        lo: f64,
        /// Upper end of what is left.
        hi: f64,
    },
    /// The function itself failed.
    #[error("the function failed: {0}")]
    Function(E),
}

/// A root and what it cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Root {
    /// The root.
    pub x: f64,
    /// The other end of the final bracket (for [`newton_bracketed`]: the end on the far side of `x`).
    pub other: f64,
    /// Function evaluations, those at the ends included.
    pub evaluations: u32,
}

/// Root of a continuous `f` in `[lo, hi]` by the interpolate–truncate–project method (Oliveira & Takahashi 2021): never more
/// than one evaluation beyond bisection, superlinear on smooth functions.
///
/// The answer's bracket is at most `tol` wide; `x` is the end with the sign of `f(hi)` (so an event located in time is
/// never returned before it happened).
///
/// # Errors
/// [`RootError`]; the function's own errors come back as [`RootError::Function`].
pub fn itp<E>(
    mut f: impl FnMut(f64) -> Result<f64, E>,
    lo: f64,
    hi: f64,
    tol: f64,
) -> Result<Root, RootError<E>> {
    let mut eval = |x: f64| -> Result<f64, RootError<E>> {
        let v = f(x).map_err(RootError::Function)?;
        if v.is_nan() { Err(RootError::NotANumber { x }) } else { Ok(v) }
    };
    let (mut a, mut b) = (lo, hi);
    let (fa0, fb0) = (eval(a)?, eval(b)?);
    if fb0 == 0.0 && fa0 != 0.0 {
        // A zero at the upper end still needs the first one inside: only an exact answer when f(lo) has a sign.
        return Ok(Root { x: b, other: a, evaluations: 2 });
    }
    if fa0 == 0.0 {
        return Ok(Root { x: a, other: a, evaluations: 2 });
    }
    if (fa0 > 0.0) == (fb0 > 0.0) {
        return Err(RootError::NoBracket { lo, hi, f_lo: fa0, f_hi: fb0 });
    }
    // Work with an increasing function: sign * f.
    let sign = if fb0 > 0.0 { 1.0 } else { -1.0 };
    let (mut fa, mut fb) = (sign * fa0, sign * fb0);
    let mut evaluations = 2;
    let half_tol = (0.5 * tol).max(f64::EPSILON * a.abs().max(b.abs()) * 0.5).max(f64::MIN_POSITIVE);
    let n_half = elementary::log2((b - a) / (2.0 * half_tol)).ceil().max(0.0);
    let n_max = n_half + 1.0;
    let kappa1 = 0.2 / (b - a);
    let mut j = 0;
    // Bisection needs n_half <= 1100 halvings for any pair of doubles.
    while b - a > 2.0 * half_tol {
        if j > 1200 {
            return Err(RootError::NoConvergence { iterations: j, lo: a, hi: b });
        }
        let mid = 0.5 * (a + b);
        let r = half_tol * elementary::exp2(n_max - f64::from(j)) - 0.5 * (b - a);
        let delta = kappa1 * (b - a) * (b - a);
        let x_f = (fb * a - fa * b) / (fb - fa);
        let s = if mid >= x_f { 1.0 } else { -1.0 };
        let x_t = if delta <= (mid - x_f).abs() { x_f + s * delta } else { mid };
        let x = if (x_t - mid).abs() <= r { x_t } else { mid - s * r };
        // Rounding may push the trial point onto an end.
        let x = if x > a && x < b { x } else { mid };
        if !(x > a && x < b) {
            break;
        }
        let fx = sign * eval(x)?;
        evaluations += 1;
        if fx >= 0.0 {
            b = x;
            fb = fx;
            if fx == 0.0 {
                break;
            }
        } else {
            a = x;
            fa = fx;
        }
        j += 1;
    }
    Ok(Root { x: b, other: a, evaluations })
}

/// Newton's method kept inside a bracket: a step that leaves the bracket, or that shrinks it too slowly, becomes a bisection.
///
/// `f` returns value and derivative; `f(lo)` and `f(hi)` must differ in sign (they are not evaluated unless Newton leaves the
/// bracket: with a good start `x0` the cost is 2 to 3 evaluations). Converged when the Newton step is at most `tol`.
///
/// # Errors
/// [`RootError`]; the function's own errors come back as [`RootError::Function`].
pub fn newton_bracketed<E>(
    mut f: impl FnMut(f64) -> Result<(f64, f64), E>,
    lo: f64,
    hi: f64,
    x0: f64,
    tol: f64,
) -> Result<Root, RootError<E>> {
    let (mut a, mut b) = (lo.min(hi), lo.max(hi));
    let mut x = if x0 >= a && x0 <= b { x0 } else { 0.5 * (a + b) };
    // Sign of f at the lower end, once known.
    let mut sign_a: Option<f64> = None;
    let mut width = b - a;
    let mut evaluations = 0;
    loop {
        let (v, derivative) = f(x).map_err(RootError::Function)?;
        evaluations += 1;
        if v.is_nan() {
            return Err(RootError::NotANumber { x });
        }
        if v == 0.0 {
            return Ok(Root { x, other: x, evaluations });
        }
        let step = -v / derivative;
        let trial = x + step;
        let inside = trial.is_finite() && trial > a && trial < b;
        if inside && step.abs() <= tol {
            return Ok(Root { x: trial, other: x, evaluations });
        }
        if sign_a.is_none() && !(inside && evaluations <= 2) {
            let (va, _) = f(a).map_err(RootError::Function)?;
            let (vb, _) = f(b).map_err(RootError::Function)?;
            evaluations += 2;
            for (e, ve) in [(a, va), (b, vb)] {
                if ve.is_nan() {
                    return Err(RootError::NotANumber { x: e });
                }
                if ve == 0.0 {
                    return Ok(Root { x: e, other: e, evaluations });
                }
            }
            if (va > 0.0) == (vb > 0.0) {
                return Err(RootError::NoBracket { lo: a, hi: b, f_lo: va, f_hi: vb });
            }
            sign_a = Some(va.signum());
        }
        if let Some(s) = sign_a {
            if v.signum() == s {
                a = x;
            } else {
                b = x;
            }
            if b - a <= tol || !(0.5 * (a + b) > a && 0.5 * (a + b) < b) {
                return Ok(Root { x: 0.5 * (a + b), other: b, evaluations });
            }
            let slow = evaluations % 3 == 0 && {
                let slow = b - a > 0.5 * width;
                width = b - a;
                slow
            };
            x = if trial > a && trial < b && !slow { trial } else { 0.5 * (a + b) };
        } else {
            x = trial;
        }
        if evaluations > 300 {
            return Err(RootError::NoConvergence { iterations: evaluations, lo: a, hi: b });
        }
    }
}

/// What [`first_root`] knows of its function before it begins, and what it is asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Known {
    /// Where the search begins if a local one fails: the root that is found then is the first one from here on.
    pub from: f64,
    /// Where the root is expected.
    pub guess: f64,
    /// Derivative expected there; zero or less: unknown.
    pub slope: f64,
    /// Longest step.
    pub reach: f64,
    /// Error admitted.
    pub tol: f64,
}

/// A root at which the function was evaluated last, and its derivative there by differences.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Found {
    /// The root, within the error admitted.
    pub x: f64,
    /// The derivative.
    pub slope: f64,
}

/// Steps of the secant method before a search begins anew with a bracket.
const SECANTS: usize = 6;
/// Part of the error admitted within which a step by a derivative from before ends at the root.
const STALE: f64 = 0.1;
/// Steps of the walk to a bracket, and within it.
const WALK: usize = 200;

/// A root of a function that rises through it, by secants from a guess; the first one beyond [`Known::from`] where they fail.
///
/// Made for functions that are solved again and again with little changed: two to three evaluations as a rule. The function is evaluated at the answer
/// last, so that what it leaves behind belongs to the answer.
///
/// # Errors
/// [`RootError::NoConvergence`]; the function's own errors come back as [`RootError::Function`].
pub fn first_root<E>(mut f: impl FnMut(f64) -> Result<f64, E>, known: Known) -> Result<Found, RootError<E>> {
    let mut eval = |x: f64| f(x).map_err(RootError::Function);
    if let Some(found) = secants(&mut eval, known)? {
        return Ok(found);
    }
    let (lo, hi) = walk(&mut eval, known)?;
    between(&mut eval, lo, hi, known.tol)
}

/// The root by secants from the guess, if they settle.
fn secants<E>(
    eval: &mut impl FnMut(f64) -> Result<f64, RootError<E>>,
    known: Known,
) -> Result<Option<Found>, RootError<E>> {
    if known.slope <= 0.0 {
        return Ok(None);
    }
    let (mut x, mut slope) = (known.guess, known.slope);
    let mut fx = eval(x)?;
    for k in 0..SECANTS {
        let step = -fx / slope;
        if step.abs() <= if k == 0 { STALE * known.tol } else { known.tol } {
            return Ok(Some(Found { x, slope }));
        }
        if step.is_nan() || step.abs() > known.reach {
            return Ok(None);
        }
        let next = x + step;
        let fnext = eval(next)?;
        let seen = (fnext - fx) / (next - x);
        (x, fx) = (next, fnext);
        if seen.is_nan() || seen <= 0.0 {
            return Ok(None);
        }
        slope = seen;
    }
    Ok(None)
}

/// Two points beside each other, from `known.from` on in the direction in which the function asks to go, between which it changes its sign.
fn walk<E>(
    eval: &mut impl FnMut(f64) -> Result<f64, RootError<E>>,
    known: Known,
) -> Result<([f64; 2], [f64; 2]), RootError<E>> {
    let mut last = [known.from, eval(known.from)?];
    if last[1] == 0.0 {
        return Ok((last, last));
    }
    let away = -last[1].signum();
    let mut stride = if known.slope > 0.0 { (last[1] / known.slope).abs() } else { last[1].abs() };
    for _ in 0..WALK {
        let step = stride.clamp(known.tol, known.reach);
        let x = last[0] + away * step;
        let next = [x, eval(x)?];
        if next[1] * last[1] <= 0.0 {
            return Ok((last, next));
        }
        let slope = (next[1] - last[1]) / (next[0] - last[0]);
        let newton = if slope > 0.0 { 1.1 * (next[1] / slope).abs() } else { f64::INFINITY };
        (stride, last) = (newton.min(4.0 * step), next);
    }
    Err(RootError::NoConvergence { iterations: WALK as u32, lo: known.from, hi: last[0] })
}

/// The root between two points of different sign: false position with halved weights (Illinois), every fourth step a bisection.
fn between<E>(
    eval: &mut impl FnMut(f64) -> Result<f64, RootError<E>>,
    mut a: [f64; 2],
    mut b: [f64; 2],
    tol: f64,
) -> Result<Found, RootError<E>> {
    let slope = |a: [f64; 2], b: [f64; 2]| ((b[1] - a[1]) / (b[0] - a[0])).max(0.0);
    if b[1] == 0.0 {
        return Ok(Found { x: b[0], slope: slope(a, b) });
    }
    for k in 1..=WALK {
        let (was, span) = (b, b[0] - a[0]);
        let secant = a[0] - a[1] * span / (b[1] - a[1]);
        let x = if k.is_multiple_of(4) { a[0] + 0.5 * span } else { secant };
        let next = [x, eval(x)?];
        let steep = slope(was, next);
        if next[1] * b[1] < 0.0 {
            a = b;
        } else {
            a[1] *= 0.5;
        }
        b = next;
        if b[1] == 0.0 || (b[0] - a[0]).abs() <= tol {
            return Ok(Found { x, slope: steep });
        }
    }
    Err(RootError::NoConvergence { iterations: WALK as u32, lo: a[0], hi: b[0] })
}
