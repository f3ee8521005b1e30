//! Tests of the piston skirt.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

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
