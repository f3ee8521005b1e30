//! Cost and error of two-dimensional films: a piston skirt by multigrid and by banded elimination, and a textured slider with cavitation.
//!
//! The tables that come first hold error beside time: a speed means nothing without the accuracy it was reached at. `--table` prints the tables
//! alone, `--json` the textured slider as one JSON array (for `race_film.py`); everything else goes to criterion.
#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]
#![allow(clippy::print_stdout, missing_docs)]
#![allow(clippy::excessive_precision, reason = "reference values stand as they were computed")]

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::Criterion;
use gudgeon_core::EvalError;
use gudgeon_core::kinds::{Film2d, Film2dCtx, Film2dGrid, Film2dIn, Film2dOut, Film2dSpec};
use gudgeon_film::film_2d::{Cavitation, Direct, Flux, Multigrid, Sor};

/// Load of the skirt \[N\], whole film, by Chebyshev collocation.
const SKIRT: f64 = 911.4953768238879;
/// Dimples a side of the textured slider, its load \[N\] and highest pressure \[Pa\] on the same grid by two other programs.
const TEXTURED: [(usize, f64, f64); 4] = [
    (1, 409.70979254654713, 482112.287892393),
    (2, 381.6177220018324, 537438.9038046171),
    (8, 352.305446513026, 492443.5055594756),
    (10, 351.325960714651, 469600.0601681846),
];

struct Scene {
    grid: Film2dGrid,
    h: Vec<f64>,
    faces: [Vec<f64>; 2],
    textured: bool,
}

impl Scene {
    /// A skirt of 2 × 50 degrees, 86 mm in diameter and 50 mm long, clearance 30 um, barrel 20 um, eccentricities 18 um at the top and 10 um at the
    /// bottom, sliding at 8 m/s in an oil of 10 mPa s.
    fn skirt(nx: usize, ny: usize) -> Self {
        let width = 2.0 * 50.0_f64.to_radians() * 0.043;
        let grid = Film2dGrid::uniform(nx + 1, ny + 1, 0.05, width);
        let (dx, dy) = (0.5 * grid.x[1], 0.5 * grid.y[1]);
        let sample = |sx: f64, sy: f64| -> Vec<f64> {
            let film = |x: f64, y: f64| {
                let s = x / 0.05;
                3e-5 - (18e-6 - 8e-6 * s) * ((y - 0.5 * width) / 0.043).cos() + 2e-5 * (2.0 * s - 1.0).powi(2)
            };
            grid.y.iter().flat_map(|&y| grid.x.iter().map(move |&x| film(x + sx, y + sy))).collect()
        };
        let (h, faces) = (sample(0.0, 0.0), [sample(dx, 0.0), sample(0.0, dy)]);
        Self { grid, h, faces, textured: false }
    }

    /// The slider of Woloszynski et al. 2015 with `k` × `k` square dimples of 12 um in a film of 15 um.
    fn textured(k: usize) -> Self {
        let n = 30 * k + 2;
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
        Self {
            grid: Film2dGrid::uniform(n, n, 80e-3, 80e-3),
            h,
            faces: [Vec::new(), Vec::new()],
            textured: true,
        }
    }

    fn input(&self) -> Film2dIn<'_> {
        if self.textured {
            Film2dIn { p_cav: 30e3, edge_pressure: [100e3; 4], ..Film2dIn::new(&self.h, 5.0, 3e-2) }
        } else {
            let [x, y] = &self.faces;
            Film2dIn { h_face_x: x, h_face_y: y, ..Film2dIn::new(&self.h, -8.0, 0.01) }
        }
    }

    fn build(&self, spec: &dyn Film2dSpec) -> Box<dyn Film2d> {
        spec.build(&Film2dCtx { grid: &self.grid }).expect("the film builds")
    }
}

/// From nothing: assembly, setup and search.
fn cold(film: &mut dyn Film2d, inp: &Film2dIn<'_>) -> Result<Film2dOut, EvalError> {
    film.reset();
    film.solve(inp)
}

/// Medians \[us\] of the times of each film, one search of every film in turn.
fn race(
    films: &mut [Box<dyn Film2d>],
    inp: &Film2dIn<'_>,
    rounds: usize,
) -> Result<Vec<(Film2dOut, f64)>, EvalError> {
    let mut times = vec![Vec::with_capacity(rounds); films.len()];
    let mut out = Vec::new();
    for round in 0..rounds {
        for (film, times) in films.iter_mut().zip(&mut times) {
            let begin = Instant::now();
            let o = black_box(cold(film.as_mut(), black_box(inp))?);
            times.push(begin.elapsed().as_secs_f64() * 1e6);
            if round == 0 {
                out.push(o);
            }
        }
    }
    let median = |mut t: Vec<f64>| {
        t.sort_by(f64::total_cmp);
        t[t.len() / 2]
    };
    Ok(out.into_iter().zip(times.into_iter().map(median)).collect())
}

fn skirts() -> Result<(), EvalError> {
    let cavitation = Cavitation::FullSommerfeld;
    let multigrid = |tolerance| Multigrid { cavitation, tolerance, ..Multigrid::default() };
    println!("{:<24} {:>9} {:>7} {:>11} {:>9}", "skirt, full film", "grid", "cycles", "load error", "us");
    for (nx, ny) in [(32, 24), (64, 48), (128, 96), (256, 192)] {
        let scene = Scene::skirt(nx, ny);
        let mut films = vec![
            scene.build(&multigrid(1e-3)),
            scene.build(&multigrid(1e-4)),
            scene.build(&multigrid(1e-9)),
            scene.build(&Direct { cavitation, ..Direct::default() }),
        ];
        let mut names = vec!["multigrid 1e-3", "multigrid 1e-4", "multigrid 1e-9", "direct"];
        if nx <= 64 {
            films.push(scene.build(&Sor { cavitation, tolerance: 1e-3, ..Sor::default() }));
            names.push("sor 1e-3");
        }
        for (name, (out, us)) in names.iter().zip(race(&mut films, &scene.input(), 31)?) {
            let error = out.load / SKIRT - 1.0;
            println!("{name:<24} {:>9} {:>7} {error:>11.1e} {us:>9.1}", format!("{nx}x{ny}"), out.cycles);
        }
    }
    Ok(())
}

struct Row {
    k: usize,
    load_error: f64,
    peak_error: f64,
    out: Film2dOut,
    us: f64,
}

fn textured() -> Result<Vec<Row>, EvalError> {
    let mut rows = Vec::new();
    for (k, load, top) in TEXTURED {
        let scene = Scene::textured(k);
        let mut films = vec![scene.build(&Multigrid { flux: Flux::Node, ..Multigrid::default() })];
        let (out, us) = race(&mut films, &scene.input(), 7)?[0];
        // Their load counts every node with the area of a full one.
        let area = scene.grid.x[1] * scene.grid.y[1];
        let sum: f64 = films[0].pressure().iter().map(|p| (p - 100e3) * area).sum::<f64>() + 640.0;
        rows.push(Row { k, load_error: sum / load - 1.0, peak_error: out.p_max / top - 1.0, out, us });
    }
    Ok(rows)
}

fn run() -> Result<(), EvalError> {
    let args: Vec<String> = std::env::args().collect();
    let has = |name: &str| args.iter().any(|a| a == name);
    if has("--json") {
        let rows: Vec<_> = textured()?
            .iter()
            .map(|r| {
                serde_json::json!({
                    "k": r.k, "load_error": r.load_error, "peak_error": r.peak_error,
                    "iterations": r.out.iterations, "cycles": r.out.cycles, "milliseconds": r.us * 1e-3,
                })
            })
            .collect();
        println!("{}", serde_json::Value::Array(rows));
        return Ok(());
    }
    skirts()?;
    println!(
        "{:<24} {:>9} {:>7} {:>7} {:>11} {:>11} {:>9}",
        "textured, conserving", "nodes", "newton", "cycles", "load error", "peak error", "us"
    );
    for r in textured()? {
        let n = 30 * r.k + 2;
        println!(
            "{:<24} {:>9} {:>7} {:>7} {:>11.1e} {:>11.1e} {:>9.1}",
            format!("{0} x {0} dimples", r.k),
            n * n,
            r.out.iterations,
            r.out.cycles,
            r.load_error.abs(),
            r.peak_error.abs(),
            r.us
        );
    }
    if has("--table") {
        return Ok(());
    }
    let mut criterion = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(2))
        .configure_from_args();
    let mut group = criterion.benchmark_group("film_2d");
    let cavitation = Cavitation::FullSommerfeld;
    let skirt = Scene::skirt(64, 48);
    let mut film = skirt.build(&Multigrid { cavitation, tolerance: 1e-4, ..Multigrid::default() });
    group.bench_function("skirt_multigrid", |b| {
        b.iter(|| cold(film.as_mut(), &skirt.input()).map(|o| o.load))
    });
    let mut film = skirt.build(&Direct { cavitation, ..Direct::default() });
    group.bench_function("skirt_direct", |b| b.iter(|| cold(film.as_mut(), &skirt.input()).map(|o| o.load)));
    let texture = Scene::textured(2);
    let mut film = texture.build(&Multigrid { flux: Flux::Node, ..Multigrid::default() });
    group.bench_function("textured", |b| b.iter(|| cold(film.as_mut(), &texture.input()).map(|o| o.load)));
    group.finish();
    criterion.final_summary();
    Ok(())
}

fn main() {
    if let Err(e) = run() {
        println!("a film was not found: {e}");
    }
}
