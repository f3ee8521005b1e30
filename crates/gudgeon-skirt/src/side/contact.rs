//! Solid contact of one side, summed along rows.

use gudgeon_core::BuildError;
use gudgeon_core::kinds::{
    BoundaryFriction, BoundaryFrictionSpec, Contact, ContactSpec, SkirtProfile, real_area_is_known,
};
use gudgeon_numerics::elementary;

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

/// Solid contact, and its friction where there is a model for it.
pub(super) struct Touch {
    contact: Box<dyn Contact>,
    friction: Option<Box<dyn BoundaryFriction>>,
}

impl Touch {
    /// Builds both.
    pub(super) fn new(
        contact: &dyn ContactSpec,
        friction: Option<&dyn BoundaryFrictionSpec>,
    ) -> Result<Self, BuildError> {
        let built = contact.build().map_err(|e| e.within("contact"))?;
        let Some(friction) = friction else { return Ok(Self { contact: built, friction: None }) };
        let model = friction.build().map_err(|e| e.within("boundary_friction"))?;
        real_area_is_known(&*model, &*built, contact.typetag_name())
            .map_err(|e| e.within("boundary_friction"))?;
        Ok(Self { contact: built, friction: Some(model) })
    }

    fn uses_real_area(&self) -> bool {
        self.friction.as_ref().is_some_and(|f| f.uses_real_area())
    }
}

/// Rows along which solid contact is summed.
pub(super) struct ContactRows {
    panel: Panel,
    sign: f64,
    clearance: f64,
    grid: ContactGrid,
    touch: Touch,
    /// Part of the height at every row.
    rows: Vec<f64>,
    cos: Vec<f64>,
    /// Drop of the profile, row after row; empty for a cylinder.
    drop: Vec<f64>,
    /// Elastic shapes, row after row, shape after shape.
    shapes: Vec<f64>,
    /// Gaps, pressures and real areas along a row.
    work: [Vec<f64>; 3],
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
        touch: Touch,
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
        let cos: Vec<f64> = angle.iter().map(|&a| elementary::cos(a)).collect();
        let work = [vec![0.0; cos.len()], vec![0.0; cos.len()], vec![0.0; cos.len()]];
        Self { panel, sign, clearance, grid, touch, rows, cos, drop, shapes, work, sums: 0 }
    }

    /// Distance of the mean planes up to which there is contact \[m\].
    pub(super) fn range(&self) -> f64 {
        self.touch.contact.range()
    }

    /// Axial force \[N\] of the friction of solid contact, away from the head, and the force times `R cos φ` \[N m\], for what
    /// [`ContactRows::loads`] found, while the skirt moves away from the head at `speed` \[m/s\].
    pub(super) fn rubbing(&self, speed: f64, loads: &[f64; 6]) -> [f64; 2] {
        let Some(friction) = &self.touch.friction else {
            let direction = if speed > 0.0 {
                1.0
            } else if speed < 0.0 {
                -1.0
            } else {
                0.0
            };
            let rub = -direction * self.touch.contact.friction_coefficient();
            return [rub * loads[2], rub * loads[3]];
        };
        let whole = self.panel.width() * self.panel.length;
        let force = |load: f64, area: f64, lever: f64| {
            let nominal = whole * lever;
            // What is refused is no number already.
            -load * friction.of_body(speed, load / nominal, area / nominal).unwrap_or(f64::NAN)
        };
        [force(loads[2], loads[4], 1.0), force(loads[3], loads[5], self.panel.radius)]
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

    /// Depth of every row below the upper edge \[m\].
    pub(super) fn depths(&self) -> Vec<f64> {
        self.rows.iter().map(|s| s * self.panel.length).collect()
    }

    /// Normal pressure of every row \[Pa\], mean over the arc. Not counted among the sums.
    pub(super) fn pressures(&mut self, e: [f64; 2], q: &[f64]) -> Vec<f64> {
        let (range, points, n) = (self.touch.contact.range(), self.cos.len(), self.grid.intervals);
        let (doubled, count) = (points < n + 1, self.rows.len());
        let pressure = |k| {
            self.row(k, e, q);
            let [h, p, _] = &mut self.work;
            if h.iter().all(|h| *h >= range) {
                return 0.0;
            }
            self.touch.contact.pressure(h, p);
            p.iter().enumerate().map(|(i, p)| weight(i, points, doubled) * p).sum::<f64>() / n as f64
        };
        (0..count).map(pressure).collect()
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

    /// Forces on both edges \[N\], normal force \[N\] and `∫ p R cos φ dA` \[N m\]; the real area `∫ A_c/A dA` \[m²\] and `∫ A_c/A R cos φ dA` \[m³\] where
    /// friction asks for them.
    pub(super) fn loads(&mut self, e: [f64; 2], q: &[f64]) -> [f64; 6] {
        let range = self.touch.contact.range();
        let mut sum = [0.0; 6];
        let wants_area = self.touch.uses_real_area();
        self.sums += 1;
        let points = self.cos.len();
        let n = self.grid.intervals;
        let doubled = points < n + 1;
        let step = self.grid.pitch * self.panel.width() / n as f64;
        for k in 0..self.rows.len() {
            self.row(k, e, q);
            let s = self.rows[k];
            let [h, p, area] = &mut self.work;
            if h.iter().all(|h| *h >= range) {
                continue;
            }
            self.touch.contact.pressure(h, p);
            if wants_area {
                self.touch.contact.real_area(h, area);
            }
            for (i, p) in p.iter().enumerate() {
                let w = weight(i, points, doubled);
                let load = step * w * p;
                let side = self.sign * load * self.cos[i];
                sum[0] += side * (1.0 - s);
                sum[1] += side * s;
                sum[2] += load;
                sum[3] += load * self.panel.radius * self.cos[i];
                if wants_area {
                    let touching = step * w * area[i];
                    sum[4] += touching;
                    sum[5] += touching * self.panel.radius * self.cos[i];
                }
            }
        }
        sum
    }
}

/// Weight of point `i` of a row of `points` in the trapezoidal rule over the whole arc; `doubled`: the row is one half of it, to the middle.
fn weight(i: usize, points: usize, doubled: bool) -> f64 {
    let end = i == 0 || (!doubled && i + 1 == points);
    let middle = doubled && i + 1 == points;
    match (end, middle, doubled) {
        (true, _, true) | (_, true, _) | (false, false, false) => 1.0,
        (true, _, false) => 0.5,
        _ => 2.0,
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
