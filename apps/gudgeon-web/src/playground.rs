//! What the page can have done.

use gudgeon_case::{InputValue, Report, scene_of};
use gudgeon_core::result::{NoteLevel, RunResult};
use gudgeon_core::unwatched;
use gudgeon_report::{run_data, run_files};
use gudgeon_scene::{Checked, help, load, run, scenes};
use serde_json::{Value, json};

use crate::cases::CASES;
use crate::controls::{choices, sliders};
use crate::place::{checked, source};
use crate::shown;
use crate::swap;

/// Why there is no answer.
#[derive(Debug)]
pub enum Failed {
    /// The case is wrong.
    Refused(Report),
    /// The run, or the question.
    Run(String),
}

impl From<Report> for Failed {
    fn from(report: Report) -> Self {
        Self::Refused(report)
    }
}

/// Keeps what the next question may be about.
#[derive(Default)]
pub struct Playground {
    last: Option<RunResult>,
    /// The text that was checked last, by its file: what is opened is run next.
    checked: Option<(String, Checked)>,
}

impl Playground {
    /// The cases by scene, and what the program is.
    pub(crate) fn catalogue(&self) -> Value {
        let case = |(file, text): &(&str, &str)| {
            let source = source(file, (*text).to_owned());
            let title =
                text.lines().find_map(|l| l.strip_prefix("title = ")).map(|t| t.trim().trim_matches('"'));
            json!({ "file": file, "title": title.unwrap_or(file), "scene": scene_of(&source, &[]) })
        };
        let scenes: Vec<Value> =
            scenes().iter().map(|s| json!({ "name": s.name, "summary": s.summary })).collect();
        let cases: Vec<Value> = CASES.iter().map(case).collect();
        json!({
            "version": env!("CARGO_PKG_VERSION"), "revision": env!("GUDGEON_REVISION"), "scenes": scenes, "cases": cases,
        })
    }

    /// The text of a case.
    pub(crate) fn text(&self, file: &str) -> Result<Value, Failed> {
        let found = CASES.iter().find(|(name, _)| *name == file);
        let (_, text) = found.ok_or_else(|| Failed::Run(format!("there is no case `{file}`")))?;
        Ok(json!({ "file": file, "text": text }))
    }

    /// Sliders, choices and notes.
    pub(crate) fn open(&mut self, file: &str, text: String) -> Result<Value, Failed> {
        let c = self.checked(file, text)?;
        let heading = c.case.heading();
        let inputs = c.case.inputs();
        let scene = scene(c);
        Ok(json!({
            "name": c.name, "title": heading.title, "scene": scene, "source": heading.source, "notes": c.notes,
            "sliders": sliders(&inputs, &c.case.resolved(), shown::of(&scene)), "choices": choices(&inputs),
        }))
    }

    /// The case of a text, which is checked unless it is the one that was checked last.
    fn checked(&mut self, file: &str, text: String) -> Result<&Checked, Failed> {
        let known = |(name, c): &(String, Checked)| name == file && c.case.source().text == text;
        let case = match self.checked.take().filter(known) {
            Some(case) => case,
            None => (file.to_owned(), checked(file, text, &[])?),
        };
        Ok(&self.checked.insert(case).1)
    }

    /// The text with changes written into it. A model that needs keys gets them from its example.
    pub(crate) fn change(&self, file: &str, text: String, set: &[String]) -> Result<Value, Failed> {
        let case = load(source(file, text), &[])?;
        let new = case.rewritten(set)?;
        let written = |new: String, added: &[String]| json!({ "text": new, "added": added });
        if load(source(file, new.clone()), &[]).is_ok() {
            return Ok(written(new, &[]));
        }
        let inputs = case.inputs();
        let kind = |path: &str| {
            inputs.iter().find(|i| i.path == path).and_then(|i| match &i.value {
                InputValue::Choice(c) => Some(c.kind.clone()),
                _ => None,
            })
        };
        let present = |path: &str| inputs.iter().any(|i| i.path == path && i.line.is_some());
        let kinds = set.iter().filter_map(|s| Some((s, kind(s.split_once('=')?.0.trim())?)));
        let added: Vec<String> = kinds.flat_map(|(s, kind)| swap::needed(s, &kind, present)).collect();
        let all: Vec<String> = set.iter().chain(&added).cloned().collect();
        match case.rewritten(&all) {
            Ok(text) if !added.is_empty() => Ok(written(text, &added)),
            _ => Ok(written(new, &[])),
        }
    }

    /// Results and drawings.
    pub(crate) fn run(&mut self, file: &str, text: String, preview: bool) -> Result<Value, Failed> {
        let c = self.checked(file, text)?;
        let set = if preview { preview_of(c) } else { Vec::new() };
        let quicker;
        let c = match (preview, set.is_empty()) {
            (true, true) => return Err(Failed::Run("this case has no quicker settings".into())),
            (true, false) => {
                quicker = c.with(&set)?;
                &quicker
            }
            _ => c,
        };
        let mut result = run(c, &mut unwatched).map_err(|e| Failed::Run(e.to_string()))?;
        result.provenance.revision = env!("GUDGEON_REVISION").into();
        let told = told(c, &result, &set);
        if !preview {
            self.last = Some(result);
        }
        Ok(told)
    }

    /// `report.html`, `summary.json` and `series.csv` of the last run.
    pub(crate) fn files(&self) -> Result<Value, Failed> {
        let last = self.last.as_ref().ok_or_else(|| Failed::Run("nothing has run yet".into()))?;
        let files = run_files(last).map_err(|e| Failed::Run(e.to_string()))?;
        let text = |bytes: Vec<u8>| Value::from(String::from_utf8_lossy(&bytes).into_owned());
        Ok(Value::Object(files.into_iter().map(|(name, bytes)| (name, text(bytes))).collect()))
    }

    /// What the schema knows about a place.
    pub(crate) fn help(&self, text: String, offset: usize) -> Value {
        serde_json::to_value(help(&source("case.toml", text), offset)).unwrap_or_default()
    }
}

/// Name of the scene of a case.
fn scene(c: &Checked) -> String {
    scene_of(c.case.source(), c.case.overrides()).unwrap_or_default()
}

/// The changes that make a run of this case quicker; empty where it is quick already or has no such settings.
fn preview_of(c: &Checked) -> Vec<String> {
    let inputs = c.case.inputs();
    let worth = |(path, value): &&(&str, &str)| {
        inputs.iter().find(|i| i.path == *path).is_some_and(|i| match &i.value {
            InputValue::Number(n) => value.parse().is_ok_and(|v: f64| v > n.value),
            InputValue::Choice(choice) => choice.value != *value,
            _ => false,
        })
    };
    let all = shown::of(&scene(c)).map_or(&[][..], |s| s.preview);
    all.iter().filter(worth).map(|(path, value)| format!("{path}={value}")).collect()
}

/// What the page shows of a run.
fn told(c: &Checked, r: &RunResult, set: &[String]) -> Value {
    // Of rings and shafts the first.
    let headlines: Vec<String> =
        r.leading().into_iter().filter_map(|h| Some(h.results.into_iter().next()?.1)).collect();
    let results: Vec<Value> = r
        .results
        .iter()
        .map(|(name, v)| json!({ "name": name, "value": v.value, "unit": v.unit, "what": v.what }))
        .collect();
    let notes: Vec<Value> =
        r.solver.notes.iter().map(|n| json!({ "level": level(n.level), "text": n.text })).collect();
    json!({
        "case": c.name, "title": r.title, "scene": r.scene, "preview": set, "method": r.solver.method,
        "counters": r.solver.counters, "headlines": headlines, "results": results, "notes": notes, "data": run_data(r),
    })
}

const fn level(level: NoteLevel) -> &'static str {
    match level {
        NoteLevel::Failure => "failure",
        NoteLevel::Exceeded => "exceeded",
        NoteLevel::Caution => "caution",
        NoteLevel::Info => "info",
    }
}
