//! Resistance of the oil in the groove to axial motion.

mod checks;
pub mod off;
pub mod squeeze_film;
pub mod tangent_degrees;
pub mod tangent_radians;
