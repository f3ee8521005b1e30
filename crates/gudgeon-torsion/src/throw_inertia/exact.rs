use gudgeon_core::kinds::{ThrowCtx, ThrowInertia, ThrowInertiaSpec};
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::elementary;
use serde::{Deserialize, Serialize};

use super::Lumped;

/// The inertia of the mechanism as it is.
///
/// ```text
/// I(θ) = I_c + m₁ r² + I₂ (dφ/dθ)² + (m₂ + m_p) (dx/dθ)²
/// dφ/dθ = r cos θ/(l cos φ),   dx/dθ = -r (sin θ + cos θ tan φ),   sin φ = (r sin θ - e)/l
/// ```
///
/// Its derivative enters the equation of motion as `½ I'(θ) ω²`, the torque of the moving masses.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Exact {}

#[register_model(
    name = "exact",
    summary = "inertia of crank, rod and piston as it is at each crank angle",
    equations = "I = I_c + m_1 r^2 + I_2 (dphi/dtheta)^2 + (m_2 + m_p) (dx/dtheta)^2",
    validity = "Rigid parts; offset included.",
    references = ["gomes2021", "heywood1988"],
    example = "",
)]
impl ThrowInertiaSpec for Exact {
    fn build(&self, ctx: &ThrowCtx) -> Result<Box<dyn ThrowInertia>, BuildError> {
        let mut m = Mechanism { p: Lumped::new(ctx)?, mean: 0.0 };
        // The trapezium rule over a period is exact to rounding for this smooth function.
        let n = 512;
        let sum: f64 = (0..n).map(|i| m.at(f64::from(i) * 2.0 * std::f64::consts::PI / f64::from(n)).0).sum();
        m.mean = sum / f64::from(n);
        Ok(Box::new(m))
    }
}

#[derive(Debug, Clone)]
struct Mechanism {
    p: Lumped,
    mean: f64,
}

impl Mechanism {
    fn at(&self, theta: f64) -> (f64, f64) {
        let Lumped { turning, oscillating, residual, r, l, e } = self.p;
        let (sin, cos) = elementary::sin_cos(theta);
        let sin_phi = (r * sin - e) / l;
        let cos_phi = ((1.0 - sin_phi) * (1.0 + sin_phi)).sqrt();
        let tan_phi = sin_phi / cos_phi;
        let q = r * cos / (l * cos_phi);
        let dq = -r * sin / (l * cos_phi) + q * q * tan_phi;
        let way = -r * (sin + cos * tan_phi);
        // d(tan φ)/dθ = q/cos²φ
        let dway = -r * (cos - sin * tan_phi + cos * q / (cos_phi * cos_phi));
        (
            turning + residual * q * q + oscillating * way * way,
            2.0 * (residual * q * dq + oscillating * way * dway),
        )
    }
}

impl ThrowInertia for Mechanism {
    fn inertia(&self, theta: f64) -> (f64, f64) {
        self.at(theta)
    }
    fn mean(&self) -> f64 {
        self.mean
    }
    fn is_constant(&self) -> bool {
        false
    }
}
