//! Cost and error of a film along a line: the barrel face of a ring, 10 m/s, 1 bar at both edges, one cavity.
//!
//! The table that comes first holds error beside time, for each model and grid. `--table` prints the table alone; everything else
//! goes to criterion.
#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]
#![allow(clippy::print_stdout, missing_docs)]
#![allow(clippy::excessive_precision, reason = "reference values stand as they were computed")]

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion};
use gudgeon_core::EvalError;
use gudgeon_core::kinds::{Film1d, Film1dCtx, Film1dIn, Film1dOut, Film1dSpec, FilmEnd, FilmTime};
use gudgeon_film::Cavitation;
use gudgeon_film::film_1d::{Complementarity, ElrodAdams, FrontTracking, LineProfile, LineSolver};

/// Load \[N/m\] and shear of the liner \[N/m\], from closed forms in 25 digits.
const LOAD: f64 = 1928.500543377637755942081;
const SHEAR: f64 = 31.83651283314982372982677 + 7.192262943906510181987812;

struct Face {
    line: LineProfile,
    mu: Vec<f64>,
    film: Box<dyn Film1d>,
}

impl Face {
    fn new(spec: &dyn Film1dSpec, panels: usize) -> Self {
        let line =
            LineProfile::parabola(1.2e-3, 6e-6 / 0.36e-6, 0.6e-3, 2e-6, panels, false).expect("a face");
        let film = spec.build(&Film1dCtx { x: &line.x }).expect("a line");
        Self { mu: vec![0.01; panels], line, film }
    }

    fn solve(&mut self, u: f64) -> Result<Film1dOut, EvalError> {
        self.film.solve(&Film1dIn {
            h_a: &self.line.h_a,
            h_b: &self.line.h_b,
            mu: &self.mu,
            factors: None,
            u,
            ends: [FilmEnd::Flooded { p: 1e5 }; 2],
            p_cav: 0.0,
            time: FilmTime::Steady,
        })
    }

    /// Forgets the film found last: a sliding back and forth that leaves no start to a search.
    fn forget(&mut self) {
        let _ = self.solve(-1.0);
    }
}

fn models() -> Vec<(&'static str, Box<dyn Film1dSpec>)> {
    let with = |cavitation| Complementarity { cavitation, ..Complementarity::default() };
    vec![
        ("mass_conserving", Box::new(with(Cavitation::MassConserving))),
        (
            "mass_conserving, Newton",
            Box::new(Complementarity { solver: LineSolver::FischerBurmeister, ..Complementarity::default() }),
        ),
        ("front_tracking", Box::new(FrontTracking::default())),
        (
            "elrod_adams, 10 TPa",
            Box::new(ElrodAdams {
                // So stiff that compressibility is not what the error shows.
                bulk_modulus: gudgeon_core::quantity::quantity(1e13),
                ..ElrodAdams::default()
            }),
        ),
        ("swift_stieber", Box::new(with(Cavitation::SwiftStieber))),
        ("half_sommerfeld", Box::new(with(Cavitation::HalfSommerfeld))),
    ]
}

/// Median of the time \[µs\] of one call, over batches that take turns with nothing else.
fn median(mut call: impl FnMut()) -> f64 {
    let mut times: Vec<f64> = (0..101)
        .map(|_| {
            let begin = Instant::now();
            for _ in 0..50 {
                call();
            }
            begin.elapsed().as_secs_f64() * 1e6 / 50.0
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[50]
}

fn main() {
    println!(
        "{:<24} {:>6} {:>6} {:>6} {:>11} {:>11} {:>9} {:>9}",
        "model", "panels", "cold", "warm", "load error", "shear error", "cold us", "warm us"
    );
    for (name, spec) in models() {
        for panels in [32, 64, 128, 800] {
            let mut face = Face::new(&*spec, panels);
            face.forget();
            let cold = face.solve(10.0).expect("a film");
            let warm = face.solve(10.0).expect("a film");
            // Both directions in turn: nothing of the last film helps.
            let mut u = 10.0;
            let cold_time = median(|| {
                u = -u;
                black_box(face.solve(black_box(u))).expect("a film");
            });
            let warm_time = median(|| {
                black_box(face.solve(black_box(10.0))).expect("a film");
            });
            println!(
                "{name:<24} {panels:>6} {:>6} {:>6} {:>11.1e} {:>11.1e} {cold_time:>9.3} {warm_time:>9.3}",
                cold.iterations,
                warm.iterations,
                (cold.load / LOAD - 1.0).abs(),
                (cold.moving_shear / SHEAR - 1.0).abs(),
            );
        }
    }
    if std::env::args().any(|a| a == "--table") {
        return;
    }
    let mut criterion = Criterion::default()
        .sample_size(30)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1))
        .configure_from_args();
    let mut group = criterion.benchmark_group("film_1d");
    for (name, spec) in models() {
        let mut face = Face::new(&*spec, 64);
        group.bench_function(BenchmarkId::new(name, 64), |b| {
            b.iter(|| face.solve(black_box(10.0)).map(|o| o.load));
        });
    }
    group.finish();
    criterion.final_summary();
}
