//! A motion over time as results read it.

use std::f64::consts::PI;
use std::ops::Range;

use gudgeon_core::kinds::TorsionOut;

use crate::assemble::Assembled;
use crate::results::extremes;

/// A motion with its line, and the window at its end.
pub(super) struct Motion<'a> {
    pub out: &'a TorsionOut,
    pub a: &'a Assembled,
    /// Rows of the window; the last one is the last of all.
    pub window: Range<usize>,
    /// Speed ratios of the inertias.
    pub ratio: Vec<f64>,
    /// Mean inertias \[kg m²\], and their sum at the reference shaft.
    inertia: Vec<f64>,
    total: f64,
}

impl<'a> Motion<'a> {
    /// With a window of so many rows before the last one.
    pub fn new(out: &'a TorsionOut, a: &'a Assembled, rows: usize) -> Self {
        let (nodes, n) = (a.line.nodes.len(), out.times.len());
        let inertia: Vec<f64> = (0..nodes).map(|i| a.line.mean_inertia(i)).collect();
        let ratio: Vec<f64> = a.line.nodes.iter().map(|n| n.ratio).collect();
        let total = inertia.iter().zip(&ratio).map(|(j, r)| j * r * r).sum();
        Self { out, a, window: rows.min(n - 1)..n, ratio, inertia, total }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.out.times.len()
    }

    /// First row of the window.
    pub fn first(&self) -> usize {
        self.window.start
    }

    /// Last row.
    pub fn last(&self) -> usize {
        self.rows() - 1
    }

    /// Length of the window \[s\].
    pub fn length(&self) -> f64 {
        self.out.times[self.last()] - self.out.times[self.first()]
    }

    /// Momentum by inertia, at the reference shaft \[rad/s\].
    pub fn mean_speed(&self, r: usize) -> f64 {
        let speeds = &self.out.speeds[r];
        (0..speeds.len()).map(|i| self.inertia[i] * self.ratio[i] * speeds[i]).sum::<f64>() / self.total
    }

    /// Turns within the window: what the inertias turn in the mean.
    pub fn turns(&self) -> f64 {
        let (first, last) = (&self.out.angles[self.first()], &self.out.angles[self.last()]);
        (0..last.len()).map(|i| self.inertia[i] * self.ratio[i] * (last[i] - first[i])).sum::<f64>()
            / self.total
            / (2.0 * PI)
    }

    /// Twist of a link and its rate.
    pub fn twist(&self, l: usize, r: usize) -> [f64; 2] {
        let [x, y] = self.a.line.links[l].nodes;
        let gear = self.ratio[x] / self.ratio[y];
        [&self.out.angles, &self.out.speeds].map(|v| v[r][x] - gear * v[r][y])
    }

    /// Torque of a link; a model that does not give it leaves it to the law.
    pub fn torque(&self, l: usize, r: usize) -> f64 {
        let given = self.out.torque.get(r).and_then(|t| t.get(l)).copied();
        given.unwrap_or_else(|| {
            let [twist, rate] = self.twist(l, r);
            self.a.line.links[l].coupling.torque(twist, rate).torque
        })
    }

    /// Power that a link loses.
    pub fn loss(&self, l: usize, r: usize) -> f64 {
        let [twist, rate] = self.twist(l, r);
        self.a.line.links[l].coupling.torque(twist, rate).damping * rate * rate
    }

    /// Maximum and minimum over the window.
    pub fn window_extremes(&self, f: impl FnMut(usize) -> f64) -> [f64; 2] {
        extremes(self.window.clone().map(f))
    }

    /// Maximum and minimum over all rows.
    pub fn all_extremes(&self, f: impl FnMut(usize) -> f64) -> [f64; 2] {
        extremes((0..self.rows()).map(f))
    }

    /// Mean over the rows of the window.
    pub fn window_mean(&self, f: impl FnMut(usize) -> f64) -> f64 {
        self.window.clone().map(f).sum::<f64>() / self.window.len() as f64
    }
}
