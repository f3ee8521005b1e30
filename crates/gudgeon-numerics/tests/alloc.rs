//! The step loops of the integrators allocate nothing: a long integration takes as many allocations as a short one.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

#[path = "../../../tests/tests/common/counting.rs"]
mod counting;

use gudgeon_numerics::EvalError;
use gudgeon_numerics::ode::{ColumnGroups, Flow, Integrator, OdeSystem, Options, Stats};
use gudgeon_numerics::radau::Radau5;
use gudgeon_numerics::rodas::Rodas;

/// A forced chain of oscillators with a stiff end, which now and then refuses a trial state.
struct Chain;
impl OdeSystem for Chain {
    fn dim(&self) -> usize {
        6
    }
    fn quad_dim(&self) -> usize {
        1
    }
    fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        if y[0].abs() > 5.0 {
            return Err(EvalError::recoverable("chain", "too far"));
        }
        for i in 0..3 {
            let below = if i > 0 { y[2 * i - 2] } else { (3.0 * t).sin() };
            f[2 * i] = y[2 * i + 1];
            f[2 * i + 1] = [1.0, 50.0, 1e6][i] * (below - y[2 * i] - 0.1 * y[2 * i + 1]) - y[2 * i].powi(3);
        }
        f[6] = y[0] * y[0];
        Ok(())
    }
}

fn allocations(integrator: &mut dyn Integrator<Chain>, cycles: u32) -> (u64, Stats) {
    let breakpoints: Vec<f64> = (0..=20 * cycles).map(|k| 0.25 * f64::from(k)).collect();
    let options = Options { h_init: 1.0, ..Options::new(1e-7, &[1.0; 6]) };
    let (mut y, mut q, mut stats) = ([0.0; 6], [0.0], Stats::default());
    let (mut steps, mut middle) = (0, [0.0; 6]);
    let before = counting::allocations();
    let end = 5.0 * f64::from(cycles);
    let result = integrator.integrate(
        &mut Chain,
        (0.0, end),
        &breakpoints,
        &mut y,
        &mut q,
        &options,
        &mut stats,
        &mut |_, view| {
            view.interpolate(0.5 * (view.t0() + view.t1()), &mut middle);
            steps += 1;
            Flow::Continue
        },
    );
    let count = counting::allocations() - before;
    assert!(result.is_ok(), "{result:?}");
    assert_eq!(steps, stats.steps);
    (count, stats)
}

#[test]
fn no_allocation_per_step() {
    let groups = || {
        // The last oscillator's rows do not depend on the first's states.
        let rows = vec![vec![1, 3, 6], vec![0, 1], vec![3, 5], vec![2, 3], vec![5], vec![4, 5]];
        Some(ColumnGroups { groups: vec![vec![0, 4], vec![1, 2], vec![3, 5]], rows })
    };
    for groups in [None, groups()] {
        let mut integrators: [Box<dyn Integrator<Chain>>; 2] =
            [Box::new(Rodas::new(6, 1, groups.clone())), Box::new(Radau5::new(6, 1, groups))];
        for integrator in &mut integrators {
            let (short, few) = allocations(integrator.as_mut(), 1);
            let (long, many) = allocations(integrator.as_mut(), 20);
            assert!(many.steps > 10 * few.steps && few.rejected > 0, "{few:?} {many:?}");
            assert_eq!(short, long, "{few:?} {many:?}");
        }
    }
}
