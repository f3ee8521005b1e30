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

/// The ring rests on one flank for the whole cycle: axial motion switched off. A rail rests on the flank that its expander presses it onto.
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
    fn build(&self, ctx: RingMotionCtx) -> Result<Box<dyn RingMotion>, BuildError> {
        let given = match self.flank {
            Flank::Lower => 0.0,
            Flank::Upper => 1.0,
        };
        Ok(Box::new(Runtime { e: ctx.pressed_onto.unwrap_or(given) }))
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
