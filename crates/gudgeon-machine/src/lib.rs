//! One description of an engine and its piston, shared by every scene.
//!
//! A case has the tables `[engine]` and `[piston]` in whatever scene it is of, and a table that one scene reads is valid in all others. What a scene
//! cannot do without it requires where it declares the table, in the schema:
//!
//! ```ignore
//! /// Engine.
//! #[schemars(extend("required" = ["speed", "rod_length"]))]
//! pub engine: Engine,
//! /// Piston.
//! #[schemars(extend("x-used" = ["lands", "pin_to_ring1"]))]
//! pub piston: Piston,
//! ```
//!
//! Where it reads only some keys of a table it names them there too (`x-used`): `gudgeon explain` lists the others that a case gives, and a sweep of
//! one is refused.
//!
//! so that a case without it is refused with its line; the accessors here ([`Engine::crank`], [`Piston::body`]) refuse it too, for cases that no
//! file was read for.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]

mod engine;
mod piston;

pub use engine::{Crank, Engine};
pub use piston::{Body, GravityFrom, GravitySide, Land, Piston};
