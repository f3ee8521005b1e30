use gudgeon_core::kinds::{Coupling, CouplingSpec, CouplingTorque, LinearCoupling};
use gudgeon_core::quantity::{NonNegative, Ratio, TorsionalDamping, quantity};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

use super::check_table;

/// A coupling with straight pieces of torque over twist: stages, stops, and play between the teeth of a gear.
///
/// Between the rows runs a straight line, beyond the ends the line of the last piece. A row at `(0, 0)` with further rows of the same
/// torque beside it is play. Damping is that of the piece, `loss_time` times its stiffness, plus `damping`.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Piecewise {
    /// Twists \[rad\], ascending.
    pub twist: Vec<f64>,
    /// Torques \[N m\], not descending.
    pub torque: Vec<f64>,
    /// Viscous damping everywhere.
    #[serde(default = "none")]
    pub damping: TorsionalDamping<NonNegative>,
    /// Damping of each piece by its stiffness \[s\].
    #[serde(default = "no_time")]
    pub loss_time: Ratio<NonNegative>,
}

fn none() -> TorsionalDamping<NonNegative> {
    quantity(0.0)
}
fn no_time() -> Ratio<NonNegative> {
    quantity(0.0)
}

#[register_model(
    name = "piecewise",
    summary = "stiffness by pieces: stages, stops, play",
    equations = "T = T_i + k_i (x - x_i) + (c + tau k_i) dx/dt between the rows x_i <= x < x_{i+1}",
    validity = "Spring couplings, gear play. `orders` and `modal` take the piece of the mean torque, right while the vibration stays in it; `harmonic_balance` and models in time take all.",
    references = ["den_hartog1956"],
    example = "twist = [-0.02, -0.01, 0.01, 0.02]\ntorque = [-300, -100, 100, 300]\ndamping = \"2 N m s/rad\"\nloss_time = 0\n",
)]
impl CouplingSpec for Piecewise {
    fn build(&self) -> Result<Box<dyn Coupling>, BuildError> {
        check_table("twist", &self.twist, &[("torque", &self.torque)], 2)?;
        let stiffness: Vec<f64> = self
            .twist
            .windows(2)
            .zip(self.torque.windows(2))
            .map(|(x, t)| (t[1] - t[0]) / (x[1] - x[0]))
            .collect();
        if let Some(i) = stiffness.iter().position(|s| !(s.is_finite() && *s >= 0.0)) {
            return Err(BuildError::at(format!("torque.{}", i + 1), "the torque falls over the twist"));
        }
        if stiffness[0] == 0.0 || stiffness[stiffness.len() - 1] == 0.0 {
            return Err(BuildError::at("torque", "the first and the last piece must carry torque"));
        }
        Ok(Box::new(Stages {
            x: self.twist.clone(),
            t: self.torque.clone(),
            k: stiffness,
            c: self.damping.si(),
            tau: self.loss_time.si(),
        }))
    }
}

#[derive(Debug, Clone)]
struct Stages {
    x: Vec<f64>,
    t: Vec<f64>,
    k: Vec<f64>,
    c: f64,
    tau: f64,
}

impl Coupling for Stages {
    fn torque(&self, twist: f64, rate: f64) -> CouplingTorque {
        let i = self.x.partition_point(|x| *x <= twist).clamp(1, self.k.len()) - 1;
        let c = self.c + self.tau * self.k[i];
        CouplingTorque {
            torque: self.t[i] + self.k[i] * (twist - self.x[i]) + c * rate,
            stiffness: self.k[i],
            damping: c,
        }
    }
    fn linear(&self, _: f64, mean_torque: f64) -> LinearCoupling {
        let here = self.torque(self.static_twist(mean_torque), 0.0);
        LinearCoupling { stiffness: here.stiffness, damping: here.damping, loss_factor: 0.0 }
    }
    fn static_twist(&self, torque: f64) -> f64 {
        // Where the torque stays the same over a piece, the middle of it.
        let n = self.k.len();
        let a = self.t.partition_point(|t| *t < torque);
        let b = self.t.partition_point(|t| *t <= torque);
        if b > a {
            return 0.5 * (self.x[a] + self.x[b - 1]);
        }
        let i = a.clamp(1, n) - 1;
        self.x[i] + (torque - self.t[i]) / self.k[i]
    }
    fn is_linear(&self) -> bool {
        false
    }
}
