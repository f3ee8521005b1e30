//! The film under a ring face.

mod averaged;
mod check_face;
pub mod closed_form_face;
mod gridded_face;
mod off;
mod rheology_grid;
mod rough_nodes;

pub use closed_form_face::{CavityShear, ClosedFormFace};
pub use gridded_face::GriddedFace;
pub use off::Off;
