//! Solid contact of one side, summed along rows.

use gudgeon_core::kinds::{Contact, SkirtProfile};

use super::nodes::Nodes;
use crate::geometry::{Panel, between};

/// Where the pressure of solid contact is summed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactGrid {
    /// Distance of the rows \[m\], the first one on the upper edge: the pitch of machining grooves whose crests touch. Every row stands for one
    /// distance.
    pub pitch: f64,
    /// Intervals along the arc, summed by the trapezoidal rule.
    pub intervals: usize,
}

/// Rows along which solid contact is summed.
pub(super) struct ContactRows {
    panel: Panel,
    sign: f64,
    clearance: f64,
    grid: ContactGrid,
    contact: Box<dyn Contact>,
    /// Part of the height at every row.
    rows: Vec<f64>,
    cos: Vec<f64>,
    /// Drop of the profile, row after row; empty for a cylinder.
    drop: Vec<f64>,
    /// Elastic shapes, row after row, shape after shape.
    shapes: Vec<f64>,
    work: [Vec<f64>; 2],
    /// Sums so far.
    pub(super) sums: u64,
}

impl ContactRows {
    /// Rows over a side whose elastic shapes stand at the `nodes`, shape after shape, in `shapes`; of one half when the side is `symmetric` and the number
    /// of intervals is even. `is_cylinder`: the profile has no depth.
    #[allow(clippy::too_many_arguments, reason = "a side and its rows")]
    pub(super) fn new(
        panel: Panel,
        sign: f64,
        clearance: f64,
        grid: ContactGrid,
        contact: Box<dyn Contact>,
        symmetric: bool,
        profile: Option<&dyn SkirtProfile>,
        nodes: &Nodes,
        elastic: &[f64],
    ) -> Self {
        let count = (panel.length / grid.pitch * (1.0 + 1e-12)).floor() as usize + 1;
        let rows: Vec<f64> = (0..count).map(|k| k as f64 * grid.pitch / panel.length).collect();
        let halved = symmetric && grid.intervals.is_multiple_of(2);
        let across = if halved { grid.intervals / 2 } else { grid.intervals };
        let angle: Vec<f64> =
            (0..=across).map(|i| panel.half_angle * (2.0 * i as f64 / grid.intervals as f64 - 1.0)).collect();
        let mut drop = Vec::new();
        if let Some(profile) = profile {
            for &s in &rows {
                drop.extend(angle.iter().map(|&a| profile.depth(s * panel.length, a)));
            }
        }
        let mut shapes = Vec::new();
        for shape in elastic.chunks_exact(nodes.len()) {
            for &row in &rows {
                shapes.extend(angle.iter().map(|&a| bilinear(shape, &nodes.s, &nodes.angle, row, a)));
            }
        }
        let cos: Vec<f64> = angle.iter().map(|a| a.cos()).collect();
        let work = [vec![0.0; cos.len()], vec![0.0; cos.len()]];
        Self { panel, sign, clearance, grid, contact, rows, cos, drop, shapes, work, sums: 0 }
    }

    /// Distance of the mean planes up to which there is contact \[m\].
    pub(super) fn range(&self) -> f64 {
        self.contact.range()
    }

    /// Coefficient of friction.
    pub(super) fn friction_coefficient(&self) -> f64 {
        self.contact.friction_coefficient()
    }

    /// Smallest gap along all rows \[m\].
    pub(super) fn smallest(&mut self, e: [f64; 2], q: &[f64]) -> f64 {
        let mut smallest = f64::INFINITY;
        for k in 0..self.rows.len() {
            self.row(k, e, q);
            smallest = self.work[0].iter().fold(smallest, |a, &h| a.min(h));
        }
        smallest
    }

    /// The gap along row `k` of contact, into the first of `work`.
    fn row(&mut self, k: usize, e: [f64; 2], q: &[f64]) {
        let points = self.cos.len();
        let here = between(self.sign * e[0], self.sign * e[1], self.rows[k]);
        for (i, h) in self.work[0].iter_mut().enumerate() {
            *h = self.clearance + here * self.cos[i];
            if !self.drop.is_empty() {
                *h += self.drop[k * points + i];
            }
            for (m, q) in q.iter().enumerate() {
                *h += q * self.shapes[(m * self.rows.len() + k) * points + i];
            }
        }
    }

    /// Forces on both edges \[N\], normal force \[N\] and `∫ p R cos φ dA` \[N m\].
    pub(super) fn loads(&mut self, e: [f64; 2], q: &[f64]) -> [f64; 4] {
        let range = self.contact.range();
        let mut sum = [0.0; 4];
        self.sums += 1;
        let points = self.cos.len();
        let n = self.grid.intervals;
        let doubled = points < n + 1;
        let step = self.grid.pitch * self.panel.width() / n as f64;
        for k in 0..self.rows.len() {
            self.row(k, e, q);
            let s = self.rows[k];
            let [h, p] = &mut self.work;
            if h.iter().all(|h| *h >= range) {
                continue;
            }
            self.contact.pressure(h, p);
            for (i, p) in p.iter().enumerate() {
                let end = i == 0 || (!doubled && i + 1 == points);
                let middle = doubled && i + 1 == points;
                let w = match (end, middle, doubled) {
                    (true, _, true) | (_, true, _) | (false, false, false) => 1.0,
                    (true, _, false) => 0.5,
                    _ => 2.0,
                };
                let load = step * w * p;
                let side = self.sign * load * self.cos[i];
                sum[0] += side * (1.0 - s);
                sum[1] += side * s;
                sum[2] += load;
                sum[3] += load * self.panel.radius * self.cos[i];
            }
        }
        sum
    }
}

/// Value of a field over `x` × `y` between its nodes; beyond the last ones that of the mirror image or of the edge.
fn bilinear(f: &[f64], x: &[f64], y: &[f64], at_x: f64, at_y: f64) -> f64 {
    let find = |line: &[f64], at: f64| {
        let i = line.partition_point(|v| *v < at).clamp(1, line.len() - 1);
        (i - 1, ((at - line[i - 1]) / (line[i] - line[i - 1])).clamp(0.0, 1.0))
    };
    let ((i, a), (j, b)) = (find(x, at_x), find(y, at_y));
    let row = |j: usize| f[j * x.len() + i] * (1.0 - a) + f[j * x.len() + i + 1] * a;
    row(j) * (1.0 - b) + row(j + 1) * b
}
