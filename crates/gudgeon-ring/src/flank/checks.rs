//! What the models check of the groove.

use gudgeon_core::BuildError;
use gudgeon_core::kinds::FlankCtx;

/// The oil-filled fraction is one.
pub(super) fn check_fill(ctx: &FlankCtx) -> Result<(), BuildError> {
    if (0.0..=1.0).contains(&ctx.oil_fill) {
        Ok(())
    } else {
        Err(BuildError::new(format!(
            "the groove of ring {} is filled with oil to {}, which is not between 0 and 1",
            ctx.ring + 1,
            ctx.oil_fill
        ))
        .help("write 60 % as \"60 %\" or 0.6"))
    }
}

/// Width and viscosity are positive.
pub(super) fn check_oil(ctx: &FlankCtx) -> Result<(), BuildError> {
    check_width(ctx)?;
    positive(ctx, ctx.mu, "the oil viscosity", "Pa s")
}

/// The width is positive.
pub(super) fn check_width(ctx: &FlankCtx) -> Result<(), BuildError> {
    positive(ctx, ctx.width, "the radial width of the flank", "m")
}

fn positive(ctx: &FlankCtx, value: f64, what: &str, unit: &str) -> Result<(), BuildError> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(BuildError::new(format!(
        "{what} of ring {} is {value:e} {unit}, which must be greater than zero",
        ctx.ring + 1
    )))
}
