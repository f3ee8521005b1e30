//! Tests of the crate as one program.

mod certificate;
mod common;
mod conditions;
mod design;
mod fatigue;
mod optimum;
mod pin_load;
mod piston;
mod profile_curve;
mod published;
mod search;
mod stock;
mod strength;
