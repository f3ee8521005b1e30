//! The keys of a table, as `describe` tells them.

use std::fmt::Write as _;

use gudgeon_case::catalogue::{DEPTH, bound, choice, resolve, texts, words};
use serde_json::{Map, Value};

use crate::ui::wrapped;

/// The keys of a table with their types, defaults and meanings, and those of the tables in it.
pub fn keys(schema: &Value, definitions: &Map<String, Value>, indent: usize, depth: usize, s: &mut String) {
    let Some(properties) = schema.get("properties").and_then(Value::as_object) else { return };
    let required = texts(schema, "required");
    for (key, p) in properties.iter().filter(|(_, p)| p.get("const").is_none()) {
        let (inner, name) = resolve(p, definitions);
        let default = match p.get("default") {
            Some(Value::String(t)) => format!(", default {t}"),
            Some(Value::Object(_)) => ", has defaults".to_owned(),
            Some(Value::Null) => ", optional".to_owned(),
            Some(v) => format!(", default {v}"),
            None if required.contains(&key.as_str()) => ", required".to_owned(),
            None => ", optional".to_owned(),
        };
        let _ = writeln!(s, "{:indent$}{key}: {}{default}", "", type_text(inner, name, definitions));
        let text = p.get("description").or_else(|| inner.get("description")).and_then(Value::as_str);
        if let Some(t) = text {
            s.push_str(&wrapped(&plain(t), indent + 4));
        }
        for (word, what) in words(inner) {
            let meaning = what.map_or_else(String::new, |w| format!(": {}", plain(w)));
            s.push_str(&wrapped(&format!("`{word}`{meaning}"), indent + 6));
        }
        let element = inner.get("items").map_or(inner, |i| resolve(i, definitions).0);
        if depth >= DEPTH {
            continue;
        }
        match choice(element) {
            // A model inside a model has a page of its own.
            Some(("model", _)) => {}
            Some((tag, tables)) => {
                for (word, table) in tables {
                    let what = table.get("description").and_then(Value::as_str).unwrap_or_default();
                    s.push_str(&wrapped(&format!("{tag} = \"{word}\": {}", plain(what)), indent + 6));
                    keys(table, definitions, indent + 10, depth + 1, s);
                }
            }
            None => keys(element, definitions, indent + 4, depth + 1, s),
        }
    }
}

/// Rustdoc's escapes and line breaks are for another reader.
fn plain(t: &str) -> String {
    t.replace("\\[", "[").replace("\\]", "]").split_whitespace().collect::<Vec<_>>().join(" ")
}

fn type_text(schema: &Value, name: Option<&str>, definitions: &Map<String, Value>) -> String {
    if let Some(dimension) = schema.get("x-dimension").and_then(Value::as_str) {
        let units = texts(schema, "x-units");
        let units = if units.is_empty() { String::new() } else { format!(" [{}]", units.join(", ")) };
        return format!("{dimension}{units}{}", bound(schema));
    }
    if !words(schema).is_empty() {
        return "one word of".into();
    }
    if schema.get("oneOf").is_some() {
        return match choice(schema) {
            Some((tag, _)) if tag != "model" => format!("a table with the key `{tag}`, one of"),
            _ => format!("a {} model, a table with the key `model`", name.unwrap_or("sub-")),
        };
    }
    if let Some(items) = schema.get("items") {
        let (inner, name) = resolve(items, definitions);
        return match type_text(inner, name, definitions).as_str() {
            "table" => "array of tables".into(),
            one => format!("array, each {one}"),
        };
    }
    match schema.get("type") {
        Some(Value::Array(a)) => a
            .iter()
            .filter_map(Value::as_str)
            .filter(|t| *t != "null")
            .map(|t| basic(t, schema))
            .collect::<Vec<_>>()
            .join(" or "),
        Some(Value::String(t)) => basic(t, schema),
        _ => "any value".into(),
    }
}

fn basic(t: &str, schema: &Value) -> String {
    let minimum = schema.get("minimum").and_then(Value::as_f64);
    let suffix = minimum.map_or(String::new(), |m| format!(", at least {m}"));
    match t {
        "string" => "text".into(),
        "number" => format!("number{suffix}"),
        "integer" => format!("whole number{suffix}"),
        "boolean" => "true or false".into(),
        "object" => "table".into(),
        other => other.into(),
    }
}
