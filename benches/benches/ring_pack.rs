//! Cost and error of a whole ring pack, and of the film under one ring face.
//!
//! The table that comes first runs `cases/turbo-diesel-120.toml` at several tolerances and with the published scheme at small
//! steps, and compares blow-by and friction power with a tight run; `--table` prints it alone.
#![allow(clippy::print_stdout, missing_docs)]

use std::hint::black_box;
use std::path::Path;
use std::time::Duration;

use criterion::Criterion;
use gudgeon_core::geometry::FaceProfile;
use gudgeon_core::kinds::{FaceCtx, FaceIn, HydrodynamicsSpec};
use gudgeon_core::result::RunResult;
use gudgeon_film::{ClosedFormFace, GriddedFace};
use gudgeon_models as _;

const CASE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../cases/turbo-diesel-120.toml");
/// Runs of each setting; the fastest solve counts.
const RUNS: usize = 3;

fn run(overrides: &[&str]) -> Result<RunResult, String> {
    let overrides: Vec<String> = overrides.iter().map(|s| (*s).to_owned()).collect();
    let checked = gudgeon_scene::check(Path::new(CASE), &overrides).map_err(|e| e.to_string())?;
    gudgeon_scene::run(&checked, &mut gudgeon_scene::unwatched).map_err(|e| e.to_string())
}

fn value(r: &RunResult, name: &str) -> f64 {
    r.results.get(name).map_or(f64::NAN, |v| v.value)
}

fn table() -> Result<(), String> {
    let tight = run(&["solver.integrator=radau5", "solver.tolerance=1e-8", "solver.periodicity=1e-7"])?;
    let settings: [(&str, Vec<&str>); 9] = [
        ("order 3, 1e-2", vec!["solver.integrator=rodas3", "solver.tolerance=1e-2"]),
        ("order 3, 5e-3", vec!["solver.integrator=rodas3", "solver.tolerance=5e-3"]),
        ("order 3, 1e-3", vec!["solver.integrator=rodas3", "solver.tolerance=1e-3"]),
        ("order 3, 1e-4 (default)", vec![]),
        ("order 5, 1e-2", vec!["solver.integrator=rodas5p", "solver.tolerance=1e-2"]),
        ("order 5, 1e-4", vec!["solver.integrator=rodas5p", "solver.tolerance=1e-4"]),
        ("order 5, 1e-5", vec!["solver.tolerance=1e-5"]),
        ("order 5, 1e-6", vec!["solver.tolerance=1e-6"]),
        (
            "as published, 16 per degree",
            vec![
                "solver.method=substep_march",
                "solver.passes=720",
                "solver.cycles=3",
                "solver.clamp=inward",
                "solver.steps_per_degree=16",
            ],
        ),
    ];
    println!(
        "{:<28} {:>10} {:>9} {:>7} {:>10} {:>13} {:>15}",
        "solver", "solve ms", "ms/cycle", "cycles", "rhs", "blow-by error", "friction error"
    );
    let row = |label: &str, r: &RunResult, seconds: f64| {
        let error = |name: &str| (value(r, name) / value(&tight, name) - 1.0).abs();
        let count = |name: &str| r.solver.counters.get(name).copied().unwrap_or(0);
        let cycles = count("cycles");
        println!(
            "{label:<28} {:>10.2} {:>9.2} {cycles:>7} {:>10} {:>13.2e} {:>15.2e}",
            seconds * 1e3,
            seconds * 1e3 / cycles.max(1) as f64,
            count("rhs"),
            error("blow_by"),
            error("friction_power"),
        );
    };
    let seconds = |r: &RunResult| r.seconds.get("solve").copied().unwrap_or(f64::NAN);
    for (label, overrides) in settings {
        let mut result = run(&overrides)?;
        let mut best = seconds(&result);
        for _ in 1..RUNS {
            result = run(&overrides)?;
            best = best.min(seconds(&result));
        }
        row(label, &result, best);
    }
    row("radau5, 1e-8 (reference)", &tight, seconds(&tight));
    println!(
        "reference: blow-by {:.9e}, friction power {:.9e} W",
        value(&tight, "blow_by"),
        value(&tight, "friction_power")
    );
    Ok(())
}

/// Films of a benchmark run, a step of a few per cent apart as those of an integrator.
const FILMS: usize = 16;

/// The film under a barrel 3 mm long with 6 µm drop about mid-stroke speed, 10 bar above, 2 bar below: each time is that of
/// `FILMS` films, one after the other.
fn faces(criterion: &mut Criterion) -> Result<(), String> {
    let face = FaceProfile::Parabola { length: 3e-3, curvature: 6e-6 / (1.5e-3 * 1.5e-3), apex: 1.2e-3 };
    let inputs: [FaceIn; FILMS] = std::array::from_fn(|k| {
        let (sin, cos) = (std::f64::consts::TAU * k as f64 / FILMS as f64).sin_cos();
        let (h, u) = (3e-6 * (1.0 + 0.1 * sin), -10.0 - 2.0 * cos);
        FaceIn { h, u, p_bottom: 2e5, p_top: 1e6, p_cav: 1e5, mu: 8e-3 }
    });
    let models: [(&str, Box<dyn HydrodynamicsSpec>); 2] = [
        ("closed_form_face", Box::new(ClosedFormFace::default())),
        ("gridded_face", Box::new(GriddedFace::default())),
    ];
    for (name, spec) in models {
        let mut film = spec.build(&FaceCtx { face: &face }).map_err(|e| format!("{name}: {e}"))?;
        let hdot = -1e-4;
        let mut loads = [0.0; FILMS];
        for (inp, load) in inputs.iter().zip(&mut loads) {
            // What fails here is not worth its time; what does not, does not below either.
            *load = film.evaluate(inp, hdot).map_err(|e| format!("{name}: {e}"))?.load;
            film.carry(inp, *load).map_err(|e| format!("{name}: {e}"))?;
        }
        let mut group = criterion.benchmark_group(name);
        group.bench_function("evaluate", |b| {
            b.iter(|| inputs.iter().all(|i| black_box(film.evaluate(black_box(i), hdot)).is_ok()));
        });
        group.bench_function("load", |b| {
            b.iter(|| inputs.iter().all(|i| black_box(film.load(black_box(i), hdot)).is_ok()));
        });
        group.bench_function("squeeze_rate", |b| {
            b.iter(|| {
                inputs.iter().zip(loads).all(|(i, w)| black_box(film.squeeze_rate(black_box(i), w)).is_ok())
            });
        });
        group.bench_function("carry", |b| {
            b.iter(|| inputs.iter().zip(loads).all(|(i, w)| black_box(film.carry(black_box(i), w)).is_ok()));
        });
        group.finish();
    }
    Ok(())
}

fn main() {
    let args: Vec<String> = std::env::args().collect();
    if let Err(e) = table() {
        println!("the case stopped: {e}");
        return;
    }
    if args.iter().any(|a| a == "--table") {
        return;
    }
    let mut criterion = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(2))
        .configure_from_args();
    let mut group = criterion.benchmark_group("ring_pack");
    if let Ok(checked) = gudgeon_scene::check(Path::new(CASE), &[]) {
        group.bench_function("turbo-diesel-120", |b| {
            b.iter(|| gudgeon_scene::run(&checked, &mut gudgeon_scene::unwatched))
        });
    }
    group.finish();
    if let Err(e) = faces(&mut criterion) {
        println!("the films stopped: {e}");
        return;
    }
    criterion.final_summary();
}
