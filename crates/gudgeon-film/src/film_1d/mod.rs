//! Films along a line.

mod complementarity;
mod elrod_adams;
mod front_tracking;
mod line;
mod off;
mod profile;
mod rows;
mod viscosity;

pub use complementarity::{Complementarity, LineSolver};
pub use elrod_adams::ElrodAdams;
pub use front_tracking::FrontTracking;
pub use line::LineCavityShear;
pub use off::Off;
pub use profile::LineProfile;
pub use viscosity::ViscosityLoop;
