//! Films along a line.

mod complementarity;
mod line;
mod profile;
mod rows;

pub use complementarity::{Complementarity, LineSolver};
pub use line::LineCavityShear;
pub use profile::LineProfile;
