use gudgeon_core::kinds::{Coupling, CouplingSpec, CouplingTorque, LinearCoupling};
use gudgeon_core::quantity::{
    NonNegative, PosTorque, PosTorsionalStiffness, Ratio, TorsionalDamping, quantity,
};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// A coupling that stiffens with its torque, as rubber in compression does.
///
/// ```text
/// T = k Δθ + k₃ Δθ³ + c Δω,   k₃ chosen so that the tangent stiffness at the nominal torque is `gain` times k
/// ```
///
/// With twist x at the nominal torque T_n: `3 k₃ x² = (gain - 1) k` and `k x + k₃ x³ = T_n`, so `x = 3 T_n/(k (2 + gain))`.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Progressive {
    /// Stiffness k without torque.
    pub stiffness: PosTorsionalStiffness,
    /// Torque at which the stiffness has grown by `gain`.
    pub nominal_torque: PosTorque,
    /// Tangent stiffness at the nominal torque, by that without torque; at least 1.
    pub gain: Ratio<NonNegative>,
    /// Viscous damping c.
    #[serde(default = "none")]
    pub damping: TorsionalDamping<NonNegative>,
}

fn none() -> TorsionalDamping<NonNegative> {
    quantity(0.0)
}

#[register_model(
    name = "progressive",
    summary = "stiffness that grows with the torque, cubic",
    equations = "T = k x + k3 x^3 + c dx/dt;  3 k3 x_n^2 = (gain - 1) k;  x_n = 3 T_n/(k (2 + gain))",
    validity = "Rubber couplings up to about their largest torque. `orders` and `modal` take the tangent at the mean torque; `harmonic_balance` and models in time take all.",
    references = ["den_hartog1956"],
    example = "stiffness = \"20 kN m/rad\"\nnominal_torque = \"2 kN m\"\ngain = 2\ndamping = \"20 N m s/rad\"\n",
)]
impl CouplingSpec for Progressive {
    fn build(&self) -> Result<Box<dyn Coupling>, BuildError> {
        let (k, gain) = (self.stiffness.si(), self.gain.si());
        if gain < 1.0 {
            let what = format!("a gain of {gain} would soften the coupling; it is at least 1");
            return Err(BuildError::at("gain", what));
        }
        let x = 3.0 * self.nominal_torque.si() / (k * (2.0 + gain));
        let cubic = (gain - 1.0) * k / (3.0 * x * x);
        if !cubic.is_finite() {
            return Err(BuildError::at("nominal_torque", "the cubic stiffness is too large to compute"));
        }
        Ok(Box::new(Cubic { k, cubic, c: self.damping.si() }))
    }
}

#[derive(Debug, Clone)]
struct Cubic {
    k: f64,
    cubic: f64,
    c: f64,
}

impl Coupling for Cubic {
    fn torque(&self, twist: f64, rate: f64) -> CouplingTorque {
        let square = self.cubic * twist * twist;
        CouplingTorque {
            torque: (self.k + square) * twist + self.c * rate,
            stiffness: self.k + 3.0 * square,
            damping: self.c,
        }
    }
    fn linear(&self, _: f64, mean_torque: f64) -> LinearCoupling {
        let x = self.static_twist(mean_torque);
        LinearCoupling { stiffness: self.k + 3.0 * self.cubic * x * x, damping: self.c, loss_factor: 0.0 }
    }
    fn static_twist(&self, torque: f64) -> f64 {
        // Newton from the linear twist, which overestimates: monotone.
        let mut x = torque / self.k;
        for _ in 0..100 {
            let t = self.torque(x, 0.0);
            let step = (t.torque - torque) / t.stiffness;
            x -= step;
            if step.abs() <= 4.0 * f64::EPSILON * x.abs() {
                break;
            }
        }
        x
    }
    fn is_linear(&self) -> bool {
        self.cubic == 0.0
    }
}
