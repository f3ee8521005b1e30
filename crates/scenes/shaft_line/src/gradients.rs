//! Derivatives of what a line does at its mean speed.
//!
//! Natural frequencies, and the vibration of a torsion model whose equations are linear, are solutions to rounding. The derivative of such a solution,
//! `A dx = df - dA x` and `dω²= φᵀ(dK - ω² dM)φ/φᵀMφ`, costs as much as another solution, and a difference of two is good to a millionth, so each
//! input costs one solution at the mean speed. Nothing is searched for: results over the speed range and of the verdict are left to differences of runs.

use gudgeon_case::Loaded;
use gudgeon_core::result::{Gradient, Gradients, Note, RunResult};
use gudgeon_scene::{GradientError, Progress, RunError, Stopped, Varied, unwatched};

use super::assemble::Assembled;
use super::case::ShaftLineCase;
use super::plan::Plan;

/// A result that is rounding and nothing else.
const ROUNDING: &str = "holzer_residual";

pub fn gradients(
    loaded: &Loaded<ShaftLineCase>,
    a: &Assembled,
    varied: &dyn Fn() -> Result<Vec<Varied<ShaftLineCase>>, GradientError>,
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<Gradients, GradientError> {
    let case = &loaded.value;
    if !case.models.torsion.is_linear() {
        let name = case.models.torsion.typetag_name();
        let why = format!("the torsion model `{name}` iterates, or goes through time in steps");
        return Err(GradientError::NoMethod(why));
    }
    let own = answer(loaded, a)?.results;
    let mut found = Gradients {
        method: "differences of direct solutions at the mean speed".into(),
        results: own
            .into_iter()
            .filter(|(name, _)| name != ROUNDING)
            .map(|(name, v)| (name, Gradient::new(v)))
            .collect(),
        ..Gradients::default()
    };
    let varied = varied()?;
    for (k, v) in varied.iter().enumerate() {
        let fraction = (k + 1) as f64 / (varied.len() + 1) as f64;
        progress(Progress { phase: "derivatives".into(), fraction }).map_err(RunError::from)?;
        let there = answer(&v.loaded, &v.built)?.results;
        for (name, g) in &mut found.results {
            g.by.push(there.get(name).map(|r| (r.value - g.value.value) / v.step));
        }
        *found.counters.entry("lines_beside".into()).or_insert(0) += 1;
    }
    let whole = Plan::new(case);
    if whole.range || whole.verdict {
        let text = "results over the speed range and of the verdict, which come from searches, are not among them: take differences of runs";
        found.notes.push(Note::info("gradients_at_mean_speed", text));
    }
    Ok(found)
}

/// Results at the mean speed.
fn answer(loaded: &Loaded<ShaftLineCase>, a: &Assembled) -> Result<RunResult, RunError> {
    super::run(loaded, a, &Plan::at_mean_speed(&loaded.value), &mut unwatched)
}
