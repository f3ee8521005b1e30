//! One point in the middle.

use gudgeon_core::BuildError;

use super::{Points, counted};

/// One point with all inputs at their medians, around which a study is linear.
#[derive(Debug, Clone)]
pub struct Medians {
    dimensions: usize,
}

impl Medians {
    /// # Errors
    /// No input.
    pub fn new(dimensions: usize) -> Result<Self, BuildError> {
        counted("inputs", dimensions, 1, dimensions)?;
        Ok(Self { dimensions })
    }
}

impl Points for Medians {
    fn len(&self) -> usize {
        1
    }

    fn dimensions(&self) -> usize {
        self.dimensions
    }

    fn point(&self, k: usize) -> Vec<f64> {
        assert!(k < 1, "point {k} of 1");
        vec![0.5; self.dimensions]
    }
}
