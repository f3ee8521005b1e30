//! Shapes, scales and axes that the drawings share.

use gudgeon_core::elementary;
use gudgeon_core::result::{Anchor, Figure, FigureKind, RunResult, Shape, Style};

pub fn path(points: Vec<[f64; 2]>, closed: bool, style: Style) -> Shape {
    Shape::Path { points, closed, style }
}

pub fn block(x: [f64; 2], y: [f64; 2], style: Style) -> Shape {
    path(vec![[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]], true, style)
}

pub fn text(at: [f64; 2], text: impl Into<String>, anchor: Anchor) -> Shape {
    Shape::Text { at, text: text.into(), anchor }
}

pub fn dimension(from: [f64; 2], to: [f64; 2], offset: f64, name: &str, mm: f64) -> Shape {
    // Three decimals: micrometres; trailing zeros say nothing.
    let number = format!("{mm:.3}");
    let number = number.trim_end_matches('0').trim_end_matches('.');
    Shape::Dimension { from, to, offset, text: format!("{name} {number}") }
}

/// Adds a figure without a table.
pub fn figure(out: &mut RunResult, title: &str, hint: String, kind: FigureKind) {
    out.figures.push(Figure { title: title.into(), hint, table: String::new(), kind });
}

/// The largest scale of 1, 2 or 5 times a power of ten that is not above `wanted`.
pub fn round_scale(wanted: f64) -> f64 {
    let decade = elementary::powf(10f64, elementary::log10(wanted).floor());
    decade * [1.0, 2.0, 5.0].into_iter().rev().find(|f| f * decade <= wanted).unwrap_or(1.0)
}

/// Round steps that divide `span` into about `n` parts.
pub fn round_step(span: f64, n: f64) -> f64 {
    let raw = span / n;
    let decade = elementary::powf(10f64, elementary::log10(raw).floor());
    decade * [1.0, 2.0, 5.0, 10.0].into_iter().find(|f| f * decade >= raw).unwrap_or(10.0)
}

/// Label of a tick: four decimals, without trailing zeros.
fn tick(v: f64) -> String {
    format!("{v:.4}").trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// A frame with ticks around a box.
pub fn axes(fixed: &mut Vec<Shape>, (w, h): (f64, f64), x: (f64, f64), y: (f64, f64), names: (&str, &str)) {
    fixed.push(path(vec![[0.0, 0.0], [w, 0.0], [w, h], [0.0, h]], true, Style::Outline));
    let ticks = |(from, to): (f64, f64)| {
        let step = round_step(to - from, 6.0);
        let first = (from / step - 1e-9).ceil();
        (0..20).map(move |k| (first + f64::from(k)) * step).take_while(move |v| *v <= to + 1e-9 * step)
    };
    for v in ticks(x) {
        let at = w * (v - x.0) / (x.1 - x.0);
        fixed.push(path(vec![[at, 0.0], [at, -1.2]], false, Style::Thin));
        fixed.push(text([at, -3.4], tick(v), Anchor::Middle));
    }
    for v in ticks(y) {
        let at = h * (v - y.0) / (y.1 - y.0);
        fixed.push(path(vec![[0.0, at], [-1.2, at]], false, Style::Thin));
        fixed.push(text([-2.0, at], tick(v), Anchor::End));
    }
    fixed.push(text([0.5 * w, -7.4], names.0, Anchor::Middle));
    fixed.push(text([-2.0, h + 2.6], names.1, Anchor::Middle));
}
