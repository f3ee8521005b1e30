//! The singly diagonally implicit method and the solver of its stages: order, stiffness, invariants, dense output, corners, refusals.

use gudgeon_numerics::EvalError;
use gudgeon_numerics::ode::{
    Flow, IntegrateError, Integrator, LinearInvariant, OdeSystem, Options, Stage, Stats,
};
use gudgeon_numerics::sdirk::{self, Sdirk};
use gudgeon_numerics::stages::{Ended, StageNewton};

/// Error and dense output for one component alone are those of a step.
#[test]
fn a_step_of_one_component() {
    // y = t² has no third derivative, and a parabola is its own dense output; y = t³ has 6.
    let rates = |f: fn(f64) -> f64| sdirk::PLACES.map(f);
    assert!(sdirk::error(rates(|x| 2.0 * x)).abs() < 1e-15);
    let cubic = sdirk::error(rates(|x| 3.0 * x * x));
    assert!(cubic > 0.01 && cubic < 1.0, "{cubic}");
    for x in [0.0, 0.3, 0.8, 1.0] {
        let y = sdirk::between([1.0, 5.0], [2.0, 6.0], 1.0, x);
        // Sums of four numbers of the order of one.
        assert!((y - (1.0 + 2.0 * x + 2.0 * x * x)).abs() < 1e-14, "{x}: {y}");
    }
    // A slope that would overshoot is limited.
    assert!(sdirk::between([0.0, 1.0], [90.0, 0.0], 1.0, 0.5) <= 1.0);
}

/// A system that solves its stages by Newton's method for all of its states.
struct Stages<F> {
    rates: F,
    newton: StageNewton,
    n: usize,
    quads: usize,
    invariants: Vec<LinearInvariant>,
}

impl<F: FnMut(f64, &[f64], &mut [f64])> Stages<F> {
    fn new(n: usize, quads: usize, rates: F) -> Self {
        Self { rates, newton: StageNewton::new(n), n, quads, invariants: Vec::new() }
    }
}

impl<F: FnMut(f64, &[f64], &mut [f64])> OdeSystem for Stages<F> {
    fn dim(&self) -> usize {
        self.n
    }
    fn quad_dim(&self) -> usize {
        self.quads
    }
    fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        (self.rates)(t, y, f);
        Ok(())
    }
    fn stage(&mut self, t: f64, stage: &Stage<'_>, y: &mut [f64], g: &mut [f64]) -> Result<(), EvalError> {
        let (n, rates) = (self.n, &mut self.rates);
        let mut f = vec![0.0; n + self.quads];
        // What stages add to the error is not what is tested here.
        let accuracy: Vec<f64> = stage.accuracy.iter().map(|a| 1e-6 * a).collect();
        self.newton.solve(y, stage.step, &accuracy, &mut |x, r| {
            rates(t, x, &mut f);
            (0..n).for_each(|i| r[i] = x[i] - stage.base[i] - stage.step * f[i]);
            Ok(())
        })?;
        rates(t, y, &mut f);
        g.copy_from_slice(&f[n..]);
        Ok(())
    }
    fn invariants(&self) -> &[LinearInvariant] {
        &self.invariants
    }
}

/// Solution `y0 = exp(sin t)`, `y1 = cos t + 2`; the quadrature is the integral of `y0`.
fn smooth(t: f64, y: &[f64], f: &mut [f64]) {
    f[0] = (y[1] - 2.0) * y[0];
    f[1] = -t.sin() + (y[0] - t.sin().exp());
    f[2] = y[0];
}

/// Errors of state and dense output, and the quadrature, with constant steps.
fn solve(h: f64, end: f64) -> [f64; 3] {
    // A tolerance that no error of a step reaches, and a largest step: constant steps.
    let mut o = Options::new(1e-2, &[1.0, 1.0]);
    (o.h_max, o.h_init) = (h, h);
    let (mut system, mut s) = (Stages::new(2, 1, smooth), Sdirk::new(2, 1));
    let (mut y, mut q, mut worst) = ([1.0, 3.0], [0.0], 0.0_f64);
    s.integrate(&mut system, (0.0, end), &[], &mut y, &mut q, &o, &mut Stats::default(), &mut |_, v| {
        let (mut out, at) = ([0.0; 2], v.t0() + 0.37 * (v.t1() - v.t0()));
        v.interpolate(at, &mut out);
        worst = worst.max((out[0] - at.sin().exp()).abs());
        Flow::Continue
    })
    .unwrap();
    [(y[0] - end.sin().exp()).abs(), worst, q[0]]
}

#[test]
fn order_two_of_state_dense_output_and_quadrature() {
    let exact = solve(0.001, 2.0)[2];
    // A quarter of the step twice: the next error term, and where the steps fall about the maximum inside, move the observed order by some tenths.
    let (a, b) = (solve(0.1, 2.0), solve(0.025, 2.0));
    let order = |a: f64, b: f64| (a / b).abs().log2() / 2.0;
    for (name, p) in [("state", order(a[0], b[0])), ("dense output", order(a[1], b[1]))] {
        assert!((1.7..2.4).contains(&p), "{name}: {p}");
    }
    let p = order(a[2] - exact, b[2] - exact);
    // The parabola adds an order where the states are exact; their error of order two is integrated with it.
    assert!((1.5..3.6).contains(&p), "quadrature: {p}");
}

#[test]
fn stiff_components_follow_their_equilibrium_and_errors_the_tolerance() {
    let rates = |t: f64, y: &[f64], f: &mut [f64]| f[0] = -1e7 * (y[0] - t.cos()) - t.sin();
    let error = |tolerance: f64| {
        let (mut system, mut s) = (Stages::new(1, 0, rates), Sdirk::new(1, 0));
        let mut o = Options::new(tolerance, &[1.0]);
        o.h_init = 1e-3;
        let (mut y, mut stats) = ([1.0], Stats::default());
        s.integrate(&mut system, (0.0, 10.0), &[], &mut y, &mut [], &o, &mut stats, &mut |_, _| {
            Flow::Continue
        })
        .unwrap();
        ((y[0] - 10f64.cos()).abs(), stats.steps)
    };
    let (loose, tight) = (error(1e-3), error(1e-5));
    // In the stiff limit the state is the equilibrium to rounding of the product with 1e7, and to the accuracy of the stages.
    assert!(loose.0 < 1e-3 && tight.0 < 1e-5, "{loose:?} {tight:?}");
    // On a component that follows its equilibrium the rates of the stages are means over them, and the estimate falls with the square of the step: a
    // hundredth of the tolerance costs ten times the steps, growth at the start apart.
    let more = tight.1 as f64 / loose.1 as f64;
    assert!((7.0..11.0).contains(&more), "{more}");
}

#[test]
fn linear_invariants_hold_to_rounding() {
    // What flows from one vessel to the next, and out: the outflow is the pivot.
    let rates = |t: f64, y: &[f64], f: &mut [f64]| {
        let inflow = 1.0 + t.sin();
        let out = y[1].abs().sqrt();
        (f[0], f[1]) = (inflow - 1e4 * (y[0] - y[1]), 1e4 * (y[0] - y[1]) - out);
        (f[2], f[3]) = (inflow, out);
    };
    let mut system = Stages::new(2, 2, rates);
    let terms = vec![(0, 1.0), (1, 1.0), (2, -1.0), (3, 1.0)];
    system.invariants = vec![LinearInvariant { pivot: 3, terms }];
    let mut s = Sdirk::new(2, 2);
    let mut o = Options::new(1e-3, &[1.0, 1.0]);
    o.h_init = 1e-3;
    let (mut y, mut q) = ([1.0, 1.0], [0.0, 0.0]);
    s.integrate(&mut system, (0.0, 20.0), &[], &mut y, &mut q, &o, &mut Stats::default(), &mut |_, _| {
        Flow::Continue
    })
    .unwrap();
    let closure = y[0] + y[1] - 2.0 - q[0] + q[1];
    // Rounding of some hundred steps of sums of the order of twenty.
    assert!(closure.abs() < 1e-12, "{closure}");
    // Without the invariant the outflow would miss what the stages lack.
    assert!((q[0] - 20.0 - (1.0 - 20f64.cos())).abs() < 1e-2, "{q:?}");
}

#[test]
fn dense_output_does_not_overshoot_a_fall_into_a_stop() {
    // A body falls onto a stiff stop and stays.
    let rates = |_: f64, y: &[f64], f: &mut [f64]| {
        let depth = (-y[0]).max(0.0);
        (f[0], f[1]) = (y[1], -1.0 + 1e8 * depth * (1.0 - 1e2 * y[1]).max(0.0));
    };
    let (mut system, mut s) = (Stages::new(2, 0, rates), Sdirk::new(2, 0));
    let mut o = Options::new(1e-3, &[1.0, 10.0]);
    o.h_init = 1e-3;
    let mut y = [1.0, 0.0];
    let mut beyond = 0.0_f64;
    s.integrate(&mut system, (0.0, 3.0), &[], &mut y, &mut [], &o, &mut Stats::default(), &mut |_, v| {
        let mut at = [0.0; 2];
        for k in 1..8 {
            v.interpolate(v.t0() + f64::from(k) / 8.0 * (v.t1() - v.t0()), &mut at);
            let ends = (v.y0()[0].min(v.y1()[0]), v.y0()[0].max(v.y1()[0]));
            beyond = beyond.max(ends.0 - at[0]).max(at[0] - ends.1);
        }
        Flow::Continue
    })
    .unwrap();
    // Rounding of values of the order of one.
    assert!(beyond <= 1e-15, "{beyond}");
    // It rests where the stop carries its weight, 1e-8 deep, within the accuracy asked.
    assert!(y[0].abs() < 1e-3 && y[1].abs() < 1e-2, "{y:?}");
}

#[test]
fn a_system_without_stages_is_refused() {
    struct Plain;
    impl OdeSystem for Plain {
        fn dim(&self) -> usize {
            1
        }
        fn rhs(&mut self, _: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
            f[0] = -y[0];
            Ok(())
        }
    }
    let o = Options::new(1e-3, &[1.0]);
    let outcome = Sdirk::new(1, 0).integrate(
        &mut Plain,
        (0.0, 1.0),
        &[],
        &mut [1.0],
        &mut [],
        &o,
        &mut Stats::default(),
        &mut |_, _| Flow::Continue,
    );
    assert!(matches!(outcome, Err(IntegrateError::Eval { .. })), "{outcome:?}");
}

#[test]
fn stages_with_a_corner_are_solved_and_hopeless_ones_refused() {
    let mut newton = StageNewton::new(2);
    let (base, step, accuracy) = ([1.0, -1.0], 0.5, [1e-9; 2]);
    let mut evaluations = 0;
    let mut residual = |x: &[f64], r: &mut [f64]| {
        evaluations += 1;
        r[0] = x[0] - base[0] - step * (-40.0 * x[0].max(0.0) + x[1]);
        r[1] = x[1] - base[1] - step * (x[0] - x[1].powi(3));
        Ok(())
    };
    let mut x = [1.0, -1.0];
    newton.solve(&mut x, step, &accuracy, &mut residual).unwrap();
    let mut r = [0.0; 2];
    residual(&x, &mut r).unwrap();
    // The answer is as good as asked, the matrix of the order of twenty.
    assert!(r[0].abs().max(r[1].abs()) < 2e-8, "{r:?}");
    let first = evaluations;
    evaluations_of_the_next(&mut newton, &mut x, step, &accuracy, first);
    // No number solves x = 1 + x² with a step of one.
    let mut none = |x: &[f64], r: &mut [f64]| {
        r[0] = x[0] - 1.0 - x[0] * x[0];
        Ok(())
    };
    let refused = StageNewton::new(1).solve(&mut [0.0], 1.0, &[1e-9], &mut none);
    assert!(refused.is_err_and(|e| e.is_recoverable()));
}

/// Where solutions may be foreseen, two in turn end a look earlier, as near as is asked, and the next one is looked at again.
#[test]
fn solutions_are_foreseen_by_the_contraction_of_those_before() {
    // x' = sin x + x/10 about a point that moves on: chords of a Jacobian that is kept contract a hundredfold or so.
    let (s, accuracy) = (0.3, [1e-2]);
    let ends = |foresees: bool| -> Vec<(Ended, usize)> {
        let mut newton = StageNewton::new(1);
        newton.foresee(foresees);
        let solve = |k: usize| {
            let (base, mut x, mut looks) = (0.2 + 0.01 * k as f64, [0.25 + 0.01 * k as f64], 0);
            let missing = |x: f64| x - base - s * (x.sin() + 0.1 * x);
            let ended = newton.solve(&mut x, s, &accuracy, &mut |x, r| {
                looks += 1;
                r[0] = missing(x[0]);
                Ok(())
            });
            // The residual falls with the solution by 1 - 0.4 at least.
            let off = missing(x[0]).abs() / 0.6;
            assert!(off <= accuracy[0], "solution {k} is {off:e} off");
            (ended.expect("a solution"), looks)
        };
        (0..7).map(solve).collect()
    };
    let (seen, foreseen) = (ends(false), ends(true));
    assert!(seen.iter().all(|(ended, _)| *ended == Ended::Seen), "{seen:?}");
    let of = |all: &[(Ended, usize)], k: usize| all[k].1;
    assert!(
        foreseen[1..].windows(3).all(|w| w.iter().filter(|(e, _)| *e == Ended::Foreseen).count() == 2),
        "{foreseen:?}"
    );
    for (k, (ended, _)) in foreseen.iter().enumerate() {
        assert_eq!(
            of(&foreseen, k) + usize::from(*ended == Ended::Foreseen),
            of(&seen, k),
            "{seen:?} {foreseen:?}"
        );
    }
}

/// A small space beside a wide passage: its gas goes with the root of a pressure difference, and Newton's method steps over the root and back. What such a step
/// saw is learnt from, and a Jacobian that is given need not be found.
#[test]
fn a_step_over_the_root_of_a_difference_is_learnt_from() {
    // x = b + s C sign(1 - x) sqrt|1 - x| has the solution 1 - (b - 1)²/(s C)², nearly.
    let (base, step, c) = ([0.9, 0.5], 0.05, 200.0);
    let count = |given: bool| {
        let mut newton = StageNewton::new(2);
        let mut evaluations = 0;
        let mut x = [0.93, 0.5];
        if given {
            newton.set_jacobian(|r, k| if r == k { [-0.5 * c / 0.07_f64.sqrt(), -1.0][r] } else { 0.0 });
        }
        newton
            .solve(&mut x, step, &[1e-9; 2], &mut |x, r| {
                evaluations += 1;
                let d: f64 = 1.0 - x[0];
                r[0] = x[0] - base[0] - step * c * d.signum() * d.abs().sqrt();
                r[1] = x[1] - base[1] + step * x[1];
                Ok(())
            })
            .unwrap();
        let lacks = x[0] - base[0] - step * c * (1.0 - x[0]).sqrt();
        // As good as asked; next to the root the slope is some thousand.
        assert!(lacks.abs() < 1e-5, "{lacks:e}");
        evaluations
    };
    let (found, given) = (count(false), count(true));
    // By shorter steps alone it took 18 and 19.
    assert!(found <= 18 && given <= 16, "{found} {given}");
}

/// A stage of another step is solved with the Jacobian that is known: in fewer evaluations than the first, which took one.
fn evaluations_of_the_next(
    newton: &mut StageNewton,
    x: &mut [f64; 2],
    step: f64,
    accuracy: &[f64],
    first: u32,
) {
    let (step, mut evaluations) = (1.1 * step, 0);
    newton
        .solve(x, step, accuracy, &mut |x, r| {
            evaluations += 1;
            r[0] = x[0] - 1.0 - step * (-40.0 * x[0].max(0.0) + x[1]);
            r[1] = x[1] + 1.0 - step * (x[0] - x[1].powi(3));
            Ok(())
        })
        .unwrap();
    assert!(evaluations < first, "{evaluations} {first}");
}

/// Steps of an integration that are taken again: with the same ends from another start, and in parts where the error has grown beyond what is let pass.
#[test]
fn known_steps_are_taken_again() {
    let run = |start: f64, ends: &[f64], slack: f64| {
        let (mut system, mut s) = (Stages::new(2, 1, smooth), Sdirk::new(2, 1));
        let mut o = Options::new(1e-4, &[1.0, 1.0]);
        (o.ends, o.slack) = (ends.to_vec(), slack);
        let (mut y, mut q, mut seen) = ([start, 3.0], [0.0], Vec::new());
        let mut stats = Stats::default();
        s.integrate(&mut system, (0.0, 2.0), &[0.7], &mut y, &mut q, &o, &mut stats, &mut |_, v| {
            seen.push(v.t1());
            Flow::Continue
        })
        .unwrap();
        (seen, y, q, stats.rejected)
    };
    let first = run(1.0, &[], 1.0);
    let again = run(1.0, &first.0, 10.0);
    assert_eq!((&again.0, again.3), (&first.0, 0));
    // The length of a step is now a difference of its ends: some roundings of numbers of the order of one in each of two dozen steps.
    assert!((again.1[0] - first.1[0]).abs() + (again.2[0] - first.2[0]).abs() < 1e-13, "{again:?} {first:?}");
    assert_eq!(run(1.02, &first.0, 10.0).0, first.0);
    // Every other end, the last one among them: errors are up to eight times those admitted, and all of these ends are met.
    let half: Vec<f64> = first.0.iter().skip(1 - first.0.len() % 2).step_by(2).copied().collect();
    let parts = run(1.0, &half, 1.0);
    assert!(parts.3 > 0 && half.iter().all(|end| parts.0.contains(end)), "{parts:?}");
}
