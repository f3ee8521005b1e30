//! What results do over the sweeps of a case, for the terminal: a table of one input, a grid of two.

use std::fmt::Write as _;

use gudgeon_core::result::{Figure, FigureKind, Lines, RunResult, Series};
use gudgeon_scene::Sweep;

use super::spark::{change, chosen, course, line, range};
use crate::ui::{number, table, unit, wrapped};

/// Values of an input that stand side by side.
const COLUMNS: usize = 6;
/// Values of a second input that stand below each other.
const ROWS: usize = 12;
/// Characters of a value that is no number.
const LABEL: usize = 14;

/// One input: where it stands, and its values in short.
struct Input {
    path: String,
    unit: String,
    labels: Vec<String>,
}

/// The trends of a run with sweeps; nothing for one without. `blocks`: whether the terminal shows block characters.
pub fn text(sweeps: &[Sweep], r: &RunResult, blocks: bool) -> String {
    let Some(sheet) = r.tables.get("sweep") else { return String::new() };
    let inputs: Vec<Input> = sweeps.iter().filter_map(input).collect();
    let drawn: Vec<(&str, Vec<&[f64]>)> =
        r.figures.iter().filter(|f| f.table == "sweep").filter_map(|f| rows_of(f, sheet, &inputs)).collect();
    match &inputs[..] {
        [one] => over_one(one, &drawn, r, blocks),
        [across, down] => {
            drawn.iter().map(|(name, rows)| grid(name, rows, across, down, r, blocks)).collect()
        }
        _ => String::new(),
    }
}

fn input(sweep: &Sweep) -> Option<Input> {
    let values = gudgeon_scene::values(&sweep.axis).ok()?;
    let numbers: Option<Vec<(f64, &str)>> = values.iter().map(|v| gudgeon_scene::number(v)).collect();
    let path = sweep.axis.path.clone();
    Some(match numbers {
        Some(n) if n.iter().all(|(_, u)| *u == n[0].1) => Input {
            path,
            unit: n.first().map_or("", |(_, u)| u).to_owned(),
            labels: n.iter().map(|(v, _)| plain(*v)).collect(),
        },
        _ => Input { path, unit: String::new(), labels: values.iter().map(|v| short(v)).collect() },
    })
}

/// A number without zeros at its end: what a person has written, or nearly.
fn plain(v: f64) -> String {
    let text = number(v);
    if text.contains('.') && !text.contains('e') {
        return text.trim_end_matches('0').trim_end_matches('.').to_owned();
    }
    text
}

/// A value that is no number: a model with its settings by its name alone, anything else by its beginning.
fn short(value: &str) -> String {
    let model = value.split_once("model").filter(|_| value.trim_start().starts_with('{'));
    let name = model.and_then(|(_, rest)| rest.split('"').nth(1)).unwrap_or(value).trim_matches('"');
    if name.chars().count() <= LABEL {
        return name.to_owned();
    }
    name.chars().take(LABEL - 2).chain("..".chars()).collect()
}

/// The result that a figure shows, and its values: a row for each value of the second input.
fn rows_of<'a>(f: &'a Figure, sheet: &'a Series, inputs: &[Input]) -> Option<(&'a str, Vec<&'a [f64]>)> {
    let column = |name: &str| sheet.get(name).map(|c| c.values.as_slice());
    match &f.kind {
        FigureKind::Lines(Lines { lines, .. }) => {
            let first = lines.first()?.1.as_str();
            // A curve for each value of the second input is called by the result and that value.
            let name =
                if lines.len() > 1 || inputs.len() > 1 { result_of(first, &lines[0].0) } else { first };
            Some((name, lines.iter().filter_map(|(_, c)| column(c)).collect()))
        }
        FigureKind::Map { value, .. } => {
            let across = inputs.first()?.labels.len().max(1);
            Some((value, column(value)?.chunks(across).collect()))
        }
        _ => None,
    }
}

/// `blow_by` of `blow_by.2_mm`.
fn result_of<'a>(column: &'a str, label: &str) -> &'a str {
    let ending = label.replace(' ', "_");
    column.strip_suffix(&ending).map_or(column, |c| c.trim_end_matches('.'))
}

fn heading(across: &Input, names: &[usize]) -> Vec<String> {
    names.iter().map(|k| across.labels[*k].clone()).collect()
}

fn with_unit(text: &str, u: &str) -> String {
    if u.is_empty() { text.to_owned() } else { format!("{text} [{u}]") }
}

/// One row a result: values at some places, the line over all of them, how it goes, and the change from the first to the last.
fn over_one(over: &Input, drawn: &[(&str, Vec<&[f64]>)], r: &RunResult, blocks: bool) -> String {
    let shown = chosen(over.labels.len(), COLUMNS);
    let mut head = vec![with_unit(&over.path, &over.unit), String::new()];
    head.extend(heading(over, &shown));
    let mut rows = vec![head];
    for (name, values) in drawn.iter().filter_map(|(n, rows)| Some((n, *rows.first()?))) {
        let mut row = vec![(*name).to_owned(), unit(&unit_of(name, r))];
        row.extend(shown.iter().map(|k| cell(values, *k)));
        row.extend(blocks.then(|| range(values).map_or_else(String::new, |lo_hi| line(values, lo_hi))));
        row.push(course(values, &over.labels));
        row.push(change(values));
        rows.push(row);
    }
    let right: Vec<usize> = (2..2 + shown.len()).chain([3 + usize::from(blocks) + shown.len()]).collect();
    let hidden = over.labels.len() - shown.len();
    let of =
        if hidden > 0 { format!(", {} of {} values", shown.len(), over.labels.len()) } else { String::new() };
    format!("\n  Over {}{of}; change from the first to the last\n{}", over.path, table(&rows, &right))
}

/// A result over two inputs: a row for each value of the second.
fn grid(name: &str, rows: &[&[f64]], across: &Input, down: &Input, r: &RunResult, blocks: bool) -> String {
    let columns = chosen(across.labels.len(), COLUMNS);
    let lines = chosen(rows.len().min(down.labels.len()), ROWS);
    let all: Vec<f64> = rows.iter().flat_map(|row| row.iter().copied()).collect();
    let Some(lo_hi) = range(&all) else { return String::new() };
    let mut head = vec![with_unit(&down.path, &down.unit)];
    head.extend(heading(across, &columns));
    let mut cells = vec![head];
    for k in &lines {
        let mut row = vec![down.labels[*k].clone()];
        row.extend(columns.iter().map(|c| cell(rows[*k], *c)));
        row.extend(blocks.then(|| line(rows[*k], lo_hi)));
        row.push(course(rows[*k], &across.labels));
        row.push(change(rows[*k]));
        cells.push(row);
    }
    let right: Vec<usize> = (1..1 + columns.len()).chain([2 + usize::from(blocks) + columns.len()]).collect();
    let mut s = format!(
        "\n  {} over {}\n",
        with_unit(name, &unit(&unit_of(name, r))),
        with_unit(&across.path, &across.unit)
    );
    s.push_str(&table(&cells, &right));
    s.push_str(&ends(rows, lo_hi, across, down));
    let hidden = rows.len() - lines.len();
    if hidden > 0 {
        // Writing to a String cannot fail.
        let _ = writeln!(s, "  {hidden} more values of {} in sweep.csv", down.path);
    }
    s
}

/// Where a grid is least and greatest.
fn ends(rows: &[&[f64]], (lo, hi): (f64, f64), across: &Input, down: &Input) -> String {
    let place = |v: f64| {
        let at = rows.iter().enumerate().find_map(|(i, row)| Some((i, row.iter().position(|x| *x == v)?)));
        let (i, k) = at.unwrap_or_default();
        let label = |input: &Input, k: usize| input.labels.get(k).cloned().unwrap_or_default();
        format!("{} at {}, {}", number(v), label(across, k), label(down, i))
    };
    wrapped(&format!("least {}; greatest {}", place(lo), place(hi)), 2)
}

fn cell(values: &[f64], k: usize) -> String {
    values.get(k).filter(|v| v.is_finite()).map_or_else(|| "-".into(), |v| number(*v))
}

/// The unit of a result: of the case itself, or of a column where the case has none.
fn unit_of(name: &str, r: &RunResult) -> String {
    let own = r.results.get(name).map(|v| v.unit.clone());
    own.or_else(|| {
        let columns = &r.tables.get("sweep")?.columns;
        let belongs = |c: &&str| *c == name || c.strip_prefix(name).is_some_and(|rest| rest.starts_with('.'));
        columns.iter().find(|c| belongs(&c.name.as_str())).map(|c| c.unit.clone())
    })
    .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_called_in_short() {
        assert_eq!(short("{ model = \"barus\", pressure_viscosity = \"18 1/GPa\" }"), "barus");
        assert_eq!(short("\"5W-30\""), "5W-30");
        assert_eq!(short("narrow_channel_with_a_long_name"), "narrow_chann..");
        assert_eq!([0.4, 1000.0, 533.333_333, 2e-9].map(plain), ["0.4", "1000", "533.33", "2.0000e-9"]);
        assert_eq!(result_of("fmep.2_mm", "2 mm"), "fmep");
    }
}
