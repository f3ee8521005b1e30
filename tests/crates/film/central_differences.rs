//! Central differences of the expanded equation: order, walls as mirrors, sweeps against elimination.

use std::f64::consts::PI;

use gudgeon_core::kinds::{Edge, Film2dCtx, Film2dGrid, Film2dIn, Film2dOut, Film2dSpec};
use gudgeon_film::film_2d::{Cavitation, CentralDifferences, Direct, Equations};

const ELIMINATION: CentralDifferences =
    CentralDifferences { cavitation: Cavitation::FullSommerfeld, equations: Equations::Elimination };
const SWEEPS: CentralDifferences = CentralDifferences { equations: Equations::Sweeps, ..ELIMINATION };

fn solved(spec: &dyn Film2dSpec, grid: &Film2dGrid, inp: &Film2dIn<'_>) -> (Film2dOut, Vec<f64>) {
    let mut film = spec.build(&Film2dCtx { grid }).expect("a film");
    let out = film.solve(inp).expect("a pressure");
    (out, film.pressure().to_vec())
}

fn field(grid: &Film2dGrid, f: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    grid.y.iter().flat_map(|&y| grid.x.iter().map(move |&x| (x, y))).map(|(x, y)| f(x, y)).collect()
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    let top = a.iter().chain(b).fold(0.0_f64, |m, v| m.max(v.abs()));
    a.iter().zip(b).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())) / top
}

#[test]
fn it_tends_to_the_film_of_the_control_volumes_with_second_order() {
    let mut errors = Vec::new();
    for n in [9, 17, 33] {
        let grid = Film2dGrid::uniform(n, 2 * n - 1, 0.04, 0.05);
        let h = field(&grid, |x, y| 20e-6 * (2.0 - 20.0 * x + 0.3 * (40.0 * PI * y).cos()));
        let dhdt = field(&grid, |x, y| 1e-3 * (1.0 + 30.0 * x * (20.0 * PI * y).sin()));
        let inp =
            Film2dIn { dhdt: &dhdt, edge_pressure: [1e5, 3e5, 2e5, 4e5], ..Film2dIn::new(&h, 3.0, 0.02) };
        let (out, p) = solved(&ELIMINATION, &grid, &inp);
        // Rounding of rows with coefficients up to the square of the number of nodes.
        assert!(out.residual < 1e-10 && out.cycles == 1, "{out:?}");
        let direct = Direct { cavitation: Cavitation::FullSommerfeld, ..Direct::default() };
        let (_, volumes) = solved(&direct, &grid, &inp);
        errors.push(apart(&p, &volumes));
    }
    let order = (errors[1] / errors[2]).log2();
    // The gap varies by a factor of 1.9 over 8 intervals on the coarsest grid.
    assert!((order - 2.0).abs() < 0.3 && errors[2] < 5e-3, "{order} {errors:?}");
}

/// The part of a grid between two nodes of each direction.
fn part(
    full: &Film2dGrid,
    x: std::ops::RangeInclusive<usize>,
    y: std::ops::RangeInclusive<usize>,
) -> Film2dGrid {
    Film2dGrid { x: full.x[x].to_vec(), y: full.y[y].to_vec(), ..full.clone() }
}

#[test]
fn a_wall_is_a_mirror() {
    const N: usize = 17;
    const M: usize = N / 2;
    let full = Film2dGrid::uniform(N, N, 1.0, 1.0);
    for across in [true, false] {
        // Symmetric about the middle of y, or of x; there without sliding, which would not be.
        let gap = |x: f64, y: f64| {
            let (s, t) = if across { (y, x) } else { (x, y) };
            1.0 + 0.4 * t + 0.3 * (2.0 * PI * s).cos()
        };
        let rate = |x: f64, y: f64| if across { -0.2 - 0.1 * x } else { -0.2 - 0.1 * y };
        let u = if across { 0.7 } else { 0.0 };
        let solve = |grid: &Film2dGrid, spec: &CentralDifferences| {
            let (h, dhdt) = (field(grid, gap), field(grid, rate));
            solved(spec, grid, &Film2dIn { dhdt: &dhdt, ..Film2dIn::new(&h, u, 0.1) }).1
        };
        let whole = solve(&full, &ELIMINATION);
        for low in [true, false] {
            let half = if low { 0..=M } else { M..=N - 1 };
            let mut grid = if across {
                part(&full, 0..=N - 1, half.clone())
            } else {
                part(&full, half.clone(), 0..=N - 1)
            };
            grid.edges[if across { 2 } else { 0 } + usize::from(low)] = Edge::Wall;
            let (i0, j0) = if low { (0, 0) } else { (M, M) };
            for (spec, tolerance) in [(&ELIMINATION, 1e-12), (&SWEEPS, 1e-3)] {
                let p = solve(&grid, spec);
                for j in 0..grid.y.len() {
                    for i in 0..grid.x.len() {
                        let (a, b) = if across { (i, j + j0) } else { (i + i0, j) };
                        let (got, want) = (p[j * grid.x.len() + i], whole[b * N + a]);
                        // Rounding; sweeps end when all pressures change by 1e-5 together, and are a hundred times farther off at most.
                        assert!((got - want).abs() <= tolerance, "{across} {low} {i} {j}: {got} {want}");
                    }
                }
            }
        }
    }
}

#[test]
fn sweeps_with_their_relaxation_take_few_of_them() {
    for wall in [None, Some(1), Some(2)] {
        let mut grid = Film2dGrid::uniform(41, 21, 0.05, 0.02);
        if let Some(w) = wall {
            grid.edges[w] = Edge::Wall;
        }
        let h = vec![20e-6; 41 * 21];
        let dhdt = vec![-1e-3; 41 * 21];
        let inp = Film2dIn { dhdt: &dhdt, ..Film2dIn::new(&h, 0.0, 0.02) };
        let (eliminated, p) = solved(&ELIMINATION, &grid, &inp);
        let (out, q) = solved(&SWEEPS, &grid, &inp);
        // 1e-5 Pa a sweep at the end, of some 1e5 Pa.
        assert!(apart(&p, &q) < 1e-8 && out.residual < 1e-8, "{out:?}");
        assert!((out.load / eliminated.load - 1.0).abs() < 1e-8);
        // The error falls by (ω - 1) a sweep, about 1 - 2π/41 where the film is closed: 25 powers of e in some 200 sweeps; without relaxation
        // it would be 1 - π²/800 and ten times as many.
        assert!(out.cycles < 260, "{wall:?}: {} sweeps", out.cycles);
    }
}
