//! Force on the pin.

pub mod cycle;
pub mod given;
pub mod other_case;
pub mod peak_pressure_rule;
mod search;
