//! Films along a line: the Reynolds equation in one dimension, on any profile ([`LineProfile`]) given by its panels.
//!
//! [`Complementarity`] solves on nodes, steady or in time; [`FrontTracking`] finds the steady film with its fronts where they are;
//! [`ElrodAdams`] is kept for comparison. [`ViscosityLoop`] goes around any of them when viscosity depends on pressure or shear.

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
