//! The piston in its bore as a scene: what it refuses, explains, runs and how its solvers compare.

use gudgeon_case::Loaded;
use gudgeon_core::BuildError;
use gudgeon_core::kinds::EngineCycle;
use gudgeon_core::result::{ModelUse, Note, RunResult, Skipped, SolverReport};
use gudgeon_scene::elsewhere::Elsewhere;
use gudgeon_scene::{Explanation, Progress, RunError, SceneCase, Stopped, WorkPrecision};

use super::assemble::assemble;
use super::assembly::Assembly;
use super::case::PistonSecondaryCase;
use super::elsewhere::elsewhere;
use super::explained::{Explained, models};
use super::impossible::impossible;
use super::march::{Found, Purpose};
use super::plan::{self, ResultInfo};
use super::record::Record;
use super::row::Look;
use super::search::{Search, refused, work};
use super::survey::Survey;
use super::{draw, film_strokes, headlines, methods, notes, results};

impl SceneCase for PistonSecondaryCase {
    /// The piston as its models have it. A run builds others beside it: with films that nobody has asked yet, coarser ones, or a rigid skirt.
    type Built = Assembly;

    fn build(loaded: &Loaded<Self>) -> Result<Assembly, Vec<BuildError>> {
        let mut a = assemble(&loaded.value, &loaded.source.files, true, None)?;
        let mut errors = impossible(&loaded.value, &mut a);
        errors.extend(plan::wanted(&loaded.value, &a).err().unwrap_or_default());
        if errors.is_empty() { Ok(a) } else { Err(errors) }
    }

    fn explain(
        loaded: &Loaded<Self>,
        a: &mut Assembly,
        told: &mut Explanation,
    ) -> Result<Vec<ModelUse>, RunError> {
        let case = &loaded.value;
        let wanted = wanted(case, a)?;
        let why = |what: &str, why: &str| Skipped { what: what.into(), why: why.into() };
        told.runs.push(why("films of both sides", "their forces move the piston"));
        let mut explained = Explained::new(case, a, &wanted);
        told.runs.append(&mut explained.runs);
        told.skipped.append(&mut explained.skipped);
        told.results = wanted.into_iter().map(|r| r.name).collect();
        told.states = a.layout.states.iter().map(|s| s.name.clone()).collect();
        Ok(models(case))
    }

    fn cycle(loaded: &Loaded<Self>) -> Option<Result<EngineCycle, BuildError>> {
        let (c, files) = (&loaded.value, &loaded.source.files);
        let (motion, gas) = (&*c.models.kinematics, &*c.models.cylinder_pressure);
        Some(c.engine.cycle(motion, gas, c.gas.crankcase_pressure, files))
    }

    fn elsewhere(loaded: &Loaded<Self>, a: &mut Assembly) -> Vec<Elsewhere> {
        elsewhere(&loaded.value, a)
    }

    fn result_names(loaded: &Loaded<Self>, a: &mut Assembly) -> Option<Vec<String>> {
        Some(wanted(&loaded.value, a).ok()?.into_iter().map(|r| r.name).collect())
    }

    fn run(
        loaded: &Loaded<Self>,
        checked: Assembly,
        progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
    ) -> Result<RunResult, RunError> {
        let case = &loaded.value;
        let wanted = wanted(case, &checked)?;
        let mut search = Search::new(loaded, progress);
        let start = search.start(checked)?;
        let mut a = search.built(start.elastic, None)?;
        let phase = if start.elastic { "elastic skirt" } else { "rigid skirt" };
        let found = search.run(phase, &mut a, start.begin(), Purpose::Results, false)?;
        let mut result = RunResult { models: models(case), ..RunResult::default() };
        result.skipped = Explained::new(case, &a, &wanted).skipped;
        result.skipped.extend(start.skipped);
        look_at(case, &mut a, &found, &wanted, &mut search, &mut result)?;
        Ok(result)
    }

    fn work_precision(loaded: &Loaded<Self>, _: &mut Assembly) -> Result<WorkPrecision, String> {
        Ok(methods::work_precision(&loaded.value))
    }
}

fn wanted(case: &PistonSecondaryCase, a: &Assembly) -> Result<Vec<ResultInfo>, RunError> {
    plan::wanted(case, a).map_err(refused)
}

/// Looks at the motion found, for results, notes, series and figures.
fn look_at(
    case: &PistonSecondaryCase,
    a: &mut Assembly,
    found: &Found,
    wanted: &[ResultInfo],
    search: &mut Search<'_>,
    result: &mut RunResult,
) -> Result<(), RunError> {
    let flows = wanted.iter().any(|r| r.flow);
    let bends = a.breakpoints.clone();
    let mut look = Look::new(a, &found.trajectory, flows);
    let before = work(&look.a.piston);
    // Results come first: no row that is shown can change them.
    let (told, films, notes) = Survey::new(&mut look, &bends)
        .and_then(|s| {
            let told = results::tell(&s, &mut look, case, wanted, found.periodicity_error)?;
            let films = film_strokes::table(&s, &mut look)?;
            let notes = notes::notes(&s, &mut look, told.peaks)?;
            Ok((told, films, notes))
        })
        .map_err(|e| look.stopped(e))?;
    let record = Record::new(&mut look, case, told.peaks, flows).map_err(|e| look.stopped(e))?;
    for ((name, now), before) in work(&look.a.piston).into_iter().zip(before) {
        search.count(name, now - before.1);
    }
    (result.results, result.events) = (told.results, told.events);
    result.tables.insert("skirt_films".into(), films);
    result.solver = SolverReport {
        method: case.solver.method.typetag_name().into(),
        counters: std::mem::take(&mut search.counters),
        notes: a.cylinder.notes().into_iter().chain(found.notes.iter().cloned()).collect(),
    };
    result.solver.notes.extend(notes);
    result.solver.notes.push(centre_of_gravity(case));
    result.balance.skirt_oil = found.trajectory.oil.as_ref().map(|oil| oil.ledger.error());
    draw::figures(a, &record, result);
    draw::slap(&told.spectrum, result);
    result.headlines = headlines::headlines();
    result.lead = draw::PISTON.into();
    result.series = record.series();
    result.seconds.insert("solve".into(), search.seconds);
    Ok(())
}

fn centre_of_gravity(case: &PistonSecondaryCase) -> Note {
    // Of a case that ran, both are there.
    let pin = case.engine.crank().map_or(0.0, |c| c.pin_offset);
    let offset = 1e3 * case.piston.body(pin).map_or(0.0, |b| b.gravity_offset);
    let side = if offset > 0.0 { "thrust" } else { "anti-thrust" };
    Note::info(
        "centre_of_gravity",
        format!("Centre of gravity {:.3} mm from the pin on its {side} side", offset.abs()),
    )
}
