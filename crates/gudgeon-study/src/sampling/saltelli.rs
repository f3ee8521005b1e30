//! Blocks for Sobol indices: Saltelli et al., "Variance based sensitivity analysis of model output. Design and estimator for the total
//! sensitivity index", Comput. Phys. Commun. 181 (2010) 259-270.

use gudgeon_core::BuildError;

use super::{Points, Sobol, counted};

/// `base` rows of `d + 2` points each: A, B, and A with coordinate `i` taken from B, for every input `i`. A and B are the two halves of a
/// scrambled Sobol sequence in `2 d` dimensions.
#[derive(Debug, Clone)]
pub struct Saltelli {
    halves: Sobol,
}

impl Saltelli {
    /// # Errors
    /// No row, no input or more than 128, too many points.
    pub fn new(base: usize, dimensions: usize, seed: u64) -> Result<Self, BuildError> {
        counted("base", base, dimensions + 2, dimensions)?;
        Ok(Self { halves: Sobol::scrambled(base, 2 * dimensions, seed)? })
    }

    /// Number of rows.
    #[must_use]
    pub fn base(&self) -> usize {
        self.halves.len()
    }
}

impl Points for Saltelli {
    fn len(&self) -> usize {
        self.base() * (self.dimensions() + 2)
    }

    fn dimensions(&self) -> usize {
        self.halves.dimensions() / 2
    }

    fn point(&self, k: usize) -> Vec<f64> {
        let d = self.dimensions();
        let mut a = self.halves.point(k / (d + 2));
        let b = a.split_off(d);
        match k % (d + 2) {
            0 => a,
            1 => b,
            mixed => {
                a[mixed - 2] = b[mixed - 2];
                a
            }
        }
    }
}
