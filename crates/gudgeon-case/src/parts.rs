//! The parts of a schema that stand apart from its root: what references name, and models, which are made when a document names them.

use std::collections::{BTreeMap, HashMap};
use std::sync::{Mutex, PoisonError, RwLock};

use gudgeon_core::Registry;
use gudgeon_core::registry::{Outlines, X_KIND, model_schema};
use schemars::SchemaGenerator;
use schemars::generate::SchemaSettings;
use serde_json::{Map, Value};

use super::schema::{Part, at};

/// All parts that are known, and the generator that makes others. Each is made once and lives as long as the program.
#[derive(Debug)]
pub(super) struct Parts {
    generator: Mutex<SchemaGenerator>,
    /// Definitions by name.
    named: RwLock<BTreeMap<String, Part>>,
    /// What was made from another part, by the address of that.
    made: RwLock<HashMap<usize, Part>>,
}

impl Parts {
    /// The root of the schema of a type, with the parts that it names.
    pub fn of<T: schemars::JsonSchema>() -> (Part, Self) {
        let mut generator = SchemaSettings::default().with_transform(Outlines).into_generator();
        let root = kept(T::json_schema(&mut generator).to_value());
        let mut named = BTreeMap::new();
        take(&mut generator, &mut named);
        let parts =
            Self { generator: Mutex::new(generator), named: RwLock::new(named), made: RwLock::default() };
        (root, parts)
    }

    /// What a definition says.
    pub fn named(&self, name: &str) -> Option<Part> {
        self.named.read().unwrap_or_else(PoisonError::into_inner).get(name).copied()
    }

    /// The whole of a model that a part outlines; any other part itself.
    pub fn whole(&self, part: Part) -> Part {
        let Some(kind) = at(part, X_KIND).and_then(Value::as_str) else { return part };
        self.made(part, || {
            let name = part.pointer("/properties/model/const").and_then(Value::as_str)?;
            let model = Registry::collect().model(kind, name)?;
            let mut generator = self.generator.lock().unwrap_or_else(PoisonError::into_inner);
            let whole = model_schema(model, &mut generator);
            take(&mut generator, &mut self.named.write().unwrap_or_else(PoisonError::into_inner));
            Some(whole)
        })
    }

    /// The table that a field refers to, with the keys that it must have in this place beside those that it must have in all (`required`
    /// beside `$ref`).
    pub fn demanding(&self, field: Part, table: Part) -> Part {
        let here = at(field, "required").and_then(Value::as_array);
        match (field.as_object(), here, table.as_object()) {
            (Some(own), Some(here), Some(all)) => self.made(field, || Some(demanding(own, here, all).into())),
            _ => table,
        }
    }

    /// What is made from a part, which stands for itself where nothing is.
    fn made(&self, part: Part, make: impl FnOnce() -> Option<Value>) -> Part {
        let place = std::ptr::from_ref(part).addr();
        if let Some(known) = self.made.read().unwrap_or_else(PoisonError::into_inner).get(&place) {
            return known;
        }
        let made = make().map_or(part, kept);
        // The first to come stays: no more of them are kept than there are parts, but for threads that come together.
        self.made.write().unwrap_or_else(PoisonError::into_inner).entry(place).or_insert(made)
    }
}

/// Takes what the generator has defined since the last time. It keeps the names, so that nothing is defined twice.
fn take(generator: &mut SchemaGenerator, named: &mut BTreeMap<String, Part>) {
    for (name, definition) in generator.definitions_mut().iter_mut().skip(named.len()) {
        named.insert(name.clone(), kept(definition.take()));
    }
}

/// A value for the whole life of the program.
fn kept(value: Value) -> Part {
    Box::leak(Box::new(value))
}

fn demanding(field: &Map<String, Value>, here: &[Value], table: &Map<String, Value>) -> Map<String, Value> {
    let mut required = table.get("required").and_then(Value::as_array).cloned().unwrap_or_default();
    required.extend(here.iter().filter(|key| !required.contains(key)).cloned().collect::<Vec<_>>());
    let mut out: Map<String, Value> = field
        .iter()
        .filter(|(key, _)| *key != "$ref")
        .map(|(key, value)| (key.clone(), value.clone()))
        .collect();
    out.insert("required".into(), Value::Array(required));
    for (key, value) in table {
        out.entry(key.clone()).or_insert_with(|| value.clone());
    }
    out
}
