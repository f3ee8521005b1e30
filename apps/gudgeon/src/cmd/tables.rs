//! Schemas of models: references followed, tables that a word tells apart.

use gudgeon_core::ModelInfo;
use gudgeon_core::schemars::SchemaGenerator;
use serde_json::{Map, Value};

/// The schema of a model and what it refers to.
pub fn schema(m: &ModelInfo) -> (Value, Map<String, Value>) {
    let mut g = SchemaGenerator::default();
    let schema = (m.schema)(&mut g).to_value();
    (schema, g.take_definitions(true))
}

/// Tables inside tables that are shown; a model inside a model names its kind instead.
pub const DEPTH: usize = 4;

/// Follows references and the non-null alternative of an optional value; with the name of the last reference.
pub fn resolve<'a>(
    mut schema: &'a Value,
    definitions: &'a Map<String, Value>,
) -> (&'a Value, Option<&'a str>) {
    let mut name = None;
    for _ in 0..DEPTH {
        if let Some(r) = schema.get("$ref").and_then(Value::as_str) {
            name = r.rsplit('/').next();
            match name.and_then(|n| definitions.get(n)) {
                Some(s) => schema = s,
                None => break,
            }
        } else if let Some(any) = schema.get("anyOf").and_then(Value::as_array) {
            let is_null = |s: &&Value| s.get("type").and_then(Value::as_str) == Some("null");
            match any.iter().find(|s| !is_null(s)) {
                Some(s) if any.len() == 2 => schema = s,
                _ => break,
            }
        } else {
            break;
        }
    }
    (schema, name)
}

/// The only word that a key of a table may have.
fn constant<'a>(table: &'a Value, key: &str) -> Option<&'a str> {
    table.get("properties")?.get(key)?.get("const")?.as_str()
}

/// The key whose word tells tables apart, with the words and their tables.
pub fn choice(schema: &Value) -> Option<(&str, Vec<(&str, &Value)>)> {
    let all = schema.get("oneOf").and_then(Value::as_array)?;
    let first = all.first()?.get("properties")?.as_object()?;
    let tag = first.keys().find(|k| all.iter().all(|s| constant(s, k).is_some()))?;
    Some((tag, all.iter().filter_map(|s| Some((constant(s, tag)?, s))).collect()))
}

/// Tables of a model that a word other than `model` tells apart: path, key, words.
pub fn choices(m: &ModelInfo) -> Vec<(String, String, Vec<String>)> {
    fn look(
        schema: &Value,
        definitions: &Map<String, Value>,
        path: &str,
        depth: usize,
        out: &mut Vec<(String, String, Vec<String>)>,
    ) {
        for (key, p) in schema.get("properties").and_then(Value::as_object).into_iter().flatten() {
            let inner = resolve(p, definitions).0;
            let element = inner.get("items").map_or(inner, |i| resolve(i, definitions).0);
            let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
            match choice(element) {
                Some((tag, tables)) if tag != "model" => {
                    out.push((path, tag.to_owned(), tables.iter().map(|(w, _)| (*w).to_owned()).collect()));
                }
                None if depth < DEPTH => look(element, definitions, &path, depth + 1, out),
                _ => {}
            }
        }
    }
    let (schema, definitions) = schema(m);
    let mut out = Vec::new();
    look(&schema, &definitions, "", 0, &mut out);
    out
}
