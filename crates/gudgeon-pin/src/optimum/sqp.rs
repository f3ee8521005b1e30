//! Sequential quadratic programming with exact second derivatives.

use gudgeon_core::kinds::{PIN_QUANTITIES, PinSize};
use gudgeon_numerics::qp::{self, Minimum, QpError, VARIABLES};

use super::conditions::conditions;
use super::program::{CONSTRAINTS, Expansion, Linearised, Multipliers, Program};
use super::result::{KKT_TOLERANCE, NoOptimum, Optimum};
use crate::design::Design;

/// Maximum number of quadratic programs.
const MAX_STEPS: u32 = 80;
/// Step by the largest outer diameter below which no number changes for the better.
const UNMOVED: f64 = 4.0 * f64::EPSILON;

/// The local optimum that is reached from a pin.
pub fn local_optimum(d: &Design<'_>, from: PinSize) -> Result<Optimum, NoOptimum> {
    let p = Program::new(d);
    let mut x = p.point_within_ranges(&from);
    let mut at = Expansion::default();
    p.expand(&x, &mut at).map_err(NoOptimum::Model)?;
    let mut mu = [0.0; CONSTRAINTS];
    let (mut iterations, mut settled) = (0, false);
    // The last step is at rounding: its multipliers belong to this very point.
    while iterations < MAX_STEPS && !settled {
        iterations += 1;
        let mut rows = Linearised::new(&p, &at, &x);
        let w = p.lagrangian_hessian(&at, &mu);
        let gradient = p.free(&at.mass.g);
        let Some(mut step) = step(&w, &gradient, &mut rows, &mu) else { break };
        mu = rows.multipliers(&step);
        if iterations == 1 {
            // Without multipliers the curvature of the limits is not in the first program: it is solved again with those that it gave.
            let w = p.lagrangian_hessian(&at, &mu);
            if let Some(again) = self::step(&w, &gradient, &mut rows, &mu) {
                mu = rows.multipliers(&again);
                step = again;
            }
        }
        let length = length(&step.x);
        if length < UNMOVED {
            break;
        }
        if !line_search(&p, (&mut x, &mut at), (&step.x, length), &mu) {
            break;
        }
        settled = length < 1e-13;
    }
    judged(d, conditions(&p, &x, &at, &mu, iterations).map_err(NoOptimum::Model)?)
}

fn length(step: &[f64; 3]) -> f64 {
    step.iter().fold(0.0, |a: f64, b| a.max(b.abs()))
}

/// Goes to the point along a step of some length at which mass and violations together are smaller, and expands there; false where there is none.
fn line_search(
    p: &Program<'_, '_>,
    (x, at): (&mut [f64; 3], &mut Expansion),
    (step, length): (&[f64; 3], f64),
    mu: &Multipliers,
) -> bool {
    let weight = 2.0 * mu[..PIN_QUANTITIES].iter().fold(1.0, |a: f64, b| a.max(*b));
    let before = p.merit_of(at, weight);
    let mut scale = 1.0;
    loop {
        let y = p.moved(x, scale, step);
        // Close by, rounding decides the merit; Newton's step is right without it.
        let accepted =
            length < 1e-6 || p.merit(&y, weight).is_some_and(|merit| merit < before || !before.is_finite());
        if accepted && p.expand(&y, at).is_ok() {
            *x = y;
            return true;
        }
        scale *= 0.5;
        if scale * length < 1e-16 || scale < 1e-12 {
            return false;
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
    let [h, inverse] = convexified(w, c, mu)?;
    // What held the point before will mostly hold it again.
    let mut guess = [0; VARIABLES];
    let mut held = 0;
    for (row, _) in c.place[..c.n].iter().enumerate().filter(|(_, place)| mu[**place] > 0.0).take(VARIABLES) {
        guess[held] = row;
        held += 1;
    }
    let rows = &mut c.rows[..c.n];
    for part in [1.0, 0.5, 0.2, 0.05, 0.0] {
        if part < 1.0 {
            for r in rows.iter_mut().filter(|r| r.b < 0.0) {
                r.b *= part;
            }
        }
        match qp::minimise_near((&h, &inverse), g, rows, &guess[..held]) {
            Ok(m) => return Some(m),
            Err(QpError::NotConvex) => return None,
            Err(QpError::Infeasible | QpError::Stalled) => {}
        }
    }
    None
}

/// The Hessian, or the first of its positive definite modifications, and its inverse.
fn convexified(w: &[[f64; 3]; 3], c: &Linearised, mu: &Multipliers) -> Option<[[[f64; 3]; 3]; 2]> {
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
        .find_map(|h| Some([h, qp::inverse(&h)?]))
}

fn modified(w: &[[f64; 3]; 3], c: &Linearised, mu: &Multipliers, weight: f64, shift: f64) -> [[f64; 3]; 3] {
    let mut h = *w;
    for (r, k) in c.rows[..c.n].iter().zip(&c.place).filter(|_| weight > 0.0) {
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
