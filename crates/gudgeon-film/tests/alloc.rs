//! Films allocate when they are built, not when they are solved.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

#[path = "../../../tests/tests/common/counting.rs"]
mod counting;

use counting::allocations;
use gudgeon_core::kinds::{
    Film1dCtx, Film1dIn, Film1dSpec, Film2dCtx, Film2dGrid, Film2dIn, Film2dSpec, FilmEnd, FilmMode, FilmTime,
};
use gudgeon_film::film_1d::{
    Complementarity, ElrodAdams, FrontTracking, LineProfile, LineSolver, ViscosityLoop,
};
use gudgeon_film::film_2d::{Cavitation, Direct, Multigrid, Sor};

#[test]
fn a_film_along_a_line_allocates_nothing() {
    // Parallel with dimples: many cavities, and as many fronts.
    let line = LineProfile::textured(0.01, 1e-6, 1e-6, 6, 0.4, 2e-6, 120).expect("a line");
    let n = line.panels();
    let mu = vec![0.01; n];
    let rates = vec![0.05; n];
    let mut content = vec![0.0; n + 1];
    let newton = Complementarity { solver: LineSolver::FischerBurmeister, ..Complementarity::default() };
    let specs: [&dyn Film1dSpec; 4] =
        [&Complementarity::default(), &newton, &FrontTracking::default(), &ElrodAdams::default()];
    for (k, spec) in specs.into_iter().enumerate() {
        let mut film = spec.build(&Film1dCtx { x: &line.x }).expect("a line");
        let mut viscosity = ViscosityLoop::new(n);
        film.full_content(&line.h_a, &line.h_b, &mut content);
        let inp = |u: f64, time| Film1dIn {
            h_a: &line.h_a,
            h_b: &line.h_b,
            mu: &mu,
            factors: None,
            u,
            ends: [FilmEnd::Flooded { p: 1e5 }; 2],
            p_cav: 0.0,
            time,
        };
        let before = allocations();
        for u in [2.0, -2.0, 0.0, 50.0] {
            let out = film.solve(&inp(u, FilmTime::Steady)).expect("a film");
            assert!(out.flux_error < 1e-9);
            let thickening = |p: f64, _: f64| 0.01 * (1e-8 * p).exp();
            viscosity.solve(&mut *film, &inp(u, FilmTime::Steady), thickening).expect("a film");
            if k < 2 {
                film.solve(&inp(u, FilmTime::Squeeze(&rates))).expect("a film");
            }
            if k != 2 {
                film.solve(&inp(u, FilmTime::Step { dt: 1e-4, content: &content })).expect("a film");
            }
        }
        assert_eq!(allocations() - before, 0, "model {k}");
    }
}

#[test]
fn a_film_along_and_across_allocates_nothing() {
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
            let before = allocations();
            let first = film.solve(&inp).unwrap();
            let second = film.solve(&Film2dIn { u: -2.0, ..inp }).unwrap();
            film.solve_many(&inp, &modes, &mut p).unwrap();
            let after = allocations();
            assert!(first.load > 0.0 && second.load > 0.0);
            assert_eq!(after - before, 0, "{spec:?}");
        }
    }
}
