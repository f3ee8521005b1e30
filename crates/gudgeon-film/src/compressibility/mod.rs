//! Density under pressure.

pub mod dowson_higginson;
pub mod off;
