use gudgeon_core::geometry::RingPlace;
use gudgeon_core::kinds::{Flank, FlankCtx, FlankLaw, FlankSpec, Rig, RigCtx, RigOut, RigSpec, named};
use gudgeon_core::quantity::{
    Force, Fraction, Mass, NonNegative, PosArea, PosLength, PosRatio, PosTime, PosVelocity, PosViscosity,
    Ratio, Velocity, quantity,
};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_numerics::ode::{Direction, EventAction, Flow, Integrator, OdeSystem, Options, Stats};
use gudgeon_numerics::rodas::Rodas;
use gudgeon_numerics::roots::itp;
use serde::{Deserialize, Serialize};

use crate::draw::{self, Scales, line};

/// A ring that a constant load moves in its groove, against the oil there.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FlankRig {
    /// Axial clearance of the ring.
    pub clearance: PosLength,
    /// Flank annulus.
    pub area: PosArea,
    /// Radial width of the flank contact.
    pub width: PosLength,
    /// Oil-filled fraction of the flanks.
    #[serde(default = "full")]
    pub oil_fill: Ratio<Fraction>,
    /// Viscosity of the oil in the groove.
    pub viscosity: PosViscosity,
    /// Mass of the ring; 0: its inertia is left out.
    #[serde(default = "massless")]
    pub mass: Mass<NonNegative>,
    /// Load on the ring, towards the lower flank positive.
    pub load: Force,
    /// Height above the lower flank at the start.
    pub height: PosLength,
    /// Velocity at the start, upwards positive. Not for a ring without mass.
    #[serde(default = "still")]
    pub velocity: Velocity,
    /// How long the ring is followed, unless it lands before.
    pub duration: PosTime,
    /// Speed of the curves of the force over the height.
    #[serde(default = "millimetre_per_second")]
    pub speed: PosVelocity,
    /// Relative error of a step of the integration.
    #[serde(default = "usual")]
    #[schemars(extend("x-refine" = { "group": "tolerance", "factor": 0.1 }))]
    pub tolerance: PosRatio,
    /// The model.
    pub flank: Box<dyn FlankSpec>,
}

fn full() -> Ratio<Fraction> {
    quantity(1.0)
}
fn massless() -> Mass<NonNegative> {
    quantity(0.0)
}
fn still() -> Velocity {
    quantity(0.0)
}
fn millimetre_per_second() -> PosVelocity {
    quantity(1e-3)
}
fn usual() -> PosRatio {
    quantity(1e-8)
}

/// Loosest and tightest tolerance of the integration.
const TOLERANCES: (f64, f64) = (1e-12, 1e-1);

#[register_model(
    name = "flank",
    summary = "oil between ring and groove flanks: force over the height, and a ring landing under a load",
    equations = "m dv/dt = -load + F(s, v);  without mass: F(s, v) = load",
    validity = "A ring that stays parallel to the flanks; flanks are rigid, and the run ends when it lands.",
    references = [],
    example = "clearance = \"0.1 mm\"\narea = \"1000 mm2\"\nwidth = \"3 mm\"\nviscosity = \"10 mPa s\"\nmass = \"12 g\"\nload = \"60 N\"\n\
              height = \"30 um\"\nduration = \"20 ms\"\nflank = { model = \"squeeze_film\" }\n",
)]
impl RigSpec for FlankRig {
    fn models(&self) -> Vec<(&'static str, &'static str)> {
        vec![("flank", self.flank.typetag_name())]
    }
    fn build(&self, _: &RigCtx<'_>) -> Result<Box<dyn Rig>, Vec<BuildError>> {
        let mut errors = Vec::new();
        if self.height.si() >= self.clearance.si() {
            errors.push(BuildError::at("height", "the ring does not start inside its groove"));
        }
        if self.mass.si() == 0.0 && self.velocity.si() != 0.0 {
            let what = "a ring without mass has the velocity at which its forces balance";
            errors.push(BuildError::at("velocity", what));
        }
        let (tightest, loosest) = TOLERANCES;
        if !(tightest..=loosest).contains(&self.tolerance.si()) {
            let what = format!("the tolerance must lie between {tightest:e} and {loosest}");
            errors.push(BuildError::at("tolerance", what));
        }
        let ctx = FlankCtx::new(0, 2, self.oil_fill.si(), self.width.si(), self.viscosity.si());
        match self.flank.build(&ctx) {
            Ok(oil) if errors.is_empty() => Ok(Box::new(Bench {
                ring: Ring {
                    law: oil.law(),
                    oil,
                    clearance: self.clearance.si(),
                    area: self.area.si(),
                    mass: self.mass.si(),
                    load: self.load.si(),
                },
                start: (self.height.si(), self.velocity.si()),
                duration: self.duration.si(),
                speed: self.speed.si(),
                tolerance: self.tolerance.si(),
            })),
            Ok(_) => Err(errors),
            Err(e) => {
                errors.push(e.within("flank"));
                Err(errors)
            }
        }
    }
}

const MODEL: &str = "flank";

struct Ring {
    /// Oil on the flanks, of which nothing is lost.
    oil: Box<dyn Flank>,
    law: Box<dyn FlankLaw>,
    clearance: f64,
    area: f64,
    /// Zero: without inertia.
    mass: f64,
    load: f64,
}

impl Ring {
    fn force(&self, s: f64, v: f64) -> f64 {
        let place = RingPlace { s, v, clearance: self.clearance, ..RingPlace::default() };
        self.law.force(&self.oil.oil(&[], &place), s, v, self.clearance, self.area)
    }

    /// Velocity at which the oil carries the load.
    fn balance(&self, s: f64) -> Result<f64, EvalError> {
        if self.load == 0.0 {
            return Ok(0.0);
        }
        let direction = -self.load.signum();
        let surplus =
            |speed: f64| Ok::<_, EvalError>((self.force(s, direction * speed)).abs() - self.load.abs());
        // The resistance grows with the speed; a decade at a time up to one that no ring reaches.
        let mut fast = 1e-12;
        while surplus(fast)? < 0.0 {
            fast *= 10.0;
            if fast > 1e9 {
                let what =
                    format!("at {s:e} m above the flank no velocity is resisted by as much as the load");
                return Err(EvalError::recoverable(MODEL, what));
            }
        }
        itp(surplus, 0.0, fast, 4.0 * f64::EPSILON * fast)
            .map(|root| direction * root.x)
            .map_err(|e| EvalError::recoverable(MODEL, e.to_string()))
    }
}

impl OdeSystem for Ring {
    fn dim(&self) -> usize {
        if self.mass > 0.0 { 2 } else { 1 }
    }
    /// Height \[m\], and velocity \[m/s\] of a ring with mass.
    fn rhs(&mut self, _: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        match *y {
            [s, v] => {
                f[0] = v;
                f[1] = (self.force(s, v) - self.load) / self.mass;
            }
            _ => f[0] = self.balance(y[0])?,
        }
        Ok(())
    }
    fn n_events(&self) -> usize {
        2
    }
    /// Landing on the lower and on the upper flank.
    fn events(&mut self, _: f64, y: &[f64], g: &mut [f64]) -> Result<(), EvalError> {
        g[0] = y[0];
        g[1] = y[0] - self.clearance;
        Ok(())
    }
    fn event_direction(&self, k: usize) -> Direction {
        if k == 0 { Direction::Falling } else { Direction::Rising }
    }
    fn on_event(&mut self, _: usize, _: f64, _: &mut [f64]) -> Result<EventAction, EvalError> {
        Ok(EventAction::Stop)
    }
}

struct Bench {
    ring: Ring,
    start: (f64, f64),
    duration: f64,
    speed: f64,
    tolerance: f64,
}

/// Rows of the series, heights of the table.
const POINTS: usize = 401;
/// Most steps of the integration.
const MAX_STEPS: u64 = 100_000;

impl Bench {
    /// Rows of time and state, of which the last is where the ring lands or the time ends.
    fn history(&mut self, stats: &mut Stats) -> Result<Vec<(f64, Vec<f64>)>, EvalError> {
        let n = self.ring.dim();
        let (s, v) = self.start;
        let mut y = vec![s, v];
        y.truncate(n);
        // A thousandth of the start is near for a height; velocities go with the fall from there.
        let fall = (2.0 * self.ring.load.abs() * s / self.ring.mass.max(f64::MIN_POSITIVE)).sqrt();
        let scale = [1e-3 * s, (1e-3 * (v.abs() + fall.min(1e3))).max(1e-9)];
        let mut options = Options::new(self.tolerance, &scale[..n]);
        options.max_steps = MAX_STEPS;
        let mut times = vec![0.0];
        times.extend(draw::logarithmic(1e-4 * self.duration, self.duration, POINTS - 1));
        let (mut rows, mut last) = (Vec::new(), (0.0, y.clone()));
        Rodas::new(n, 0, None)
            .integrate(
                &mut self.ring,
                (0.0, self.duration),
                &[],
                &mut y,
                &mut [],
                &options,
                stats,
                &mut |_, view| {
                    while rows.len() < times.len() && times[rows.len()] <= view.t1() {
                        let (t, mut row) = (times[rows.len()], vec![0.0; n]);
                        view.interpolate(t, &mut row);
                        rows.push((t, row));
                    }
                    last = (view.t1(), view.y1().to_vec());
                    Flow::Continue
                },
            )
            .map_err(|e| EvalError::fatal(MODEL, e.to_string()))?;
        if rows.last().is_none_or(|r| r.0 < last.0) {
            rows.push(last);
        }
        Ok(rows)
    }
}

impl Rig for Bench {
    fn results(&self) -> Vec<String> {
        named(&["force", "pull", "time", "end_height", "end_velocity"])
    }

    fn run(&mut self, out: &mut RigOut) -> Result<(), EvalError> {
        let (s, v) = self.start;
        out.result(
            "force",
            self.ring.force(s, -self.speed),
            "N",
            "force of the oil at the start height, falling with `speed`",
        );
        let pull = self.ring.force(s, self.speed);
        out.result("pull", -pull, "N", "the same against rising with `speed`");
        let mut stats = Stats::default();
        let rows = self.history(&mut stats)?;
        let velocity = |row: &[f64]| match *row {
            [_, v] => Ok(v),
            _ => self.ring.balance(row[0].clamp(0.0, self.ring.clearance)),
        };
        let speeds = rows.iter().map(|r| velocity(&r.1)).collect::<Result<Vec<_>, _>>()?;
        let (end, last) = rows.last().map_or((0.0, s), |r| (r.0, r.1[0]));
        out.result("time", 1e3 * end, "ms", "when the ring lands, or `duration` when it does not");
        out.result("end_height", 1e6 * last, "um", "height above the lower flank then");
        out.result(
            "end_velocity",
            speeds.last().copied().unwrap_or(v),
            "m/s",
            "velocity then, upwards positive",
        );
        let counted = [
            ("steps", stats.steps),
            ("rejected", stats.rejected),
            ("rhs", stats.rhs),
            ("jacobians", stats.jacobians),
        ];
        for (key, n) in counted {
            out.counters.insert(key.into(), n);
        }
        out.axis("time", "s", rows.iter().map(|r| r.0).collect());
        out.column("height", "m", rows.iter().map(|r| r.1[0]).collect());
        out.column("velocity", "m/s", speeds.clone());
        let approach = speeds.iter().map(|v| -v).collect();
        out.column("fall", "m/s", approach);
        let oil: Vec<f64> = rows.iter().zip(&speeds).map(|(r, v)| self.ring.force(r.1[0], *v)).collect();
        out.column("force", "N", oil);
        let log = Scales { log_x: true, log_y: true };
        draw::curves(out, "series", "Height above the lower flank", "", log, &[line("height", "height")]);
        draw::curves(
            out,
            "series",
            "Velocity of the fall",
            "downwards positive",
            log,
            &[line("velocity", "fall")],
        );
        draw::curves(
            out,
            "series",
            "Force of the oil",
            "upwards positive",
            Scales { log_x: true, log_y: false },
            &[line("force", "force")],
        );

        let c = self.ring.clearance;
        let heights = draw::linear(0.0, c, POINTS);
        let mut columns = Vec::new();
        let mut lines = Vec::new();
        for (factor, label) in [(0.1, "a tenth of `speed`"), (1.0, "`speed`"), (10.0, "ten times `speed`")] {
            for (sign, way, key) in [(-1.0, "falling", "fall"), (1.0, "rising", "rise")] {
                let v = sign * factor * self.speed;
                let name = format!("{key}.{factor}");
                let f = heights.iter().map(|h| self.ring.force(*h, v).abs()).collect();
                columns.push(draw::column(&name, "N", f));
                lines.push(line(&format!("{way}, {}", label.replace('`', "")), &name));
            }
        }
        draw::table(out, "resistance", draw::column("height", "m", heights), columns);
        draw::curves(
            out,
            "resistance",
            "Resistance over the height",
            "magnitude of the force of the oil on both flanks",
            Scales { log_x: false, log_y: true },
            &lines,
        );
        draw::finite(MODEL, out)
    }
}
