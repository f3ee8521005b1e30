//! Time of one run of every case whose work is counted, from a case that was read to its results, without sweeps and files; and of runs with every model of the kinds
//! that ask other parts of a scene, on its registered example: solvers, motions.
#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]
#![allow(clippy::print_stdout, missing_docs)]

use std::time::Duration;

use criterion::Criterion;
use gudgeon_benches::cases::{Case, counted, run_alone};
use gudgeon_core::Registry;

/// Kinds whose models run within a scene alone: the case they are put into, where, and by which key they are named there.
const WITHIN: [(&str, &str, &str, &str); 4] = [
    ("ring_pack_solver", "turbo-diesel-120-as-published", "solver", "method"),
    ("radial_motion", "turbo-diesel-120", "models.radial_motion", "model"),
    ("piston_solver", "turbo-diesel-120-skirt", "solver", "method"),
    ("secondary_motion", "ea111-1400", "models.secondary_motion", "model"),
];
/// A motion that every solver of a ring pack takes.
const MOTION: &str = "models.ring_motion={ model = \"seated\" }";

fn time(criterion: &mut Criterion, case: &Case) -> Result<(), String> {
    let checked = case.check()?;
    // What fails is not worth its time.
    run_alone(&checked)?;
    let mut group = criterion.benchmark_group("scenes");
    group.bench_function(case.name.as_str(), |b| b.iter(|| run_alone(&checked).is_ok()));
    group.finish();
    Ok(())
}

/// Every model of those kinds, from its example.
fn within() -> Vec<Case> {
    let registry = Registry::collect();
    let mut all = Vec::new();
    for (kind, file, path, key) in WITHIN {
        for m in registry.models(kind) {
            let example: toml::Table = toml::from_str(m.example).unwrap_or_default();
            let named = [(key.to_owned(), m.name.into())];
            let entries =
                named.into_iter().chain(example).map(|(k, v): (_, toml::Value)| format!("{k} = {v}"));
            let table = format!("{path}={{ {} }}", entries.collect::<Vec<_>>().join(", "));
            let mut set = vec![table.as_str()];
            set.extend((kind == "ring_pack_solver").then_some(MOTION));
            all.push(Case::shipped(file).changed(&format!("{kind}/{}", m.name), &set));
        }
    }
    all
}

fn main() {
    let mut criterion = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(3))
        .configure_from_args();
    for case in counted().iter().chain(&within()) {
        if let Err(e) = time(&mut criterion, case) {
            println!("not timed: {e}");
        }
    }
    criterion.final_summary();
}
