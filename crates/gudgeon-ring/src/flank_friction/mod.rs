//! Friction on the flanks against radial motion.

pub mod off;
pub mod rational_saturation;
pub mod tanh_stribeck;
