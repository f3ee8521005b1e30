use gudgeon_core::kinds::{Lateral, SecondaryMotion, SecondaryMotionSpec};
use gudgeon_core::quantity::{Length, quantity};
use gudgeon_core::{BuildError, register_model};
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
    fn build(&self) -> Result<Box<dyn SecondaryMotion>, BuildError> {
        Ok(Box::new(Still { e_top: self.e_top.si(), e_bottom: self.e_bottom.si() }))
    }
}

#[derive(Debug)]
struct Still {
    e_top: f64,
    e_bottom: f64,
}

impl SecondaryMotion for Still {
    fn lateral(&self) -> Lateral {
        Lateral::Held { e_top: self.e_top, e_bottom: self.e_bottom }
    }
}
