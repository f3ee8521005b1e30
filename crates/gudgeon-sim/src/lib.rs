//! Case files, scenes, the planner, the runner and studies.

// The models that a case names, and those that stand as defaults, must be linked.
use gudgeon_models as _;

pub mod case;
mod foresee;
pub mod load;
pub mod pin;
pub mod piston_secondary;
pub mod power_cylinder;
mod provenance;
pub mod rig;
pub mod ring_pack;
pub mod run;
pub mod scene;
pub mod shaft_line;
pub mod study;
pub mod sweep;
pub mod validate;
mod verify;

pub use run::{Checked, Explanation, Progress, RunError, check, explain, run, run_verified};
pub use study::{bench, compare, compare_verified};
