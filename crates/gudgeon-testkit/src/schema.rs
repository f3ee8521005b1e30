//! Schemas: the keys of a model, and whether each is described.

use std::collections::BTreeSet;

use gudgeon_core::ModelInfo;
use serde_json::{Map, Value};

/// The schema of a model and what it refers to.
pub(crate) fn schema(m: &ModelInfo) -> (Value, Map<String, Value>) {
    let mut g = schemars::SchemaGenerator::default();
    let s = (m.schema)(&mut g).to_value();
    (s, g.take_definitions(true))
}

pub(crate) fn properties(schema: &Value) -> Map<String, Value> {
    schema.get("properties").and_then(Value::as_object).cloned().unwrap_or_default()
}

pub(crate) fn required(schema: &Value) -> BTreeSet<String> {
    let names = schema.get("required").and_then(Value::as_array).into_iter().flatten();
    names.filter_map(Value::as_str).map(str::to_owned).collect()
}

/// Complaints about every key of a schema that has no description, in the schema itself and in the `definitions` it refers to, and about every
/// word of a choice.
#[must_use]
pub fn undescribed(schema: &Value, definitions: &Map<String, Value>) -> Vec<String> {
    let mut wrong = Vec::new();
    keys(schema, "", &mut wrong);
    // What is referred to is described once, under its own name. Kinds are checked model by model.
    for (name, s) in definitions {
        if s.get("oneOf").is_none() {
            keys(s, &format!("{name}."), &mut wrong);
        }
        for choice in s.get("oneOf").and_then(Value::as_array).into_iter().flatten() {
            if let Some(word) = choice.get("const").filter(|_| !is_described(choice)) {
                wrong.push(format!("the word {word} of `{name}` has no description"));
            }
        }
        for word in s.get("enum").and_then(Value::as_array).into_iter().flatten() {
            wrong.push(format!("the word {word} of `{name}` has no description"));
        }
    }
    wrong
}

fn keys(schema: &Value, place: &str, wrong: &mut Vec<String>) {
    for (key, p) in properties(schema) {
        let own = format!("{place}{key}");
        if !is_described(&p) {
            wrong.push(format!("`{own}` has no description in the schema; write a doc comment"));
        }
        keys(&p, &format!("{own}."), wrong);
    }
}

fn is_described(s: &Value) -> bool {
    let of = |key: &str| s.get(key).and_then(Value::as_str).unwrap_or_default().trim().to_owned();
    // A quantity without a doc comment still says of itself "a length, greater than zero".
    let own = format!("{}, {}", of("x-dimension"), of("x-bound"));
    !of("description").is_empty() && of("description") != own
}
