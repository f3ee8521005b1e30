//! Whole cases. One program for all of them: it is linked once, and its tests run side by side.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

#[path = "../common/mod.rs"]
mod common;

mod bench;
mod cases;
mod compare;
mod elsewhere;
mod extremes;
mod gas_balance;
mod gas_energy;
mod gas_states;
mod gradients;
mod implicit;
mod lazy;
mod limits;
mod loader_fuzz;
mod many;
mod oil;
mod oil_ring;
mod pin;
mod piston_secondary;
mod reference;
mod rheology;
mod rigs;
mod sampling;
mod shaft_line;
mod skirt_oil;
mod tomanik;
mod trends;
mod two_threads;
mod unused;
mod validation;
mod wear;
mod zottin;
