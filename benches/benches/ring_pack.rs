//! Cost and error of a whole ring pack: a table.
//!
//! It runs `cases/turbo-diesel-120.toml` with flooded faces at several tolerances and with the published scheme at small steps, and compares blow-by and friction
//! power with a tight run.
#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]
#![allow(clippy::print_stdout, missing_docs)]

use gudgeon_benches::cases::{Case, FLOODED};
use gudgeon_core::result::RunResult;

/// Runs of each setting; the fastest solve counts.
const RUNS: usize = 3;

fn run(overrides: &[&str]) -> Result<RunResult, String> {
    let set = [&[FLOODED], overrides].concat();
    Case::shipped("turbo-diesel-120").changed("turbo-diesel-120, flooded", &set).run()
}

fn value(r: &RunResult, name: &str) -> f64 {
    r.results.get(name).map_or(f64::NAN, |v| v.value)
}

fn table() -> Result<(), String> {
    let tight = run(&["solver.integrator=radau5", "solver.tolerance=1e-8", "solver.periodicity=1e-7"])?;
    let settings: [(&str, Vec<&str>); 14] = [
        ("order 2, own stages, 1e-2", vec!["solver.integrator=sdirk2", "solver.tolerance=1e-2"]),
        ("order 2, own stages, 3e-3", vec!["solver.integrator=sdirk2", "solver.tolerance=3e-3"]),
        ("in halves, 1e-2", vec!["solver.integrator=waveform", "solver.tolerance=1e-2"]),
        ("in halves, 3e-3", vec!["solver.integrator=waveform", "solver.tolerance=3e-3"]),
        ("order 2, own stages, 1e-3", vec!["solver.integrator=sdirk2", "solver.tolerance=1e-3"]),
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
                "models.flank.model=squeeze_film",
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

fn main() {
    if let Err(e) = table() {
        println!("the case stopped: {e}");
    }
}
