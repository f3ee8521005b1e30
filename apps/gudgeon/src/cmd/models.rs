//! `gudgeon models [KIND]`

use std::fmt::Write as _;

use gudgeon_case::catalogue;
use gudgeon_core::Registry;

use crate::args::ModelsArgs;
use crate::cmd::sets;
use crate::failure::Failure;
use crate::ui::{Ui, table, wrapped};

pub fn models(a: &ModelsArgs, registry: &Registry, ui: &Ui) -> Result<(), Failure> {
    if a.sets {
        return sets::list(a.kind.as_deref(), a.json, registry, ui);
    }
    let kinds = match &a.kind {
        Some(k) => vec![catalogue::kind(registry, k)?],
        None => registry.kinds().collect(),
    };
    if a.json {
        let list: Vec<_> = kinds.iter().map(|k| catalogue::of_kind(registry, k)).collect();
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
            for (path, key, words) in catalogue::choices(m) {
                text.push_str(&wrapped(&format!("{}: {path}.{key} is {}", m.name, words.join(", ")), 4));
            }
        }
    }
    ui.out(&text);
    Ok(())
}
