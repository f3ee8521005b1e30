use gudgeon_core::kinds::{
    LateralLoads, LateralPartials, LateralPose, MotionPart, SecondaryMotion, SecondaryMotionCtx,
    SecondaryMotionSpec,
};
use gudgeon_core::quantity::{Length, quantity};
use gudgeon_core::states::Stateful;
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

/// No motion across the bore: the skirt stands where it is told.
///
/// For static points, and for friction of a skirt whose place is known.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Held {
    /// Displacement of the upper edge towards the anti-thrust side.
    #[serde(default = "centred")]
    pub e_top: Length,
    /// Displacement of the lower edge towards the anti-thrust side.
    #[serde(default = "centred")]
    pub e_bottom: Length,
}

fn centred() -> Length {
    quantity(0.0)
}

#[register_model(
    name = "held",
    summary = "no motion across the bore: the skirt stands where it is told",
    equations = "e_t, e_b constant",
    validity = "Friction and pressures of a given place; forces are not in balance.",
    references = [],
    example = "e_top = \"-1 um\"\ne_bottom = \"-2 um\"\n",
)]
impl SecondaryMotionSpec for Held {
    fn build(&self, _: &SecondaryMotionCtx) -> Result<Box<dyn SecondaryMotion>, BuildError> {
        Ok(Box::new(Still { e: [self.e_top.si(), self.e_bottom.si()] }))
    }
}

#[derive(Debug)]
struct Still {
    e: [f64; 2],
}

impl Stateful for Still {}

impl SecondaryMotion for Still {
    fn pose(&self, _: &[f64]) -> LateralPose {
        LateralPose::new(self.e).moving([0.0; 2])
    }

    fn rates(&mut self, _: &[f64], _: &mut dyn LateralLoads, _: &mut [f64]) -> Result<(), EvalError> {
        Ok(())
    }

    fn partials(&mut self, _: &[f64], _: &LateralPartials<'_>, _: &mut [f64]) -> bool {
        true
    }

    fn time_partials(&mut self, _: [f64; 2], _: &mut [f64]) -> bool {
        true
    }

    fn moves(&self) -> bool {
        false
    }

    fn start_keys(&self) -> Option<[&'static str; 2]> {
        Some(["e_top", "e_bottom"])
    }

    fn parts(&self) -> Vec<MotionPart> {
        vec![MotionPart::left_out("motion across the bore", "`held`: the skirt stands where it is told")]
    }
}
