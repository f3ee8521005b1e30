use gudgeon_core::kinds::{PinLoadCase, PinLoadCtx, PinLoadSpec};
use gudgeon_core::quantity::{Mass, NonNegative};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

use super::search::over_cycle;

/// Gas and inertia over the cycle of the engine of another case file.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OtherCase {
    /// The case file, relative to this one: its speed, crank drive, cylinder pressure and crankcase pressure are taken.
    pub case: String,
    /// Mass of the piston with its rings, without the pin.
    pub piston_mass: Mass<NonNegative>,
}

#[register_model(
    name = "other_case",
    summary = "gas and inertia over the cycle of the engine of another case file",
    equations = "F_gas = (p - p_crankcase) pi D^2/4;  F_in = m a;  sized for max |F_gas + F_in|",
    validity = "The bore of both cases must be the same. Only cylinder pressure and piston motion of the other case are evaluated.",
    references = [],
    example = "case = \"turbo-diesel-120.toml\"\npiston_mass = \"2.1 kg\"\n",
)]
impl PinLoadSpec for OtherCase {
    fn build(&self, ctx: &PinLoadCtx<'_>) -> Result<PinLoadCase, BuildError> {
        let engine = (ctx.cycle_of)(&self.case).map_err(|e| BuildError { field: "case".into(), ..e })?;
        // Both files write the bore in millimetres; beyond rounding it is another engine.
        if (engine.bore - ctx.bore).abs() > 1e-9 * ctx.bore {
            let what = format!(
                "`{}` has a bore of {} mm, this case one of {} mm",
                self.case,
                1e3 * engine.bore,
                1e3 * ctx.bore
            );
            return Err(BuildError::at("case", what));
        }
        over_cycle(&engine, ctx.pi, self.piston_mass.si())
    }
}
