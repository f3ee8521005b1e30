//! Random cases over all scenes and models, and what becomes of them.
//!
//! A case is a shipped one with one to six changes, drawn along the JSON schema of its scene and its resolved values ([`draw`]); no key is
//! listed by hand. It depends on the seed and its index alone. Cases run in child processes ([`child`]), so that one that never ends or
//! takes the process with it costs only itself. What came out is judged by [`class`], with bounds of physics in [`bounds`]; what is bad is
//! reduced to the changes that make it so ([`shrink`]) and told as commands ([`tell`]).

// The models that a case may name must be linked.
use gudgeon_models as _;

pub mod bounds;
pub mod campaign;
pub mod case;
pub mod child;
pub mod class;
pub mod corpus;
pub mod draw;
pub mod execute;
pub mod regression;
pub mod shrink;
pub mod sites;
pub mod tell;
pub mod text;
