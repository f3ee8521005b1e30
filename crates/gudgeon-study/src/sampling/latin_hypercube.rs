//! Latin hypercube sampling: McKay, Beckman and Conover, "A comparison of three methods for selecting values of input variables in the
//! analysis of output from a computer code", Technometrics 21 (1979) 239-245.

use gudgeon_core::BuildError;

use super::{Points, counted};
use crate::random::{Stream, hash, open_unit};

/// `n` points: each of the `n` equal parts of every dimension holds exactly one of them, at a random place within the part.
#[derive(Debug, Clone)]
pub struct LatinHypercube {
    /// By dimension, the part of each point.
    parts: Vec<Vec<u32>>,
    points: usize,
    seed: u64,
}

impl LatinHypercube {
    /// # Errors
    /// No point, no dimension, or more than [`MAX_POINTS`](super::MAX_POINTS) points.
    pub fn new(points: usize, dimensions: usize, seed: u64) -> Result<Self, BuildError> {
        counted("points", points, 1, dimensions)?;
        let parts = (0..dimensions)
            .map(|d| {
                let mut order: Vec<u32> = (0..points as u32).collect();
                Stream::new(&[seed, d as u64]).shuffle(&mut order);
                order
            })
            .collect();
        Ok(Self { parts, points, seed })
    }
}

impl Points for LatinHypercube {
    fn len(&self) -> usize {
        self.points
    }

    fn dimensions(&self) -> usize {
        self.parts.len()
    }

    fn point(&self, k: usize) -> Vec<f64> {
        let place = |(d, parts): (usize, &Vec<u32>)| {
            // 32 bits: the sum with a part below 2^20 is exact, and the quotient stays within the part.
            let within = open_unit(hash(&[self.seed, d as u64, k as u64]), 32);
            (f64::from(parts[k]) + within) / self.points as f64
        };
        self.parts.iter().enumerate().map(place).collect()
    }
}
