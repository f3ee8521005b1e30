//! Motion towards the liner and off it.

pub mod film_balance;
mod search;
mod tangent;
