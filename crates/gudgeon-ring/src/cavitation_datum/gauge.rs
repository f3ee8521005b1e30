//! Films cavitate at crankcase pressure.

use gudgeon_core::kinds::{CavitationDatum, CavitationDatumSpec};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Crankcase pressure, or the lower of the two edge pressures when that is below: oil that stood under crankcase pressure is saturated with gas there.
///
/// ```text
/// p_cav = min(p_crankcase, p_above, p_below)
/// ```
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gauge {}

#[register_model(
    name = "gauge",
    summary = "crankcase pressure, or the lower of the two land pressures",
    equations = "p_cav = min(p_crankcase, p_above, p_below)",
    validity = "Oil saturated with gas at crankcase pressure, which it gives off below that.",
    references = [],
    example = "",
)]
impl CavitationDatumSpec for Gauge {
    fn build(&self) -> Result<Box<dyn CavitationDatum>, BuildError> {
        Ok(Box::new(*self))
    }
}

impl CavitationDatum for Gauge {
    fn pressure(&self, p_crankcase: f64, p_above: f64, p_below: f64) -> f64 {
        p_crankcase.min(p_above).min(p_below)
    }
}
