//! Where a model of a kind stands in a case.

use gudgeon_core::Registry;
use serde_json::{Map, Value};

use crate::catalogue::{choice, definitions, resolve};

/// Tables inside tables that are looked into.
const DEPTH: usize = 3;

/// A table of a case, and the key in it that names the model.
#[derive(Debug, PartialEq)]
pub struct Place {
    /// `models.oil`, `rig`, `shafts.coupling`, `solver`.
    pub path: String,
    /// `model`, of a solver `method`.
    pub key: String,
}

/// Where a kind stands: among the models where any of these cases has it there, else at the first place of the first case that asks for it, else
/// in the first model that does.
pub fn of(registry: &Registry, kind: &str, cases: &[Value]) -> Place {
    let names: Vec<&str> = registry.models(kind).iter().map(|m| m.name).collect();
    let usual = Place { path: format!("models.{kind}"), key: "model".into() };
    for in_models in [false, true] {
        let mut search = Search { kind, names: &names, in_models, found: Vec::new() };
        for case in cases {
            search.table(case, &definitions(case), "", 0);
        }
        if search.found.contains(&usual) {
            return usual;
        }
        if let Some(first) = search.found.into_iter().next() {
            return first;
        }
    }
    usual
}

struct Search<'a> {
    kind: &'a str,
    /// Its models.
    names: &'a [&'a str],
    /// Whether models are looked into as well.
    in_models: bool,
    found: Vec<Place>,
}

impl Search<'_> {
    fn table(&mut self, table: &Value, definitions: &Map<String, Value>, path: &str, depth: usize) {
        for (key, p) in table.get("properties").and_then(Value::as_object).into_iter().flatten() {
            let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
            let (value, name) = resolve(p, definitions);
            let (element, inner) = value.get("items").map_or((value, None), |i| resolve(i, definitions));
            if inner.or(name) == Some(self.kind) || by_word(p, self.kind) {
                self.found.push(Place { path, key: "model".into() });
                continue;
            }
            match choice(element) {
                Some((tag, tables)) if tag != "model" && has_all(self.names, &tables) => {
                    self.found.push(Place { path, key: tag.to_owned() });
                }
                Some((_, tables)) if self.in_models && depth < DEPTH => {
                    tables.iter().for_each(|(_, m)| self.table(m, definitions, &path, depth + 1));
                }
                None if depth < DEPTH => self.table(element, definitions, &path, depth + 1),
                _ => {}
            }
        }
    }
}

/// Whether each of these names is a word that tells the tables apart.
fn has_all(names: &[&str], tables: &[(&str, &Value)]) -> bool {
    names.iter().all(|n| tables.iter().any(|(word, _)| word == n))
}

/// Whether a value is a model of the kind or the word that is short for one.
fn by_word(p: &Value, kind: &str) -> bool {
    let all = p.get("anyOf").and_then(Value::as_array);
    let name = |s: &Value| s.get("$ref")?.as_str()?.rsplit('/').next().map(str::to_owned);
    all.into_iter().flatten().any(|s| name(s).as_deref() == Some(kind))
}
