//! Undamped and damped eigenvalues of a [`Tree`](crate::tree::Tree), with shapes.

mod chain;
mod damped;
mod determinant;
mod modal_damping;
mod modes;
mod rigid;
mod shapes;
mod simultaneous;
mod undamped;

pub use damped::{Spectrum, damped_eigenvalues, roots};
pub use modal_damping::modal_damping;
pub use modes::{holzer_residual, modes};
pub use rigid::{connected_parts, rigid_modes};
pub use shapes::shapes;
pub use undamped::natural_frequencies;
