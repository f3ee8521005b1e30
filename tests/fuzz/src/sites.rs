//! What may be changed in a case: its resolved values beside the schema that says what each of them is.

use gudgeon_core::Registry;
use serde_json::{Map, Value};

use crate::corpus::Corpus;

/// A value of a case that can be changed.
#[derive(Debug, Clone, PartialEq)]
pub struct Site {
    /// Its path.
    pub path: String,
    /// What it is.
    pub what: What,
}

/// Kinds of value.
#[derive(Debug, Clone, PartialEq)]
pub enum What {
    /// A number, in the unit that stands behind it.
    Number {
        /// Its value.
        value: f64,
        /// Its unit; empty for a ratio.
        unit: String,
        /// Its dimension, in the words of the schema.
        dimension: String,
        /// Which values are admitted, in the words of the schema.
        bound: String,
    },
    /// A count.
    Whole(i64),
    /// A switch.
    Switch(bool),
    /// One of some words.
    Word {
        /// The word that stands there.
        now: String,
        /// The others.
        others: Vec<String>,
    },
    /// A model of a kind. It may be absent where it is optional.
    Model {
        /// The kind.
        kind: String,
    },
    /// A table of another sort (a shape, a mode), written as it would stand with the values it shares with the one there.
    Table {
        /// Those that need nothing more.
        others: Vec<Value>,
    },
    /// A list.
    List(Vec<Value>),
    /// Names of wanted results.
    Results,
    /// Free text: a name, a file.
    Text,
    /// The changes of another case file that this one names.
    Part {
        /// The file.
        file: String,
    },
}

/// Keys of every case that say nothing to the simulation.
const HEADING: &[&str] = &["scene", "title", "source", "assumptions"];

/// Everything that may be changed in a resolved case of a scene.
#[must_use]
pub fn sites(corpus: &Corpus, registry: &Registry, scene: &str, resolved: &Value) -> Vec<Site> {
    let Some(schema) = corpus.schemas.get(scene) else { return Vec::new() };
    let walk = Walk { corpus, registry };
    let mut out = Vec::new();
    walk.value(schema, resolved, "", &mut out);
    out.retain(|s| !HEADING.contains(&s.path.split('.').next().unwrap_or_default()));
    out
}

struct Walk<'a> {
    corpus: &'a Corpus,
    registry: &'a Registry,
}

impl<'a> Walk<'a> {
    /// Follows references and drops the alternative `null`; the name of the last reference goes with it.
    fn resolve(&self, mut schema: &'a Value) -> (&'a Value, Option<&'a str>) {
        let mut name = None;
        // Deeper than any schema refers without a value in between.
        for _ in 0..32 {
            if let Some(r) = schema.get("$ref").and_then(Value::as_str) {
                name = r.rsplit('/').next();
                match name.and_then(|n| self.corpus.definitions.get(n)) {
                    Some(s) => schema = s,
                    None => break,
                }
                continue;
            }
            let some = ["anyOf", "allOf"].iter().find_map(|k| schema.get(k)).and_then(Value::as_array);
            let mut rest =
                some.into_iter().flatten().filter(|s| s.get("type").and_then(Value::as_str) != Some("null"));
            match (rest.next(), rest.next()) {
                (Some(only), None) => schema = only,
                // A model or its name: as the resolved case writes it, a model.
                (Some(word), Some(model)) if word.get("enum").is_some() && model.get("$ref").is_some() => {
                    schema = model
                }
                _ => break,
            }
        }
        (schema, name)
    }

    fn value(&self, schema: &'a Value, value: &Value, path: &str, out: &mut Vec<Site>) {
        let (schema, name) = self.resolve(schema);
        let site = |what| Site { path: path.to_owned(), what };
        if let Some(kind) = name.filter(|n| self.registry.kind(n).is_some()) {
            out.push(site(What::Model { kind: kind.to_owned() }));
        }
        if let Some(d) = schema.get("x-dimension").and_then(Value::as_str) {
            let bound = schema.get("x-bound").and_then(Value::as_str).unwrap_or_default();
            out.extend(number(value, d, bound).map(site));
            return;
        }
        match value {
            Value::Bool(b) => out.push(site(What::Switch(*b))),
            Value::Number(n) => match n.as_i64() {
                Some(i) if types(schema).contains(&"integer") => out.push(site(What::Whole(i))),
                _ => out.extend(number(value, "", "").map(site)),
            },
            Value::String(now) => out.push(site(match words(schema) {
                Some(all) => What::Word {
                    now: now.clone(),
                    others: all.into_iter().filter(|w| w != now).map(str::to_owned).collect(),
                },
                None => What::Text,
            })),
            Value::Array(items) => {
                let results = path.ends_with("results");
                out.push(site(if results { What::Results } else { What::List(items.clone()) }));
                if let Some(inner) = schema.get("items").filter(|_| !results) {
                    for (k, v) in items.iter().enumerate() {
                        self.value(inner, v, &join(path, &k.to_string()), out);
                    }
                }
            }
            Value::Object(table) => self.table(schema, table, path, out),
            Value::Null => {}
        }
    }

    fn table(&self, schema: &'a Value, table: &Map<String, Value>, path: &str, out: &mut Vec<Site>) {
        let chosen = match self.variants(schema) {
            Some((tag, variants)) => {
                let now = table.get(tag).and_then(Value::as_str).unwrap_or_default();
                if tag != "model" {
                    let others = others(tag, &variants, now, table);
                    out.push(Site { path: path.to_owned(), what: What::Table { others } });
                }
                variants.into_iter().find(|(n, _)| *n == now).map(|(_, s)| s)
            }
            None => Some(schema),
        };
        let Some(properties) = chosen.and_then(|s| s.get("properties")).and_then(Value::as_object) else {
            return;
        };
        if let (Some(file), true) =
            (table.get("case").and_then(Value::as_str), properties.contains_key("set"))
        {
            out.push(Site { path: path.to_owned(), what: What::Part { file: file.to_owned() } });
        }
        for (key, field) in properties {
            let path = join(path, key);
            match table.get(key) {
                Some(v) if field.get("const").is_none() => self.value(field, v, &path, out),
                Some(_) => {}
                // An optional model that is not there may be.
                None => {
                    let kind = self.resolve(field).1.filter(|n| self.registry.kind(n).is_some());
                    out.extend(kind.map(|k| Site { path, what: What::Model { kind: k.to_owned() } }));
                }
            }
        }
    }

    /// The sorts of a table that one of its keys tells apart.
    fn variants(&self, schema: &'a Value) -> Option<(&'a str, Vec<(&'a str, &'a Value)>)> {
        let all: Vec<&Value> = schema.get("oneOf")?.as_array()?.iter().map(|s| self.resolve(s).0).collect();
        let constant = |s: &'a Value, key: &str| s.get("properties")?.get(key)?.get("const")?.as_str();
        let keys = all.first()?.get("properties")?.as_object()?.keys();
        let tag = keys.into_iter().find(|k| all.iter().all(|s| constant(s, k).is_some()))?;
        Some((tag, all.iter().filter_map(|s| Some((constant(s, tag)?, *s))).collect()))
    }
}

/// The other sorts of a table that need no key which neither stands there nor has a default.
fn others(tag: &str, variants: &[(&str, &Value)], now: &str, table: &Map<String, Value>) -> Vec<Value> {
    let mut out = Vec::new();
    for (name, schema) in variants.iter().filter(|(n, _)| *n != now) {
        let needs = schema.get("required").and_then(Value::as_array).into_iter().flatten();
        if needs.filter_map(Value::as_str).any(|k| k != tag && !table.contains_key(k)) {
            continue;
        }
        let mut other = Map::new();
        other.insert(tag.to_owned(), (*name).into());
        let has = |k: &str| schema.get("properties").is_some_and(|p| p.get(k).is_some());
        other.extend(table.iter().filter(|(k, _)| *k != tag && has(k)).map(|(k, v)| (k.clone(), v.clone())));
        out.push(Value::Object(other));
    }
    out
}

/// A number with its unit, as a resolved case writes it.
fn number(value: &Value, dimension: &str, bound: &str) -> Option<What> {
    let (value, unit) = match value {
        Value::String(s) => {
            let (number, unit) = s.split_once(' ').unwrap_or((s, ""));
            (number.parse().ok()?, unit.to_owned())
        }
        v => (v.as_f64()?, String::new()),
    };
    Some(What::Number { value, unit, dimension: dimension.to_owned(), bound: bound.to_owned() })
}

fn types(schema: &Value) -> Vec<&str> {
    match schema.get("type") {
        Some(Value::String(s)) => vec![s],
        Some(Value::Array(a)) => a.iter().filter_map(Value::as_str).collect(),
        _ => Vec::new(),
    }
}

/// The words that a text must be one of.
fn words(schema: &Value) -> Option<Vec<&str>> {
    if let Some(all) = schema.get("enum").and_then(Value::as_array) {
        return Some(all.iter().filter_map(Value::as_str).collect());
    }
    let all = schema.get("oneOf").or_else(|| schema.get("anyOf"))?.as_array()?;

    if !all.iter().all(|s| s.get("const").is_some() || s.get("enum").is_some()) {
        return None;
    }
    let mut out = Vec::new();
    for s in all {
        out.extend(s.get("const").and_then(Value::as_str));
        out.extend(s.get("enum").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_str));
    }
    Some(out)
}

/// `path.key`, or `key` at the top.
fn join(path: &str, key: &str) -> String {
    if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") }
}
