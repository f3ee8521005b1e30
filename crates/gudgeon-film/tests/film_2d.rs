//! Films along and across the motion against exact solutions, published values and one another.
#![allow(clippy::excessive_precision, reason = "reference values stand as they were computed")]
#![allow(missing_docs)]

use gudgeon_core::kinds::{
    Edge, Film2d, Film2dCtx, Film2dGrid, Film2dIn, Film2dOut, Film2dSpec, FilmMode, History,
};
use gudgeon_film::film_2d::{Cavitation, Direct, Flux, Multigrid, Off, Sor};

fn build(spec: &dyn Film2dSpec, grid: &Film2dGrid) -> Box<dyn Film2d> {
    spec.build(&Film2dCtx { grid }).unwrap()
}

fn field(grid: &Film2dGrid, f: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let line = |y: f64| grid.x.iter().map(move |&x| (x, y)).collect::<Vec<_>>();
    grid.y.iter().flat_map(|&y| line(y)).map(|(x, y)| f(x, y)).collect()
}

/// The slider of Woloszynski et al. 2015 with `k` × `k` square dimples, sampled as in study C4 of the public-domain program EHL-FBNS of E. Hansen.
fn textured(k: usize) -> (Film2dGrid, Vec<f64>) {
    let n = 30 * k + 2;
    let grid = Film2dGrid::uniform(n, n, 80e-3, 80e-3);
    let place = |i: usize| if i == 0 || i + 1 == n { 0 } else { (i - 1) % 30 + 1 };
    let h = (0..n * n)
        .map(|m| {
            let at = [place(m % n), place(m / n)];
            if at.iter().any(|&a| a <= 4 || a >= 27) {
                15e-6
            } else if at.iter().all(|&a| (6..=25).contains(&a)) {
                27e-6
            } else {
                21e-6
            }
        })
        .collect();
    (grid, h)
}

fn textured_in(h: &[f64]) -> Film2dIn<'_> {
    Film2dIn { p_cav: 30e3, edge_pressure: [100e3; 4], ..Film2dIn::new(h, 5.0, 3e-2) }
}

#[test]
fn look() {
    for k in [1, 2, 8, 10] {
        let (grid, h) = textured(k);
        let spec = Multigrid { flux: Flux::Node, tolerance: 1e-11, ..Multigrid::default() };
        let mut film = build(&spec, &grid);
        let t = std::time::Instant::now();
        let out = film.solve(&textured_in(&h));
        let t = t.elapsed();
        let dx = grid.x[1];
        let sum: f64 = film.pressure().iter().map(|p| (p - 100e3) * dx * dx).sum::<f64>() + 640.0;
        println!("{k} {t:?} {sum} {out:?}");
    }
}
