//! Oil on the lands of the piston: what rings scrape off and what passes their end gaps, until inertia and gas move it on.
//!
//! A land of height `H` holds the volume `V` per circumference as a film `δ = V/H`. A piston that accelerates at `a` drives it along the land, and gas that
//! flows through an end gap drags it with its shear stress `τ`; both are films with one free surface:
//!
//! `q = ρ |a| δ³/(3 μ)`,  `q = τ δ²/(2 μ)`
//!
//! per circumference that is open: the share `φ` of the end gap, all of it above ring 1 and into a groove that drains. Over a step either is solved
//! exactly, `δ' = -c δ³` and `δ' = -c δ²`, so a volume never becomes negative; what leaves one place is what comes to the other.

use gudgeon_core::kinds::{OilDrive, OilLand, OilLedger, OilPassed};

/// Shear stress of gas on the walls of an end gap over the pressure difference: the friction factor of Blasius, `0.079 Re^-1/4`, at the Reynolds numbers of
/// end gaps, 3e3 to 3e4, is 0.006 to 0.011.
const SHEAR: f64 = 0.008;
/// Part of the higher pressure beyond which a lower pressure below the gap makes no faster flow: it is choked.
const CHOKED: f64 = 0.47;

/// One land.
#[derive(Debug, Clone)]
struct Land {
    place: OilLand,
    volume: f64,
    /// Of the ring below it.
    passed: OilPassed,
}

/// All lands.
#[derive(Debug)]
pub struct Lands {
    lands: Vec<Land>,
    /// Density of the oil \[kg/m³\].
    pub density: f64,
}

/// What is left of a film after `δ' = -c δ³` for `t`.
fn by_inertia(film: f64, c_t: f64) -> f64 {
    film / (1.0 + 2.0 * c_t * film * film).sqrt()
}

/// What is left of a film after `δ' = -c δ²` for `t`.
fn by_shear(film: f64, c_t: f64) -> f64 {
    film / (1.0 + c_t * film)
}

impl Lands {
    /// Lands without oil.
    pub fn new(places: &[OilLand], density: f64) -> Self {
        let land = |place: &OilLand| Land { place: *place, volume: 0.0, passed: OilPassed::default() };
        Self { lands: places.iter().map(land).collect(), density }
    }

    /// Share of the circumference that the end gap of ring `i` leaves open.
    pub fn gap(&self, i: usize) -> f64 {
        self.lands.get(i).map_or(0.0, |l| l.place.gap)
    }

    /// Brings a volume to land `k`; below the lowest ring it is in the crankcase.
    pub fn put(&mut self, k: usize, volume: f64, ledger: &mut OilLedger) {
        match self.lands.get_mut(k) {
            Some(land) => land.volume += volume,
            None => ledger.drained += volume,
        }
    }

    /// Counts what ring `i` scraped.
    pub fn count_scraped(&mut self, i: usize, volume: f64) {
        self.lands[i].passed.scraped += volume;
    }

    /// Counts what passed the end gap of ring `i`.
    pub fn count_passed(&mut self, i: usize, up: bool, volume: f64) {
        let passed = &mut self.lands[i].passed;
        *if up { &mut passed.up } else { &mut passed.down } += volume;
    }

    /// Brings what passed the end gap of ring `i` to the land above it or below.
    fn pass(&mut self, i: usize, up: bool, volume: f64, ledger: &mut OilLedger) {
        self.count_passed(i, up, volume);
        self.put(if up { i } else { i + 1 }, volume, ledger);
    }

    /// Moves the oil over a step.
    pub fn step(&mut self, drive: &OilDrive<'_>, ledger: &mut OilLedger) {
        for k in 0..self.lands.len() {
            self.by_inertia(k, drive, ledger);
        }
        for i in 0..self.lands.len() {
            self.by_gas(i, drive, ledger);
        }
    }

    /// Inertia moves the oil of land `k`.
    fn by_inertia(&mut self, k: usize, drive: &OilDrive<'_>, ledger: &mut OilLedger) {
        let up = drive.acceleration < 0.0;
        let OilLand { height, gap, drained } = self.lands[k].place;
        let open = match (up, k) {
            (true, 0) => 1.0,
            (true, _) => self.gap(k - 1),
            _ if drained => 1.0,
            _ => gap,
        };
        let c = open * self.density * drive.acceleration.abs() / (3.0 * drive.viscosity[k] * height);
        let moved = self.take(k, |film| by_inertia(film, c * drive.dt));
        match (up, k) {
            (true, 0) => ledger.thrown += moved,
            (true, _) => self.pass(k - 1, true, moved, ledger),
            _ if drained => self.put(self.lands.len(), moved, ledger),
            _ => self.pass(k, false, moved, ledger),
        }
    }

    /// Gas moves oil through the end gap of ring `i`.
    fn by_gas(&mut self, i: usize, drive: &OilDrive<'_>, ledger: &mut OilLedger) {
        let (above, below) = (drive.pressures[i], drive.pressures[i + 1]);
        let up = below > above;
        // The crankcase has no film on a land.
        let from = if up { i + 1 } else { i };
        let Some(land) = self.lands.get(from) else { return };
        let shear = SHEAR * (above - below).abs().min(CHOKED * above.max(below));
        let c = self.gap(i) * shear / (2.0 * drive.viscosity[i] * land.place.height);
        let moved = self.take(from, |film| by_shear(film, c * drive.dt));
        self.pass(i, up, moved, ledger);
    }

    /// Thins the film of land `k` and gives the volume that left.
    fn take(&mut self, k: usize, left: impl Fn(f64) -> f64) -> f64 {
        let Land { place, volume, .. } = &mut self.lands[k];
        let rest = (left(*volume / place.height) * place.height).min(*volume);
        let moved = *volume - rest;
        *volume = rest;
        moved
    }

    /// Number of lands.
    pub fn count(&self) -> usize {
        self.lands.len()
    }

    /// Volumes per circumference \[m²\] from the crown down.
    pub fn volumes(&self) -> impl Iterator<Item = f64> {
        self.lands.iter().map(|l| l.volume)
    }

    /// Sets them.
    pub fn set_volumes(&mut self, volumes: &[f64]) {
        for (land, volume) in self.lands.iter_mut().zip(volumes) {
            land.volume = *volume;
        }
    }

    /// Sets films of one thickness \[m\].
    pub fn cover(&mut self, film: f64) {
        for land in &mut self.lands {
            land.volume = film * land.place.height;
        }
    }

    /// What every ring scraped and let pass.
    pub fn passed(&self) -> impl Iterator<Item = OilPassed> {
        self.lands.iter().map(|l| l.passed)
    }

    /// Goes on counting from `passed`.
    pub fn count_from(&mut self, passed: &[OilPassed]) {
        for (land, passed) in self.lands.iter_mut().zip(passed) {
            land.passed = *passed;
        }
    }
}
