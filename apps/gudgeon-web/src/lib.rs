//! The playground: reads, changes, runs and keeps cases for a page, in a browser and without a server.
//!
//! The page asks in JSON ([`answer`]) and is answered in JSON. In WebAssembly the texts go through the memory of the module (`abi.rs`); on this
//! machine the same function is called by tests. Sliders, choices and headlines come from the schema and the resolved case; what a scene
//! shows first stands in [`shown`].

#[cfg(target_family = "wasm")]
mod abi;
mod cases;
mod controls;
mod drawings;
mod place;
mod playground;
mod request;
pub mod shown;
mod swap;

pub use cases::{CASES, files};
pub use controls::{Choice, Slider};
pub use playground::Playground;
pub use request::{Request, answer};
