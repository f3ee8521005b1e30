//! Sequential quadratic programming with exact second derivatives.

use gudgeon_core::kinds::{PIN_QUANTITIES, PinSize};
use gudgeon_numerics::qp::{self, Minimum, QpError};

use super::conditions::conditions;
use super::program::{CONSTRAINTS, Expansion, Linearised, Multipliers, Program};
use super::result::{KKT_TOLERANCE, NoOptimum, Optimum};
use crate::design::Design;

/// Maximum number of quadratic programs.
const MAX_STEPS: u32 = 80;

/// The local optimum that is reached from a pin.
pub fn local_optimum(d: &Design<'_>, from: PinSize) -> Result<Optimum, NoOptimum> {
    let p = Program::new(d);
    let mut x = p.point_within_ranges(&from);
    let mut at = p.expansion(&x).map_err(NoOptimum::Model)?;
    let mut mu = [0.0; CONSTRAINTS];
    let (mut iterations, mut settled) = (0, false);
    // The last step is at rounding: its multipliers belong to this very point.
    while iterations < MAX_STEPS && !settled {
        iterations += 1;
        let mut rows = Linearised::new(&p, &at, &x);
        let w = p.lagrangian_hessian(&at, &mu);
        let Some(step) = step(&w, &p.free(&at.mass.g), &mut rows, &mu) else { break };
        mu = rows.multipliers(&step);
        let Some(next) = line_search(&p, &x, &step.x, &mu) else { break };
        (x, at) = next;
        settled = length(&step.x) < 1e-13;
    }
    judged(d, conditions(&p, &x, &at, &mu, iterations).map_err(NoOptimum::Model)?)
}

fn length(step: &[f64; 3]) -> f64 {
    step.iter().fold(0.0, |a: f64, b| a.max(b.abs()))
}

/// The point along a step at which mass and violations together are smaller, with its expansion.
fn line_search(
    p: &Program<'_, '_>,
    x: &[f64; 3],
    step: &[f64; 3],
    mu: &Multipliers,
) -> Option<([f64; 3], Expansion)> {
    let weight = 2.0 * mu[..PIN_QUANTITIES].iter().fold(1.0, |a: f64, b| a.max(*b));
    let length = length(step);
    let before = p.merit(x, weight);
    let mut scale = 1.0;
    loop {
        let y = p.moved(x, scale, step);
        // Close by, rounding decides the merit; Newton's step is right without it.
        let accepted = length < 1e-6
            || match (p.merit(&y, weight), before) {
                (Some(a), Some(b)) => a < b,
                (Some(_), None) => true,
                (None, _) => false,
            };
        if accepted && let Ok(e) = p.expansion(&y) {
            return Some((y, e));
        }
        scale *= 0.5;
        if scale * length < 1e-16 || scale < 1e-12 {
            return None;
        }
    }
}

/// An optimum whose conditions hold; else why there is none.
fn judged(d: &Design<'_>, o: Optimum) -> Result<Optimum, NoOptimum> {
    if o.kkt.hold(KKT_TOLERANCE) {
        return Ok(o);
    }
    let blocking =
        if d.min_feasible_outer().is_none() { d.blocking_limits(d.outer.high) } else { Vec::new() };
    Err(if blocking.is_empty() { NoOptimum::Unproven(Box::new(o)) } else { NoOptimum::Infeasible(blocking) })
}

/// The step of the quadratic program. Its Hessian is made positive definite first along the normals of the limits that hold the point,
/// which leaves the step as it is, then in all directions; contradicting limits are approached by parts.
fn step(w: &[[f64; 3]; 3], g: &[f64; 3], c: &mut Linearised, mu: &Multipliers) -> Option<Minimum> {
    let h = convexified(w, c, mu)?;
    let rows = &mut c.rows[..c.n];
    for part in [1.0, 0.5, 0.2, 0.05, 0.0] {
        if part < 1.0 {
            for r in rows.iter_mut().filter(|r| r.b < 0.0) {
                r.b *= part;
            }
        }
        match qp::minimise(&h, g, rows) {
            Ok(m) => return Some(m),
            Err(QpError::NotConvex) => return None,
            Err(QpError::Infeasible | QpError::Stalled) => {}
        }
    }
    None
}

/// The Hessian, or the first of its positive definite modifications.
fn convexified(w: &[[f64; 3]; 3], c: &Linearised, mu: &Multipliers) -> Option<[[f64; 3]; 3]> {
    let size = w.iter().flatten().fold(1e-12, |a: f64, b| a.max(b.abs()));
    // Weight of the active normals, shift of the diagonal.
    let modifications = [
        (0.0, 0.0),
        (2.0 * size, 0.0),
        (10.0 * size, 0.0),
        (10.0 * size, 0.1 * size),
        (10.0 * size, size),
        (0.0, 4.0 * size),
        (0.0, 40.0 * size),
    ];
    modifications
        .into_iter()
        .map(|(weight, shift)| modified(w, c, mu, weight, shift))
        .find(|h| qp::inverse(h).is_some())
}

fn modified(w: &[[f64; 3]; 3], c: &Linearised, mu: &Multipliers, weight: f64, shift: f64) -> [[f64; 3]; 3] {
    let mut h = *w;
    for (r, k) in c.rows[..c.n].iter().zip(&c.place) {
        let norm: f64 = r.a.iter().map(|a| a * a).sum();
        if mu[*k] > 0.0 && norm > 0.0 {
            for i in 0..3 {
                for j in 0..3 {
                    h[i][j] += weight * r.a[i] * r.a[j] / norm;
                }
            }
        }
    }
    for (i, row) in h.iter_mut().enumerate() {
        row[i] += shift;
    }
    h
}
