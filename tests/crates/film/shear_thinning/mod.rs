//! Viscosity under shear.

mod carreau;
mod cross;
mod off;
