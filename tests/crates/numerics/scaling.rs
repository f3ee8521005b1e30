//! Nothing depends on units: with times, states or values in units that differ by a power of two, every number of a computation is
//! that power times its original, without a rounding, so steps, evaluations and results must be the same to the last bit.

use gudgeon_numerics::EvalError;
use gudgeon_numerics::gmres::Gmres;
use gudgeon_numerics::maximum::maximise;
use gudgeon_numerics::multigrid::{FivePoint, LineMultigrid, Role};
use gudgeon_numerics::ode::{Direction, EventAction, Flow, Integrator, OdeSystem, Options, Stats};
use gudgeon_numerics::orbit::{CycleMap, OrbitOptions, periodic_orbit};
use gudgeon_numerics::quadrature::integrate_adaptive;
use gudgeon_numerics::radau::Radau5;
use gudgeon_numerics::rodas::{Formula, Rodas};
use gudgeon_numerics::roots::{itp, newton_bracketed};
use gudgeon_numerics::table::{Pchip, PeriodicCubic};
use std::convert::Infallible;

/// Powers of two for times and for states.
const UNITS: [(f64, f64); 4] =
    [(1024.0, 1.0), (1.0, 4096.0), (1.0 / 65536.0, 1.0 / 256.0), (32.0, 1.0 / 1048576.0)];

/// A stiff relaxation towards a wave, an oscillator that bounces off a wall, and the work done, in units of `time` and `state`.
struct Scaled {
    time: f64,
    state: f64,
    wall: bool,
    hits: u32,
}

impl OdeSystem for Scaled {
    fn dim(&self) -> usize {
        3
    }
    fn quad_dim(&self) -> usize {
        1
    }
    fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        let (x, y) = (t / self.time, [y[0] / self.state, y[1] / self.state, y[2] / self.state]);
        let rate = self.state / self.time;
        // A refusal that the first guess of a large step meets.
        if y[0].abs() > 4.0 {
            return Err(EvalError::recoverable("scaled", "too far"));
        }
        f[0] = rate * (-2000.0 * (y[0] - (3.0 * x).sin()) + y[1] * y[2]);
        f[1] = rate * y[2];
        f[2] = rate * (-9.0 * y[1] - 0.5 * y[1] * y[1] * y[1] + y[0]);
        f[3] = rate * y[1] * y[2];
        Ok(())
    }
    fn n_events(&self) -> usize {
        usize::from(self.wall)
    }
    fn events(&mut self, _: f64, y: &[f64], g: &mut [f64]) -> Result<(), EvalError> {
        g[0] = y[1] + 0.3 * self.state;
        Ok(())
    }
    fn event_direction(&self, _: usize) -> Direction {
        Direction::Falling
    }
    fn on_event(&mut self, _: usize, _: f64, y: &mut [f64]) -> Result<EventAction, EvalError> {
        self.hits += 1;
        y[2] *= -0.75;
        Ok(EventAction::Restart)
    }
}

/// End state and quadrature, times of the steps, all in original units, and the work.
fn integrate(
    integrator: &mut dyn Integrator<Scaled>,
    (time, state): (f64, f64),
    wall: bool,
    rtol: f64,
    h_init: f64,
) -> (Vec<f64>, Stats) {
    let mut o = Options::new(rtol, &[state; 3]);
    o.atol_quad = vec![10.0 * rtol * state];
    o.h_init = h_init * time;
    let mut sys = Scaled { time, state, wall, hits: 0 };
    let (mut y, mut q, mut stats) = ([0.5 * state, 1.0 * state, 0.0], [0.0], Stats::default());
    let breakpoints = [1.0 * time, 2.5 * time];
    let mut seen = Vec::new();
    let mut middle = [0.0; 3];
    let done = integrator.integrate(
        &mut sys,
        (0.0, 4.0 * time),
        &breakpoints,
        &mut y,
        &mut q,
        &o,
        &mut stats,
        &mut |_, view| {
            seen.push(view.t1() / time);
            view.interpolate(0.5 * (view.t0() + view.t1()), &mut middle);
            seen.extend(middle.map(|y| y / state));
            Flow::Continue
        },
    );
    let h = done.unwrap();
    assert!(!wall || sys.hits > 2, "{}", sys.hits);
    seen.extend(y.map(|y| y / state));
    seen.push(q[0] / state);
    seen.push(h / time);
    (seen, stats)
}

#[test]
fn integrations_do_not_depend_on_units() {
    for method in 0..3 {
        for (rtol, h_init) in [(1e-3, 0.0), (1e-6, 0.0), (1e-9, 0.0), (1e-5, 2.0)] {
            let wall = method < 2;
            let run = |units: (f64, f64)| {
                let mut integrator: Box<dyn Integrator<Scaled>> = match method {
                    0 => Box::new(Rodas::with(Formula::Rodas5P, 3, 1, None)),
                    1 => Box::new(Rodas::with(Formula::Rodas3, 3, 1, None)),
                    _ => Box::new(Radau5::new(3, 1, None)),
                };
                integrate(integrator.as_mut(), units, wall, rtol, h_init)
            };
            let original = run((1.0, 1.0));
            for units in UNITS {
                let scaled = run(units);
                if h_init > 0.0 || units.0 == 1.0 {
                    assert_eq!(scaled.1, original.1, "{method} {rtol:e} {units:?}");
                    assert_eq!(scaled.0, original.0, "{method} {rtol:e} {units:?}");
                }
                // The first step is a product of powers 0.4 and 0.6 of times, whose rounding depends on the unit, and with it the times of
                // all steps and whether one is rejected. The ends agree as well as either is right: some tens of errors of the tolerance.
                let end = original.0.len() - 5..original.0.len() - 1;
                for (a, b) in scaled.0[end.clone()].iter().zip(&original.0[end]) {
                    assert!((a - b).abs() <= 30.0 * rtol, "{method} {rtol:e} {units:?}: {a} {b}");
                }
            }
        }
    }
}

/// A bent contraction of two states with a slow mode.
struct Map {
    unit: f64,
}

impl CycleMap for Map {
    fn dim(&self) -> usize {
        2
    }
    fn map(&mut self, y0: &[f64], y1: &mut [f64], _: f64) -> Result<f64, EvalError> {
        let y = [y0[0] / self.unit, y0[1] / self.unit];
        y1[0] = self.unit * (1.0 + 0.9 * y[0] - 0.02 * y[0] * y[0] + 0.1 * y[1]);
        y1[1] = self.unit * (0.5 - 0.6 * y[1] + 0.05 * y[0] * y[1]);
        Ok(1.0)
    }
    fn scale(&self, y: &[f64], s: &mut [f64]) {
        for (s, y) in s.iter_mut().zip(y) {
            *s = 0.5 * self.unit + y.abs();
        }
    }
}

#[test]
fn orbits_do_not_depend_on_units() {
    for accelerate in [true, false] {
        let options =
            OrbitOptions { tolerance: 1e-8, accuracy: 1e-11, max_cycles: 400, refinements: 0, accelerate };
        let run = |unit: f64| {
            let mut y = [0.0; 2];
            let mut report = periodic_orbit(&mut Map { unit }, &mut y, &options).unwrap();
            // What was learnt of the slope counts in units of the states.
            for c in &mut report.changes {
                c.start.iter_mut().chain(&mut c.change).for_each(|v| *v /= unit);
            }
            (y.map(|y| y / unit), report)
        };
        let original = run(1.0);
        assert!(original.1.converged);
        for unit in [1024.0, 1.0 / 65536.0] {
            assert_eq!(run(unit), original, "{unit}");
        }
    }
}

#[test]
fn roots_and_maxima_do_not_depend_on_units() {
    let f = |x: f64| (x - 0.3).powi(3) + 0.2 * (x - 0.3) + 0.001;
    let slope = |x: f64| 3.0 * (x - 0.3).powi(2) + 0.2;
    let bump = |x: f64| 1.0 / (1.0 + 40.0 * (x - 0.31) * (x - 0.31)) + 0.2 * x;
    let run = |x: f64, y: f64| {
        let r = itp(|t: f64| Ok::<_, Infallible>(y * f(t / x)), -x, 2.0 * x, 1e-10 * x).unwrap();
        let n = newton_bracketed(
            |t: f64| Ok::<_, Infallible>((y * f(t / x), y / x * slope(t / x))),
            -x,
            2.0 * x,
            1.7 * x,
            1e-10 * x,
        )
        .unwrap();
        let samples: Vec<(f64, f64)> =
            [0.0, 0.2, 0.5, 0.9, 1.0].iter().map(|s| (s * x, y * bump(*s))).collect();
        let mut calls = 0;
        let (at, top) = maximise(&samples, |t| {
            calls += 1;
            y * bump(t / x)
        });
        (r.x / x, r.other / x, r.evaluations, n.x / x, n.evaluations, at / x, top / y, calls)
    };
    let original = run(1.0, 1.0);
    for (x, y) in UNITS {
        assert_eq!(run(x, y), original, "{x} {y}");
    }
}

#[test]
fn integrals_and_tables_do_not_depend_on_units() {
    let at = [0.0, 0.1, 0.4, 0.5, 0.8, 1.3];
    let values = [0.0, 0.3, 0.2, 0.9, 1.1, 1.15];
    let run = |x: f64, y: f64| {
        let integral =
            integrate_adaptive(|t| y * (t / x).sqrt() * (1.0 + t / x), 0.0, x, 0.0, 1e-10).unwrap() / (x * y);
        let (a, v): (Vec<f64>, Vec<f64>) = (at.map(|a| a * x).into(), values.map(|v| v * y).into());
        let p = Pchip::new(a.clone(), v.clone()).unwrap();
        let q = Pchip::periodic(a.clone(), v.clone(), 2.0 * x).unwrap();
        let s = PeriodicCubic::new(a, v, 2.0 * x).unwrap();
        let mut out = vec![integral];
        for k in -30..60 {
            let t = 0.05 * f64::from(k) * x;
            for (value, derivative) in [p.eval(t), q.eval(t), s.eval(t)] {
                out.extend([value / y, derivative * x / y]);
            }
        }
        out
    };
    let original = run(1.0, 1.0);
    for (x, y) in UNITS {
        assert_eq!(run(x, y), original, "{x} {y}");
    }
}

#[test]
fn linear_solvers_do_not_depend_on_units() {
    let n = 12;
    let entry =
        |i: usize, j: usize| ((7 * i + 3 * j + i * j) % 11) as f64 / 11.0 + if i == j { 4.0 } else { 0.0 };
    let krylov = |a: f64, b: f64| {
        let right: Vec<f64> = (0..n).map(|i| b * (1.0 + i as f64)).collect();
        let mut x = vec![0.0; n];
        let mut gmres = Gmres::default();
        let left = gmres.solve(&right, &mut x, 1e-8, n, |x, y| {
            for i in 0..n {
                y[i] = (0..n).map(|j| a * entry(i, j) * x[j]).sum();
            }
        });
        (x.iter().map(|x| x * a / b).collect::<Vec<_>>(), left, gmres.iterations)
    };
    let grid = |a: f64, b: f64| {
        let (nx, ny) = (9, 13);
        let mut m = FivePoint::new(nx, ny, true);
        for k in 0..nx * ny {
            m.gx[k] = a * (1.0 + 0.37 * (k % 5) as f64);
            m.gy[k] = a * (0.5 + (k % 3) as f64);
            m.qx[k] = a * 2.0;
            m.hold[k] = 0.8 * a;
            m.role[k] = match k {
                _ if k < nx || k % 29 == 3 => Role::Fixed,
                _ if k % 7 == 2 => Role::Carried,
                _ => Role::Diffused,
            };
        }
        let right: Vec<f64> = (0..nx * ny).map(|k| b * ((k * 7) % 13) as f64).collect();
        let mut v = vec![0.0; nx * ny];
        let mut mg = LineMultigrid::new(nx, ny, true);
        mg.setup(&m).unwrap();
        let done = mg.solve(&right, &mut v, 1e-9 * b, 40);
        (v.iter().map(|v| v * a / b).collect::<Vec<_>>(), done.cycles, done.residual / b)
    };
    let (one, two) = (krylov(1.0, 1.0), grid(1.0, 1.0));
    assert!(one.1 <= 1e-8 && two.2 <= 1e-9);
    for (a, b) in UNITS {
        assert_eq!(krylov(a, b), one, "{a} {b}");
        assert_eq!(grid(a, b), two, "{a} {b}");
    }
}
