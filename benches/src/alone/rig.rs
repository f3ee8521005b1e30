//! Test benches.

use gudgeon_core::file::Files;
use gudgeon_core::kinds::{RigCtx, RigOut, RigSpec};
use gudgeon_core::{BuildError, ModelInfo};

use super::{Alone, alone, seen};

/// A run of the bench.
pub fn rig(m: &ModelInfo) -> Result<Alone, String> {
    let all = |wrong: Vec<BuildError>| wrong.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ");
    alone::<dyn RigSpec, _, _>(
        m,
        move |s| s.build(&RigCtx { files: &Files::default() }).map_err(all),
        |bench| {
            let mut out = RigOut::default();
            bench.run(&mut out)?;
            seen(out)
        },
    )
}
