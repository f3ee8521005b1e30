//! A line over time that is held at the mean speed of its case.

use gudgeon_core::kinds::{DriveSpec, Line, LineDrive, TorsionCtx, TorsionOut, TorsionSpec};
use gudgeon_core::quantity::quantity;
use gudgeon_scene::RunError;
use gudgeon_torsion::drive::Constant;
use gudgeon_torsion::torsion::HarmonicBalance;

use super::{failed, one};

/// The line with the constant torque that holds its mean speed, on the inertias that balance it.
///
/// # Errors
/// A line without a periodic motion.
pub fn held(ctx: &TorsionCtx<'_>) -> Result<Line, RunError> {
    let mut periodic = TorsionOut::default();
    HarmonicBalance::default().build(ctx).map_err(one)?.run(&mut periodic).map_err(failed)?;
    let mut line = ctx.line.clone();
    for (node, share) in ctx.balance.iter().enumerate().filter(|(_, share)| **share != 0.0) {
        // Counted at the reference shaft: an inertia that turns faster needs less.
        let torque = periodic.balance_torque * share / line.nodes[node].ratio;
        let drive = Constant { torque: quantity(torque) }.build().map_err(one)?;
        line.drives.push(LineDrive { node, phase: 0.0, factor: 1.0, drive });
    }
    Ok(line)
}
