//! Tests of the crate, one module a topic.
#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]
#![allow(clippy::excessive_precision, reason = "reference values stand as they were computed")]

mod balance;
mod discharge;
mod elimination;
mod energy;
mod heat_capacity;
mod labyrinth;
mod models;
mod mouths;
mod namazian_heywood;
mod network;
mod network_cycle;
mod openings;
mod orifice;
mod packs;
mod partials;
mod passages;
mod refusals;
mod series;
mod skeleton;
mod support;
mod vents;
mod ways;
