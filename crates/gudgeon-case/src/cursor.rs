//! What the schema knows about the place of a text where a person writes, for editors.

use serde::Serialize;
use serde_json::Value;
use toml::de::DeTable;

use super::inputs::flat;
use super::report::Origin;
use super::schema::{Part, Schema, phrase, strings, types_of, units_of, words_of};
use super::tree::{Data, Node, join};

/// Help on one place of a case.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct Help {
    /// Path of the key, or of the table where the place is on no key.
    pub path: String,
    /// What it is for.
    pub about: String,
    /// What is wanted: `a length, greater than zero`.
    pub wants: String,
    /// Units that may be written, the SI unit first.
    pub units: Vec<String>,
    /// The value where the case gives none.
    pub default: String,
    /// Words or models that may stand there, with what they mean.
    pub words: Vec<(String, String)>,
    /// Keys of the table.
    pub keys: Vec<KeyHelp>,
}

/// A key that a table may have.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct KeyHelp {
    /// Its name.
    pub key: String,
    /// What it is for.
    pub about: String,
    /// Whether the table must have it.
    pub required: bool,
    /// Whether the text has it.
    pub present: bool,
    /// Whether it is a table of its own, or several.
    pub table: bool,
}

/// Help on the line that a byte offset of a text stands in; the text may be wrong elsewhere.
pub(super) fn help(schema: &Schema, text: &str, offset: usize) -> Help {
    // What could be read of a text with mistakes is enough to know which models it names.
    let document = Node::from_table(&DeTable::parse_recoverable(text).0, Origin::File, 0);
    let (table, key) = place(text, offset);
    let mut at = At { field: schema.root(), node: Some(&document) };
    for step in &table {
        match at.below(schema, step) {
            Some(next) => at = next,
            None => return Help { path: table.join("."), ..Help::default() },
        }
    }
    let path = table.iter().fold(String::new(), |p, s| join(&p, s));
    let keys = keys(schema, &at);
    let mut out = Help { path: path.clone(), about: about(schema, at.field), keys, ..Help::default() };
    let Some(key) = key.filter(|k| !k.is_empty()) else { return out };
    let mut inner = at;
    for step in &key {
        match inner.below(schema, step) {
            Some(next) => inner = next,
            None => return out,
        }
    }
    out.path = key.iter().fold(path, |p, s| join(&p, s));
    describe(schema, inner.field, &mut out);
    out
}

/// A place of the schema and, where the text has it, of the text.
#[derive(Clone, Copy)]
struct At<'n> {
    field: Part,
    node: Option<&'n Node>,
}

impl<'n> At<'n> {
    fn below(&self, schema: &Schema, step: &str) -> Option<At<'n>> {
        let node = self.node.and_then(|n| n.child(step));
        let field = schema.field(self.field, self.node, step).or_else(|| {
            // The tag itself is no property of one table but what tells several apart.
            let tagged = schema.tagged(schema.resolve(self.field))?;
            (tagged.tag == step).then_some(self.field)
        })?;
        Some(At { field, node })
    }
}

/// The table that a place stands in, with the number of an entry where there are several, and the key of its line.
fn place(text: &str, offset: usize) -> (Vec<String>, Option<Vec<String>>) {
    let mut end = offset.min(text.len());
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    let line_end = text[end..].find('\n').map_or(text.len(), |i| end + i);
    let mut table: Vec<String> = Vec::new();
    let mut counts: std::collections::BTreeMap<String, usize> = std::collections::BTreeMap::new();
    let mut key = None;
    for line in text[..line_end].lines() {
        let code = line.trim_start();
        key = None;
        if let Some(name) = code.strip_prefix("[[").and_then(|r| r.split("]]").next()) {
            table = entry(name, &mut counts, true);
        } else if let Some(name) =
            code.strip_prefix('[').and_then(|r| r.split(']').next()).filter(|_| !line.starts_with(' '))
        {
            table = entry(name, &mut counts, false);
        } else if let Some((name, _)) = code.split_once('=').filter(|_| !code.starts_with('#')) {
            key = Some(names(name));
        }
    }
    (table, key)
}

fn names(dotted: &str) -> Vec<String> {
    dotted.split('.').map(|s| s.trim().trim_matches('"').to_owned()).filter(|s| !s.is_empty()).collect()
}

/// The path of a header: every table that is one of several has the number of the last that was opened.
fn entry(header: &str, counts: &mut std::collections::BTreeMap<String, usize>, opens: bool) -> Vec<String> {
    let all = names(header);
    let mut path = Vec::new();
    let mut name = String::new();
    for (k, step) in all.iter().enumerate() {
        name = join(&name, step);
        path.push(step.clone());
        if opens && k + 1 == all.len() {
            let n = counts.entry(name.clone()).and_modify(|n| *n += 1).or_insert(0);
            path.push(n.to_string());
            let below = format!("{name}.");
            counts.retain(|other, _| !other.starts_with(&below));
        } else if let Some(n) = counts.get(&name) {
            path.push(n.to_string());
        }
    }
    path
}

fn about(schema: &Schema, field: Part) -> String {
    let inner = schema.resolve(field);
    let text = field.get("description").or_else(|| inner.get("description")).and_then(Value::as_str);
    flat(text.unwrap_or_default())
}

/// What a key wants.
fn describe(schema: &Schema, field: Part, out: &mut Help) {
    let inner = schema.resolve(field);
    out.about = about(schema, field);
    out.default = match field.get("default") {
        None | Some(Value::Null) => String::new(),
        Some(Value::String(s)) => s.clone(),
        // Of a model its name; its keys have defaults of their own.
        Some(Value::Object(o)) => o.get("model").and_then(Value::as_str).unwrap_or_default().to_owned(),
        Some(v) => v.to_string(),
    };
    let table = schema.model_of_word(inner).map_or(inner, |m| schema.resolve(m));
    if let Some(tagged) = schema.tagged(table) {
        out.words = tagged.variants.iter().map(|(n, s)| ((*n).to_owned(), about(schema, s))).collect();
        out.wants = if out.words.is_empty() { String::new() } else { "one of these models".into() };
    } else if let Some(words) = words_of(inner) {
        let meaning = |w: &str| {
            let of = |s: &Value| s.get("const").and_then(Value::as_str) == Some(w);
            let all = inner.get("oneOf").and_then(Value::as_array).into_iter().flatten();
            all.filter(|s| of(s)).find_map(|s| s.get("description")?.as_str()).map(flat).unwrap_or_default()
        };
        out.words = words.iter().map(|w| ((*w).to_owned(), meaning(w))).collect();
        out.wants = "one of these words".into();
    } else if let Some(dimension) = inner.get("x-dimension").and_then(Value::as_str) {
        let bound = inner.get("x-bound").and_then(Value::as_str).unwrap_or_default();
        out.wants = format!("{dimension}, {bound}");
        out.units = units_of(dimension).into_iter().map(str::to_owned).collect();
    } else {
        out.wants = phrase(&types_of(inner));
        for (key, words) in [
            ("minimum", "at least"),
            ("exclusiveMinimum", "greater than"),
            ("maximum", "at most"),
            ("exclusiveMaximum", "less than"),
        ] {
            if let Some(limit) = inner.get(key).and_then(Value::as_f64) {
                out.wants.push_str(&format!(", {words} {limit}"));
            }
        }
    }
}

/// The keys of a table, those that must be there first.
fn keys(schema: &Schema, at: &At<'_>) -> Vec<KeyHelp> {
    let inner = schema.resolve(at.field);
    let inner = schema.model_of_word(inner).map_or(inner, |m| schema.resolve(m));
    let table = match (schema.tagged(inner), at.node) {
        (Some(t), Some(node)) => t.chosen(schema, node).or_else(|| t.first(schema)),
        (Some(t), None) => t.first(schema),
        (None, _) => Some(inner),
    };
    let Some(table) = table else { return Vec::new() };
    let required = strings(table.get("required"));
    let present = |key: &str| match at.node.map(|n| &n.data) {
        Some(Data::Table(entries)) => entries.iter().any(|e| e.key == key),
        _ => false,
    };
    let properties = table.get("properties").and_then(Value::as_object).into_iter().flatten();
    let mut out: Vec<KeyHelp> = properties
        .map(|(key, s)| {
            let inner = schema.resolve(s);
            let several = inner.get("items").map(|i| schema.resolve(i));
            let holds = |p: Part| p.get("properties").is_some() || schema.tagged(p).is_some();
            KeyHelp {
                key: key.clone(),
                about: about(schema, s),
                required: required.contains(&key.as_str()),
                present: present(key),
                table: holds(inner) || several.is_some_and(holds),
            }
        })
        .collect();
    out.sort_by_key(|k| !k.required);
    out
}
