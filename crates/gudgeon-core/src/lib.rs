//! What every part of Gudgeon agrees on: the sub-model traits with their inputs and outputs, the model registry,
//! quantities with units, results, errors. No physics lives here.
//!
//! # Conventions
//!
//! * SI `f64` everywhere; a name that holds anything else carries a suffix (`theta_deg`).
//! * Crank angle `theta` \[rad\], 0 at the gas-exchange top dead centre (start of intake), 2π at the firing one of a
//!   four-stroke cycle; it counts from the crank throw pointing at the head.
//! * Axial direction: positive towards the cylinder head ("up"). Face coordinate `x` runs from the bottom edge (crankcase
//!   side) to the top edge of the ring face.
//! * Rings count from the crown, ring 1 first; `land 1` is the top land above ring 1, `land n+1` the space below ring n.
//!   Slices are zero-based: `lands[0]` is land 1.
//! * Pressures are absolute unless said otherwise. `p_cav` is the pressure below which a film cannot go.
//!
//! # What a physics crate brings along
//!
//! `gudgeon-film`, `-gas` or `-torsion` alone are 48 packages with all they depend on (`cargo tree -p gudgeon-film -e normal`): 20 are
//! `gudgeon-numerics` and its linear algebra, most of the others serde and schemars, because a specification can be read, written and described
//! wherever it is used, and so are models that hold others (`Box<dyn …Spec>`, see [`spec`]). There is no feature to leave that out: it would
//! stand on every specification and save 6 packages. Reading case files (TOML, places, diagnostics) is `gudgeon-case`, which no physics crate
//! depends on; the program as a whole is 129 packages.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]

pub mod content;
pub mod error;
pub mod face;
pub mod file;
pub mod geometry;
pub mod kinds;
pub mod registry;
pub mod sets;
pub mod spec;
pub mod states;
mod stopwatch;
mod word;

// The attributes name this crate by its name, also inside it.
extern crate self as gudgeon_core;

/// What the registering attributes and macros name.
#[doc(hidden)]
pub mod __private {
    pub use {dyn_clone, inventory, schemars, serde, serde_json, typetag};
}
#[doc(hidden)]
pub use {inventory, schemars, serde_json};

pub use gudgeon_macros::{register_kind, register_model};

pub use error::{BuildError, EvalError};
pub use gudgeon_numerics::{Stopped, elementary, unwatched};
pub use registry::{KindInfo, ModelInfo, Registry};
pub use stopwatch::Stopwatch;
pub use word::Word;
pub use {gudgeon_result as result, gudgeon_units as quantity};
