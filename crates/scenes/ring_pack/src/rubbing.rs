//! Friction of the solid contact of a ring whose case has a model for it.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::BoundaryFriction;

use super::contact_line::ContactLine;

/// The friction model of a ring.
#[derive(Debug)]
pub struct FaceFriction {
    /// The model.
    pub model: Box<dyn BoundaryFriction>,
    /// Length of all running lands \[m\], over which the load is taken as a mean pressure.
    pub length: f64,
}

impl FaceFriction {
    /// Force per circumference \[N/m\] on the ring along `+x`, where its contact carries `load` \[N/m\] at film thickness `h` \[m\] and the liner
    /// slides by at `u` \[m/s\].
    ///
    /// # Errors
    /// What the model refuses.
    pub fn force(&self, line: &ContactLine, h: f64, load: f64, u: f64) -> Result<f64, EvalError> {
        let (pressure, area) = (load / self.length, line.area(h) / self.length);
        Ok(load * self.model.of_body(u, pressure, area)?)
    }
}
