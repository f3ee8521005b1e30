use gudgeon_core::kinds::{Coupling, CouplingSpec, CouplingTorque, LinearCoupling};
use gudgeon_core::quantity::{NonNegative, Ratio, quantity};
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::elementary;
use serde::{Deserialize, Serialize};

use super::{check_table, interpolate};

/// A coupling described as its maker does: dynamic stiffness over the mean torque, and relative damping.
///
/// ```text
/// amplitude of T = K(T_mean) (1 + iψ/(2π)) amplitude of Δθ
/// ```
///
/// The relative damping ψ is the energy lost per cycle over the elastic energy of the vibration, so ψ = 2π η. `heat_factor` takes off
/// stiffness for a warm coupling (0.7 to 1 in makers' tables).
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LoadDependent {
    /// Mean torques \[N m\], ascending, of one sign; the law is the same for negative torque.
    pub mean_torque: Vec<f64>,
    /// Dynamic stiffness at each \[N m/rad\].
    pub stiffness: Vec<f64>,
    /// Relative damping ψ at each.
    pub relative_damping: Vec<f64>,
    /// Factor on the stiffness for the temperature.
    #[serde(default = "cold")]
    pub heat_factor: Ratio<NonNegative>,
}

fn cold() -> Ratio<NonNegative> {
    quantity(1.0)
}

#[register_model(
    name = "load_dependent",
    summary = "dynamic stiffness and relative damping over the mean torque",
    equations = "T = K(T_mean) (1 + i psi/(2 pi)) dtheta",
    validity = "Harmonic motion about a mean torque; models in time refuse it.",
    references = [],
    example = "mean_torque = [0, 1000, 2000]\nstiffness = [1e4, 2e4, 4e4]\nrelative_damping = [1.1, 1.0, 0.9]\nheat_factor = 1\n",
)]
impl CouplingSpec for LoadDependent {
    fn build(&self) -> Result<Box<dyn Coupling>, BuildError> {
        let columns = [
            ("stiffness", self.stiffness.as_slice()),
            ("relative_damping", self.relative_damping.as_slice()),
        ];
        check_table("mean_torque", &self.mean_torque, &columns, 1)?;
        if self.mean_torque[0] < 0.0 {
            return Err(BuildError::at("mean_torque.0", "must be zero or greater: the law is symmetric"));
        }
        if let Some(i) = self.stiffness.iter().position(|v| *v <= 0.0) {
            return Err(BuildError::at(format!("stiffness.{i}"), "must be greater than zero"));
        }
        if let Some(i) = self.relative_damping.iter().position(|v| *v < 0.0) {
            return Err(BuildError::at(format!("relative_damping.{i}"), "must be zero or greater"));
        }
        if self.heat_factor.si() <= 0.0 {
            return Err(BuildError::at("heat_factor", "must be greater than zero"));
        }
        Ok(Box::new(Rubber {
            torque: self.mean_torque.clone(),
            k: self.stiffness.iter().map(|k| k * self.heat_factor.si()).collect(),
            eta: self.relative_damping.iter().map(|p| p / (2.0 * std::f64::consts::PI)).collect(),
        }))
    }
}

#[derive(Debug, Clone)]
struct Rubber {
    torque: Vec<f64>,
    k: Vec<f64>,
    eta: Vec<f64>,
}

impl Coupling for Rubber {
    fn torque(&self, twist: f64, _: f64) -> CouplingTorque {
        CouplingTorque { torque: self.k[0] * twist, stiffness: self.k[0], damping: 0.0 }
    }
    fn linear(&self, _: f64, mean_torque: f64) -> LinearCoupling {
        let t = mean_torque.abs();
        LinearCoupling {
            stiffness: interpolate(&self.torque, &self.k, t),
            damping: 0.0,
            loss_factor: interpolate(&self.torque, &self.eta, t),
        }
    }
    fn depends_on_load(&self) -> bool {
        true
    }
    fn is_harmonic_only(&self) -> bool {
        true
    }
    fn static_twist(&self, torque: f64) -> f64 {
        // dT = K(T) dx, so x is the integral of 1/K over the torque; 1/K by straight pieces of K.
        let end = torque.abs();
        let mut x = 0.0;
        let mut at = 0.0;
        let stops = self.torque.iter().copied().filter(|t| *t > 0.0 && *t < end).chain([end]);
        for stop in stops {
            let (a, b) = (interpolate(&self.torque, &self.k, at), interpolate(&self.torque, &self.k, stop));
            let ratio = (b - a) / a;
            // ln(1 + r)/r near 1 for small r.
            let mean = if ratio.abs() < 1e-8 { 1.0 - 0.5 * ratio } else { elementary::ln_1p(ratio) / ratio };
            x += (stop - at) / a * mean;
            at = stop;
        }
        x.copysign(torque)
    }
}
