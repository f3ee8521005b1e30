//! The film on the liner, on a fixed grid.
//!
//! In a cell that an edge of a face stands in, the thickness is that of the part outside the face.

use gudgeon_core::kinds::Volatile;

use super::face::Trail;
use super::vapour::Vapour;

/// Film by height.
#[derive(Debug, Clone)]
pub struct Liner {
    /// Film \[m\], from the lowest cell up.
    pub film: Vec<f64>,
    /// Height of the lower end of the lowest cell \[m\].
    pub bottom: f64,
    /// Height of a cell \[m\].
    pub cell: f64,
    /// One over that.
    per_cell: f64,
    /// Volume of the film below each cell.
    sum: Vec<f64>,
    /// Lowest cell whose film has changed since these were added up.
    changed: usize,
    /// Film that the crankcase leaves \[m\].
    supply: f64,
    /// Number of cells, from the bottom up, that hold just that.
    supplied: usize,
    /// Height up to which rings reach \[m\].
    top: f64,
    /// What evaporates, if anything does.
    vapour: Option<Vapour>,
}

/// Way beyond the outermost edges that the grid covers \[m\].
const MARGIN: f64 = 2e-3;

impl Liner {
    /// A liner between two heights \[m\] with cells of at most `spacing`, without oil, on which the crankcase leaves a film of `supply` \[m\].
    pub fn new(low: f64, top: f64, spacing: f64, supply: f64, volatile: Option<Volatile<'_>>) -> Self {
        let cells = (((top - low + 2.0 * MARGIN) / spacing).ceil() as usize).max(8);
        let cell = (top - low + 2.0 * MARGIN) / cells as f64;
        let bottom = low - MARGIN;
        let vapour = volatile.map(|v| Vapour::new(&v, (0..cells).map(|k| bottom + (k as f64 + 0.5) * cell)));
        Self {
            film: vec![0.0; cells],
            bottom,
            cell,
            per_cell: 1.0 / cell,
            sum: vec![0.0; cells + 1],
            changed: 0,
            supply,
            supplied: 0,
            top,
            vapour,
        }
    }

    /// A film of `initial` \[m\], also above the rings unless it would only dry up there.
    pub fn start(&mut self, initial: f64) {
        let dry = self.vapour.is_some();
        self.touch(0);
        for k in 0..self.film.len() {
            self.film[k] = if dry && self.ends(k).0 >= self.top { 0.0 } else { initial };
        }
    }

    /// Begins a cycle with a film that may be another: all oil is fresh.
    pub fn refresh(&mut self) {
        self.touch(0);
        if let Some(vapour) = &mut self.vapour {
            vapour.refresh();
        }
    }

    /// Cell at a height \[m\], or the nearest.
    fn cell_at(&self, z: f64) -> usize {
        (((z - self.bottom) * self.per_cell).max(0.0) as usize).min(self.film.len() - 1)
    }

    /// Notes that the film may change from a cell upwards.
    fn touch(&mut self, from: usize) {
        self.changed = self.changed.min(from);
        self.supplied = self.supplied.min(from);
    }

    /// Height \[m\] within reach of ring 1 that lay bare without oil since the cycle began; none where nothing evaporates.
    pub fn dried(&self) -> f64 {
        self.vapour.as_ref().map_or(0.0, |v| v.dried() as f64 * self.cell)
    }

    /// Evaporates the film above height `from` \[m\] for `dt` \[s\] under gas of `pressure` \[Pa\]; the volume of oil, of `density` \[kg/m³\], that goes.
    pub fn evaporate(&mut self, from: f64, dt: f64, pressure: f64, density: f64) -> f64 {
        let Some(vapour) = &mut self.vapour else { return 0.0 };
        let exposure = vapour.transfer(pressure) * dt;
        let first = (((from - self.bottom) * self.per_cell).max(0.0) as usize).min(self.film.len());
        self.changed = self.changed.min(first);
        self.supplied = self.supplied.min(first);
        let mut gone = 0.0;
        for (k, film) in self.film.iter_mut().enumerate().skip(first) {
            let (low, high) = (self.bottom + k as f64 * self.cell, self.bottom + (k + 1) as f64 * self.cell);
            if *film > 0.0 {
                let left = vapour.thin(k, *film, density, exposure);
                gone += (*film - left) * (high - from).clamp(0.0, self.cell);
                *film = left;
            }
            if low >= from && high <= self.top {
                vapour.see(k, *film);
            }
        }
        gone
    }

    /// Adds the volumes up again, after the film has changed.
    pub fn add_up(&mut self) {
        let mut sum = self.sum[self.changed];
        for (s, h) in self.sum[self.changed + 1..].iter_mut().zip(&self.film[self.changed..]) {
            sum += h * self.cell;
            *s = sum;
        }
        self.changed = self.film.len();
    }

    /// Volume of the film on the liner below height `z`.
    pub fn below(&self, z: f64) -> f64 {
        let x = ((z - self.bottom) * self.per_cell).clamp(0.0, self.film.len() as f64);
        let k = (x as usize).min(self.film.len() - 1);
        self.sum[k] + (x - k as f64) * self.cell * self.film[k]
    }

    /// Volume of the film from height `a` up to `b`, as it is now; none where `b` is below.
    pub fn between(&self, a: f64, b: f64) -> f64 {
        let mut sum = 0.0;
        if b > a {
            for k in self.cell_at(a)..=self.cell_at(b) {
                let (low, high) = self.ends(k);
                sum += self.film[k] * (b.min(high) - a.max(low)).max(0.0);
            }
        }
        sum
    }

    /// Lays the film that an edge left; outside the face is above a top edge (`side` 1), below a
    /// bottom edge.
    pub fn lay(&mut self, trail: &Trail, side: usize) {
        let (a, b) = (trail.from, trail.to);
        let (lo, hi) = (a.min(b), a.max(b));
        let (first, last) = (self.cell_at(lo), self.cell_at(hi));
        self.touch(first);
        for k in first..=last {
            let (low, high) = self.ends(k);
            let new = hi.min(high) - lo.max(low);
            if new <= 0.0 {
                continue;
            }
            // The part that was outside before.
            let old =
                if side == 1 { (high - a).clamp(0.0, self.cell) } else { (a - low).clamp(0.0, self.cell) };
            let (before, added) = (self.film[k] * old, trail.film * new);
            self.film[k] = (before + added) / (old + new);
            if let Some(vapour) = &mut self.vapour {
                vapour.mix(k, before, added);
            }
        }
    }

    /// The crankcase wets the liner up to the height `to` \[m\]; what that adds \[m²\].
    pub fn wet(&mut self, to: f64) -> f64 {
        let mut added = 0.0;
        let (first, last) = (self.supplied, self.cell_at(to));
        for k in first..=last {
            let low = self.bottom + k as f64 * self.cell;
            let outside = (to - low).clamp(0.0, self.cell);
            added += (self.supply - self.film[k]) * outside;
            self.film[k] = self.supply;
        }
        self.changed = self.changed.min(first);
        self.supplied = first.max(last + 1);
        added
    }

    /// Lower and upper end of cell `k` \[m\].
    pub fn ends(&self, k: usize) -> (f64, f64) {
        (self.bottom + k as f64 * self.cell, self.bottom + (k + 1) as f64 * self.cell)
    }
}
