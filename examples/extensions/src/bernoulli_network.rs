//! A gas law: incompressible orifices on the skeleton of a gas model.

use gudgeon_core::kinds::{GasFlow, GasFlowCtx, GasFlowSpec};
use gudgeon_core::quantity::{Fraction, Ratio, quantity};
use gudgeon_core::{BuildError, register_model};
use gudgeon_gas::{Area, FlowPartials, GasState, OrificeAreas, PackNetwork, PackOptions, PassageLaw};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Orifices without compressibility, `ṁ = C_d A √(2 ρ_u (p_u - p_d))` with the density upstream: what a handbook of liquids would say.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BernoulliNetwork {
    /// Discharge coefficient.
    pub discharge: Ratio<Fraction>,
    /// Pressure difference over the upstream pressure below which the flow is linear in it.
    pub laminar: Ratio<Fraction>,
}

impl Default for BernoulliNetwork {
    fn default() -> Self {
        Self { discharge: quantity(0.86), laminar: quantity(1e-3) }
    }
}

#[register_model(
    name = "bernoulli_network",
    summary = "incompressible orifices at gap, flanks and face",
    equations = "m' = C_d A sqrt(2 rho_u (p_u - p_d));  linear below the relative pressure difference `laminar`",
    validity = "Pressure differences small against the pressure. It does not choke: at the largest ones it lets twice as much through as a compressible orifice.",
    references = [],
    example = "discharge = 0.86\nlaminar = 1e-3\n",
)]
impl GasFlowSpec for BernoulliNetwork {
    fn build(&self, ctx: &GasFlowCtx<'_>) -> Result<Box<dyn GasFlow>, BuildError> {
        if self.laminar.si() <= 0.0 {
            return Err(BuildError::at("laminar", "the derivative of a root is infinite at zero"));
        }
        let law = Bernoulli { discharge: self.discharge.si(), laminar: self.laminar.si() };
        let areas = OrificeAreas::default();
        Ok(Box::new(PackNetwork::new("bernoulli_network", areas, law, ctx.pack, PackOptions::default())?))
    }
}

struct Bernoulli {
    discharge: f64,
    laminar: f64,
}

impl Bernoulli {
    /// Flow from a higher to a lower pressure and its derivatives by both.
    fn downhill(&self, area: f64, up: &GasState, down: &GasState) -> (f64, f64, f64) {
        let (p, q) = (up.pressure(), down.pressure());
        let k = self.discharge * area * up.inv_sqrt_rt() * std::f64::consts::SQRT_2;
        let (d, least) = (p - q, self.laminar * p);
        if d < least {
            // The chord of the root: `k p √ε d/(ε p)`.
            let c = k / self.laminar.sqrt();
            return (c * d, c, -c);
        }
        let root = (p * d).sqrt();
        (k * root, 0.5 * k * (2.0 * p - q) / root, -0.5 * k * p / root)
    }
}

impl PassageLaw for Bernoulli {
    type Passage = Area;

    fn mass_flow_partials(&self, Area(area): Area, a: &GasState, b: &GasState) -> FlowPartials {
        if a.pressure() >= b.pressure() {
            let (flow, by_a, by_b) = self.downhill(area, a, b);
            FlowPartials { flow, by_a, by_b }
        } else {
            let (flow, by_b, by_a) = self.downhill(area, b, a);
            FlowPartials { flow: -flow, by_a: -by_a, by_b: -by_b }
        }
    }
}
