use gudgeon_core::kinds::{PinForces, PinInstant, PinLoadCase, PinLoadCtx, PinLoadSpec};
use gudgeon_core::quantity::{Force, PosForce, quantity};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// Forces that are given.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Given {
    /// Gas force on the piston.
    pub gas: PosForce,
    /// Inertia force, negative where it relieves the pin.
    #[serde(default = "none")]
    pub inertia: Force,
}

fn none() -> Force {
    quantity(0.0)
}

#[register_model(
    name = "given",
    summary = "gas and inertia force as given",
    equations = "F = F_gas + F_in",
    validity = "One instant; the pressure shown is the gas force over the bore's area.",
    references = [],
    example = "gas = \"49.5 kN\"\ninertia = \"-1 kN\"\n",
)]
impl PinLoadSpec for Given {
    fn build(&self, ctx: &PinLoadCtx<'_>) -> Result<PinLoadCase, BuildError> {
        let forces = PinForces { gas: self.gas.si(), inertia: self.inertia.si() };
        if forces.total() == 0.0 {
            return Err(BuildError::at("inertia", "gas and inertia cancel: nothing loads the pin"));
        }
        let pressure = forces.gas / (ctx.pi * ctx.bore * ctx.bore / 4.0);
        let design = PinInstant { theta: 2.0 * std::f64::consts::PI, pressure, forces };
        Ok(PinLoadCase { design, ..PinLoadCase::default() })
    }
}
