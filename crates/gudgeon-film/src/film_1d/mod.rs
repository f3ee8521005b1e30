//! Films along a line: the Reynolds equation in one dimension, on any profile ([`LineProfile`]) given by its panels.
//!
//! [`Complementarity`] solves on nodes, steady or in time; [`FrontTracking`] finds the steady film with its fronts where they are;
//! [`ElrodAdams`] is kept for comparison. [`ViscosityLoop`] goes around any of them when viscosity depends on pressure or shear.

mod cavity_shear;
mod complementarity;
mod elrod_adams;
mod fischer_burmeister;
mod front_tracking;
mod inputs;
#[doc(hidden)]
pub mod line;
mod line_solver;
mod off;
mod panel;
mod profile;
mod report;
#[doc(hidden)]
pub mod rows;
mod sums;
mod switching;
mod viscosity;

pub use cavity_shear::LineCavityShear;
pub use complementarity::Complementarity;
pub use elrod_adams::ElrodAdams;
pub use front_tracking::FrontTracking;
pub use line_solver::LineSolver;
pub use off::Off;
pub use profile::LineProfile;
pub use viscosity::ViscosityLoop;
