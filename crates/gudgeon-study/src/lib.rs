//! Many runs: comparisons of models and settings, run time against error of solvers, validation against sources.

mod bench;
mod compare;
mod error;
pub mod validate;

pub use bench::bench;
pub use compare::{compare, compare_verified};
pub use error::StudyError;
