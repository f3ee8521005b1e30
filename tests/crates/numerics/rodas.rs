//! Rosenbrock methods: orders, invariants, linear solvers of the system, refusals.

use gudgeon_numerics::EvalError;
use gudgeon_numerics::ode::{Flow, IntegrateError, Integrator, OdeSystem, Options, Stats};
use gudgeon_numerics::rodas::{Formula, Rodas};

/// y' = -y² sin-forced and coupled: smooth, nonlinear, non-autonomous, with a known solution.
struct Smooth;
impl OdeSystem for Smooth {
    fn dim(&self) -> usize {
        2
    }
    fn quad_dim(&self) -> usize {
        1
    }
    fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        // Solution y0 = e^{sin t}, y1 = cos t + 2.
        f[0] = (y[1] - 2.0) * y[0];
        f[1] = -t.sin() + (y[0] - t.sin().exp());
        f[2] = y[0];
        Ok(())
    }
}

fn solve(formula: Formula, h: f64, t: f64, dense: Option<f64>) -> [f64; 3] {
    // A huge tolerance and a fixed largest step: constant steps.
    let mut o = Options::new(1e3, &[1.0, 1.0]);
    (o.h_max, o.h_init) = (h, h);
    let (mut y, mut q) = ([1.0, 3.0], [0.0]);
    let mut r = Rodas::with(formula, 2, 1, None);
    let mut worst: f64 = 0.0;
    let mut out = [0.0; 2];
    let result =
        r.integrate(&mut Smooth, (0.0, t), &[], &mut y, &mut q, &o, &mut Stats::default(), &mut |_, v| {
            if let Some(x) = dense {
                let t = v.t0() + x * (v.t1() - v.t0());
                v.interpolate(t, &mut out);
                worst = worst.max((out[0] - t.sin().exp()).abs());
            }
            Flow::Continue
        });
    assert!(result.is_ok());
    [(y[0] - t.sin().exp()).abs(), worst, q[0]]
}

#[test]
fn orders_of_state_dense_output_and_quadrature() {
    // Steps fifty times shorter, of order 5: an error 3e8 times smaller.
    let exact = solve(Formula::Rodas5P, 0.002, 2.0, None)[2];
    for (formula, order, dense) in [(Formula::Rodas5P, 5.0, 4.0), (Formula::Rodas3, 3.0, 2.0)] {
        let observed = |a: f64, b: f64| (a / b).log2();
        let (a, b) = (solve(formula, 0.1, 2.0, None), solve(formula, 0.05, 2.0, None));
        // The difference Jacobian and the next error term move the observed value by a few tenths.
        let p = observed(a[0], b[0]);
        assert!((order - 0.4..order + 0.7).contains(&p), "{formula:?} {p}");
        let p = observed((a[2] - exact).abs(), (b[2] - exact).abs());
        assert!((order - 0.5..order + 1.2).contains(&p), "{formula:?} quadrature {p}");
        let (a, b) = (solve(formula, 0.1, 2.0, Some(0.37))[1], solve(formula, 0.05, 2.0, Some(0.37))[1]);
        // Global order of the interpolant; its local error is one order higher.
        let p = observed(a, b);
        assert!((dense - 0.3..dense + 1.5).contains(&p), "{formula:?} dense {p}");
    }
}

/// A stiff exchange between two vessels, one of them tiny, and the outside: a linear invariant of states and quadratures.
struct Vessels {
    exact: bool,
}
impl OdeSystem for Vessels {
    fn dim(&self) -> usize {
        2
    }
    fn quad_dim(&self) -> usize {
        1
    }
    fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        let a = 1e6 * (y[0] - 1e4 * y[1]) * (1.0 + (3.0 * t).sin().abs());
        let b = y[0] * y[0].abs();
        (f[0], f[1], f[2]) = (-a - b, a, b);
        Ok(())
    }
    fn jacobian(&mut self, t: f64, y: &[f64], _: &[f64], jac: &mut [f64]) -> Result<bool, EvalError> {
        let r = 1e6 * (1.0 + (3.0 * t).sin().abs());
        let b = 2.0 * y[0].abs();
        jac.copy_from_slice(&[-r - b, 1e4 * r, r, -1e4 * r, b, 0.0]);
        Ok(self.exact)
    }
}

#[test]
fn linear_invariants_hold_at_a_loose_tolerance() {
    // With an exact Jacobian the defect is round-off amplified by the solves (condition number about 1e4). A difference
    // Jacobian satisfies the invariant only to eps |f| / increment, 1e-16 * 1e6 / 1e-12 of entries of 1e10.
    for (exact, bound) in [(true, 1e-12), (false, 1e-9)] {
        let (mut y, mut q) = ([1.0, 2e-4], [0.0]);
        let o = Options::new(1e-2, &[1.0, 1e-4]);
        let mut stats = Stats::default();
        let r = Rodas::new(2, 1, None).integrate(
            &mut Vessels { exact },
            (0.0, 10.0),
            &[],
            &mut y,
            &mut q,
            &o,
            &mut stats,
            &mut |_, _| Flow::Continue,
        );
        assert!(r.is_ok());
        let defect = (y[0] + y[1] + q[0] - 1.0002).abs();
        assert!(defect < bound, "{defect:e}");
        // An L-stable method does not follow the fast exchange.
        assert!(stats.steps < 200, "{stats:?}");
    }
}

/// A pendulum with damping that inverts its two by two matrix by hand.
#[derive(Default)]
struct Own {
    j: [f64; 2],
    d: f64,
}
impl OdeSystem for Own {
    fn dim(&self) -> usize {
        2
    }
    fn rhs(&mut self, _: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        (f[0], f[1]) = (y[1], -40.0 * y[0].sin() - 900.0 * y[1]);
        Ok(())
    }
    fn linearise(&mut self, _: f64, y: &[f64], _: &[f64]) -> Result<(), EvalError> {
        self.j = [-40.0 * y[0].cos(), -900.0];
        Ok(())
    }
    fn factor(&mut self, d: f64) -> bool {
        self.d = d;
        d * (d - self.j[1]) - self.j[0] != 0.0
    }
    fn solve(&mut self, b: &mut [f64]) {
        // [d, -1; -j0, d - j1] x = b
        let det = self.d * (self.d - self.j[1]) - self.j[0];
        let x = ((self.d - self.j[1]) * b[0] + b[1]) / det;
        (b[0], b[1]) = (x, self.d * x - b[0]);
    }
}

#[test]
fn a_system_that_solves_for_itself_is_the_same() {
    let mut found = [[0.0; 2]; 2];
    for (y, mut r) in found.iter_mut().zip([Rodas::new(2, 0, None), Rodas::structured(Formula::Rodas5P, 2)]) {
        *y = [2.0, 0.0];
        let o = Options::new(1e-8, &[1.0, 1.0]);
        let mut stats = Stats::default();
        let done =
            r.integrate(&mut Own::default(), (0.0, 9.0), &[], y, &mut [], &o, &mut stats, &mut |_, _| {
                Flow::Continue
            });
        assert!(done.is_ok() && stats.lu > 10);
    }
    // The difference Jacobian of the first is good to 1e-8; what that does to the result is below the tolerance.
    for (a, b) in found[0].iter().zip(found[1]) {
        assert!((a - b).abs() < 1e-9, "{found:?}");
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

#[test]
fn robertson_at_40() {
    let mut y = [1.0, 0.0, 0.0];
    let o = Options::new(1e-7, &[1.0, 1e-5, 1.0]);
    let r = Rodas::new(3, 0, None).integrate(
        &mut Robertson,
        (0.0, 40.0),
        &[],
        &mut y,
        &mut [],
        &o,
        &mut Stats::default(),
        &mut |_, _| Flow::Continue,
    );
    assert!(r.is_ok());
    // Independent 18-digit solution; the global error may exceed the tolerance per step by the number of steps' share.
    for (y, exact) in
        y.iter().zip([0.715_827_068_719_405, 9.185_534_764_557_764e-6, 0.284_163_745_745_830_36])
    {
        assert!((y / exact - 1.0).abs() < 1e-6, "{y} {exact}");
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
    let mut o = Options::new(1e-3, &[1.0]);
    o.h_init = 0.3;
    let mut stats = Stats::default();
    let mut y = [100.0];
    let mut r = Rodas::new(1, 0, None);
    let ok = r.integrate(&mut Refusing, (0.0, 0.35), &[], &mut y, &mut [], &o, &mut stats, &mut |_, _| {
        Flow::Continue
    });
    // sqrt(y) falls linearly: y(0.35) = (10 - 25 * 0.35)².
    assert!(ok.is_ok() && (y[0] - 1.5625).abs() < 1e-2, "{ok:?} {y:?}");
    let mut y = [1e6];
    let end = r.integrate(&mut Refusing, (0.0, 3.0), &[], &mut y, &mut [], &o, &mut stats, &mut |_, _| {
        Flow::Continue
    });
    assert!(matches!(end, Err(IntegrateError::Eval { .. })), "{end:?}");
}

#[test]
fn stops_exactly_at_breakpoints() {
    let mut seen = Vec::new();
    let (mut y, mut q) = ([1.0, 3.0], [0.0]);
    let o = Options::new(1e-3, &[1.0, 1.0]);
    let r = Rodas::new(2, 1, None).integrate(
        &mut Smooth,
        (0.0, 2.0),
        &[0.0, 0.5, 1.25, 2.0],
        &mut y,
        &mut q,
        &o,
        &mut Stats::default(),
        &mut |_, v| {
            seen.push(v.t1());
            Flow::Continue
        },
    );
    assert!(r.is_ok());
    assert!([0.5, 1.25, 2.0].iter().all(|b| seen.contains(b)), "{seen:?}");
}

/// A linear system with its Jacobian and the derivative by time: nothing is differenced.
struct Given;
impl OdeSystem for Given {
    fn dim(&self) -> usize {
        2
    }
    fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        (f[0], f[1]) = (-50.0 * (y[0] - t.cos()), y[0] - y[1]);
        Ok(())
    }
    fn jacobian(&mut self, _: f64, _: &[f64], _: &[f64], jac: &mut [f64]) -> Result<bool, EvalError> {
        jac.copy_from_slice(&[-50.0, 0.0, 1.0, -1.0]);
        Ok(true)
    }
    fn time_derivative(&mut self, t: f64, _: &[f64], _: &[f64], d: &mut [f64]) -> Result<bool, EvalError> {
        (d[0], d[1]) = (-50.0 * t.sin(), 0.0);
        Ok(true)
    }
}

#[test]
fn the_work_of_a_step_is_that_of_its_stages() {
    for (formula, calls, solves) in [(Formula::Rodas5P, 7, 8), (Formula::Rodas3, 2, 4)] {
        let o = Options { h_init: 0.5, ..Options::new(1e-6, &[1.0; 2]) };
        let s = Rodas::with(formula, 2, 0, None).solve(&mut Given, (0.0, 10.0), &mut [0.0; 2], &o).unwrap();
        let tried = s.steps + s.rejected;
        assert_eq!((s.jacobians, s.lu, s.solves), (s.steps, tried, solves * tried));
        // One at the start, one at the end of every step that is accepted.
        assert_eq!(s.rhs, 1 + calls * tried + s.steps);
        assert!(s.rejected > 0 && s.rejected * 5 < s.steps, "{s:?}");
    }
}

#[test]
fn first_steps_fit_the_solution() {
    // Without a first step the integrator finds one: it loses neither many steps to growth nor many to rejection, whatever the rate.
    for rate in [1e-3, 1.0, 1e3, 1e6] {
        struct Decay(f64);
        impl OdeSystem for Decay {
            fn dim(&self) -> usize {
                1
            }
            fn rhs(&mut self, _: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
                f[0] = -self.0 * y[0];
                Ok(())
            }
        }
        let mut first = 0.0;
        let (mut y, mut s) = ([1.0], Stats::default());
        let o = Options::new(1e-6, &[1.0]);
        let mut r = Rodas::new(1, 0, None);
        let done = r.integrate(
            &mut Decay(rate),
            (0.0, 5.0 / rate),
            &[],
            &mut y,
            &mut [],
            &o,
            &mut s,
            &mut |_, v| {
                if first == 0.0 {
                    first = v.t1() * rate;
                }
                Flow::Continue
            },
        );
        assert!(done.is_ok() && (y[0] - (-5.0_f64).exp()).abs() < 1e-6, "{y:?}");
        // The guess is that of a method of order 1, raised towards one of order 5: cautious, but growth by six a step makes it good soon.
        assert!((1e-5..0.1).contains(&first) && s.rejected == 0 && s.steps < 20, "{rate}: {first} {s:?}");
    }
}
