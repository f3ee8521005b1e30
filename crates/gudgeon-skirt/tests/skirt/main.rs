//! Tests of the piston skirt.

mod body;
mod common;
mod compliance;
mod friction;
mod geometry;
mod kept_oil;
mod motions;
mod piston;
mod profiles;
mod published_points;
mod rigid_limit;
mod sides;
