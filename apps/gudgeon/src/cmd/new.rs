//! `gudgeon new [TEMPLATE] [FILE]`

use std::fs::OpenOptions;
use std::io::{ErrorKind, Write as _};
use std::path::Path;

use gudgeon_case::{Diagnostic, advice};
use serde_json::json;

use crate::args::NewArgs;
use crate::failure::Failure;
use crate::ui::{Ui, table};

/// A case that a person fills in: its name and its text, whose first line says in a comment what it is.
struct Template {
    name: &'static str,
    text: &'static str,
}

const TEMPLATES: &[Template] = &[
    Template { name: "petrol-engine", text: include_str!("../../templates/petrol-engine.toml") },
    Template { name: "diesel", text: include_str!("../../templates/diesel.toml") },
    Template { name: "compressor-line", text: include_str!("../../templates/compressor-line.toml") },
    Template { name: "skirt", text: include_str!("../../templates/skirt.toml") },
    Template { name: "pin", text: include_str!("../../templates/pin.toml") },
];

/// A study of a case.
const STUDY: Template = Template { name: "study", text: include_str!("../../templates/study.toml") };

impl Template {
    /// What it is, in one line.
    fn about(&self) -> &'static str {
        self.text.lines().next().unwrap_or_default().trim_start_matches(['#', ' '])
    }
}

pub fn new(a: &NewArgs, ui: &Ui) -> Result<(), Failure> {
    let Some(name) = &a.template else {
        list(a.json, ui);
        return Ok(());
    };
    if name == STUDY.name {
        return study(a, ui);
    }
    let Some(template) = TEMPLATES.iter().find(|t| t.name == name) else {
        let names: Vec<&str> = TEMPLATES.iter().chain([&STUDY]).map(|t| t.name).collect();
        let what = Diagnostic::new(format!("there is no template `{name}`"));
        return Err(what.help(advice(name, &names)).into());
    };
    let own = format!("{name}.toml");
    let file = a.file.as_deref().unwrap_or(Path::new(&own));
    write(file, template.text)?;
    let file = file.display();
    ui.out(&format!(
        "{file}: {}\n\n  edit {file}, then\n    gudgeon check {file}      is everything right with it?\n    gudgeon explain {file}    \
         every value and model that it uses\n    gudgeon run {file}        results and a report",
        template.about(),
    ));
    Ok(())
}

/// Writes a study of a case, `engine.toml` as long as nobody names another.
fn study(a: &NewArgs, ui: &Ui) -> Result<(), Failure> {
    let file = a.file.as_deref().unwrap_or(Path::new("study.toml"));
    write(file, STUDY.text)?;
    let stem = file.file_stem().map_or_else(|| "study".into(), |s| s.to_string_lossy());
    let dir = format!("out/{stem}");
    let file = file.display();
    ui.out(&format!(
        "{file}: {}\n\n  edit {file}, then\n    gudgeon study new {dir} {file}    is everything right with it? makes the folder\n    \
         gudgeon study run {dir}            runs what is missing in it\n    gudgeon study collect {dir} --csv  table.csv, analysis.json and report.html",
        STUDY.about(),
    ));
    Ok(())
}

fn list(as_json: bool, ui: &Ui) {
    if as_json {
        let all: Vec<_> = TEMPLATES
            .iter()
            .map(|t| json!({ "template": t.name, "about": t.about(), "text": t.text }))
            .collect();
        return ui.json(&all.into());
    }
    let rows: Vec<_> = TEMPLATES.iter().map(|t| vec![t.name.to_owned(), t.about().to_owned()]).collect();
    ui.out(&format!(
        "Cases to be filled in, with a comment on every line:\n\n{}\nA study runs a case at many points:\n\n{}\n`gudgeon new TEMPLATE [FILE]` writes one.",
        table(&rows, &[]),
        table(&[vec![STUDY.name.to_owned(), STUDY.about().to_owned()]], &[])
    ));
}

/// Writes a file that does not exist yet.
fn write(file: &Path, text: &str) -> Result<(), Failure> {
    let cannot = |e: std::io::Error| match e.kind() {
        ErrorKind::AlreadyExists => Failure::argument(
            format!("`{}` exists and is not overwritten", file.display()),
            "give another name: `gudgeon new TEMPLATE FILE`",
        ),
        _ => Failure::argument(
            format!("`{}` cannot be written: {e}", file.display()),
            "name a file in a folder that exists and can be written",
        ),
    };
    let mut new = OpenOptions::new().write(true).create_new(true).open(file).map_err(cannot)?;
    new.write_all(text.as_bytes()).map_err(|e| Failure::Run(format!("`{}`: {e}", file.display())))
}
