//! Many runs of one case: `compare` and `bench`.

use std::path::Path;
use std::time::Instant;

use gudgeon_core::result::{BenchPoint, BenchTable, Comparison, Variant};
use gudgeon_core::{BuildError, Registry};
use indexmap::IndexMap;

use crate::case::{IntegratorName, RingPackCase};
use crate::load::Report;
use crate::run::{Checked, Progress, RunError, check, run};

/// `gas_flow`, `models.gas_flow` and `models.gas_flow.model` all mean the model's name; anything else is taken as written.
fn swap_path(path: &str) -> String {
    let registry = Registry::collect();
    let bare = path.strip_prefix("models.").unwrap_or(path);
    if registry.kind(bare).is_some() {
        return format!("models.{bare}.model");
    }
    match path.rsplit_once('.') {
        Some((_, last)) if registry.kind(last).is_some() => format!("{path}.model"),
        _ => path.to_owned(),
    }
}

/// Runs every combination of `swaps`, `(path, values)`.
///
/// Every combination is checked before any is run; those that cannot be are kept with the reason.
///
/// # Errors
/// The case itself is wrong, a swap has no values, or no combination is possible.
pub fn compare(
    path: &Path,
    overrides: &[String],
    swaps: &[(String, Vec<String>)],
    progress: &mut dyn FnMut(Progress),
) -> Result<Comparison, Report> {
    let base = check(path, overrides)?;
    let mut combinations: Vec<Vec<(String, String)>> = vec![Vec::new()];
    for (p, values) in swaps {
        if values.is_empty() || values.iter().any(String::is_empty) {
            let e = BuildError::new(format!("the swap `{p}` has an empty value"))
                .help("write `--swap PATH=A,B,C`");
            return Err(base.refuse([&e]));
        }
        let p = swap_path(p);
        combinations = combinations
            .iter()
            .flat_map(|c| {
                values
                    .iter()
                    .map(|v| c.iter().cloned().chain([(p.clone(), v.clone())]).collect())
                    .collect::<Vec<_>>()
            })
            .collect();
    }
    let checked: Vec<Result<Checked, Report>> = combinations
        .iter()
        .map(|c| base.with(&c.iter().map(|(p, v)| format!("{p}={v}")).collect::<Vec<_>>()))
        .collect();
    if checked.iter().all(Result::is_err) {
        // Nothing is possible: the first refusal says why, with places.
        if let Some(Err(report)) = checked.into_iter().next() {
            return Err(report);
        }
        return Err(base.refuse([&BuildError::new("no combination to run")]));
    }
    let total = combinations.len() as f64;
    let variants = combinations
        .into_iter()
        .zip(checked)
        .enumerate()
        .map(|(k, (swaps, checked))| {
            let label = swaps
                .iter()
                .map(|(p, v)| format!("{}={v}", p.trim_start_matches("models.").trim_end_matches(".model")))
                .collect::<Vec<_>>()
                .join(", ");
            let outcome = match checked {
                Err(report) => Err(format!(
                    "refused: {}",
                    report.diagnostics.iter().map(|d| d.headline()).collect::<Vec<_>>().join("; ")
                )),
                Ok(c) => run(&c, &mut |p| {
                    progress(Progress {
                        phase: format!("{label}: {}", p.phase),
                        fraction: (k as f64 + p.fraction) / total,
                    });
                })
                .map_err(|e| format!("failed: {e}")),
            };
            Variant { label, swaps, outcome }
        })
        .collect();
    Ok(Comparison {
        case: base.name.clone(),
        title: base.title().to_owned(),
        swaps: swaps.iter().map(|(p, v)| (swap_path(p), v.clone())).collect(),
        variants,
    })
}

/// Results that a work-precision study looks at unless told otherwise; those that the case has.
const DEFAULT_RESULTS: [&str; 3] = ["blow_by", "friction_power", "land2.p_max"];
/// Runs per point, three for slow ones; the median counts.
const REPEATS: usize = 5;

/// Methods of the sweep.
const METHODS: [&str; 3] = ["implicit, order 3", "implicit, order 5", "as_published"];

struct Sweep {
    method: &'static str,
    setting: String,
    is_default: bool,
    set: Vec<String>,
}

fn sweeps(case: &RingPackCase) -> Vec<Sweep> {
    let mut all = Vec::new();
    let default = case.solver.tolerance.si();
    let orders: [(&str, &str, IntegratorName, &[f64]); 2] = [
        (METHODS[0], "rodas3", IntegratorName::Rodas3, &[1e-2, 3e-3, 1e-3, 3e-4, 1e-4]),
        (METHODS[1], "rodas5p", IntegratorName::Rodas5p, &[1e-2, 1e-3, 1e-4, 1e-5, 1e-6]),
    ];
    for (method, name, integrator, tolerances) in orders {
        for &t in tolerances {
            all.push(Sweep {
                method,
                setting: format!("tolerance {t:.0e}"),
                is_default: (t / default - 1.0).abs() < 1e-9 && case.solver.resolved() == integrator,
                set: vec![
                    "solver.method=implicit".into(),
                    format!("solver.integrator={name}"),
                    format!("solver.tolerance={t:e}"),
                    format!("solver.periodicity={t:e}"),
                ],
            });
        }
    }
    let rings = case.rings.len() as u32;
    let published = case.solver.method == crate::case::Method::AsPublished;
    // The published scheme and its own refinement. The scheme follows from the axial motion.
    let discrete = case.models.ring_motion.typetag_name() == "three_seat";
    let (scheme, own) = if discrete { ("degree_march", 1) } else { ("substep_march", rings + 1) };
    for factor in [1u32, 2, 4, 8] {
        let steps = own * factor;
        let gas = if published && case.solver.gas_steps > 0 { case.solver.gas_steps } else { 0 };
        all.push(Sweep {
            method: METHODS[2],
            setting: format!("{steps} steps per degree"),
            is_default: factor == 1,
            set: vec![
                "solver.method=as_published".into(),
                format!("solver.scheme={scheme}"),
                format!("solver.steps_per_degree={steps}"),
                format!("solver.gas_steps={gas}"),
                "solver.passes=720".into(),
                // The scheme as printed has no limit in a keystone groove; this variant of its flank rule has.
                "solver.clamp=inward".into(),
                format!("solver.cycles={}", if discrete { 8 } else { 3 }),
            ],
        });
    }
    all
}

/// Sweeps the accuracy of every solver against a reference and states error beside run time.
///
/// The reference is the implicit system solved by the other integrator (Radau IIA) at a tolerance a hundred times tighter
/// than the tightest point; the same integrator ten times looser tells how far it can be trusted.
///
/// # Errors
/// The reference cannot be run.
pub fn bench(
    base: &Checked,
    results: &[String],
    progress: &mut dyn FnMut(Progress),
) -> Result<BenchTable, RunError> {
    let Some(case) = base.ring_pack() else {
        return Err(RunError::Refused(
            "`bench` races the solvers of a ring pack, and a rig has none; `compare` swaps its sub-model, and a sweep over its grid \
             with checks against a source shows the errors"
                .into(),
        ));
    };
    let reference = |tolerance: f64| -> Result<_, RunError> {
        let c = base
            .with(&[
                "solver.method=implicit".into(),
                "solver.integrator=radau5".into(),
                format!("solver.tolerance={tolerance:e}"),
                format!("solver.periodicity={tolerance:e}"),
            ])
            .map_err(|r| RunError::Refused(r.to_string()))?;
        run(&c, &mut |_| {})
    };
    progress(Progress { phase: "reference".into(), fraction: 0.0 });
    let tight = reference(1e-8)?;
    progress(Progress { phase: "reference check".into(), fraction: 0.1 });
    let loose = reference(1e-7)?;
    let chosen: Vec<String> = if results.is_empty() {
        DEFAULT_RESULTS.iter().map(|s| (*s).to_owned()).filter(|n| tight.results.contains_key(n)).collect()
    } else {
        results.to_vec()
    };
    for name in &chosen {
        if !tight.results.contains_key(name) {
            let known: Vec<_> = tight.results.keys().map(String::as_str).collect();
            return Err(RunError::Refused(format!(
                "there is no result `{name}`; this case has {}",
                known.join(", ")
            )));
        }
    }
    let error = |r: &gudgeon_core::result::RunResult, name: &str| {
        let (a, b) = (r.results.get(name).map_or(f64::NAN, |v| v.value), tight.results[name].value);
        if b == 0.0 { (a - b).abs() } else { ((a - b) / b).abs() }
    };
    let trust = chosen.iter().map(|n| error(&loose, n)).fold(0.0, f64::max);
    let mut table = BenchTable {
        case: base.name.clone(),
        title: base.title().to_owned(),
        reference: format!(
            "implicit system, Radau IIA order 5, tolerance 1e-8; differs from the same at 1e-7 by at most {trust:.1e} (relative)"
        ),
        reference_values: chosen
            .iter()
            .filter_map(|n| tight.results.get(n).map(|v| (n.clone(), v.clone())))
            .collect(),
        ..BenchTable::default()
    };
    let sweeps = sweeps(case);
    let total = (sweeps.len() * REPEATS) as f64;
    let mut samples: Vec<Vec<(f64, f64)>> = vec![Vec::new(); sweeps.len()];
    // Methods take turns, so that a slow spell of the machine hits all of them.
    for repeat in 0..REPEATS {
        for (k, s) in sweeps.iter().enumerate() {
            progress(Progress {
                phase: format!("{}, {}", s.method, s.setting),
                fraction: 0.2 + 0.8 * (repeat * sweeps.len() + k) as f64 / total,
            });
            let slow = samples[k].first().is_some_and(|(seconds, _)| *seconds > 1.0);
            if repeat > 0 && (slow && repeat > 2 || table.points[k].failure.is_some()) {
                continue;
            }
            let begin = Instant::now();
            let outcome = base
                .with(&s.set)
                .map_err(|r| r.to_string())
                .and_then(|c| run(&c, &mut |_| {}).map_err(|e| e.to_string()));
            let wall = begin.elapsed().as_secs_f64();
            if repeat == 0 {
                let mut point = BenchPoint {
                    method: s.method.into(),
                    setting: s.setting.clone(),
                    is_default: s.is_default,
                    seconds_per_cycle: 0.0,
                    seconds_total: 0.0,
                    cycles: 0.0,
                    work: IndexMap::new(),
                    errors: IndexMap::new(),
                    failure: None,
                };
                match &outcome {
                    Ok(r) => {
                        point.work = r.solver.counters.clone();
                        point.errors = chosen.iter().map(|n| (n.clone(), error(r, n))).collect();
                        point.cycles = *r.solver.counters.get("cycles").unwrap_or(&1) as f64;
                    }
                    Err(e) => point.failure = Some(e.clone()),
                }
                table.points.push(point);
            }
            if let Ok(r) = &outcome {
                samples[k].push((*r.seconds.get("solve").unwrap_or(&wall), table.points[k].cycles.max(1.0)));
            }
        }
    }
    for (point, s) in table.points.iter_mut().zip(&mut samples) {
        s.sort_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((seconds, cycles)) = s.get(s.len() / 2) {
            point.seconds_total = *seconds;
            point.seconds_per_cycle = seconds / cycles;
        }
    }
    table.findings = findings(&table, &chosen);
    Ok(table)
}

/// Compares methods at equal error: time interpolated on the log-log curve of each.
fn findings(table: &BenchTable, chosen: &[String]) -> Vec<String> {
    let mut out = Vec::new();
    let worst = |p: &BenchPoint| chosen.iter().filter_map(|n| p.errors.get(n)).copied().fold(0.0, f64::max);
    let best = |method: &str, error: f64| {
        table
            .points
            .iter()
            .filter(|p| p.method == method && p.failure.is_none() && worst(p) <= error)
            .min_by(|a, b| a.seconds_per_cycle.total_cmp(&b.seconds_per_cycle))
    };
    for error in [1e-2, 1e-3, 1e-4] {
        let (mut reach, mut fail) = (Vec::new(), Vec::new());
        for method in METHODS {
            match best(method, error) {
                Some(p) => reach.push(p),
                None => fail.push(method),
            }
        }
        reach.sort_by(|a, b| a.seconds_per_cycle.total_cmp(&b.seconds_per_cycle));
        let Some(first) = reach.first() else { continue };
        let mut text = format!("at an error of {error:.0e} in {}: ", chosen.join(", "));
        for (i, p) in reach.iter().enumerate() {
            if i > 0 {
                text.push_str("; ");
            }
            text.push_str(&format!(
                "{} ({}) {:.3} ms a cycle",
                p.method,
                p.setting,
                1e3 * p.seconds_per_cycle
            ));
            if i > 0 {
                text.push_str(&format!(
                    ", {:.1} times the first",
                    p.seconds_per_cycle / first.seconds_per_cycle
                ));
            }
        }
        for method in fail {
            text.push_str(&format!("; {method} does not reach it within this sweep"));
        }
        out.push(text);
    }
    out
}
