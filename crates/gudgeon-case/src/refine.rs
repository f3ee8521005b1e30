//! The numerical settings of a case that refine its results: tolerances, grids, orders.
//!
//! A field says so itself, in its schema: `x-refine` holds the name of what is refined (`tolerance`, `film grid`; settings of one name are
//! refined together), the `factor` of one level, and possibly `levels`, how many of them are worth their time (a plane grid has four times the
//! nodes a level). So a model that is registered elsewhere is verified like a built-in one.

use indexmap::IndexMap;
use serde_json::Value;

use super::schema::{Part, Schema};
use super::tree::join;

/// Most levels of a group.
const LEVELS: i32 = 3;

/// A group of settings and how it is refined.
#[derive(Debug, Clone, PartialEq)]
pub struct Refinement {
    /// What is refined.
    pub what: String,
    /// The changes of each level, as `--set` takes them, the mildest first.
    pub levels: Vec<Vec<String>>,
}

/// The settings of a resolved case that refine its results, by what they refine.
pub(super) fn refinements(schema: &Schema, resolved: &Value) -> Vec<Refinement> {
    let mut groups: IndexMap<String, Vec<Setting>> = IndexMap::new();
    for s in settings(schema, resolved) {
        groups.entry(s.group.clone()).or_default().push(s);
    }
    let most = |s: &[Setting]| s.iter().map(|s| s.levels).min().unwrap_or(LEVELS);
    let levels = |s: &[Setting]| (1..=most(s)).map(|k| s.iter().map(|s| s.at(k)).collect()).collect();
    groups.into_iter().map(|(what, s)| Refinement { what, levels: levels(&s) }).collect()
}

/// One setting.
#[derive(Debug, Clone, PartialEq)]
struct Setting {
    /// Its path.
    path: String,
    /// What is refined.
    group: String,
    /// Its value.
    value: f64,
    /// Whether it is a count.
    whole: bool,
    /// Unit behind the number.
    unit: String,
    /// By how much one level changes it.
    factor: f64,
    /// Most levels.
    levels: i32,
}

impl Setting {
    /// The change of a level; level 0 is the case as it stands.
    fn at(&self, level: i32) -> String {
        let value = self.value * self.factor.powi(level);
        // Without the rounding of the product: nobody writes a tolerance of 1.0000000000000001e-5.
        let value = format!("{value:.9e}").parse().unwrap_or(value);
        if self.whole {
            return format!("{}={:.0}", self.path, value);
        }
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        format!("{}={value:e}{unit}", self.path)
    }
}

/// All settings of a resolved case that refine its results.
fn settings(schema: &Schema, resolved: &Value) -> Vec<Setting> {
    let mut out = Vec::new();
    walk(schema, schema.root(), resolved, "", &mut out);
    out
}

fn walk(schemas: &Schema, schema: Part, value: &Value, path: &str, out: &mut Vec<Setting>) {
    let schema = schemas.resolve(schema);
    let schema = schemas.model_of_word(schema).map_or(schema, |models| schemas.resolve(models));
    match value {
        Value::Array(items) => {
            let Some(inner) = schema.get("items") else { return };
            for (k, v) in items.iter().enumerate() {
                walk(schemas, inner, v, &join(path, k), out);
            }
        }
        Value::Object(table) => {
            let own = match schemas.tagged(schema) {
                Some(t) => table
                    .get(t.tag)
                    .and_then(Value::as_str)
                    .and_then(|name| t.variants.iter().find(|(n, _)| *n == name))
                    .map(|(_, s)| *s),
                None => Some(schema),
            };
            let Some(properties) = own.and_then(|s| s.get("properties")).and_then(Value::as_object) else {
                return;
            };
            for (key, v) in table {
                let Some(field) = properties.get(key) else { continue };
                let path = join(path, key);
                match field.get("x-refine").and_then(|how| setting(how, v, &path)) {
                    Some(s) => out.push(s),
                    None => walk(schemas, field, v, &path, out),
                }
            }
        }
        _ => {}
    }
}

fn setting(how: &Value, value: &Value, path: &str) -> Option<Setting> {
    let text = value.as_str().unwrap_or_default();
    let (number, unit) = text.split_once(' ').unwrap_or((text, ""));
    let number = value.as_f64().or_else(|| number.parse().ok()).filter(|v| *v != 0.0)?;
    Some(Setting {
        path: path.to_owned(),
        group: how.get("group")?.as_str()?.to_owned(),
        value: number,
        whole: value.is_u64(),
        unit: unit.to_owned(),
        factor: how.get("factor")?.as_f64()?,
        levels: how.get("levels").and_then(Value::as_i64).map_or(LEVELS, |n| n.clamp(1, 3) as i32),
    })
}
