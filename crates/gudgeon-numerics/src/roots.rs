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
    /// What the derivative is expected to be there beyond the part that the function tells; none: unknown.
    pub rest: Option<f64>,
    /// Longest step.
    pub reach: f64,
    /// Error admitted.
    pub tol: f64,
}

/// A root, and what is known of the derivative there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Found {
    /// The root, within the error admitted. So is where the function was evaluated last.
    pub x: f64,
    /// The derivative beyond the part that the function tells, for the next search; none where it is not known.
    pub rest: Option<f64>,
}

/// Steps of the secant method before a search begins anew with a bracket.
const SECANTS: usize = 6;
/// Steps of the walk to a bracket, and within it.
const WALK: usize = 200;

/// A root of a function that rises through it, by secants from a guess; the first one beyond [`Known::from`] where they fail.
///
/// Made for functions that are solved again and again with little changed: one to three evaluations as a rule. The function tells its value and what it knows of its
/// derivative, the part that changes most; secants find the rest, which is taken over from one search to the next. What the function leaves behind at its last evaluation belongs to a
/// point that is the root within the error admitted; the root itself is one step nearer.
///
/// # Errors
/// [`RootError::NoConvergence`]; the function's own errors come back as [`RootError::Function`].
pub fn first_root<E>(
    mut f: impl FnMut(f64) -> Result<(f64, f64), E>,
    known: Known,
) -> Result<Found, RootError<E>> {
    let mut look = |x: f64| {
        let (f, told) = f(x).map_err(RootError::Function)?;
        Ok(Look { x, f, told })
    };
    if let Some(found) = secants(&mut look, known)? {
        return Ok(found);
    }
    let (from, to) = walk(&mut look, known)?;
    between(&mut look, from, to, known.tol)
}

/// A function at a point, and the part of its derivative that it tells.
#[derive(Debug, Clone, Copy)]
struct Look {
    x: f64,
    f: f64,
    told: f64,
}

impl Look {
    /// The derivative between here and another point.
    fn secant(&self, to: &Self) -> f64 {
        (to.f - self.f) / (to.x - self.x)
    }

    /// What the function does not tell of its derivative between here and another point, the secant of which is that of the middle; none where it does not rise.
    fn rest(&self, to: &Self) -> Option<f64> {
        let slope = self.secant(to);
        (slope > 0.0).then_some(slope - 0.5 * (self.told + to.told))
    }
}

/// The root by secants from the guess, if they settle.
fn secants<E>(
    look: &mut impl FnMut(f64) -> Result<Look, RootError<E>>,
    known: Known,
) -> Result<Option<Found>, RootError<E>> {
    let Some(mut rest) = known.rest else { return Ok(None) };
    let (mut x, mut before) = (known.guess, None::<Look>);
    for _ in 0..=SECANTS {
        let at = look(x)?;
        if let Some(before) = before {
            let Some(seen) = before.rest(&at) else { return Ok(None) };
            rest = seen;
        }
        let slope = at.told + rest;
        let step = -at.f / slope;
        if slope <= 0.0 || step.is_nan() || step.abs() > known.reach {
            return Ok(None);
        }
        x = at.x + step;
        if step.abs() <= known.tol {
            return Ok(Some(Found { x, rest: Some(rest) }));
        }
        before = Some(at);
    }
    Ok(None)
}

/// Two points beside each other, from `known.from` on in the direction in which the function asks to go, between which it changes its sign.
fn walk<E>(
    look: &mut impl FnMut(f64) -> Result<Look, RootError<E>>,
    known: Known,
) -> Result<(Look, Look), RootError<E>> {
    let mut last = look(known.from)?;
    if last.f == 0.0 {
        return Ok((last, last));
    }
    let away = -last.f.signum();
    let slope = known.rest.map_or(0.0, |rest| last.told + rest);
    let mut stride = if slope > 0.0 { (last.f / slope).abs() } else { last.f.abs() };
    for _ in 0..WALK {
        let step = stride.clamp(known.tol, known.reach);
        let next = look(last.x + away * step)?;
        if next.f * last.f <= 0.0 {
            return Ok((last, next));
        }
        let slope = last.secant(&next);
        let newton = if slope > 0.0 { 1.1 * (next.f / slope).abs() } else { f64::INFINITY };
        (stride, last) = (newton.min(4.0 * step), next);
    }
    Err(RootError::NoConvergence { iterations: WALK as u32, lo: known.from, hi: last.x })
}

/// The root between two points of different sign: false position with halved weights (Illinois), every fourth step a bisection.
fn between<E>(
    look: &mut impl FnMut(f64) -> Result<Look, RootError<E>>,
    mut a: Look,
    mut b: Look,
    tol: f64,
) -> Result<Found, RootError<E>> {
    if b.f == 0.0 {
        return Ok(Found { x: b.x, rest: a.rest(&b) });
    }
    for k in 1..=WALK {
        let (was, span) = (b, b.x - a.x);
        let secant = a.x - a.f * span / (b.f - a.f);
        b = look(if k.is_multiple_of(4) { a.x + 0.5 * span } else { secant })?;
        if b.f * was.f < 0.0 {
            a = was;
        } else {
            a.f *= 0.5;
        }
        if b.f == 0.0 || (b.x - a.x).abs() <= tol {
            return Ok(Found { x: b.x, rest: was.rest(&b) });
        }
    }
    Err(RootError::NoConvergence { iterations: WALK as u32, lo: a.x, hi: b.x })
}
