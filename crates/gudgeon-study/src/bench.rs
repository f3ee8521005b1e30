//! Work-precision: run time against error of the solvers of a scene.

use std::time::Instant;

use gudgeon_core::result::{BenchPoint, BenchTable, RunResult};
use gudgeon_scene::run::run_alone;
use gudgeon_scene::{Checked, MethodSetting, Progress, RunError, Stopped, WorkPrecision, foresee, unwatched};
use indexmap::IndexMap;

/// Runs per point, three for slow ones; the median counts.
const REPEATS: usize = 5;
/// Seconds from which a run is slow.
const SLOW: f64 = 1.0;

/// Runs every solver at every accuracy against a reference and states error beside run time.
///
/// The scene names the reference, an independent method far more accurate than the tightest setting, and a looser one that tells how
/// far it can be trusted.
///
/// # Errors
/// The reference cannot be run.
pub fn bench(
    base: &Checked,
    results: &[String],
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<BenchTable, RunError> {
    let Some(methods) = base.case.work_precision() else {
        return Err(RunError::Refused(
            "`bench` compares the solvers of a scene, and this one has none to choose from; `compare` swaps sub-models, and a sweep over a \
             grid with checks against a source shows the errors"
                .into(),
        ));
    };
    if let Some(known) = base.case.result_names() {
        foresee::all_known(results, &known).map_err(RunError::Refused)?;
    }
    progress(Progress { phase: "reference".into(), fraction: 0.0 })?;
    let tight = once(base, &methods.reference).map_err(RunError::Refused)?;
    progress(Progress { phase: "reference check".into(), fraction: 0.1 })?;
    let loose = once(base, &methods.reference_check).map_err(RunError::Refused)?;
    let chosen = chosen(&methods, results, &tight)?;
    let trust = chosen.iter().map(|n| error(&loose, &tight, n)).fold(0.0, f64::max);
    let value = |n: &String| tight.results.get(n).map(|v| (n.clone(), v.clone()));
    let mut table = BenchTable {
        case: base.name.clone(),
        title: base.title().to_owned(),
        reference: format!("{} by at most {trust:.1e} (relative)", methods.reference_is),
        reference_values: chosen.iter().filter_map(value).collect(),
        points: measure(base, &methods.settings, &tight, &chosen, progress)?,
        ..BenchTable::default()
    };
    table.findings = findings(&table, &methods.methods, &chosen);
    Ok(table)
}

/// One run with some settings changed.
fn once(base: &Checked, set: &[String]) -> Result<RunResult, String> {
    let c = base.with(set).map_err(|r| r.to_string())?;
    run_alone(&c, &mut unwatched).map_err(|e| e.to_string())
}

/// The results that errors are told of: those asked for, or those of the scene that this case has.
fn chosen(methods: &WorkPrecision, asked: &[String], reference: &RunResult) -> Result<Vec<String>, RunError> {
    if asked.is_empty() {
        let has = |n: &&&str| reference.results.contains_key(**n);
        return Ok(methods.results.iter().filter(has).map(|s| (*s).to_owned()).collect());
    }
    match asked.iter().find(|n| !reference.results.contains_key(n.as_str())) {
        None => Ok(asked.to_vec()),
        Some(missing) => {
            let known: Vec<_> = reference.results.keys().map(String::as_str).collect();
            let text = format!("there is no result `{missing}`; this case has {}", known.join(", "));
            Err(RunError::Refused(text))
        }
    }
}

/// Relative error of a result, absolute where the reference is zero.
fn error(r: &RunResult, reference: &RunResult, name: &str) -> f64 {
    let value = |r: &RunResult| r.results.get(name).map_or(f64::NAN, |v| v.value);
    let (a, b) = (value(r), value(reference));
    if b == 0.0 { (a - b).abs() } else { ((a - b) / b).abs() }
}

/// All settings, each [`REPEATS`] times. Methods take turns, so that a slow spell of the machine hits all of them.
fn measure(
    base: &Checked,
    settings: &[MethodSetting],
    reference: &RunResult,
    chosen: &[String],
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<Vec<BenchPoint>, Stopped> {
    let total = (settings.len() * REPEATS) as f64;
    let mut points: Vec<BenchPoint> = Vec::with_capacity(settings.len());
    let mut seconds: Vec<Vec<f64>> = vec![Vec::new(); settings.len()];
    for repeat in 0..REPEATS {
        for (k, s) in settings.iter().enumerate() {
            let fraction = 0.2 + 0.8 * (repeat * settings.len() + k) as f64 / total;
            progress(Progress { phase: format!("{}, {}", s.method, s.setting), fraction })?;
            let slow = seconds[k].first().is_some_and(|t| *t > SLOW);
            if repeat > 0 && (slow && repeat > 2 || points[k].failure.is_some()) {
                continue;
            }
            let begin = Instant::now();
            let outcome = once(base, &s.set);
            let wall = begin.elapsed().as_secs_f64();
            if let Ok(r) = &outcome {
                seconds[k].push(*r.seconds.get("solve").unwrap_or(&wall));
            }
            if repeat == 0 {
                points.push(point(s, outcome, reference, chosen));
            }
        }
    }
    for (p, mut s) in points.iter_mut().zip(seconds) {
        s.sort_by(f64::total_cmp);
        if let Some(median) = s.get(s.len() / 2) {
            (p.seconds_total, p.seconds_per_cycle) = (*median, median / p.cycles.max(1.0));
        }
    }
    Ok(points)
}

/// What the first run of a setting tells, times apart.
fn point(
    s: &MethodSetting,
    outcome: Result<RunResult, String>,
    reference: &RunResult,
    chosen: &[String],
) -> BenchPoint {
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
    match outcome {
        Ok(r) => {
            point.errors = chosen.iter().map(|n| (n.clone(), error(&r, reference, n))).collect();
            point.cycles = *r.solver.counters.get("cycles").unwrap_or(&1) as f64;
            point.work = r.solver.counters;
        }
        Err(e) => point.failure = Some(e),
    }
    point
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
