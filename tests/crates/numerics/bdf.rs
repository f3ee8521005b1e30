//! Backward differentiation formulas: accuracy against an independent method, invariants, dense output, events, restarts, work.

use gudgeon_numerics::EvalError;
use gudgeon_numerics::bdf::Bdf;
use gudgeon_numerics::ode::{
    Direction, EventAction, Flow, IntegrateError, Integrator, OdeSystem, Options, Stats, StepView,
};
use gudgeon_numerics::radau::Radau5;
use gudgeon_numerics::rodas::Rodas;

/// Robertson's kinetics, what reacted in the first step as a quadrature: rates from 0.04 to 3e7, and `y0 + y1 + y2 = 1`.
struct Kinetics;
impl OdeSystem for Kinetics {
    fn dim(&self) -> usize {
        3
    }
    fn quad_dim(&self) -> usize {
        1
    }
    fn rhs(&mut self, _: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        let (a, b, c) = (0.04 * y[0], 1e4 * y[1] * y[2], 3e7 * y[1] * y[1]);
        (f[0], f[1], f[2], f[3]) = (b - a, a - b - c, c, a);
        Ok(())
    }
    fn jacobian(&mut self, _: f64, y: &[f64], _: &[f64], jac: &mut [f64]) -> Result<bool, EvalError> {
        let (b1, b2, c1) = (1e4 * y[2], 1e4 * y[1], 6e7 * y[1]);
        jac.copy_from_slice(&[-0.04, b1, b2, 0.04, -b1 - c1, -b2, 0.0, c1, 0.0, 0.04, 0.0, 0.0]);
        Ok(true)
    }
}

fn kinetics<I: Integrator<Kinetics>>(integrator: &mut I, rtol: f64) -> ([f64; 4], Stats) {
    let (mut y, mut q, mut stats) = ([1.0, 0.0, 0.0], [0.0], Stats::default());
    let options = Options { atol_quad: vec![rtol], ..Options::new(rtol, &[1.0, 1e-4, 1.0]) };
    let go = &mut |_: &mut Kinetics, _: &dyn StepView| Flow::Continue;
    let outcome =
        integrator.integrate(&mut Kinetics, (0.0, 400.0), &[], &mut y, &mut q, &options, &mut stats, go);
    assert!(outcome.is_ok(), "{outcome:?}");
    ([y[0], y[1], y[2], q[0]], stats)
}

#[test]
fn stiff_kinetics_agree_with_an_independent_method_and_follow_the_tolerance() {
    let (exact, _) = kinetics(&mut Radau5::new(3, 1, None), 1e-11);
    let mut before = f64::INFINITY;
    for rtol in [1e-3, 1e-5, 1e-7, 1e-9] {
        let (found, _) = kinetics(&mut Bdf::new(3, 1, None), rtol);
        let error = exact.iter().zip(found).map(|(a, b)| ((a - b) / a).abs()).fold(0.0, f64::max);
        // The error of a run is that of some hundred steps, which add up and partly cancel.
        assert!(error < 300.0 * rtol, "{rtol:e}: {error:e}");
        assert!(error < 0.5 * before, "{rtol:e}: {error:e}");
        before = error;
    }
}

/// Five of them side by side: more numbers than a block of the integrator's work arrays holds.
struct FiveFold;
impl OdeSystem for FiveFold {
    fn dim(&self) -> usize {
        15
    }
    fn quad_dim(&self) -> usize {
        5
    }
    fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        for (i, y) in y.chunks_exact(3).enumerate() {
            let mut one = [0.0; 4];
            Kinetics.rhs(t, y, &mut one)?;
            f[3 * i..3 * i + 3].copy_from_slice(&one[..3]);
            f[15 + i] = one[3];
        }
        Ok(())
    }
    fn jacobian(&mut self, t: f64, y: &[f64], _: &[f64], jac: &mut [f64]) -> Result<bool, EvalError> {
        jac.fill(0.0);
        for (i, y) in y.chunks_exact(3).enumerate() {
            let mut one = [0.0; 12];
            Kinetics.jacobian(t, y, &[], &mut one)?;
            for (k, row) in one.chunks_exact(3).enumerate() {
                let to = if k < 3 { 3 * i + k } else { 15 + i };
                jac[15 * to + 3 * i..15 * to + 3 * i + 3].copy_from_slice(row);
            }
        }
        Ok(true)
    }
}

#[test]
fn systems_side_by_side_run_as_one_alone() {
    let (alone, work) = kinetics(&mut Bdf::new(3, 1, None), 1e-6);
    let scale = [1.0, 1e-4, 1.0].repeat(5);
    let options = Options { atol_quad: vec![1e-6; 5], ..Options::new(1e-6, &scale) };
    let (mut y, mut q, mut stats) = ([1.0, 0.0, 0.0].repeat(5), [0.0; 5], Stats::default());
    let go = &mut |_: &mut FiveFold, _: &dyn StepView| Flow::Continue;
    let outcome = Bdf::new(15, 5, None).integrate(
        &mut FiveFold,
        (0.0, 400.0),
        &[],
        &mut y,
        &mut q,
        &options,
        &mut stats,
        go,
    );
    assert!(outcome.is_ok(), "{outcome:?}");
    // The norm is the largest component, and zeros beside a system change no sum: steps and results are those of one.
    assert_eq!(stats, work);
    assert!(y.chunks_exact(3).zip(q).all(|(y, q)| [y[0], y[1], y[2], q] == alone), "{y:?} {q:?} {alone:?}");
}

#[test]
fn linear_invariants_hold_at_a_loose_tolerance() {
    let (found, _) = kinetics(&mut Bdf::new(3, 1, None), 1e-3);
    // Rounding of sums of 1, once a step, however well Newton's method has converged.
    assert!((found[0] + found[1] + found[2] - 1.0).abs() < 1e-13, "{found:?}");
}

#[test]
fn a_smooth_problem_takes_fewer_right_hand_sides_and_far_fewer_jacobians_than_a_rosenbrock_method() {
    for rtol in [1e-4, 1e-6] {
        let (_, bdf) = kinetics(&mut Bdf::new(3, 1, None), rtol);
        let (_, rodas) = kinetics(&mut Rodas::new(3, 1, None), rtol);
        assert!(bdf.rhs < rodas.rhs, "{bdf:?} {rodas:?}");
        assert!(3 * bdf.jacobians < bdf.steps, "{bdf:?}");
        // Jacobians use the rates of the first correction. Beside the corrections: two rates for the first step, and one where an old Jacobian was no good.
        assert!(bdf.rhs - bdf.solves < 5, "{bdf:?}");
    }
}

/// `y' = -λ (y - sin t) + cos t`, solution `sin t`; its integral as a quadrature; what is done at zeros of `y`.
struct Follower {
    lambda: f64,
    zeros: Vec<f64>,
    restarts: bool,
}
impl Follower {
    fn new(lambda: f64) -> Self {
        Self { lambda, zeros: Vec::new(), restarts: false }
    }
}
impl OdeSystem for Follower {
    fn dim(&self) -> usize {
        1
    }
    fn quad_dim(&self) -> usize {
        1
    }
    fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        (f[0], f[1]) = (-self.lambda * (y[0] - t.sin()) + t.cos(), y[0]);
        Ok(())
    }
    fn n_events(&self) -> usize {
        1
    }
    fn events(&mut self, _: f64, y: &[f64], g: &mut [f64]) -> Result<(), EvalError> {
        g[0] = y[0];
        Ok(())
    }
    fn event_direction(&self, _: usize) -> Direction {
        Direction::Either
    }
    fn on_event(&mut self, _: usize, t: f64, _: &mut [f64]) -> Result<EventAction, EvalError> {
        self.zeros.push(t);
        Ok(if self.restarts { EventAction::Restart } else { EventAction::Continue })
    }
}

/// Follows to t = 10; the errors of the state, of dense output and of the quadrature.
fn follow(sys: &mut Follower, rtol: f64, breakpoints: &[f64]) -> Result<([f64; 3], Stats), IntegrateError> {
    let (mut y, mut q, mut stats) = ([0.0], [0.0], Stats::default());
    let options = Options { atol_quad: vec![rtol], ..Options::new(rtol, &[1.0]) };
    let (mut worst, mut inside) = (0.0_f64, [0.0]);
    let observe = &mut |_: &mut Follower, v: &dyn StepView| {
        for x in [0.1, 0.37, 0.8] {
            let t = v.t0() + x * (v.t1() - v.t0());
            v.interpolate(t, &mut inside);
            worst = worst.max((inside[0] - t.sin()).abs());
        }
        Flow::Continue
    };
    Bdf::new(1, 1, None).integrate(
        sys,
        (0.0, 10.0),
        breakpoints,
        &mut y,
        &mut q,
        &options,
        &mut stats,
        observe,
    )?;
    let integral = 1.0 - 10.0_f64.cos();
    Ok(([(y[0] - 10.0_f64.sin()).abs(), worst, (q[0] - integral).abs()], stats))
}

#[test]
fn states_dense_output_and_quadratures_are_as_accurate_as_asked() -> Result<(), IntegrateError> {
    for lambda in [0.0, 1.0, 1e3, 1e6] {
        for rtol in [1e-3, 1e-6, 1e-9] {
            let ([end, inside, integral], _) = follow(&mut Follower::new(lambda), rtol, &[])?;
            // Errors of all steps add up where nothing damps them; between steps a polynomial of lower order may lose another factor.
            assert!(end < 50.0 * rtol, "λ {lambda}, {rtol:e}: {end:e}");
            assert!(inside < 100.0 * rtol, "λ {lambda}, {rtol:e} inside: {inside:e}");
            assert!(integral < 100.0 * rtol, "λ {lambda}, {rtol:e} integral: {integral:e}");
        }
    }
    Ok(())
}

#[test]
fn quadratures_without_an_accuracy_are_refused() {
    let (mut y, mut q, options) = ([0.0], [0.0], Options::new(1e-3, &[1.0]));
    let go = &mut |_: &mut Follower, _: &dyn StepView| Flow::Continue;
    let (mut sys, mut stats) = (Follower::new(1.0), Stats::default());
    let refused =
        Bdf::new(1, 1, None).integrate(&mut sys, (0.0, 1.0), &[], &mut y, &mut q, &options, &mut stats, go);
    assert!(
        matches!(refused, Err(IntegrateError::Input { what }) if what.contains("atol_quad")),
        "{refused:?}"
    );
}

#[test]
fn events_are_found_and_restarts_begin_anew() -> Result<(), IntegrateError> {
    let pi = std::f64::consts::PI;
    for restarts in [false, true] {
        let mut sys = Follower { restarts, ..Follower::new(1.0) };
        let ([end, ..], stats) = follow(&mut sys, 1e-7, &[2.0, 5.0])?;
        assert!(end < 1e-5, "{end:e}");
        // The start itself is a zero and no event.
        let expected = [pi, 2.0 * pi, 3.0 * pi];
        assert_eq!(sys.zeros.len(), 3, "{:?}", sys.zeros);
        // Times of zeros of slope one: as accurate as the solution.
        assert!(sys.zeros.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-5), "{:?}", sys.zeros);
        // Order 1 at the start and behind breakpoints and events costs steps: some thirty each at this tolerance.
        assert!(stats.steps < 500, "{stats:?}");
    }
    Ok(())
}
