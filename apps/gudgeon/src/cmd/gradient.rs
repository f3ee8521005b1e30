//! `gudgeon gradient CASE`

use std::fmt::Write as _;

use gudgeon_core::result::{Gradients, NoteLevel};

use crate::args::GradientArgs;
use crate::cmd::{checked, open_out};
use crate::failure::Failure;
use crate::ui::{Ui, number, table, unit, wrapped};

pub fn gradient(a: &GradientArgs, ui: &Ui) -> Result<(), Failure> {
    let c = checked(&a.case.case, &a.case.set, ui)?;
    let folder =
        if a.json { None } else { Some(open_out(a.out.as_deref(), &a.case.case, &c.name, "-gradient")?) };
    let found = {
        let bar = ui.bar();
        let mut show = |p| bar.show(p);
        if a.by_runs {
            let mut all = gudgeon_study::gradients::differences(&c, &a.by, &mut show)?;
            all.results.retain(|name, _| a.results.is_empty() || a.results.contains(name));
            all
        } else {
            gudgeon_study::gradients::gradients(&c, &a.by, &a.results, &mut show)?
        }
    };
    match folder {
        None => ui.out(gudgeon_report::gradients_json(&found).trim_end()),
        Some(folder) => {
            let path = gudgeon_report::write_gradients_in(&found, folder)?;
            if !ui.quiet() {
                let body = if a.results.is_empty() { all(&found) } else { listed(&found) };
                ui.out(&format!("{}: {}\n\n{body}{}{}", c.name, c.title(), told(&found), path.display()));
            }
        }
    }
    match found.notes.iter().find(|n| n.level == NoteLevel::Failure) {
        Some(n) => Err(Failure::Run(n.text.clone())),
        None => Ok(()),
    }
}

/// Inputs by their weight on a result, the heaviest first; those without a derivative last.
fn order(g: &Gradients, result: &str) -> Vec<usize> {
    let weight = |k: usize| g.elasticity(result, k).map_or(-1.0, f64::abs);
    let mut all: Vec<usize> = (0..g.inputs.len()).collect();
    all.sort_by(|a, b| weight(*b).total_cmp(&weight(*a)));
    all
}

/// Why a result has no derivative by an input.
const NONE_HERE: &str = "none here: the result has a corner or a jump here, or changes by less than what its solver leaves open; \
    two values that lie farther apart tell more (`gudgeon compare --swap`)";

/// Every result with its inputs, the one that it depends on most first.
fn listed(g: &Gradients) -> String {
    let mut out = String::new();
    for (name, result) in &g.results {
        // Writing to a String cannot fail.
        let _ = writeln!(out, "  {name} = {} {}", number(result.value.value), unit(&result.value.unit));
        let mut rows =
            vec![["input", "value", "", "part per part", "derivative", ""].map(str::to_owned).to_vec()];
        for k in order(g, name) {
            let i = &g.inputs[k];
            let (derivative, units) = match result.by.get(k).copied().flatten() {
                Some(d) => (number(d), unit(&g.unit(name, k).unwrap_or_default())),
                None => ("none here".into(), String::new()),
            };
            let elasticity = g.elasticity(name, k).map_or("-".into(), |e| format!("{e:+.4}"));
            rows.push(vec![i.path.clone(), number(i.value), unit(&i.unit), elasticity, derivative, units]);
        }
        let _ = writeln!(out, "{}", table(&rows, &[1, 3, 4]));
        if result.by.iter().any(Option::is_none) {
            out.push_str(&wrapped(NONE_HERE, 2));
            out.push('\n');
        }
    }
    out
}

/// All results: by which part of itself each changes with a part of the inputs. Inputs and results that matter most come first.
fn all(g: &Gradients) -> String {
    let weight = |name: &String, k: usize| g.elasticity(name, k).map_or(0.0, f64::abs);
    let mut columns: Vec<usize> = (0..g.inputs.len()).collect();
    let of_input = |k: usize| g.results.keys().map(|r| weight(r, k).min(10.0)).sum::<f64>();
    columns.sort_by(|a, b| of_input(*b).total_cmp(&of_input(*a)));
    let mut head = vec!["part per part".to_owned(), "value".to_owned(), String::new()];
    head.extend(columns.iter().enumerate().map(|(at, _)| format!("[{}]", at + 1)));
    let mut rows = vec![head];
    for (name, result) in &g.results {
        let mut row = vec![name.clone(), number(result.value.value), unit(&result.value.unit)];
        row.extend(columns.iter().map(|k| g.elasticity(name, *k).map_or("-".into(), |e| format!("{e:+.3}"))));
        rows.push(row);
    }
    let right: Vec<usize> = std::iter::once(1).chain(3..3 + columns.len()).collect();
    let mut out = String::new();
    for (at, k) in columns.iter().enumerate() {
        let i = &g.inputs[*k];
        let _ = writeln!(out, "  [{}] {} = {} {}", at + 1, i.path, number(i.value), unit(&i.unit));
    }
    out + "\n" + &table(&rows, &right) + "\n"
}

/// How the derivatives were found, and what there is to know of them.
fn told(g: &Gradients) -> String {
    let mut out = wrapped(&g.method, 2) + "\n";
    for n in &g.notes {
        out.push_str(&wrapped(&n.text, 2));
        out.push('\n');
    }
    out + "\n"
}
