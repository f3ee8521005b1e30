//! A cycle kept as the polynomials of its steps.

use gudgeon_numerics::ode::StepView;
use gudgeon_scene_piston_secondary::trajectory::{Between, Trajectory};

/// A step along a polynomial of degree four.
struct Quartic(f64, f64, [f64; 1], [f64; 1]);
fn quartic(t: f64) -> f64 {
    1.0 - 2.0 * t + 3.0 * t * t - 0.5 * t.powi(3) + 0.25 * t.powi(4)
}
impl StepView for Quartic {
    fn t0(&self) -> f64 {
        self.0
    }
    fn t1(&self) -> f64 {
        self.1
    }
    fn y0(&self) -> &[f64] {
        &self.2
    }
    fn y1(&self) -> &[f64] {
        &self.3
    }
    fn interpolate(&self, t: f64, y: &mut [f64]) {
        y[0] = quartic(t);
    }
}

#[test]
fn a_quartic_is_held_exactly() {
    let mut held = Trajectory::new(1, Between::Dense);
    held.start(0.0, &[quartic(0.0)]);
    for (a, b) in [(0.0, 0.7), (0.7, 1.0), (1.0, 2.0)] {
        held.step(&Quartic(a, b, [quartic(a)], [quartic(b)]));
    }
    // Sums of five products of order one: rounding.
    for t in [0.0, 0.1, 0.7, 0.93, 1.0, 1.5, 2.0] {
        assert!((held.state(t, 0) - quartic(t)).abs() < 1e-13, "{t}");
    }
    let slope = |t: f64| -2.0 + 6.0 * t - 1.5 * t * t + t.powi(3);
    // The third derivative, of order ten, times the square of a thousandth; one-sided at ends, the second times a thousandth.
    assert!((held.slope(1.5, 0) - slope(1.5)).abs() < 1e-5);
    assert!((held.slope(0.7, 0) - slope(0.7)).abs() < 1e-2);
    let whole = |t: f64| t - t * t + t.powi(3) - 0.125 * t.powi(4) + 0.05 * t.powi(5);
    assert!((held.mean(0) - whole(2.0) / 2.0).abs() < 1e-13);
    assert_eq!(held.end_at(0.7), Some(1));
    assert_eq!(held.end_at(0.71), None);
    assert_eq!(held.at_end(2), &[quartic(1.0)]);
}
