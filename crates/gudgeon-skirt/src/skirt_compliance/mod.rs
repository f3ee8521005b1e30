//! How the skirt yields.

mod influence_matrix;
mod modal;
pub(crate) mod points;
mod rigid;

pub use influence_matrix::InfluenceMatrix;
pub use modal::{Modal, Shape};
pub use rigid::Rigid;
