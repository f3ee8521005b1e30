//! Many runs of one case: `compare` and `bench`.

use std::path::Path;
use std::time::Instant;

use gudgeon_core::result::{BenchPoint, BenchTable, Comparison, RunResult, Variant};
use gudgeon_core::{BuildError, Registry};
use indexmap::IndexMap;

use crate::foresee;
use crate::load::Report;
use crate::run::{Checked, Progress, RunError, check, run_alone, run_alone_verified};

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

/// Most combinations of one comparison: each is a run, and all their results are kept.
const MOST_COMBINATIONS: usize = 1000;

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
    compare_by(run_alone, path, overrides, swaps, progress)
}

/// As [`compare`], and finds the numerical uncertainty of every result.
///
/// # Errors
/// As [`compare`].
pub fn compare_verified(
    path: &Path,
    overrides: &[String],
    swaps: &[(String, Vec<String>)],
    progress: &mut dyn FnMut(Progress),
) -> Result<Comparison, Report> {
    compare_by(run_alone_verified, path, overrides, swaps, progress)
}

/// How one combination is run.
type Run = fn(&Checked, &mut dyn FnMut(Progress)) -> Result<RunResult, RunError>;

fn compare_by(
    run: Run,
    path: &Path,
    overrides: &[String],
    swaps: &[(String, Vec<String>)],
    progress: &mut dyn FnMut(Progress),
) -> Result<Comparison, Report> {
    let base = check(path, overrides)?;
    let count = swaps.iter().fold(1usize, |n, (_, v)| n.saturating_mul(v.len()));
    if count > MOST_COMBINATIONS {
        let what = format!("the swaps make {count} combinations, at most {MOST_COMBINATIONS} are compared");
        return Err(base
            .case
            .refuse(&[BuildError::new(what).help("fewer values, or one `--swap` after the other")]));
    }
    let mut combinations: Vec<Vec<(String, String)>> = vec![Vec::new()];
    for (p, values) in swaps {
        if values.is_empty() || values.iter().any(String::is_empty) {
            let e = BuildError::new(format!("the swap `{p}` has an empty value"))
                .help("write `--swap PATH=A,B,C`");
            return Err(base.case.refuse(&[e]));
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
        return Err(base.case.refuse(&[BuildError::new("no combination to run")]));
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

/// Runs per point, three for slow ones; the median counts.
const REPEATS: usize = 5;

/// One solver at one setting.
pub struct Contender {
    /// Solver: settings of one method form one curve.
    pub method: &'static str,
    /// The setting: `tolerance 1e-4`, `16 sub-steps`.
    pub setting: String,
    /// Whether a case that says nothing has it.
    pub is_default: bool,
    /// The setting as `--set` takes it.
    pub set: Vec<String>,
}

/// What `bench` runs for a scene.
pub struct Race {
    /// Methods, in the order in which they are named.
    pub methods: Vec<&'static str>,
    /// Every method at every setting.
    pub contenders: Vec<Contender>,
    /// Settings that give the reference.
    pub reference: Vec<String>,
    /// Settings that tell how far the reference can be trusted.
    pub reference_check: Vec<String>,
    /// Both in words, up to "by at most".
    pub reference_is: &'static str,
    /// Results that are looked at unless told otherwise; those that the case has.
    pub results: Vec<&'static str>,
}

/// Sweeps the accuracy of every solver against a reference and states error beside run time.
///
/// The scene names the reference, an independent method far more accurate than the tightest contender, and a looser one that tells how
/// far it can be trusted.
///
/// # Errors
/// The reference cannot be run.
pub fn bench(
    base: &Checked,
    results: &[String],
    progress: &mut dyn FnMut(Progress),
) -> Result<BenchTable, RunError> {
    let Some(race) = base.case.race() else {
        return Err(RunError::Refused(
            "`bench` races the solvers of a scene, and this one has none to choose from; `compare` swaps sub-models, and a sweep over a \
             grid with checks against a source shows the errors"
                .into(),
        ));
    };
    if let Some(known) = base.case.result_names() {
        foresee::all_known(results, &known).map_err(RunError::Refused)?;
    }
    let reference = |set: &[String]| -> Result<_, RunError> {
        let c = base.with(set).map_err(|r| RunError::Refused(r.to_string()))?;
        run_alone(&c, &mut |_| {})
    };
    progress(Progress { phase: "reference".into(), fraction: 0.0 });
    let tight = reference(&race.reference)?;
    progress(Progress { phase: "reference check".into(), fraction: 0.1 });
    let loose = reference(&race.reference_check)?;
    let chosen: Vec<String> = if results.is_empty() {
        race.results.iter().map(|s| (*s).to_owned()).filter(|n| tight.results.contains_key(n)).collect()
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
        reference: format!("{} by at most {trust:.1e} (relative)", race.reference_is),
        reference_values: chosen
            .iter()
            .filter_map(|n| tight.results.get(n).map(|v| (n.clone(), v.clone())))
            .collect(),
        ..BenchTable::default()
    };
    let sweeps = &race.contenders;
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
                .and_then(|c| run_alone(&c, &mut |_| {}).map_err(|e| e.to_string()));
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
    table.findings = findings(&table, &race.methods, &chosen);
    Ok(table)
}

/// Compares methods at equal error: time interpolated on the log-log curve of each.
fn findings(table: &BenchTable, methods: &[&str], chosen: &[String]) -> Vec<String> {
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
        for &method in methods {
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
