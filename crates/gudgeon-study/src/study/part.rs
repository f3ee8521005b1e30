//! The rows of some points.

use gudgeon_core::result::{Failure, IMPOSSIBLE, Note, NoteLevel, RunResult};
use gudgeon_scene::many::run_point;
use gudgeon_scene::{Checked, Progress, Stopped};
use indexmap::IndexMap;

use super::linear;
use super::notes;
use super::points::Plan;
use super::record::Record;
use super::table::{Column, Table, Values};
use crate::sampling::Design;

/// What is kept of the run of a point.
#[derive(Debug, Clone, Default)]
pub struct Row {
    point: usize,
    case: String,
    /// Values of the varied inputs.
    values: Vec<String>,
    /// Why there is no result, or why it is not what was asked for.
    failure: Failure,
    /// Topics of what a person must know.
    notes: String,
    /// Those that are not about numerics alone in words, a line each.
    told: String,
    /// Results with their units and what they are.
    results: Vec<(String, f64, Told)>,
    /// The abscissa and the columns of the series that were asked for, with their units.
    curves: Vec<(String, String, Vec<f64>)>,
}

/// Unit of a result, and what it is.
#[derive(Debug, Clone, Default)]
pub struct Told {
    /// The unit.
    pub unit: String,
    /// One line.
    pub what: String,
}

/// Runs point `k`.
///
/// # Errors
/// The caller wanted it to end.
pub fn run_row(
    record: &Record,
    plan: &Plan,
    cases: &[Checked],
    k: usize,
    tell: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<Row, Stopped> {
    let (case, values) = plan.values(k);
    let (_, set) = plan.changes(k);
    let mut row = Row { point: k, case: record.cases[case].name.clone(), values, ..Row::default() };
    match run_point(cases[case].case.as_ref(), &set, tell) {
        Ok(result) => {
            row.keep(record, result);
            if matches!(record.study.design, Some(Design::Linear {})) {
                match linear::columns(plan, &cases[case], &set, &record.study.results, tell) {
                    Ok(columns) => row.results.extend(
                        columns.into_iter().map(|(n, v, unit)| (n, v, Told { unit, ..Told::default() })),
                    ),
                    Err(failure) if failure.code == "stopped" => return Err(Stopped),
                    Err(failure) => row.failure = failure,
                }
            }
        }
        Err(failure) if failure.code == "stopped" => return Err(Stopped),
        Err(failure) => row.failure = failure,
    }
    Ok(row)
}

impl Row {
    /// Number of its point.
    pub const fn point(&self) -> usize {
        self.point
    }

    fn keep(&mut self, record: &Record, result: RunResult) {
        let wanted = |name: &String| record.study.results.is_empty() || record.study.results.contains(name);
        let mut notes: IndexMap<&str, &Note> = IndexMap::new();
        for n in result.solver.notes.iter().filter(|n| n.level > NoteLevel::Info) {
            notes.entry(&n.topic).or_insert(n);
        }
        self.notes = notes.keys().copied().collect::<Vec<_>>().join(" ");
        let physical = notes.into_iter().filter(|(_, n)| !n.numerical);
        self.told = physical.map(|(topic, n)| notes::line(topic, &n.text)).collect::<Vec<_>>().join("\n");
        if let Some(n) = result.solver.notes.iter().find(|n| n.level == NoteLevel::Failure) {
            self.failure = Failure { code: n.topic.clone(), message: n.text.clone(), path: String::new() };
        }
        if !record.study.curves.is_empty() {
            let series = &result.series;
            let all = std::iter::once(&series.axis).chain(&series.columns);
            let asked =
                |name: &str| name == series.axis.name || record.study.curves.iter().any(|c| c == name);
            let kept = all.filter(|c| asked(&c.name));
            self.curves = kept.map(|c| (c.name.clone(), c.unit.clone(), c.values.clone())).collect();
        }
        let results = result.results.into_iter().filter(|(name, _)| wanted(name));
        self.results =
            results.map(|(name, v)| (name, v.value, Told { unit: v.unit, what: v.what })).collect();
    }
}

/// Rows as a table: number, case, inputs, how it ended, results.
pub fn table(record: &Record, plan: &Plan, rows: &[Row]) -> Table {
    let mut table = Table::default();
    let texts =
        |f: &dyn Fn(&Row) -> &str| Values::Texts(rows.iter().map(|r| Some(f(r).to_owned())).collect());
    table.push("point", "", Values::Integers(rows.iter().map(|r| i64::try_from(r.point).ok()).collect()));
    table.push("case", "", texts(&|r| &r.case));
    for (k, varied) in plan.varied.iter().enumerate() {
        let values = match &varied.unit {
            Some(_) => Values::Numbers(
                rows.iter().map(|r| gudgeon_scene::number(&r.values[k]).map(|n| n.0)).collect(),
            ),
            None => texts(&|r| &r.values[k]),
        };
        table.push(varied.path.clone(), varied.unit.clone().unwrap_or_default(), values);
    }
    table.push("code", "", texts(&|r| &r.failure.code));
    table.push("message", "", texts(&|r| &r.failure.message));
    table.push("wrong", "", texts(&|r| &r.failure.path));
    table.push("notes", "", texts(&|r| &r.notes));
    table.push(notes::RESERVATIONS, "", texts(&|r| &r.told));
    for (name, column) in results(record, rows) {
        table.columns.insert(name, column);
    }
    table
}

/// Columns of the results: those that were asked for, or those that any row has.
fn results(record: &Record, rows: &[Row]) -> IndexMap<String, Column> {
    let empty = || Column { values: Values::Numbers(vec![None; rows.len()]), ..Column::default() };
    let mut columns: IndexMap<String, Column> =
        record.study.results.iter().map(|n| (n.clone(), empty())).collect();
    for (k, row) in rows.iter().enumerate() {
        for (name, value, told) in &row.results {
            let column = columns.entry(name.clone()).or_insert_with(empty);
            column.unit.clone_from(&told.unit);
            column.what.clone_from(&told.what);
            if let Values::Numbers(v) = &mut column.values {
                v[k] = Some(*value);
            }
        }
    }
    columns
}

/// The series of all rows below each other, with the number of their point; none where none were asked for.
pub fn curves(record: &Record, rows: &[Row]) -> Option<Table> {
    if record.study.curves.is_empty() {
        return None;
    }
    let mut all = Table::default();
    for row in rows {
        let mut own = Table::default();
        let n = row.curves.first().map_or(0, |(.., v)| v.len());
        own.push("point", "", Values::Integers(vec![i64::try_from(row.point).ok(); n]));
        for (name, unit, values) in &row.curves {
            own.push(name.clone(), unit.clone(), Values::Numbers(values.iter().copied().map(Some).collect()));
        }
        // All columns but the number are numbers: they fit.
        let _ = all.append(own);
    }
    Some(all)
}

/// Number of rows without the results that were asked for, machines that cannot be apart.
pub fn failed(rows: &[Row]) -> usize {
    rows.iter().filter(|r| !r.failure.code.is_empty() && r.failure.code != IMPOSSIBLE).count()
}

/// Number of rows that are left out because there is no such machine.
pub fn left_out(rows: &[Row]) -> usize {
    rows.iter().filter(|r| r.failure.code == IMPOSSIBLE).count()
}
