//! Surfaces on which gas presses radially.

mod back_and_face;
mod back_face_and_gap;
mod back_only;
mod bore_perimeter;
pub use back_and_face::BackAndFace;
pub use back_face_and_gap::BackFaceAndGap;
pub use back_only::BackOnly;
pub use bore_perimeter::BorePerimeter;
