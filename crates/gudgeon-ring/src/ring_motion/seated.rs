//! A ring that never leaves its seat.

use gudgeon_core::kinds::{RingForces, RingMotion, RingMotionCtx, RingMotionSpec, RingPose, RingResponse};
use gudgeon_core::states::Stateful;
use gudgeon_core::{BuildError, EvalError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A groove flank.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Flank {
    /// Towards the crankcase.
    #[default]
    Lower,
    /// Towards the head.
    Upper,
}

/// The ring rests on one flank for the whole cycle: axial motion switched off.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Seated {
    /// The flank it rests on.
    #[serde(default)]
    pub flank: Flank,
}

#[register_model(
    name = "seated",
    summary = "the ring rests on one flank for the whole cycle",
    equations = "s = 0 (lower flank) or s = c (upper flank)",
    validity = "Top rings at low speed and high load; every ring when only gas flow or film is of interest.",
    references = [],
    example = "flank = \"lower\"\n",
)]
impl RingMotionSpec for Seated {
    fn build(&self, _: RingMotionCtx) -> Result<Box<dyn RingMotion>, BuildError> {
        Ok(Box::new(Runtime {
            e: match self.flank {
                Flank::Lower => 0.0,
                Flank::Upper => 1.0,
            },
        }))
    }
}

struct Runtime {
    e: f64,
}

impl Stateful for Runtime {}

impl RingMotion for Runtime {
    fn moves(&self) -> bool {
        false
    }
    fn uses_film_force(&self) -> bool {
        false
    }
    fn uses_gravity(&self) -> bool {
        false
    }
    fn pose(&self, _: &[f64], clearance: f64) -> RingPose {
        RingPose::seated(self.e, clearance)
    }
    fn rates(&mut self, _: &[f64], _: &RingForces, _: &mut [f64]) -> Result<RingResponse, EvalError> {
        Ok(RingResponse::default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gudgeon_core::kinds::{FlankDampingCtx, FlankDampingSpec};

    #[test]
    fn rests_where_it_is_told() {
        let oil = FlankDampingCtx { ring: 2, rings: 3, oil_fill: 0.6, width: 5e-3, mu: 0.01 };
        for (flank, e) in [(Flank::Lower, 0.0), (Flank::Upper, 1.0)] {
            let damping = crate::DampingOff {}.build(&oil).expect("builds");
            let m =
                Seated { flank }.build(RingMotionCtx::new(2, 0.0, 0.0, 1.0, damping)).expect("always builds");
            let pose = m.pose(&[], 1e-4);
            assert_eq!((pose.s, pose.lift_fraction), (e * 1e-4, e));
            assert!(!m.moves() && !m.uses_film_force() && m.states().is_empty());
        }
    }
}
