use std::f64::consts::PI;

use gudgeon_core::kinds::Kinematics;

/// Crank angles of a turn: prime, so that none is special but 0.
const ANGLES: u32 = 359;
/// Half the step of the difference quotients \[rad\].
const STEP: f64 = 1e-4;
/// Part of the largest velocity or acceleration by which a difference quotient may differ: the square of the step, times some harmonics, and the
/// rounding of a height over it.
const QUOTIENT: f64 = 1e-6;

/// Complaints about a running kinematics model, over a turn:
///
/// - motion that is not finite or does not repeat after 2π;
/// - a velocity that is not the derivative of the height, an acceleration that is not that of the velocity;
/// - a height above [`Kinematics::y_tdc`], and heights whose span is not [`Kinematics::stroke`].
#[must_use]
pub fn kinematics(model: &dyn Kinematics) -> Vec<String> {
    let (top, stroke, omega) = (model.y_tdc(), model.stroke(), model.omega());
    if ![top, stroke, omega].iter().all(|v| v.is_finite()) || stroke <= 0.0 {
        return vec![format!("top dead centre at {top} m, stroke {stroke} m, {omega} rad/s")];
    }
    let angles: Vec<f64> = (0..ANGLES).map(|k| 2.0 * PI * f64::from(k) / f64::from(ANGLES)).collect();
    let motions: Vec<_> = angles.iter().map(|t| model.motion(*t)).collect();
    let largest = |f: &dyn Fn(usize) -> f64| (0..angles.len()).map(|k| f(k).abs()).fold(0.0, f64::max);
    let (v_max, a_max) = (largest(&|k| motions[k].v), largest(&|k| motions[k].a));
    let mut wrong = Vec::new();
    for (theta, m) in angles.iter().zip(&motions) {
        if ![m.y, m.v, m.a, m.rod_angle].iter().all(|v| v.is_finite()) {
            wrong.push(format!("{m:?} at {theta} rad"));
            continue;
        }
        let later = model.motion(theta + 2.0 * PI);
        // The angle itself is rounded, by 1e-15.
        if (later.y - m.y).abs() > 1e-12 * stroke
            || (later.v - m.v).abs() > 1e-12 * v_max.max(f64::MIN_POSITIVE)
        {
            wrong.push(format!("a turn after {theta} rad the motion is {later:?}, not {m:?}"));
        }
        let (before, after) = (model.motion(theta - STEP), model.motion(theta + STEP));
        let rate = omega / (2.0 * STEP);
        let (v, a) = ((after.y - before.y) * rate, (after.v - before.v) * rate);
        if (v - m.v).abs() > QUOTIENT * v_max {
            wrong.push(format!("the velocity at {theta} rad is {:e} m/s, heights give {v:e}", m.v));
        }
        if (a - m.a).abs() > QUOTIENT * a_max {
            wrong.push(format!("the acceleration at {theta} rad is {:e} m/s2, velocities give {a:e}", m.a));
        }
        if m.y > top + 1e-12 * stroke {
            wrong.push(format!("the pin is at {} m, above the top dead centre at {top} m", m.y));
        }
    }
    let (low, high) =
        motions.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), m| (a.min(m.y), b.max(m.y)));
    // Between two of the angles a dead centre is missed by half their distance: the square of it, halved, of the crank radius, some 4e-5.
    if ((high - low) / stroke - 1.0).abs() > 1e-4 || (top - high) > 1e-4 * stroke {
        wrong.push(format!(
            "the pin moves from {low} m to {high} m: top dead centre {top} m, stroke {stroke} m"
        ));
    }
    wrong
}
