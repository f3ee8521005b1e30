//! Every combination of some models or settings of one case, side by side.

use std::path::Path;

use gudgeon_case::Report;
use gudgeon_core::result::{Comparison, RunResult, Variant};
use gudgeon_core::{BuildError, Registry};
use gudgeon_scene::many::run_many;
use gudgeon_scene::run::{run_alone, run_alone_verified};
use gudgeon_scene::{Checked, Progress, RunError, Stopped, check};

use crate::error::StudyError;

/// `gas_flow`, `models.gas_flow` and `models.gas_flow.model` all mean the model's name; anything else is taken as written.
pub(crate) fn swap_path(path: &str) -> String {
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
const MAX_COMBINATIONS: usize = 1000;

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
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<Comparison, StudyError> {
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
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<Comparison, StudyError> {
    compare_by(run_alone_verified, path, overrides, swaps, progress)
}

/// What a combination is called.
fn label(swaps: &[(String, String)]) -> String {
    let short = |(p, v): &(String, String)| {
        format!("{}={v}", p.trim_start_matches("models.").trim_end_matches(".model"))
    };
    swaps.iter().map(short).collect::<Vec<_>>().join(", ")
}

/// How one combination is run.
type Run = fn(&Checked, &mut dyn FnMut(Progress) -> Result<(), Stopped>) -> Result<RunResult, RunError>;

fn compare_by(
    run: Run,
    path: &Path,
    overrides: &[String],
    swaps: &[(String, Vec<String>)],
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<Comparison, StudyError> {
    let base = check(path, overrides)?;
    let count = swaps.iter().fold(1usize, |n, (_, v)| n.saturating_mul(v.len()));
    if count > MAX_COMBINATIONS {
        let what = format!("the swaps make {count} combinations, at most {MAX_COMBINATIONS} are compared");
        let e = BuildError::new(what).help("fewer values, or one `--swap` after the other");
        return Err(base.case.refuse(&[e]).into());
    }
    let mut combinations: Vec<Vec<(String, String)>> = vec![Vec::new()];
    for (p, values) in swaps {
        if values.is_empty() || values.iter().any(String::is_empty) {
            let e = BuildError::new(format!("the swap `{p}` has an empty value"))
                .help("write `--swap PATH=A,B,C`");
            return Err(base.case.refuse(&[e]).into());
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
            return Err(report.into());
        }
        return Err(base.case.refuse(&[BuildError::new("no combination to run")]).into());
    }
    let outcome = |k: usize, tell: &mut dyn FnMut(Progress) -> Result<(), Stopped>| match &checked[k] {
        Err(report) => Err(format!("refused: {}", report.failure())),
        Ok(c) => run(c, tell).map_err(|e| format!("failed: {e}")),
    };
    let outcomes = run_many(combinations.len(), 0, outcome, progress).all()?;
    let variants = combinations
        .into_iter()
        .zip(outcomes)
        .map(|(swaps, outcome)| Variant { label: label(&swaps), swaps, outcome })
        .collect();
    Ok(Comparison {
        case: base.name.clone(),
        title: base.title().to_owned(),
        swaps: swaps.iter().map(|(p, v)| (swap_path(p), v.clone())).collect(),
        variants,
    })
}
