//! Sliders and choices, made from the inputs of a case.

use gudgeon_case::{Input, InputValue, NumberInput};
use gudgeon_core::elementary;
use serde::Serialize;
use serde_json::Value;

use crate::shown::{Shown, fits};

/// Least and most sliders that a case shows by itself.
const SLIDERS: std::ops::RangeInclusive<usize> = 4..=10;

/// An input that a person moves.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Slider {
    /// Path, as `--set` takes it.
    pub path: String,
    /// Name for a person.
    pub label: String,
    /// What it belongs to: `ring 1`.
    pub of: String,
    /// What it is.
    pub about: String,
    /// Unit; empty where there is none.
    pub unit: String,
    /// The value of the case, in the unit.
    pub value: f64,
    /// Where the slider begins.
    pub low: f64,
    /// Where it ends.
    pub high: f64,
    /// By how much a key moves it.
    pub step: f64,
    /// Whether it is shown before a person asks for it.
    pub first: bool,
}

/// A model or a word that a person may choose.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Choice {
    /// Path, as `--set` takes it.
    pub path: String,
    /// Name for a person.
    pub label: String,
    /// What it belongs to.
    pub of: String,
    /// The kind of the models; empty for other words.
    pub kind: String,
    /// What is chosen.
    pub value: String,
    /// What may be chosen: name and meaning.
    pub words: Vec<(String, String)>,
}

/// All sliders of a case, those that are shown first before the others.
#[must_use]
pub fn sliders(inputs: &[Input], resolved: &Value, shown: Option<&Shown>) -> Vec<Slider> {
    let all: Vec<(&Input, &NumberInput)> = inputs
        .iter()
        .filter_map(|i| match &i.value {
            InputValue::Number(n) if n.value.is_finite() => Some((i, n)),
            _ => None,
        })
        .collect();
    let mut first: Vec<usize> = Vec::new();
    for pattern in shown.map_or(&[][..], |s| s.sliders) {
        let found = (0..all.len()).filter(|k| fits(pattern, &all[*k].0.path) && all[*k].1.value != 0.0);
        first.extend(found.filter(|k| !first.contains(k)).collect::<Vec<_>>());
    }
    first.truncate(*SLIDERS.end());
    // What the text itself gives is what its author thought of, but settings of the solver are not what a slider is for.
    let given = |k: &usize| {
        let (input, number) = all[*k];
        let numerics =
            ["solver", "outputs", "sweeps", "conventions"].iter().any(|t| input.path.starts_with(t));
        input.line.is_some() && number.value != 0.0 && !numerics && !first.contains(k)
    };
    let more: Vec<usize> = (0..all.len()).filter(given).collect();
    let missing = SLIDERS.start().saturating_sub(first.len());
    first.extend(more.into_iter().take(if first.len() < *SLIDERS.start() { missing.max(2) } else { 0 }));
    let rest = (0..all.len()).filter(|k| !first.contains(k)).map(|k| (k, false)).collect::<Vec<_>>();
    let order = first.iter().map(|k| (*k, true)).chain(rest);
    order.map(|(k, first)| slider(all[k].0, all[k].1, resolved, first)).collect()
}

/// The choices of a case: its models before other words.
#[must_use]
pub fn choices(inputs: &[Input]) -> Vec<Choice> {
    let mut all: Vec<Choice> = inputs
        .iter()
        .filter_map(|i| match &i.value {
            InputValue::Choice(c) if c.words.count() > 1 => {
                let path = i.path.strip_suffix(".model").unwrap_or(&i.path);
                let (label, of) = names(path);
                let (value, words) = (c.value.clone(), c.words.told().collect());
                Some(Choice { path: i.path.clone(), label, of, kind: c.kind.clone(), value, words })
            }
            _ => None,
        })
        .collect();
    all.sort_by_key(|c| c.kind.is_empty());
    all
}

fn slider(input: &Input, n: &NumberInput, resolved: &Value, first: bool) -> Slider {
    let (label, of) = names(&input.path);
    let of = name_of(&input.path, resolved).map_or(of.clone(), |name| format!("{of}: {name}"));
    let (low, high, step) = range(n);
    Slider {
        path: input.path.clone(),
        label,
        of,
        about: input.about.told(),
        unit: n.unit.clone(),
        value: n.value,
        low,
        high,
        step,
        first,
    }
}

/// `rings.0.cold_gap` as `Cold gap` of `ring 1`.
fn names(path: &str) -> (String, String) {
    let steps: Vec<&str> = path.split('.').collect();
    let (last, above) = steps.split_last().map_or(("", &[][..]), |(l, a)| (*l, a));
    let plain = |s: &str| s.replace('_', " ");
    let mut of: Vec<String> = Vec::new();
    for step in above.iter().filter(|s| **s != "models") {
        match (step.parse::<usize>(), of.last_mut()) {
            (Ok(k), Some(family)) => {
                *family = format!("{} {}", family.strip_suffix('s').unwrap_or(family), k + 1)
            }
            _ => of.push(plain(step)),
        }
    }
    let mut label = plain(last);
    if ["tdc", "bdc"].contains(&last) {
        label.make_ascii_uppercase();
    }
    if let Some(c) = label.get_mut(..1) {
        c.make_ascii_uppercase();
    }
    (label, of.join(", "))
}

/// The name that an entry of an array gives itself.
fn name_of<'a>(path: &str, resolved: &'a Value) -> Option<&'a str> {
    let steps: Vec<&str> = path.split('.').collect();
    let at = steps.iter().position(|s| s.parse::<usize>().is_ok())?;
    resolved.pointer(&format!("/{}/name", steps[..=at].join("/")))?.as_str().filter(|name| !name.is_empty())
}

/// Ends and step of a slider around a value.
fn range(n: &NumberInput) -> (f64, f64, f64) {
    let v = n.value;
    let (low, high) = match n.dimension.as_str() {
        "a temperature" => (v - 40.0, v + 40.0),
        _ if v == 0.0 => (-1.0, 1.0),
        _ => ((0.5 * v).min(1.5 * v), (0.5 * v).max(1.5 * v)),
    };
    let raw = (high - low) / 100.0;
    let decade = elementary::powf(10f64, elementary::log10(raw).floor());
    let nice =
        [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * decade).find(|s| *s >= raw * 0.999).unwrap_or(decade);
    let step = if n.whole { nice.round().max(1.0) } else { nice };
    let grid = |x: f64, up: bool| {
        let k = if up { (x / step - 1e-9).ceil() } else { (x / step + 1e-9).floor() };
        // Without the rounding of the product.
        format!("{:.9e}", k * step).parse().unwrap_or(x)
    };
    let (mut low, mut high): (f64, f64) = (grid(low, false), grid(high, true));
    // Zero itself is often not admitted where only what is below it is forbidden.
    if let Some(least) = n.least {
        low = if low <= least {
            if v > least { least + step.min(0.5 * (v - least)) } else { least }
        } else {
            low
        };
    }
    if let Some(most) = n.most {
        high = high.min(most);
    }
    (low.min(v), high.max(v), step)
}
