//! What cannot be integrated is refused before the first step, by both integrators and with the state untouched.

use gudgeon_numerics::EvalError;
use gudgeon_numerics::ode::{
    ColumnGroups, Flow, IntegrateError, Integrator, LinearInvariant, OdeSystem, Options, Stats,
};
use gudgeon_numerics::radau::Radau5;
use gudgeon_numerics::rodas::Rodas;

/// Exchange between two states, with the outflow as quadrature.
struct Exchange {
    dim: usize,
    quad: usize,
    invariants: Vec<LinearInvariant>,
    called: bool,
}

impl OdeSystem for Exchange {
    fn dim(&self) -> usize {
        self.dim
    }
    fn quad_dim(&self) -> usize {
        self.quad
    }
    fn rhs(&mut self, _: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        self.called = true;
        (f[0], f[1], f[2]) = (y[1] - y[0], y[0] - 2.0 * y[1], y[1]);
        Ok(())
    }
    fn invariants(&self) -> &[LinearInvariant] {
        &self.invariants
    }
}

/// A call that is right in everything, to be spoiled in one respect.
struct Call {
    sys: Exchange,
    interval: (f64, f64),
    breakpoints: Vec<f64>,
    y: Vec<f64>,
    q: Vec<f64>,
    options: Options,
    groups: Option<ColumnGroups>,
}

fn right() -> Call {
    let terms = vec![(0, 1.0), (1, 1.0), (2, 1.0)];
    let mut options = Options::new(1e-6, &[1.0, 1.0]);
    options.atol_quad = vec![1e-6];
    options.absolute = vec![false, true];
    Call {
        sys: Exchange {
            dim: 2,
            quad: 1,
            invariants: vec![LinearInvariant { pivot: 2, terms }],
            called: false,
        },
        interval: (0.0, 1.0),
        breakpoints: vec![0.25, 0.5, 0.5],
        y: vec![1.0, 0.5],
        q: vec![0.25],
        options,
        groups: Some(ColumnGroups::from_pattern(vec![vec![0, 1], vec![0, 1, 2]])),
    }
}

fn run(radau: bool, mut c: Call) -> Result<f64, String> {
    let mut integrator: Box<dyn Integrator<Exchange>> =
        if radau { Box::new(Radau5::new(2, 1, c.groups)) } else { Box::new(Rodas::new(2, 1, c.groups)) };
    let (y, q, mut stats) = (c.y.clone(), c.q.clone(), Stats::default());
    let done = integrator.integrate(
        &mut c.sys,
        c.interval,
        &c.breakpoints,
        &mut c.y,
        &mut c.q,
        &c.options,
        &mut stats,
        &mut |_, _| Flow::Continue,
    );
    match done {
        Ok(h) => Ok(h),
        Err(IntegrateError::Input { what }) => {
            let bits = |v: &[f64]| v.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
            assert!(bits(&y) == bits(&c.y) && bits(&q) == bits(&c.q) && stats == Stats::default());
            assert!(!c.sys.called, "the system was evaluated");
            Err(what.to_owned())
        }
        Err(e) => panic!("{e}"),
    }
}

#[test]
fn each_mistake_is_named() {
    type Spoil = fn(&mut Call);
    let term = |row: usize, c: f64| LinearInvariant { pivot: 2, terms: vec![(row, c), (2, 1.0)] };
    let nan = f64::NAN;
    let mistakes: Vec<(Spoil, &str)> = vec![
        (|c| c.sys.dim = 3, "dimensions"),
        (|c| c.sys.quad = 2, "dimensions"),
        (|c| c.y.push(0.0), "wrong length"),
        (|c| c.q.clear(), "wrong length"),
        (|c| c.interval.0 = f64::NEG_INFINITY, "interval"),
        (|c| c.interval.1 = f64::NAN, "interval"),
        (|c| c.interval = (1.0, 0.0), "interval"),
        (|c| c.breakpoints = vec![0.5, 0.25], "breakpoints"),
        (|c| c.breakpoints = vec![0.25, f64::NAN], "breakpoints"),
        (|c| c.y[1] = f64::INFINITY, "initial state"),
        (|c| c.q[0] = f64::NAN, "initial state"),
        (|c| c.options.rtol = -1e-3, "relative tolerance"),
        (|c| c.options.rtol = f64::INFINITY, "relative tolerance"),
        (|c| c.options.atol.push(1.0), "absolute tolerance has"),
        (|c| c.options.absolute.push(true), "absolute tolerance has"),
        (|c| c.options.atol_quad.push(1.0), "absolute tolerance has"),
        (|c| c.options.atol[0] = -1.0, "absolute tolerance is"),
        (|c| c.options.atol_quad[0] = f64::NAN, "absolute tolerance is"),
        (|c| (c.options.rtol, c.options.atol[0]) = (0.0, 0.0), "both zero"),
        // The second state is judged by its absolute tolerance alone.
        (|c| c.options.atol[1] = 0.0, "both zero"),
        (|c| c.groups.as_mut().unwrap().rows.truncate(1), "column groups"),
        (|c| c.groups.as_mut().unwrap().groups.push(vec![2]), "column groups"),
        (|c| c.groups.as_mut().unwrap().rows[0].push(3), "column groups"),
    ];
    for radau in [false, true] {
        assert!(run(radau, right()).is_ok());
        for (k, (spoil, what)) in mistakes.iter().enumerate() {
            let mut call = right();
            spoil(&mut call);
            let refused = run(radau, call);
            assert!(refused.as_ref().is_err_and(|e| e.contains(what)), "{radau} {k}: {refused:?}");
        }
        for bad in [term(3, 1.0), term(0, nan), LinearInvariant { pivot: 2, terms: vec![(0, 1.0)] }] {
            let mut call = right();
            call.sys.invariants = vec![bad];
            let refused = run(radau, call);
            assert!(refused.as_ref().is_err_and(|e| e.contains("invariant")), "{radau}: {refused:?}");
        }
    }
}

#[test]
fn what_may_be_left_out_is_not_refused() {
    for radau in [false, true] {
        let mut call = right();
        call.options.absolute.clear();
        call.options.atol_quad.clear();
        call.options.atol = vec![0.0, 0.0];
        call.breakpoints.clear();
        call.groups = None;
        call.sys.invariants.clear();
        assert!(run(radau, call).is_ok());
        // An interval without length is a result, not a mistake.
        let mut call = right();
        call.interval = (1.0, 1.0);
        assert!(run(radau, call).is_ok());
    }
}
