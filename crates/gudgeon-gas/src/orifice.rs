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
    /// What the discharge coefficient loses towards equal pressures: `C_d = discharge - discharge_fall (p_d/p_u)²`. 0, the default: a constant
    /// coefficient. Jets of sharp edges contract less the faster they are: `discharge = 0.85` with `discharge_fall = 0.25` goes from 0.85 into a
    /// vacuum to 0.60 of incompressible flow, and between lies up to 9 % above Jobson's theory of the contraction (which has 0.87 and 0.60).
    #[serde(default = "no_fall")]
    pub discharge_fall: Ratio<NonNegative>,
    /// Formula.
    #[serde(default)]
    pub law: OrificeFormula,
    /// `ε` of the laminar branch: below a relative pressure difference of about `ε` the flow is proportional to the pressure
    /// difference instead of its square root. 0 gives the bare law, whose slope is infinite at zero pressure difference: below a relative difference of 1e-8 (in the rig
    /// `gas_volumes`, ten times its tolerance) a parabola stands for it. Not used by `isentropic_truncated`.
    #[serde(default = "default_laminar")]
    pub laminar: Ratio<NonNegative>,
    /// Ratio of specific heats in the law: the machine's constant one, or that of a gas at the temperature it comes with.
    #[serde(default)]
    pub gamma: Gamma,
}

fn default_discharge() -> PosRatio {
    quantity(0.86)
}
fn no_fall() -> Ratio<NonNegative> {
    quantity(0.0)
}
fn default_laminar() -> Ratio<NonNegative> {
    quantity(1e-3)
}

impl Default for Orifice {
    fn default() -> Self {
        Self {
            discharge: default_discharge(),
            discharge_fall: no_fall(),
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
    /// `gamma` not between 1 and 2, `gas_constant` not positive, `discharge` above 1, `discharge_fall` that leaves nothing of it.
    pub fn build(&self, gamma: f64, gas_constant: f64) -> Result<OrificeLaw, BuildError> {
        if !Fraction::admits(self.discharge.si()) {
            return Err(BuildError::at(
                "discharge",
                format!("the discharge coefficient {} is greater than 1", self.discharge.si()),
            )
            .help("measured values for ring gaps lie between 0.6 and 0.9"));
        }
        let (discharge, fall) = (self.discharge.si(), self.discharge_fall.si());
        if fall >= discharge {
            return Err(BuildError::at(
                "discharge_fall",
                format!("the discharge coefficient {discharge} falls by {fall}: nothing is left at equal pressures"),
            )
            .help("0.25 of 0.85 for sharp edges, 0 for a constant coefficient"));
        }
        if !(gas_constant > 0.0 && gas_constant.is_finite()) {
            return Err(BuildError::new(format!("the gas constant {gas_constant} J/(kg K) is not positive")));
        }
        let flow_function = FlowFunction::new(gamma)?;
        let truncated = self.law == OrificeFormula::IsentropicTruncated;
        Ok(OrificeLaw::new(flow_function, discharge, fall / discharge, self.laminar.si(), truncated))
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
