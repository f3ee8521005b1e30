//! A TOML document whose every key and value remembers where it was written.

use std::ops::Range;

use gudgeon_core::content::Content;
use serde_json::Value;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::report::Origin;

/// A value with its place.
#[derive(Debug, Clone)]
pub(super) struct Node {
    pub data: Data,
    pub place: Place,
}

/// A range in one of the texts.
#[derive(Debug, Clone)]
pub(super) struct Place {
    pub origin: Origin,
    pub span: Option<Range<usize>>,
}

#[derive(Debug, Clone)]
pub(super) enum Data {
    Text(String),
    Integer(i64),
    /// Also integers that do not fit an `i64`.
    Float(f64),
    Bool(bool),
    Date,
    Array(Vec<Node>),
    Table(Vec<Entry>),
}

#[derive(Debug, Clone)]
pub(super) struct Entry {
    pub key: String,
    pub key_place: Place,
    pub node: Node,
}

/// One step of a path.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Step {
    /// Its text.
    pub text: String,
    /// Range of the step in the text that the path was read from.
    pub span: Range<usize>,
}

/// Reads `rings.0.gap` or `rings[0].gap`; steps keep their byte ranges, shifted by `base`.
pub fn steps(path: &str, base: usize) -> Vec<Step> {
    let mut out = Vec::new();
    let mut start = 0;
    let mut push = |from: usize, to: usize, keep_empty: bool| {
        let raw = &path[from..to];
        let text = raw.trim();
        if keep_empty || !text.is_empty() {
            let lead = raw.len() - raw.trim_start().len();
            let s = base + from + lead;
            out.push(Step { text: text.to_owned(), span: s..s + text.len() });
        }
    };
    let mut after_bracket = false;
    for (i, c) in path.char_indices() {
        match c {
            '.' | '[' => {
                push(start, i, !after_bracket && c == '.');
                (start, after_bracket) = (i + 1, false);
            }
            ']' => {
                push(start, i, true);
                (start, after_bracket) = (i + 1, true);
            }
            _ => {}
        }
    }
    push(start, path.len(), !after_bracket);
    out
}

/// `path.key`, or `key` at the top.
pub(super) fn join(path: &str, key: &str) -> String {
    if path.is_empty() { key.to_owned() } else { [path, ".", key].concat() }
}

impl Node {
    pub fn from_table(t: &Spanned<DeTable<'_>>, origin: Origin, base: usize) -> Self {
        Self { data: table(t.get_ref(), origin, base), place: Place { origin, span: None } }
    }

    /// The value without its places.
    pub fn content(&self) -> Content {
        match &self.data {
            Data::Text(s) => Content::Text(s.clone()),
            Data::Integer(i) => Content::Integer(*i),
            Data::Float(f) if f.is_finite() => Content::Number(*f),
            // The check of the schema has refused them where a number is wanted.
            Data::Float(_) | Data::Date => Content::Nothing,
            Data::Bool(b) => Content::Bool(*b),
            Data::Array(a) => Content::List(a.iter().map(Self::content).collect()),
            Data::Table(t) => Content::Table(t.iter().map(|e| (e.key.clone(), e.node.content())).collect()),
        }
    }

    pub fn from_value(v: &Spanned<DeValue<'_>>, origin: Origin, base: usize) -> Self {
        let data = match v.get_ref() {
            DeValue::String(s) => Data::Text(s.to_string()),
            DeValue::Integer(i) => {
                let parsed = i64::from_str_radix(i.as_str(), i.radix());
                // Out of range of i64: keep the magnitude, so that the range check can speak about it.
                parsed
                    .map_or_else(|_| Data::Float(i.as_str().parse().unwrap_or(f64::INFINITY)), Data::Integer)
            }
            DeValue::Float(f) => Data::Float(f.as_str().parse().unwrap_or(f64::NAN)),
            DeValue::Boolean(b) => Data::Bool(*b),
            DeValue::Datetime(_) => Data::Date,
            DeValue::Array(a) => Data::Array(a.iter().map(|v| Self::from_value(v, origin, base)).collect()),
            DeValue::Table(t) => table(t, origin, base),
        };
        Self { data, place: place(v.span(), origin, base) }
    }

    /// A default of the schema.
    pub fn from_json(v: &Value) -> Option<Self> {
        let data = match v {
            Value::Null => return None,
            Value::Bool(b) => Data::Bool(*b),
            Value::Number(n) => {
                n.as_i64().map_or_else(|| Data::Float(n.as_f64().unwrap_or(f64::NAN)), Data::Integer)
            }
            Value::String(s) => Data::Text(s.clone()),
            Value::Array(a) => Data::Array(a.iter().filter_map(Self::from_json).collect()),
            Value::Object(o) => Data::Table(
                o.iter()
                    .filter_map(|(k, v)| {
                        let key_place = Place { origin: Origin::Default, span: None };
                        Self::from_json(v).map(|node| Entry { key: k.clone(), key_place, node })
                    })
                    .collect(),
            ),
        };
        Some(Self { data, place: Place { origin: Origin::Default, span: None } })
    }

    pub fn child(&self, step: &str) -> Option<&Self> {
        match &self.data {
            Data::Table(t) => t.iter().find(|e| e.key == step).map(|e| &e.node),
            Data::Array(a) => a.get(step.parse::<usize>().ok()?),
            _ => None,
        }
    }

    /// The node at `path` or its nearest existing ancestor, and whether it is the node itself.
    pub fn deepest<'a>(&'a self, path: &str) -> (&'a Self, bool) {
        let mut node = self;
        let mut located = self;
        if path.is_empty() {
            return (self, true);
        }
        for step in steps(path, 0) {
            match node.child(&step.text) {
                Some(n) => node = n,
                None => return (located, false),
            }
            if node.place.span.is_some() {
                located = node;
            }
        }
        (located, std::ptr::eq(located, node))
    }

    /// What kind of value it is, for messages.
    pub const fn noun(&self) -> &'static str {
        match self.data {
            Data::Text(_) => "a text",
            Data::Integer(_) => "an integer",
            Data::Float(_) => "a number",
            Data::Bool(_) => "a boolean",
            Data::Date => "a date",
            Data::Array(_) => "an array",
            Data::Table(_) => "a table",
        }
    }
}

fn place(span: Range<usize>, origin: Origin, base: usize) -> Place {
    Place { origin, span: (!span.is_empty()).then(|| span.start + base..span.end + base) }
}

fn table(t: &DeTable<'_>, origin: Origin, base: usize) -> Data {
    Data::Table(
        t.iter()
            .map(|(k, v)| {
                let key_place = place(k.span(), origin, base);
                let mut node = Node::from_value(v, origin, base);
                if node.place.span.is_none() {
                    // A table that only its sub-tables imply has no text of its own.
                    node.place = key_place.clone();
                }
                Entry { key: k.get_ref().to_string(), key_place, node }
            })
            .collect(),
    )
}
