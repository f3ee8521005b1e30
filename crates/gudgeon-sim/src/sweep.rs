//! Sweeps: every combination of one or two varied inputs, each read and built as a case of its own.

use gudgeon_core::BuildError;
use gudgeon_core::result::{Column, Figure, FigureKind, Note, RunResult, Series};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::run::{Progress, RunError};
use crate::scene::{Scene, changed};

/// One varied input. Give `values`, or `from`, `to` and `points`.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sweep {
    /// Path of the input, `rig.speed` or `models.oil.model`.
    pub path: String,
    /// The values as a case would write them: `["1 um", "2 um"]`, `["complementarity", "elrod_adams"]`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub values: Vec<String>,
    /// First value, with its unit.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub from: String,
    /// Last value, in the same unit.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub to: String,
    /// Number of values between `from` and `to`, both included.
    #[serde(default)]
    pub points: u32,
    /// How they are spaced.
    #[serde(default)]
    pub spacing: Spacing,
    /// Results that the report draws over the sweep; empty: the first six.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub results: Vec<String>,
}

/// Spacing of the values of a sweep.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Spacing {
    /// Equal steps.
    #[default]
    Linear,
    /// Equal ratios.
    Log,
}

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
pub fn legal(sweeps: &[Sweep]) -> Vec<BuildError> {
    let mut errors = Vec::new();
    if sweeps.len() > 2 {
        errors.push(BuildError::at(
            "sweeps.2",
            "a case has one or two sweeps; more can be run from a script with `--set`",
        ));
    }
    let mut runs = 1usize;
    for (k, s) in sweeps.iter().enumerate() {
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

/// The change that each sweep begins with, with its number.
pub fn first_values(sweeps: &[Sweep]) -> Vec<(usize, String)> {
    let first = |s: &Sweep| values(s).ok().and_then(|v| v.first().map(|v| format!("{}={v}", s.path)));
    sweeps.iter().enumerate().filter_map(|(k, s)| first(s).map(|f| (k, f))).collect()
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

/// What curves are called: the values as written, but a model with its settings, `{ model = "barus", … }`, by its name alone where
/// that tells it from the others.
fn labels(values: &[String]) -> Vec<String> {
    let name = |v: &String| {
        let inside = v.trim().strip_prefix('{')?;
        let (_, after) = inside.split_once("model")?;
        Some(after.trim_start().strip_prefix('=')?.trim_start().split('"').nth(1)?.to_owned())
    };
    let names: Vec<Option<String>> = values.iter().map(name).collect();
    values
        .iter()
        .zip(&names)
        .map(|(v, n)| match n {
            Some(text) if names.iter().filter(|m| *m == n).count() == 1 => text.clone(),
            _ => v.clone(),
        })
        .collect()
}

/// Runs the sweeps of a case into the table `sweep` and its figures.
///
/// # Errors
/// No point can be run, or a result is wanted that there is not.
pub fn run(
    scene: &dyn Scene,
    sweeps: &[Sweep],
    result: &mut RunResult,
    progress: &mut dyn FnMut(Progress),
) -> Result<(), RunError> {
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
            row.push(match changed(scene, &set).and_then(|s| s.once(&mut |_| {})) {
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
        let text = format!("{} of {total} points of the sweep have no result; the first: {f}", failed.len());
        result.solver.notes.push(Note::caution("sweep.failed", text));
    }
    let unit = |n: &str| result.results.get(n).map_or(String::new(), |v| v.unit.clone());
    // Titles are plain text.
    let what = |n: &str| result.results.get(n).map_or(String::new(), |v| v.what.replace('`', ""));
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
                let line = vec![(n.clone(), n.clone())];
                figures.push(lines(what(n), first, &table, line));
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
                let labels = labels(v);
                for n in &wanted {
                    let r = names.iter().position(|m| m == n).unwrap_or(0);
                    let mut curves = Vec::new();
                    for (row, label) in cells.iter().zip(&labels) {
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
                    figures.push(lines(what(n), first, &table, curves));
                }
            }
        }
    }
    result.figures.extend(figures);
    result.tables.insert("sweep".into(), table);
    Ok(())
}

/// Values over a sweep by equal ratios that span more than this factor are drawn by equal ratios too.
const WIDE: f64 = 100.0;

fn lines(title: String, s: &Sweep, table: &Series, lines: Vec<(String, String)>) -> Figure {
    let log_x = s.spacing == Spacing::Log;
    let (lo, hi) = lines
        .iter()
        .filter_map(|(_, c)| table.get(c))
        .flat_map(|c| &c.values)
        .filter(|v| v.is_finite())
        .fold((f64::INFINITY, 0.0), |(lo, hi): (f64, f64), v| (lo.min(*v), hi.max(*v)));
    Figure {
        title,
        hint: format!("over {}", s.path),
        table: "sweep".into(),
        kind: FigureKind::Lines {
            x: table.axis.name.clone(),
            lines,
            log_x,
            log_y: log_x && lo > 0.0 && hi > WIDE * lo,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn models_with_settings_are_called_by_name() {
        let named = |v: &[&str]| labels(&v.iter().map(|s| (*s).to_owned()).collect::<Vec<_>>());
        assert_eq!(
            named(&[r#"{ model = "barus", x = 1 }"#, r#"{x = 2, model="off"}"#, "1 um"]),
            ["barus", "off", "1 um"]
        );
        // A name that stands for two says nothing.
        let twice = [r#"{ model = "barus", x = 1 }"#, r#"{ model = "barus", x = 2 }"#];
        assert_eq!(named(&twice), twice);
        assert_eq!(named(&["{ x = 1 }", "{"]), ["{ x = 1 }", "{"]);
    }

    #[test]
    fn wide_results_of_a_sweep_by_ratios_are_drawn_by_ratios() {
        let drawn = |spacing, values: Vec<f64>| {
            let sweep = Sweep {
                path: "rig.x".into(),
                values: Vec::new(),
                from: String::new(),
                to: String::new(),
                points: 0,
                spacing,
                results: Vec::new(),
            };
            let column = |name: &str, values| Column { name: name.into(), unit: String::new(), values };
            let table = Series { axis: column("x", vec![1.0; 3]), columns: vec![column("y", values)] };
            match lines(String::new(), &sweep, &table, vec![("y".into(), "y".into())]).kind {
                FigureKind::Lines { log_x, log_y, .. } => (log_x, log_y),
                _ => (false, false),
            }
        };
        assert_eq!(drawn(Spacing::Log, vec![1.0, 10.0, 1000.0]), (true, true));
        assert_eq!(drawn(Spacing::Log, vec![1.0, f64::NAN, 1000.0]), (true, true));
        assert_eq!(drawn(Spacing::Log, vec![1.0, 10.0, 50.0]), (true, false));
        assert_eq!(drawn(Spacing::Log, vec![0.0, 10.0, 1000.0]), (true, false));
        assert_eq!(drawn(Spacing::Linear, vec![1.0, 10.0, 1000.0]), (false, false));
    }
}
