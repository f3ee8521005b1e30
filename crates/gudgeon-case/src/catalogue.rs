//! What a case may say: kinds and models found by name, and what is known of them, for a program to read.

use std::collections::BTreeMap;

use gudgeon_core::schemars::SchemaGenerator;
use gudgeon_core::sets::{self, ParameterSets};
use gudgeon_core::{KindInfo, ModelInfo, Registry};
use serde_json::{Map, Value, json};

use crate::near::{advice, list};
use crate::places::{self, Place};
use crate::report::Diagnostic;

/// The kind of that name.
///
/// # Errors
/// There is none; the advice names those that would do.
pub fn kind(registry: &Registry, name: &str) -> Result<&'static KindInfo, Diagnostic> {
    registry.kind(name).ok_or_else(|| {
        let names: Vec<&str> = registry.kinds().map(|k| k.kind).collect();
        Diagnostic::new(format!("there is no kind `{name}`")).help(advice(name, &names))
    })
}

/// The model that `what` names: `kind/model`, `kind.model`, or a model name that only one kind has.
///
/// # Errors
/// There is none, or several; the advice names those that would do.
pub fn model(registry: &Registry, what: &str) -> Result<&'static ModelInfo, Diagnostic> {
    if let Some((k, name)) = what.split_once(['/', '.']) {
        let k = kind(registry, k)?;
        return registry.model(k.kind, name).ok_or_else(|| {
            let names: Vec<&str> = registry.models(k.kind).iter().map(|m| m.name).collect();
            Diagnostic::new(format!("there is no {} model `{name}`", k.kind)).help(advice(name, &names))
        });
    }
    let all: Vec<&'static ModelInfo> =
        registry.kinds().flat_map(|k| registry.models(k.kind)).copied().collect();
    let named: Vec<&'static ModelInfo> = all.iter().filter(|m| m.name == what).copied().collect();
    match named[..] {
        [only] => Ok(only),
        [] => {
            let mut names: Vec<&str> = all.iter().map(|m| m.name).collect();
            names.extend(registry.kinds().map(|k| k.kind));
            names.sort_unstable();
            names.dedup();
            Err(Diagnostic::new(format!("there is no kind and no model `{what}`")).help(advice(what, &names)))
        }
        ref many => {
            let full: Vec<String> = many.iter().map(|m| format!("{}/{}", m.kind, m.name)).collect();
            Err(Diagnostic::new(format!("several kinds have a model `{what}`"))
                .help(format!("name one of {}", list(full.iter().map(String::as_str)))))
        }
    }
}

/// A kind with its models: `kind`, `summary`, `models`, each with `model`, `summary`, `references`, `tables`.
#[must_use]
pub fn of_kind(registry: &Registry, k: &KindInfo) -> Value {
    let of_model = |m: &&ModelInfo| {
        let words = |(path, key, words)| json!({ "path": path, "key": key, "words": words });
        let tables: Vec<_> = choices(m).into_iter().map(words).collect();
        json!({ "model": m.name, "summary": m.summary, "references": m.references, "tables": tables })
    };
    let models: Vec<_> = registry.models(k.kind).iter().map(of_model).collect();
    json!({ "kind": k.kind, "summary": k.summary, "models": models })
}

/// Everything that is known of a model: `kind`, `model`, `summary`, `equations`, `validity`, `references`, `example`, `source`, `schema`,
/// `definitions`. `cases` are the schemas of the cases it may stand in, each with its `$defs`.
#[must_use]
pub fn of_model(registry: &Registry, m: &ModelInfo, cases: &[Value]) -> Value {
    let (schema, definitions) = schema(m);
    json!({
        "kind": m.kind,
        "model": m.name,
        "summary": m.summary,
        "equations": equations(m).collect::<Vec<_>>(),
        "validity": m.validity,
        "references": m.references,
        "example": example(registry, m, cases),
        "source": format!("{}:{}", m.file, m.line),
        "schema": schema,
        "definitions": definitions,
    })
}

/// The equations of a model, one by one.
pub fn equations(m: &ModelInfo) -> impl Iterator<Item = &'static str> {
    m.equations.split(";  ").map(str::trim).filter(|e| !e.is_empty())
}

/// The example of a model as a table of a case, where the cases of these schemas have its kind.
#[must_use]
pub fn example(registry: &Registry, m: &ModelInfo, cases: &[Value]) -> String {
    let Place { path, key } = places::of(registry, m.kind, cases);
    format!("[{path}]\n{key} = \"{}\"\n{}", m.name, m.example.trim_start())
}

/// The schema of a model and what it refers to.
#[must_use]
pub fn schema(m: &ModelInfo) -> (Value, Map<String, Value>) {
    let mut g = SchemaGenerator::default();
    let schema = (m.schema)(&mut g).to_value();
    (schema, g.take_definitions(true))
}

/// What the schema of a case refers to.
pub(crate) fn definitions(case: &Value) -> Map<String, Value> {
    case.get("$defs").and_then(Value::as_object).cloned().unwrap_or_default()
}

/// Tables inside tables that are shown; a model inside a model names its kind instead.
pub const DEPTH: usize = 4;

/// Follows references and the non-null alternative of an optional value; with the name of the last reference.
#[must_use]
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
#[must_use]
pub fn choice(schema: &Value) -> Option<(&str, Vec<(&str, &Value)>)> {
    let all = schema.get("oneOf").and_then(Value::as_array)?;
    let first = all.first()?.get("properties")?.as_object()?;
    let tag = first.keys().find(|k| all.iter().all(|s| constant(s, k).is_some()))?;
    Some((tag, all.iter().filter_map(|s| Some((constant(s, tag)?, s))).collect()))
}

/// The words of a choice, each with its meaning where it has one.
#[must_use]
pub fn words(schema: &Value) -> Vec<(&str, Option<&str>)> {
    if let Some(all) = schema.get("enum").and_then(Value::as_array) {
        return all.iter().filter_map(Value::as_str).map(|w| (w, None)).collect();
    }
    let Some(all) = schema.get("oneOf").and_then(Value::as_array) else { return Vec::new() };
    let mut out = Vec::new();
    for s in all {
        match s.get("const").and_then(Value::as_str) {
            Some(word) => out.push((word, s.get("description").and_then(Value::as_str))),
            None => out.extend(words(s)),
        }
    }
    out
}

/// The texts of an array that a schema has under a key: `required`, `x-units`.
#[must_use]
pub fn texts<'a>(schema: &'a Value, key: &str) -> Vec<&'a str> {
    let all = schema.get(key).and_then(Value::as_array);
    all.into_iter().flatten().filter_map(Value::as_str).collect()
}

/// The bound of a quantity as the end of a sentence, `, greater than zero`; empty where it has none.
#[must_use]
pub fn bound(schema: &Value) -> String {
    match schema.get("x-bound").and_then(Value::as_str) {
        None | Some("finite") => String::new(),
        Some(b) => format!(", {b}"),
    }
}

/// Tables of a model that a word other than `model` tells apart: path, key, words.
#[must_use]
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

/// A table that has parameter sets: its name as a case or a model is called, and the sets.
#[derive(Debug, Clone, PartialEq)]
pub struct SetTable {
    /// `oil/walther` of a model, `engine` of a table of a case.
    pub of: String,
    /// The sets by name.
    pub sets: ParameterSets,
}

/// Every model and every table of these schemas of cases that has parameter sets: models first, by kind and name, then tables by name.
#[must_use]
pub fn set_tables(registry: &Registry, cases: &[Value]) -> Vec<SetTable> {
    let models = registry.kinds().flat_map(|k| registry.models(k.kind));
    let of_model =
        |m: &&ModelInfo| SetTable { of: format!("{}/{}", m.kind, m.name), sets: sets::of(&schema(m).0) };
    let mut all: Vec<SetTable> = models.map(of_model).filter(|t| !t.sets.is_empty()).collect();
    let mut tables = BTreeMap::new();
    for case in cases {
        tables_with_sets(case, &definitions(case), 0, &mut tables);
    }
    all.extend(tables.into_iter().map(|(of, sets)| SetTable { of, sets }));
    all
}

/// The tables with sets below a schema, by the keys that they stand at. Models are left out.
fn tables_with_sets(
    table: &Value,
    definitions: &Map<String, Value>,
    depth: usize,
    out: &mut BTreeMap<String, ParameterSets>,
) {
    for (key, p) in table.get("properties").and_then(Value::as_object).into_iter().flatten() {
        let inner = resolve(p, definitions).0;
        let element = inner.get("items").map_or(inner, |i| resolve(i, definitions).0);
        let sets = sets::of(element);
        if !sets.is_empty() {
            out.insert(key.clone(), sets);
        }
        if depth < DEPTH {
            tables_with_sets(element, definitions, depth + 1, out);
        }
    }
}
