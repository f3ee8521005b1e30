//! Runs and times.

use std::collections::HashMap;
use std::time::Instant;

use gudgeon_core::result::{BenchPoint, RunResult};
use gudgeon_scene::{Asked, Checked, MethodSetting, Progress, Stopped};

use super::{Judge, once};

/// Runs per point, three for slow ones; the median counts.
const REPEATS: usize = 5;
/// Seconds from which a run is slow.
const SLOW: f64 = 1.0;

/// All settings, each [`REPEATS`] times. Methods take turns, so that a slow spell of the machine hits all of them.
pub fn measure(
    base: &Checked,
    settings: &[MethodSetting],
    judge: &Judge,
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<Vec<BenchPoint>, Stopped> {
    let total = (settings.len() * REPEATS) as f64;
    let mut points: Vec<BenchPoint> = Vec::with_capacity(settings.len());
    let mut seconds: Vec<Vec<f64>> = vec![Vec::new(); settings.len()];
    let mut tight = Tight::new();
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
                points.push(point(base, s, outcome, judge, &mut tight));
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

/// Runs at tight tolerances, by their settings; none for one that failed.
type Tight = HashMap<Vec<String>, Option<RunResult>>;

/// What the first run of a setting tells, times apart.
fn point(
    base: &Checked,
    s: &MethodSetting,
    outcome: Result<RunResult, String>,
    judge: &Judge,
    tight: &mut Tight,
) -> BenchPoint {
    let mut point = BenchPoint {
        method: s.method.clone(),
        setting: s.setting.clone(),
        is_default: s.is_default,
        asked: s.asked.as_ref().map(|a| a.tolerance),
        ..BenchPoint::default()
    };
    match outcome {
        Ok(r) => {
            point.errors = judge.errors(&r);
            point.achieved = s.asked.as_ref().and_then(|a| achieved(base, a, &r, judge, tight));
            // Counters of that name may mean cycles of a multigrid.
            let cycles = r.solver.counters.get("cycles").filter(|_| r.series.is_over_cycle());
            point.cycles = *cycles.unwrap_or(&1) as f64;
            point.work = r.solver.counters;
        }
        Err(e) => point.failure = Some(e),
    }
    point
}

/// The error that a tolerance leaves.
fn achieved(base: &Checked, a: &Asked, r: &RunResult, judge: &Judge, tight: &mut Tight) -> Option<f64> {
    if let Some(name) = a.told_by {
        return r.results.get(name).map(|v| v.value);
    }
    if a.against.is_empty() {
        return judge.errors(r).into_values().reduce(f64::max);
    }
    let other = tight.entry(a.against.clone()).or_insert_with(|| once(base, &a.against).ok());
    other.as_ref().map(|other| judge.apart(r, other))
}
