//! `--verify`: how far the results of a case are from those of its equations.
//!
//! Every numerical setting that a case and its models declare (`x-refine` in their schemas) is refined, one group after the other, until
//! what is left to gain is small beside what was gained. The uncertainty of a result is the sum over the groups of
//!
//! ```text
//! |R_0 - R_k| + |R_k - R_{k-1}| q/(1 - q),   q = |R_k - R_{k-1}| / |R_{k-1} - R_{k-2}|,
//! ```
//!
//! the difference between the case as it stands and its finest level, and the rest of a geometric series behind that one (q is taken as
//! 1/2 with one level, and as at most 9/10: a series that does not shrink is named). Periodic angles are compared around the cycle.
//! Whether the case has another periodic state is found by another start ([`crate::elsewhere`]).

use gudgeon_core::Stopped;
use gudgeon_core::result::{Note, Refined, RunResult, Value, Verification, change};
use indexmap::IndexMap;

use crate::elsewhere::look_elsewhere;
use crate::error::{Progress, RunError};
use crate::scene::{Scene, changed};
use gudgeon_case::Refinement;

/// A group is fine enough when the rest is at most this part of the uncertainty, for every result.
const KNOWN: f64 = 0.25;
/// Differences below this part of a value are rounding of the results, not trends.
const ROUNDING: f64 = 1e-10;
/// Differences below this part of the largest result of the same unit, and of 1 where there is none, are rounding as well: what is left
/// over of balances among such numbers carries the rounding of some thousand of them.
const LEFT_OVER: f64 = 1e-12;
/// The largest ratio of two differences that a series is believed to shrink by.
const SLOWEST: f64 = 0.9;
/// Ratio of differences that is assumed where there is but one.
const ASSUMED: f64 = 0.5;

type Results = IndexMap<String, Value>;

/// Refines every group of settings; adds the uncertainties to the result, and a note where a result does not settle or the case has another periodic state.
///
/// # Errors
/// Every refinement of a group failed.
pub(crate) fn verify(
    scene: &dyn Scene,
    result: &mut RunResult,
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<(), RunError> {
    let groups = scene.refinements();
    let mut found = Verification::default();
    let total = groups.len().max(1) as f64;
    let floors = floors(&result.results);
    for (k, Refinement { what, levels, .. }) in groups.into_iter().enumerate() {
        let mut going_on =
            || progress(Progress { phase: format!("refining the {what}"), fraction: k as f64 / total });
        going_on()?;
        let levels = levels.into_iter().map(|l| l.set).collect();
        let levels = refine(scene, levels, (&result.results, &floors), &mut going_on)?;
        let mut unsettled = Vec::new();
        for (name, v) in &result.results {
            let series: Vec<f64> = std::iter::once(v.value)
                .chain(levels.iter().filter_map(|(_, r)| r.get(name)).map(|v| v.value))
                .collect();
            let (u, settles) = uncertainty(&series, &v.unit, floors[v.unit.as_str()]);
            *found.uncertainty.entry(name.clone()).or_insert(0.0) += u;
            if !settles && u > KNOWN * v.value.abs() {
                unsettled.push(name.as_str());
            }
        }
        if !unsettled.is_empty() {
            let text = format!("refining the {what} does not settle {}", unsettled.join(", "));
            result.solver.notes.push(Note::caution(format!("unsettled.{}", what.replace(' ', "_")), text));
        }
        let levels = levels.into_iter().map(|(set, _)| set).collect();
        found.refined.push(Refined { what, levels });
    }
    look_elsewhere(scene, result, &found.uncertainty, progress)?;
    result.verification = Some(found);
    Ok(())
}

/// Results at each level, until the rest is small for all of them; each run asks whether to be `going_on`.
fn refine(
    scene: &dyn Scene,
    levels: Vec<Vec<String>>,
    (base, floors): (&Results, &IndexMap<String, f64>),
    going_on: &mut dyn FnMut() -> Result<(), Stopped>,
) -> Result<Vec<(Vec<String>, Results)>, RunError> {
    let mut out: Vec<(Vec<String>, Results)> = Vec::new();
    for set in levels {
        // A level beyond what the settings admit ends the refinement; that the first one fails is worth knowing.
        match changed(scene, &set).and_then(|s| s.once(&mut |_| going_on())) {
            Ok(r) => out.push((set, r.results)),
            Err(e) if out.is_empty() || matches!(e, RunError::Stopped) => return Err(e),
            Err(_) => break,
        }
        let known = base.iter().all(|(name, v)| {
            let series: Vec<f64> = std::iter::once(v.value)
                .chain(out.iter().filter_map(|(_, r)| r.get(name)).map(|v| v.value))
                .collect();
            let floor = floors[v.unit.as_str()];
            let u = uncertainty(&series, &v.unit, floor).0;
            rest(&series, &v.unit, floor).0 <= KNOWN * u || u <= (ROUNDING * v.value.abs()).max(floor)
        });
        if known {
            break;
        }
    }
    Ok(out)
}

/// By unit what is nothing but rounding.
fn floors(results: &Results) -> IndexMap<String, f64> {
    let mut floors = IndexMap::new();
    for v in results.values() {
        let least = if matches!(v.unit.as_str(), "" | "1" | "%") { 1.0 } else { 0.0 };
        let floor = floors.entry(v.unit.clone()).or_insert(LEFT_OVER * least);
        if v.value.is_finite() {
            *floor = floor.max(LEFT_OVER * v.value.abs());
        }
    }
    floors
}

/// What may be left behind the last of a series, and whether it shrinks: the rest of a geometric series, and at most the last difference where that takes back the one before, for the limit then
/// lies between the last two values.
fn rest(series: &[f64], unit: &str, floor: f64) -> (f64, bool) {
    let last = |k: usize| {
        let n = series.len();
        (n > k + 1).then(|| change(series[n - 2 - k], series[n - 1 - k], unit))
    };
    let Some(change) = last(0) else { return (0.0, true) };
    let (d, scale) = (change.abs(), series.iter().fold(0.0_f64, |m, v| m.max(v.abs())));
    if d <= (ROUNDING * scale).max(floor) {
        return (d, true);
    }
    let ratio = last(1).filter(|before| *before != 0.0).map_or(ASSUMED, |before| change / before);
    let q = ratio.abs().min(SLOWEST);
    let most = if ratio < 0.0 { 1.0 } else { f64::INFINITY };
    (d * (q / (1.0 - q)).min(most), ratio.abs() <= SLOWEST)
}

/// Uncertainty of the first of a series that is refined, and whether the series settles.
fn uncertainty(series: &[f64], unit: &str, floor: f64) -> (f64, bool) {
    let (Some(first), Some(last)) = (series.first(), series.last()) else { return (0.0, true) };
    let (rest, settles) = rest(series, unit, floor);
    (change(*first, *last, unit).abs() + rest, settles)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_uncertainty_bounds_the_error_of_a_series_that_converges() {
        // Orders one half to four, limit 1, error 0.1 at the coarsest.
        for q in [0.7, 0.5, 0.25, 0.0625] {
            let series: Vec<f64> = (0..4).map(|k| 1.0 + 0.1 * f64::powi(q, k)).collect();
            for n in 3..=4 {
                let (u, settles) = uncertainty(&series[..n], "N", 0.0);
                // A geometric series is summed exactly, within rounding of its differences.
                assert!(settles && (u - 0.1).abs() < 1e-9, "{q} {n} {u}");
            }
            let (u, _) = uncertainty(&series[..2], "N", 0.0);
            assert!(q > ASSUMED || u >= 0.1 - 1e-12, "{q} {u}");
        }
    }

    #[test]
    fn the_limit_of_a_series_that_goes_to_and_fro_lies_between_its_last_values() {
        // It shrinks by a fifth a time, about a limit of 1, from which it begins 0.1 away.
        let series = [1.1, 0.92, 1.064];
        let (u, settles) = uncertainty(&series, "N", 0.0);
        assert!(settles && (u - (0.036 + 0.144)).abs() < 1e-12, "{u}");
        // A fast one is the sum that it was: a tenth of a change.
        let (u, settles) = uncertainty(&[1.1, 0.99, 1.001], "N", 0.0);
        assert!(settles && (u - (0.099 + 0.011 * (0.1 / 0.9))).abs() < 1e-12, "{u}");
        // Noise does not settle, and is told by its size, not nine times that.
        let (u, settles) = uncertainty(&[1.0, 1.2, 1.0, 1.2], "N", 0.0);
        assert!(!settles && (u - 0.4).abs() < 1e-12, "{u}");
    }

    #[test]
    fn a_series_that_does_not_shrink_is_named() {
        assert!(!uncertainty(&[1.0, 2.0, 3.0], "N", 0.0).1);
        assert!(!uncertainty(&[675.0, 1294.0, 1883.0], "bar", 0.0).1);
        // Rounding is no trend.
        assert!(uncertainty(&[1.0, 1.0 + 1e-15, 1.0 - 1e-15], "N", 0.0).1);
    }

    #[test]
    fn angles_go_the_shorter_way() {
        assert!((uncertainty(&[719.9, 0.1], "deg", 0.0).0 - 0.4).abs() < 1e-9);
    }

    #[test]
    fn what_is_left_over_of_a_balance_is_rounding() {
        let value = |value: f64, unit: &str| Value { value, unit: unit.into(), what: String::new() };
        let results: Results = [
            ("load", value(1e4, "N")),
            ("out_of_balance", value(1e-11, "N")),
            ("flux_error", value(1e-16, "")),
        ]
        .into_iter()
        .map(|(k, v)| (k.to_owned(), v))
        .collect();
        let floors = floors(&results);
        assert!(uncertainty(&[1e-16, 3e-16, 9e-16], "", floors[""]).1);
        assert!(uncertainty(&[1e-11, 4e-10, 9e-9], "N", floors["N"]).1);
        // A trend above the rounding is still one.
        assert!(!uncertainty(&[1e-16, 3e-10, 9e-10], "", floors[""]).1);
    }
}
