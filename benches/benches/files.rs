//! Time of what stands before and after a run: reading a case, changing it, refusing a broken one, writing its summary and its report.
#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]
#![allow(clippy::print_stdout, missing_docs)]

use std::hint::black_box;
use std::time::Duration;

use criterion::Criterion;
use gudgeon_benches::cases::{Case, run_alone};
use gudgeon_case::read;
use gudgeon_report::{Folder, summary_json, write_run_in};

/// The case that is read and told.
const CASE: &str = "turbo-diesel-120";

fn loader(criterion: &mut Criterion) -> Result<(), String> {
    let case = Case::shipped(CASE);
    let read_again = case.check()?;
    // A case with a mistake in every table: what a person sees first.
    let broken = read(&case.path()).map_err(|e| e.to_string())?;
    let broken = gudgeon_case::Source { text: broken.text.replace(" = ", " = 1 + "), ..broken };
    let mut wrong = read(&case.path()).map_err(|e| e.to_string())?;
    wrong.text = wrong.text.replace("mm\"", "furlongs\"");
    let mut group = criterion.benchmark_group("loader");
    group.bench_function("read and check", |b| b.iter(|| case.check().is_ok()));
    group.bench_function("change by --set", |b| {
        b.iter(|| read_again.with(black_box(&["engine.speed=2100 rpm".to_owned()])).is_ok());
    });
    for (what, source) in [("refuse what is no TOML", &broken), ("refuse wrong units", &wrong)] {
        let refused = || gudgeon_scene::check_source("case.toml".into(), source.clone(), &[]).is_err();
        if !refused() {
            return Err(format!("{what}: it is not refused"));
        }
        group.bench_function(what, |b| b.iter(refused));
    }
    group.finish();
    Ok(())
}

fn report(criterion: &mut Criterion) -> Result<(), String> {
    let result = run_alone(&Case::shipped(CASE).check()?)?;
    let folder = std::env::temp_dir().join(format!("gudgeon-bench-{}", std::process::id()));
    let write = || -> Result<(), String> {
        let open = Folder::open(&folder).map_err(|e| e.to_string())?;
        write_run_in(&result, open).map(drop).map_err(|e| e.to_string())
    };
    write()?;
    let mut group = criterion.benchmark_group("report");
    group.bench_function("summary as text", |b| b.iter(|| summary_json(black_box(&result))));
    group.bench_function("all files of a run", |b| b.iter(|| write().is_ok()));
    group.bench_function("page from its files", |b| b.iter(|| gudgeon_report::rewrite(&folder).is_ok()));
    group.finish();
    std::fs::remove_dir_all(&folder).map_err(|e| e.to_string())
}

fn main() {
    let mut criterion = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1))
        .configure_from_args();
    for outcome in [loader(&mut criterion), report(&mut criterion)] {
        if let Err(e) = outcome {
            println!("not timed: {e}");
        }
    }
    criterion.final_summary();
}
