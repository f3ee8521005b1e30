//! Time to read, to build and to ask every registered model: kinds and models come from the registry, examples too, so that a new model is
//! timed without a line here.
//!
//! A model of a kind that asks other parts of a scene is read alone; `--list` of criterion shows what is timed, and the kinds whose models run within a
//! scene alone are told at the end. Error beside time is not what this file shows: `gudgeon bench` does, where there is a reference.
#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]
#![allow(clippy::print_stdout, missing_docs)]

use std::hint::black_box;
use std::time::Duration;

use criterion::Criterion;
use gudgeon_benches::alone::{KINDS, Reach, models, reach};
use gudgeon_core::ModelInfo;
use gudgeon_core::content::Content;

/// The example of a model as its reader takes it.
fn example(m: &ModelInfo) -> Result<Content, String> {
    let table: serde_json::Value = toml::from_str(m.example).map_err(|e| e.to_string())?;
    Ok(Content::from(&table))
}

fn time(criterion: &mut Criterion, m: &ModelInfo) -> Result<(), String> {
    let content = example(m)?;
    let mut group = criterion.benchmark_group(format!("{}/{}", m.kind, m.name));
    group.bench_function("read", |b| b.iter(|| (m.read)(black_box(&content)).is_ok()));
    if let Some(Reach::Alone(stand)) = reach(m.kind) {
        let mut alone = stand(m)?;
        group.bench_function("build", |b| b.iter(&mut alone.build));
        group.bench_function("ask", |b| b.iter(&mut alone.ask));
    }
    group.finish();
    Ok(())
}

fn main() {
    let mut criterion = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(50))
        .measurement_time(Duration::from_millis(150))
        .configure_from_args();
    for m in models() {
        if let Err(e) = time(&mut criterion, m) {
            println!("{}/{} is not timed: {e}", m.kind, m.name);
        }
    }
    println!("\nOnly within a scene (bench `scenes`):");
    for (kind, reach) in KINDS {
        if let Reach::Within(why) = reach {
            println!("    {kind}: {why}");
        }
    }
    criterion.final_summary();
}
