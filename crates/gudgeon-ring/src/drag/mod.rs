//! Friction that friction power counts.

mod face_shear;
mod liner;
pub use face_shear::FaceShear;
pub use liner::Liner;
