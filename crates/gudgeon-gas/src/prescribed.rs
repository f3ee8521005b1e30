//! Land pressures that are given: the gas flow switched off.

use gudgeon_core::kinds::{GasFlow, GasFlowCtx, GasFlowSpec, GasIn, GasOut};
use gudgeon_core::quantity::PosPressure;
use gudgeon_core::states::Stateful;
use gudgeon_core::{BuildError, EvalError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Constant pressures between the rings, no flow.
///
/// The space behind a ring has the pressure of the land it faces: `p_back = (1 - e) p_above + e p_below` with the position `e` in the
/// groove (0 on the lower flank, 1 on the upper one). What a film or a ring does under known pressures, without a gas model.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Prescribed {
    /// Absolute pressures of the lands between the rings, from the top: one less than there are rings.
    #[serde(default)]
    pub lands: Vec<PosPressure>,
}

#[register_model(
    name = "prescribed",
    summary = "given constant pressures between the rings; no flow is computed",
    equations = "p_land given;  p_back = (1 - e) p_above + e p_below;  m' = 0",
    validity = "Studies of films and rings under known pressures. Blow-by is zero by definition.",
    references = [],
    example = "lands = [\"6 bar\", \"2 bar\"]\n",
)]
impl GasFlowSpec for Prescribed {
    fn build(&self, ctx: &GasFlowCtx<'_>) -> Result<Box<dyn GasFlow>, BuildError> {
        let between = ctx.pack.rings.len().saturating_sub(1);
        if self.lands.len() != between {
            return Err(BuildError::at(
                "lands",
                format!(
                    "{} pressures are given, {} rings have {between} lands between them",
                    self.lands.len(),
                    ctx.pack.rings.len()
                ),
            ));
        }
        Ok(Box::new(Runtime { lands: self.lands.iter().map(|p| p.si()).collect() }))
    }
}

struct Runtime {
    lands: Vec<f64>,
}

impl Stateful for Runtime {}

impl GasFlow for Runtime {
    fn uses_end_gaps(&self) -> bool {
        false
    }
    fn uses_film_height(&self) -> bool {
        false
    }
    fn at_pressures(&self, _: &GasIn<'_>, _: &[f64], _: &mut [f64]) {}

    fn pressures(&mut self, inp: &GasIn<'_>, _: &[f64], out: &mut GasOut) -> Result<(), EvalError> {
        for (name, p) in [("cylinder", inp.p_cylinder), ("crankcase", inp.p_crankcase)] {
            if !(p > 0.0 && p.is_finite()) {
                return Err(EvalError::recoverable(
                    "prescribed",
                    format!("the {name} has the absolute pressure {p:e} Pa"),
                ));
            }
        }
        let n = inp.rings.len();
        out.p_land[0] = inp.p_cylinder;
        out.p_land[1..n].copy_from_slice(&self.lands);
        out.p_land[n] = inp.p_crankcase;
        for (i, ring) in inp.rings.iter().enumerate() {
            let e = ring.lift_fraction.clamp(0.0, 1.0);
            out.p_back[i] = (1.0 - e) * out.p_land[i] + e * out.p_land[i + 1];
        }
        Ok(())
    }

    fn rates(
        &mut self,
        inp: &GasIn<'_>,
        state: &[f64],
        _: &mut [f64],
        out: &mut GasOut,
    ) -> Result<(), EvalError> {
        self.pressures(inp, state, out)?;
        out.flow_in.fill(0.0);
        out.flow_out.fill(0.0);
        Ok(())
    }
}
