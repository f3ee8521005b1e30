//! Barrel and oval of the skirt, enlarged.

use std::f64::consts::PI;

use gudgeon_core::elementary;
use gudgeon_core::result::{Anchor, FigureKind, RunResult, Shape, Style};
use gudgeon_pin::piston::oval_radius;

use super::shapes::{dimension, figure, path, round_scale, text};

/// Draws the skirt.
pub fn skirt(bore: f64, height: f64, ovality: Option<f64>, out: &mut RunResult) {
    let Some(t) = out.tables.get("skirt") else { return };
    let Some(finished) = t.get("finished") else { return };
    let max = finished.values.iter().copied().fold(0.0f64, |a, b| a.max(b.abs()));
    if max == 0.0 && ovality.is_none() {
        return;
    }
    let (h, half) = (1e3 * height, 0.5e3 * bore);
    // The largest ordinate shows as a seventh of the radius.
    let scale = round_scale(if max > 0.0 { half / 7.0 / (0.5e3 * max) } else { 1.0 });
    let side = |sign: f64| -> Vec<[f64; 2]> {
        let rows = t.axis.values.iter().zip(&finished.values);
        rows.map(|(x, y)| [sign * (half + scale * 0.5e3 * y), 1e3 * x]).collect()
    };
    let mut body = side(-1.0);
    let mut right = side(1.0);
    right.reverse();
    body.extend(right);
    let top = 1e3 * t.axis.values.last().copied().unwrap_or(height);
    let mut fixed = vec![path(body, true, Style::Metal)];
    for sign in [-1.0, 1.0] {
        fixed.push(path(vec![[sign * half, 0.0], [sign * half, top]], false, Style::Dashed));
    }
    fixed.push(path(vec![[0.0, -3.0], [0.0, h + 3.0]], false, Style::Axis));
    fixed.push(dimension([half, 0.0], [-half, 0.0], 7.0, "D", 2.0 * half));
    fixed.push(dimension([-half, 0.0], [-half, h], 5.0, "skirt", h));
    let mut hint = format!("in millimetres; the profile enlarged {scale:.0} times, open end below");
    if let Some(ov) = ovality {
        let scale = oval(bore, half, h, ov, &mut fixed);
        hint += &format!("; the ovality of {:.1} um enlarged {scale:.0} times", 1e6 * ov);
    }
    figure(out, "Skirt", hint, FigureKind::Drawing { apart: false, fixed, frames: Vec::new() });
}

/// The oval beside the barrel; returns its scale.
fn oval(bore: f64, half: f64, h: f64, ov: f64, fixed: &mut Vec<Shape>) -> f64 {
    let scale = round_scale(half / 3.5 / (0.5e3 * ov));
    let (cx, cy) = (2.35 * half, 0.5 * h);
    let points = (0..180)
        .map(|k| {
            let a = PI * f64::from(k) / 90.0;
            let r = 1e3 * (0.5 * bore - scale * (0.5 * bore - oval_radius(bore, ov, a)));
            [cx + r * elementary::cos(a), cy + r * elementary::sin(a)]
        })
        .collect();
    fixed.push(path(points, true, Style::Metal));
    fixed.push(Shape::Circle { centre: [cx, cy], radius: half, style: Style::Dashed });
    fixed.push(path(vec![[cx - half - 4.0, cy], [cx + half + 4.0, cy]], false, Style::Axis));
    fixed.push(path(vec![[cx, cy - half - 4.0], [cx, cy + half + 4.0]], false, Style::Axis));
    fixed.push(text([cx + half + 5.0, cy], "thrust", Anchor::Start));
    fixed.push(text([cx, cy + half + 6.0], "pin", Anchor::Middle));
    // Room for the word beside the axis.
    fixed.push(text([cx + half + 24.0, cy], "", Anchor::Start));
    scale
}
