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
