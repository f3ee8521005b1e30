//! `gudgeon describe KIND/MODEL`, and of scenes and their tables

use std::fmt::Write as _;

use crate::args::{DescribeArgs, ModelsArgs};
use crate::cmd::keys::keys;
use crate::cmd::{models, scenes};
use crate::failure::Failure;
use crate::ui::{Ui, wrapped};
use gudgeon_case::catalogue::{self, equations, schema};
use gudgeon_core::{ModelInfo, Registry, sets};
use gudgeon_scene::case_schemas;

pub fn describe(a: &DescribeArgs, registry: &Registry, ui: &Ui) -> Result<(), Failure> {
    let what = a.what.trim().trim_start_matches("models.");
    if registry.kind(what).is_some() {
        let a = ModelsArgs { kind: Some(what.to_owned()), sets: false, json: a.json };
        return models::models(&a, registry, ui);
    }
    // What is a kind as well (`rig`) is meant as one.
    let kind = what.split(['.', '/']).next().and_then(|first| registry.kind(first));
    if let Some((scene, table)) = scenes::named(what).filter(|_| kind.is_none()) {
        return scenes::describe(scene, table, a.json, ui);
    }
    let m = catalogue::model(registry, what)?;
    if a.json {
        ui.json(&catalogue::of_model(registry, m, &case_schemas()));
    } else {
        ui.out(&page(registry, m));
    }
    Ok(())
}

fn page(registry: &Registry, m: &ModelInfo) -> String {
    let mut s = String::new();
    // Writing to a String cannot fail.
    let _ = writeln!(s, "{}/{}", m.kind, m.name);
    s.push_str(&wrapped(m.summary, 2));
    if let Some(k) = registry.kind(m.kind) {
        s.push_str(&wrapped(&format!("kind: {}", k.summary), 2));
    }
    let _ = writeln!(s, "\nEquations");
    for e in equations(m) {
        s.push_str(&wrapped(e, 2));
    }
    let _ = writeln!(s, "\nValidity");
    s.push_str(&wrapped(m.validity, 2));
    let (schema, definitions) = schema(m);
    let _ = writeln!(s, "\nParameters");
    let before = s.len();
    keys(&schema, &definitions, 2, 0, &mut s);
    if s.len() == before {
        let _ = writeln!(s, "  none");
    }
    let sets = sets::of(&schema);
    if !sets.is_empty() {
        let _ = writeln!(s, "\nParameter sets");
        s.push_str(&crate::cmd::sets::text(&sets, 2));
    }
    let _ = writeln!(s, "\nExample");
    for line in catalogue::example(registry, m, &case_schemas()).lines() {
        let _ = writeln!(s, "  {line}");
    }
    let _ = writeln!(
        s,
        "\nReferences\n  {}",
        if m.references.is_empty() { "none".into() } else { m.references.join(", ") }
    );
    let _ = writeln!(s, "\nSource\n  {}:{}", m.file, m.line);
    s
}
