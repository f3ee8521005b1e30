//! What a run was made of, and a case from what an earlier run recorded.

use std::fmt::Write as _;

use gudgeon_core::file::Files;
use gudgeon_core::result::{KeptFile, Provenance, SetUse, SetValueUse};
use indexmap::IndexMap;
use sha2::{Digest, Sha256};

use crate::scene::Scene;
use gudgeon_case::{Diagnostic, Report, Source, UsedSet};
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
        resolved,
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
