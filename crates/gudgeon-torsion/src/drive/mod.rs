//! Torques of motors, engines and loads.

mod constant;
mod harmonics;
mod induction_motor;
mod linear;
mod off;
mod power_law;
mod table;

pub use constant::Constant;
pub use harmonics::{Harmonic, Harmonics};
pub use induction_motor::InductionMotor;
pub use linear::{Linear, Rated};
pub use off::Off;
pub use power_law::PowerLaw;
pub use table::Table;

use gudgeon_core::kinds::{Drive, DriveTorque, OrderTorque};

/// A drive on a shaft that turns backwards, `T'(θ, ω) = -T(-θ, -ω)`: its angle, speed and torque count in the direction in which it turns.
#[derive(Debug, Clone)]
pub struct Reversed {
    drive: Box<dyn Drive>,
    orders: Vec<OrderTorque>,
}

impl Reversed {
    /// Turns a drive about.
    #[must_use]
    pub fn new(drive: Box<dyn Drive>) -> Self {
        let orders = drive.orders().iter().map(|o| OrderTorque { cosine: -o.cosine, ..*o }).collect();
        Self { drive, orders }
    }
}

impl Drive for Reversed {
    fn torque(&self, theta: f64, omega: f64) -> DriveTorque {
        let t = self.drive.torque(-theta, -omega);
        DriveTorque { torque: -t.torque, slope: t.slope }
    }
    fn orders(&self) -> &[OrderTorque] {
        &self.orders
    }
    fn is_linear(&self) -> bool {
        self.drive.is_linear()
    }
}
