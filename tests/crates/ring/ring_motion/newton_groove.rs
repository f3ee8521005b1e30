//! The ring as a mass between the flanks.

use gudgeon_core::kinds::{FlankCtx, FlankSpec};
use gudgeon_core::kinds::{RingMotionCtx, RingMotionSpec};
use gudgeon_core::quantity::quantity;
use gudgeon_ring::parts::GrooveFlank as Flank;
use gudgeon_ring::{NewtonGroove, SqueezeFilm};

const MASS: f64 = 0.043;
const CLEARANCE: f64 = 1e-4;

fn flank(spec: &NewtonGroove) -> Flank {
    Flank { stiffness: spec.flank_stiffness.si(), per_rebound: spec.rebound_velocity.si().recip() }
}

#[test]
fn flanks_only_push_and_meet_zero_continuously() {
    let m = flank(&NewtonGroove::default());
    let c = CLEARANCE;
    for v in [-3.0, -1e-3, 0.0, 1e-3, 3.0] {
        assert_eq!(m.reaction(0.5 * c, v, c), 0.0);
        assert_eq!(m.reaction(0.0, v, c), 0.0);
        assert_eq!(m.reaction(c, v, c), 0.0);
        for d in [1e-15, 1e-9, 1e-7, 1e-6] {
            let lower = m.reaction(-d, v, c);
            let upper = m.reaction(c + d, v, c);
            assert!(lower >= 0.0 && upper <= 0.0);
            // The factor of k d is at most 1 + 3/0.01.
            assert!(lower.max(-upper) <= 1.0001e10 * d * 301.0);
            // Up and down are mirrored; the depth at the upper flank carries the rounding of c + d, 1e-20 m.
            let mirrored = -m.reaction(c + d, -v, c);
            assert!((lower - mirrored).abs() <= 1e10 * 2e-20 * 301.0, "{lower} {mirrored}");
        }
    }
    // 10 kN indents 1 µm.
    assert!((m.reaction(-1e-6, 0.0, c) - 1e4).abs() < 1e-8);
}

/// Depth and velocity after one contact by a classical Runge-Kutta scheme with tiny steps, until the ring has left.
fn rebound(m: &Flank, mass: f64, v_in: f64, dt: f64) -> f64 {
    let c = CLEARANCE;
    let f = |y: [f64; 2]| [y[1], m.reaction(y[0], y[1], c) / mass];
    let add = |y: [f64; 2], k: [f64; 2], h: f64| [y[0] + h * k[0], y[1] + h * k[1]];
    let mut y = [0.0, -v_in];
    for _ in 0..20_000_000 {
        let k1 = f(y);
        let k2 = f(add(y, k1, 0.5 * dt));
        let k3 = f(add(y, k2, 0.5 * dt));
        let k4 = f(add(y, k3, dt));
        for i in 0..2 {
            y[i] += dt / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
        }
        if y[0] >= 0.0 && y[1] > 0.0 {
            return y[1];
        }
    }
    panic!("no rebound");
}

/// Positive root of -x - ln(1 - x) = rhs by bisection in y = -ln(1 - x), which stays well scaled near x = 1.
fn closed_form(v_in: f64, v_r: f64) -> f64 {
    let xi = v_in / v_r;
    let rhs = xi - xi.ln_1p();
    let g = |y: f64| (-y).exp_m1() + y;
    let (mut lo, mut hi) = (0.0, rhs + 2.0);
    for _ in 0..200 {
        let mid = 0.5 * (lo + hi);
        if g(mid) < rhs { lo = mid } else { hi = mid }
    }
    v_r * -(-lo).exp_m1()
}

#[test]
fn rebound_follows_the_closed_form_and_loses_energy() {
    let v_r = 0.5;
    let spec = NewtonGroove { rebound_velocity: quantity(v_r), ..NewtonGroove::default() };
    let m = flank(&spec);
    let mut last = 0.0;
    for v_in in [0.01, 0.1, 0.5, 2.0] {
        let v_out = rebound(&m, MASS, v_in, 1e-10);
        let exact = closed_form(v_in, v_r);
        // The contact ends inside one step of 1e-10 s, in which the force, at most k·v·dt, changes the velocity by less than
        // 1e10·0.5·1e-10/0.043·1e-10 ~ 1e-9 m/s; the scheme itself is far better than that.
        assert!((v_out - exact).abs() < 2e-9, "{v_in}: {v_out} {exact}");
        assert!(v_out < v_in, "energy must decrease");
        assert!(v_out < v_r, "no rebound is faster than v_r");
        assert!(v_out > last, "a harder impact rebounds faster");
        last = v_out;
    }
    // Gentle impacts: v_o/v_i = 1 - 2/3 v_i/v_r + O(v_i²/v_r²).
    let x = 1e-3;
    let ratio = closed_form(x * v_r, v_r) / (x * v_r);
    assert!((ratio - (1.0 - 2.0 / 3.0 * x)).abs() < 2.0 * x * x, "{ratio}");
}

#[test]
fn refuses_what_cannot_move() {
    for (mass, clearance) in [(MASS, 0.0), (0.0, CLEARANCE), (f64::NAN, CLEARANCE)] {
        let oil = FlankCtx::new(0, 1, 0.6, 5e-3, 0.01);
        let damping = SqueezeFilm::default().build(&oil).expect("builds").law();
        let ctx = RingMotionCtx::new(0, mass, clearance, 200.0, damping);
        assert!(NewtonGroove::default().build(ctx).is_err());
    }
}
