use gudgeon_core::kinds::{CylinderPressure, CylinderPressureCtx, CylinderPressureSpec};
use gudgeon_core::quantity::{PosPressure, quantity};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// One pressure at all crank angles: an engine motored without valves or cylinder head, a compressor shut off.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Constant {
    /// Absolute pressure.
    #[serde(default = "one_bar")]
    pub pressure: PosPressure,
}

fn one_bar() -> PosPressure {
    quantity(1e5)
}

impl Default for Constant {
    fn default() -> Self {
        Self { pressure: one_bar() }
    }
}

#[register_model(
    name = "constant",
    summary = "the same pressure at all crank angles, for motoring without valves",
    equations = "p = const",
    validity = "Motored rigs without gas exchange or head.",
    references = [],
    example = "pressure = \"1 bar\"\n",
)]
impl CylinderPressureSpec for Constant {
    fn build(&self, _: &CylinderPressureCtx<'_>) -> Result<Box<dyn CylinderPressure>, BuildError> {
        Ok(Box::new(Level { pressure: self.pressure.si() }))
    }
}

#[derive(Debug, Clone)]
struct Level {
    pressure: f64,
}

impl CylinderPressure for Level {
    fn pressure(&self, _: f64) -> f64 {
        self.pressure
    }
    fn kinks(&self) -> &[f64] {
        &[]
    }
    fn period(&self) -> f64 {
        crate::periodic::FOUR_STROKE
    }
    fn depends_on_speed(&self) -> bool {
        false
    }
}
