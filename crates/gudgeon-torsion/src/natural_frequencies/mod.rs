//! How natural frequencies are found.

mod clamped_neighbours;
mod eigenvalues;

pub use clamped_neighbours::ClampedNeighbours;
pub use eigenvalues::Eigenvalues;
