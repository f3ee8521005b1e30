//! Results, columns and figures of a run.

use gudgeon_core::result::{Column, Figure, FigureKind, Lines, RunResult, Value};
use gudgeon_core::{BuildError, EvalError};
use gudgeon_scene::RunError;

/// What is wrong, in one line.
pub fn refused(errors: Vec<BuildError>) -> RunError {
    RunError::Refused(errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))
}

/// A model refused.
pub fn model(source: EvalError) -> RunError {
    RunError::Model { source }
}

/// Adds a result.
pub fn result(out: &mut RunResult, name: impl Into<String>, value: f64, unit: &str, what: impl Into<String>) {
    out.results.insert(name.into(), Value { value, unit: unit.into(), what: what.into() });
}

/// A column: name, SI unit, values.
pub fn column(name: &str, unit: &str, values: Vec<f64>) -> Column {
    Column { name: name.into(), unit: unit.into(), values }
}

/// Draws `(label, column)` of a table over its axis.
pub fn lines(out: &mut RunResult, table: &str, title: &str, hint: &str, lines: &[(&str, &str)]) {
    let Some(t) = out.tables.get(table) else { return };
    out.figures.push(Figure {
        title: title.into(),
        hint: hint.into(),
        table: table.into(),
        kind: FigureKind::Lines(Lines {
            x: t.axis.name.clone(),
            lines: lines.iter().map(|(l, c)| ((*l).into(), (*c).into())).collect(),
            ..Lines::default()
        }),
    });
}
