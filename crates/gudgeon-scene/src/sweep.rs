//! Sweeps: every combination of one or two varied inputs, each read and built as a case of its own.

use gudgeon_core::result::{
    Column, Failure, Figure, FigureKind, IMPOSSIBLE, Lines, Note, NoteLevel, REFUSED, RunResult, Series,
    Value,
};
use gudgeon_core::{BuildError, Stopped};
use indexmap::IndexMap;

use crate::error::{Progress, RunError};
use crate::many::run_points;
use crate::scene::Scene;
use crate::sweep_input::{Axis, Spacing, Sweep, number, values};

/// Results drawn when none are named.
const DRAWN: usize = 6;

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
fn abscissa(s: &Axis, values: &[String]) -> (Column, bool) {
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

/// One point of a sweep.
struct Point {
    set: Vec<String>,
    outcome: Result<(IndexMap<String, Value>, Vec<Note>), Failure>,
}

impl Point {
    fn value(&self, name: &str) -> f64 {
        self.outcome.as_ref().ok().and_then(|(r, _)| r.get(name)).map_or(f64::NAN, |v| v.value)
    }

    /// The exit code that a run of this point alone would have.
    fn exit(&self) -> f64 {
        match &self.outcome {
            Ok((_, notes)) if notes.iter().any(|n| n.level == NoteLevel::Failure) => 1.0,
            Ok(_) => 0.0,
            Err(e) if e.code == REFUSED || e.code == IMPOSSIBLE => 2.0,
            Err(_) => 1.0,
        }
    }
}

/// Name of the column that says how each point ended: 0 done, 1 failed or marked as failed, 2 refused.
const EXIT: &str = "exit";

/// Runs the sweeps of a case into the table `sweep` and its figures; says how many points were run.
///
/// A point that fails is a row without results; what the points had to say is gathered by topic.
///
/// # Errors
/// No point can be run, or a result is wanted that no point has.
pub fn run(
    scene: &dyn Scene,
    sweeps: &[Sweep],
    result: &mut RunResult,
    threads: usize,
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<usize, RunError> {
    let Some(first) = sweeps.first().map(|s| &s.axis) else { return Ok(0) };
    let refused = |e: BuildError| RunError::Refused(e.to_string());
    let inner = values(first).map_err(refused)?;
    let outer = match sweeps.get(1).map(|s| &s.axis) {
        Some(s) => Some((s, values(s).map_err(refused)?)),
        None => None,
    };
    let sets = combinations((first, &inner), outer.as_ref().map(|(s, v)| (*s, &v[..])));
    let keep = |_, outcome: Result<RunResult, Failure>| outcome.map(|r| (r.results, r.solver.notes));
    let outcomes = run_points(scene, &sets, threads, keep, progress).all()?;
    let points: Vec<Point> =
        sets.into_iter().zip(outcomes).map(|(set, outcome)| Point { set, outcome }).collect();
    if let Some(Err(e)) = points.iter().all(|p| p.outcome.is_err()).then(|| &points[0].outcome) {
        return Err(RunError::Refused(format!("no point of the sweep could be run; the first: {e}")));
    }
    let told = told(&points);
    let names: Vec<&str> = told.keys().map(String::as_str).collect();
    let wanted = wanted(sweeps, &names)?;
    gather(&points, &mut result.solver.notes);
    let sheet = Sheet { points: &points, told: &told, wanted: &wanted, first, inner: &inner };
    let (mut table, figures) = match &outer {
        None => sheet.lines(),
        Some((second, v)) => {
            let numbers = abscissa(first, &inner).1 && abscissa(second, v).1;
            if numbers && v.len() > FEW { sheet.map(second, v) } else { sheet.families(v) }
        }
    };
    if table.axis.values.len() == points.len() {
        let exits = points.iter().map(Point::exit).collect();
        table.columns.push(Column { name: EXIT.into(), unit: "1".into(), values: exits });
    }
    result.figures.extend(figures);
    result.tables.insert("sweep".into(), table);
    Ok(points.len())
}

/// Values of a second input up to which there is a curve for each.
const FEW: usize = 8;

/// The changes of every combination, the first input running fastest.
fn combinations((first, inner): (&Axis, &[String]), outer: Option<(&Axis, &[String])>) -> Vec<Vec<String>> {
    let rows: Vec<Option<String>> = match outer {
        None => vec![None],
        Some((s, v)) => v.iter().map(|v| Some(format!("{}={v}", s.path))).collect(),
    };
    let with = |row: &Option<String>, v: &String| {
        std::iter::once(format!("{}={v}", first.path)).chain(row.clone()).collect()
    };
    rows.iter().flat_map(|row| inner.iter().map(move |v| with(row, v))).collect()
}

/// Unit and meaning of every result that any point has.
fn told(points: &[Point]) -> IndexMap<String, Value> {
    let mut told = IndexMap::new();
    for (name, v) in points.iter().filter_map(|p| p.outcome.as_ref().ok()).flat_map(|(r, _)| r) {
        told.entry(name.clone()).or_insert_with(|| v.clone());
    }
    told
}

/// The results that are drawn.
fn wanted(sweeps: &[Sweep], names: &[&str]) -> Result<Vec<String>, RunError> {
    let Some(named) = sweeps.iter().map(|s| &s.results).find(|r| !r.is_empty()) else {
        return Ok(names.iter().take(DRAWN).map(|n| (*n).to_owned()).collect());
    };
    match named.iter().find(|w| !names.contains(&w.as_str())) {
        None => Ok(named.clone()),
        Some(missing) => {
            let near = gudgeon_case::advice(missing, names);
            Err(RunError::Refused(format!("the sweep wants the result `{missing}`; {near}")))
        }
    }
}

/// What the points had to say, by topic: how many points, and the first of them in its words. What the case as it stands says too is added to its note.
fn gather(points: &[Point], notes: &mut Vec<Note>) {
    let total = points.len();
    let mut said: IndexMap<(&str, NoteLevel), (usize, String, bool)> = IndexMap::new();
    let mut say = |topic, level, p: &Point, text: &str, numerical| {
        let first = || (0, format!("{}: {text}", p.set.join(", ")), numerical);
        said.entry((topic, level)).or_insert_with(first).0 += 1;
    };
    for p in points {
        match &p.outcome {
            Err(e) if e.code == IMPOSSIBLE => {
                say("left_out", NoteLevel::Caution, p, &format!("left out, for it cannot be: {e}"), false);
            }
            Err(e) => say("failed", NoteLevel::Failure, p, &format!("no result: {e}"), false),
            Ok((_, own)) => {
                let mut seen: Vec<&str> = Vec::new();
                for n in own.iter().filter(|n| n.level > NoteLevel::Info) {
                    if !seen.contains(&n.topic.as_str()) {
                        seen.push(&n.topic);
                        say(&n.topic, n.level, p, &n.text, n.numerical);
                    }
                }
            }
        }
    }
    for ((topic, level), (n, text, numerical)) in said {
        if let Some(own) = notes.iter_mut().find(|own| own.topic == topic && own.level == level) {
            own.text.push_str(&format!("; likewise at {n} of {total} points of the sweep"));
            own.amounts.insert("points".into(), count(n));
            continue;
        }
        let text = format!("{n} of {total} points of the sweep, the first at {text}");
        let amounts = std::iter::once(("points".to_owned(), count(n))).collect();
        notes.push(Note { topic: format!("sweep.{topic}"), level, text, numerical, amounts });
    }
    notes.sort_by_key(|n| n.numerical);
}

fn count(n: usize) -> Value {
    Value { value: n as f64, unit: "1".into(), what: String::new() }
}

/// The points of a sweep as a table with its figures.
struct Sheet<'a> {
    points: &'a [Point],
    told: &'a IndexMap<String, Value>,
    wanted: &'a [String],
    first: &'a Axis,
    inner: &'a [String],
}

impl Sheet<'_> {
    fn unit(&self, name: &str) -> String {
        self.told.get(name).map_or(String::new(), |v| v.unit.clone())
    }

    /// Titles are plain text.
    fn title(&self, name: &str) -> String {
        self.told.get(name).map_or(String::new(), |v| v.what.replace('`', ""))
    }

    fn columns(&self) -> impl Iterator<Item = Column> + '_ {
        self.told.iter().map(|(name, v)| Column {
            name: name.clone(),
            unit: v.unit.clone(),
            values: self.points.iter().map(|p| p.value(name)).collect(),
        })
    }

    /// One input.
    fn lines(&self) -> (Series, Vec<Figure>) {
        let axis = abscissa(self.first, self.inner).0;
        let table = Series { axis, columns: self.columns().collect() };
        let one = |n: &String| lines(self.title(n), self.first, &table, vec![(n.clone(), n.clone())]);
        let figures = self.wanted.iter().map(one).collect();
        (table, figures)
    }

    /// Two inputs that are numbers.
    fn map(&self, second: &Axis, outer: &[String]) -> (Series, Vec<Figure>) {
        let (x, y) = (abscissa(self.first, self.inner).0, abscissa(second, outer).0);
        let along = outer.iter().flat_map(|_| x.values.clone()).collect();
        let across = y.values.iter().flat_map(|v| std::iter::repeat_n(*v, self.inner.len())).collect();
        let mut columns = vec![Column { values: across, ..y.clone() }];
        columns.extend(self.columns());
        let figure = |n: &String| Figure {
            title: self.title(n),
            hint: String::new(),
            table: "sweep".into(),
            kind: FigureKind::Map {
                x: x.name.clone(),
                y: y.name.clone(),
                value: n.clone(),
                marks: Vec::new(),
            },
        };
        let figures = self.wanted.iter().map(figure).collect();
        (Series { axis: Column { values: along, ..x.clone() }, columns }, figures)
    }

    /// Few values of the second input, or names: a curve for each.
    fn families(&self, outer: &[String]) -> (Series, Vec<Figure>) {
        let mut table = Series { axis: abscissa(self.first, self.inner).0, columns: Vec::new() };
        let mut figures = Vec::new();
        let labels = labels(outer);
        for n in self.wanted {
            let mut curves = Vec::new();
            for (row, label) in self.points.chunks(self.inner.len()).zip(&labels) {
                // A word that would read as a number stands in quotes.
                let label = label.trim_matches('"');
                let name = format!("{n}.{}", label.replace(' ', "_"));
                let values = row.iter().map(|p| p.value(n)).collect();
                table.columns.push(Column { name: name.clone(), unit: self.unit(n), values });
                curves.push((label.to_owned(), name));
            }
            figures.push(lines(self.title(n), self.first, &table, curves));
        }
        (table, figures)
    }
}

/// Values over a sweep by equal ratios that span more than this factor are drawn by equal ratios too.
const WIDE: f64 = 100.0;

fn lines(title: String, s: &Axis, table: &Series, lines: Vec<(String, String)>) -> Figure {
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
        kind: FigureKind::Lines(Lines {
            x: table.axis.name.clone(),
            lines,
            log_x,
            log_y: log_x && lo > 0.0 && hi > WIDE * lo,
            ..Lines::default()
        }),
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
            let axis = Axis { path: "rig.x".into(), spacing, ..Axis::default() };
            let column = |name: &str, values| Column { name: name.into(), unit: String::new(), values };
            let table = Series { axis: column("x", vec![1.0; 3]), columns: vec![column("y", values)] };
            match lines(String::new(), &axis, &table, vec![("y".into(), "y".into())]).kind {
                FigureKind::Lines(l) => (l.log_x, l.log_y),
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
