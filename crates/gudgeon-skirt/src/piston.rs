//! The piston between both sides of its skirt: the balance of all forces across the bore.

mod balance;
mod equation;
mod euler;
mod follow;
mod follow_work;
mod forces;
mod lateral;
mod linear;
mod newton;
mod oil;
mod stage;
mod summary;
mod tangent;

pub use equation::Momentum;
pub use forces::Piston;
pub use lateral::Asked;
pub use summary::Summary;
pub use tangent::Partials;

/// Name of the part of the program in its errors.
const MODEL: &str = "piston";
