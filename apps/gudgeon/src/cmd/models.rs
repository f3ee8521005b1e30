//! `gudgeon models [KIND]`

use std::fmt::Write as _;

use gudgeon_case::advice;
use gudgeon_core::{KindInfo, Registry};
use serde_json::json;

use crate::args::ModelsArgs;
use crate::cmd::tables::choices;
use crate::failure::Failure;
use crate::ui::{Ui, table, wrapped};

pub fn models(a: &ModelsArgs, registry: &Registry, ui: &Ui) -> Result<(), Failure> {
    let kinds = match &a.kind {
        Some(k) => vec![kind(registry, k)?],
        None => registry.kinds().collect(),
    };
    if a.json {
        let list: Vec<_> = kinds
            .iter()
            .map(|k| {
                let models: Vec<_> = registry
                    .models(k.kind)
                    .iter()
                    .map(|m| {
                        let tables: Vec<_> = choices(m)
                            .into_iter()
                            .map(|(path, key, words)| json!({ "path": path, "key": key, "words": words }))
                            .collect();
                        json!({ "model": m.name, "summary": m.summary, "references": m.references, "tables": tables })
                    })
                    .collect();
                json!({ "kind": k.kind, "summary": k.summary, "models": models })
            })
            .collect();
        ui.json(&list.into());
        return Ok(());
    }
    let mut text = String::new();
    for k in kinds {
        if !text.is_empty() {
            text.push('\n');
        }
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{}: {}", k.kind, k.summary);
        let rows: Vec<_> =
            registry.models(k.kind).iter().map(|m| vec![m.name.to_owned(), m.summary.to_owned()]).collect();
        text.push_str(&table(&rows, &[]));
        for m in registry.models(k.kind) {
            for (path, key, words) in choices(m) {
                text.push_str(&wrapped(&format!("{}: {path}.{key} is {}", m.name, words.join(", ")), 4));
            }
        }
    }
    ui.out(&text);
    Ok(())
}

/// The kind of that name; otherwise the names that would do.
pub fn kind(registry: &Registry, name: &str) -> Result<&'static KindInfo, Failure> {
    registry.kind(name).ok_or_else(|| {
        let names: Vec<&str> = registry.kinds().map(|k| k.kind).collect();
        Failure::argument(format!("there is no kind `{name}`"), advice(name, &names))
    })
}
