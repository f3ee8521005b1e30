//! What a run was made of, and a case from what an earlier run recorded.

use std::fmt::Write as _;

use gudgeon_core::file::Files;
use gudgeon_core::result::{InputUse, KeptFile, Provenance, SetUse, SetValueUse};
use indexmap::IndexMap;
use sha2::{Digest, Sha256};

use crate::scene::Scene;
use gudgeon_case::{Diagnostic, Input, InputValue, Report, Source, UsedSet};
use gudgeon_core::sets::SetValue;

/// SHA-256 of some bytes in hexadecimal digits.
#[must_use]
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().fold(String::new(), |mut s, b| {
        // Writing to a String cannot fail.
        let _ = write!(s, "{b:02x}");
        s
    })
}

/// What a run of this case is made of.
pub fn provenance(file: &str, case: &dyn Scene) -> Provenance {
    let source = case.source();
    let resolved = case.resolved();
    Provenance {
        file: file.to_owned(),
        overrides: case.overrides().to_vec(),
        resolved_sha256: sha256(resolved.to_string().as_bytes()),
        sha256: sha256(source.text.as_bytes()),
        revision: String::new(),
        text: source.text.clone(),
        files: files(source),
        sets: case.sets().iter().map(set_use).collect(),
        inputs: inputs(case, &resolved),
        resolved,
    }
}

/// The inputs as a page shows them. A change with `--set` has no line in the file, and neither have values of a parameter set: their paths say that they are given.
fn inputs(case: &dyn Scene, resolved: &serde_json::Value) -> Vec<InputUse> {
    let changed: Vec<&str> =
        case.overrides().iter().filter_map(|o| o.split('=').next()).map(|c| short(c.trim())).collect();
    let sets: Vec<String> = case
        .sets()
        .iter()
        .flat_map(|s| s.taken.iter().map(move |(key, _)| format!("{}.{key}", s.path)))
        .collect();
    // A change may give a whole table.
    let is_within = |path: &str, table: &str| {
        path.strip_prefix(table).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    };
    let given = |i: &Input| {
        i.line.is_some() || sets.contains(&i.path) || changed.iter().any(|c| is_within(short(&i.path), c))
    };
    let shown =
        |i: Input| InputUse { given: given(&i), value: text(&i.value), about: i.about.brief(), path: i.path };
    case.inputs_of(resolved).into_iter().map(shown).collect()
}

/// A path without the table of models before it.
fn short(path: &str) -> &str {
    path.strip_prefix("models.").map_or(path, short)
}

fn text(value: &InputValue) -> String {
    match value {
        InputValue::Number(n) if n.unit.is_empty() => n.value.to_string(),
        InputValue::Number(n) => format!("{} {}", n.value, n.unit),
        InputValue::Choice(c) => c.value.clone(),
        _ => String::new(),
    }
}

fn set_use(set: &UsedSet) -> SetUse {
    let value = |v: &SetValue| SetValueUse { value: v.text(), origin: v.origin() };
    SetUse {
        path: set.path.clone(),
        name: set.name.clone(),
        values: set.taken.iter().map(|(key, v)| (key.clone(), value(v))).collect(),
    }
}

/// The files that the case named, as they were read.
fn files(source: &Source) -> IndexMap<String, KeptFile> {
    let read = source.files.read_so_far();
    read.into_iter()
        .map(|(name, text)| (name, KeptFile { sha256: sha256(text.as_bytes()), text: text.to_string() }))
        .collect()
}

/// The case file that a `summary.json` recorded, its text and its overrides.
///
/// # Errors
/// A file that is no summary, or one whose record is not what its hash says.
pub fn recorded(summary: &Source) -> Result<(String, Source, Vec<String>), Report> {
    #[derive(serde::Deserialize)]
    struct Summary {
        provenance: Provenance,
    }
    let refuse = |what: String| {
        let help = "name a case, or the summary.json of a run that this version or a later one wrote";
        Report::unreadable(&summary.name, Diagnostic::new(what).help(help))
    };
    let Summary { provenance: p } = serde_json::from_str(&summary.text)
        .map_err(|_| refuse(format!("`{}` does not record what a run was made of", summary.name)))?;
    let changed = p.files.values().any(|f| sha256(f.text.as_bytes()) != f.sha256);
    if changed || sha256(p.text.as_bytes()) != p.sha256 {
        return Err(refuse(format!(
            "the case that `{}` records was changed: its hash is another",
            summary.name
        )));
    }
    let kept = p.files.into_iter().map(|(name, f)| (name, f.text));
    let source = Source {
        name: format!("{} in {}", p.file, summary.name),
        text: p.text,
        files: Files::recorded(kept),
    };
    Ok((p.file, source, p.overrides))
}
