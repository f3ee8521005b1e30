//! Time of one run of every scene, from a case that was read to its results, without sweeps and files; of each solver of a ring pack and of a piston; and of
//! ring packs with the models that run within a scene alone.
#![allow(clippy::print_stdout, missing_docs)]

use std::time::Duration;

use criterion::Criterion;
use gudgeon_benches::cases::{Case, one_a_scene, run_alone};
use gudgeon_core::Registry;

/// Case and kind of the solvers that are tried on it.
const SOLVERS: [(&str, &str); 2] =
    [("turbo-diesel-120-as-published", "ring_pack_solver"), ("turbo-diesel-120-skirt", "piston_solver")];

fn time(criterion: &mut Criterion, case: &Case) -> Result<(), String> {
    let checked = case.check()?;
    // What fails is not worth its time.
    run_alone(&checked)?;
    let mut group = criterion.benchmark_group("scenes");
    group.bench_function(case.name.as_str(), |b| b.iter(|| run_alone(&checked).is_ok()));
    group.finish();
    Ok(())
}

/// Every registered solver at its defaults.
fn solvers() -> Vec<Case> {
    let registry = Registry::collect();
    let of = |(file, kind)| {
        registry.models(kind).iter().map(move |m| {
            let name = format!("{file}, {}", m.name);
            Case::shipped(file).changed(&name, &[&format!("solver={{ method = \"{}\" }}", m.name)])
        })
    };
    SOLVERS.into_iter().flat_map(of).collect()
}

fn main() {
    let mut criterion = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(3))
        .configure_from_args();
    for case in one_a_scene().iter().chain(&solvers()) {
        if let Err(e) = time(&mut criterion, case) {
            println!("not timed: {e}");
        }
    }
    criterion.final_summary();
}
