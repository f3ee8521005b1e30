//! A two-dimensional film allocates when it is built, not when it is solved.
#![allow(
    unsafe_code,
    reason = "a global allocator that counts is the only way to see allocations, and its trait is unsafe"
)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use gudgeon_core::kinds::{Film2dCtx, Film2dGrid, Film2dIn, Film2dSpec, FilmMode};
use gudgeon_film::film_2d::{Cavitation, Direct, Multigrid, Sor};

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
fn a_search_allocates_nothing() {
    let grid = Film2dGrid::uniform(30, 25, 1.0, 0.8);
    let h: Vec<f64> = (0..grid.len()).map(|k| 1.0 + 0.4 * ((k % 30) as f64 * 0.3).sin()).collect();
    let inp = Film2dIn { edge_pressure: [0.01; 4], ..Film2dIn::new(&h, 1.0, 1.0) };
    let mut p = vec![0.0; 2 * grid.len()];
    let modes = [FilmMode { u: 1.0, ..FilmMode::default() }, FilmMode { dhdt: &h, ..FilmMode::default() }];
    for cavitation in [Cavitation::MassConserving, Cavitation::SwiftStieber, Cavitation::HalfSommerfeld] {
        let specs: [&dyn Film2dSpec; 3] = [
            &Multigrid { cavitation, ..Multigrid::default() },
            &Direct { cavitation, ..Direct::default() },
            &Sor { cavitation, ..Sor::default() },
        ];
        for spec in specs {
            let mut film = spec.build(&Film2dCtx { grid: &grid }).unwrap();
            let before = COUNT.with(Cell::get);
            let first = film.solve(&inp).unwrap();
            let second = film.solve(&Film2dIn { u: -2.0, ..inp }).unwrap();
            film.solve_many(&inp, &modes, &mut p).unwrap();
            let after = COUNT.with(Cell::get);
            assert!(first.load > 0.0 && second.load > 0.0);
            assert_eq!(after - before, 0, "{spec:?}");
        }
    }
}
