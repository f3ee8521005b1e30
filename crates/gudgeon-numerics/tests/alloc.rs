//! The step loop of the integrators and one look-up of a table allocate nothing.
#![allow(
    unsafe_code,
    reason = "a counting global allocator is an unsafe trait; it only counts and forwards to the system's"
)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use gudgeon_core::EvalError;
use gudgeon_numerics::ode::{Direction, EventAction, Flow, Integrator, OdeSystem, Options, Stats};
use gudgeon_numerics::rodas::Rodas;

thread_local! {
    // Per thread: the test harness allocates on its own.
    static COUNT: Cell<u64> = const { Cell::new(0) };
}

struct Counting;

// SAFETY: every call is forwarded unchanged to the system allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, l: Layout) -> *mut u8 {
        // `try_with`: a thread that ends may allocate after its locals are gone.
        let _ = COUNT.try_with(|c| c.set(c.get() + 1));
        // SAFETY: as the caller promised.
        unsafe { System.alloc(l) }
    }
    unsafe fn dealloc(&self, p: *mut u8, l: Layout) {
        // SAFETY: as the caller promised.
        unsafe { System.dealloc(p, l) }
    }
    unsafe fn realloc(&self, p: *mut u8, l: Layout, n: usize) -> *mut u8 {
        let _ = COUNT.try_with(|c| c.set(c.get() + 1));
        // SAFETY: as the caller promised.
        unsafe { System.realloc(p, l, n) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// A stiff oscillator with a quadrature and an event that restarts.
struct Stiff;

impl OdeSystem for Stiff {
    fn dim(&self) -> usize {
        2
    }
    fn quad_dim(&self) -> usize {
        1
    }
    fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        if y[0].abs() > 1e3 {
            return Err(EvalError::recoverable("stiff", "out of range"));
        }
        (f[0], f[1], f[2]) = (y[1], 100.0 * (1.0 - y[0] * y[0]) * y[1] - y[0] + t.sin(), y[0] * y[0]);
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
    fn on_event(&mut self, _: usize, _: f64, _: &mut [f64]) -> Result<EventAction, EvalError> {
        Ok(EventAction::Restart)
    }
}

#[test]
fn rodas_allocates_only_when_made() {
    let mut m = Rodas::new(2, 1, None);
    let o = Options::new(1e-5, &[1.0, 1.0]);
    let mut run = || {
        let (mut y, mut q, mut stats) = ([2.0, 0.0], [0.0], Stats::default());
        let before = COUNT.with(Cell::get);
        let mut seen = 0.0;
        m.integrate(
            &mut Stiff,
            (0.0, 500.0),
            &[100.0, 250.0],
            &mut y,
            &mut q,
            &o,
            &mut stats,
            &mut |_, v| {
                seen += v.y1()[0];
                Flow::Continue
            },
        )
        .unwrap();
        (COUNT.with(Cell::get) - before, stats)
    };
    // The first call makes room for the event functions, whose number only the system knows.
    let (first, stats) = run();
    assert!(first <= 8, "{first} allocations in {stats:?}");
    assert!(stats.steps > 100 && stats.rejected > 0 && stats.events > 3, "{stats:?}");
    assert_eq!(run(), (0, stats));
}
