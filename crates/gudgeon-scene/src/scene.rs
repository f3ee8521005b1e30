//! What a scene is: the case it reads, what it refuses, what it explains and how it runs.
//!
//! A scene is one implementation of [`SceneCase`] and one [`register_scene!`](crate::register_scene) beside it. Sweeps of any input are the
//! same for all of them.

use std::any::Any;
use std::borrow::Cow;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use gudgeon_case::catalogue::resolve;
use gudgeon_case::{
    Diagnostic, Document, Help, Input, Loaded, Origin, Refinement, Report, Source, UsedSet, load_document,
    nearest,
};
use gudgeon_core::kinds::EngineCycle;
use gudgeon_core::result::{GradientInput, Gradients, ModelUse, Note, RunResult, Value};
use gudgeon_core::{BuildError, Stopped, Stopwatch};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Map;

use crate::elsewhere::Elsewhere;
use crate::error::{Progress, RunError};
use crate::explanation::Explanation;
use crate::gradients::{self, GradientError, Varied};
use crate::heading::{Headed, Heading};
use crate::work_precision::WorkPrecision;

/// What a case of one scene says and does.
pub trait SceneCase:
    Headed + Serialize + DeserializeOwned + JsonSchema + Send + Sync + Sized + 'static
{
    /// The case with its sub-models built. What is checked is what is run.
    type Built: Send;

    /// Builds the sub-models.
    ///
    /// # Errors
    /// Everything that is wrong with a case that could be read, sweeps apart.
    fn build(loaded: &Loaded<Self>) -> Result<Self::Built, Vec<BuildError>>;

    /// What a person should look at before a run, although the case is possible: values far from anything usual, a trace that was filtered. A run tells
    /// the same among its notes.
    fn doubts(_loaded: &Loaded<Self>, _built: &mut Self::Built) -> Vec<Note> {
        Vec::new()
    }

    /// The models in use; adds to `told` what runs, what is skipped and which results there are.
    ///
    /// # Errors
    /// What only shows when the models are asked.
    fn explain(
        loaded: &Loaded<Self>,
        built: &mut Self::Built,
        told: &mut Explanation,
    ) -> Result<Vec<ModelUse>, RunError>;

    /// Names of all results that a run may tell, each once, known before it: a sweep or a comparison that asks for another one is refused. A
    /// run that tells one more panics where debug assertions are on.
    fn result_names(loaded: &Loaded<Self>, built: &mut Self::Built) -> Option<Vec<String>>;

    /// Runs the case once, sweeps apart. Title, source and scene are filled in by the caller.
    ///
    /// # Errors
    /// What stopped it.
    fn run(
        loaded: &Loaded<Self>,
        built: Self::Built,
        progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
    ) -> Result<RunResult, RunError>;

    /// The cycle of one cylinder, for cases of other scenes that take it from here; none when the scene describes no cylinder.
    fn cycle(_loaded: &Loaded<Self>) -> Option<Result<EngineCycle, BuildError>> {
        None
    }

    /// The parameter sets that it names, those of cases that it is made of included.
    fn sets(loaded: &Loaded<Self>) -> Vec<UsedSet> {
        loaded.sets.clone()
    }

    /// How its numerical settings are refined: those that it and its models declare.
    fn refinements(loaded: &Loaded<Self>) -> Vec<Refinement> {
        loaded.refinements()
    }

    /// Other starts of the search of a periodic state, for cases that may have several, those first that most often tell; none where their state is the only one, or where a run
    /// tells all.
    fn elsewhere(_loaded: &Loaded<Self>, _built: &mut Self::Built) -> Vec<Elsewhere> {
        Vec::new()
    }

    /// Derivatives of the results by inputs, at a fraction of the cost of runs with other inputs: from the case as it stands, and for each input the case
    /// with a slightly higher value, which `varied` builds. The inputs of the answer are filled in by the caller. `progress` is told as in [`SceneCase::run`].
    ///
    /// # Errors
    /// The scene has none of its own for this case ([`GradientError::NoMethod`], the default), or what stopped it.
    fn gradients(
        _loaded: &Loaded<Self>,
        _built: Self::Built,
        _varied: &dyn Fn() -> Result<Vec<Varied<Self>>, GradientError>,
        _progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
    ) -> Result<Gradients, GradientError> {
        Err(GradientError::NoMethod("this scene has no derivatives of its own".into()))
    }

    /// Its solvers at their settings, other methods for its equations, and what errors are counted from, for `bench`.
    ///
    /// # Errors
    /// Why there is nothing to race, and what to race instead.
    fn work_precision(_loaded: &Loaded<Self>, _built: &mut Self::Built) -> Result<WorkPrecision, String> {
        Ok(WorkPrecision::default())
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
    /// As [`SceneCase::sets`].
    fn sets(&self) -> Vec<UsedSet>;
    /// Paths of the values that the case gives and its scene does not use.
    fn unused(&self) -> Vec<String>;
    /// Every value in SI units, changes and defaults filled in.
    fn resolved(&self) -> serde_json::Value;
    /// As [`SceneCase::cycle`].
    fn cycle(&self) -> Option<Result<EngineCycle, BuildError>>;
    /// As [`SceneCase::refinements`].
    fn refinements(&self) -> Vec<Refinement>;
    /// As [`SceneCase::elsewhere`].
    fn elsewhere(&self) -> Vec<Elsewhere>;
    /// Its numbers, words and models, for a program that offers them to a person.
    fn inputs(&self) -> Vec<Input> {
        self.inputs_of(&self.resolved())
    }
    /// The same, where its resolved values are at hand.
    fn inputs_of(&self, resolved: &serde_json::Value) -> Vec<Input>;
    /// The text it was read from with further changes written into it, but not checked.
    ///
    /// # Errors
    /// A change that is none of a case, or that the text cannot hold.
    fn rewritten(&self, set: &[String]) -> Result<String, Report>;
    /// Everything that is wrong, sweeps apart.
    fn legal(&self) -> Vec<BuildError>;
    /// As [`SceneCase::doubts`].
    fn doubts(&self) -> Vec<Note>;
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
    fn once(&self, progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>) -> Result<RunResult, RunError>;
    /// Derivatives of the results by the inputs at these paths, by the scene's own method ([`SceneCase::gradients`]).
    ///
    /// # Errors
    /// [`GradientError`]: no method, an input that is no continuous quantity, a run that failed, or a caller that wants it to end.
    fn gradients(
        &self,
        inputs: &[String],
        progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
    ) -> Result<Gradients, GradientError>;
    /// As [`SceneCase::work_precision`].
    ///
    /// # Errors
    /// As [`SceneCase::work_precision`].
    fn work_precision(&self) -> Result<WorkPrecision, String>;
    /// The typed case, for callers that know the scene.
    fn value(&self) -> &dyn Any;
    /// The typed case, to be changed: how a scene hands values to its parts. Sub-models that were built are built anew.
    fn value_mut(&mut self) -> &mut dyn Any;
}

/// A case that was read, and its sub-models once they were built.
struct Read<C: SceneCase> {
    loaded: Loaded<C>,
    built: Mutex<Option<C::Built>>,
}

impl<C: SceneCase> Read<C> {
    fn new(loaded: Loaded<C>) -> Self {
        Self { loaded, built: Mutex::new(None) }
    }

    /// The sub-models, built if they are not yet or were used up by a run.
    fn take(&self) -> Result<C::Built, Vec<BuildError>> {
        let ready = self.built.lock().unwrap_or_else(PoisonError::into_inner).take();
        ready.map_or_else(|| C::build(&self.loaded), Ok)
    }

    /// Has `f` look at the sub-models, and keeps them.
    fn look<T>(&self, f: impl FnOnce(&mut C::Built) -> T) -> Result<T, Vec<BuildError>> {
        let mut built = self.take()?;
        let out = f(&mut built);
        *self.built.lock().unwrap_or_else(PoisonError::into_inner) = Some(built);
        Ok(out)
    }
}

impl<C: SceneCase> Read<C> {
    /// The case with a higher value of an input, or a lower one where that is at the end of what is legal.
    fn beside(&self, input: &GradientInput) -> Result<Varied<C>, GradientError> {
        self.varied(input, input.step).or_else(|e| self.varied(input, -input.step).map_err(|_| e))
    }

    fn varied(&self, input: &GradientInput, step: f64) -> Result<Varied<C>, GradientError> {
        let refuse = |why: String| GradientError::Input { path: input.path.clone(), why };
        let set = [gradients::assignment(input, input.value + step)];
        let loaded = self.loaded.reload::<C>(&set).map_err(|report| {
            let first = report.diagnostics.first().map_or_else(String::new, |d| d.headline().to_string());
            refuse(format!("cannot be varied: {first}"))
        })?;
        let built =
            C::build(&loaded).map_err(|e| refuse(format!("cannot be varied: {}", RunError::refused(&e))))?;
        Ok(Varied { step, loaded, built })
    }
}

impl<C: SceneCase> Scene for Read<C> {
    fn heading(&self) -> Heading<'_> {
        self.loaded.value.heading()
    }

    fn source(&self) -> &Source {
        &self.loaded.source
    }

    fn overrides(&self) -> &[String] {
        &self.loaded.overrides
    }

    fn notes(&self) -> &[String] {
        &self.loaded.notes
    }

    fn sets(&self) -> Vec<UsedSet> {
        C::sets(&self.loaded)
    }

    fn unused(&self) -> Vec<String> {
        self.loaded.unused()
    }

    fn resolved(&self) -> serde_json::Value {
        // What a case was read from can be written: a type that cannot would fail its first test.
        self.loaded.resolved().unwrap_or_default()
    }

    fn cycle(&self) -> Option<Result<EngineCycle, BuildError>> {
        C::cycle(&self.loaded)
    }

    fn refinements(&self) -> Vec<Refinement> {
        C::refinements(&self.loaded)
    }

    fn elsewhere(&self) -> Vec<Elsewhere> {
        self.look(|built| C::elsewhere(&self.loaded, built)).unwrap_or_default()
    }

    fn inputs_of(&self, resolved: &serde_json::Value) -> Vec<Input> {
        self.loaded.inputs_of(resolved)
    }

    fn rewritten(&self, set: &[String]) -> Result<String, Report> {
        self.loaded.rewritten(set)
    }

    fn legal(&self) -> Vec<BuildError> {
        self.look(|_| ()).err().unwrap_or_default()
    }

    fn doubts(&self) -> Vec<Note> {
        self.look(|built| C::doubts(&self.loaded, built)).unwrap_or_default()
    }

    fn result_names(&self) -> Option<Vec<String>> {
        self.look(|built| C::result_names(&self.loaded, built)).ok().flatten()
    }

    fn refuse(&self, errors: &[BuildError]) -> Report {
        self.loaded.refuse(errors)
    }

    fn changed(&self, set: &[String]) -> Result<Box<dyn Scene>, Report> {
        if set.iter().any(|s| s.split('=').next().is_some_and(|path| path.trim() == "scene")) {
            // Another scene is another type of case.
            let all: Vec<String> = self.overrides().iter().chain(set).cloned().collect();
            return load(Source::clone(&self.loaded.source), &all);
        }
        Ok(Box::new(Self::new(self.loaded.reload::<C>(set)?)))
    }

    fn explain(&self, told: &mut Explanation) -> Result<Vec<ModelUse>, RunError> {
        told.resolved = self.resolved();
        self.look(|built| C::explain(&self.loaded, built, told)).map_err(|e| RunError::refused(&e))?
    }

    fn once(&self, progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>) -> Result<RunResult, RunError> {
        let begin = Stopwatch::start();
        let built = self.take().map_err(|e| RunError::refused(&e))?;
        let seconds = begin.seconds();
        let mut result = C::run(&self.loaded, built, progress).map_err(RunError::plain)?;
        result.seconds.insert("build".into(), seconds);
        let not_finite = |(_, v): &(&String, &Value)| !v.value.is_finite();
        match result.results.iter().find(not_finite) {
            Some((name, _)) => Err(RunError::NotANumber(name.clone())),
            None => Ok(result),
        }
    }

    fn gradients(
        &self,
        inputs: &[String],
        progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
    ) -> Result<Gradients, GradientError> {
        let resolved = self.resolved();
        let inputs =
            inputs.iter().map(|p| gradients::followed(&resolved, p)).collect::<Result<Vec<_>, _>>()?;
        let built = self.take().map_err(|e| RunError::refused(&e))?;
        let varied = || inputs.iter().map(|i| self.beside(i)).collect();
        let found = C::gradients(&self.loaded, built, &varied, progress).map_err(GradientError::plain)?;
        Ok(Gradients { inputs, ..found })
    }

    fn work_precision(&self) -> Result<WorkPrecision, String> {
        let refused = |e: Vec<BuildError>| RunError::refused(&e).to_string();
        self.look(|built| C::work_precision(&self.loaded, built)).map_err(refused)?
    }

    fn value(&self) -> &dyn Any {
        &self.loaded.value
    }

    fn value_mut(&mut self) -> &mut dyn Any {
        *self.built.get_mut().unwrap_or_else(PoisonError::into_inner) = None;
        &mut self.loaded.value
    }
}

/// Reads a case from a text, the document that it is and `--set` arguments.
type ReadCase = fn(Source, Document, &[String]) -> Result<Box<dyn Scene>, Report>;

/// A registered scene.
#[derive(Debug)]
pub struct SceneInfo {
    /// Name, as the key `scene` gives it.
    pub name: &'static str,
    /// One line.
    pub summary: &'static str,
    /// The governing equations, as text.
    pub equations: &'static str,
    /// Where it holds and where it does not.
    pub validity: &'static str,
    /// Keys into `REFERENCES.bib`.
    pub references: &'static [&'static str],
    /// Module that registers it; its first word is the crate.
    pub module: &'static str,
    /// Source file.
    pub file: &'static str,
    /// Source line.
    pub line: u32,
    /// Reads a case.
    #[doc(hidden)]
    pub read: ReadCase,
    /// JSON schema of a case.
    #[doc(hidden)]
    pub schema: fn(&mut SchemaGenerator) -> Schema,
    /// Help on a place of a text.
    #[doc(hidden)]
    pub help: fn(&str, usize) -> Help,
}
gudgeon_core::inventory::collect!(SceneInfo);

impl SceneInfo {
    /// The crate that registers it, `gudgeon_scene_ring_pack`.
    #[must_use]
    pub fn crate_name(&self) -> &'static str {
        self.module.split("::").next().unwrap_or(self.module)
    }

    /// The JSON schema of a case and what it refers to.
    #[must_use]
    pub fn case_schema(&self) -> (serde_json::Value, Map<String, serde_json::Value>) {
        let mut generator = SchemaGenerator::default();
        let root = (self.schema)(&mut generator).to_value();
        let definitions = generator.take_definitions(true);
        // A case is a definition of its own, or stands at the root.
        let case = resolve(&root, &definitions).0.clone();
        (case, definitions)
    }
}

/// The JSON schemas of the cases of all scenes, each with what it refers to under `$defs`.
#[must_use]
pub fn case_schemas() -> Vec<serde_json::Value> {
    let one = |s: &&SceneInfo| {
        let (mut case, definitions) = s.case_schema();
        case["$defs"] = definitions.into();
        case
    };
    scenes().iter().map(one).collect()
}

/// Reads a case of the scene `C`: what [`register_scene!`](crate::register_scene) hands over.
#[doc(hidden)]
pub fn read_case<C: SceneCase>(
    source: Source,
    document: Document,
    overrides: &[String],
) -> Result<Box<dyn Scene>, Report> {
    Ok(Box::new(Read::new(load_document::<C>(source, document, overrides)?)))
}

/// Registers a scene, beside the implementation of [`SceneCase`].
///
/// ```ignore
/// register_scene! {
///     RingPackCase, name: "ring_pack",
///     summary: "…", equations: "…", validity: "…", references: ["key"],
/// }
/// ```
#[macro_export]
macro_rules! register_scene {
    ($case:ty, name: $name:literal, summary: $summary:expr, equations: $equations:expr, validity: $validity:expr,
     references: [$($r:literal),* $(,)?] $(,)?) => {
        $crate::inventory::submit! {
            $crate::SceneInfo {
                name: $name,
                summary: $summary,
                equations: $equations,
                validity: $validity,
                references: &[$($r),*],
                module: module_path!(),
                file: file!(),
                line: line!(),
                read: $crate::read_case::<$case>,
                schema: |g| g.subschema_for::<$case>(),
                help: $crate::help_at::<$case>,
            }
        }
        const _: () = {
            // Stands in the same object file as the registration.
            #[inline(never)]
            fn anchor() {}
            impl $crate::Linked<$crate::SceneInfo> for $case {
                const ANCHOR: fn() = anchor;
            }
        };
    };
}

/// All scenes linked into this program, by name.
pub fn scenes() -> &'static [&'static SceneInfo] {
    static ALL: OnceLock<Vec<&'static SceneInfo>> = OnceLock::new();
    ALL.get_or_init(|| {
        let mut all: Vec<_> = gudgeon_core::inventory::iter::<SceneInfo>().collect();
        all.sort_by_key(|s| (s.name, s.file, s.line));
        all
    })
}

/// Checks that no two scenes share a name.
///
/// # Errors
/// The places of both.
pub fn verify_scenes() -> Result<(), String> {
    match scenes().windows(2).find(|p| p[0].name == p[1].name) {
        None => Ok(()),
        Some(p) => Err(format!(
            "the scene `{}` is registered twice: {}:{} and {}:{}",
            p[0].name, p[0].file, p[0].line, p[1].file, p[1].line
        )),
    }
}

/// Name of a scene.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct SceneName(String);

impl SceneName {
    /// The name.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl JsonSchema for SceneName {
    fn schema_name() -> Cow<'static, str> {
        "SceneName".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let word = |s: &&SceneInfo| serde_json::json!({ "const": s.name, "description": s.summary, "type": "string" });
        let words: Vec<_> = scenes().iter().map(word).collect();
        schemars::json_schema!({ "description": "Scenes.", "oneOf": words })
    }
}

/// Reads a case of the scene it names. One that names none, or none that exists, is read as the scene that knows most of its keys, so
/// that the rest of what is wrong is reported too.
///
/// # Errors
/// Every mistake of the text and of the overrides.
pub fn load(source: Source, overrides: &[String]) -> Result<Box<dyn Scene>, Report> {
    let document = Document::of(&source.text);
    if let (None, Some(place)) = (document.scene(overrides), document.place("cases")) {
        let d = Diagnostic::new("this is the file of a study, not a case").at(Origin::File, Some(place));
        let d = d.help(format!("`gudgeon study new DIR {}` makes a study of it", source.name));
        return Err(Report::new(vec![d], Arc::new(source), Arc::from(overrides)));
    }
    match scene_for(&document, overrides) {
        Some(s) => (s.read)(source, document, overrides),
        None => {
            let what = "no scene is linked into this program";
            Err(Report::unreadable(&source.name, Diagnostic::new(what)))
        }
    }
}

/// The scene that a case names, or the one that is most like it.
fn scene_for(document: &Document, overrides: &[String]) -> Option<&'static SceneInfo> {
    let name = document.scene(overrides);
    let all = scenes();
    let named = |n: &str| all.iter().find(|s| s.name == n);
    name.as_deref()
        .and_then(|n| named(n).or_else(|| named(nearest(n, all.iter().map(|s| s.name))?)))
        .or_else(|| most_alike(document, all))
        .copied()
}

/// What the schema of a case knows about the line of a text that a byte offset stands in: of the scene that the text names, or that is most like it.
#[must_use]
pub fn help(source: &Source, offset: usize) -> Help {
    scene_for(&Document::of(&source.text), &[]).map_or_else(Help::default, |s| (s.help)(&source.text, offset))
}

/// The scene that knows most of the tables of a document.
fn most_alike<'a>(document: &Document, all: &'a [&'static SceneInfo]) -> Option<&'a &'static SceneInfo> {
    let keys = document.keys();
    let known = |s: &SceneInfo| {
        let mut generator = SchemaGenerator::default();
        let _ = (s.schema)(&mut generator);
        let definitions = generator.take_definitions(true);
        let own = |k: &&&str| {
            definitions
                .values()
                .any(|d| d["properties"]["scene"].is_object() && d["properties"][**k].is_object())
        };
        keys.iter().filter(own).count()
    };
    // The first of those that know equally many.
    all.iter().rev().max_by_key(|s| known(s))
}

/// The case with some values changed; a refusal in one line.
///
/// # Errors
/// Every mistake of the changes.
pub fn changed(scene: &dyn Scene, set: &[String]) -> Result<Box<dyn Scene>, RunError> {
    scene.changed(set).map_err(|report| {
        RunError::Refused(format!(
            "{}: {}",
            set.join(", "),
            report.diagnostics.iter().map(|d| d.headline()).collect::<Vec<_>>().join("; ")
        ))
    })
}
