//! How lateral position and tilt follow from the forces.

mod full_inertia;
mod held;
mod quasi_static;

pub use full_inertia::FullInertia;
pub use held::Held;
pub use quasi_static::QuasiStatic;
