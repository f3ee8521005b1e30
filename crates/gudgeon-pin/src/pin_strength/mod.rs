//! Strength of the pin.

pub mod curved_ring;
pub mod elastic_ring;
mod formula;
pub mod shear_beam;
pub mod thin_ring;
