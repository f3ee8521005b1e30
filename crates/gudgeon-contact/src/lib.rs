//! Solid contact between a ring and the liner: asperity pressure, thresholds, floors.
//!
//! | model | load carried by solids | friction |
//! |---|---|---|
//! | [`GreenwoodTripp`] | a pressure that grows smoothly as the surfaces approach | a coefficient times that pressure |
//! | [`RoughnessThreshold`] | none until the film is as thin as the roughness, then whatever is left | the whole load rubs |
//! | [`FilmFloor`] | whatever is left at a smallest admitted film | none: the film keeps its viscous shear |
//! | [`Off`] | none | none |
//!
//! The integrals behind the asperity models are public: [`asperity_integral()`], [`f_5_2`], [`f_2`], [`real_area_ratio`].

pub mod asperity_integral;
mod film_floor;
mod greenwood_tripp;
mod off;
mod roughness_threshold;

pub use asperity_integral::{asperity_integral, f_2, f_5_2};
pub use film_floor::FilmFloor;
pub use greenwood_tripp::{
    AsperityIntegralFormula, GreenwoodTripp, composite_modulus, composite_roughness, real_area_ratio,
};
pub use off::Off;
pub use roughness_threshold::RoughnessThreshold;
