//! The numerical settings of a case that refine its results: tolerances, grids, orders.
//!
//! A field says so itself, in its schema: `x-refine` holds the name of what is refined (`tolerance`, `film grid`; settings of one name are
//! refined together), the `factor` of one level, and possibly `levels`, how many of them are worth their time (a plane grid has four times the
//! nodes a level). A name that ends in `tolerance` says that the value is a relative error that is asked for. So a model that is registered
//! elsewhere is verified, and raced by `bench`, like a built-in one.

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
    /// The settings as they stand.
    pub own: Level,
    /// Finer settings, the mildest first: as many as are worth their time.
    pub levels: Vec<Level>,
    /// Coarser settings, the mildest first. A case may refuse some of them.
    pub coarser: Vec<Level>,
}

/// A group of settings at one level of refinement.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// The settings as `--set` takes them.
    pub set: Vec<String>,
    /// The settings in words: `panels 200`.
    pub words: String,
    /// The relative error that they ask for, the largest of the group. Only what is named a tolerance asks for an error; a grid or a step does
    /// not know its own.
    pub asked: Option<f64>,
}

/// The settings of a resolved case that refine its results, by what they refine.
pub(super) fn refinements(schema: &Schema, resolved: &Value) -> Vec<Refinement> {
    let mut groups: IndexMap<String, Vec<Setting>> = IndexMap::new();
    for s in settings(schema, resolved) {
        groups.entry(s.group.clone()).or_default().push(s);
    }
    let group = |(what, s): (String, Vec<Setting>)| {
        let most = s.iter().map(|s| s.levels).min().unwrap_or(LEVELS);
        let coarsest = (1..=LEVELS).take_while(|k| s.iter().all(|s| s.exists_at(-k))).last().unwrap_or(0);
        Refinement {
            own: level(&what, &s, 0),
            levels: (1..=most).map(|k| level(&what, &s, k)).collect(),
            coarser: (1..=coarsest).map(|k| level(&what, &s, -k)).collect(),
            what,
        }
    };
    groups.into_iter().map(group).collect()
}

/// What the name of a group ends in whose settings are relative errors that are asked for.
const TOLERANCE: &str = "tolerance";

fn level(what: &str, settings: &[Setting], k: i32) -> Level {
    let mut words: Vec<String> = settings.iter().map(|s| s.words(k)).collect();
    words.dedup();
    let largest = settings.iter().map(|s| s.value_at(k)).reduce(f64::max);
    Level {
        set: settings.iter().map(|s| s.at(k)).collect(),
        words: words.join(", "),
        asked: largest.filter(|_| what.ends_with(TOLERANCE)),
    }
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
    /// The value at a level; level 0 is the case as it stands, negative levels are coarser.
    fn value_at(&self, level: i32) -> f64 {
        let value = self.value * self.factor.powi(level);
        // Without the rounding of the product: nobody writes a tolerance of 1.0000000000000001e-5.
        let value: f64 = format!("{value:.9e}").parse().unwrap_or(value);
        if self.whole { value.round() } else { value }
    }

    /// Whether a count is still one at a level, and another than at the level before.
    fn exists_at(&self, level: i32) -> bool {
        !self.whole || self.value_at(level) >= 1.0 && self.value_at(level) < self.value_at(level + 1)
    }

    /// The value with its unit.
    fn text_at(&self, level: i32) -> String {
        let value = self.value_at(level);
        if self.whole {
            return format!("{value:.0}");
        }
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        format!("{value:e}{unit}")
    }

    /// The change of a level.
    fn at(&self, level: i32) -> String {
        format!("{}={}", self.path, self.text_at(level))
    }

    /// The setting in words.
    fn words(&self, level: i32) -> String {
        let name = self.path.rsplit('.').next().unwrap_or_default().replace('_', " ");
        let value = self.value_at(level);
        let plain = !self.whole && (1e-2..1e4).contains(&value.abs());
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        if plain { format!("{name} {value}{unit}") } else { format!("{name} {}", self.text_at(level)) }
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
                walk(schemas, inner, v, &join(path, &k.to_string()), out);
            }
        }
        Value::Object(table) => {
            let own = match schemas.tagged(schema) {
                Some(t) => table.get(t.tag).and_then(Value::as_str).and_then(|name| t.variant(schemas, name)),
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
