//! Many runs: comparisons of models and settings, run time against error of solvers, validation against sources; where to run and what the
//! results depend on.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]

pub mod anova;
mod bench;
mod compare;
pub mod distribution;
mod error;
pub mod gradients;
mod normal;
mod random;
pub mod sampling;
pub mod sensitivity;
pub mod study;
pub mod validate;

pub use bench::bench;
pub use compare::{Plan, Subject, compare, compare_cases, shares};
pub use error::StudyError;
