use gudgeon_core::BuildError;
use gudgeon_core::kinds::{CylinderPressureCtx, Kinematics};

/// The gas space above the piston, `V = A (y_tdc - y) + V_c` with `V_c = A s/(ε - 1)`.
///
/// `A` piston area, `s` stroke, `ε` compression ratio. Only ratios of volumes enter most cylinder-pressure models.
#[derive(Debug, Clone)]
pub struct Chamber {
    kinematics: Box<dyn Kinematics>,
    area: f64,
    /// Volume at the highest position of the piston \[m³\].
    pub clearance: f64,
    /// Swept volume \[m³\].
    pub swept: f64,
}

impl Chamber {
    /// The chamber over a piston that moves as `ctx` says.
    ///
    /// # Errors
    /// A compression ratio that is not above 1, a piston area or stroke that is not positive.
    pub fn new(ctx: &CylinderPressureCtx<'_>, compression_ratio: f64) -> Result<Self, BuildError> {
        Self::over(dyn_clone::clone_box(ctx.kinematics), ctx.piston_area, compression_ratio)
    }

    pub(crate) fn over(
        kinematics: Box<dyn Kinematics>,
        area: f64,
        compression_ratio: f64,
    ) -> Result<Self, BuildError> {
        if !(compression_ratio.is_finite() && compression_ratio > 1.0) {
            let what = format!("a compression ratio of {compression_ratio} cannot be, it must be above 1");
            return Err(BuildError::at("compression_ratio", what));
        }
        let swept = area * kinematics.stroke();
        if !(swept.is_finite() && swept > 0.0) {
            let what = format!(
                "the swept volume is {swept} m³: piston area {area} m², stroke {} m",
                kinematics.stroke()
            );
            return Err(BuildError::new(what));
        }
        Ok(Self { kinematics, area, clearance: swept / (compression_ratio - 1.0), swept })
    }

    /// Volume \[m³\] at crank angle `theta` \[rad\].
    #[must_use]
    pub fn volume(&self, theta: f64) -> f64 {
        // The difference is at least zero up to rounding; the clearance volume keeps the sum positive.
        self.area * (self.kinematics.y_tdc() - self.kinematics.height(theta)) + self.clearance
    }

    /// Volume \[m³\] and its derivative \[m³/rad\].
    #[must_use]
    pub fn volume_and_derivative(&self, theta: f64) -> (f64, f64) {
        let m = self.kinematics.motion(theta);
        (
            self.area * (self.kinematics.y_tdc() - m.y) + self.clearance,
            -self.area * m.v / self.kinematics.omega(),
        )
    }
}
