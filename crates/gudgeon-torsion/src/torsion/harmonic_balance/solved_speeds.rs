//! The start of an iteration from the motions at other speeds.

use gudgeon_numerics::linalg::Complex;

/// Torques at speeds that were solved.
#[derive(Debug, Default)]
pub(super) struct SolvedSpeeds {
    /// Speed, when it was put here, torques; ascending.
    at: Vec<(f64, u64, Vec<Complex>)>,
    count: u64,
}

/// Numbers that are kept, and the minimum number of speeds.
const ROOM: usize = 1 << 19;
const KEPT: usize = 24;
/// Maximum number of speeds that a guess goes through, and their maximum distance by that of the nearest.
const THROUGH: usize = 8;
const NEAR: f64 = 10.0;
/// Sum of the weights up to which a guess is worth more than the nearest speed.
const TRUSTED: f64 = 300.0;

impl SolvedSpeeds {
    pub fn keep(&mut self, speed: f64, x: &[Complex]) {
        self.count += 1;
        if self.at.len() >= KEPT.max(ROOM / x.len().max(1)) {
            let oldest = (0..self.at.len()).min_by_key(|i| self.at[*i].1);
            oldest.map(|i| self.at.remove(i));
        }
        let place = self.at.partition_point(|k| k.0 < speed);
        let own = (speed, self.count, x.to_vec());
        match self.at.get_mut(place) {
            Some(old) if old.0 == speed => *old = own,
            _ => self.at.insert(place, own),
        }
    }

    /// The speeds next to one, nearest first.
    fn near(&self, speed: f64) -> Vec<usize> {
        let mut above = self.at.partition_point(|k| k.0 < speed);
        let mut below = above;
        let mut near = Vec::with_capacity(THROUGH);
        while near.len() < THROUGH.min(self.at.len()) {
            let up = self.at.get(above).map_or(f64::INFINITY, |k| k.0 - speed);
            let down = if below > 0 { speed - self.at[below - 1].0 } else { f64::INFINITY };
            if up <= down {
                near.push(above);
                above += 1;
            } else {
                below -= 1;
                near.push(below);
            }
        }
        near
    }

    /// Whether no speed was solved yet.
    pub fn is_empty(&self) -> bool {
        self.at.is_empty()
    }

    /// The polynomial through the torques at the nearest speeds.
    pub fn extrapolate(&self, speed: f64, x: &mut [Complex]) {
        x.fill(Complex::default());
        let near: Vec<&(f64, u64, Vec<Complex>)> = self.near(speed).iter().map(|i| &self.at[*i]).collect();
        let Some(first) = near.first() else { return };
        let reach = NEAR * (first.0 - speed).abs();
        let mut count = near.iter().take_while(|k| (k.0 - speed).abs() <= reach).count();
        let weights = |count: usize| -> Vec<f64> {
            let part = |i: usize, j: usize| (speed - near[j].0) / (near[i].0 - near[j].0);
            (0..count).map(|i| (0..count).filter(|j| *j != i).map(|j| part(i, j)).product()).collect()
        };
        while count > 1 && weights(count).iter().map(|w: &f64| w.abs()).sum::<f64>() > TRUSTED {
            count -= 1;
        }
        for (w, (_, _, known)) in weights(count.max(1)).into_iter().zip(&near) {
            let w = Complex::new(w, 0.0);
            x.iter_mut().zip(known).for_each(|(x, k)| *x = *x + w * *k);
        }
    }
}
