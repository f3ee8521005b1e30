//! Tests of the crate, one module a topic.

use gudgeon_ring as _; // links the models, which are asked for by name

mod conventions;
mod flank;
mod flank_friction;
mod radial_motion;
mod registered;
mod ring_motion;
