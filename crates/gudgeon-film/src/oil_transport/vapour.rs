//! What the film on the liner above ring 1 is made of, and what of it evaporates.

use gudgeon_core::kinds::{Evaporation, Volatile};

/// Film \[m\] below which there is none: a molecule.
const MOLECULE: f64 = 1e-9;

/// The composition of the film, cell by cell.
#[derive(Debug, Clone)]
pub struct Vapour {
    model: Box<dyn Evaporation>,
    /// Shares of the fractions in fresh oil.
    fresh: Vec<f64>,
    /// Shares in the film of every cell.
    shares: Vec<f64>,
    /// Volatilities of the fractions at every cell.
    volatility: Vec<f64>,
    /// Cells that have been dry since the cycle began.
    dried: Vec<bool>,
    /// Masses of one cell, scratch.
    masses: Vec<f64>,
}

impl Vapour {
    /// Fresh oil in cells whose middles are at the heights `z` \[m\].
    pub fn new(volatile: &Volatile<'_>, z: impl ExactSizeIterator<Item = f64>) -> Self {
        let fresh = volatile.model.shares().to_vec();
        let (n, cells) = (fresh.len(), z.len());
        let mut volatility = vec![0.0; n * cells];
        for (out, z) in volatility.chunks_exact_mut(n).zip(z) {
            // A model that does not know its liner is not asked for vapour.
            if let Some(t) = volatile.temperature.liner(volatile.top - z) {
                volatile.model.volatility(t, out);
            }
        }
        Self {
            model: dyn_clone::clone_box(volatile.model),
            shares: fresh.repeat(cells),
            dried: vec![false; cells],
            masses: vec![0.0; n],
            fresh,
            volatility,
        }
    }

    /// Makes all oil fresh, and no cell dry yet.
    pub fn refresh(&mut self) {
        self.dried.fill(false);
        for cell in self.shares.chunks_exact_mut(self.fresh.len()) {
            cell.copy_from_slice(&self.fresh);
        }
    }

    /// Adds a volume of fresh oil to the volume `before` of cell `k`.
    pub fn mix(&mut self, k: usize, before: f64, added: f64) {
        let n = self.fresh.len();
        let part = if before > 0.0 { before / (before + added) } else { 0.0 };
        for (share, fresh) in self.shares[n * k..n * (k + 1)].iter_mut().zip(&self.fresh) {
            *share = part * *share + (1.0 - part) * fresh;
        }
    }

    /// What the gas takes away at a pressure \[Pa\].
    pub fn transfer(&self, pressure: f64) -> f64 {
        self.model.transfer(pressure)
    }

    /// Notes that cell `k` lies bare under a `film` \[m\].
    pub fn see(&mut self, k: usize, film: f64) {
        self.dried[k] |= film < MOLECULE;
    }

    /// Number of cells that have been dry.
    pub fn dried(&self) -> usize {
        self.dried.iter().filter(|d| **d).count()
    }

    /// What is left of the `film` \[m\] of cell `k`, of oil of `density` \[kg/m³\].
    pub fn thin(&mut self, k: usize, film: f64, density: f64, exposure: f64) -> f64 {
        let n = self.fresh.len();
        let own = n * k..n * (k + 1);
        for (m, share) in self.masses.iter_mut().zip(&self.shares[own.clone()]) {
            *m = film * density * share;
        }
        self.model.thin(&self.volatility[own.clone()], exposure, &mut self.masses);
        let left: f64 = self.masses.iter().sum();
        if left > 0.0 {
            for (share, m) in self.shares[own].iter_mut().zip(&self.masses) {
                *share = m / left;
            }
        }
        (left / density).min(film)
    }
}
