//! Pressure at which films of rings cavitate.

mod absolute;
mod gauge;
pub use absolute::Absolute;
pub use gauge::Gauge;
