use gudgeon_core::kinds::{Lateral, SecondaryMotion, SecondaryMotionSpec};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// Newton's law for the lateral motion and the tilt.
///
/// `M (ë_t, ë_b) = (forces on both edges)`: four states. The films answer to a change of velocity within nanoseconds, which an implicit
/// integrator passes over.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FullInertia {}

#[register_model(
    name = "full_inertia",
    summary = "piston and pin with their inertia across the bore",
    equations = "M d2(e_t, e_b)/dt2 = film + contact + rod + gas and inertia about the pin + friction;  \
                M = sum m grad(e) grad(e) + I/L^2 (1, -1)(1, -1)",
    validity = "Rigid piston whose pin is fixed in it; small angles; constant crank speed.",
    references = ["zhu1992", "loureiro2009"],
    example = "",
)]
impl SecondaryMotionSpec for FullInertia {
    fn build(&self) -> Result<Box<dyn SecondaryMotion>, BuildError> {
        Ok(Box::new(Inertial))
    }
}

#[derive(Debug)]
struct Inertial;

impl SecondaryMotion for Inertial {
    fn lateral(&self) -> Lateral {
        Lateral::Inertial
    }
}
