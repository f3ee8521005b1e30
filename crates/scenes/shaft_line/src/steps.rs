//! Load steps: the machine with some of its inputs changed, read and checked as `--set` is.

use gudgeon_core::BuildError;

use super::case::{LoadStepCase, ShaftLineCase};
use super::start::Start;
use super::{assemble, legal_machine};
use gudgeon_case::{Loaded, Origin, Report};

/// Name of the load step that the case itself is.
pub const AS_IT_STANDS: &str = "as it stands";

/// Inputs that are one for all load steps: what is asked, not how the machine is loaded.
const COMMON: [&str; 14] = [
    "scene",
    "title",
    "source",
    "assumptions",
    "speed",
    "operating",
    "load_steps",
    "limits",
    "outputs",
    "range",
    "time",
    "models",
    "sweeps",
    "checks",
];

/// Names of all load steps in the order in which they are judged, with their changes; none for the case as it stands.
pub fn all(case: &ShaftLineCase) -> Vec<(&str, Option<&LoadStepCase>)> {
    let steps = || case.load_steps.iter();
    let own = (!steps().any(|s| s.set.is_empty())).then_some((AS_IT_STANDS, None));
    own.into_iter().chain(steps().map(|s| (s.name.as_str(), (!s.set.is_empty()).then_some(s)))).collect()
}

/// The case in a load step.
///
/// # Errors
/// Every mistake of its changes.
pub fn read(loaded: &Loaded<ShaftLineCase>, step: &LoadStepCase) -> Result<Loaded<ShaftLineCase>, Report> {
    loaded.reload(&step.set)
}

/// What is wrong with the load steps, each at its place.
pub fn legal(loaded: &Loaded<ShaftLineCase>) -> Vec<BuildError> {
    let case = &loaded.value;
    let mut errors = Vec::new();
    for (k, step) in case.load_steps.iter().enumerate() {
        let here = format!("load_steps.{k}");
        if step.name.trim().is_empty() {
            errors.push(BuildError::at(format!("{here}.name"), "a load step has a name"));
        }
        let twice = case.load_steps[..k]
            .iter()
            .any(|s| s.name == step.name || s.set.is_empty() && step.set.is_empty());
        if twice || step.name == AS_IT_STANDS && !step.set.is_empty() {
            let what = format!("`{}` is another load step already", step.name);
            errors.push(BuildError::at(format!("{here}.name"), what));
        }
        let before = errors.len();
        for (j, set) in step.set.iter().enumerate() {
            let root = set.split(['.', '=']).next().unwrap_or_default().trim();
            if COMMON.contains(&root) {
                let what = format!("`{root}` is one for all load steps");
                let e = BuildError::at(format!("{here}.set.{j}"), what);
                errors.push(
                    e.help("a load step changes the machine: drives, throws, shafts, inertias, dampers"),
                );
            }
        }
        if errors.len() == before && !step.set.is_empty() {
            errors.extend(legal_step(loaded, step, &here));
        }
    }
    errors
}

/// What is wrong with one load step: its text, then what is built from it.
fn legal_step(loaded: &Loaded<ShaftLineCase>, step: &LoadStepCase, here: &str) -> Vec<BuildError> {
    let common = loaded.overrides.len();
    let place = |origin: Origin| match origin {
        Origin::Override(k) if k >= common => format!("{here}.set.{}", k - common),
        _ => format!("{here}.set"),
    };
    let report = match read(loaded, step) {
        Err(report) => report,
        Ok(changed) => match assemble::assemble(&changed.value, &changed.source.files) {
            Err(e) => changed.refuse(&e),
            Ok(a) => {
                let start = Start::new(&changed.value, a.line.nodes.len());
                let errors = legal_machine(&changed.value, &a, &start);
                if errors.is_empty() {
                    return Vec::new();
                }
                changed.refuse(&errors)
            }
        },
    };
    let told = |d: &gudgeon_case::Diagnostic| {
        let e = BuildError::at(place(d.origin), format!("load step `{}`: {}", step.name, d.headline()));
        match &d.help {
            Some(help) => e.help(help.clone()),
            None => e,
        }
    };
    report.diagnostics.iter().map(told).collect()
}
