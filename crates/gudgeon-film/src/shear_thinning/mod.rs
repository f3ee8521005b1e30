//! Viscosity under shear.

pub mod carreau;
pub mod cross;
pub mod off;
