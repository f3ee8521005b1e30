//! Distortion of the liner.

/// Liner radius growth over the height above the pin at top dead centre; positions ascending.
#[derive(Debug, Clone, Default)]
pub struct LinerShape {
    /// Heights \[m\].
    pub position: Vec<f64>,
    /// Radial growth \[m\].
    pub growth: Vec<f64>,
}

impl LinerShape {
    /// Radial growth at a height \[m\].
    pub fn at(&self, x: f64) -> f64 {
        let n = self.position.len();
        if n == 0 {
            return 0.0;
        }
        let i = self.position.partition_point(|p| *p <= x).clamp(1, n - 1);
        let (x0, x1) = (self.position[i - 1], self.position[i]);
        self.growth[i - 1] + (self.growth[i] - self.growth[i - 1]) * (x - x0) / (x1 - x0)
    }
}
