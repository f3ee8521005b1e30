//! The periodic state of the oil on the lands.
//!
//! What is on the lands acts on nothing else, and a land empties over thousands of cycles: its flows go with the second and third power of its film. So a
//! cycle only notes what comes to the lands and what drives it, and their periodic state is found afterwards by Newton's method on the map of that cycle.

use gudgeon_core::kinds::{OilDrive, OilLand, OilLedger, OilPassed};
use gudgeon_numerics::linalg::{lu_factor, lu_solve};

use super::lands::Lands;

/// Film \[m\] at which the search begins: from thicker ones Newton's method comes down, from none it would not get away.
const FIRST_FILM: f64 = 20e-6;
/// Least part of a volume that a step of the search leaves.
const LEAST_LEFT: f64 = 0.25;
/// Most steps of the search: the film of a land that gets nothing falls by a third a step.
const MAX_STEPS: usize = 60;
/// Part of a volume over which differences are taken: what leaves a nearly dry land is 1e-10 of its volume.
const INCREMENT: f64 = 1e-3;
/// Change of a volume over a cycle, as a part of what comes to the lands, at which it repeats.
const REPEATS: f64 = 1e-11;

/// The lands and a cycle of theirs.
#[derive(Debug)]
pub struct LandCycle {
    lands: Lands,
    /// What came to each land since the last step.
    came: Vec<f64>,
    /// Of every step: its length, the acceleration, what came to each land, viscosities, pressures.
    log: Vec<f64>,
    /// Oil gained over the cycle per circumference \[m²\].
    gained: f64,
}

impl LandCycle {
    /// Lands without oil.
    pub fn new(places: &[OilLand], density: f64) -> Self {
        Self {
            lands: Lands::new(places, density),
            came: vec![0.0; places.len()],
            log: Vec::new(),
            gained: 0.0,
        }
    }

    /// The lands as the cycle leaves them.
    pub fn lands(&self) -> &Lands {
        &self.lands
    }

    /// Oil gained over the cycle per circumference \[m²\]: none before it is settled.
    pub fn gained(&self) -> f64 {
        self.gained
    }

    /// Begins a cycle.
    pub fn clear(&mut self) {
        self.log.clear();
        self.came.fill(0.0);
        self.gained = 0.0;
        self.lands.count_from(&vec![OilPassed::default(); self.lands.count()]);
    }

    /// Brings a volume to land `k`; below the lowest ring it is in the crankcase.
    fn put(&mut self, k: usize, volume: f64, ledger: &mut OilLedger) {
        *self.came.get_mut(k).unwrap_or(&mut ledger.drained) += volume;
    }

    /// Brings what ring `i` scraped to land `k`.
    pub fn scrape(&mut self, i: usize, k: usize, volume: f64, ledger: &mut OilLedger) {
        self.lands.count_scraped(i, volume);
        self.put(k, volume, ledger);
    }

    /// Brings what passed the end gap of ring `i` with the liner to the land above it or below; above ring 1 it stays on the liner.
    pub fn pass(&mut self, i: usize, up: bool, volume: f64, ledger: &mut OilLedger) {
        self.lands.count_passed(i, up, volume);
        if !(up && i == 0) {
            self.put(if up { i } else { i + 1 }, volume, ledger);
        }
    }

    /// Notes a step.
    pub fn step(&mut self, drive: &OilDrive<'_>) {
        self.log.extend([drive.dt, drive.acceleration]);
        for part in [&self.came[..], drive.viscosity, drive.pressures] {
            self.log.extend_from_slice(part);
        }
        self.came.fill(0.0);
    }

    /// The cycle that was noted from the volumes `start`; what went is added to `ledger`.
    fn run(&mut self, start: &[f64], ledger: &mut OilLedger) {
        let n = self.lands.count();
        self.lands.set_volumes(start);
        for step in self.log.chunks_exact(3 * (n + 1)) {
            let (came, drives) = step[2..].split_at(n);
            for (k, volume) in came.iter().enumerate() {
                self.lands.put(k, *volume, ledger);
            }
            let (viscosity, pressures) = drives.split_at(n);
            self.lands.step(&OilDrive { dt: step[0], acceleration: step[1], viscosity, pressures }, ledger);
        }
    }

    /// Change of the volumes over the cycle from `start`.
    fn change(&mut self, start: &[f64]) -> Vec<f64> {
        self.run(start, &mut OilLedger::default());
        self.lands.volumes().zip(start).map(|(end, start)| end - start).collect()
    }

    /// Finds the volumes that repeat, and adds what goes in their cycle to `ledger`.
    pub fn settle(&mut self, ledger: &mut OilLedger) {
        let n = self.lands.count();
        let counted: Vec<OilPassed> = self.lands.passed().collect();
        let came: f64 = self.log.chunks_exact(3 * (n + 1)).flat_map(|step| &step[2..2 + n]).sum();
        self.lands.cover(FIRST_FILM);
        let mut start: Vec<f64> = self.lands.volumes().collect();
        // A film that nothing changes: oil neither reaches that land nor leaves it.
        let first = self.change(&start);
        for (v, _) in start.iter_mut().zip(&first).filter(|(_, c)| **c == 0.0 || came == 0.0) {
            *v = 0.0;
        }
        for _ in 0..MAX_STEPS {
            let change = self.change(&start);
            if change.iter().all(|c| c.abs() <= REPEATS * came) {
                break;
            }
            let Some(step) = self.newton(&start, &change) else { break };
            for (v, d) in start.iter_mut().zip(step) {
                *v = (*v + d).max(LEAST_LEFT * *v);
            }
        }
        self.lands.count_from(&counted);
        self.run(&start, ledger);
        self.gained = self.lands.volumes().zip(&start).map(|(end, start)| end - start).sum();
    }

    /// The step to where nothing changes, for the `change` from `start`.
    fn newton(&mut self, start: &[f64], change: &[f64]) -> Option<Vec<f64>> {
        let n = start.len();
        let mut matrix = vec![0.0; n * n];
        let mut beside = start.to_vec();
        let mut right: Vec<f64> = change.iter().map(|c| -c).collect();
        for k in 0..n {
            let d = INCREMENT * start[k];
            if d == 0.0 {
                matrix[k * n + k] = 1.0;
                continue;
            }
            beside[k] = start[k] + d;
            for (i, c) in self.change(&beside).iter().enumerate() {
                matrix[i * n + k] = (c - change[i]) / d;
            }
            beside[k] = start[k];
        }
        let mut pivots = vec![0; n];
        lu_factor(&mut matrix, n, &mut pivots).ok()?;
        lu_solve(&matrix, n, &pivots, &mut right);
        right.iter().all(|d| d.is_finite()).then_some(right)
    }
}
