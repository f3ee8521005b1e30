//! Sweeps: every combination of one or two varied inputs, each read and built as a case of its own.

use gudgeon_core::BuildError;
use gudgeon_core::result::{Column, Figure, FigureKind, RunResult, Series};

use super::case::{RigCase, Spacing, Sweep};
use super::variant;
use crate::load::Loaded;
use crate::run::{Progress, RunError};

/// Most runs of one sweep: at a millisecond each, a minute and a half.
const MOST: usize = 100_000;
/// Results drawn when none are named.
const DRAWN: usize = 6;

/// `"1.5 um"` as 1.5 and `um`; `"3"` as 3 and nothing.
fn number(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let (value, unit) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    value.parse::<f64>().ok().filter(|v| v.is_finite()).map(|v| (v, unit.trim()))
}

fn values(s: &Sweep) -> Result<Vec<String>, BuildError> {
    let ends = !s.from.is_empty() || !s.to.is_empty() || s.points != 0;
    if !s.values.is_empty() {
        return if ends {
            Err(BuildError::at("values", "a sweep has `values` or `from`, `to` and `points`, not both"))
        } else {
            Ok(s.values.clone())
        };
    }
    let (Some((a, unit)), Some((b, unit_b))) = (number(&s.from), number(&s.to)) else {
        let field = if number(&s.from).is_none() { "from" } else { "to" };
        return Err(BuildError::at(field, "a sweep needs `values`, or `from` and `to` with a number each")
            .help("for example `from = \"1 um\"`, `to = \"10 um\"`, `points = 10`"));
    };
    if unit != unit_b {
        return Err(BuildError::at(
            "to",
            format!("`from` and `to` must have the same unit, not `{unit}` and `{unit_b}`"),
        ));
    }
    let n = s.points as usize;
    if !(2..=MOST).contains(&n) {
        return Err(BuildError::at("points", format!("a sweep has 2 to {MOST} points, not {n}")));
    }
    if s.spacing == Spacing::Log && a * b <= 0.0 {
        return Err(BuildError::at("spacing", "equal ratios need two values of the same sign, neither zero"));
    }
    let at = |k: usize| {
        let f = k as f64 / (n - 1) as f64;
        match s.spacing {
            _ if k == 0 => a,
            _ if k == n - 1 => b,
            Spacing::Linear => a + f * (b - a),
            Spacing::Log => a * (b / a).powf(f),
        }
    };
    Ok((0..n)
        .map(|k| if unit.is_empty() { format!("{}", at(k)) } else { format!("{} {unit}", at(k)) })
        .collect())
}

/// What is wrong with the sweeps of a case.
pub fn legal(case: &RigCase) -> Vec<BuildError> {
    let mut errors = Vec::new();
    if case.sweeps.len() > 2 {
        errors.push(BuildError::at(
            "sweeps.2",
            "a case has one or two sweeps; more can be run from a script with `--set`",
        ));
    }
    let mut runs = 1usize;
    for (k, s) in case.sweeps.iter().enumerate() {
        match values(s) {
            Ok(v) => runs = runs.saturating_mul(v.len()),
            Err(e) => errors.push(e.within(&format!("sweeps.{k}"))),
        }
    }
    if runs > MOST {
        errors.push(BuildError::at("sweeps", format!("{runs} runs are more than {MOST}")));
    }
    errors
}

/// Name of a swept input as a column: the last part of its path.
fn short(path: &str) -> String {
    let parts: Vec<&str> = path.split('.').collect();
    match parts.as_slice() {
        [.., kind, "model"] => (*kind).to_owned(),
        [.., last] => (*last).to_owned(),
        [] => String::new(),
    }
}

/// The varied input as numbers with a unit, or its place in the list when it is not a number.
fn abscissa(s: &Sweep, values: &[String]) -> (Column, bool) {
    let numbers: Option<Vec<(f64, &str)>> = values.iter().map(|v| number(v)).collect();
    let name = short(&s.path);
    match numbers {
        Some(n) if n.iter().all(|(_, u)| *u == n[0].1) => {
            let unit = n.first().map_or("", |(_, u)| u).to_owned();
            (Column { name, unit, values: n.into_iter().map(|(v, _)| v).collect() }, true)
        }
        _ => {
            let places = (1..=values.len()).map(|k| k as f64).collect();
            (Column { name, unit: String::new(), values: places }, false)
        }
    }
}

/// Runs the sweeps of a case into the table `sweep` and its figures.
pub fn run(
    loaded: &Loaded<RigCase>,
    result: &mut RunResult,
    progress: &mut dyn FnMut(Progress),
) -> Result<(), RunError> {
    let sweeps = &loaded.value.sweeps;
    let Some(first) = sweeps.first() else { return Ok(()) };
    let refused = |e: BuildError| RunError::Refused(e.to_string());
    let a = values(first).map_err(refused)?;
    let b = match sweeps.get(1) {
        Some(s) => Some((s, values(s).map_err(refused)?)),
        None => None,
    };
    let (x, x_number) = abscissa(first, &a);
    let names: Vec<String> = result.results.keys().cloned().collect();
    let wanted = sweeps
        .iter()
        .find(|s| !s.results.is_empty())
        .map_or_else(|| names.iter().take(DRAWN).cloned().collect::<Vec<_>>(), |s| s.results.clone());
    if let Some(missing) = wanted.iter().find(|w| !names.contains(w)) {
        return Err(RunError::Refused(format!(
            "the sweep wants the result `{missing}`; {}",
            crate::load::advice(missing, &names.iter().map(String::as_str).collect::<Vec<_>>())
        )));
    }
    let outer: Vec<Option<String>> =
        b.as_ref().map_or_else(|| vec![None], |(_, v)| v.iter().cloned().map(Some).collect());
    // cells[outer][inner][result]
    let mut cells: Vec<Vec<Vec<f64>>> = Vec::new();
    let total = (outer.len() * a.len()) as f64;
    let mut failed = Vec::new();
    for (j, o) in outer.iter().enumerate() {
        let mut row = Vec::new();
        for (i, v) in a.iter().enumerate() {
            progress(Progress { phase: "sweeping".into(), fraction: (j * a.len() + i) as f64 / total });
            let mut set = vec![format!("{}={v}", first.path)];
            if let (Some((s, _)), Some(o)) = (&b, o) {
                set.push(format!("{}={o}", s.path));
            }
            row.push(match variant(loaded, &set) {
                Ok(out) => names.iter().map(|n| out.results.get(n).map_or(f64::NAN, |v| v.value)).collect(),
                Err(e) => {
                    failed.push(format!("{}: {e}", set.join(", ")));
                    vec![f64::NAN; names.len()]
                }
            });
        }
        cells.push(row);
    }
    if failed.len() == (outer.len() * a.len()) {
        return Err(RunError::Refused(format!(
            "no point of the sweep could be run; the first: {}",
            failed[0]
        )));
    }
    if let Some(f) = failed.first() {
        result
            .solver
            .notes
            .push(format!("{} of {total} points of the sweep have no result; the first: {f}", failed.len()));
    }
    let unit = |n: &str| result.results.get(n).map_or(String::new(), |v| v.unit.clone());
    let what = |n: &str| result.results.get(n).map_or(String::new(), |v| v.what.clone());
    let mut table = Series::default();
    let mut figures = Vec::new();
    match &b {
        None => {
            table.axis = x.clone();
            for (r, n) in names.iter().enumerate() {
                let v = cells[0].iter().map(|c| c[r]).collect();
                table.columns.push(Column { name: n.clone(), unit: unit(n), values: v });
            }
            for n in &wanted {
                figures.push(lines(what(n), first, &x.name, vec![(n.clone(), n.clone())]));
            }
        }
        Some((second, v)) => {
            let (y, y_number) = abscissa(second, v);
            if x_number && y_number && v.len() > 8 {
                table.axis =
                    Column { values: outer.iter().flat_map(|_| x.values.clone()).collect(), ..x.clone() };
                let across = y.values.iter().flat_map(|v| std::iter::repeat_n(*v, a.len())).collect();
                table.columns.push(Column { values: across, ..y.clone() });
                for (r, n) in names.iter().enumerate() {
                    let v = cells.iter().flatten().map(|c| c[r]).collect();
                    table.columns.push(Column { name: n.clone(), unit: unit(n), values: v });
                }
                for n in &wanted {
                    figures.push(Figure {
                        title: what(n),
                        hint: String::new(),
                        table: "sweep".into(),
                        kind: FigureKind::Map { x: x.name.clone(), y: y.name.clone(), value: n.clone() },
                    });
                }
            } else {
                // Few values, or names: a curve for each.
                table.axis = x.clone();
                for n in &wanted {
                    let r = names.iter().position(|m| m == n).unwrap_or(0);
                    let mut curves = Vec::new();
                    for (row, label) in cells.iter().zip(v) {
                        // A word that would read as a number stands in quotes.
                        let label = label.trim_matches('"');
                        let name = format!("{n}.{}", label.replace(' ', "_"));
                        table.columns.push(Column {
                            name: name.clone(),
                            unit: unit(n),
                            values: row.iter().map(|c| c[r]).collect(),
                        });
                        curves.push((label.to_owned(), name));
                    }
                    figures.push(lines(what(n), first, &x.name, curves));
                }
            }
        }
    }
    result.figures.extend(figures);
    result.tables.insert("sweep".into(), table);
    Ok(())
}

fn lines(title: String, s: &Sweep, x: &str, lines: Vec<(String, String)>) -> Figure {
    Figure {
        title,
        hint: format!("over {}", s.path),
        table: "sweep".into(),
        kind: FigureKind::Lines { x: x.into(), lines, log_x: s.spacing == Spacing::Log, log_y: false },
    }
}
