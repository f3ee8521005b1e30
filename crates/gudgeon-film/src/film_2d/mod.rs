//! Films resolved along and across the motion.

mod arrival;
mod cavitation;
mod central_differences;
mod checks;
mod complementarity;
mod direct;
mod flux;
mod multigrid;
mod off;
mod problem;
mod sides;
mod sor;

pub use cavitation::Cavitation;
pub use central_differences::{CentralDifferences, Equations};
pub use direct::Direct;
pub use flux::Flux;
pub use multigrid::Multigrid;
pub use off::Off;
pub use sor::Sor;
