//! A sub-model outside the physics crates of Gudgeon.
//!
//! `walther.rs` is all there is to it: a specification with its documentation, one `#[register_model]`, the running model.
//! Case files, `models`, `describe`, `schema`, validation with places, `compare` and `bench` follow from that.

mod walther;

pub use walther::Walther;

gudgeon_core::link!(Walther,);
