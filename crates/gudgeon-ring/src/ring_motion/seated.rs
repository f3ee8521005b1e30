//! A ring that never leaves its seat.

use gudgeon_core::kinds::{AxialForces, Motion, RingMotion, RingMotionCtx, RingMotionSpec};
use gudgeon_core::{BuildError, register_model};
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
    fn build(&self, _: &RingMotionCtx) -> Result<Box<dyn RingMotion>, BuildError> {
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

impl RingMotion for Runtime {
    fn motion(&self) -> Motion {
        Motion::Fixed { e: self.e }
    }
    fn uses_film_force(&self) -> bool {
        false
    }
    fn uses_gravity(&self) -> bool {
        false
    }
    fn flank_reaction(&self, _: f64, _: f64, _: f64) -> f64 {
        0.0
    }
    fn seat(&self, _: &AxialForces) -> f64 {
        self.e
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rests_where_it_is_told() {
        let ctx = RingMotionCtx { mass: 0.0, clearance: 0.0, flank_area: 0.0, ring: 2 };
        for (flank, e) in [(Flank::Lower, 0.0), (Flank::Upper, 1.0)] {
            let m = Seated { flank }.build(&ctx).expect("always builds");
            assert_eq!(m.motion(), Motion::Fixed { e });
            assert_eq!(m.seat(&AxialForces { gas: 1e4, ..AxialForces::default() }), e);
            assert!(!m.uses_film_force());
        }
    }
}
