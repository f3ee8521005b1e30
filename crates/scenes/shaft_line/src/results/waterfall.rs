//! Order spectra of the shafts over the speed, as a waterfall.

use std::f64::consts::PI;
use std::sync::Arc;

use gudgeon_core::result::{Figure, FigureKind, Series, Waterfall};

use super::{Results, column};
use crate::assemble::Assembled;
use crate::machine::Point;
use crate::rpm;

/// Maximum number of spectra.
const SPECTRA: usize = 36;
/// Maximum number of shafts.
const SHAFTS: usize = 4;
/// Part of the largest line of a shaft below which no line is seen.
const SEEN: f64 = 2e-3;

/// A shaft whose spectra are drawn.
struct Drawn {
    link: usize,
    /// Torque \[N m\] to what is drawn.
    factor: f64,
    unit: &'static str,
    what: &'static str,
    /// Largest half of peak to peak over the speeds of the diagram.
    largest: f64,
}

impl Results<'_> {
    /// Table `order_spectra`, with a row per speed and order, and its figure. `orders` are those of the amplitudes in `rows` and of the largest of each
    /// shaft.
    pub(super) fn order_spectra(
        &mut self,
        a: &Assembled,
        orders: &[f64],
        (rows, strengths): (&[Arc<Point>], &[Vec<f64>]),
        speeds: &[f64],
    ) {
        let shafts = shafts(a, rows);
        let kept = lines(orders, &shafts, strengths);
        if shafts.is_empty() || kept.is_empty() {
            return;
        }
        let chosen = spectra(rows, &shafts);
        let places: Vec<(usize, usize)> = chosen.iter().flat_map(|j| kept.iter().map(|k| (*j, *k))).collect();
        let of =
            |f: &dyn Fn(usize, usize) -> f64| places.iter().map(|(j, k)| f(*j, *k)).collect::<Vec<f64>>();
        let mut table = Series {
            axis: column("order", "", of(&|_, k| orders[k])),
            columns: vec![
                column("frequency", "Hz", of(&|j, k| orders[k] * speeds[j] / (2.0 * PI))),
                column("speed", "rpm", of(&|j, _| rpm(speeds[j]))),
            ],
        };
        let mut labels = Vec::new();
        for s in &shafts {
            let name = format!("shaft{}.{}", s.link + 1, s.what);
            let values = of(&|j, k| s.factor * rows[j].order_of(s.link, k));
            labels.push((format!("{}, {}", a.line.links[s.link].name, s.what), name.clone()));
            table.columns.push(column(name, s.unit, values));
        }
        self.out.tables.insert("order_spectra".into(), table);
        let every = if chosen.len() < speeds.len() {
            "; every few speeds of the diagram, peaks among them"
        } else {
            ""
        };
        self.out.figures.push(Figure {
            title: "Order spectra over the speed".into(),
            hint: format!(
                "amplitude of each order, one spectrum per speed, moved up by the speed{every}; over the frequency a resonance is a column of peaks"
            ),
            table: "order_spectra".into(),
            kind: FigureKind::Waterfall(Waterfall {
                x: vec!["order".into(), "frequency".into()],
                y: "speed".into(),
                spectra: labels,
            }),
        });
    }
}

/// Shafts that vibrate most: first those whose stress is known, by it, then the others by their torque.
fn shafts(a: &Assembled, rows: &[Arc<Point>]) -> Vec<Drawn> {
    let drawn = |link: usize| {
        let (factor, unit, what) = match a.stress[link] {
            Some(s) => (s / 1e6, "MPa", "stress"),
            None => (1.0, "N m", "torque"),
        };
        let largest = rows.iter().map(|p| factor * p.links[link].amplitude).fold(0.0, f64::max);
        Drawn { link, factor, unit, what, largest }
    };
    let mut all: Vec<Drawn> = (0..a.line.links.len()).map(drawn).filter(|s| s.largest > 0.0).collect();
    all.sort_by(|x, y| x.unit.cmp(y.unit).then(y.largest.total_cmp(&x.largest)));
    all.truncate(SHAFTS);
    all
}

/// Orders with a line that is seen in any of the shafts.
fn lines(orders: &[f64], shafts: &[Drawn], strengths: &[Vec<f64>]) -> Vec<usize> {
    let seen = |k: usize, s: &Drawn| s.factor * strengths[s.link][k] > SEEN * s.largest;
    (0..orders.len()).filter(|k| shafts.iter().any(|s| seen(*k, s))).collect()
}

/// Speeds that are drawn: every few of the diagram, and in their place those at which a shaft comes closest to its largest vibration, so that no
/// resonance of the diagram is passed over.
fn spectra(rows: &[Arc<Point>], shafts: &[Drawn]) -> Vec<usize> {
    let near = |j: usize| {
        shafts.iter().map(|s| s.factor * rows[j].links[s.link].amplitude / s.largest).fold(0.0, f64::max)
    };
    let all: Vec<usize> = (0..rows.len()).collect();
    let is_top = |j: &usize| {
        let beside = [j.checked_sub(1), Some(j + 1).filter(|k| *k < rows.len())];
        beside.into_iter().flatten().all(|k| near(k) <= near(*j))
    };
    let of = |some: &[usize]| {
        let top = some.iter().copied().filter(is_top).max_by(|x, y| near(*x).total_cmp(&near(*y)));
        top.unwrap_or(some[some.len() / 2])
    };
    all.chunks(rows.len().div_ceil(SPECTRA).max(1)).map(of).collect()
}
