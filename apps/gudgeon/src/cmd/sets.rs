//! `gudgeon models [KIND] --sets`

use std::fmt::Write as _;

use gudgeon_case::Diagnostic;
use gudgeon_case::advice;
use gudgeon_case::catalogue::{SetTable, set_tables};
use gudgeon_core::Registry;
use gudgeon_core::sets::ParameterSets;
use gudgeon_scene::case_schemas;
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::ui::{Ui, wrapped};

/// Lists the parameter sets of everything, or of a kind, a model or a table of a case.
pub fn list(only: Option<&str>, as_json: bool, registry: &Registry, ui: &Ui) -> Result<(), Failure> {
    let all = set_tables(registry, &case_schemas());
    let shown: Vec<&SetTable> = all.iter().filter(|t| only.is_none_or(|o| is_of(t, o))).collect();
    if shown.is_empty() {
        return Err(none(only.unwrap_or_default(), &all, registry).into());
    }
    if as_json {
        let list: Vec<Value> = shown.iter().map(|t| json!({ "of": t.of, "sets": t.sets })).collect();
        ui.json(&list.into());
        return Ok(());
    }
    let one = |t: &&SetTable| format!("{}\n{}", t.of, text(&t.sets, 2));
    ui.out(&shown.iter().map(one).collect::<Vec<_>>().join("\n"));
    Ok(())
}

/// The sets with every value and where it comes from.
pub fn text(sets: &ParameterSets, indent: usize) -> String {
    let mut s = String::new();
    for (name, set) in sets {
        s.push_str(&wrapped(&format!("set = \"{name}\": {}", set.about), indent));
        for (key, v) in &set.values {
            // Writing to a String cannot fail.
            let _ = writeln!(s, "{:w$}{key} = {}", "", v.text(), w = indent + 4);
            s.push_str(&wrapped(&v.origin(), indent + 8));
        }
    }
    s
}

/// Whether a table is meant by the name of a kind, of a model, of both or of the table.
fn is_of(t: &SetTable, name: &str) -> bool {
    t.of == name || t.of.split('/').any(|part| part == name)
}

fn none(name: &str, all: &[SetTable], registry: &Registry) -> Diagnostic {
    let names: Vec<&str> = all.iter().map(|t| t.of.as_str()).collect();
    let known = registry.kind(name).is_some()
        || name.split_once('/').is_some_and(|(k, m)| registry.model(k, m).is_some());
    let what = if known { "has no parameter sets" } else { "is no kind, model or table with parameter sets" };
    Diagnostic::new(format!("`{name}` {what}")).help(advice(name, &names))
}
