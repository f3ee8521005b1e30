//! A model in place of another: the keys that it must have and nobody gave come from its example.

use gudgeon_case::catalogue;
use gudgeon_core::Registry;

/// What else must be set for `PATH.model=NAME`: required keys that `present` does not know, with the values of the model's example.
pub fn needed(set: &str, kind: &str, present: impl Fn(&str) -> bool) -> Vec<String> {
    let Some((path, name)) = set.split_once('=') else { return Vec::new() };
    let Some(table) = path.trim().strip_suffix("model") else { return Vec::new() };
    let registry = Registry::collect();
    let Some(model) = registry.model(kind, name.trim().trim_matches('"')) else { return Vec::new() };
    let Ok(example) = model.example.parse::<toml::Table>() else { return Vec::new() };
    let (schema, _) = catalogue::schema(model);
    let required = catalogue::texts(&schema, "required").into_iter();
    let missing = required.filter(|key| *key != "model" && !present(&format!("{table}{key}")));
    missing.filter_map(|key| Some(format!("{table}{key}={}", example.get(key)?))).collect()
}
