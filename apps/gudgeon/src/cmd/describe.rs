//! `gudgeon describe KIND/MODEL`, and of scenes and their tables

use std::fmt::Write as _;

use crate::args::{DescribeArgs, ModelsArgs};
use crate::cmd::keys::keys;
use crate::cmd::{models, scenes};
use crate::failure::Failure;
use crate::ui::{Ui, wrapped};
use gudgeon_case::catalogue::{self, equations, schema};
use gudgeon_core::schemars::SchemaGenerator;
use gudgeon_core::{ModelInfo, Registry, sets};
use gudgeon_scene::case_schemas;
use gudgeon_study::study::StudyFile;
use serde_json::json;

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
    if what == STUDY {
        return study(a.json, ui);
    }
    let m = catalogue::model(registry, what)?;
    if a.json {
        ui.json(&catalogue::of_model(registry, m, &case_schemas()));
    } else {
        ui.out(&page(registry, m));
    }
    Ok(())
}

/// What a study file is called here.
const STUDY: &str = "study";

/// What a study file may say.
fn study(as_json: bool, ui: &Ui) -> Result<(), Failure> {
    let mut generator = SchemaGenerator::default();
    let root = generator.subschema_for::<StudyFile>().to_value();
    let definitions = generator.take_definitions(true);
    let file = catalogue::resolve(&root, &definitions).0;
    if as_json {
        ui.json(&json!({ "study": file, "definitions": definitions }));
        return Ok(());
    }
    let mut s = format!(
        "study\n{}\nKeys\n",
        wrapped(
            "A study file: one or more cases at many points. `gudgeon new study` writes one with comments; `gudgeon study new DIR FILE` makes its folder, \
             `study run DIR` fills it, `study collect DIR --csv` writes its table and its page.",
            2
        )
    );
    keys(file, &definitions, 2, 0, &mut s);
    ui.out(&s);
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
