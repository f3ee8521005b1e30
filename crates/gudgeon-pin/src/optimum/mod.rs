//! The lightest pin, exactly, with the residuals of the conditions that prove it to be one.
//!
//! Sequential quadratic programming with exact second derivatives on the logarithms of the utilisations, which makes the limits nearly
//! linear. At a corner of three limits the steps are Newton's method on those limits; elsewhere they are Newton's method on the
//! conditions of Karush, Kuhn and Tucker. Both end at rounding, and the conditions are evaluated there and handed out.

mod conditions;
mod program;
mod result;
mod sqp;
mod start;

use gudgeon_core::kinds::PinSize;

use crate::design::Design;

#[doc(hidden)]
pub use conditions::min_curvature;
pub use result::{BOUNDS, Bound, KKT_TOLERANCE, KktResiduals, NoOptimum, Optimum};

/// The lightest pin of a design near `from`, or from a start of its own.
///
/// # Errors
/// [`NoOptimum`].
pub fn lightest(d: &Design<'_>, from: Option<PinSize>) -> Result<Optimum, NoOptimum> {
    if d.min_inner(d.outer.high) > d.max_inner(d.outer.high) {
        // No limit of strength: there is no room for a bore and its wall.
        return Err(NoOptimum::Infeasible(d.blocking_limits(d.outer.high)));
    }
    let from = match from {
        Some(s) => s,
        None => start::feasible(d).ok_or_else(|| NoOptimum::Infeasible(d.blocking_limits(d.outer.high)))?,
    };
    let mut found = sqp::local_optimum(d, from);
    // A solid pin is stationary in its bore without being the lightest: the mass falls with the square of the bore. From there the search
    // starts again with the largest bore.
    for _ in 0..2 {
        let Err(NoOptimum::Unproven(o)) = &found else { break };
        let PinSize { length, outer, .. } = o.size;
        // Beyond the rounding of the limits that hold the solid pin; without room even there, from a hollow one that is not admitted.
        let (longer, wider) = (length * (1.0 + 1e-9), outer * (1.0 + 1e-9));
        let inner = d.max_feasible_inner_over(length, longer, wider, 1e-3).map_or(0.3 * outer, |i| 0.98 * i);
        found = sqp::local_optimum(d, PinSize { length, outer, inner });
    }
    found
}
