//! From a file to results: the functions behind `check`, `explain` and `run`.

use std::path::Path;
use std::time::Instant;

use gudgeon_core::result::{ModelUse, Note, RunResult, Skipped};
use gudgeon_core::{BuildError, EvalError, Registry};
use gudgeon_numerics::ode::IntegrateError;
use serde::Serialize;

use crate::load::{Report, Source, read};
use crate::provenance::{self, provenance};
use crate::scene::{self, Scene, SceneCase};
use crate::verify::verify;

/// A case that was read, resolved and found to be possible.
pub struct Checked {
    /// Name of the case: the file name without its extension.
    pub name: String,
    /// Name of the case file without its folder.
    pub file: String,
    /// What a person should know although nothing is wrong (keys dropped by a model swap).
    pub notes: Vec<String>,
    /// The case.
    pub case: Box<dyn Scene>,
}

/// How far a run is.
#[derive(Debug, Clone, PartialEq)]
pub struct Progress {
    /// What is going on.
    pub phase: String,
    /// Fraction done, 0 to 1.
    pub fraction: f64,
}

/// A case that is well-formed but whose run failed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// A sub-model refused.
    #[error("at {theta_deg:.3} deg crank angle: {source}")]
    Eval {
        /// Where \[deg\].
        theta_deg: f64,
        /// What it said.
        source: EvalError,
    },
    /// A sub-model refused, wherever it was asked.
    #[error("{source}")]
    Model {
        /// What it said.
        source: EvalError,
    },
    /// The integrator gave up.
    #[error("the integration stopped: {}", in_degrees(.0))]
    Integrate(#[from] IntegrateError),
    /// The integrator of a ring pack needs too many steps.
    #[error(
        "at {theta_deg:.3} deg crank angle a cycle has taken {max} steps, the most that `solver.limits.most_steps` lets it take"
    )]
    Steps {
        /// Where \[deg\].
        theta_deg: f64,
        /// The limit.
        max: u64,
    },
    /// A ring rests on next to nothing.
    #[error(
        "at {theta_deg:.1} deg crank angle {load:.4} N press ring {ring} on a film of {film_nm:.2} nm, which neither oil nor contact carries. \
         Give the ring a `contact` that can carry it, such as `greenwood_tripp`"
    )]
    NothingCarries {
        /// Ring, from 1.
        ring: usize,
        /// Where \[deg\].
        theta_deg: f64,
        /// Load that is left \[N\].
        load: f64,
        /// Film thickness \[nm\].
        film_nm: f64,
    },
    /// The cycle does not close.
    #[error(
        "no periodic cycle after {cycles} cycles: estimated error {error:.2e}, wanted {wanted:.0e}. {advice}"
    )]
    NotPeriodic {
        /// Cycles run.
        cycles: u32,
        /// Estimated relative error.
        error: f64,
        /// Wanted relative error.
        wanted: f64,
        /// What may help.
        advice: String,
    },
    /// A result is not a number: a defect of a model, caught before anything is written.
    #[error("the result `{0}` is not a number; nothing was written")]
    NotANumber(String),
    /// The sub-models could not be built a second time.
    #[error("{0}")]
    Refused(String),
}

/// What an integrator over the crank angle says, with the angle in degrees.
fn in_degrees(e: &IntegrateError) -> String {
    let deg = |t: &f64| format!("{:.3} deg crank angle", t.to_degrees());
    match e {
        IntegrateError::Eval { t, source } => format!("at {}: {source}", deg(t)),
        IntegrateError::StepTooSmall { t, h, last } => {
            let why = last.as_ref().map_or_else(String::new, |e| format!(" ({e})"));
            format!("at {} the step would have to be smaller than {:e} deg{why}", deg(t), h.to_degrees())
        }
        IntegrateError::TooManySteps { t, max } => format!("more than {max} steps, stopped at {}", deg(t)),
        IntegrateError::NonFinite { t } => format!("at {} the rates are not finite", deg(t)),
        IntegrateError::Chatter { t, event } => {
            format!("at {} event {event} repeats without progress", deg(t))
        }
        other => other.to_string(),
    }
}

/// Reads, resolves and validates a case, or the case that the `summary.json` of a run recorded.
///
/// # Errors
/// Everything that is wrong with it, with places.
pub fn check(path: &Path, overrides: &[String]) -> Result<Checked, Report> {
    let source = read(path)?;
    if path.extension().is_some_and(|e| e == "json") {
        let (file, source, recorded) = provenance::recorded(&source)?;
        let all: Vec<String> = recorded.iter().chain(overrides).cloned().collect();
        return check_source(file, source, &all);
    }
    let file = path.file_name().map_or_else(|| "case".to_owned(), |s| s.to_string_lossy().into_owned());
    check_source(file, source, overrides)
}

/// As [`check`], from a text that was read before.
///
/// # Errors
/// As [`check`].
pub fn check_source(file: String, source: Source, overrides: &[String]) -> Result<Checked, Report> {
    let case = scene::load(source, overrides)?;
    let errors = case.legal();
    legal(file, case, &errors)
}

fn legal(file: String, case: Box<dyn Scene>, errors: &[BuildError]) -> Result<Checked, Report> {
    if !errors.is_empty() {
        return Err(case.refuse(errors));
    }
    let name =
        Path::new(&file).file_stem().map_or_else(|| file.clone(), |s| s.to_string_lossy().into_owned());
    Ok(Checked { name, file, notes: case.notes().to_vec(), case })
}

impl Checked {
    /// The same file with more `--set` arguments, its sweeps apart: what a study does for each of its variants.
    ///
    /// # Errors
    /// As [`check`].
    pub fn with(&self, more: &[String]) -> Result<Self, Report> {
        let case = self.case.changed(more)?;
        let errors = case.legal_alone();
        legal(self.file.clone(), case, &errors)
    }

    /// Title.
    #[must_use]
    pub fn title(&self) -> &str {
        self.case.heading().title
    }

    /// The case, when it is one of the scene `C`.
    #[must_use]
    pub fn of<C: SceneCase>(&self) -> Option<&C> {
        self.case.value().downcast_ref()
    }
}

/// A model with the references of its registration.
pub(crate) fn model_use(registry: &Registry, kind: &str, model: &str) -> ModelUse {
    ModelUse {
        kind: kind.into(),
        model: model.into(),
        references: registry
            .model(kind, model)
            .map(|m| m.references.iter().map(|r| (*r).to_owned()).collect())
            .unwrap_or_default(),
    }
}

/// One model in an [`Explanation`].
#[derive(Debug, Clone, Serialize)]
pub struct ExplainedModel {
    /// Kind and name.
    #[serde(rename = "model")]
    pub used: ModelUse,
    /// One line.
    pub summary: String,
    /// Governing equations.
    pub equations: String,
    /// Where it holds.
    pub validity: String,
}

/// The resolved case: every model, default and unit; what runs and what is skipped.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Explanation {
    /// Name of the case.
    pub case: String,
    /// Title.
    pub title: String,
    /// Every value, defaults filled in, SI units.
    pub resolved: serde_json::Value,
    /// Models that run.
    pub models: Vec<ExplainedModel>,
    /// What runs, and why.
    pub runs: Vec<Skipped>,
    /// What is left out, and why.
    pub skipped: Vec<Skipped>,
    /// Wanted results.
    pub results: Vec<String>,
    /// Floors, caps and drags: key, value, reason.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub limits: Vec<(String, String, String)>,
    /// Names of the states that are integrated.
    pub states: Vec<String>,
    /// Notes.
    pub notes: Vec<String>,
}

/// Explains a case without running it.
///
/// # Errors
/// When the sub-models cannot be built (which [`check`] would have said).
pub fn explain(c: &Checked) -> Result<Explanation, RunError> {
    let registry = Registry::collect();
    let mut told = Explanation {
        case: c.name.clone(),
        title: c.title().into(),
        notes: c.notes.clone(),
        ..Explanation::default()
    };
    let used = c.case.explain(&mut told)?;
    told.models = used
        .into_iter()
        .map(|used| {
            let info = registry.model(&used.kind, &used.model);
            let text = |f: fn(&gudgeon_core::ModelInfo) -> &'static str| info.map_or("", f).to_owned();
            ExplainedModel {
                summary: text(|i| i.summary),
                equations: text(|i| i.equations),
                validity: text(|i| i.validity),
                used,
            }
        })
        .collect();
    Ok(told)
}

impl Explanation {
    /// As text for a person.
    #[must_use]
    pub fn to_text(&self) -> String {
        use std::fmt::Write as _;
        let mut s = String::new();
        // Writing to a String cannot fail.
        let _ = writeln!(s, "{}: {}\n", self.case, self.title);
        let _ = writeln!(s, "Models");
        for m in &self.models {
            let _ = writeln!(s, "  {:<18} {}", m.used.kind, m.used.model);
            let _ = writeln!(s, "  {:<18}   {}", "", m.summary);
            for line in m.equations.split(";  ") {
                let _ = writeln!(s, "  {:<18}     {}", "", line.trim());
            }
            if !m.used.references.is_empty() {
                let _ = writeln!(s, "  {:<18}   [{}]", "", m.used.references.join(", "));
            }
        }
        let _ = writeln!(s, "\nRuns");
        for r in &self.runs {
            let _ = writeln!(s, "  {}: {}", r.what, r.why);
        }
        let _ = writeln!(s, "\nSkipped");
        if self.skipped.is_empty() {
            let _ = writeln!(s, "  nothing");
        }
        for r in &self.skipped {
            let _ = writeln!(s, "  {}: {}", r.what, r.why);
        }
        if !self.limits.is_empty() {
            let _ = writeln!(s, "\nFloors, caps and drags (what acts in a run is noted)");
            for (key, value, reason) in &self.limits {
                let _ = writeln!(s, "  {key} = {value}\n      {reason}");
            }
        }
        if !self.states.is_empty() {
            let _ = writeln!(s, "\nStates integrated ({}): {}", self.states.len(), self.states.join(", "));
        }
        if !self.results.is_empty() {
            let _ = writeln!(s, "Results: {}", self.results.join(", "));
        }
        for n in &self.notes {
            let _ = writeln!(s, "Note: {n}");
        }
        let _ = writeln!(s, "\nResolved case (SI units, defaults filled in)");
        print_value(&mut s, "", &self.resolved);
        s
    }
}

/// Flat `path = value` lines.
fn print_value(s: &mut String, path: &str, v: &serde_json::Value) {
    use std::fmt::Write as _;
    let join = |k: &str| if path.is_empty() { k.to_owned() } else { format!("{path}.{k}") };
    match v {
        serde_json::Value::Object(o) if !o.is_empty() => {
            for (k, v) in o {
                print_value(s, &join(k), v);
            }
        }
        serde_json::Value::Array(a) if a.iter().any(|v| v.is_object()) => {
            for (k, v) in a.iter().enumerate() {
                print_value(s, &join(&k.to_string()), v);
            }
        }
        v => {
            let _ = writeln!(s, "  {path} = {v}");
        }
    }
}

/// Runs a case with its sweeps.
///
/// # Errors
/// What stopped it; nothing has been written.
pub fn run(c: &Checked, progress: &mut dyn FnMut(Progress)) -> Result<RunResult, RunError> {
    let begin = Instant::now();
    finish(c, begin, scene::run(c.case.as_ref(), progress)?)
}

/// As [`run`], then refines every numerical setting until the uncertainty of each result is known.
///
/// # Errors
/// As [`run`]; a refinement that cannot be run.
pub fn run_verified(c: &Checked, progress: &mut dyn FnMut(Progress)) -> Result<RunResult, RunError> {
    verified(c, run(c, progress)?, progress)
}

fn verified(
    c: &Checked,
    mut result: RunResult,
    progress: &mut dyn FnMut(Progress),
) -> Result<RunResult, RunError> {
    let begin = Instant::now();
    verify(c.case.as_ref(), &mut result, progress)?;
    result.seconds.insert("verify".into(), begin.elapsed().as_secs_f64());
    Ok(result)
}

/// Runs a case without its sweeps.
///
/// # Errors
/// As [`run`].
pub(crate) fn run_alone(c: &Checked, progress: &mut dyn FnMut(Progress)) -> Result<RunResult, RunError> {
    let begin = Instant::now();
    finish(c, begin, scene::run_alone(c.case.as_ref(), progress)?)
}

/// As [`run_verified`] without the sweeps.
///
/// # Errors
/// As [`run_verified`].
pub(crate) fn run_alone_verified(
    c: &Checked,
    progress: &mut dyn FnMut(Progress),
) -> Result<RunResult, RunError> {
    verified(c, run_alone(c, progress)?, progress)
}

fn finish(c: &Checked, begin: Instant, mut result: RunResult) -> Result<RunResult, RunError> {
    result.case.clone_from(&c.name);
    result.gudgeon = env!("CARGO_PKG_VERSION").into();
    result.provenance = provenance(c);
    result.solver.notes.extend(c.notes.iter().map(|n| Note::caution("dropped_keys", n)));
    if let Some(column) = result.series.columns.iter().find(|c| c.values.iter().any(|v| !v.is_finite())) {
        return Err(RunError::NotANumber(column.name.clone()));
    }
    result.seconds.insert("total".into(), begin.elapsed().as_secs_f64());
    Ok(result)
}
