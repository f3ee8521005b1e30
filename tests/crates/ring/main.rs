//! Tests of the crate, one module a topic.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

use gudgeon_ring as _; // links the models, which are asked for by name

mod conventions;
mod flank;
mod flank_friction;
mod radial_motion;
mod registered;
mod ring_motion;
