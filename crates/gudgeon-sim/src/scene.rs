//! What a scene is: the case it reads, what it refuses, what it explains and how it runs.
//!
//! A scene is one implementation of [`SceneCase`] and one line in [`SCENES`]. Sweeps of any input are the same for all of them.

use std::any::Any;

use gudgeon_core::BuildError;
use gudgeon_core::result::{ModelUse, Note, RunResult, Value};
use gudgeon_core::schemars::{Schema, SchemaGenerator};
use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::case::RingPackCase;
use crate::foresee;
use crate::load::{Loaded, Refinement, Report, Source, load_source, scene_of};
use crate::pin::case::PinCase;
use crate::piston_secondary::case::PistonSecondaryCase;
use crate::power_cylinder::case::PowerCylinderCase;
use crate::rig::case::RigCase;
use crate::run::{Explanation, Progress, RunError};
use crate::shaft_line::case::ShaftLineCase;
use crate::study::Race;
use crate::sweep::{self, Sweep};

/// Scenes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SceneName {
    /// A piston ring pack in one cylinder.
    RingPack,
    /// Gudgeon pin and piston design.
    Pin,
    /// One sub-model on a test bench.
    Rig,
    /// The lateral motion and the tilt of a piston in its bore.
    PistonSecondary,
    /// Rings and skirt of one cylinder.
    PowerCylinder,
    /// A shaft line that twists.
    ShaftLine,
}

/// All scenes. The first one reads cases that name none of them, so that the rest of what is wrong is reported too.
pub static SCENES: &[SceneEntry] = &[
    SceneEntry::of::<RingPackCase>("ring_pack"),
    SceneEntry::of::<PinCase>("pin"),
    SceneEntry::of::<RigCase>("rig"),
    SceneEntry::of::<PistonSecondaryCase>("piston_secondary"),
    SceneEntry::of::<PowerCylinderCase>("power_cylinder"),
    SceneEntry::of::<ShaftLineCase>("shaft_line"),
];

/// What every case may say besides its physics.
#[derive(Debug, Clone, Copy, Default)]
pub struct Heading<'a> {
    /// One line for reports.
    pub title: &'a str,
    /// Where the case comes from.
    pub source: &'a str,
    /// Inputs that no source gives and that were assumed.
    pub assumptions: &'a [String],
    /// Inputs that are varied.
    pub sweeps: &'a [Sweep],
}

/// The part of a case that is the same for every scene. `case_file!` implements it.
pub trait Headed {
    /// Title, source, sweeps.
    fn heading(&self) -> Heading<'_>;
}

/// The type of a case file: the keys of its scene between those that every case may say.
macro_rules! case_file {
    ($(#[$about:meta])* pub struct $name:ident { $($own:tt)* }) => {
        $(#[$about])*
        #[derive(Debug, Clone, ::serde::Serialize, ::serde::Deserialize, ::schemars::JsonSchema)]
        #[serde(deny_unknown_fields)]
        pub struct $name {
            /// What is simulated.
            pub scene: $crate::scene::SceneName,
            /// One line for reports.
            #[serde(default)]
            pub title: String,
            /// Where the case comes from.
            #[serde(default)]
            pub source: String,
            /// Inputs that no source gives and that were assumed, one sentence each. Reports show them.
            #[serde(default)]
            pub assumptions: Vec<String>,
            $($own)*
            /// Inputs that are varied, one or two: every combination is run.
            #[serde(default, skip_serializing_if = "Vec::is_empty")]
            pub sweeps: Vec<$crate::sweep::Sweep>,
        }

        impl $crate::scene::Headed for $name {
            fn heading(&self) -> $crate::scene::Heading<'_> {
                $crate::scene::Heading {
                    title: &self.title,
                    source: &self.source,
                    assumptions: &self.assumptions,
                    sweeps: &self.sweeps,
                }
            }
        }
    };
}
pub(crate) use case_file;

/// What a case of one scene says and does.
pub trait SceneCase:
    Headed + Serialize + DeserializeOwned + JsonSchema + Send + Sync + Sized + 'static
{
    /// Everything that is wrong with a case that could be read, sweeps apart.
    fn legal(loaded: &Loaded<Self>) -> Vec<BuildError>;

    /// The models in use; adds to `told` what runs, what is skipped and which results there are.
    ///
    /// # Errors
    /// The sub-models cannot be built, which [`SceneCase::legal`] would have said.
    fn explain(loaded: &Loaded<Self>, told: &mut Explanation) -> Result<Vec<ModelUse>, RunError>;

    /// Runs the case once, sweeps apart. Title, source and scene are filled in by the caller.
    ///
    /// # Errors
    /// What stopped it.
    fn run(loaded: &Loaded<Self>, progress: &mut dyn FnMut(Progress)) -> Result<RunResult, RunError>;

    /// How its numerical settings are refined: those that it and its models declare.
    fn refinements(loaded: &Loaded<Self>) -> Vec<Refinement> {
        loaded.refinements()
    }

    /// Names of all results that a run may tell, known before it; none for a case that is not legal.
    fn result_names(loaded: &Loaded<Self>) -> Option<Vec<String>>;

    /// What `bench` races; none when the scene has no solvers to choose from.
    fn race(&self) -> Option<Race> {
        None
    }
}

/// A case of any scene with its places in the file. Implemented for every [`SceneCase`] that was read.
pub trait Scene: Send + Sync {
    /// Title, source, sweeps.
    fn heading(&self) -> Heading<'_>;
    /// The text it was read from.
    fn source(&self) -> &Source;
    /// The `--set` arguments that changed it.
    fn overrides(&self) -> &[String];
    /// What a person should know although nothing is wrong.
    fn notes(&self) -> &[String];
    /// Every value in SI units, changes and defaults filled in.
    fn resolved(&self) -> serde_json::Value;
    /// As [`SceneCase::refinements`].
    fn refinements(&self) -> Vec<Refinement>;
    /// Everything that is wrong, the changes that sweeps make included.
    fn legal(&self) -> Vec<BuildError>;
    /// Everything that is wrong, sweeps apart.
    fn legal_alone(&self) -> Vec<BuildError>;
    /// As [`SceneCase::result_names`].
    fn result_names(&self) -> Option<Vec<String>>;
    /// A report on errors found after the case was read.
    fn refuse(&self, errors: &[BuildError]) -> Report;
    /// The same case with some values changed, read but not built.
    ///
    /// # Errors
    /// Every mistake of the changes.
    fn changed(&self, set: &[String]) -> Result<Box<dyn Scene>, Report>;
    /// As [`SceneCase::explain`], with the resolved case.
    ///
    /// # Errors
    /// As [`SceneCase::explain`].
    fn explain(&self, told: &mut Explanation) -> Result<Vec<ModelUse>, RunError>;
    /// As [`SceneCase::run`].
    ///
    /// # Errors
    /// As [`SceneCase::run`]; a result that is not a number.
    fn once(&self, progress: &mut dyn FnMut(Progress)) -> Result<RunResult, RunError>;
    /// As [`SceneCase::race`].
    fn race(&self) -> Option<Race>;
    /// The typed case, for callers that know the scene.
    fn value(&self) -> &dyn Any;
}

impl<C: SceneCase> Scene for Loaded<C> {
    fn heading(&self) -> Heading<'_> {
        self.value.heading()
    }

    fn source(&self) -> &Source {
        &self.source
    }

    fn overrides(&self) -> &[String] {
        &self.overrides
    }

    fn notes(&self) -> &[String] {
        &self.notes
    }

    fn resolved(&self) -> serde_json::Value {
        // What a case was read from can be written: a type that cannot would fail its first test.
        Self::resolved(self).unwrap_or_default()
    }

    fn refinements(&self) -> Vec<Refinement> {
        C::refinements(self)
    }

    fn legal(&self) -> Vec<BuildError> {
        let heading = self.value.heading();
        let mut errors = C::legal(self);
        errors.extend(sweep::legal(heading.sweeps));
        // The file itself comes first: its mistakes would come back with every change.
        if errors.is_empty() {
            errors.extend(legal_changes(self, heading));
        }
        errors
    }

    fn legal_alone(&self) -> Vec<BuildError> {
        C::legal(self)
    }

    fn result_names(&self) -> Option<Vec<String>> {
        C::result_names(self)
    }

    fn refuse(&self, errors: &[BuildError]) -> Report {
        Self::refuse(self, errors)
    }

    fn changed(&self, set: &[String]) -> Result<Box<dyn Scene>, Report> {
        if set.iter().any(|s| s.split('=').next().is_some_and(|path| path.trim() == "scene")) {
            // Another scene is another type of case.
            let all: Vec<String> = self.overrides.iter().chain(set).cloned().collect();
            return load(Source::clone(&self.source), &all);
        }
        Ok(Box::new(self.reload::<C>(set)?))
    }

    fn explain(&self, told: &mut Explanation) -> Result<Vec<ModelUse>, RunError> {
        told.resolved = Scene::resolved(self);
        C::explain(self, told)
    }

    fn once(&self, progress: &mut dyn FnMut(Progress)) -> Result<RunResult, RunError> {
        let result = C::run(self, progress)?;
        let not_finite = |(_, v): &(&String, &Value)| !v.value.is_finite();
        match result.results.iter().find(not_finite) {
            Some((name, _)) => Err(RunError::NotANumber(name.clone())),
            None => Ok(result),
        }
    }

    fn race(&self) -> Option<Race> {
        self.value.race()
    }

    fn value(&self) -> &dyn Any {
        &self.value
    }
}

/// Reads a case from a text and `--set` arguments.
type Read = fn(Source, &[String]) -> Result<Box<dyn Scene>, Report>;

/// One scene in [`SCENES`].
pub struct SceneEntry {
    /// Name, as the key `scene` gives it.
    pub name: &'static str,
    /// Reads a case.
    read: Read,
    /// JSON schema of a case.
    schema: fn(&mut SchemaGenerator) -> Schema,
}

impl SceneEntry {
    const fn of<C: SceneCase>(name: &'static str) -> Self {
        Self {
            name,
            read: |source, overrides| Ok(Box::new(load_source::<C>(source, overrides)?)),
            schema: SchemaGenerator::subschema_for::<C>,
        }
    }

    /// JSON schema of a case of this scene.
    pub fn schema(&self, generator: &mut SchemaGenerator) -> Schema {
        (self.schema)(generator)
    }
}

/// Reads a case of the scene it names.
///
/// # Errors
/// Every mistake of the text and of the overrides.
pub fn load(source: Source, overrides: &[String]) -> Result<Box<dyn Scene>, Report> {
    let name = scene_of(&source, overrides);
    let entry = SCENES.iter().find(|s| Some(s.name) == name.as_deref()).unwrap_or(&SCENES[0]);
    (entry.read)(source, overrides)
}

/// What is wrong with the changes that sweeps make.
fn legal_changes(scene: &dyn Scene, heading: Heading<'_>) -> Vec<BuildError> {
    let mut errors = foresee::sweeps(scene, heading.sweeps);
    errors.extend(foresee::drawn(scene, heading.sweeps));
    errors
}

/// The case with some values changed; a refusal in one line.
pub(crate) fn changed(scene: &dyn Scene, set: &[String]) -> Result<Box<dyn Scene>, RunError> {
    scene.changed(set).map_err(|report| {
        RunError::Refused(format!(
            "{}: {}",
            set.join(", "),
            report.diagnostics.iter().map(|d| d.headline()).collect::<Vec<_>>().join("; ")
        ))
    })
}

/// Runs the case without its sweeps.
///
/// # Errors
/// What stopped it.
pub(crate) fn run_alone(
    scene: &dyn Scene,
    progress: &mut dyn FnMut(Progress),
) -> Result<RunResult, RunError> {
    Ok(headed(scene, scene.once(progress)?))
}

/// A result with what its case says of itself.
fn headed(scene: &dyn Scene, mut result: RunResult) -> RunResult {
    let heading = scene.heading();
    result.title = heading.title.into();
    result.source = heading.source.into();
    result.assumptions = heading.assumptions.to_vec();
    result.scene = scene_of(scene.source(), scene.overrides()).unwrap_or_default();
    result
}

/// Runs the case and its sweeps. Where the case itself fails, its sweeps are still run.
///
/// # Errors
/// What stopped it.
pub(crate) fn run(scene: &dyn Scene, progress: &mut dyn FnMut(Progress)) -> Result<RunResult, RunError> {
    let sweeps = scene.heading().sweeps;
    let mut result = match run_alone(scene, progress) {
        Err(e) if !sweeps.is_empty() => {
            let mut result = RunResult::default();
            result
                .solver
                .notes
                .push(Note::failure("case", format!("the case as it stands has no result: {e}")));
            headed(scene, result)
        }
        outcome => outcome?,
    };
    let points = sweep::run(scene, sweeps, &mut result, progress)?;
    result.solver.counters.insert("runs".into(), 1 + points as u64);
    Ok(result)
}
