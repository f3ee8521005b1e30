//! The scene `rig`: one sub-model on a test bench.

use gudgeon_core::kinds::{Rig, RigCtx, RigOut};
use gudgeon_core::result::{Headline, ModelUse, RunResult, Skipped};
use gudgeon_core::{BuildError, EvalError, Registry, Stopwatch};

use crate::case::RigCase;
use gudgeon_case::Loaded;
use gudgeon_scene::{
    Explanation, OtherMethod, Progress, RunError, SceneCase, Stopped, WorkPrecision, model_use,
};

impl SceneCase for RigCase {
    type Built = Box<dyn Rig>;

    fn build(loaded: &Loaded<Self>) -> Result<Box<dyn Rig>, Vec<BuildError>> {
        let built = loaded.value.rig.build(&RigCtx { files: &loaded.source.files });
        built.map_err(|e| e.into_iter().map(|e| e.within("rig")).collect())
    }

    fn explain(
        loaded: &Loaded<Self>,
        _: &mut Box<dyn Rig>,
        told: &mut Explanation,
    ) -> Result<Vec<ModelUse>, RunError> {
        let models = models(&loaded.value);
        let stands =
            |(k, m): &(&str, &str)| Skipped { what: format!("{k}/{m}"), why: "stands on the bench".into() };
        told.runs = models.iter().map(stands).collect();
        let registry = Registry::collect();
        Ok(models.into_iter().map(|(k, m)| model_use(&registry, k, m)).collect())
    }

    fn result_names(_: &Loaded<Self>, rig: &mut Box<dyn Rig>) -> Option<Vec<String>> {
        Some(rig.results())
    }

    fn work_precision(loaded: &Loaded<Self>, bench: &mut Box<dyn Rig>) -> Result<WorkPrecision, String> {
        let rig = &loaded.value.rig;
        let results = match rig.headline() {
            [] => bench.results().into_iter().take(UNNAMED).collect(),
            named => named.iter().map(|n| (*n).to_owned()).collect(),
        };
        let mut told = WorkPrecision { results, ..WorkPrecision::default() };
        if let Some((place, others)) = rig.same_equations() {
            let own = rig.models().into_iter().find(|(kind, _)| *kind == place);
            told.own = own.map_or_else(String::new, |(_, model)| model.to_owned());
            let other = |model: &&str| OtherMethod {
                label: (*model).to_owned(),
                set: vec![format!("rig.{place}.model={model}")],
            };
            told.others = others.iter().map(other).collect();
        }
        Ok(told)
    }

    fn run(
        loaded: &Loaded<Self>,
        mut rig: Box<dyn Rig>,
        _: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
    ) -> Result<RunResult, RunError> {
        let case = &loaded.value;
        let begin = Stopwatch::start();
        let mut out = RigOut::default();
        rig.run(&mut out).map_err(|source: EvalError| RunError::Model { source })?;
        let registry = Registry::collect();
        let mut result = RunResult {
            models: models(case).into_iter().map(|(k, m)| model_use(&registry, k, m)).collect(),
            results: out.results,
            balance: out.balance,
            series: out.series,
            tables: out.tables,
            figures: out.figures,
            ..RunResult::default()
        };
        result.headlines = headlines(case.rig.headline(), &result);
        result.solver.method = case.rig.typetag_name().into();
        result.solver.counters = out.counters;
        result.solver.notes = out.notes;
        result.seconds.insert("solve".into(), begin.seconds());
        Ok(result)
    }
}

/// What the bench names, and results beside it until the first page is full.
fn headlines(named: &[&str], run: &RunResult) -> Vec<Headline> {
    let others = run.results.keys().map(String::as_str).filter(|name| !named.contains(name));
    let all = named.iter().copied().chain(others);
    let told = all.filter_map(|name| Some((name, run.results.get(name)?))).take(SHOWN);
    told.map(|(name, v)| Headline::one(&v.what, name)).collect()
}

/// Results on the first page.
const SHOWN: usize = 8;
/// Results that a race looks at where the bench names none.
const UNNAMED: usize = 4;

/// The models on the bench, in the order the rig names them, the rig itself first.
fn models(case: &RigCase) -> Vec<(&'static str, &'static str)> {
    let mut all = vec![("rig", case.rig.typetag_name())];
    for m in case.rig.models() {
        if !all.contains(&m) {
            all.push(m);
        }
    }
    all
}

gudgeon_scene::register_scene! {
    RigCase,
    name: "rig",
    summary: "one sub-model on a test bench",
    equations: "those of the sub-model under prescribed conditions",
    validity: "That of the sub-model.",
    references: [],
}
