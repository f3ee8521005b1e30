use gudgeon_core::kinds::{Coupling, CouplingSpec, CouplingTorque, LinearCoupling};
use gudgeon_core::quantity::{NonNegative, Ratio, TorsionalDamping, TorsionalStiffness, quantity};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// A linear spring and damper side by side: a shaft, a coupling of steel, the fluid of a viscous damper (stiffness 0).
///
/// ```text
/// T = k Δθ + c Δω;   in vibration of angular frequency ω: amplitude of T = (k (1 + iη) + iωc) amplitude of Δθ
/// ```
///
/// The loss factor η is damping whose loss per cycle does not depend on the frequency. It exists in harmonic motion only; models in time
/// refuse it.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Linear {
    /// Torsional stiffness k; zero for a link of fluid alone.
    pub stiffness: TorsionalStiffness<NonNegative>,
    /// Viscous damping c between the two ends.
    #[serde(default = "none")]
    pub damping: TorsionalDamping<NonNegative>,
    /// Loss factor η.
    #[serde(default = "no_loss")]
    pub loss_factor: Ratio<NonNegative>,
}

fn none() -> TorsionalDamping<NonNegative> {
    quantity(0.0)
}
fn no_loss() -> Ratio<NonNegative> {
    quantity(0.0)
}

#[register_model(
    name = "linear",
    summary = "linear spring and damper, with a loss factor for harmonic motion",
    equations = "T = k dtheta + c domega;  in vibration T = (k (1 + i eta) + i omega c) dtheta",
    validity = "Small twists of steel shafts and couplings. The loss factor has no meaning in time.",
    references = ["den_hartog1956"],
    example = "stiffness = \"8 MN m/rad\"\ndamping = \"492.5 N m s/rad\"\nloss_factor = 0\n",
)]
impl CouplingSpec for Linear {
    fn build(&self) -> Result<Box<dyn Coupling>, BuildError> {
        Ok(Box::new(Spring {
            law: LinearCoupling {
                stiffness: self.stiffness.si(),
                damping: self.damping.si(),
                loss_factor: self.loss_factor.si(),
            },
        }))
    }
}

#[derive(Debug, Clone)]
struct Spring {
    law: LinearCoupling,
}

impl Coupling for Spring {
    fn torque(&self, twist: f64, rate: f64) -> CouplingTorque {
        let LinearCoupling { stiffness, damping, .. } = self.law;
        CouplingTorque { torque: stiffness * twist + damping * rate, stiffness, damping }
    }
    fn linear(&self, _: f64, _: f64) -> LinearCoupling {
        self.law
    }
    fn is_harmonic_only(&self) -> bool {
        self.law.loss_factor != 0.0
    }
    fn static_twist(&self, torque: f64) -> f64 {
        if self.law.stiffness > 0.0 { torque / self.law.stiffness } else { 0.0 }
    }
}
