//! Oil, film temperature, the film under a ring face, and films along a line and along and across the motion.

mod closed_form_face;
mod constant;
mod face;
pub mod film_1d;
pub mod film_2d;
mod given;
mod gridded_face;
mod land_wall_mean;
mod liner_linear;
mod off;
pub mod oil_transport;
mod vogel;
mod vogel_grade;

pub use closed_form_face::{Cavitation, CavityShear, ClosedFormFace};
pub use constant::Constant;
pub use given::Given;
pub use gridded_face::GriddedFace;
pub use land_wall_mean::LandWallMean;
pub use liner_linear::LinerLinear;
pub use off::Off;
pub use vogel::Vogel;
pub use vogel_grade::{Grade, VogelGrade, VogelTable};
