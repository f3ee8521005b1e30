//! The size of the first step.

use super::core::Core;
use super::options::{Options, Stats};
use super::system::OdeSystem;
use crate::elementary;

/// A first step from the sizes of the solution and its first two derivatives (Hairer, Nørsett and Wanner 1993, section II.4), at most `span`.
pub(super) fn first_step<S: OdeSystem + ?Sized>(
    c: &mut Core,
    sys: &mut S,
    t: f64,
    span: f64,
    o: &Options,
    stats: &mut Stats,
) -> f64 {
    let (n, k) = (c.n, if o.atol_quad.is_empty() { c.n } else { c.m });
    c.set_tolerances(sys, t, o);
    c.x1.copy_from_slice(&c.x0);
    let (mut d0, mut d1) = (0.0_f64, 0.0_f64);
    for i in 0..k {
        let s = c.scale(o, i).max(f64::MIN_POSITIVE);
        d0 = d0.max((c.x0[i] / s).abs());
        d1 = d1.max((c.f0[i] / s).abs());
    }
    let mut h0 = if d0 < 1e-5 || d1 < 1e-5 / span { 1e-6 * span } else { 0.01 * d0 / d1 };
    h0 = h0.min(span);
    // Until the right-hand side accepts the point of an explicit step.
    for _ in 0..8 {
        for i in 0..n {
            c.y_tmp[i] = c.x0[i] + h0 * c.f0[i];
        }
        let te = c.clamp_time(t + h0);
        if Core::checked_rhs(sys, te, &c.y_tmp[..n], &mut c.f_tmp, stats).is_ok() {
            let mut d2 = 0.0_f64;
            for i in 0..k {
                let s = c.scale(o, i).max(f64::MIN_POSITIVE);
                d2 = d2.max(((c.f_tmp[i] - c.f0[i]) / (s * h0)).abs());
            }
            return (100.0 * h0).min(from_derivatives(d1, d2, h0, span)).min(span);
        }
        h0 *= 0.1;
    }
    h0
}

/// The step for scaled derivatives `d1` (1/time) and `d2` (1/time²): the error of a first-order step of size h is about h² d2.
fn from_derivatives(d1: f64, d2: f64, h0: f64, span: f64) -> f64 {
    if d1 <= 1e-15 / span && d2 <= 1e-15 / (span * span) {
        return 1e-3 * span;
    }
    let a = if d1 > 0.0 { 0.01 / d1 } else { span };
    let b = if d2 > 0.0 { (0.01 / d2).sqrt() } else { span };
    // The methods here are of order 5: the higher derivatives are guessed from these two.
    a.min(b).max(elementary::powf(a.min(b), 0.4) * elementary::powf(h0, 0.6).min(span))
}
