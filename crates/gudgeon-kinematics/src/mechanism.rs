//! What every crank mechanism needs.

use gudgeon_core::BuildError;
use gudgeon_core::kinds::KinematicsCtx;

/// Checks that the mechanism exists and turns all the way round.
pub(crate) fn check_mechanism(ctx: &KinematicsCtx) -> Result<(), BuildError> {
    let KinematicsCtx { crank_radius: r, rod_length: l, offset: e, omega } = *ctx;
    for (name, v) in [("crank_radius", r), ("rod_length", l), ("omega", omega)] {
        if !(v.is_finite() && v > 0.0) {
            return Err(BuildError::at(
                name,
                format!("{name} is {v}, it must be a number greater than zero"),
            ));
        }
    }
    if !e.is_finite() {
        return Err(BuildError::at("offset", format!("offset is {e}, it must be a number")));
    }
    if l <= r + e.abs() {
        let what = format!(
            "the crank cannot turn: the rod ({l} m) must be longer than the crank radius ({r} m) plus the offset ({} m)",
            e.abs()
        );
        return Err(BuildError::at("rod_length", what));
    }
    Ok(())
}
