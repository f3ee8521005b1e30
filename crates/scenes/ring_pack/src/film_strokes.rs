//! Films and friction by stroke: thinnest film and largest friction force with their crank angles, film and coefficient of friction in the middle.

use std::f64::consts::PI;

use gudgeon_core::result::{Bar, Column, Figure, FigureKind, Series};
use gudgeon_numerics::elementary;
use gudgeon_numerics::panel::Rule;

use super::measure::{Measures, Peak, RingMeasure, raise};

/// The film of one ring over one stroke.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StrokeFilm {
    /// `ln` of the thinnest film \[m\].
    ln_min: f64,
    /// Where it is that \[rad\].
    theta: f64,
    /// `ln` of the film half a stroke after the dead centre \[m\].
    ln_mid: f64,
    /// Friction force over radial load there.
    coefficient_mid: f64,
    /// Largest friction force \[N\].
    friction: Peak,
}

/// Samples of a ring over a step, at the nodes of a rule.
#[derive(Debug, Clone, Copy)]
pub struct StepFilm<'a> {
    /// `ln` of the film \[m\].
    pub ln_h: &'a [f64],
    /// Friction force \[N\], whatever its direction.
    pub friction: &'a [f64],
    /// Radial load \[N\].
    pub load: &'a [f64],
}

impl Default for StrokeFilm {
    fn default() -> Self {
        Self {
            ln_min: f64::INFINITY,
            theta: 0.0,
            ln_mid: f64::NAN,
            coefficient_mid: f64::NAN,
            friction: Peak::default(),
        }
    }
}

impl StrokeFilm {
    /// Adds the step from `t0` to `t1` \[rad\] of this stroke, sampled at the nodes of `rule`.
    pub fn step(&mut self, rule: Rule, step: StepFilm<'_>, (t0, t1): (f64, f64)) {
        if let Some((x, low)) = rule.minimum(step.ln_h, self.ln_min) {
            (self.ln_min, self.theta) = (low, t0 + x * (t1 - t0));
        }
        raise(&mut self.friction, rule, step.friction, t0, t1);
        let middle = ((t0 + t1) / (2.0 * PI)).floor() * PI + 0.5 * PI;
        if (t0..t1).contains(&middle) {
            let x = (middle - t0) / (t1 - t0);
            self.ln_mid = rule.value(step.ln_h, x);
            let load = rule.value(step.load, x);
            self.coefficient_mid = if load > 0.0 { rule.value(step.friction, x) / load } else { 0.0 };
        }
    }

    fn row(&self) -> [f64; 6] {
        let (h, theta) = (elementary::exp(self.ln_min), self.theta.to_degrees());
        [
            h,
            theta,
            elementary::exp(self.ln_mid),
            self.coefficient_mid,
            self.friction.value,
            self.friction.theta.to_degrees(),
        ]
    }
}

/// Columns of the table for each ring, with their units.
const COLUMNS: [(&str, &str); 6] = [
    ("h_min", "m"),
    ("h_min_angle", "deg"),
    ("h_mid", "m"),
    ("friction_coefficient_mid", "1"),
    ("friction_max", "N"),
    ("friction_max_angle", "deg"),
];

/// Strokes of a cycle of `period` \[rad\], and as many films of a ring.
fn of_cycle(ring: &RingMeasure, period: f64) -> &[StrokeFilm] {
    &ring.by_stroke[..((period / PI).round() as usize).min(4)]
}

/// Result `what` of a ring, out of its strokes in a cycle of `period` \[rad\]; means are those of the strokes.
#[must_use]
pub fn result(ring: &RingMeasure, period: f64, what: &str) -> f64 {
    let strokes = of_cycle(ring, period);
    let mean = |f: &dyn Fn(&StrokeFilm) -> f64| strokes.iter().map(f).sum::<f64>() / strokes.len() as f64;
    let largest = strokes.iter().map(|s| s.friction).reduce(|a, b| if b.value > a.value { b } else { a });
    match what {
        "h_min_angle" => {
            strokes.iter().min_by(|a, b| a.ln_min.total_cmp(&b.ln_min)).map_or(0.0, |s| s.theta.to_degrees())
        }
        "h_mid" => mean(&|s| elementary::exp(s.ln_mid)) * 1e6,
        "friction_coefficient_mid" => mean(&|s| s.coefficient_mid),
        "friction_max" => largest.map_or(0.0, |p| p.value),
        "friction_max_angle" => largest.map_or(0.0, |p| p.theta.to_degrees()),
        _ => 0.0,
    }
}

/// A row per stroke of a cycle of `period` \[rad\]: for every ring what [`COLUMNS`] name.
#[must_use]
pub fn table(measures: &Measures, period: f64) -> Series {
    let mut columns = Vec::new();
    let mut strokes = 0;
    for (i, ring) in measures.rings.iter().enumerate() {
        let rows: Vec<_> = of_cycle(ring, period).iter().map(StrokeFilm::row).collect();
        strokes = rows.len();
        for (k, (name, unit)) in COLUMNS.iter().enumerate() {
            let values = rows.iter().map(|r| r[k]).collect();
            columns.push(Column { name: format!("ring{}.{name}", i + 1), unit: (*unit).into(), values });
        }
    }
    let values = (1..=strokes).map(|k| k as f64).collect();
    Series { axis: Column { name: "stroke".into(), unit: "1".into(), values }, columns }
}

/// Strokes of a cycle of four, and of one of two.
const STROKES: (&[&str], &[&str]) = (&["intake", "compression", "expansion", "exhaust"], &["down", "up"]);

/// The thinnest films as bars, stroke by stroke, of the rings with these names.
#[must_use]
pub fn figure(measures: &Measures, period: f64, names: &[String]) -> Figure {
    let mut bars = Vec::new();
    for (ring, name) in measures.rings.iter().zip(names) {
        let strokes = of_cycle(ring, period);
        let called = if strokes.len() == STROKES.0.len() { STROKES.0 } else { STROKES.1 };
        for (film, stroke) in strokes.iter().zip(called) {
            let label = format!("{name}, {stroke}");
            bars.push(Bar { label, value: elementary::exp(film.ln_min), ..Bar::default() });
        }
    }
    Figure {
        title: "Thinnest films".into(),
        hint: "of each ring over each stroke; films.csv has their crank angles".into(),
        table: "films".into(),
        kind: FigureKind::Bars { unit: "m".into(), bars },
    }
}
