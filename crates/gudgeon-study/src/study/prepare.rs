//! From a study file to the record of what is run: everything is read, and what can be known before a run is found wrong here.

use gudgeon_case::{Loaded, Report, advice};
use gudgeon_core::BuildError;
use gudgeon_scene::{Checked, check};
use indexmap::IndexSet;

use super::file::StudyFile;
use super::list::PointList;
use super::points::Plan;
use super::record::{KeptCase, Record};

/// Parts of a study whose file does not say how large they are, and the sizes that they have then.
const PARTS: usize = 250;
const PART: std::ops::RangeInclusive<usize> = 16..=4096;

/// Most points at which a study is tried before it runs.
const MAX_TRIED: usize = 500;

/// Reads the cases and the list of points of a study, and tries its inputs.
///
/// # Errors
/// Everything that is wrong, with places.
pub fn prepare(file: &Loaded<StudyFile>) -> Result<Record, Report> {
    let study = &file.value;
    let cases = cases(file)?;
    let list = match &study.list {
        None => None,
        Some(name) => Some(read_list(file, name).map_err(|e| file.refuse(&[e]))?),
    };
    let plan = Plan::new(study, list.clone()).map_err(|e| file.refuse(&e))?;
    let errors = tried(study, &plan, &cases);
    if !errors.is_empty() {
        return Err(file.refuse(&errors));
    }
    let points = plan.len();
    let part = match study.part {
        0 => points.div_ceil(PARTS).clamp(*PART.start(), *PART.end()),
        n => n,
    };
    let keep = |(own, case): (&super::file::Case, &Checked)| {
        KeptCase::of(own.parts().1, case.case.overrides(), case)
    };
    let mut record = Record {
        gudgeon: env!("CARGO_PKG_VERSION").into(),
        study: study.clone(),
        cases: study.cases.iter().zip(&cases).map(keep).collect(),
        list,
        points,
        part,
        sha256: String::new(),
    };
    record.sha256 = record.hash();
    Ok(record)
}

fn cases(file: &Loaded<StudyFile>) -> Result<Vec<Checked>, Report> {
    let study = &file.value;
    let mut names: Vec<&str> = Vec::new();
    for (k, case) in study.cases.iter().enumerate() {
        let (_, name, _) = case.parts();
        if names.contains(&name) {
            let e = BuildError::at(format!("cases.{k}"), format!("two cases are called `{name}`"));
            return Err(file.refuse(&[e.help("give one of them a name: `{ file = \"…\", name = \"…\" }`")]));
        }
        names.push(name);
    }
    let read = |case: &super::file::Case| {
        let (name, _, own) = case.parts();
        let set: Vec<String> = study.set.iter().chain(own).cloned().collect();
        check(&file.source.files.path(name), &set)
    };
    study.cases.iter().map(read).collect()
}

fn read_list(file: &Loaded<StudyFile>, name: &str) -> Result<PointList, BuildError> {
    let text = file.source.files.text(name).map_err(|e| {
        BuildError::at("list", format!("cannot read `{}`: {e}", file.source.files.path(name).display()))
    })?;
    PointList::read(&text)
}

/// Changes whose failure tells something: every value of every input once, with the first value of the others, up to [`MAX_TRIED`].
fn tried(study: &StudyFile, plan: &Plan, cases: &[Checked]) -> Vec<BuildError> {
    let step = (plan.len() / MAX_TRIED).max(1);
    let (mut done, mut refused, mut first) = (0_usize, 0_usize, None);
    let mut names: IndexSet<String> = cases.iter().filter_map(|c| c.case.result_names()).flatten().collect();
    for k in (0..plan.len()).step_by(step) {
        let (case, set) = plan.changes(k);
        done += 1;
        match cases[case].with(&set) {
            Ok(c) if study.results.iter().any(|r| !names.contains(r)) => {
                names.extend(c.case.result_names().unwrap_or_default());
            }
            Ok(_) => {}
            Err(report) => {
                refused += 1;
                first.get_or_insert_with(|| format!("{}: {}", set.join(", "), report.failure()));
            }
        }
    }
    if let Some(why) = first.filter(|_| refused == done) {
        return vec![BuildError::at("inputs", format!("no point of the study can be run; the first, {why}"))];
    }
    let known: Vec<&str> = names.iter().map(String::as_str).collect();
    let wrong = |(k, name): (usize, &String)| {
        let missing = !known.is_empty() && !names.contains(name);
        missing.then(|| {
            let e = BuildError::at(format!("results.{k}"), format!("there is no result `{name}`"));
            e.help(advice(name, &known))
        })
    };
    study.results.iter().enumerate().filter_map(wrong).collect()
}
