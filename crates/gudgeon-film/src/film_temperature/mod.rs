//! Temperature of the film under each ring.

mod energy_balance;
mod given;
mod land_wall_mean;
mod liner_linear;

pub use energy_balance::EnergyBalance;
pub use given::Given;
pub use land_wall_mean::LandWallMean;
pub use liner_linear::LinerLinear;
