//! Radau IIA: stability function, orders, independent solutions, invariants, refusals.

#![allow(clippy::excessive_precision, reason = "reference digits as computed")]

use gudgeon_numerics::EvalError;
use gudgeon_numerics::ode::{Flow, IntegrateError, Integrator, OdeSystem, Options, Stats};
use gudgeon_numerics::radau::Radau5;
use gudgeon_numerics::rodas::Rodas;

/// `y' = J y`, dense.
struct Linear {
    n: usize,
    j: Vec<f64>,
}
impl Linear {
    fn times(&self, y: &[f64]) -> Vec<f64> {
        self.j.chunks_exact(self.n).map(|row| row.iter().zip(y).map(|(a, y)| a * y).sum()).collect()
    }
}
impl OdeSystem for Linear {
    fn dim(&self) -> usize {
        self.n
    }
    fn rhs(&mut self, _: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        f.copy_from_slice(&self.times(y));
        Ok(())
    }
    fn jacobian(&mut self, _: f64, _: &[f64], _: &[f64], jac: &mut [f64]) -> Result<bool, EvalError> {
        jac.copy_from_slice(&self.j);
        Ok(true)
    }
}

/// One step of size `h` from `y0`: the state at its end, and at the stages `(4 ∓ √6)/10`.
fn one_step(sys: &mut Linear, h: f64, y0: &[f64]) -> [Vec<f64>; 3] {
    // Any error is accepted; the iteration goes to rounding.
    let options = Options { h_init: h, h_max: h, ..Options::new(1e8, &vec![1.0; sys.n]) };
    let mut y = y0.to_vec();
    let mut stages = [vec![0.0; sys.n], vec![0.0; sys.n]];
    let mut stats = Stats::default();
    let mut radau = Radau5::new(sys.n, 0, None).with_newton_factor(1e-20);
    let done = radau.integrate(sys, (0.0, h), &[], &mut y, &mut [], &options, &mut stats, &mut |_, view| {
        for (c, s) in [-1.0, 1.0].iter().zip(&mut stages) {
            view.interpolate(h * (4.0 + c * 6.0_f64.sqrt()) / 10.0, s);
        }
        Flow::Continue
    });
    assert!(done.is_ok() && stats.steps == 1 && stats.rejected == 0, "{done:?} {stats:?}");
    let [a, b] = stages;
    [y, a, b]
}

#[test]
fn a_step_solves_the_collocation_equations() {
    // Butcher's matrix: Z_i = h Σ a_ij J (y + Z_j), its last stage the end of the step.
    let s = 6.0_f64.sqrt();
    let a = [
        [(88.0 - 7.0 * s) / 360.0, (296.0 - 169.0 * s) / 1800.0, (-2.0 + 3.0 * s) / 225.0],
        [(296.0 + 169.0 * s) / 1800.0, (88.0 + 7.0 * s) / 360.0, (-2.0 - 3.0 * s) / 225.0],
        [(16.0 - s) / 36.0, (16.0 + s) / 36.0, 1.0 / 9.0],
    ];
    // A spiral, whose eigenvalues are complex, and a matrix whose zero diagonal makes both factorisations exchange rows.
    let spiral = Linear { n: 2, j: vec![-3.0, -5.0, 5.0, -3.0] };
    let n = 7;
    let mixed = (0..n * n)
        .map(|k| if k % (n + 1) == 0 { 0.0 } else { ((k * k * 37 + k * 11) % 101) as f64 / 50.0 - 1.0 });
    for mut sys in [spiral, Linear { n, j: mixed.collect() }] {
        let y0: Vec<f64> = (0..sys.n).map(|k| 1.0 - 0.3 * k as f64).collect();
        for h in [0.05, 0.7, 4.0] {
            let [y1, first, second] = one_step(&mut sys, h, &y0);
            let rates = [&first, &second, &y1].map(|stage| sys.times(stage));
            let size = rates.iter().flatten().fold(1.0, |m: f64, r| m.max(r.abs()));
            for (row, stage) in a.iter().zip([&first, &second, &y1]) {
                for k in 0..sys.n {
                    let sum: f64 = row.iter().zip(&rates).map(|(a, r)| a * r[k]).sum();
                    // Some tens of roundings of numbers up to 17 (the entries of T and of its inverse) times the rates.
                    let rest = (stage[k] - y0[k] - h * sum).abs();
                    assert!(rest < 1e-13 * (1.0 + h) * size, "{} {h}: {rest:e}", sys.n);
                }
            }
        }
    }
}

#[test]
fn the_end_of_a_step_follows_the_stability_function() {
    // R(z) = (1 + 2z/5 + z²/20) / (1 - 3z/5 + 3z²/20 - z³/60), applied as a matrix: Q(hJ) y1 = P(hJ) y0.
    let n = 5;
    let j = (0..n * n).map(|k| ((k * 29 + 7 * k * k) % 53) as f64 / 26.0 - 1.0).collect();
    let mut sys = Linear { n, j };
    let y0 = [1.0, -0.5, 0.25, 2.0, 0.0];
    let polynomial = |sys: &Linear, c: &[f64], h: f64, y: &[f64]| {
        // Horner's scheme.
        let mut sum = vec![0.0; n];
        for c in c.iter().rev() {
            sum = sys.times(&sum).iter().zip(y).map(|(s, y)| h * s + c * y).collect();
        }
        sum
    };
    for h in [0.1, 1.0, 10.0] {
        let [y1, ..] = one_step(&mut sys, h, &y0);
        let left = polynomial(&sys, &[1.0, -0.6, 0.15, -1.0 / 60.0], h, &y1);
        let right = polynomial(&sys, &[1.0, 0.4, 0.05], h, &y0);
        let largest = y1.iter().chain(&y0).fold(0.0, |m: f64, y| m.max(y.abs()));
        for (l, r) in left.iter().zip(&right) {
            // Backward stable solves: rounding times the size of the terms, (3 h)³/60 of a matrix of norm 3.
            assert!((l - r).abs() < 1e-13 * (1.0 + h * h * h) * largest, "{h}: {l} {r}");
        }
    }
    // Damped at infinity: R(z) tends to -3/z, with an error of the rounding of 1, the start.
    let [y, ..] = one_step(&mut Linear { n: 1, j: vec![-1e9] }, 1.0, &[1.0]);
    assert!((y[0] * 1e9 - 3.0).abs() < 1e-6, "{y:?}");
}

#[test]
fn jacobians_that_are_no_numbers_end_in_an_error() {
    struct Broken;
    impl OdeSystem for Broken {
        fn dim(&self) -> usize {
            2
        }
        fn rhs(&mut self, _: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
            f.copy_from_slice(y);
            Ok(())
        }
        fn jacobian(&mut self, _: f64, _: &[f64], _: &[f64], jac: &mut [f64]) -> Result<bool, EvalError> {
            jac.fill(f64::NAN);
            Ok(true)
        }
    }
    let done = Radau5::new(2, 0, None).solve(
        &mut Broken,
        (0.0, 1.0),
        &mut [1.0, 1.0],
        &Options::new(1e-6, &[1.0; 2]),
    );
    assert!(matches!(done, Err(IntegrateError::StepTooSmall { last: Some(_), .. })), "{done:?}");
}

/// Smooth, nonlinear, non-autonomous: y0 = e^{sin t}, y1 = cos t + 2.
struct Smooth;
impl OdeSystem for Smooth {
    fn dim(&self) -> usize {
        2
    }
    fn quad_dim(&self) -> usize {
        2
    }
    fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        f[0] = (y[1] - 2.0) * y[0];
        f[1] = -t.sin() + (y[0] - t.sin().exp());
        // ∫ y1' dt = cos t - 1, ∫ t⁴ dt.
        f[2] = f[1];
        f[3] = t.powi(4);
        Ok(())
    }
}

/// Errors of state, dense output and quadrature with constant steps.
fn constant_steps(h: f64, end: f64) -> [f64; 3] {
    // A wide tolerance accepts every step; the iteration is carried to rounding all the same.
    let mut o = Options::new(1.0, &[1.0, 1.0]);
    (o.h_max, o.h_init) = (h, h);
    let (mut y, mut q) = ([1.0, 3.0], [0.0; 2]);
    let mut r = Radau5::new(2, 2, None).with_newton_factor(1e-10);
    let (mut worst, mut out) = (0.0_f64, [0.0; 2]);
    let result =
        r.integrate(&mut Smooth, (0.0, end), &[], &mut y, &mut q, &o, &mut Stats::default(), &mut |_, v| {
            for x in [0.0, 0.2, 0.37, 0.8, 1.0] {
                let t = v.t0() + x * (v.t1() - v.t0());
                v.interpolate(t, &mut out);
                if x == 0.0 {
                    assert!((out[0] - v.y0()[0]).abs() < 1e-14 && (out[1] - v.y0()[1]).abs() < 1e-14);
                }
                worst = worst.max((out[0] - t.sin().exp()).abs());
            }
            Flow::Continue
        });
    assert!(result.is_ok());
    // Radau's weights are exact to degree 4: rounding of some tens of summands of 6.4.
    assert!((q[1] - end.powi(5) / 5.0).abs() < 1e-13, "{:e}", q[1] - end.powi(5) / 5.0);
    // y1 and its quadrature have the same rates in every iterate.
    assert!((q[0] - (y[1] - 3.0)).abs() < 1e-14, "{:e}", q[0] - (y[1] - 3.0));
    [(y[0] - end.sin().exp()).abs(), worst, (q[0] - (end.cos() - 1.0)).abs()]
}

#[test]
fn order_five_dense_order_four_and_exact_quadratures() {
    let e: Vec<[f64; 3]> = [0.2, 0.1, 0.05].iter().map(|h| constant_steps(*h, 2.0)).collect();
    for pair in e.windows(2) {
        let order = |k: usize| (pair[0][k] / pair[1][k]).log2();
        // Order 5, approached from either side as the next term of the error fades.
        assert!((4.7..5.4).contains(&order(0)), "{e:?} {}", order(0));
        assert!((4.7..5.4).contains(&order(2)), "{e:?} {}", order(2));
        // A polynomial of degree 3: h⁴ inside the step.
        assert!((3.7..4.4).contains(&order(1)), "{e:?} {}", order(1));
    }
}

struct Robertson;
impl OdeSystem for Robertson {
    fn dim(&self) -> usize {
        3
    }
    fn rhs(&mut self, _: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        let (a, b, c) = (0.04 * y[0], 1e4 * y[1] * y[2], 3e7 * y[1] * y[1]);
        (f[0], f[1], f[2]) = (-a + b, a - b - c, c);
        Ok(())
    }
}

fn run<S: OdeSystem>(
    integrator: &mut dyn Integrator<S>,
    sys: &mut S,
    interval: (f64, f64),
    start: &[f64],
    options: &Options,
) -> (Vec<f64>, Stats) {
    let mut y = start.to_vec();
    let mut stats = Stats::default();
    let mut q = vec![0.0; sys.quad_dim()];
    let r = integrator
        .integrate(sys, interval, &[], &mut y, &mut q, options, &mut stats, &mut |_, _| Flow::Continue);
    assert!(r.is_ok(), "{r:?} {stats:?}");
    (y, stats)
}

fn worst(y: &[f64], exact: &[f64]) -> f64 {
    y.iter().zip(exact).map(|(y, e)| (y / e - 1.0).abs()).fold(0.0, f64::max)
}

/// mu = 1000.
struct VanDerPol;
impl OdeSystem for VanDerPol {
    fn dim(&self) -> usize {
        2
    }
    fn rhs(&mut self, _: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        (f[0], f[1]) = (y[1], 1000.0 * (1.0 - y[0] * y[0]) * y[1] - y[0]);
        Ok(())
    }
}

/// Independent solution by an extrapolated implicit method in 40-digit arithmetic; 16 digits of it.
#[test]
fn robertson() {
    for (end, exact, scale) in [
        (
            40.0,
            [0.715_827_068_719_405_1, 9.185_534_764_557_764e-6, 0.284_163_745_745_830_36],
            [1.0, 1e-5, 1.0],
        ),
        (
            4e11,
            [5.208_353_144_253_499e-9, 2.083_341_268_422_011_3e-14, 0.999_999_994_791_626],
            [1e-8, 1e-13, 1.0],
        ),
    ] {
        for rtol in [1e-7, 1e-9, 1e-11] {
            let o = Options::new(rtol, &scale);
            let (y, _) = run(&mut Radau5::new(3, 0, None), &mut Robertson, (0.0, end), &[1.0, 0.0, 0.0], &o);
            // A contracting flow forgets old errors: the global error is that of the last steps.
            assert!(worst(&y, &exact) < rtol, "{end} {rtol:e}: {:e}", worst(&y, &exact));
        }
    }
}

/// Independent solution as above. Two fast jumps lie behind t = 2000; an error in the time of a jump is an error in phase that
/// nothing damps, so the errors of some thousand steps add up.
#[test]
fn van_der_pol() {
    let exact = [1.706_167_732_170_465, -8.928_097_010_248_165e-4];
    let mut work = 0;
    for rtol in [1e-7, 1e-9, 1e-11] {
        let o = Options::new(rtol, &[1.0, 1.0]);
        let (y, s) = run(&mut Radau5::new(2, 0, None), &mut VanDerPol, (0.0, 2000.0), &[2.0, 0.0], &o);
        assert!(worst(&y, &exact) < 3.0 * rtol, "{rtol:e}: {:e} {s:?}", worst(&y, &exact));
        // Step numbers of order 5 with the error per step near the tolerance: 100^(1/5) to 100^(1/4) between the rows.
        assert!(work == 0 || s.steps < 4 * work, "{s:?}");
        work = s.steps;
    }
}

/// Three vessels in a chain with a periodic supply: rates of 1e5 and 1 in units of 1e5 and 1e-3, nonlinear, and a balance
/// of what flowed in and out as quadratures.
struct Chain {
    exact: bool,
}
impl OdeSystem for Chain {
    fn dim(&self) -> usize {
        3
    }
    fn quad_dim(&self) -> usize {
        2
    }
    fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        let p = [y[0] * 1e5, y[1] * 1e8, y[2] * 1e5];
        let supply = 2e5 * (1.0 + (6.0 * t).sin());
        let a = supply - p[0];
        let b = 1e3 * (p[0] - p[1]);
        let c = 1e-5 * (p[1] * p[1] - p[2] * p[2]);
        let d = p[2] - 1e5;
        let s = 1e-5;
        (f[0], f[1], f[2]) = (s * (a - b), s * (b - c), s * (c - d));
        (f[3], f[4]) = (-s * a, s * d);
        Ok(())
    }
    fn jacobian(&mut self, _: f64, y: &[f64], _: &[f64], jac: &mut [f64]) -> Result<bool, EvalError> {
        let (b0, b1, c1, c2) = (1e3, -1e6, 2e6 * y[1], -2.0 * y[2]);
        jac.copy_from_slice(&[
            -1.0 - b0,
            -b1,
            0.0,
            b0,
            b1 - c1,
            -c2,
            0.0,
            c1,
            c2 - 1.0,
            1.0,
            0.0,
            0.0,
            0.0,
            0.0,
            1.0,
        ]);
        Ok(self.exact)
    }
}

#[test]
fn agrees_with_rodas_on_a_stiff_forced_system() {
    let start = [1.0, 1e-3, 1.0];
    let o = Options::new(1e-10, &[1.0, 1e-3, 1.0]);
    let (y, s) = run(&mut Radau5::new(3, 2, None), &mut Chain { exact: true }, (0.0, 5.0), &start, &o);
    let (z, r) = run(&mut Rodas::new(3, 2, None), &mut Chain { exact: true }, (0.0, 5.0), &start, &o);
    // Each within some tolerances of the solution.
    assert!(worst(&y, &z) < 5e-10, "{y:?} {z:?}");
    // Made for this: it must not need more right-hand sides than the default method.
    assert!(s.rhs < r.rhs, "{s:?} {r:?}");
}

#[test]
fn linear_invariants_hold_at_any_tolerance() {
    for (exact, rtol) in [(true, 1e-2), (true, 1e-8), (false, 1e-2), (false, 1e-8)] {
        let (mut y, mut q) = ([1.0, 1e-3, 1.0], [0.0; 2]);
        let o = Options::new(rtol, &[1.0, 1e-3, 1.0]);
        let mut stats = Stats::default();
        let r = Radau5::new(3, 2, None).integrate(
            &mut Chain { exact },
            (0.0, 5.0),
            &[],
            &mut y,
            &mut q,
            &o,
            &mut stats,
            &mut |_, _| Flow::Continue,
        );
        assert!(r.is_ok());
        let worst = (y.iter().sum::<f64>() + q.iter().sum::<f64>() - 2.001).abs();
        // Rounding of sums of order 10 over some hundred steps. The quotients of a difference Jacobian carry a rounding
        // of about 1e-2 (in 1e6); what it breaks is made good by the next iteration, so only the last increments, well below
        // rtol of 1e-3, pass through it: 1e-2 * 1e-3 rtol * 1e-3 over 5 units of time, and a factor 2.
        let bound = 1e-13 + if exact { 0.0 } else { 1e-7 * rtol };
        assert!(worst < bound, "{exact} {rtol:e} {worst:e} {stats:?}");
    }
}

/// Refuses negative states, which a large first step produces.
struct Refusing;
impl OdeSystem for Refusing {
    fn dim(&self) -> usize {
        1
    }
    fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        if y[0] < 0.0 {
            return Err(EvalError::recoverable("test", "negative"));
        }
        if t > 2.0 {
            return Err(EvalError::fatal("test", "beyond 2"));
        }
        f[0] = -50.0 * y[0].sqrt();
        Ok(())
    }
}

#[test]
fn refusals_shrink_the_step_and_fatal_ones_stop() {
    let mut o = Options::new(1e-6, &[1.0]);
    o.h_init = 0.3;
    let mut stats = Stats::default();
    let mut y = [100.0];
    let mut r = Radau5::new(1, 0, None);
    let go = |r: &mut Radau5, end: f64, y: &mut [f64], stats: &mut Stats| {
        r.integrate(&mut Refusing, (0.0, end), &[], y, &mut [], &o, stats, &mut |_, _| Flow::Continue)
    };
    let ok = go(&mut r, 0.35, &mut y, &mut stats);
    // sqrt(y) falls linearly: y(0.35) = (10 - 25 * 0.35)² = 1.5625; the error allowed is 1e-6 of 100 at the start.
    assert!(ok.is_ok() && (y[0] - 1.5625).abs() < 1e-4, "{ok:?} {y:?}");
    // sqrt(y) reaches 0 at t = 0.4: behind it there is no solution this system would take.
    let mut y = [100.0];
    match go(&mut r, 1.0, &mut y, &mut stats) {
        // On the way the state may land on 0 to rounding, where 0 is a solution too.
        Ok(_) => assert!(y[0].abs() < 1e-4, "{y:?}"),
        Err(IntegrateError::StepTooSmall { t, last, .. }) => {
            assert!((t - 0.4).abs() < 1e-3 && last.is_some(), "{t}")
        }
        Err(IntegrateError::Eval { t, .. }) => assert!((t - 0.4).abs() < 1e-3, "{t}"),
        Err(e) => panic!("{e}"),
    }
    let mut y = [1e6];
    let end = go(&mut r, 3.0, &mut y, &mut stats);
    assert!(matches!(end, Err(IntegrateError::Eval { source: EvalError::Fatal { .. }, .. })), "{end:?}");
    // What is left is the last accepted state.
    assert!(y[0] > 0.0 && y[0] < 1e6);
}

/// y' jumps at 1/3 and 2/3; which side of a jump belongs to it is left open.
struct Jumps {
    left: bool,
}
impl OdeSystem for Jumps {
    fn dim(&self) -> usize {
        1
    }
    fn quad_dim(&self) -> usize {
        1
    }
    fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        let behind = |b: f64| if self.left { t > b } else { t >= b };
        let s = if behind(2.0 / 3.0) {
            7.0
        } else if behind(1.0 / 3.0) {
            -100.0
        } else {
            1.0
        };
        (f[0], f[1]) = (s - y[0], s);
        Ok(())
    }
}

#[test]
fn jumps_at_breakpoints_are_seen_from_inside() {
    for left in [true, false] {
        let o = Options::new(1e-9, &[1.0]);
        let mut stats = Stats::default();
        let (mut y, mut q, mut seen) = ([0.0], [0.0], Vec::new());
        let r = Radau5::new(1, 1, None).integrate(
            &mut Jumps { left },
            (0.0, 1.0),
            &[0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0, 5.0],
            &mut y,
            &mut q,
            &o,
            &mut stats,
            &mut |_, v| {
                seen.push(v.t1());
                Flow::Continue
            },
        );
        assert!(r.is_ok());
        assert!([1.0 / 3.0, 2.0 / 3.0, 1.0].iter().all(|b| seen.contains(b)), "{seen:?}");
        let decay = (-1.0_f64 / 3.0).exp();
        let exact = [1.0, -100.0, 7.0].iter().fold(0.0, |y, s| s + (y - s) * decay);
        assert!((y[0] / exact - 1.0).abs() < 1e-8, "{y:?} {exact}");
        // Piecewise constant rates: the weights sum to 1.
        assert!((q[0] + 92.0 / 3.0).abs() < 1e-12, "{q:?}");
        // A jump seen from the wrong side costs a dozen rejections.
        assert!(stats.rejected <= 3, "{stats:?}");
    }
}

#[test]
fn limits_and_stops() {
    let mut o = Options::new(1e-6, &[1.0, 1.0]);
    o.max_steps = 5;
    let (mut y, mut q) = ([1.0, 3.0], [0.0; 2]);
    let mut r = Radau5::new(2, 2, None);
    let many =
        r.integrate(&mut Smooth, (0.0, 9.0), &[], &mut y, &mut q, &o, &mut Stats::default(), &mut |_, _| {
            Flow::Continue
        });
    assert!(matches!(many, Err(IntegrateError::TooManySteps { max: 5, .. })), "{many:?}");
    o.max_steps = 1000;
    let (mut y, mut q, mut at) = ([1.0, 3.0], [0.0; 2], 0.0);
    let h =
        r.integrate(&mut Smooth, (0.0, 9.0), &[], &mut y, &mut q, &o, &mut Stats::default(), &mut |_, v| {
            at = v.t1();
            if at > 1.0 { Flow::Stop } else { Flow::Continue }
        });
    assert!(at > 1.0 && at < 2.0 && (y[0] - at.sin().exp()).abs() < 1e-5, "{at} {y:?}");
    // The step handed back serves to go on with.
    assert!(h.is_ok_and(|h| h > 0.01 && h < 1.0));
}
