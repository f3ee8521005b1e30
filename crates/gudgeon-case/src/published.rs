//! The JSON schema as an editor needs it: one mistake, one message.
//!
//! A validator that meets `oneOf` tries every alternative and tells what is wrong with each. Here every choice of tables is written as
//! the words of its tag (`enum`) and one `if`/`then` for each word, so that only the table that is meant is ever looked at; a choice of
//! words is one `enum`; a word that is short for a table is told from it by the type of the value; and what may be absent is not a choice at all, because TOML has no null.

use gudgeon_core::sets::{SET, X_SETS};
use serde_json::{Map, Value, json};

use super::schema::MAX_ITEMS;

/// Rewrites a schema, definitions included, for validators.
#[must_use]
pub fn published(schema: &Value) -> Value {
    match schema {
        Value::Object(o) => table(o),
        Value::Array(a) => a.iter().map(published).collect(),
        other => other.clone(),
    }
}

fn table(o: &Map<String, Value>) -> Value {
    for key in ["oneOf", "anyOf"] {
        let Some(Value::Array(all)) = o.get(key) else { continue };
        let rest = || o.iter().filter(|(k, _)| *k != key).map(|(k, v)| (k.clone(), inside(k, v))).collect();
        let some: Vec<&Value> = all.iter().filter(|s| !is_null(s)).collect();
        if let [only] = some[..] {
            let mut out: Map<String, Value> = rest();
            if key == "oneOf" && tag_of(&some).is_some() {
                return choice(out, &some);
            }
            for (k, v) in published(only).as_object().into_iter().flatten() {
                out.entry(k.clone()).or_insert_with(|| v.clone());
            }
            return Value::Object(out);
        }
        if let Some(words) = words(&some) {
            return one_word(rest(), &words);
        }
        if tag_of(&some).is_some() {
            return choice(rest(), &some);
        }
        if let [word, table] = some[..]
            && let Some(words) = words(&[word])
        {
            return word_or_table(rest(), &words, table);
        }
    }
    let mut out: Map<String, Value> = o.iter().map(|(k, v)| (k.clone(), inside(k, v))).collect();
    drop_null(&mut out);
    out.remove("x-renamed");
    out.remove("x-used");
    // Beside a reference it is the table there that may have sets.
    if out.remove(X_SETS).is_some() || out.contains_key("$ref") {
        demand_without_set(&mut out);
    }
    if out.get("type").and_then(Value::as_str) == Some("array") {
        out.entry("maxItems").or_insert_with(|| MAX_ITEMS.into());
    }
    Value::Object(out)
}

/// What a table must have it may have from a set, all but the key that says which table it is.
fn demand_without_set(out: &mut Map<String, Value>) {
    let Some(Value::Array(required)) = out.remove("required") else { return };
    let is_tag = |key: &Value| {
        let property = out.get("properties").zip(key.as_str()).and_then(|(p, key)| p.get(key));
        property.is_some_and(|p| p.get("const").is_some())
    };
    let (tags, others): (Vec<Value>, Vec<Value>) = required.into_iter().partition(is_tag);
    if !tags.is_empty() {
        out.insert("required".into(), tags.into());
    }
    if !others.is_empty() {
        out.insert("if".into(), json!({ "required": [SET] }));
        out.insert("else".into(), json!({ "required": others }));
    }
}

/// Values of a case are no schemas, whatever their keys are called; neither are the names of properties.
fn inside(key: &str, v: &Value) -> Value {
    match (key, v) {
        ("default" | "const" | "enum" | "examples", v) => v.clone(),
        ("properties" | "$defs", Value::Object(o)) => {
            o.iter().map(|(k, v)| (k.clone(), published(v))).collect::<Map<_, _>>().into()
        }
        (_, v) => published(v),
    }
}

/// `["string", "null"]` as `"string"`; the default of what may be absent is no value.
fn drop_null(o: &mut Map<String, Value>) {
    if let Some(Value::Array(types)) = o.get_mut("type") {
        types.retain(|t| t != "null");
        if let [only] = &types[..] {
            let only = only.clone();
            o.insert("type".into(), only);
        }
    }
    if o.get("default") == Some(&Value::Null) {
        o.remove("default");
    }
}

fn is_null(schema: &Value) -> bool {
    schema.get("type").and_then(Value::as_str) == Some("null")
}

/// The words of a choice that has nothing else, each with what it means.
fn words<'a>(all: &[&'a Value]) -> Option<Vec<(&'a Value, Option<&'a str>)>> {
    let mut out = Vec::new();
    for s in all {
        let about = s.get("description").and_then(Value::as_str);
        match (
            s.get("const"),
            s.get("enum").and_then(Value::as_array),
            s.get("oneOf").and_then(Value::as_array),
        ) {
            (Some(word), ..) => out.push((word, about)),
            (_, Some(some), _) => out.extend(some.iter().map(|w| (w, None))),
            (_, _, Some(some)) => out.extend(words(&some.iter().collect::<Vec<_>>())?),
            _ => return None,
        }
    }
    Some(out)
}

fn one_word(mut out: Map<String, Value>, words: &[(&Value, Option<&str>)]) -> Value {
    drop_null(&mut out);
    let about: Vec<&str> = words.iter().map(|(_, d)| d.unwrap_or_default()).collect();
    out.insert("enum".into(), words.iter().map(|(w, _)| (*w).clone()).collect());
    if about.iter().any(|d| !d.is_empty()) {
        // Where editors look for them: Visual Studio Code, taplo.
        out.insert("markdownEnumDescriptions".into(), json!(about));
        out.insert("x-taplo".into(), json!({ "docs": { "enumValues": about } }));
    }
    Value::Object(out)
}

/// A word, or the table that a word is short for: the type of the value decides which of the two is looked at.
fn word_or_table(mut out: Map<String, Value>, words: &[(&Value, Option<&str>)], table: &Value) -> Value {
    drop_null(&mut out);
    out.insert("type".into(), json!(["string", "object"]));
    out.insert("if".into(), json!({ "type": "string" }));
    out.insert("then".into(), one_word(Map::new(), words));
    out.insert("else".into(), published(table));
    Value::Object(out)
}

/// The key whose constant tells tables apart.
fn tag_of(all: &[&Value]) -> Option<String> {
    let constants = |s: &Value| -> Vec<String> {
        let properties = s.get("properties").and_then(Value::as_object);
        let is_word = |(_, v): &(&String, &Value)| v.get("const").is_some_and(Value::is_string);
        properties.into_iter().flatten().filter(is_word).map(|(k, _)| k.clone()).collect()
    };
    let first = constants(all.first()?);
    first.into_iter().find(|k| all.iter().all(|s| constants(s).contains(k)))
}

/// One of several tables: the words of the tag, and what each asks for.
fn choice(mut out: Map<String, Value>, all: &[&Value]) -> Value {
    drop_null(&mut out);
    let Some(tag) = tag_of(all) else { return Value::Object(out) };
    let default = out.remove("x-default");
    out.remove("x-renamed");
    let mut names = Vec::new();
    let mut about = Vec::new();
    let mut rules = Vec::new();
    for s in all {
        let name = s["properties"][&tag]["const"].clone();
        about.push(s.get("description").and_then(Value::as_str).unwrap_or_default().to_owned());
        let mut when = json!({ "properties": { &tag: { "const": &name } }, "required": [&tag] });
        let mut then = published(s);
        if default.as_ref() == Some(&name) {
            // The one that is meant where the tag is missing.
            when = json!({ "properties": { &tag: { "const": &name } } });
            then["required"] = without(&then["required"], &tag);
        }
        rules.push(json!({ "if": when, "then": then }));
        names.push(name);
    }
    let word =
        one_word(Map::new(), &names.iter().zip(about.iter().map(|a| Some(a.as_str()))).collect::<Vec<_>>());
    out.insert("type".into(), "object".into());
    out.insert("properties".into(), json!({ &tag: word }));
    if default.is_none() {
        out.insert("required".into(), json!([tag]));
    }
    out.insert("allOf".into(), rules.into());
    Value::Object(out)
}

/// A list of words without one of them.
fn without(words: &Value, word: &str) -> Value {
    words.as_array().into_iter().flatten().filter(|w| *w != word).cloned().collect::<Vec<_>>().into()
}

/// The schema of a case of any scene: the scene's name decides, and only its schema is looked at. `scenes`: name and schema, rewritten.
#[must_use]
pub fn one_scene_of(scenes: &[(&str, Value)]) -> Value {
    let names: Vec<&str> = scenes.iter().map(|(n, _)| *n).collect();
    let rules: Vec<Value> = scenes
        .iter()
        .map(|(name, schema)| {
            json!({
                "if": { "properties": { "scene": { "const": name } }, "required": ["scene"] },
                "then": schema,
            })
        })
        .collect();
    json!({
        "type": "object",
        "properties": { "scene": { "enum": names, "description": "What is simulated." } },
        "required": ["scene"],
        "allOf": rules,
    })
}
