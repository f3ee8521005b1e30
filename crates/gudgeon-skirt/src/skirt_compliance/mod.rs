//! How the skirt yields.

mod influence_matrix;
mod modal;
pub(crate) mod points;
mod quasi_static;
mod rigid;

pub use influence_matrix::InfluenceMatrix;
pub use modal::{Modal, Shape};
pub use quasi_static::QuasiStaticShapes;
pub use rigid::Rigid;
