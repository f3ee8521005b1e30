//! A sub-model outside the physics crates of Gudgeon.
//!
//! `reynolds_exponential.rs` is all there is to it: a specification with its documentation, one `#[register_model]`, the running model.
//! Case files, `models`, `describe`, `schema`, validation with places, `compare` and `bench` follow from that.

mod reynolds_exponential;

pub use reynolds_exponential::ReynoldsExponential;

gudgeon_core::link!(ReynoldsExponential,);
