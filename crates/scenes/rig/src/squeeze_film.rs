use gudgeon_core::face::Face;
use gudgeon_core::geometry::FaceProfile;
use gudgeon_core::kinds::{
    Film1d, Film1dCtx, Film1dIn, Film1dOut, Film1dSpec, FilmEnd, FilmField, FilmFront, FilmTime, Rig, RigCtx,
    RigOut, RigSpec, named,
};
use gudgeon_core::quantity::{
    Force, PosLength, PosTime, PosViscosity, Positive, Pressure, Time, Velocity, quantity,
};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_film::film_1d::LineProfile;
use gudgeon_numerics::elementary;
use serde::{Deserialize, Serialize};

use crate::{along, profile, validity};

/// A film between a plane and a strip or a ring face that move towards each other or apart, without sliding.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SqueezeFilmRig {
    /// Length of the strip.
    pub length: PosLength,
    /// Shape of its face; flat when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub face: Option<Face>,
    /// How the gap changes.
    pub motion: Motion,
    /// Number of panels that the strip is divided into, about.
    #[serde(default = "panels")]
    #[schemars(range(min = 1, max = 100_000), extend("x-refine" = { "group": "film grid", "factor": 2 }))]
    pub panels: u32,
    /// Absolute pressure at both ends.
    pub p_ends: Pressure,
    /// Absolute cavitation pressure.
    #[serde(default = "vacuum")]
    pub p_cav: Pressure,
    /// Viscosity.
    pub viscosity: PosViscosity,
    /// The model.
    pub film_1d: Box<dyn Film1dSpec>,
}

/// How a gap changes. A gap is counted where the drop of the face is zero.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(tag = "mode", rename_all = "snake_case", deny_unknown_fields)]
pub enum Motion {
    /// One instant: a gap and its velocity.
    Velocity {
        /// The gap.
        gap: PosLength,
        /// Velocity, opening positive.
        velocity: Velocity,
    },
    /// The strip falls under a load, without inertia.
    Fall {
        /// Gap at the start.
        gap: PosLength,
        /// Gap at the end, smaller.
        gap_end: PosLength,
        /// Load per metre of width, above that of the pressure at the ends.
        load: Force<Positive>,
    },
    /// The gap is `mean + amplitude cos(2π t/period)`, full of oil at the start.
    Oscillation {
        /// Mean gap.
        mean: PosLength,
        /// Amplitude, smaller than the mean.
        amplitude: PosLength,
        /// Period.
        period: PosTime,
        /// How long.
        duration: PosTime,
        /// Times at which load and film are results.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        at: Vec<Time>,
        /// Steps of a period.
        #[serde(default = "steps")]
        #[schemars(range(min = 4, max = 100_000))]
        steps: u32,
    },
}

impl Motion {
    /// The gap at which the line is laid out \[m\]; complains of what contradicts itself.
    fn check(&self, errors: &mut Vec<BuildError>) -> f64 {
        match self {
            Self::Velocity { gap, .. } => gap.si(),
            Self::Fall { gap, gap_end, .. } => {
                if gap_end.si() >= gap.si() {
                    errors.push(BuildError::at(
                        "motion.gap_end",
                        format!("the strip falls: {} um must be less than `gap`", 1e6 * gap_end.si()),
                    ));
                }
                gap.si()
            }
            Self::Oscillation { mean, amplitude, period, duration, at, steps } => {
                if amplitude.si() >= mean.si() {
                    errors.push(BuildError::at(
                        "motion.amplitude",
                        "must be smaller than `mean`: no gap is left",
                    ));
                }
                if !(4..=100_000).contains(steps) {
                    errors.push(BuildError::at(
                        "motion.steps",
                        format!("must be between 4 and 100000, not {steps}"),
                    ));
                }
                if duration.si() / period.si() * f64::from(*steps) > MAX_STEPS {
                    errors.push(BuildError::at(
                        "motion.duration",
                        format!("{MAX_STEPS} steps in all are the most"),
                    ));
                }
                for (k, t) in at.iter().enumerate() {
                    if !(0.0..=duration.si()).contains(&t.si()) {
                        errors.push(BuildError::at(
                            format!("motion.at.{k}"),
                            "must lie between zero and `duration`",
                        ));
                    }
                }
                mean.si() + amplitude.si()
            }
        }
    }
}

fn panels() -> u32 {
    200
}
fn steps() -> u32 {
    1000
}
fn vacuum() -> Pressure {
    quantity(0.0)
}

#[register_model(
    name = "squeeze_film",
    summary = "squeeze film of a strip or ring face: load at a velocity, fall under a load, oscillation with cavitation",
    equations = "load = int (p - p_ends) dx;  strip: load = -mu L^3 (dh/dt)/h^3;  fall: t = int dh/(-dh/dt) at that load, \
                strip: t = mu L^3/(2 W) (1/h_end^2 - 1/h^2);  oscillation: h = mean + amplitude cos(2 pi t/period), implicit Euler steps",
    validity = "Narrow gap, no sliding, no flow across the line, no inertia. The mode `oscillation` is of first order in the step.",
    references = ["reynolds1886"],
    example = "length = \"1.2 mm\"\nmotion = { mode = \"fall\", gap = \"10 um\", gap_end = \"1 um\", load = \"1 kN\" }\n\
              p_ends = \"1 bar\"\nviscosity = \"10 mPa s\"\nfilm_1d = { model = \"complementarity\" }\n",
)]
impl RigSpec for SqueezeFilmRig {
    fn models(&self) -> Vec<(&'static str, &'static str)> {
        vec![("film_1d", self.film_1d.typetag_name())]
    }
    fn build(&self, _: &RigCtx<'_>) -> Result<Box<dyn Rig>, Vec<BuildError>> {
        let mut errors = Vec::new();
        let length = self.length.si();
        let face = match &self.face {
            None => Ok(FaceProfile::Table { length, drops: vec![0.0; 2] }),
            Some(f) => f.profile(length).map_err(|e| e.within("face")),
        };
        let gap = self.motion.check(&mut errors);
        errors.extend(self.unanswered());
        errors.extend(along::cavitation_below(self.p_cav.si(), &[self.p_ends.si()]));
        let mut keep = |e: BuildError| errors.push(e);
        let line = match (profile::panels(self.panels), face) {
            (Ok(n), Ok(face)) => line(&face, gap, n).map_err(keep).ok(),
            (n, face) => {
                let _ = n.map_err(&mut keep);
                let _ = face.map_err(keep);
                None
            }
        };
        let film = line.as_ref().and_then(|l| {
            let built = self.film_1d.build(&Film1dCtx { x: &l.x });
            built.map_err(|e| errors.push(e.within("film_1d"))).ok()
        });
        match (line, film) {
            (Some(line), Some(film)) if errors.is_empty() => {
                let mut bench = Bench {
                    mu: vec![self.viscosity.si(); line.panels()],
                    still: line.clone(),
                    line,
                    gap,
                    film,
                    motion: self.motion.clone(),
                    p: self.p_ends.si(),
                    p_cav: self.p_cav.si(),
                };
                if let Motion::Fall { load, .. } = &self.motion
                    && let Ok((_, carried, _)) = bench.pressed(gap, load.si())
                    && carried <= 0.0
                {
                    let what = "carries nothing: under a load the gap would close at once";
                    return Err(vec![BuildError::at("film_1d.model", what)]);
                }
                Ok(Box::new(bench))
            }
            _ => Err(errors),
        }
    }
}

impl SqueezeFilmRig {
    /// The refusal of a film model that knows no gap that changes like this one.
    fn unanswered(&self) -> Option<BuildError> {
        let scope = self.film_1d.scope();
        let answers = match &self.motion {
            Motion::Velocity { .. } | Motion::Fall { .. } => scope.squeeze,
            Motion::Oscillation { .. } => scope.steps,
        };
        (!answers).then(|| {
            let what = format!("`{}` knows no gap that changes in this way", self.film_1d.typetag_name());
            let help = "`complementarity` knows all of them";
            BuildError::at("film_1d.model", what).help(help)
        })
    }
}

/// Maximum number of steps.
const MAX_STEPS: f64 = 1e6;

/// The line below a face at the given gap.
fn line(face: &FaceProfile, gap: f64, panels: usize) -> Result<LineProfile, BuildError> {
    let length = face.length();
    match face.nodes() {
        None => LineProfile::pieces(&[0.0, length], panels, |_, x| gap + face.drop_at(x)),
        Some(nodes) => {
            let points: Vec<_> = nodes.into_iter().map(|(x, d)| (x, gap + d)).collect();
            LineProfile::table(&points, panels)
        }
    }
    .map_err(|e| BuildError { field: if e.field == "panels" { e.field } else { String::new() }, ..e })
}

struct Bench {
    /// The line at `gap`.
    still: LineProfile,
    line: LineProfile,
    gap: f64,
    film: Box<dyn Film1d>,
    motion: Motion,
    mu: Vec<f64>,
    p: f64,
    p_cav: f64,
}

/// Points along the line and rows in time of a map.
const MAP: (usize, usize) = (101, 201);
/// Points of the history of a fall.
const FALL: usize = 200;

impl Bench {
    fn length(&self) -> f64 {
        self.line.x[self.line.panels()] - self.line.x[0]
    }

    /// Sets the gap.
    fn open(&mut self, gap: f64) {
        let lift = gap - self.gap;
        for (h, s) in self.line.h_a.iter_mut().zip(&self.still.h_a) {
            *h = s + lift;
        }
        for (h, s) in self.line.h_b.iter_mut().zip(&self.still.h_b) {
            *h = s + lift;
        }
    }

    fn solve(&mut self, time: FilmTime<'_>) -> Result<Film1dOut, EvalError> {
        self.film.solve(&Film1dIn {
            h_a: &self.line.h_a,
            h_b: &self.line.h_b,
            mu: &self.mu,
            factors: None,
            u: 0.0,
            ends: [FilmEnd::Flooded { p: self.p }; 2],
            p_cav: self.p_cav,
            time,
        })
    }

    /// Load above that of the pressure at the ends.
    fn above(&self, o: &Film1dOut) -> f64 {
        o.load - (self.p - self.p_cav).max(0.0) * self.length()
    }

    fn velocity(&mut self, out: &mut RigOut, velocity: f64) -> Result<(), EvalError> {
        let o = self.solve(FilmTime::Squeeze(&vec![velocity; self.mu.len()]))?;
        out.result(
            "load",
            self.above(&o),
            "N/m",
            "load above that of the pressure at the ends, per metre of width",
        );
        out.result("p_max", o.p_max / 1e5, "bar", "highest pressure");
        out.result("flux_out", o.flux_out - o.flux_in, "m2/s", "flux of oil out of both ends");
        out.balance.oil_mass = along::oil_balance(&o);
        out.counters.insert("iterations".into(), o.iterations as u64);
        let field = self.film.field();
        out.axis("x", "m", self.line.x.clone());
        out.column("p", "Pa", field.p.to_vec());
        out.column("fill", "", field.fill.to_vec());
        out.curves("Pressure along the strip", "absolute", &[("pressure", "p")]);
        out.curves("Filled fraction of the gap", "", &[("fill", "fill")]);
        Ok(())
    }

    /// A velocity of the size that a flat strip has under a load, the load that the film carries at it, and its highest pressure.
    fn pressed(&mut self, gap: f64, load: f64) -> Result<(f64, f64, f64), EvalError> {
        self.open(gap);
        let scale = (gap / self.length()).powi(3) * load / self.mu[0];
        let o = self.solve(FilmTime::Squeeze(&vec![-scale; self.mu.len()]))?;
        Ok((scale, self.above(&o), o.p_max))
    }

    /// Velocity at which the strip falls under a load, and the highest pressure: a film that is pressed is full, and its load
    /// grows with the velocity in proportion.
    fn falling(&mut self, gap: f64, load: f64) -> Result<(f64, f64), EvalError> {
        let (scale, carried, p_max) = self.pressed(gap, load)?;
        let ratio = load / carried;
        if !(carried > 0.0 && ratio.is_finite() && scale > 0.0) {
            return Err(EvalError::recoverable(
                "squeeze_film",
                format!("the film of {gap:e} m carries nothing"),
            ));
        }
        Ok((scale * ratio, self.p + (p_max - self.p) * ratio))
    }

    fn fall(&mut self, out: &mut RigOut, gap_end: f64, load: f64) -> Result<(), EvalError> {
        // Equal ratios of the gap; in each Gauss's rule in 1/h², in which the fall of a flat strip is uniform.
        let node = (0.6_f64).sqrt();
        let (first, steps) = (self.gap, FALL);
        let at = |k: usize| match k {
            0 => first,
            _ if k == steps => gap_end,
            _ => first * elementary::powf(gap_end / first, k as f64 / steps as f64),
        };
        let (mut time, mut rows) = (0.0, Vec::with_capacity(steps + 1));
        for k in 0..=steps {
            let h = at(k);
            let (v, p_max) = self.falling(h, load)?;
            rows.push((time, h, v, p_max));
            if k == steps {
                break;
            }
            let (a, b) = (at(k).powi(-2), at(k + 1).powi(-2));
            for (place, weight) in [(-node, 5.0 / 18.0), (0.0, 4.0 / 9.0), (node, 5.0 / 18.0)] {
                let s = 0.5 * (a + b) + 0.5 * (b - a) * place;
                let h = s.sqrt().recip();
                time += weight * (b - a) * 0.5 * h * h * h / self.falling(h, load)?.0;
            }
        }
        let fastest = rows.iter().fold(0.0, |m: f64, r| m.max(r.2));
        out.result("fall_time", time, "s", "time of the fall from `gap` to `gap_end`");
        out.result("v_start", rows[0].2, "m/s", "velocity of the fall at its start");
        out.result("v_end", rows[steps].2, "m/s", "velocity of the fall at its end");
        out.result("v_max", fastest, "m/s", "highest velocity of the fall");
        out.result("p_max", rows.iter().fold(0.0, |m: f64, r| m.max(r.3)) / 1e5, "bar", "highest pressure");
        out.counters.insert("film_evaluations".into(), (4 * steps + 1) as u64);
        out.axis("t", "s", rows.iter().map(|r| r.0).collect());
        out.column("h", "m", rows.iter().map(|r| r.1).collect());
        out.column("v", "m/s", rows.iter().map(|r| r.2).collect());
        out.column("p_max", "Pa", rows.iter().map(|r| r.3).collect());
        out.curves("Gap", "", &[("gap", "h")]);
        out.curves("Velocity of the fall", "", &[("velocity", "v")]);
        Ok(())
    }

    fn oscillation(&mut self, out: &mut RigOut, o: &Oscillation) -> Result<(), EvalError> {
        let n = self.line.panels();
        let omega = 2.0 * std::f64::consts::PI / o.period;
        // The duration is a whole number of steps.
        let steps = (o.duration / o.period * f64::from(o.steps) - 1e-6).ceil().max(1.0) as usize;
        let dt = o.duration / steps as f64;
        let mut content = vec![0.0; n + 1];
        self.film.full_content(&self.line.h_a, &self.line.h_b, &mut content);
        let mut history = History::new(stored(&content), steps);
        let mut map = HistoryMap::new(n, steps);
        for k in 1..=steps {
            let now = k as f64 * dt;
            let gap = o.mean + o.amplitude * elementary::cos(omega * now);
            self.open(gap);
            let f = self.solve(FilmTime::Step { dt, content: &content })?;
            let field = self.film.field();
            content.copy_from_slice(field.content);
            history.entered += dt * (f.flux_in - f.flux_out);
            history.through += dt * (f.flux_in.abs() + f.flux_out.abs());
            history.passes += f.iterations;
            history.rows.push(Instant {
                t: now,
                h: gap,
                dh: -o.amplitude * omega * elementary::sin(omega * now),
                load: self.above(&f),
                full: self.covered(field.fronts) / self.length(),
                oil: stored(&content),
                p_max: f.p_max,
            });
            if k % map.every == 0 || k == steps {
                map.add(now, &field);
            }
        }
        let rest = (self.p - self.p_cav).max(0.0) * self.length();
        history.extremes(out);
        history.moments(&o.at, dt, rest, out);
        history.account(out);
        history.series(out);
        map.draw(&self.line.x, out);
        Ok(())
    }

    /// Length of the line under full film \[m\].
    fn covered(&self, fronts: &[FilmFront]) -> f64 {
        let mut film = fronts.first().is_none_or(|f| f.film_before);
        let (mut from, mut covered) = (self.line.x[0], 0.0);
        for front in fronts {
            covered += if front.film_before { front.x - from } else { 0.0 };
            film = !front.film_before;
            from = front.x;
        }
        covered + if film { self.line.x[0] + self.length() - from } else { 0.0 }
    }
}

/// Oil that is stored \[m²\].
fn stored(content: &[f64]) -> f64 {
    content.iter().sum()
}

/// An oscillating film at the end of a step.
#[derive(Debug, Clone, Copy)]
struct Instant {
    t: f64,
    h: f64,
    dh: f64,
    /// Load above that of the pressure at the ends.
    load: f64,
    /// Part of the strip under full film.
    full: f64,
    oil: f64,
    p_max: f64,
}

/// An oscillation, step by step.
struct History {
    rows: Vec<Instant>,
    /// Oil at the start.
    start: f64,
    entered: f64,
    /// Oil that passed the ends, in and out.
    through: f64,
    passes: usize,
}

impl History {
    fn new(start: f64, steps: usize) -> Self {
        Self { rows: Vec::with_capacity(steps), start, entered: 0.0, through: 0.0, passes: 0 }
    }

    /// The first row at which a value, times `sign`, is largest.
    fn extreme(&self, of: fn(&Instant) -> f64, sign: f64) -> &Instant {
        self.rows.iter().fold(&self.rows[0], |m, r| if sign * of(r) > sign * of(m) { r } else { m })
    }

    /// Extremes, and times of the cavity.
    fn extremes(&self, out: &mut RigOut) {
        let load = |sign: f64| self.extreme(|r| r.load, sign).load;
        out.result("load_max", load(1.0), "N/m", "highest load above that of the pressure at the ends");
        out.result("load_min", load(-1.0), "N/m", "lowest load above that of the pressure at the ends");
        out.result("p_max", self.extreme(|r| r.p_max, 1.0).p_max / 1e5, "bar", "highest pressure");
        let min = self.extreme(|r| r.full, -1.0);
        out.result("film_part_min", min.full, "", "smallest part of the strip under full film");
        let Some(torn) = self.rows.iter().position(|r| r.full < 1.0) else { return };
        out.result("t_cavity", 1e3 * self.rows[torn].t, "ms", "first step with a cavity");
        out.result("t_film_part_min", 1e3 * min.t, "ms", "time of the smallest full film");
        if let Some(healed) = self.rows[torn..].iter().find(|r| r.full >= 1.0) {
            let what = "first step without a cavity after one with it";
            out.result("t_closed", 1e3 * healed.t, "ms", what);
        }
    }

    /// Load and film at given times; `rest` is the load of the pressure at the ends above the cavitation pressure.
    fn moments(&self, at: &[f64], dt: f64, rest: f64, out: &mut RigOut) {
        let steps = self.rows.len();
        for (k, moment) in at.iter().enumerate() {
            // Between the steps; the first step stands for what is before it.
            let place = (moment / dt - 1.0).clamp(0.0, (steps - 1) as f64);
            let i = (place as usize).min(steps.saturating_sub(2));
            let next = (i + 1).min(steps - 1);
            let at = |of: fn(&Instant) -> f64| {
                of(&self.rows[i]) + (place - i as f64) * (of(&self.rows[next]) - of(&self.rows[i]))
            };
            let when = format!("at {} ms", (1e9 * moment).round() / 1e6);
            let mut add = |name: &str, value: f64, unit: &str, what: &str| {
                out.result(format!("{name}_{}", k + 1), value, unit, format!("{what} {when}"));
            };
            add("load_cav", at(|r| r.load) + rest, "N/m", "load above the cavitation pressure");
            add("film_part", at(|r| r.full), "", "part of the strip under full film");
        }
    }

    /// Balance of oil, work.
    fn account(&self, out: &mut RigOut) {
        let size = self.through.max(self.start);
        let stored = self.rows[self.rows.len() - 1].oil - self.start;
        out.balance.oil_mass = (size > 0.0).then(|| (self.entered - stored) / size);
        out.counters.insert("steps".into(), self.rows.len() as u64);
        out.counters.insert("iterations".into(), self.passes as u64);
    }

    fn series(&self, out: &mut RigOut) {
        let of = |f: fn(&Instant) -> f64| self.rows.iter().map(f).collect::<Vec<f64>>();
        out.axis("t", "s", of(|r| r.t));
        out.column("h", "m", of(|r| r.h));
        out.column("dh", "m/s", of(|r| r.dh));
        out.column("load", "N/m", of(|r| r.load));
        out.column("film_part", "", of(|r| r.full));
        out.column("oil", "m2", of(|r| r.oil));
        out.column("p_max", "Pa", of(|r| r.p_max));
        out.curves("Gap", "", &[("gap", "h")]);
        out.curves("Load", "above that of the pressure at the ends, per metre of width", &[("load", "load")]);
        out.curves("Part of the strip under full film", "", &[("part", "film_part")]);
        out.curves("Oil in the gap", "per metre of width", &[("oil", "oil")]);
    }
}

/// Pressure and filling along the strip and over time.
struct HistoryMap {
    /// Nodes that are drawn.
    nodes: Vec<usize>,
    /// Steps between two rows.
    every: usize,
    t: Vec<f64>,
    p: Vec<f64>,
    fill: Vec<f64>,
}

impl HistoryMap {
    fn new(panels: usize, steps: usize) -> Self {
        let columns = MAP.0.min(panels + 1);
        let nodes = (0..columns).map(|k| k * panels / (columns - 1)).collect();
        let every = steps.div_ceil(MAP.1 - 1);
        Self { nodes, every, t: Vec::new(), p: Vec::new(), fill: Vec::new() }
    }

    fn add(&mut self, t: f64, field: &FilmField<'_>) {
        self.t.push(t);
        self.p.extend(self.nodes.iter().map(|i| field.p[*i]));
        self.fill.extend(self.nodes.iter().map(|i| field.fill[*i]));
    }

    fn draw(self, x: &[f64], out: &mut RigOut) {
        let x = self.nodes.iter().map(|i| x[*i]).collect();
        out.maps(
            "history",
            ("x", "m", x),
            ("t", "s", self.t),
            vec![
                ("fill", "", "Filled fraction of the gap along the strip and over time", self.fill),
                ("p", "Pa", "Pressure along the strip and over time", self.p),
            ],
        );
    }
}

/// [`Motion::Oscillation`] as numbers.
struct Oscillation {
    mean: f64,
    amplitude: f64,
    period: f64,
    duration: f64,
    at: Vec<f64>,
    steps: u32,
}

impl Rig for Bench {
    fn results(&self) -> Vec<String> {
        match &self.motion {
            Motion::Velocity { .. } => named(&["load", "p_max", "flux_out"]),
            Motion::Fall { .. } => named(&["fall_time", "v_start", "v_end", "v_max", "p_max"]),
            Motion::Oscillation { at, .. } => {
                let mut names = named(&["load_max", "load_min", "p_max", "film_part_min"]);
                names.extend(named(&["t_cavity", "t_film_part_min", "t_closed"]));
                let moment = |k| [format!("load_cav_{k}"), format!("film_part_{k}")];
                names.extend((1..=at.len()).flat_map(moment));
                names
            }
        }
    }

    fn run(&mut self, out: &mut RigOut) -> Result<(), EvalError> {
        match self.motion.clone() {
            Motion::Velocity { velocity, .. } => self.velocity(out, velocity.si()),
            Motion::Fall { gap_end, load, .. } => self.fall(out, gap_end.si(), load.si()),
            Motion::Oscillation { mean, amplitude, period, duration, at, steps } => self.oscillation(
                out,
                &Oscillation {
                    mean: mean.si(),
                    amplitude: amplitude.si(),
                    period: period.si(),
                    duration: duration.si(),
                    at: at.iter().map(|t| t.si()).collect(),
                    steps,
                },
            ),
        }?;
        validity::note_limits(out);
        along::finite(out, "squeeze_film")
    }
}
