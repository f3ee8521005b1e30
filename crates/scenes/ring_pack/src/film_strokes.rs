//! The films by stroke: thinnest film with its crank angle, and the film in the middle of the stroke.

use std::f64::consts::PI;

use gudgeon_core::result::{Column, Series};
use gudgeon_numerics::panel::Rule;

use super::measure::Measures;

/// The film of one ring over one stroke.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StrokeFilm {
    /// `ln` of the thinnest film \[m\].
    ln_min: f64,
    /// Where it is that \[rad\].
    theta: f64,
    /// `ln` of the film half a stroke after the dead centre \[m\].
    ln_mid: f64,
}

impl Default for StrokeFilm {
    fn default() -> Self {
        Self { ln_min: f64::INFINITY, theta: 0.0, ln_mid: f64::NAN }
    }
}

impl StrokeFilm {
    /// Adds the step from `t0` to `t1` \[rad\] of this stroke, over which `ln_h` are the logarithms of the film at the nodes of `rule`.
    pub fn step(&mut self, rule: Rule, ln_h: &[f64], (t0, t1): (f64, f64)) {
        if let Some((x, low)) = rule.minimum(ln_h, self.ln_min) {
            (self.ln_min, self.theta) = (low, t0 + x * (t1 - t0));
        }
        let middle = ((t0 + t1) / (2.0 * PI)).floor() * PI + 0.5 * PI;
        if (t0..t1).contains(&middle) {
            self.ln_mid = rule.value(ln_h, (middle - t0) / (t1 - t0));
        }
    }

    fn row(&self) -> [f64; 3] {
        [self.ln_min.exp(), self.theta.to_degrees(), self.ln_mid.exp()]
    }
}

/// A row per stroke of a cycle of `period` \[rad\]: for every ring thinnest film, its crank angle and the film in mid-stroke.
#[must_use]
pub fn table(measures: &Measures, period: f64) -> Series {
    let strokes = (period / PI).round() as usize;
    let column = |name: String, unit: &str, values| Column { name, unit: unit.into(), values };
    let mut columns = Vec::new();
    for (i, ring) in measures.rings.iter().enumerate() {
        let rows: Vec<_> = ring.by_stroke[..strokes.min(4)].iter().map(StrokeFilm::row).collect();
        for (k, (name, unit)) in [("h_min", "m"), ("h_min_angle", "deg"), ("h_mid", "m")].iter().enumerate() {
            columns.push(column(format!("ring{}.{name}", i + 1), unit, rows.iter().map(|r| r[k]).collect()));
        }
    }
    let axis = column("stroke".into(), "1", (1..=strokes).map(|k| k as f64).collect());
    Series { axis, columns }
}
