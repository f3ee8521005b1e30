//! Film in the axial balance of a ring.

mod face_shear;
mod liner_reaction;
mod total;
pub use face_shear::FaceShear;
pub use liner_reaction::LinerReaction;
pub use total::Total;
