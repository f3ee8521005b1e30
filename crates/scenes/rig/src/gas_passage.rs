use gudgeon_core::kinds::{Rig, RigCtx, RigOut, RigSpec, named};
use gudgeon_core::quantity::{
    PosArea, PosGasConstant, PosLength, PosPressure, PosRatio, PosTemperature, PosViscosity, quantity,
};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_gas::{FlowFunction, Network, Orifice, Passage, channel_conductance, sutherland_viscosity};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::draw::{self, Scales, law_error, line};

/// Flow through one passage over the ratio of the pressures on its sides.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GasPassageRig {
    /// Absolute pressure on the first side.
    pub pressure: PosPressure,
    /// Pressure on the second side over that on the first, of the results. Above 1 the flow is backwards.
    pub ratio: PosRatio,
    /// Temperature of the gas on both sides.
    pub temperature: PosTemperature,
    /// Ratio of specific heats.
    #[serde(default = "diatomic")]
    pub gamma: PosRatio,
    /// Specific gas constant.
    #[serde(default = "air")]
    pub gas_constant: PosGasConstant,
    /// Law of openings and of the mouths of channels.
    #[serde(default)]
    pub orifice: Orifice,
    /// The passage.
    pub passage: PassageShape,
}

/// What the gas goes through.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PassageShape {
    /// Which of the laws.
    pub law: PassageLaw,
    /// `orifice`: the geometric area.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub area: Option<PosArea>,
    /// Channels: extent across the flow.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width: Option<PosLength>,
    /// Channels: distance of the walls.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height: Option<PosLength>,
    /// Channels: extent along the flow.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length: Option<PosLength>,
    /// Channels: viscosity of the gas; absent: that of air at the temperature.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub viscosity: Option<PosViscosity>,
    /// `automatic_channel`: sharpness of the change between opening and channel, at least 1; absent: 4.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sharpness: Option<PosRatio>,
}

impl PassageShape {
    /// Cross section, passage and, of a channel, the flow whose Reynolds number is one, for gas of the temperature `t` and the gas constant `r`;
    /// `None` when a size is missing.
    fn passage(&self, sharpness: f64, t: f64, r: f64) -> Option<(f64, Passage, Option<f64>)> {
        if self.law == PassageLaw::Orifice {
            let area = self.area?.si();
            return Some((area, Passage::Orifice { area }, None));
        }
        let (w, h, l) = (self.width?.si(), self.height?.si(), self.length?.si());
        let mu = self.viscosity.map_or_else(|| sutherland_viscosity(t), |v| v.si());
        let (area, unit_flow) = (w * h, 0.5 * w * mu);
        let conductance = channel_conductance(w, h, l, mu, r * t);
        let passage = match self.law {
            PassageLaw::Channel => Passage::Channel { conductance },
            PassageLaw::BlendedChannel => Passage::BlendedChannel { conductance, area, unit_flow },
            PassageLaw::AutomaticChannel => {
                Passage::AutomaticChannel { conductance, area, unit_flow, sharpness }
            }
            PassageLaw::Orifice | PassageLaw::LimitedChannel => Passage::LimitedChannel { conductance, area },
        };
        Some((area, passage, Some(unit_flow)))
    }
}

/// Laws of passages.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PassageLaw {
    /// A sharp opening.
    Orifice,
    /// A narrow channel with laminar friction, whatever its flow.
    Channel,
    /// The same behind its mouth, which passes no more than an opening of its cross section.
    LimitedChannel,
    /// The same, with friction that turns turbulent.
    BlendedChannel,
    /// An opening or a channel, turbulent where it must be, whichever lets less through, with a smooth change between them.
    AutomaticChannel,
}

fn diatomic() -> PosRatio {
    quantity(1.4)
}
fn air() -> PosGasConstant {
    quantity(287.0)
}

/// The keys of a channel.
const CHANNEL: [&str; 3] = ["width", "height", "length"];

impl GasPassageRig {
    fn lay_out(&self) -> Result<Bench, Vec<BuildError>> {
        let (t, r, shape) = (self.temperature.si(), self.gas_constant.si(), &self.passage);
        let mut errors = Vec::new();
        let law = self
            .orifice
            .build(self.orifice.gamma.at(t, self.gamma.si()), r)
            .map_err(|e| errors.push(law_error(e)));
        let mut foreign = |given: bool, key: &str| {
            if given {
                let what = format!("`{key}` does not belong to this law");
                errors.push(BuildError::at(format!("passage.{key}"), what));
            }
        };
        let sizes = [shape.width, shape.height, shape.length];
        foreign(shape.sharpness.is_some() && shape.law != PassageLaw::AutomaticChannel, "sharpness");
        if shape.law == PassageLaw::Orifice {
            for (key, v) in CHANNEL.iter().zip(sizes) {
                foreign(v.is_some(), key);
            }
            foreign(shape.viscosity.is_some(), "viscosity");
            if shape.area.is_none() {
                errors.push(BuildError::at("passage.area", "an opening needs its `area`"));
            }
        } else {
            foreign(shape.area.is_some(), "area");
            for (key, v) in CHANNEL.iter().zip(sizes) {
                if v.is_none() {
                    let what = format!("a channel needs its `{key}`");
                    errors.push(BuildError::at(format!("passage.{key}"), what));
                }
            }
        }
        let sharpness = shape.sharpness.map_or(4.0, |n| n.si());
        if sharpness < 1.0 {
            errors.push(BuildError::at("passage.sharpness", format!("the sharpness {sharpness} is below 1")));
        }
        let Ok(law) = law else { return Err(errors) };
        let Some((area, passage, unit_flow)) = shape.passage(sharpness, t, r) else { return Err(errors) };
        let ideal = law.flow_function().clone();
        match Network::new(law, r, &[t, t], 0, &[(0, 1)]) {
            Ok(mut net) if errors.is_empty() => {
                net.set_passage(0, passage);
                Ok(Bench {
                    net,
                    ideal,
                    area,
                    unit_flow,
                    p: self.pressure.si(),
                    ratio: self.ratio.si(),
                    root: (r * t).sqrt(),
                })
            }
            Ok(_) => Err(errors),
            Err(e) => {
                errors.push(e);
                Err(errors)
            }
        }
    }
}

#[register_model(
    name = "gas_passage",
    summary = "gas flow through one opening or narrow channel over the pressure ratio",
    equations = "orifice: m' = C_d A p_u/sqrt(R T) psi(p_d/p_u);  channel: m' = w H^3 (p_a^2 - p_b^2)/(24 mu R T L);  \
                automatic: m' = (c^-n + o^-n)^(-1/n) of channel c and opening o;  \
                effective = m' sqrt(R T)/(A p_u psi_exact)",
    validity = "Perfect gas at one temperature; isothermal in channels.",
    references = ["tian1996", "blasius1913", "sutherland1893", "jobson1955"],
    example = "pressure = \"50 bar\"\nratio = 0.5\ntemperature = \"400 K\"\npassage = { law = \"orifice\", area = \"0.3 mm2\" }\n",
)]
impl RigSpec for GasPassageRig {
    fn models(&self) -> Vec<(&'static str, &'static str)> {
        Vec::new()
    }
    fn build(&self, _: &RigCtx<'_>) -> Result<Box<dyn Rig>, Vec<BuildError>> {
        Ok(Box::new(self.lay_out()?))
    }
}

struct Bench {
    net: Network,
    ideal: FlowFunction,
    area: f64,
    /// Of a channel: the flow whose Reynolds number is one.
    unit_flow: Option<f64>,
    p: f64,
    ratio: f64,
    /// `√(R T)`.
    root: f64,
}

const MODEL: &str = "gas_passage";
/// Pressure ratios of the series, none of them 0 or 1.
const POINTS: usize = 199;

impl Bench {
    /// Flow \[kg/s\], that of the isentropic nozzle of the same area, and the effective coefficient (zero at equal pressures).
    fn flow(&mut self, ratio: f64) -> Result<(f64, f64, f64), EvalError> {
        let (a, b) = (self.p, ratio * self.p);
        self.net.set_pressure(MODEL, 0, a)?;
        self.net.set_pressure(MODEL, 1, b)?;
        self.net.update_flows();
        let (high, low) = (a.max(b), a.min(b));
        let nozzle = self.area * high / self.root * self.ideal.psi_exact((high - low) / high);
        let flow = self.net.flow(0);
        let effective = if nozzle > 0.0 { flow.abs() / nozzle } else { 0.0 };
        Ok((flow, nozzle, effective))
    }
}

impl Rig for Bench {
    fn results(&self) -> Vec<String> {
        let mut names = named(&["flow", "nozzle", "effective", "flow_to_vacuum", "choking_ratio"]);
        names.extend(self.unit_flow.map(|_| "reynolds".into()));
        names
    }

    fn run(&mut self, out: &mut RigOut) -> Result<(), EvalError> {
        let (flow, nozzle, effective) = self.flow(self.ratio)?;
        let (choked, ..) = self.flow(1e-12)?;
        out.result("flow", 1e3 * flow, "g/s", "flow at `ratio`, from the first side to the second");
        out.result("nozzle", 1e3 * nozzle, "g/s", "isentropic flow through the same area");
        out.result(
            "effective",
            effective,
            "1",
            "flow over the isentropic one: effective discharge coefficient",
        );
        out.result("flow_to_vacuum", 1e3 * choked, "g/s", "flow into a vacuum: the largest of an opening");
        out.result(
            "choking_ratio",
            1.0 - self.ideal.choking_drop(),
            "1",
            "pressure ratio at which a nozzle chokes",
        );
        if let Some(unit) = self.unit_flow {
            out.result(
                "reynolds",
                flow.abs() / unit,
                "1",
                "Reynolds number of the channel, of twice its height",
            );
        }
        let ratios: Vec<f64> = (1..=POINTS).map(|i| i as f64 / (POINTS + 1) as f64).collect();
        let rows = ratios.iter().map(|r| self.flow(*r)).collect::<Result<Vec<_>, _>>()?;
        out.axis("pressure_ratio", "1", ratios);
        out.column("flow", "kg/s", rows.iter().map(|r| r.0).collect());
        out.column("nozzle", "kg/s", rows.iter().map(|r| r.1).collect());
        out.column("effective", "1", rows.iter().map(|r| r.2).collect());
        draw::curves(
            out,
            "series",
            "Flow over the pressure ratio",
            "second side over first",
            Scales::default(),
            &[line("this passage", "flow"), line("isentropic nozzle", "nozzle")],
        );
        draw::curves(
            out,
            "series",
            "Effective discharge coefficient",
            "flow over that of an isentropic nozzle of the same area",
            Scales::default(),
            &[line("effective coefficient", "effective")],
        );
        draw::finite(MODEL, out)
    }
}
