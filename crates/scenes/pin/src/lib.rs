//! The scene `pin`: a gudgeon pin evaluated or sized, and the piston around it.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]

pub mod case;
mod draw;
mod headlines;
mod methods;
mod names;
mod output;
mod setup;
mod size;
mod skirt;

use gudgeon_core::result::{Column, ModelUse, RunResult, Series, Skipped};
use gudgeon_core::{BuildError, Registry, Stopwatch};

use case::{Method, PinCase};
use gudgeon_case::Loaded;
use gudgeon_scene::{Explanation, Progress, RunError, SceneCase, Stopped, WorkPrecision, model_use};
use setup::Setup;

impl SceneCase for PinCase {
    /// Load and strength of the pin, where one is designed.
    type Built = Option<Setup>;

    fn build(loaded: &Loaded<Self>) -> Result<Option<Setup>, Vec<BuildError>> {
        let case = &loaded.value;
        let mut errors = Vec::new();
        if case.pin.is_none() && case.skirt.is_none() && case.crown.is_none() && case.dimensions.is_none() {
            errors.push(
                BuildError::new("the case designs nothing")
                    .help("give one of the tables `pin`, `skirt`, `crown` and `dimensions`"),
            );
        }
        let built = setup::setup(case, &loaded.source.files);
        match &built {
            Ok(s) => errors.extend(s.as_ref().and_then(|s| size::impossible(case, s))),
            Err(e) => errors.extend(e.iter().cloned()),
        }
        errors.extend(skirt::legal(case));
        built.and_then(|s| if errors.is_empty() { Ok(s) } else { Err(Vec::new()) }).map_err(|_| errors)
    }

    fn explain(
        loaded: &Loaded<Self>,
        _: &mut Option<Setup>,
        told: &mut Explanation,
    ) -> Result<Vec<ModelUse>, RunError> {
        let case = &loaded.value;
        let mut say = |what: &str, why: &str| told.runs.push(Skipped { what: what.into(), why: why.into() });
        if case.pin.is_some() {
            match case.optimise.as_ref().map(|o| o.method) {
                None => say("evaluation", "`pin` is given with its dimensions"),
                Some(Method::Exact) => say("exact optimum and its proof", "`optimise` is given"),
                Some(Method::AsPublished) => say("published search", "`optimise.method` asks for it"),
            }
        }
        for (given, what) in [
            (case.skirt.is_some(), "skirt"),
            (case.crown.is_some(), "crown"),
            (case.dimensions.is_some(), "dimensions"),
        ] {
            if given {
                say(what, "its table is given");
            }
        }
        told.skipped = skipped(case);
        Ok(models(case))
    }

    fn result_names(loaded: &Loaded<Self>, setup: &mut Option<Setup>) -> Option<Vec<String>> {
        Some(names::names(&loaded.value, setup.as_ref()))
    }

    fn work_precision(loaded: &Loaded<Self>, setup: &mut Option<Setup>) -> Result<WorkPrecision, String> {
        methods::work_precision(&loaded.value, setup.as_ref())
    }

    fn run(
        loaded: &Loaded<Self>,
        setup: Option<Setup>,
        progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
    ) -> Result<RunResult, RunError> {
        let case = &loaded.value;
        let begin = Stopwatch::start();
        let mut out = RunResult { models: models(case), skipped: skipped(case), ..RunResult::default() };
        // Nothing here runs over the crank angle unless the load does.
        out.series = Series {
            axis: Column { name: "x".into(), unit: "m".into(), values: Vec::new() },
            columns: Vec::new(),
        };
        if let Some(s) = setup {
            out.solver.notes.extend(s.load.notes.iter().cloned());
            size::run(case, &s, &mut out, progress)?;
        }
        skirt::run(case, &mut out)?;
        out.headlines = headlines::headlines();
        if out.solver.method.is_empty() {
            out.solver.method = "closed forms".into();
        }
        // Where a pin is searched, what is drawn of it is not part of the search.
        out.seconds.entry("solve".into()).or_insert_with(|| begin.seconds());
        Ok(out)
    }
}

fn models(case: &PinCase) -> Vec<ModelUse> {
    let registry = Registry::collect();
    let mut all = Vec::new();
    if case.pin.is_some() {
        if let Some(load) = &case.models.pin_load {
            all.push(("pin_load", load.typetag_name()));
            all.extend(load.models());
        }
        all.push(("pin_strength", case.models.pin_strength.typetag_name()));
        if !case.models.fatigue.is_off() {
            all.push(("fatigue", case.models.fatigue.typetag_name()));
        }
    }
    if case.skirt.is_some() {
        all.push(("profile_curve", case.models.profile_curve.typetag_name()));
    }
    all.into_iter().map(|(k, m)| model_use(&registry, k, m)).collect()
}

fn skipped(case: &PinCase) -> Vec<Skipped> {
    let mut out = Vec::new();
    let mut say = |what: &str, why: &str| out.push(Skipped { what: what.into(), why: why.into() });
    if case.pin.is_some() {
        if case.optimise.is_none() {
            say("optimum", "no table `optimise`");
        }
        if case.models.fatigue.is_off() {
            say("fatigue", "`models.fatigue` is off");
        }
    } else {
        say("pin", "no table `pin`");
    }
    if case.skirt.is_none() {
        say("skirt", "no table `skirt`");
    }
    out
}

gudgeon_scene::register_scene! {
    PinCase,
    name: "pin",
    summary: "gudgeon pin and piston design",
    equations: "stresses and deformations of the pin by closed forms of its load and dimensions, each within its limit; smallest mass under these limits",
    validity: "Design rules for a floating pin under its largest load; no contact pressure distribution, no dynamics.",
    references: ["reimer1984"],
}

gudgeon_core::link!(case::PinCase,);
