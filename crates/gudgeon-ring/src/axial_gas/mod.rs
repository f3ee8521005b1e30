//! Axial gas force on a ring.

mod full_perimeter;
mod laminar_profile;
mod linear_profile;
pub use full_perimeter::FullPerimeter;
pub use laminar_profile::LaminarProfile;
pub use linear_profile::LinearProfile;
