//! The right-hand side of a whole ring pack and its Jacobian allocate nothing.
#![allow(
    unsafe_code,
    reason = "a global allocator that counts is the only way to see allocations, and its trait is unsafe"
)]

mod common;

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::path::Path;

use common::*;
use gudgeon_sim::case::RingPackCase;
use gudgeon_sim::ring_pack::assemble::assemble;
use gudgeon_sim::ring_pack::pack::Base;

thread_local! {
    // Per thread: the test harness allocates on its own.
    static COUNT: Cell<u64> = const { Cell::new(0) };
}

struct Counting;

fn count() {
    // A thread that ends may still free and allocate: those are not ours.
    let _ = COUNT.try_with(|c| c.set(c.get() + 1));
}

// SAFETY: every call is handed to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        unsafe { System.alloc(layout) }
    }
    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count();
        unsafe { System.alloc_zeroed(layout) }
    }
    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        unsafe { System.realloc(block, layout, size) }
    }
    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        unsafe { System.dealloc(block, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn a_right_hand_side_allocates_nothing() {
    for gas in ["orifice_network", "gap_orifice", "narrow_channel"] {
        let case = checked("turbo-diesel-120", &[&format!("models.gas_flow.model={gas}")]);
        let mut pack =
            assemble(case.of::<RingPackCase>().expect("a ring pack"), Path::new(".")).expect("assembles");
        let n = pack.layout.n;
        let mut y = vec![0.0; n];
        pack.initial(2e5, &mut y);
        let mut f = vec![0.0; n + 2 * pack.n_rings() + 1];
        let mut jac = vec![0.0; f.len() * n];
        let mut base = Base::default();
        let mut answered = 0;
        let mut before = 0;
        // Two cycles of states around the start: films, seats and pressures change with the angle. The first cycle may fill work
        // arrays.
        for k in 0..1440 {
            if k == 720 {
                before = COUNT.with(Cell::get);
                answered = 0;
            }
            let theta = f64::from(k % 720).to_radians();
            let mut z = y.clone();
            before += u64::from(k >= 720);
            for (i, z) in z.iter_mut().enumerate() {
                *z += 0.05 * (theta * (1.0 + 0.3 * i as f64)).sin();
            }
            if pack.rates(theta, &z, &mut f).is_ok()
                && pack.jacobian(&z, |_| 1e-7, &mut jac, &mut base).is_ok()
            {
                answered += 1;
            }
        }
        let allocations = COUNT.with(Cell::get) - before;
        assert!(answered > 600, "{gas}: {answered} of 720 states can be evaluated");
        // A state that a model refuses costs the text of its refusal.
        assert!(allocations <= 10 * (720 - answered), "{gas}: {allocations} allocations, {answered} answers");
    }
}
