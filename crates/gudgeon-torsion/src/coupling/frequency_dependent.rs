use gudgeon_core::kinds::{Coupling, CouplingSpec, CouplingTorque, LinearCoupling};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

use super::{check_table, interpolate};

/// A coupling or damper whose stiffness and loss depend on the frequency: rubber, silicone oil.
///
/// `K(ω) (1 + i η(ω))` from a table, with straight lines between the rows and the end values beyond. The first row stands for the
/// static twist and for natural frequencies.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrequencyDependent {
    /// Frequencies \[Hz\], ascending.
    pub frequency: Vec<f64>,
    /// Stiffness at each \[N m/rad\].
    pub stiffness: Vec<f64>,
    /// Loss factor at each.
    pub loss_factor: Vec<f64>,
}

#[register_model(
    name = "frequency_dependent",
    summary = "stiffness and loss factor over the frequency, from a table",
    equations = "T = K(omega) (1 + i eta(omega)) dtheta",
    validity = "Harmonic motion; models in time refuse it. Natural frequencies are those of the first row.",
    references = [],
    example = "frequency = [1, 50, 200]\nstiffness = [2e4, 3e4, 4e4]\nloss_factor = [0.1, 0.4, 0.9]\n",
)]
impl CouplingSpec for FrequencyDependent {
    fn build(&self) -> Result<Box<dyn Coupling>, BuildError> {
        let columns =
            [("stiffness", self.stiffness.as_slice()), ("loss_factor", self.loss_factor.as_slice())];
        check_table("frequency", &self.frequency, &columns, 1)?;
        for (name, c) in columns.into_iter().chain([("frequency", self.frequency.as_slice())]) {
            if let Some(i) = c.iter().position(|v| *v < 0.0) {
                return Err(BuildError::at(format!("{name}.{i}"), "must be zero or greater"));
            }
        }
        let omega = self.frequency.iter().map(|f| f * 2.0 * std::f64::consts::PI).collect();
        Ok(Box::new(Spectrum { omega, k: self.stiffness.clone(), eta: self.loss_factor.clone() }))
    }
}

#[derive(Debug, Clone)]
struct Spectrum {
    omega: Vec<f64>,
    k: Vec<f64>,
    eta: Vec<f64>,
}

impl Coupling for Spectrum {
    fn torque(&self, twist: f64, _: f64) -> CouplingTorque {
        CouplingTorque { torque: self.k[0] * twist, stiffness: self.k[0], damping: 0.0 }
    }
    fn linear(&self, omega: f64, _: f64) -> LinearCoupling {
        LinearCoupling {
            stiffness: interpolate(&self.omega, &self.k, omega),
            damping: 0.0,
            loss_factor: interpolate(&self.omega, &self.eta, omega),
        }
    }
    fn static_twist(&self, torque: f64) -> f64 {
        if self.k[0] > 0.0 { torque / self.k[0] } else { 0.0 }
    }
    fn depends_on_frequency(&self) -> bool {
        true
    }
}
