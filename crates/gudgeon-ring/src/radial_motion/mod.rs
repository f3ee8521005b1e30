//! Motion towards the liner and off it.

pub mod film_balance;
pub mod search;
mod staged;
mod tangent;
