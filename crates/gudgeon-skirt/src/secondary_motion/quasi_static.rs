use gudgeon_core::kinds::{Lateral, SecondaryMotion, SecondaryMotionSpec};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// Balance of forces at every instant, without the inertia of the motion across the bore.
///
/// `0 = (forces on both edges)`: the velocities are those at which the films carry the load, and the positions are the only states. The
/// inertia left out is a ten-thousandth of the side force in an engine; what is lost is the answer of the film within nanoseconds, and the
/// flight of a piston through a clearance without oil.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct QuasiStatic {}

#[register_model(
    name = "quasi_static",
    summary = "films, contact and rod in balance at every instant; the inertia across the bore is left out",
    equations = "0 = film + contact + rod + gas and inertia about the pin + friction, solved for (de_t/dt, de_b/dt)",
    validity = "A film on both sides; the forces of lateral inertia (m e/dt^2) small against the side force.",
    references = ["loureiro2009"],
    example = "",
)]
impl SecondaryMotionSpec for QuasiStatic {
    fn build(&self) -> Result<Box<dyn SecondaryMotion>, BuildError> {
        Ok(Box::new(Balanced))
    }
}

#[derive(Debug)]
struct Balanced;

impl SecondaryMotion for Balanced {
    fn lateral(&self) -> Lateral {
        Lateral::QuasiStatic
    }
}
