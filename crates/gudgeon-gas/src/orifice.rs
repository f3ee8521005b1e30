//! Configuration of the orifice law that the built-in models share.

use gudgeon_core::BuildError;
use gudgeon_core::quantity::{Bound as _, Fraction, NonNegative, PosRatio, Ratio, quantity};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::flow_function::FlowFunction;
use crate::heat_capacity::Gamma;
use crate::orifice_law::OrificeLaw;

/// Which formula gives the flow through an opening.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum OrificeFormula {
    /// Isentropic flow of a perfect gas, choked below the critical pressure ratio of its `gamma`, with a laminar branch
    /// near zero pressure difference.
    #[default]
    Isentropic,
    /// The same formula as printed by Zottin (1992): choking at the pressure ratio 0.53 whatever `gamma`, with the rounded
    /// factor 0.259, and no laminar branch. The two pieces do not quite meet (a jump of 0.08 % for `gamma` = 1.4).
    IsentropicTruncated,
}

/// The orifice law.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Orifice {
    /// Discharge coefficient `C_d`: effective over geometric area. 0.86 was measured for piston-ring gaps (0.8 to 0.9).
    #[serde(default = "default_discharge")]
    pub discharge: PosRatio,
    /// Formula.
    #[serde(default)]
    pub law: OrificeFormula,
    /// `ε` of the laminar branch: below a relative pressure difference of about `ε` the flow is proportional to the pressure
    /// difference instead of its square root. 0 gives the bare law, whose slope is infinite at zero pressure difference and
    /// which suits only explicit schemes with fixed steps. Not used by `isentropic_truncated`.
    #[serde(default = "default_laminar")]
    pub laminar: Ratio<NonNegative>,
    /// Ratio of specific heats in the law: the machine's constant one, or that of a gas at the temperature it comes with.
    #[serde(default)]
    pub gamma: Gamma,
}

fn default_discharge() -> PosRatio {
    quantity(0.86)
}
fn default_laminar() -> Ratio<NonNegative> {
    quantity(1e-3)
}

impl Default for Orifice {
    fn default() -> Self {
        Self {
            discharge: default_discharge(),
            law: OrificeFormula::default(),
            laminar: default_laminar(),
            gamma: Gamma::default(),
        }
    }
}

impl Orifice {
    /// Prepares the law for a gas.
    ///
    /// # Errors
    /// `gamma` not between 1 and 2, `gas_constant` not positive, `discharge` above 1.
    pub fn build(&self, gamma: f64, gas_constant: f64) -> Result<OrificeLaw, BuildError> {
        if !Fraction::admits(self.discharge.si()) {
            return Err(BuildError::at(
                "discharge",
                format!("the discharge coefficient {} is greater than 1", self.discharge.si()),
            )
            .help("measured values for ring gaps lie between 0.6 and 0.9"));
        }
        if !(gas_constant > 0.0 && gas_constant.is_finite()) {
            return Err(BuildError::new(format!("the gas constant {gas_constant} J/(kg K) is not positive")));
        }
        let flow_function = FlowFunction::new(gamma)?;
        let truncated = self.law == OrificeFormula::IsentropicTruncated;
        Ok(OrificeLaw::new(flow_function, self.discharge.si(), self.laminar.si(), truncated))
    }

    /// One law per temperature \[K\], for gas that comes with it; none when the ratio of specific heats is constant.
    ///
    /// # Errors
    /// As [`build`](Self::build).
    pub fn laws(
        &self,
        temperatures: &[f64],
        gamma: f64,
        gas_constant: f64,
    ) -> Result<Vec<OrificeLaw>, BuildError> {
        if self.gamma == Gamma::Constant {
            return Ok(Vec::new());
        }
        temperatures.iter().map(|&t| self.build(self.gamma.at(t, gamma), gas_constant)).collect()
    }
}
