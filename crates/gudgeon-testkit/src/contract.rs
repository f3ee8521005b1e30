//! What every registered model keeps: `models`, `describe`, `schema`, case files and reports rely on nothing else.

use std::ffi::OsStr;
use std::path::Path;

use gudgeon_core::registry::Kind;
use gudgeon_core::{ModelInfo, Registry};
use serde_json::{Map, Value};

use crate::schema::{properties, required, schema, undescribed};

/// Everything below for all models that the crate `name` (as in paths: `custom_model`) registers; their number.
///
/// # Panics
/// With all complaints together, or when the crate registers no model.
#[track_caller]
pub fn check_crate(name: &str) -> usize {
    for_every_model(|registry, m| if m.crate_name() == name { contract(registry, m) } else { Vec::new() });
    let registry = Registry::collect();
    let models = registry.kinds().flat_map(|k| registry.models(k.kind));
    let own = models.filter(|m| m.crate_name() == name).count();
    assert!(
        own > 0,
        "no model of the crate `{name}` is linked: call its `link()`, or name it by `use {name} as _;`"
    );
    own
}

/// [`contract`] for every model that is linked; their number.
///
/// # Panics
/// With all complaints together, when no model is linked, or when the registry contradicts itself.
#[track_caller]
pub fn check_all() -> usize {
    if let Err(errors) = Registry::collect().verify() {
        crate::assert_none(errors.iter().map(ToString::to_string).collect());
    }
    for_every_model(contract)
}

/// Calls `check` for every model that is linked, and gives their number.
///
/// # Panics
/// With the complaints about all models together, or when no model is linked.
#[track_caller]
pub fn for_every_model(check: impl Fn(&Registry, &ModelInfo) -> Vec<String>) -> usize {
    let registry = Registry::collect();
    let all: Vec<&ModelInfo> = registry.kinds().flat_map(|k| registry.models(k.kind)).copied().collect();
    assert!(!all.is_empty(), "no model is linked");
    let mut complaints = Vec::new();
    for m in &all {
        complaints.extend(check(&registry, m).into_iter().map(|c| format!("{}/{}: {c}", m.kind, m.name)));
    }
    crate::assert_none(complaints);
    all.len()
}

/// The complaints about one model:
///
/// - its name is not in snake case, or not that of its source file;
/// - a text is missing, or the summary is longer than a line of 120 characters;
/// - its example cannot be read, or reads back as something else when it is written with all defaults;
/// - an unknown key is accepted, or refused without being named;
/// - schema and reader disagree about keys and defaults;
/// - a key has no description.
#[must_use]
pub fn contract(registry: &Registry, m: &ModelInfo) -> Vec<String> {
    let mut all = names(m);
    all.extend(texts(registry, m));
    all.extend(round_trip(registry, m).err());
    all.extend(unknown_key(registry, m).err());
    all.extend(keys(registry, m));
    let (schema, definitions) = schema(m);
    all.extend(undescribed(&schema, &definitions));
    all
}

fn names(m: &ModelInfo) -> Vec<String> {
    let mut wrong = Vec::new();
    if !m.name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_') {
        wrong.push("the name is not snake_case".into());
    }
    let file = Path::new(m.file);
    let text = |s: Option<&OsStr>| s.and_then(OsStr::to_str).unwrap_or_default().to_owned();
    // A large model has a folder of its name.
    let (stem, folder) = (text(file.file_stem()), text(file.parent().and_then(Path::file_name)));
    // `off` and `constant` exist in several kinds; a crate with more than one puts them into a folder or module.
    if stem != m.name && folder != m.name {
        wrong.push(format!("stands in {}, the file should be {}.rs, or a folder {}", m.file, m.name, m.name));
    }
    wrong
}

fn texts(registry: &Registry, m: &ModelInfo) -> Vec<String> {
    let mut wrong = Vec::new();
    for (what, text) in [("summary", m.summary), ("equations", m.equations), ("validity", m.validity)] {
        if text.trim().is_empty() {
            wrong.push(format!("has no {what}"));
        }
    }
    if m.summary.contains('\n') || m.summary.len() > 120 {
        wrong.push("the summary is not one line".into());
    }
    if registry.kind(m.kind).is_none_or(|k| k.summary.trim().is_empty()) {
        wrong.push("its kind has no summary".into());
    }
    wrong
}

/// The example as a specification: its TOML with the key that selects the model.
fn example(m: &ModelInfo) -> Result<Map<String, Value>, String> {
    let mut table: Map<String, Value> =
        toml::from_str(m.example).map_err(|e| format!("the example is not TOML: {e}"))?;
    if table.insert("model".into(), m.name.into()).is_some() {
        return Err("the example must not contain the key `model`".into());
    }
    Ok(table)
}

/// The specification that the example of a model gives.
///
/// # Errors
/// An example that cannot be read, a model of another kind.
pub fn example_of<S: ?Sized + Kind + 'static>(m: &ModelInfo) -> Result<Box<S>, String> {
    let spec = Value::Object(example(m)?);
    gudgeon_core::spec::model((&spec).into()).map_err(|e| e.to_string())
}

fn resolve(
    registry: &Registry,
    m: &ModelInfo,
    spec: Map<String, Value>,
) -> Result<Map<String, Value>, String> {
    let kind = registry.kind(m.kind).ok_or("its kind does not exist")?;
    match (kind.resolve)(Value::Object(spec)) {
        Ok(Value::Object(o)) => Ok(o),
        Ok(other) => Err(format!("resolves to {other}, which is no table")),
        Err(e) => Err(e.to_string()),
    }
}

fn round_trip(registry: &Registry, m: &ModelInfo) -> Result<(), String> {
    let full = resolve(registry, m, example(m)?)?;
    let again = resolve(registry, m, full.clone())?;
    // The resolved form holds every value in SI with all its digits, so nothing may change a second time.
    if again != full { Err(format!("{full:?} reads back as {again:?}")) } else { Ok(()) }
}

fn unknown_key(registry: &Registry, m: &ModelInfo) -> Result<(), String> {
    let mut spec = example(m)?;
    spec.insert("no_such_key".into(), 1.into());
    match resolve(registry, m, spec) {
        Ok(_) => Err("accepts the key `no_such_key`; is `deny_unknown_fields` missing?".to_owned()),
        Err(e) if !e.contains("no_such_key") => Err(format!("does not name the unknown key: {e}")),
        Err(_) => Ok(()),
    }
}

/// Whether schema and reader agree about keys.
fn keys(registry: &Registry, m: &ModelInfo) -> Vec<String> {
    let mut wrong = Vec::new();
    let (schema, _) = schema(m);
    let (properties, required) = (properties(&schema), required(&schema));
    // That the example cannot be read is a complaint of its own.
    let Ok(full) = example(m).and_then(|e| resolve(registry, m, e)) else { return wrong };
    for key in full.keys().filter(|k| *k != "model" && !properties.contains_key(*k)) {
        wrong.push(format!("`{key}` is written but the schema does not know it"));
    }
    if schema.get("additionalProperties") != Some(&Value::Bool(false)) {
        wrong.push("the schema allows unknown keys".into());
    }
    for key in properties.keys().filter(|k| full.contains_key(*k)) {
        let mut less = full.clone();
        less.remove(key);
        match (resolve(registry, m, less), required.contains(key)) {
            (Ok(_), true) => wrong.push(format!("the schema requires `{key}`, the reader does not")),
            (Err(e), false) => wrong.push(format!("`{key}` has no default although the schema says so: {e}")),
            (Err(e), true) if !e.contains(key.as_str()) => {
                wrong.push(format!("the missing key `{key}` is not named: {e}"));
            }
            _ => {}
        }
    }
    for key in required.iter().filter(|k| !full.contains_key(*k)) {
        wrong.push(format!("the schema requires `{key}`, the example lacks it"));
    }
    wrong
}
