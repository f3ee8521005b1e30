//! States, memory and columns of a running model.

use std::collections::BTreeSet;

use gudgeon_core::states::{Signals, Stateful};

/// Complaints about what a running model declares: names of states and columns that are empty or stand twice, scales that are not positive, initial states
/// that are not finite or below their `least`, memory that does not come back, columns that are recorded otherwise than declared.
///
/// The states are left as they begin ([`Stateful::initial`]).
pub fn stateful(model: &mut dyn Stateful) -> Vec<String> {
    let states = model.states().to_vec();
    let mut wrong = distinct("state", states.iter().map(|s| s.name.clone()));
    let mut y = vec![f64::NAN; states.len()];
    model.initial(&mut y);
    for (s, y) in states.iter().zip(&y) {
        for (what, scale) in [("scale", s.scale), ("cycle_scale", s.cycle_scale)] {
            if !(scale > 0.0 && scale.is_finite()) {
                wrong.push(format!("the {what} of `{}` is {scale}", s.name));
            }
        }
        if !y.is_finite() || *y < s.cycle_min {
            wrong.push(format!("`{}` begins at {y}, the minimum is {}", s.name, s.cycle_min));
        }
    }
    wrong.extend(memory(model));
    let columns = model.columns();
    wrong.extend(distinct("column", columns.iter().map(|c| c.name.clone())));
    let mut row = Vec::new();
    model.record(&y, &mut row);
    if row.len() != columns.len() {
        wrong.push(format!("{} values are recorded in {} columns", row.len(), columns.len()));
    }
    wrong
}

fn memory(model: &mut dyn Stateful) -> Vec<String> {
    let (mut saved, mut again) = (Vec::new(), Vec::new());
    model.save(&mut saved);
    // What follows belongs to others and must be left.
    let own = saved.len();
    saved.push(f64::NAN);
    let taken = model.restore(&saved);
    model.save(&mut again);
    let mut wrong = Vec::new();
    if taken != own {
        wrong.push(format!("{own} values of memory are saved and {taken} are taken back"));
    }
    let bits = |v: &[f64]| v.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    if bits(&again) != bits(&saved[..own]) {
        wrong.push(format!("the memory {:?} comes back as {again:?}", &saved[..own]));
    }
    wrong
}

fn distinct(what: &str, names: impl Iterator<Item = String>) -> Vec<String> {
    let mut seen = BTreeSet::new();
    let mut wrong = Vec::new();
    for name in names {
        if name.trim().is_empty() {
            wrong.push(format!("a {what} has no name"));
        }
        if !seen.insert(name.clone()) {
            wrong.push(format!("the {what} `{name}` stands twice"));
        }
    }
    wrong
}

/// Complaints when a model reads more than it `declared` ([`Stateful::reads`]): the structure of Jacobians follows from the declaration, so an input
/// that is read and not declared leaves a hole in them.
///
/// `rates` gives the rates of the model for `inputs`; each input has the signal it belongs to, its value and another value that it may have. Of an input
/// that is not declared, no bit of any rate may depend.
pub fn reads(
    declared: Signals,
    inputs: &[(Signals, f64, f64)],
    values: usize,
    mut rates: impl FnMut(&[f64], &mut [f64]),
) -> Vec<String> {
    let mut x: Vec<f64> = inputs.iter().map(|i| i.1).collect();
    let (mut base, mut moved) = (vec![0.0; values], vec![0.0; values]);
    rates(&x, &mut base);
    let mut wrong = Vec::new();
    for (k, (signal, value, other)) in inputs.iter().enumerate() {
        if declared.meets(*signal) {
            continue;
        }
        x[k] = *other;
        rates(&x, &mut moved);
        x[k] = *value;
        if let Some(i) = (0..values).find(|&i| base[i].to_bits() != moved[i].to_bits()) {
            wrong.push(format!("rate {i} depends on input {k}, whose signal {signal:?} is not declared"));
        }
    }
    wrong
}
