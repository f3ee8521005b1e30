//! Questions of the page and the answers to them.

use gudgeon_case::Report;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::drawings::drawings;
use crate::playground::{Failed, Playground};

/// What the page asks.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "ask", rename_all = "snake_case")]
pub enum Request {
    /// The cases, by scene.
    Catalogue,
    /// The script that draws runs.
    Drawings,
    /// The text of a case that comes with the page.
    Text {
        /// Its name.
        file: String,
    },
    /// Sliders, choices and notes of a text.
    Open {
        /// Name of the case.
        file: String,
        /// Its text.
        text: String,
    },
    /// The text with changes written into it.
    Change {
        /// Name of the case.
        file: String,
        /// Its text.
        text: String,
        /// What changes, `PATH=VALUE`.
        set: Vec<String>,
    },
    /// Results and drawings of a text.
    Run {
        /// Name of the case.
        file: String,
        /// Its text.
        text: String,
        /// Whether the settings of [`crate::shown::Shown::preview`] are to make it faster.
        #[serde(default)]
        preview: bool,
    },
    /// The files of the last run that was no preview.
    Files,
    /// What the schema knows about a place of a text.
    Help {
        /// Its text.
        text: String,
        /// Byte offset.
        offset: usize,
    },
}

/// Answers a question in JSON. `{"refused": […]}` holds the mistakes of a case with their places, `{"failed": "…"}` why a run or a question has no
/// answer.
pub fn answer(playground: &mut Playground, question: &str) -> String {
    let value = match serde_json::from_str(question) {
        Ok(request) => reply(playground, request).unwrap_or_else(|e| match e {
            Failed::Refused(report) => json!({ "refused": mistakes(&report) }),
            Failed::Run(why) => json!({ "failed": why }),
        }),
        Err(e) => json!({ "failed": format!("the page asked what nobody understands: {e}") }),
    };
    value.to_string()
}

fn reply(p: &mut Playground, request: Request) -> Result<Value, Failed> {
    match request {
        Request::Catalogue => Ok(p.catalogue()),
        Request::Drawings => Ok(json!({ "script": drawings() })),
        Request::Text { file } => p.text(&file),
        Request::Open { file, text } => p.open(&file, text),
        Request::Change { file, text, set } => p.change(&file, text, &set),
        Request::Run { file, text, preview } => p.run(&file, text, preview),
        Request::Files => p.files(),
        Request::Help { text, offset } => Ok(p.help(text, offset)),
    }
}

/// The mistakes of a report: `message`, `help`, `path`, `line` and `column` from 1, `length` in characters.
fn mistakes(report: &Report) -> Value {
    let one = |d: &gudgeon_case::Diagnostic| {
        let place = report.place(d);
        let span = d.span.clone().and_then(|s| report.source.text.get(s));
        let length = span.and_then(|s| s.lines().next()).map_or(0, |s| s.chars().count());
        json!({
            "message": d.headline(), "help": d.help, "path": d.path,
            "line": place.as_ref().map(|p| p.1), "column": place.as_ref().map(|p| p.2), "length": length,
        })
    };
    report.diagnostics.iter().map(one).collect()
}
