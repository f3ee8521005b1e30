//! Interpolation of periodic functions of the crank angle.

use std::f64::consts::PI;

use gudgeon_torsion::interpolant::Interpolant;

#[test]
fn a_function_with_a_corner_is_evaluated_there_and_a_polynomial_elsewhere() {
    // Smooth but for a corner at 1.234, period two turns.
    let f = |a: f64| {
        let a = a.rem_euclid(4.0 * PI);
        1e4 * ((0.5 * a).sin() / (1.2 + a.cos()) + 0.1 * (a - 1.234).max(0.0) * (4.0 * PI - a))
    };
    let mut p = Interpolant::new(2, |a| [f(a)]);
    for k in 0..40_000 {
        let at = -20.0 + 0.001 * f64::from(k);
        // Twice: the segment is built first, and used then.
        p.value(at, |a| [f(a)]);
        let error = (p.value(at, |a| [f(a)])[0] - f(at)).abs();
        // What a polynomial promises, and the rounding of the angle by a derivative of 2e4 per radian.
        assert!(error < 1.5 * p.tolerance()[0] + 2e4 * 4e-15, "{at}: {error:e}");
    }
    let direct = p.direct_segments();
    // The corner and the jump of the derivative where the period ends, which touch two segments each at most.
    assert!((1..=4).contains(&direct), "{direct}");
    // The derivative of sin(a/2)/(1.2 + cos a) at 0.5 in closed form; interpolation loses the sixth power of the segment.
    let exact = 1e4
        * (0.5 * 0.25_f64.cos() / (1.2 + 0.5_f64.cos())
            + 0.25_f64.sin() * 0.5_f64.sin() / (1.2 + 0.5_f64.cos()).powi(2));
    assert!((p.derivative(0.5, |a| [f(a)])[0] / exact - 1.0).abs() < 1e-9);
    // On both sides of the corner, in the segment that has it, the slope of that side: from the rounding of an angle over 2e-6.
    for at in [1.233, 1.235_f64] {
        let smooth = 0.5 * (0.5 * at).cos() / (1.2 + at.cos())
            + (0.5 * at).sin() * at.sin() / (1.2 + at.cos()).powi(2);
        let beyond = if at > 1.234 { 0.1 * (4.0 * PI - at - (at - 1.234)) } else { 0.0 };
        let exact = 1e4 * (smooth + beyond);
        assert!((p.derivative(at, |a| [f(a)])[0] / exact - 1.0).abs() < 1e-8, "{at}");
    }
}

/// The derivative may be asked for first: the segment is built then.
#[test]
fn the_derivative_of_a_smooth_function_needs_no_value_before() {
    let f = |a: f64| 3.0 * (2.0 * a).sin() + (5.0 * a).cos();
    let mut p = Interpolant::new(1, |a| [f(a)]);
    for k in -30..30 {
        let at = 0.37 * f64::from(k);
        let exact = 6.0 * (2.0 * at).cos() - 5.0 * (5.0 * at).sin();
        // Seven terms over 1/512 turn: (5 · 6e-3)⁶/2⁶/6! of the slope, and rounding over the segment.
        assert!((p.derivative(at, |a| [f(a)])[0] - exact).abs() < 1e-10, "{at}");
    }
    assert_eq!(p.direct_segments(), 0);
}
