//! Tests of the crate as one program.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

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
