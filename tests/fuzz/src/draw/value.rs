//! New values: plausible ones, which an engineer might mean, and wild ones.

use fastrand::Rng;
use serde_json::Value;

use super::{Draft, Draw, New, quantity};
use crate::sites::{Site, What};
use crate::text::rounded;
use gudgeon_core::elementary;

/// Plausible steps of a series, in degrees.
const SERIES_STEPS: [f64; 7] = [0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0];
/// Quantities move between 0.7 and 1/0.7 of what they are, most of them less.
const LEAST: f64 = 0.7;
/// How much of that range is used, one as often as another.
const SPREADS: [f64; 3] = [1.0, 0.3, 0.1];
/// Absolute temperatures move by a tenth: 0.7 of them is another machine.
const WARMER: f64 = 0.1;
/// Numbers that stand for no quantity.
const ODD: [f64; 8] = [0.0, -1.0, 1e300, -1e300, 1e-300, 1e18, 1e-18, f64::MIN_POSITIVE];
/// Texts that no value is.
const WRONG: [&str; 12] = [
    "banana",
    "\"\"",
    "[]",
    "{}",
    "true",
    "nan",
    "-inf",
    "3 parsecs",
    "1979-05-27",
    "[[[]]]",
    "\"0,5 mm\"",
    "{ model = \"banana\" }",
];

impl Draw<'_> {
    pub(super) fn plausible(&self, rng: &mut Rng, site: &Site, draft: &Draft<'_>) -> Option<New> {
        match &site.what {
            What::Number { value, unit, dimension, bound } => {
                if site.path.ends_with("series_step") {
                    return Some(New::text(format!("{} deg", rng.choice(SERIES_STEPS)?)));
                }
                let new = match neighbours(&draft.doc, &site.path) {
                    Neighbours::None => scaled(rng, *value, dimension),
                    Neighbours::End => return None,
                    Neighbours::Between(a, b) => a + (b - a) * (0.1 + 0.8 * rng.f64()),
                };
                let new = if bound.starts_with("between 0 and 1") { new.min(1.0) } else { new };
                // A zero has no scale.
                (new != *value && *value != 0.0).then(|| quantity(rounded(new), unit))
            }
            What::Whole(v) if *v > 0 => {
                // Counts are at most tripled: more is a question of patience.
                let new = (*v as f64 * elementary::powf(3.0, 2.0 * rng.f64() - 1.0)).round().max(1.0) as i64;
                Some(New::of((if new == *v { v + 1 } else { new }).into()))
            }
            What::Switch(b) => Some(New::of((!b).into())),
            What::Word { others, .. } => Some(New::of(rng.choice(others)?.as_str().into())),
            What::Table { others } => Some(New::of(rng.choice(others)?.clone())),
            What::Model { kind } => self.model(rng, kind, &draft.doc, &site.path),
            What::List(items) if !items.is_empty() => {
                let mut items = items.clone();
                let k = rng.usize(0..items.len());
                if rng.bool() && items.len() > 1 {
                    items.remove(k);
                } else {
                    items.insert(k, items[k].clone());
                }
                Some(New::of(items.into()))
            }
            What::Results => {
                let all = &draft.base.results;
                let n = rng.usize(1..=3);
                let names: Vec<Value> =
                    (0..n).filter_map(|_| rng.choice(all)).map(|s| s.as_str().into()).collect();
                (!names.is_empty()).then(|| New::of(names.into()))
            }
            What::Whole(_) | What::List(_) | What::Text | What::Part { .. } => None,
        }
    }

    /// A legal model of a kind: mostly the table of its registered example, now and then its name alone, which keeps the keys that it
    /// shares with the one there.
    fn model(&self, rng: &mut Rng, kind: &str, doc: &Value, path: &str) -> Option<New> {
        let model = rng.choice(self.registry.models(kind))?;
        let there = doc.pointer(&format!("/{}", path.replace('.', "/"))).is_some_and(Value::is_object);
        if there && rng.f64() < 0.2 {
            return Some(New { below: ".model", ..New::text(model.name) });
        }
        let mut table = serde_json::Map::new();
        table.insert("model".into(), model.name.into());
        let example: toml::Table = model.example.parse().ok()?;
        table.extend(serde_json::to_value(example).ok()?.as_object()?.clone());
        let text = crate::text::inline(&Value::Object(table.clone()));
        let value = (self.registry.kind(kind)?.resolve)(table.into()).unwrap_or_default();
        Some(New { text, value, below: "" })
    }

    pub(super) fn wild_value(&self, rng: &mut Rng, site: &Site) -> Option<New> {
        if rng.f64() < 0.06 {
            return Some(New::text(*rng.choice(&WRONG)?));
        }
        match &site.what {
            What::Number { value, unit, .. } => {
                let scale = if *value == 0.0 { 1.0 } else { *value };
                let new = match rng.u8(0..10) {
                    0 => rng.choice(ODD)?,
                    1 => -scale,
                    2 => 0.0,
                    _ => rounded(scale * elementary::powf(10.0, 12.0 * rng.f64() - 6.0)),
                };
                Some(New { value: Value::Null, ..quantity(new, unit) })
            }
            What::Whole(v) => {
                let some = [0, -1, 1, 2, 3, v.saturating_mul(100), 100_000, 4_294_967_295, i64::MAX];
                Some(New::text(rng.choice(some)?.to_string()))
            }
            What::List(items) => Some(match rng.u8(0..4) {
                0 => New::text("[]"),
                1 => New::text("7"),
                2 => New::text(crate::text::inline(&items.iter().rev().cloned().collect::<Vec<_>>().into())),
                _ => {
                    let one = rng.choice(items)?;
                    New::text(crate::text::inline(&vec![one.clone(); 60].into()))
                }
            }),
            What::Model { .. } => {
                // A model of another kind.
                let kinds: Vec<_> = self.registry.kinds().collect();
                let kind = rng.choice(&kinds)?;
                let model = rng.choice(self.registry.models(kind.kind))?;
                Some(New { below: ".model", ..New::text(model.name) })
            }
            What::Results => {
                Some(New::text(rng.choice(["[]", "[\"banana\"]", "[\"all\", \"all\"]", "[\"\"]"])?))
            }
            What::Word { .. } | What::Switch(_) | What::Table { .. } | What::Text => {
                Some(New::text(*rng.choice(&WRONG)?))
            }
            What::Part { .. } => None,
        }
    }
}

fn scaled(rng: &mut Rng, value: f64, dimension: &str) -> f64 {
    let spread = rng.choice(SPREADS).unwrap_or(1.0);
    let u = spread * (2.0 * rng.f64() - 1.0);
    match dimension {
        "a temperature" => value * (1.0 + WARMER * u),
        _ => value * elementary::exp(-u * elementary::ln(LEAST)),
    }
}

/// What stands beside a number in a list that rises or falls.
enum Neighbours {
    /// It stands in no such list.
    None,
    /// It is the first or the last: the range of the list.
    End,
    /// The values before and behind it.
    Between(f64, f64),
}

fn neighbours(doc: &Value, path: &str) -> Neighbours {
    let Some((list, k)) = path.rsplit_once('.') else { return Neighbours::None };
    let (Some(Value::Array(items)), Ok(k)) =
        (doc.pointer(&format!("/{}", list.replace('.', "/"))), k.parse::<usize>())
    else {
        return Neighbours::None;
    };
    let number = |v: &Value| v.as_f64().or_else(|| v.as_str()?.split(' ').next()?.parse().ok());
    let values: Vec<f64> = items.iter().filter_map(number).collect();
    let ordered = |f: fn(&f64, &f64) -> bool| values.windows(2).all(|w| f(&w[0], &w[1]));
    if values.len() < 3 || values.len() != items.len() || !(ordered(f64::lt) || ordered(f64::gt)) {
        return Neighbours::None;
    }
    match (k.checked_sub(1).and_then(|i| values.get(i)), values.get(k + 1)) {
        (Some(a), Some(b)) => Neighbours::Between(*a, *b),
        _ => Neighbours::End,
    }
}
