use std::f64::consts::TAU;

use gudgeon_core::kinds::{Rig, RigCtx, RigOut, RigSpec};
use gudgeon_core::quantity::{
    Angle, PosAngle, PosAngularSpeed, PosArea, PosGasConstant, PosPressure, PosRatio, PosTemperature,
    PosTime, PosVolume, Pressure, quantity,
};
use gudgeon_core::result::Note;
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_gas::{Network, Orifice, Passage};
use gudgeon_numerics::elementary;
use gudgeon_numerics::linalg::{lu_factor, lu_solve};
use gudgeon_numerics::ode::{Flow, Integrator, OdeSystem, Options, Stats};
use gudgeon_numerics::orbit::{CycleMap, OrbitOptions, periodic_orbit};
use gudgeon_numerics::rodas::Rodas;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::draw::{self, Scales, law_error, line};

/// Gas volumes joined by openings, between boundaries of given pressure.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GasVolumesRig {
    /// Ratio of specific heats.
    #[serde(default = "diatomic")]
    pub gamma: PosRatio,
    /// Specific gas constant.
    #[serde(default = "air")]
    pub gas_constant: PosGasConstant,
    /// Law of the openings.
    #[serde(default)]
    pub orifice: Orifice,
    /// Volumes whose pressure is computed.
    #[schemars(length(max = 200))]
    pub volumes: Vec<GasVolume>,
    /// Surroundings whose pressure is given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub boundaries: Vec<GasBoundary>,
    /// What joins them.
    pub openings: Vec<GasOpening>,
    /// What is computed: a time from the start, the steady state, or the periodic cycle.
    pub run: GasRun,
    /// Relative error of a step of the integration, and of the periodic state.
    #[serde(default = "usual")]
    #[schemars(extend("x-refine" = { "group": "tolerance", "factor": 0.1 }))]
    pub tolerance: PosRatio,
}

/// A volume at constant temperature.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GasVolume {
    /// Letters, digits and `_`.
    pub name: String,
    /// Its size.
    pub volume: PosVolume,
    /// Temperature of its gas.
    pub temperature: PosTemperature,
    /// Absolute pressure at the start.
    pub pressure: PosPressure,
}

/// Surroundings.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GasBoundary {
    /// Letters, digits and `_`.
    pub name: String,
    /// Temperature of the gas that comes from there.
    pub temperature: PosTemperature,
    /// Absolute pressure, without the pulses.
    pub pressure: PosPressure,
    /// Pulses over the cycle, added to it; for `periodic` runs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pulses: Vec<Pulse>,
}

/// `height exp(-((θ - at)/width)²)`.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pulse {
    /// Pressure above that of the boundary.
    pub height: Pressure,
    /// Crank angle of the peak.
    pub at: Angle,
    /// Angle from the peak to 1/e of it.
    pub width: PosAngle,
}

/// An opening; flow from `from` to `to` is positive.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GasOpening {
    /// Name of a volume or boundary.
    pub from: String,
    /// Name of another.
    pub to: String,
    /// Geometric area.
    pub area: PosArea,
}

/// What is computed.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GasRun {
    /// Where the run ends.
    pub until: Until,
    /// `time`: how long.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub duration: Option<PosTime>,
    /// `periodic`: crankshaft speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed: Option<PosAngularSpeed>,
    /// `periodic`: length of the cycle.
    #[serde(default = "two_turns")]
    pub period: PosAngle,
    /// `periodic`: crank angle of the pressures among the results.
    #[serde(default = "nothing")]
    pub angle: Angle,
}

/// Ends of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Until {
    /// A time from the start.
    Time,
    /// The steady state.
    Steady,
    /// The cycle that repeats itself.
    Periodic,
}

fn diatomic() -> PosRatio {
    quantity(1.4)
}
fn air() -> PosGasConstant {
    quantity(287.0)
}
fn usual() -> PosRatio {
    quantity(1e-6)
}
fn two_turns() -> PosAngle {
    quantity(2.0 * TAU)
}
fn nothing() -> Angle {
    quantity(0.0)
}

/// Maximum number of volumes: the Jacobian is dense.
const MAX_NODES: usize = 200;
/// Minimum and maximum tolerance of the integration.
const TOLERANCES: (f64, f64) = (1e-12, 1e-1);
/// Maximum period: rows of the series are a degree apart.
const MAX_PERIOD: f64 = 100.0 * TAU;

impl GasVolumesRig {
    /// Everything that is wrong but for the law, and the ends of the openings as numbers of nodes.
    fn legal(&self) -> (Vec<BuildError>, Vec<(usize, usize)>) {
        let mut errors = Vec::new();
        let names: Vec<&str> = self
            .volumes
            .iter()
            .map(|v| v.name.as_str())
            .chain(self.boundaries.iter().map(|b| b.name.as_str()))
            .collect();
        self.check_names(&names, &mut errors);
        if self.volumes.is_empty() || self.volumes.len() > MAX_NODES {
            errors.push(BuildError::at("volumes", format!("there must be 1 to {MAX_NODES} volumes")));
        }
        let mut ends = Vec::new();
        for (k, o) in self.openings.iter().enumerate() {
            let mut node = |name: &str, key: &str| {
                let found = names.iter().position(|n| *n == name);
                if found.is_none() {
                    let what = format!("there is no `{name}`");
                    let help = format!("one of {}", names.join(", "));
                    errors.push(BuildError::at(format!("openings.{k}.{key}"), what).help(help));
                }
                found
            };
            if let (Some(a), Some(b)) = (node(&o.from, "from"), node(&o.to, "to")) {
                if a == b {
                    errors.push(BuildError::at(
                        format!("openings.{k}.to"),
                        "leads back to where it comes from",
                    ));
                }
                ends.push((a, b));
            }
        }
        if self.openings.len() > MAX_NODES {
            errors.push(BuildError::at("openings", format!("there can be {MAX_NODES} openings")));
        }
        self.check_run(&mut errors);
        let (tightest, loosest) = TOLERANCES;
        if !(tightest..=loosest).contains(&self.tolerance.si()) {
            let what = format!("the tolerance must lie between {tightest:e} and {loosest}");
            errors.push(BuildError::at("tolerance", what));
        }
        (errors, ends)
    }

    fn check_names(&self, names: &[&str], errors: &mut Vec<BuildError>) {
        for (i, name) in names.iter().enumerate() {
            let n = self.volumes.len();
            let field =
                if i < n { format!("volumes.{i}.name") } else { format!("boundaries.{}.name", i - n) };
            if name.is_empty() || !name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') {
                errors.push(BuildError::at(field, "a name has letters, digits and `_`"));
            } else if names[..i].contains(name) {
                errors.push(BuildError::at(field, format!("there are two with the name `{name}`")));
            }
        }
    }

    fn check_run(&self, errors: &mut Vec<BuildError>) {
        let (run, periodic) = (&self.run, self.run.until == Until::Periodic);
        if (run.until == Until::Time) != run.duration.is_some() {
            errors
                .push(BuildError::at("run.duration", "a run until a `time`, and no other, needs `duration`"));
        }
        if periodic != run.speed.is_some() {
            errors.push(BuildError::at("run.speed", "a `periodic` run, and no other, needs `speed`"));
        }
        if run.period.si() > MAX_PERIOD {
            errors.push(BuildError::at("run.period", "a cycle has at most a hundred turns"));
        }
        if periodic && !(0.0..=run.period.si() * (1.0 + 1e-12)).contains(&run.angle.si()) {
            errors.push(BuildError::at("run.angle", "the angle is not within the cycle"));
        }
        for (i, b) in self.boundaries.iter().enumerate() {
            if !periodic && !b.pulses.is_empty() {
                let field = format!("boundaries.{i}.pulses");
                errors.push(BuildError::at(field, "pulses belong to a `periodic` run"));
            }
        }
    }

    fn lay_out(&self) -> Result<Bench, Vec<BuildError>> {
        let (mut errors, ends) = self.legal();
        let (gamma, r) = (self.gamma.si(), self.gas_constant.si());
        let temperatures: Vec<f64> = self
            .volumes
            .iter()
            .map(|v| v.temperature.si())
            .chain(self.boundaries.iter().map(|b| b.temperature.si()))
            .collect();
        let mut wrong = |e: BuildError| errors.push(law_error(e));
        let law = self.orifice.build(gamma, r).map_err(&mut wrong);
        // A steady state is found to rounding, whatever the tolerance.
        let still = if self.run.until == Until::Steady { 0.0 } else { STILL * self.tolerance.si() };
        let law = law.map(|law| law.with_least_drop(still));
        let laws = self.orifice.laws(&temperatures, gamma, r).map_err(&mut wrong);
        let (Ok(law), Ok(laws)) = (law, laws) else { return Err(errors) };
        let n = self.volumes.len();
        let mut net = match Network::new(law, r, &temperatures, n, &ends) {
            Ok(net) if errors.is_empty() => net,
            Ok(_) => return Err(errors),
            Err(e) => {
                errors.push(e);
                return Err(errors);
            }
        };
        net.set_source_laws(laws);
        for (k, o) in self.openings.iter().enumerate() {
            net.set_passage(k, Passage::Orifice { area: o.area.si() });
        }
        let mass_of_bar: Vec<f64> =
            self.volumes.iter().zip(&temperatures).map(|(v, t)| BAR * v.volume.si() / (r * t)).collect();
        if let Some(i) = mass_of_bar.iter().position(|m| !m.is_normal()) {
            let what =
                format!("at 1 bar it holds {:e} kg, no pressure can be computed with it", mass_of_bar[i]);
            return Err(vec![BuildError::at(format!("volumes.{i}.volume"), what)]);
        }
        let run = &self.run;
        let degrees = run.until == Until::Periodic;
        Ok(Bench {
            gas: Gas {
                volumes: self.volumes.iter().map(|v| v.volume.si()).collect(),
                boundaries: self.boundaries.iter().map(|b| (b.pressure.si(), b.pulses.clone())).collect(),
                per_unit: run.speed.map_or(1.0, |w| 1f64.to_radians() / w.si()),
                degrees,
                rates: vec![0.0; n],
                openings: ends.len(),
                mass_of_bar,
                net,
            },
            start: self.volumes.iter().map(|v| v.pressure.si() / BAR).collect(),
            names: (
                self.volumes.iter().map(|v| v.name.clone()).collect(),
                self.boundaries.iter().map(|b| b.name.clone()).collect(),
                self.openings.iter().map(|o| format!("{}-{}", o.from, o.to)).collect(),
            ),
            ends,
            until: run.until,
            extent: if degrees { degrees_of(run.period.si()) } else { run.duration.map_or(0.0, |d| d.si()) },
            angle: degrees_of(run.angle.si()),
            tolerance: self.tolerance.si(),
        })
    }
}

#[register_model(
    name = "gas_volumes",
    summary = "gas volumes joined by openings: blow-down, steady leakage, periodic cycle",
    equations = "dm_i/dt = sum of flows;  p_i = m_i R T_i/V_i;  m' = C_d A p_u/sqrt(R T_u) psi(p_d/p_u)",
    validity = "Every volume of constant size, at the constant temperature of its walls. Below a relative pressure difference of ten times the tolerance (1e-8 in a steady \
                state) an orifice without a laminar branch passes what a parabola says, not a root.",
    references = [],
    example = "run = { until = \"time\", duration = \"0.1 s\" }\n\
              volumes = [{ name = \"vessel\", volume = \"200 mm3\", temperature = \"400 K\", pressure = \"50 bar\" }]\n\
              boundaries = [{ name = \"ambient\", temperature = \"400 K\", pressure = \"1 bar\" }]\n\
              openings = [{ from = \"vessel\", to = \"ambient\", area = \"0.02 mm2\" }]\n",
)]
impl RigSpec for GasVolumesRig {
    fn models(&self) -> Vec<(&'static str, &'static str)> {
        Vec::new()
    }
    fn build(&self, _: &RigCtx<'_>) -> Result<Box<dyn Rig>, Vec<BuildError>> {
        Ok(Box::new(self.lay_out()?))
    }
}

const MODEL: &str = "gas_volumes";
/// Pressure that makes the states numbers near 1 \[Pa\].
const BAR: f64 = 1e5;
/// Unit of the quadratures \[kg\].
const MILLIGRAM: f64 = 1e-6;

/// The masses of the volumes, over those at 1 bar, and behind them the gas through every opening \[mg\], over seconds or degrees.
struct Gas {
    net: Network,
    volumes: Vec<f64>,
    /// Mass at 1 bar \[kg\]: what the states are multiples of.
    mass_of_bar: Vec<f64>,
    boundaries: Vec<(f64, Vec<Pulse>)>,
    /// Seconds in a unit of the independent variable.
    per_unit: f64,
    /// Whether that is a degree.
    degrees: bool,
    rates: Vec<f64>,
    openings: usize,
}

impl Gas {
    /// Pressure of a boundary \[Pa\].
    fn boundary(&self, i: usize, at: f64) -> f64 {
        let (base, pulses) = &self.boundaries[i];
        let theta = if self.degrees { at.to_radians() } else { 0.0 };
        let pulse = |p: &Pulse| {
            let x = (theta - p.at.si()) / p.width.si();
            p.height.si() * elementary::exp(-x * x)
        };
        base + pulses.iter().map(pulse).sum::<f64>()
    }

    fn set(&mut self, at: f64, y: &[f64]) -> Result<(), EvalError> {
        let n = self.volumes.len();
        for i in 0..n {
            self.net.set_mass(MODEL, i, y[i] * self.mass_of_bar[i], self.volumes[i])?;
        }
        for i in 0..self.boundaries.len() {
            let p = self.boundary(i, at);
            self.net.set_pressure(MODEL, n + i, p)?;
        }
        Ok(())
    }
}

impl OdeSystem for Gas {
    fn dim(&self) -> usize {
        self.volumes.len()
    }
    fn quad_dim(&self) -> usize {
        self.openings
    }
    fn rhs(&mut self, at: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        self.set(at, y)?;
        self.net.update_flows();
        self.net.rates(&mut self.rates);
        let n = self.volumes.len();
        for i in 0..n {
            f[i] = self.rates[i] / self.mass_of_bar[i] * self.per_unit;
        }
        for (k, q) in f[n..].iter_mut().enumerate() {
            *q = self.net.flow(k) / MILLIGRAM * self.per_unit;
        }
        Ok(())
    }
    fn jacobian(&mut self, at: f64, y: &[f64], _: &[f64], jac: &mut [f64]) -> Result<bool, EvalError> {
        self.set(at, y)?;
        self.net.update_partials();
        let n = self.volumes.len();
        jac.fill(0.0);
        self.net.jacobian(&mut jac[..n * n]);
        for (row, entries) in jac.chunks_exact_mut(n).enumerate() {
            let unit = if row < n {
                self.mass_of_bar[row]
            } else {
                self.net.add_flow_gradient(row - n, 1.0, entries);
                MILLIGRAM
            };
            for (entry, mass) in entries.iter_mut().zip(&self.mass_of_bar) {
                *entry *= mass / unit * self.per_unit;
            }
        }
        Ok(true)
    }
}

/// Whole degrees as such: radians have them rounded.
fn degrees_of(angle: f64) -> f64 {
    let (d, whole) = (angle.to_degrees(), angle.to_degrees().round());
    if (d - whole).abs() < 1e-10 { whole } else { d }
}

/// `land2` as `land 2`.
fn spoken(name: &str) -> String {
    match name.find(|c: char| c.is_ascii_digit()) {
        Some(at) if at > 0 => format!("{} {}", &name[..at], &name[at..]),
        _ => name.to_owned(),
    }
}

/// Names of volumes, boundaries and openings.
type Names = (Vec<String>, Vec<String>, Vec<String>);

struct Bench {
    gas: Gas,
    /// Pressures of the volumes at the start \[bar\].
    start: Vec<f64>,
    names: Names,
    ends: Vec<(usize, usize)>,
    until: Until,
    /// Seconds, or degrees of the cycle.
    extent: f64,
    angle: f64,
    tolerance: f64,
}

/// Rows of the series over time.
const ROWS: usize = 401;
/// Maximum number of steps of an integration: about a second.
const MAX_STEPS: u64 = 100_000;
/// Maximum step \[deg\].
const MAX_STEP: f64 = 20.0;
/// Relative pressure drop over the tolerance below which the flow is no root of it any more.
const STILL: f64 = 10.0;
/// Cycles until a periodic state must be found.
const CYCLES: usize = 60;
/// How many times the search of a periodic state may tighten the tolerance tenfold: cycles differ by the noise of their steps where gas passes an opening whose flow has a corner.
const REFINEMENTS: usize = 2;

/// Where rows of a run are wanted.
struct Plan {
    /// Rows of the series.
    axis: Vec<f64>,
    /// These, and the place of the results where it is none of them.
    at: Vec<f64>,
    /// The row of the results in `at`.
    result_row: usize,
    /// Whether it is no row of the series.
    extra: bool,
}

/// A run over the extent.
struct Run {
    /// States at the rows of the series.
    rows: Vec<Vec<f64>>,
    /// State at the place of the results.
    here: Vec<f64>,
    begin: Vec<f64>,
    end: Vec<f64>,
    /// Gas through every opening \[mg\].
    q: Vec<f64>,
}

/// One integration over the extent, with rows on the way.
struct March<'a> {
    gas: &'a mut Gas,
    rodas: Rodas,
    extent: f64,
    tolerance: f64,
    max_step: f64,
    /// Where rows are wanted, ascending.
    at: Vec<f64>,
    rows: Vec<Vec<f64>>,
    q: Vec<f64>,
    /// Work of all cycles.
    stats: Stats,
    cycles: u64,
}

impl March<'_> {
    fn integrate(&mut self, y: &mut [f64], rtol: f64) -> Result<(), EvalError> {
        let mut options = Options::new(rtol, &vec![1.0; y.len()]);
        (options.h_max, options.max_steps) = (self.max_step, MAX_STEPS);
        self.q.fill(0.0);
        self.rows.clear();
        self.cycles += 1;
        let (at, rows, n) = (&self.at, &mut self.rows, y.len());
        self.rodas
            .integrate(
                self.gas,
                (0.0, self.extent),
                &[],
                y,
                &mut self.q,
                &options,
                &mut self.stats,
                &mut |_, v| {
                    while rows.len() < at.len() && at[rows.len()] <= v.t1() {
                        let mut row = vec![0.0; n];
                        v.interpolate(at[rows.len()], &mut row);
                        rows.push(row);
                    }
                    Flow::Continue
                },
            )
            .map(|_| ())
            .map_err(|e| EvalError::fatal(MODEL, e.to_string()))
    }

    /// Finds the cycle that repeats itself; a note where there is none.
    fn close(&mut self, y: &mut [f64], out: &mut RigOut) -> Result<(), EvalError> {
        let options = OrbitOptions {
            tolerance: self.tolerance,
            accuracy: self.tolerance,
            max_cycles: CYCLES,
            refinements: REFINEMENTS,
            accelerate: true,
        };
        let report = periodic_orbit(self, y, &options)?;
        if !report.converged {
            let text = format!(
                "the cycle does not repeat itself after {CYCLES} cycles: it changes by {:.1e} bar",
                report.residual
            );
            out.notes.push(Note::failure("not_periodic", text).amount("change", report.residual, "bar"));
        }
        Ok(())
    }
}

impl CycleMap for March<'_> {
    fn dim(&self) -> usize {
        self.gas.volumes.len()
    }
    fn map(&mut self, y0: &[f64], y1: &mut [f64], accuracy: f64) -> Result<f64, EvalError> {
        y1.copy_from_slice(y0);
        self.integrate(y1, accuracy.max(TOLERANCES.0))?;
        Ok(1.0)
    }
    fn scale(&self, _: &[f64], s: &mut [f64]) {
        s.fill(1.0);
    }
}

impl Bench {
    /// Groups of volumes that no boundary feeds: their gas stays what it is.
    fn closed(&self) -> Vec<Vec<usize>> {
        let n = self.start.len();
        let mut group: Vec<usize> = (0..n + self.names.1.len()).collect();
        for &(a, b) in &self.ends {
            let (a, b) = (group[a], group[b]);
            for g in &mut group {
                if *g == a {
                    *g = b;
                }
            }
        }
        let fed = &group[n..];
        let mut labels: Vec<usize> = group[..n].iter().copied().filter(|g| !fed.contains(g)).collect();
        labels.sort_unstable();
        labels.dedup();
        labels.iter().map(|l| (0..n).filter(|i| group[*i] == *l).collect()).collect()
    }

    /// The steady state from the start on: implicit Euler steps that grow until they are Newton's. Returns their number.
    ///
    /// Euler's implicit step keeps sums of masses, so what volumes without a boundary share in the end is what they had. In long steps
    /// rounding would take that away: there the sum stands in place of one of their balances.
    fn settle(&mut self, y: &mut [f64]) -> Result<u64, EvalError> {
        const STEPS: u64 = 2_000;
        let n = y.len();
        let rows = n + self.gas.openings;
        let (mut f, mut jac) = (vec![0.0; rows], vec![0.0; rows * n]);
        let (mut a, mut piv, mut d) = (vec![0.0; n * n], vec![0; n], vec![0.0; n]);
        self.gas.rhs(0.0, y, &mut f)?;
        let closed = self.closed();
        // A hundredth of what the fastest volume needs to change by its content.
        let fastest = y.iter().zip(&f).map(|(y, f)| (f / y).abs()).fold(0.0, f64::max);
        if fastest == 0.0 {
            return Ok(0);
        }
        let mut h = 0.01 / fastest;
        let (mut last, mut root) = (f64::INFINITY, false);
        for step in 1..=STEPS {
            self.gas.rhs(0.0, y, &mut f)?;
            self.gas.jacobian(0.0, y, &f, &mut jac)?;
            for (i, a) in a.iter_mut().enumerate() {
                *a = f64::from(u8::from(i % (n + 1) == 0)) - h * jac[i];
            }
            for (d, f) in d.iter_mut().zip(&f) {
                *d = h * f;
            }
            for volumes in &closed {
                let row = volumes[0];
                a[row * n..(row + 1) * n].fill(0.0);
                for &j in volumes {
                    a[row * n + j] = self.gas.mass_of_bar[j] / self.gas.mass_of_bar[row];
                }
                d[row] = 0.0;
            }
            let solved = lu_factor(&mut a, n, &mut piv).is_ok();
            if solved {
                lu_solve(&a, n, &piv, &mut d);
            }
            let change = d.iter().zip(y.iter()).map(|(d, y)| (d / y).abs()).fold(0.0, f64::max);
            // Half a content in a step is no small change; no number is none either.
            if !solved || change.is_nan() || change >= 0.5 {
                h *= 0.25;
                continue;
            }
            // A step much longer than the slowest volume needs is Newton's. Flow goes with the root of a pressure drop that vanishes, and of a root
            // Newton's steps lead from one side to the other, as far again: from then on the flows left over must fall.
            let newton = h * fastest > 1e9;
            root |= newton && change >= 0.5 * last;
            let part = if root { self.shorter(y, &d, &f[..n])? } else { 1.0 };
            for (y, d) in y.iter_mut().zip(&d) {
                *y += part * d;
            }
            // What is left of the change is rounding.
            if newton && part * change < 1e-14 {
                return Ok(step);
            }
            last = change;
            h = (2.0 * h).min(1e15 / fastest);
        }
        Err(EvalError::fatal(MODEL, format!("no steady state in {STEPS} steps")))
    }

    /// The part of the step `d` from `y` behind which the largest of the rates left over, now `f`, has fallen; halved until then.
    fn shorter(&mut self, y: &[f64], d: &[f64], f: &[f64]) -> Result<f64, EvalError> {
        let largest = |f: &[f64]| f.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        let (now, n) = (largest(f), y.len());
        let mut rates = vec![0.0; n + self.gas.openings];
        let mut part = 1.0;
        while part > 1e-6 {
            let there: Vec<f64> = y.iter().zip(d).map(|(y, d)| y + part * d).collect();
            self.gas.rhs(0.0, &there, &mut rates)?;
            if largest(&rates[..n]) < now {
                break;
            }
            part *= 0.5;
        }
        Ok(part)
    }

    fn steady(&mut self, out: &mut RigOut) -> Result<(), EvalError> {
        let mut y = self.start.clone();
        let steps = self.settle(&mut y)?;
        out.counters.insert("steps".into(), steps);
        self.gas.set(0.0, &y)?;
        self.gas.net.update_flows();
        let n = y.len();
        for (name, p) in self.names.0.iter().zip(&y) {
            out.result(format!("{name}.p"), *p, "bar", format!("steady pressure in {}", spoken(name)));
        }
        for (i, name) in self.names.1.iter().enumerate() {
            let inflow: f64 = self.sum_into(n + i, |k| self.gas.net.flow(k));
            out.result(
                format!("{name}.flow"),
                1e3 * inflow,
                "g/s",
                format!("steady flow into {}", spoken(name)),
            );
        }
        // In the order of the nodes: along a labyrinth when its volumes stand in theirs.
        out.axis("volume", "1", (1..=n).map(|i| i as f64).collect());
        out.column("p", "Pa", y.iter().map(|y| y * BAR).collect());
        draw::curves(
            out,
            "series",
            "Steady pressures",
            "of the volumes, in the order of the case",
            Scales::default(),
            &[line("pressure", "p")],
        );
        Ok(())
    }

    /// Sum of `value` of the openings that lead to a node, less those that lead from it.
    fn sum_into(&self, node: usize, value: impl Fn(usize) -> f64) -> f64 {
        let signed = |(k, &(a, b)): (usize, &(usize, usize))| {
            if b == node {
                value(k)
            } else if a == node {
                -value(k)
            } else {
                0.0
            }
        };
        self.ends.iter().enumerate().map(signed).sum()
    }

    fn history(&mut self, out: &mut RigOut) -> Result<(), EvalError> {
        let plan = self.plan();
        let run = self.march(&plan, out)?;
        self.results_of(&run, out);
        let pressures = self.draw_pressures(&plan.axis, &run.rows, out);
        let flows = self.draw_flows(&plan.axis, &run.rows, out)?;
        draw::curves(out, "series", "Pressures", "absolute", Scales::default(), &pressures);
        draw::curves(out, "series", "Flow through the openings", "", Scales::default(), &flows);
        Ok(())
    }

    fn periodic(&self) -> bool {
        self.until == Until::Periodic
    }

    /// Where rows are wanted.
    fn plan(&self) -> Plan {
        let periodic = self.periodic();
        let count = if periodic { self.extent.round().max(1.0) as usize + 1 } else { ROWS };
        let axis = draw::linear(0.0, self.extent, count);
        // The row of the results stands among the others.
        let mut at = axis.clone();
        let result_row = if periodic { at.partition_point(|t| *t < self.angle) } else { count - 1 };
        let extra = periodic && at.get(result_row).is_some_and(|t| *t != self.angle);
        if extra {
            at.insert(result_row, self.angle.min(self.extent));
        }
        Plan { axis, at, result_row, extra }
    }

    /// Maximum step: no pulse is stepped over.
    fn max_step(&self) -> f64 {
        if !self.periodic() {
            return f64::INFINITY;
        }
        let pulses = self.gas.boundaries.iter().flat_map(|b| &b.1);
        pulses.map(|p| p.width.si().to_degrees()).fold(MAX_STEP, f64::min)
    }

    /// Integrates from the start, or over the cycle that repeats itself.
    fn march(&mut self, plan: &Plan, out: &mut RigOut) -> Result<Run, EvalError> {
        let (periodic, max_step) = (self.periodic(), self.max_step());
        let mut march = March {
            rodas: Rodas::new(self.start.len(), self.gas.openings, None),
            q: vec![0.0; self.gas.openings],
            gas: &mut self.gas,
            extent: self.extent,
            tolerance: self.tolerance,
            max_step,
            at: plan.at.clone(),
            rows: Vec::new(),
            stats: Stats::default(),
            cycles: 0,
        };
        let mut y = self.start.clone();
        if periodic {
            march.close(&mut y, out)?;
        }
        let begin = y.clone();
        march.integrate(&mut y, self.tolerance)?;
        let (mut rows, q, stats, cycles) = (march.rows, march.q, march.stats, march.cycles);
        // A step may end a rounding before the extent.
        while rows.len() < plan.at.len() {
            rows.push(y.clone());
        }
        let last = plan.axis.len() - 1;
        let here =
            if plan.extra { rows.remove(plan.result_row) } else { rows[plan.result_row.min(last)].clone() };
        let counted = [
            ("steps", stats.steps),
            ("rejected", stats.rejected),
            ("rhs", stats.rhs),
            ("jacobians", stats.jacobians),
        ];
        for (key, n) in counted {
            out.counters.insert(key.into(), n);
        }
        if periodic {
            out.counters.insert("cycles".into(), cycles);
        }
        Ok(Run { rows, here, begin, end: y, q })
    }

    /// Pressures, gas taken in, and the balance of mass.
    fn results_of(&self, run: &Run, out: &mut RigOut) {
        let (n, periodic) = (self.start.len(), self.periodic());
        let when = if periodic { "pressure at the angle" } else { "pressure at the end" };
        for (i, name) in self.names.0.iter().enumerate() {
            out.result(format!("{name}.p"), run.here[i], "bar", format!("{when}, in {}", spoken(name)));
            let max = run.rows.iter().map(|r| r[i]).fold(0.0, f64::max);
            out.result(
                format!("{name}.p_max"),
                max,
                "bar",
                format!("highest pressure, of the rows of the series, in {}", spoken(name)),
            );
        }
        let mut balance = 0.0;
        for (i, name) in self.names.1.iter().enumerate() {
            let received = self.sum_into(n + i, |k| run.q[k]);
            balance += received;
            let whole = if periodic { "a cycle" } else { "the run" };
            out.result(
                format!("{name}.received"),
                received,
                "mg",
                format!("gas taken in over {whole} by {}", spoken(name)),
            );
        }
        let stored: f64 =
            (0..n).map(|i| (run.end[i] - run.begin[i]) * self.gas.mass_of_bar[i] / MILLIGRAM).sum();
        let throughput: f64 = run.q.iter().map(|q| q.abs()).sum();
        if throughput > 0.0 {
            out.balance.gas_mass = Some((balance + stored) / throughput);
        }
    }

    /// Columns of the pressures; returns their curves.
    fn draw_pressures(&self, axis: &[f64], rows: &[Vec<f64>], out: &mut RigOut) -> Vec<(String, String)> {
        if self.periodic() {
            out.axis(gudgeon_core::result::CRANK_ANGLE, "deg", axis.to_vec());
        } else {
            out.axis("time", "s", axis.to_vec());
        }
        let mut pressures = Vec::new();
        for (i, name) in self.names.1.iter().enumerate() {
            let p = axis.iter().map(|t| self.gas.boundary(i, *t)).collect();
            out.column(format!("{name}.p"), "Pa", p);
            pressures.push(line(name, &format!("{name}.p")));
        }
        for (i, name) in self.names.0.iter().enumerate() {
            out.column(format!("{name}.p"), "Pa", rows.iter().map(|r| r[i] * BAR).collect());
            pressures.push(line(name, &format!("{name}.p")));
        }
        pressures
    }

    /// Columns of the flows; returns their curves.
    fn draw_flows(
        &mut self,
        axis: &[f64],
        rows: &[Vec<f64>],
        out: &mut RigOut,
    ) -> Result<Vec<(String, String)>, EvalError> {
        let mut flows: Vec<Vec<f64>> = vec![Vec::with_capacity(axis.len()); self.ends.len()];
        for (t, row) in axis.iter().zip(rows) {
            self.gas.set(*t, row)?;
            self.gas.net.update_flows();
            for (k, flow) in flows.iter_mut().enumerate() {
                flow.push(self.gas.net.flow(k));
            }
        }
        let mut lines = Vec::new();
        for (k, (name, flow)) in self.names.2.iter().zip(flows).enumerate() {
            // Two openings may join the same spaces.
            let again = self.names.2[..k].iter().filter(|n| *n == name).count();
            let name = if again > 0 { format!("{name}-{}", again + 1) } else { name.clone() };
            let column = format!("{name}.flow");
            out.column(column.clone(), "kg/s", flow);
            lines.push(line(&name, &column));
        }
        Ok(lines)
    }
}

impl Rig for Bench {
    fn results(&self) -> Vec<String> {
        let (inside, outside) = match self.until {
            Until::Steady => (&["p"][..], "flow"),
            Until::Time | Until::Periodic => (&["p", "p_max"][..], "received"),
        };
        let of = |name: &String| inside.iter().map(move |what| format!("{name}.{what}")).collect::<Vec<_>>();
        let taken = self.names.1.iter().map(|name| format!("{name}.{outside}"));
        self.names.0.iter().flat_map(of).chain(taken).collect()
    }

    fn run(&mut self, out: &mut RigOut) -> Result<(), EvalError> {
        match self.until {
            Until::Steady => self.steady(out)?,
            Until::Time | Until::Periodic => self.history(out)?,
        }
        draw::finite(MODEL, out)
    }
}
