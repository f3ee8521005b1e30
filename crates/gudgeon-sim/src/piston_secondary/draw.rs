//! Pictures of the motion.

use gudgeon_core::result::RunResult;

use super::assemble::Assembly;
use super::case::PistonSecondaryCase;
use super::record::Record;

/// Adds the figures of a run.
pub fn figures(_case: &PistonSecondaryCase, _a: &Assembly, _record: &Record, _result: &mut RunResult) {}
