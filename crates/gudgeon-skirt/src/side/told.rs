//! The forces of one side that were told last.

use super::{SideLoads, Slopes};

/// Forces of a side, and for what they were told: whoever asks again at the same place, as for derivatives or for a row after a balance, is told at once.
#[derive(Default)]
pub(super) struct Told {
    is_there: bool,
    speed: f64,
    mu: f64,
    rates: Vec<f64>,
    film: [f64; 4],
    elastic: Vec<f64>,
    /// Which derivatives are known.
    slopes: Slopes,
    slope: Vec<f64>,
}

impl Told {
    /// Whether it holds the forces at these arguments.
    pub(super) fn is_of(&self, speed: f64, mu: f64, rates: &[f64]) -> bool {
        self.is_there && self.speed == speed && self.mu == mu && self.rates == rates
    }

    /// Takes forces without derivatives.
    pub(super) fn take(&mut self, speed: f64, mu: f64, rates: &[f64], loads: &SideLoads) {
        (self.is_there, self.speed, self.mu, self.film) = (true, speed, mu, loads.film);
        self.rates.clear();
        self.rates.extend_from_slice(rates);
        self.elastic.clone_from(&loads.elastic);
        self.slopes = Slopes::None;
    }

    /// Tells the forces.
    pub(super) fn loads(&self, out: &mut SideLoads) {
        out.film = self.film;
        out.elastic.clone_from(&self.elastic);
    }

    /// Takes derivatives of the forces that it holds.
    pub(super) fn take_slope(&mut self, slopes: Slopes, slope: &[f64]) {
        self.slopes = slopes;
        self.slope.clear();
        self.slope.extend_from_slice(slope);
    }

    /// Tells derivatives of the forces that it holds, when it knows them.
    pub(super) fn slope(&self, slopes: Slopes, out: &mut [f64]) -> bool {
        let is_known = self.slopes == slopes && self.slope.len() == out.len();
        if is_known {
            out.copy_from_slice(&self.slope);
        }
        is_known
    }

    /// Forgets all.
    pub(super) fn forget(&mut self) {
        self.is_there = false;
    }
}
