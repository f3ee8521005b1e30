//! Tests of the crate, one module a topic.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

use gudgeon_contact as _;

mod abbott_firestone;
mod asperity_integral;
mod boundary_friction;
mod crest_wedge;
mod greenwood_tripp;
mod linear_penalty;
mod load_sharing;
mod models;
mod summits;
