//! Derivatives along a trajectory: closed forms, order, a periodic orbit, an event.

use gudgeon_numerics::linalg::{lu_factor, lu_solve, lu_solve_rows};
use gudgeon_numerics::tangent::{Jump, NODES, Tangent};

/// `y' = -t y + p`, `q' = y²` from `y(0) = 1` at `p = 0`, where `y = exp(-t²/2)`: columns by the initial state and by `p`.
fn decaying(steps: usize) -> Tangent {
    let mut tangent = Tangent::new(1, 1, 2);
    tangent.values_mut()[0] = 1.0;
    let h = 1.0 / steps as f64;
    for k in 0..steps {
        for (i, x) in NODES.iter().enumerate() {
            let t = (k as f64 + x) * h;
            let node = tangent.node(i);
            node.jacobian.copy_from_slice(&[-t, 2.0 * (-0.5 * t * t).exp()]);
            node.forcing.copy_from_slice(&[0.0, 1.0, 0.0, 0.0]);
        }
        tangent.prepare(h).unwrap();
        tangent.step(h);
    }
    tangent
}

/// `y = y0 exp(-t²/2)`, so `∂y/∂y0 = exp(-1/2)` and `∂q/∂y0 = 2 ∫ exp(-t²) dt = √π erf(1)`. The method is of order 5, and 7 at the ends of steps of a
/// scalar problem at most: halving the steps divides the error by 32 or more.
#[test]
fn a_decaying_solution_is_differentiated_to_order_five() {
    let exact = [(-0.5_f64).exp(), 1.493_648_265_624_854];
    let error = |steps| {
        let t = decaying(steps);
        [(t.values()[0] - exact[0]).abs(), (t.values()[2] - exact[1]).abs()]
    };
    let (coarse, fine) = (error(4), error(8));
    for k in 0..2 {
        assert!(coarse[k] < 1e-6 && fine[k] < coarse[k] / 25.0, "{coarse:?} {fine:?}");
    }
}

/// By `p`: `exp(-1/2) ∫ exp(t²/2) dt`; the collocation polynomial is between the knots what a run that ends there gives, to its order 4.
#[test]
fn derivatives_inside_a_step_follow_the_collocation_polynomial() {
    let t = decaying(8);
    // exp(-1/2) times the integral of exp(t²/2) from 0 to 1, 1.194957661910227. The error of a step of h = 1/8 is h⁶/7200 times a derivative of order 6,
    // which is 15 at most here; eight of them make 6e-8.
    assert!((t.values()[1] - 0.724_778_459_007_076_3).abs() < 6e-8, "{}", t.values()[1]);
    let mut s = [0.0; 4];
    t.interpolate(0.5, &mut s);
    let at = 1.0 - 0.5 / 8.0_f64;
    assert!((s[0] - (-0.5 * at * at).exp()).abs() < 1e-6);
    t.interpolate(1.0, &mut s);
    assert!(s.iter().zip(t.values()).all(|(a, b)| (a - b).abs() < 1e-15));
}

/// `y' = -λ (y - p cos t)` has the orbit `p (λ² cos t + λ sin t)/(1 + λ²)`: stiff and not, by the implicit function at the orbit.
#[test]
fn the_derivative_of_a_periodic_orbit_is_that_of_its_closed_form() {
    for lambda in [0.3, 30.0, 1e7] {
        let steps = 400;
        let h = std::f64::consts::TAU / steps as f64;
        // By the state at the start, and by p.
        let mut tangent = Tangent::new(1, 0, 2);
        tangent.values_mut()[0] = 1.0;
        for k in 0..steps {
            for (i, x) in NODES.iter().enumerate() {
                let t = (k as f64 + x) * h;
                let node = tangent.node(i);
                node.jacobian[0] = -lambda;
                node.forcing.copy_from_slice(&[0.0, lambda * t.cos()]);
            }
            tangent.prepare(h).unwrap();
            tangent.step(h);
        }
        let [m, by_p] = [tangent.values()[0], tangent.values()[1]];
        let exact = lambda * lambda / (1.0 + lambda * lambda);
        // Errors of order h^5 over the cycle, h = 0.016.
        assert!((by_p / (1.0 - m) - exact).abs() < 1e-9, "{lambda}: {} {exact}", by_p / (1.0 - m));
    }
}

/// A ball that falls from the height `H` and comes back with the part `e` of its velocity. At the time `t` after one bounce
///
/// ```text
/// t1 = √(2H/g),  u = e √(2gH),  s = t - t1,  x = u s - g s²/2,  v = u - g s
/// ```
///
/// and `q = ∫ x dt = H t1 - g t1³/6 + u s²/2 - g s³/6`. All is a polynomial of degree 3 at most in each piece, so the method is exact and the jump is
/// all that can be wrong. Without the delay of the bounce the derivative of `v` by `H` would be off by `(1 + e) g dt1/dH`.
#[test]
fn derivatives_jump_where_a_ball_bounces() {
    let (height, g, e, end) = (1.3_f64, 9.81, 0.7, 0.8);
    let t1 = (2.0 * height / g).sqrt();
    let v1 = -(2.0 * g * height).sqrt();
    // By H, by g, by e.
    let mut tangent = Tangent::new(2, 1, 3);
    tangent.values_mut()[0] = 1.0;
    let piece = |tangent: &mut Tangent, h: f64| {
        for i in 0..3 {
            let node = tangent.node(i);
            node.jacobian.copy_from_slice(&[0.0, 1.0, 0.0, 0.0, 1.0, 0.0]);
            node.forcing.fill(0.0);
            node.forcing[3 + 1] = -1.0;
        }
        tangent.prepare(h).unwrap();
        tangent.step(h);
    };
    piece(&mut tangent, t1);
    // The event is x = 0: τ' = -S_x/v.
    let delay: Vec<f64> = tangent.values()[..3].iter().map(|s| -s / v1).collect();
    assert!((delay[0] - 0.5 * t1 / height).abs() < 1e-14 && delay[2] == 0.0);
    tangent.jump(&Jump {
        reset: &[1.0, 0.0, 0.0, -e],
        moved: &[0.0, 0.0, 0.0, 0.0, 0.0, -v1],
        before: &[v1, -g, 0.0],
        after: &[-e * v1, -g, 0.0],
        delay: &delay,
    });
    piece(&mut tangent, end - t1);

    let state = |height: f64, g: f64, e: f64| {
        let (t1, u) = ((2.0 * height / g).sqrt(), e * (2.0 * g * height).sqrt());
        let s = end - t1;
        let q = height * t1 - g * t1.powi(3) / 6.0 + 0.5 * u * s * s - g * s.powi(3) / 6.0;
        [u * s - 0.5 * g * s * s, u - g * s, q]
    };
    let d = 1e-5;
    let by = [
        (state(height + d, g, e), state(height - d, g, e)),
        (state(height, g + d, e), state(height, g - d, e)),
        (state(height, g, e + d), state(height, g, e - d)),
    ];
    for (c, (high, low)) in by.iter().enumerate() {
        for r in 0..3 {
            let difference = (high[r] - low[r]) / (2.0 * d);
            // The difference loses 1e-16/1e-5 to rounding and 1e-10 to curvature.
            assert!((tangent.values()[3 * r + c] - difference).abs() < 1e-9, "row {r}, column {c}");
        }
    }
}

/// Several right-hand sides at once are each one alone.
#[test]
fn right_hand_sides_side_by_side() {
    let matrix = [0.0, 2.0, 1.0, 1.0, -3.0, 0.5, 4.0, 0.0, 1.0];
    let (mut a, mut pivots) = (matrix, [0; 3]);
    lu_factor(&mut a, 3, &mut pivots).unwrap();
    let columns = [[1.0, 2.0, 3.0], [-1.0, 0.5, 0.0]];
    let mut b = [0.0; 6];
    for (c, column) in columns.iter().enumerate() {
        for r in 0..3 {
            b[2 * r + c] = column[r];
        }
    }
    lu_solve_rows(&a, 3, &pivots, &mut b, 2);
    for (c, mut x) in columns.into_iter().enumerate() {
        lu_solve(&a, 3, &pivots, &mut x);
        for r in 0..3 {
            assert_eq!(b[2 * r + c].to_bits(), x[r].to_bits());
        }
    }
}
