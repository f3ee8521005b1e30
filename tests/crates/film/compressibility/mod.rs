//! Density under pressure.

mod dowson_higginson;
mod off;
