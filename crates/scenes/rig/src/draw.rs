//! What the benches share: rows, tables with curves, and the refusal of results that are no numbers.

use gudgeon_core::kinds::RigOut;
use gudgeon_core::result::{Column, Figure, FigureKind, Lines, Series};
use gudgeon_core::{BuildError, EvalError};
use gudgeon_numerics::elementary;

/// `n` values at equal distances, both ends included.
pub fn linear(from: f64, to: f64, n: usize) -> Vec<f64> {
    (0..n).map(|i| if i + 1 == n { to } else { from + (to - from) * i as f64 / (n - 1) as f64 }).collect()
}

/// `n` values at equal ratios, both ends, positive, included.
pub fn logarithmic(from: f64, to: f64, n: usize) -> Vec<f64> {
    linear(elementary::ln(from), elementary::ln(to), n)
        .iter()
        .enumerate()
        .map(|(i, l)| match i {
            0 => from,
            _ if i + 1 == n => to,
            _ => elementary::exp(*l),
        })
        .collect()
}

/// A column: name, SI unit, values.
pub fn column(name: &str, unit: &str, values: Vec<f64>) -> Column {
    Column { name: name.into(), unit: unit.into(), values }
}

/// A further table of columns over an axis.
pub fn table(out: &mut RigOut, name: &str, axis: Column, columns: Vec<Column>) {
    out.tables.insert(name.into(), Series { axis, columns });
}

/// Scales of a drawing.
#[derive(Debug, Clone, Copy, Default)]
pub struct Scales {
    pub log_x: bool,
    pub log_y: bool,
}

/// Draws `(label, column)` of a table over its axis.
pub fn curves(
    out: &mut RigOut,
    table: &str,
    title: &str,
    hint: &str,
    scales: Scales,
    lines: &[(String, String)],
) {
    let axis = if table == "series" { &out.series.axis } else { &out.tables[table].axis };
    let x = axis.name.clone();
    out.figures.push(Figure {
        title: title.into(),
        hint: hint.into(),
        table: table.into(),
        kind: FigureKind::Lines(Lines {
            x,
            lines: lines.to_vec(),
            log_x: scales.log_x,
            log_y: scales.log_y,
            ..Lines::default()
        }),
    });
}

/// A label and a column.
pub fn line(label: &str, column: &str) -> (String, String) {
    (label.into(), column.into())
}

/// Refuses results and rows that are not numbers: inputs at the ends of what numbers can be.
pub fn finite(model: &'static str, out: &RigOut) -> Result<(), EvalError> {
    let refuse = |name: &str, v: f64| {
        Err(EvalError::fatal(
            model,
            format!("`{name}` is {v}: these inputs lead beyond what numbers can hold"),
        ))
    };
    for (name, v) in &out.results {
        if !v.value.is_finite() {
            return refuse(name, v.value);
        }
    }
    for t in std::iter::once(&out.series).chain(out.tables.values()) {
        for c in std::iter::once(&t.axis).chain(&t.columns) {
            if let Some(v) = c.values.iter().find(|v| !v.is_finite()) {
                return refuse(&c.name, *v);
            }
        }
    }
    Ok(())
}

/// What the law of openings refuses, at its place: without a field it speaks of the gas, whose constant is positive already.
pub fn law_error(mut e: BuildError) -> BuildError {
    if e.field.is_empty() {
        e.field = "gamma".into();
        e
    } else {
        e.within("orifice")
    }
}
