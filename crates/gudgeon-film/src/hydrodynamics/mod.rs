//! The film under a ring face.

mod check_face;
pub mod closed_form_face;
mod gridded_face;
mod off;

pub use closed_form_face::{CavityShear, ClosedFormFace};
pub use gridded_face::GriddedFace;
pub use off::Off;
