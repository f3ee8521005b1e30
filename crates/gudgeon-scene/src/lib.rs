//! What a scene is, and what is the same for all scenes: reading and checking a case, explaining, running, sweeping and verifying it.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]

pub mod elsewhere;
mod error;
mod explanation;
pub mod foresee;
pub mod gradients;
mod heading;
pub mod many;
mod provenance;
pub mod run;
mod scene;
mod second;
mod solver_table;
mod sweep;
mod sweep_input;
mod verify;
mod work_precision;

#[doc(hidden)]
pub use gudgeon_case::help_at;
pub use gudgeon_core::{Stopped, unwatched};
#[doc(hidden)]
pub use gudgeon_core::{inventory, registry::Linked};

pub use error::{Progress, RunError};
pub use explanation::{ExplainedModel, Explanation, model_use};
pub use gradients::{GradientError, Varied};
pub use heading::{Headed, Heading};
pub use provenance::sha256;
pub use run::{Checked, check, check_case, check_source, explain, run, run_verified};
pub use scene::{
    Scene, SceneCase, SceneInfo, SceneName, case_schemas, changed, help, load, read_case, scenes,
    verify_scenes,
};
pub use second::{SecondThread, Threads, receive, with_threads};
pub use solver_table::{SolverCommon, SolverTable, default_solvers};
pub use sweep_input::{Axis, Spacing, Sweep, number, values};
pub use work_precision::{Asked, MethodSetting, OtherMethod, Reference, WorkPrecision};
