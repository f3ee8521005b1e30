//! `gudgeon describe SCENE` and `SCENE.TABLE`: what a case may say.

use std::fmt::Write as _;

use gudgeon_case::catalogue::resolve;
use gudgeon_case::{Diagnostic, advice};
use gudgeon_scene::SceneInfo;
use serde_json::{Map, Value, json};

use crate::cmd::keys::keys;
use crate::failure::Failure;
use crate::ui::{Ui, wrapped};

/// The scene that a name begins with, and what of its case is meant: `ring_pack`, `ring_pack.rings.face`.
pub fn named(what: &str) -> Option<(&'static SceneInfo, &str)> {
    let (name, table) = what.split_once(['.', '/']).unwrap_or((what, ""));
    gudgeon_scene::scenes().iter().find(|s| s.name == name).map(|s| (*s, table))
}

pub fn describe(scene: &SceneInfo, path: &str, as_json: bool, ui: &Ui) -> Result<(), Failure> {
    let (case, definitions) = scene.case_schema();
    let table = at(&case, &definitions, path, scene)?;
    if as_json {
        ui.json(&json!({ "scene": scene.name, "path": path, "summary": scene.summary, "equations": scene.equations,
            "validity": scene.validity, "references": scene.references, "schema": table, "definitions": definitions }));
        return Ok(());
    }
    let mut s = String::new();
    // Writing to a String cannot fail.
    if path.is_empty() {
        let _ = writeln!(s, "{}", scene.name);
        s.push_str(&wrapped(scene.summary, 2));
        let _ = writeln!(s, "\nEquations");
        scene.equations.split(";  ").for_each(|e| s.push_str(&wrapped(e, 2)));
        let _ = writeln!(s, "\nValidity\n{}\nKeys", wrapped(scene.validity, 2).trim_end());
    } else {
        let _ = writeln!(s, "{}.{path}", scene.name);
        let about = table.get("description").and_then(Value::as_str).unwrap_or_default();
        s.push_str(&wrapped(about, 2));
        let _ = writeln!(s, "\nKeys");
    }
    keys(table, &definitions, 2, 0, &mut s);
    ui.out(&s);
    Ok(())
}

/// The table at a path of a case; indices of arrays may be left out.
fn at<'a>(
    case: &'a Value,
    definitions: &'a Map<String, Value>,
    path: &str,
    scene: &SceneInfo,
) -> Result<&'a Value, Diagnostic> {
    let mut table = case;
    for step in path.split(['.', '/']).filter(|s| !s.is_empty() && s.parse::<usize>().is_err()) {
        let own = table.get("properties").and_then(Value::as_object);
        let is_table = |p: &Value| inner(p, definitions).get("properties").is_some();
        let found = own.and_then(|o| o.get(step)).filter(|p| is_table(p));
        let Some(found) = found else {
            let names: Vec<&str> = own
                .into_iter()
                .flatten()
                .filter(|(_, p)| is_table(p))
                .map(|(name, _)| name.as_str())
                .collect();
            let what = format!("a case of the scene `{}` has no table `{step}` there", scene.name);
            return Err(Diagnostic::new(what).help(advice(step, &names)));
        };
        table = inner(found, definitions);
    }
    Ok(table)
}

/// What a value is, or each element of an array.
fn inner<'a>(p: &'a Value, definitions: &'a Map<String, Value>) -> &'a Value {
    let value = resolve(p, definitions).0;
    value.get("items").map_or(value, |i| resolve(i, definitions).0)
}
