//! What a model of Gudgeon must keep, as checks for the tests of one's own models. Gudgeon runs the same over its own.
//!
//! | to check | use |
//! |---|---|
//! | all that is registered: names, texts, examples, keys, schema | [`check_crate`] for the models of one crate, [`check_all`] for all, [`contract`] for one model |
//! | a model built from its own example | [`example_of`] |
//! | references against a BibTeX file | [`Bibliography`] |
//! | partial derivatives against difference quotients | [`partials`] |
//! | that the same question gives the same bytes, also after another | [`same_answer`] |
//! | that no input gives a NaN | [`all_finite`] |
//! | states, memory and columns of a running model | [`stateful`] |
//! | that a model reads no more than it declares | [`reads`] |
//! | a running model of a kind | [`contact`], [`cylinder_pressure`], [`gas_flow`], [`hydrodynamics`], [`kinematics`], [`oil`], [`pin_strength`] |
//!
//! A check gives its complaints as a list, empty when all is well; [`assert_none`] ends a test with all of them together. What a check cannot
//! know (a closed form, a limit, an observed order of convergence) the tests of the model show.
//!
//! ```
//! # use gudgeon_core::kinds::{Oil, OilSpec};
//! # use gudgeon_core::quantity::PosViscosity;
//! # use gudgeon_core::{BuildError, register_model};
//! /// The same viscosity at every temperature.
//! #[derive(Debug, Clone, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
//! #[serde(deny_unknown_fields)]
//! pub struct Syrup {
//!     /// Dynamic viscosity.
//!     viscosity: PosViscosity,
//! }
//!
//! #[register_model(
//!     name = "syrup", summary = "an oil that does not know its temperature", equations = "mu = constant",
//!     validity = "Comparisons with closed forms.", references = [], example = "viscosity = \"0.1 Pa s\"\n",
//! )]
//! impl OilSpec for Syrup {
//!     fn build(&self) -> Result<Box<dyn Oil>, BuildError> {
//!         Ok(Box::new(Running(self.viscosity.si())))
//!     }
//! }
//! # #[derive(Debug)]
//! # struct Running(f64);
//! # impl Oil for Running {
//! #     fn viscosity(&self, _temperature: f64) -> f64 {
//! #         self.0
//! #     }
//! # }
//!
//! let registry = gudgeon_core::Registry::collect();
//! let model = registry.model("oil", "syrup").unwrap();
//! # let mut model = gudgeon_core::ModelInfo { ..*model };
//! # model.file = "syrup.rs"; // a documentation test has no file of its own
//! gudgeon_testkit::assert_none(gudgeon_testkit::contract(&registry, &model));
//!
//! let spec: Box<dyn OilSpec> = serde_json::from_str(r#"{ "model": "syrup", "viscosity": "0.1 Pa s" }"#).unwrap();
//! gudgeon_testkit::assert_none(gudgeon_testkit::oil(&*spec.build().unwrap()));
//! ```
#![cfg_attr(doctest, doc = include_str!("../README.md"))]

mod bibliography;
mod contract;
mod differences;
mod kinds;
mod repeat;
mod schema;
mod states;

pub use bibliography::Bibliography;
pub use contract::{check_all, check_crate, contract, example_of, for_every_model};
pub use differences::{Tolerance, partials};
pub use kinds::{contact, cylinder_pressure, gas_flow, hydrodynamics, kinematics, oil, pin_strength};
pub use repeat::{all_finite, same_answer};
pub use schema::undescribed;
pub use states::{reads, stateful};

/// Ends a test that has complaints, with all of them.
///
/// # Panics
/// When there are any.
#[track_caller]
pub fn assert_none(complaints: Vec<String>) {
    assert!(complaints.is_empty(), "\n{}", complaints.join("\n"));
}
