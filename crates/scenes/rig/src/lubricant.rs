use gudgeon_core::kinds::{
    Compressibility, CompressibilitySpec, Oil, OilSpec, Piezoviscosity, PiezoviscositySpec, Rig, RigCtx,
    RigOut, RigSpec, ShearThinning, ShearThinningSpec, named,
};
use gudgeon_core::quantity::{
    NonNegative, PosPressure, PosShearRate, PosTemperature, Pressure, ShearRate, quantity,
};
use gudgeon_core::result::Column;
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use crate::draw::{self, Scales, line};

/// An oil over temperature, pressure and shear rate.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LubricantRig {
    /// Temperature of the results.
    pub temperature: PosTemperature,
    /// Pressure of the results, above ambient.
    #[serde(default = "ambient")]
    pub pressure: Pressure<NonNegative>,
    /// Shear rate of the results.
    #[serde(default = "rest")]
    pub shear_rate: ShearRate<NonNegative>,
    /// Lowest temperature that is drawn.
    #[serde(default = "cold")]
    pub coldest: PosTemperature,
    /// Highest temperature that is drawn.
    #[serde(default = "hot")]
    pub hottest: PosTemperature,
    /// Highest pressure that is drawn, above ambient.
    #[serde(default = "half_gigapascal")]
    pub highest_pressure: PosPressure,
    /// Highest shear rate that is drawn, from a ten-thousandth of it.
    #[serde(default = "fast")]
    pub highest_shear_rate: PosShearRate,
    /// Viscosity at ambient pressure and low shear rate.
    pub oil: Box<dyn OilSpec>,
    /// Rise of viscosity with pressure; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub piezoviscosity: Option<Box<dyn PiezoviscositySpec>>,
    /// Fall of viscosity with shear rate; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shear_thinning: Option<Box<dyn ShearThinningSpec>>,
    /// Rise of density with pressure; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compressibility: Option<Box<dyn CompressibilitySpec>>,
}

fn ambient() -> Pressure<NonNegative> {
    quantity(0.0)
}
fn rest() -> ShearRate<NonNegative> {
    quantity(0.0)
}
fn cold() -> PosTemperature {
    quantity(293.15)
}
fn hot() -> PosTemperature {
    quantity(473.15)
}
fn half_gigapascal() -> PosPressure {
    quantity(0.5e9)
}
fn fast() -> PosShearRate {
    quantity(1e8)
}

#[register_model(
    name = "lubricant",
    summary = "viscosity and density of an oil over temperature, pressure and shear rate",
    equations = "mu = mu_0(T) f_p(mu_0, p) f_s(gamma);  rho/rho_0 = f_rho(p)",
    validity = "Factors of pressure and shear rate are taken as independent, as in the films.",
    references = [],
    example = "temperature = \"100 degC\"\noil = { model = \"constant\", viscosity = \"10 mPa s\" }\n",
)]
impl RigSpec for LubricantRig {
    fn models(&self) -> Vec<(&'static str, &'static str)> {
        let mut all = vec![("oil", self.oil.typetag_name())];
        all.extend(self.piezoviscosity.as_ref().map(|m| ("piezoviscosity", m.typetag_name())));
        all.extend(self.shear_thinning.as_ref().map(|m| ("shear_thinning", m.typetag_name())));
        all.extend(self.compressibility.as_ref().map(|m| ("compressibility", m.typetag_name())));
        all
    }
    fn build(&self, _: &RigCtx<'_>) -> Result<Box<dyn Rig>, Vec<BuildError>> {
        let mut errors = Vec::new();
        if self.coldest.si() >= self.hottest.si() {
            errors.push(BuildError::at("hottest", "the highest temperature is not above the lowest"));
        }
        let oil = self.oil.build().map_err(|e| errors.push(e.within("oil"))).ok();
        let piezo = part(&mut errors, "piezoviscosity", self.piezoviscosity.as_ref().map(|m| m.build()));
        let thinning = part(&mut errors, "shear_thinning", self.shear_thinning.as_ref().map(|m| m.build()));
        let density = part(&mut errors, "compressibility", self.compressibility.as_ref().map(|m| m.build()));
        match oil {
            Some(oil) if errors.is_empty() => Ok(Box::new(Bench {
                oil,
                piezo,
                thinning,
                density,
                at: (self.temperature.si(), self.pressure.si(), self.shear_rate.si()),
                temperatures: (self.coldest.si(), self.hottest.si()),
                max: (self.highest_pressure.si(), self.highest_shear_rate.si()),
            })),
            _ => Err(errors),
        }
    }
}

/// A model that need not be there.
fn part<T>(errors: &mut Vec<BuildError>, field: &str, built: Option<Result<T, BuildError>>) -> Option<T> {
    built?.map_err(|e| errors.push(e.within(field))).ok()
}

struct Bench {
    oil: Box<dyn Oil>,
    piezo: Option<Box<dyn Piezoviscosity>>,
    thinning: Option<Box<dyn ShearThinning>>,
    density: Option<Box<dyn Compressibility>>,
    /// Temperature, pressure, shear rate.
    at: (f64, f64, f64),
    temperatures: (f64, f64),
    /// Maximum pressure and shear rate that are drawn.
    max: (f64, f64),
}

const MODEL: &str = "lubricant";
const POINTS: usize = 181;
/// Range of the shear rates that are drawn.
const DECADES: f64 = 1e-4;

/// The oil at one state.
#[derive(Debug, Clone, Copy)]
struct State {
    mu_0: f64,
    mu: f64,
    by_pressure: f64,
    by_shear: f64,
    /// `d ln μ/dp` \[1/Pa\].
    coefficient: f64,
    density: f64,
}

impl Bench {
    fn state(&self, temperature: f64, pressure: f64, rate: f64) -> Result<State, EvalError> {
        let mu_0 = self.oil.viscosity(temperature);
        let (mut f, mut s) = ([1.0], [0.0]);
        if let Some(m) = &self.piezo {
            m.factor(mu_0, &[pressure], &mut f, &mut s)?;
        }
        let (by_pressure, coefficient) = (f[0], s[0] / f[0]);
        let (mut f, mut s) = ([1.0], [0.0]);
        if let Some(m) = &self.thinning {
            m.factor(&[rate], &mut f, &mut s)?;
        }
        let by_shear = f[0];
        let (mut f, mut s) = ([1.0], [0.0]);
        if let Some(m) = &self.density {
            m.factor(&[pressure], &mut f, &mut s)?;
        }
        Ok(State {
            mu_0,
            mu: mu_0 * by_pressure * by_shear,
            by_pressure,
            by_shear,
            coefficient,
            density: f[0],
        })
    }

    fn states(&self, at: impl Iterator<Item = (f64, f64, f64)>) -> Result<Vec<State>, EvalError> {
        at.map(|(t, p, rate)| self.state(t, p, rate)).collect()
    }

    /// Results at the state of the case.
    fn here(&self, out: &mut RigOut) -> Result<(), EvalError> {
        let (t, p, rate) = self.at;
        let here = self.state(t, p, rate)?;
        out.result("viscosity", 1e3 * here.mu, "mPa s", "viscosity at temperature, pressure and shear rate");
        out.result("base_viscosity", 1e3 * here.mu_0, "mPa s", "viscosity at ambient pressure and at rest");
        out.result("pressure_factor", here.by_pressure, "1", "rise of viscosity by pressure");
        out.result("shear_factor", here.by_shear, "1", "fall of viscosity by shear");
        out.result(
            "pressure_viscosity",
            1e9 * here.coefficient,
            "1/GPa",
            "relative change of viscosity with pressure",
        );
        out.result("density_ratio", here.density, "1", "density over that at ambient pressure");
        Ok(())
    }

    fn over_temperature(&self, out: &mut RigOut) -> Result<(), EvalError> {
        let (_, p, rate) = self.at;
        let temperatures = draw::linear(self.temperatures.0, self.temperatures.1, POINTS);
        let warm = self.states(temperatures.iter().map(|t| (*t, p, rate)))?;
        out.axis("temperature", "K", temperatures);
        out.series.columns.push(column("viscosity", &warm, |s| s.mu));
        out.series.columns.push(column("base_viscosity", &warm, |s| s.mu_0));
        draw::curves(
            out,
            "series",
            "Viscosity over temperature",
            "at the given pressure and shear rate",
            Scales { log_x: false, log_y: true },
            &[line("viscosity", "viscosity"), line("ambient, at rest", "base_viscosity")],
        );
        Ok(())
    }

    fn over_pressure(&self, out: &mut RigOut) -> Result<(), EvalError> {
        let (t, _, rate) = self.at;
        let pressures = draw::linear(0.0, self.max.0, POINTS);
        let pressed = self.states(pressures.iter().map(|p| (t, *p, rate)))?;
        draw::table(
            out,
            "pressure",
            draw::column("pressure", "Pa", pressures),
            vec![column("viscosity", &pressed, |s| s.mu), column("density_ratio", &pressed, |s| s.density)],
        );
        if self.piezo.is_some() {
            draw::curves(
                out,
                "pressure",
                "Viscosity over pressure",
                "pressure above ambient, at the given temperature and shear rate",
                Scales { log_x: false, log_y: true },
                &[line("viscosity", "viscosity")],
            );
        }
        if self.density.is_some() {
            draw::curves(
                out,
                "pressure",
                "Density over pressure",
                "over that at ambient pressure",
                Scales::default(),
                &[line("density ratio", "density_ratio")],
            );
        }
        Ok(())
    }

    fn over_shear_rate(&self, out: &mut RigOut) -> Result<(), EvalError> {
        let (t, p, _) = self.at;
        let rates = draw::logarithmic(DECADES * self.max.1, self.max.1, POINTS);
        let sheared = self.states(rates.iter().map(|r| (t, p, *r)))?;
        draw::table(
            out,
            "shear",
            draw::column("shear_rate", "1/s", rates),
            vec![column("viscosity", &sheared, |s| s.mu)],
        );
        if self.thinning.is_some() {
            draw::curves(
                out,
                "shear",
                "Viscosity over shear rate",
                "at the given temperature and pressure",
                Scales { log_x: true, log_y: false },
                &[line("viscosity", "viscosity")],
            );
        }
        Ok(())
    }
}

/// A column over states.
fn column(name: &str, states: &[State], f: fn(&State) -> f64) -> Column {
    let unit = if name.ends_with("ratio") { "1" } else { "Pa s" };
    draw::column(name, unit, states.iter().map(f).collect())
}

impl Rig for Bench {
    fn results(&self) -> Vec<String> {
        named(&[
            "viscosity",
            "base_viscosity",
            "pressure_factor",
            "shear_factor",
            "pressure_viscosity",
            "density_ratio",
        ])
    }

    fn run(&mut self, out: &mut RigOut) -> Result<(), EvalError> {
        self.here(out)?;
        self.over_temperature(out)?;
        self.over_pressure(out)?;
        self.over_shear_rate(out)?;
        draw::finite(MODEL, out)
    }
}
