//! Every input alone, from a middle that all share.

use gudgeon_core::BuildError;

use super::{Points, counted};

/// Point 0 has all inputs at their medians; points `2 i + 1` and `2 i + 2` have input `i` at its low and its high quantile.
#[derive(Debug, Clone)]
pub struct OneAtATime {
    dimensions: usize,
    low: f64,
    high: f64,
}

impl OneAtATime {
    /// # Errors
    /// No input, or quantiles that are not 0 < `low` < 0.5 < `high` < 1.
    pub fn new(dimensions: usize, low: f64, high: f64) -> Result<Self, BuildError> {
        counted("inputs", dimensions, 2, dimensions)?;
        if !(0.0 < low && low < 0.5) {
            return Err(BuildError::at("low", format!("`low` must be between 0 and 0.5, not {low}")));
        }
        if !(0.5 < high && high < 1.0) {
            return Err(BuildError::at("high", format!("`high` must be between 0.5 and 1, not {high}")));
        }
        Ok(Self { dimensions, low, high })
    }
}

impl Points for OneAtATime {
    fn len(&self) -> usize {
        2 * self.dimensions + 1
    }

    fn dimensions(&self) -> usize {
        self.dimensions
    }

    fn point(&self, k: usize) -> Vec<f64> {
        assert!(k < self.len(), "point {k} of {}", self.len());
        let mut u = vec![0.5; self.dimensions];
        if let Some(moved) = k.checked_sub(1) {
            u[moved / 2] = if moved % 2 == 0 { self.low } else { self.high };
        }
        u
    }
}
