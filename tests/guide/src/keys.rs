//! The keys of a specification, from its JSON schema, as a list in Markdown.

use std::fmt::Write as _;

use gudgeon_case::catalogue::{DEPTH, bound, choice, resolve, texts, words};
use gudgeon_core::Registry;
use serde_json::{Map, Value};

/// What the references of a schema are looked up in.
#[derive(Debug)]
pub struct Names<'a> {
    /// Definitions that a schema refers to; that of a kind has its name.
    pub definitions: &'a Map<String, Value>,
    /// Which kinds there are.
    pub registry: &'a Registry,
}

/// The keys as a nested list; empty where there are none. `to_kinds` is the way to the pages of the kinds.
#[must_use]
pub fn list(schema: &Value, names: &Names<'_>, to_kinds: &str) -> String {
    let mut out = String::new();
    let writer = Writer { names, to_kinds };
    writer.table(schema, 0, 0, &mut out);
    out
}

struct Writer<'a> {
    names: &'a Names<'a>,
    to_kinds: &'a str,
}

impl Writer<'_> {
    fn table(&self, schema: &Value, indent: usize, depth: usize, out: &mut String) {
        let Some(properties) = schema.get("properties").and_then(Value::as_object) else { return };
        let required = texts(schema, "required");
        for (key, p) in properties.iter().filter(|(_, p)| p.get("const").is_none()) {
            self.key(key, p, required.contains(&key.as_str()), (indent, depth), out);
        }
    }

    fn key(&self, key: &str, p: &Value, required: bool, (indent, depth): (usize, usize), out: &mut String) {
        let (inner, name) = resolve(p, self.names.definitions);
        let text = p.get("description").or_else(|| inner.get("description")).and_then(Value::as_str);
        let text = text.map_or(String::new(), |t| format!(". {}", plain(t)));
        // Writing to a String cannot fail.
        let _ = writeln!(
            out,
            "{:indent$}- `{key}`: {}{}{text}",
            "",
            self.what(inner, name),
            default(p, required)
        );
        if name.is_some_and(|n| self.is_kind(n)) {
            return;
        }
        for (word, what) in words(inner) {
            let meaning = what.map_or_else(String::new, |w| format!(": {}", plain(w)));
            let _ = writeln!(out, "{:1$}- `\"{word}\"`{meaning}", "", indent + 2);
        }
        let element = inner.get("items").map_or(inner, |i| resolve(i, self.names.definitions).0);
        if depth < DEPTH {
            self.inside(element, indent + 2, depth + 1, out);
        }
    }

    fn inside(&self, element: &Value, indent: usize, depth: usize, out: &mut String) {
        match choice(element) {
            // A model inside another has a page of its own.
            Some(("model", _)) => {}
            Some((tag, tables)) => {
                for (word, table) in tables {
                    let what = table.get("description").and_then(Value::as_str).unwrap_or_default();
                    let _ = writeln!(out, "{:indent$}- `{tag} = \"{word}\"`: {}", "", plain(what));
                    self.table(table, indent + 2, depth, out);
                }
            }
            None => self.table(element, indent, depth, out),
        }
    }

    fn is_kind(&self, name: &str) -> bool {
        self.names.registry.kind(name).is_some()
    }

    fn what(&self, schema: &Value, name: Option<&str>) -> String {
        if let Some(kind) = name.filter(|n| self.is_kind(n)) {
            return format!("a model of [{kind}]({}{kind}.md)", self.to_kinds);
        }
        if let Some(text) = quantity(schema) {
            return text;
        }
        if !words(schema).is_empty() {
            return "one word of".into();
        }
        if schema.get("oneOf").is_some() {
            return match choice(schema) {
                Some((tag, _)) => format!("a table with the key `{tag}`, one of"),
                None => "one of several forms".into(),
            };
        }
        if let Some(items) = schema.get("items") {
            let (inner, name) = resolve(items, self.names.definitions);
            return format!("array of {}", self.what(inner, name));
        }
        basic(schema)
    }
}

/// Rustdoc's escapes, line breaks and links are for another reader; what looks like HTML stays text.
fn plain(text: &str) -> String {
    let text = text.replace("\\[", "[").replace("\\]", "]");
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    without_links(&text).replace('<', "&lt;").replace("](", "] (")
}

/// ``[`Name`](path)`` as `Name`.
fn without_links(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(at) = rest.find("](") {
        let (Some(open), Some(close)) = (rest[..at].rfind('['), rest[at..].find(')')) else { break };
        out.push_str(&rest[..open]);
        out.push_str(&rest[open + 1..at]);
        rest = &rest[at + close + 1..];
    }
    out + rest
}

fn default(p: &Value, required: bool) -> String {
    match p.get("default") {
        Some(Value::String(t)) => format!(", default `{t}`"),
        Some(Value::Object(_)) => ", has defaults".into(),
        Some(Value::Null) => ", optional".into(),
        Some(v) => format!(", default `{v}`"),
        None if required => ", **required**".into(),
        None => ", optional".into(),
    }
}

fn quantity(schema: &Value) -> Option<String> {
    let dimension = schema.get("x-dimension").and_then(Value::as_str)?;
    let units = match &texts(schema, "x-units")[..] {
        [] => String::new(),
        // A number stands plainly or as a part of a hundred.
        ["%"] => " or a text in %".into(),
        units => format!(" in {}", units.join(", ")),
    };
    Some(format!("{dimension}{units}{}", bound(schema)))
}

fn basic(schema: &Value) -> String {
    let one = |t: &str| match t {
        "string" => "text".to_owned(),
        "integer" => "whole number".into(),
        "boolean" => "true or false".into(),
        "object" => "table".into(),
        other => other.to_owned(),
    };
    let least =
        schema.get("minimum").and_then(Value::as_f64).map_or(String::new(), |m| format!(", at least {m}"));
    match schema.get("type") {
        Some(Value::Array(a)) => {
            let all: Vec<String> =
                a.iter().filter_map(Value::as_str).filter(|t| *t != "null").map(one).collect();
            all.join(" or ") + &least
        }
        Some(Value::String(t)) => one(t) + &least,
        _ => "any value".into(),
    }
}
