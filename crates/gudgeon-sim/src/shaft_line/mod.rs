//! The scene `shaft_line`: torsional vibration of compressors and engines.

pub mod assemble;
pub mod case;
mod draw;
pub mod plan;
mod results;
pub mod tors;

use std::f64::consts::PI;
use std::time::Instant;

use gudgeon_core::kinds::{Line, NaturalFrequenciesSpec, TorsionAnswer, TorsionCtx, TorsionOut, TorsionSpec};
use gudgeon_core::result::{ModelUse, RunResult};
use gudgeon_core::{BuildError, EvalError, Registry};
use gudgeon_torsion::torsion::Orders;

use crate::load::Loaded;
use crate::run::{Explanation, Progress, RunError, model_use};
use crate::scene::SceneCase;
use assemble::{Assembled, assemble, renamed};
use case::ShaftLineCase;
use plan::Plan;
use results::Results;

impl SceneCase for ShaftLineCase {
    fn legal(loaded: &Loaded<Self>) -> Vec<BuildError> {
        let case = &loaded.value;
        let mut errors = legal_values(case);
        match assemble(case, &loaded.source.folder) {
            Ok(a) => {
                errors.extend(legal_names(case, &a.line));
                errors.extend(legal_memory(case, a.period, a.line.links.len()));
                let start = Start::new(case, a.line.nodes.len());
                errors.extend(start.errors.iter().cloned());
                if errors.is_empty() {
                    let ctx = start.context(case, &a);
                    if let Err(e) = case.models.torsion.build(&ctx) {
                        errors.push(renamed(e).within_model("torsion"));
                    }
                    if let Err(e) = case.models.natural_frequencies.build(&a.line) {
                        errors.push(renamed(e).within_model("natural_frequencies"));
                    }
                }
            }
            Err(e) => errors.extend(e),
        }
        errors
    }

    fn explain(loaded: &Loaded<Self>, told: &mut Explanation) -> Result<Vec<ModelUse>, RunError> {
        let case = &loaded.value;
        let plan = Plan::new(case);
        told.runs.clone_from(&plan.runs);
        told.skipped.clone_from(&plan.skipped);
        if plan.response && case.models.torsion.answers() == TorsionAnswer::Time {
            let names = case.inertias.iter().map(|i| &i.name).chain(case.dampers.iter().map(|d| &d.name));
            let names: Vec<&String> = names.collect();
            told.states = names.iter().map(|n| format!("angle of {n}")).collect();
            told.states.extend(names.iter().map(|n| format!("speed of {n}")));
        }
        Ok(models(case, &plan))
    }

    fn run(loaded: &Loaded<Self>, progress: &mut dyn FnMut(Progress)) -> Result<RunResult, RunError> {
        let begin = Instant::now();
        let case = &loaded.value;
        let folder = &loaded.source.folder;
        let plan = Plan::new(case);
        let model = |source: EvalError| RunError::Model { source };
        let refused = |e: Vec<BuildError>| {
            RunError::Refused(e.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))
        };
        let mut result =
            RunResult { models: models(case, &plan), skipped: plan.skipped.clone(), ..RunResult::default() };
        result.solver.method = case.models.torsion.typetag_name().into();
        for counter in ["lines_built", "time_steps", "linear_solutions"] {
            result.solver.counters.insert(counter.into(), 0);
        }
        let mut results = Results::new(case, &mut result);
        if !plan.line() {
            if plan.throws {
                results.throws(&assemble::throws_alone(case, folder).map_err(refused)?);
            }
            result.seconds.insert("solve".into(), begin.elapsed().as_secs_f64());
            return Ok(result);
        }
        let a = assemble(case, folder).map_err(refused)?;
        results.count("lines_built", 1);
        results.note(&a.notes);
        // Once for all throws that share a pressure.
        let mut told = Vec::new();
        for note in a.line.throws.iter().flat_map(|t| &t.ends).flat_map(|e| e.pressure.notes()) {
            if !told.contains(&note) {
                told.push(note);
            }
        }
        results.note(&told);
        let built = begin.elapsed().as_secs_f64();
        if plan.throws {
            results.throws(&a.line.throws);
        }
        let one = |e: BuildError| refused(vec![e]);
        let mut modes = Vec::new();
        let mut start = Start::new(case, a.line.nodes.len());
        if plan.frequencies {
            progress(Progress { phase: "natural frequencies".into(), fraction: 0.0 });
            let wanted = &case.models.natural_frequencies;
            // Small vibration happens about the mean torque.
            let line = gudgeon_torsion::steady::about_mean_torque(&start.context(case, &a)).map_err(one)?;
            modes = if wanted.typetag_name() == "eigenvalues" {
                wanted.build(&line).map_err(one)?.modes().map_err(model)?
            } else {
                // A model that is known to be wrong stands beside the truth.
                results.published(&wanted.build(&line).map_err(one)?.modes().map_err(model)?, &a.line);
                gudgeon_torsion::natural_frequencies::Eigenvalues::default()
                    .build(&line)
                    .map_err(one)?
                    .modes()
                    .map_err(model)?
            };
            results.modes(&modes, &a.line);
            results.critical_speeds(&modes, &a);
            if case.models.torsion.typetag_name() == "runge_kutta" {
                results.stable_step(&modes);
            }
        }
        let mut response = None;
        if plan.response {
            if case.time.as_ref().is_some_and(|t| t.start_steady)
                && case.models.torsion.answers() == TorsionAnswer::Time
            {
                let mut steady = TorsionOut::default();
                Orders {}.build(&start.context(case, &a)).map_err(one)?.run(&mut steady).map_err(model)?;
                start.take_steady(&steady);
            }
            progress(Progress { phase: "response".into(), fraction: 0.2 });
            let mut torsion = case.models.torsion.build(&start.context(case, &a)).map_err(one)?;
            let mut out = TorsionOut::default();
            torsion.run(&mut out).map_err(model)?;
            match case.models.torsion.answers() {
                TorsionAnswer::Periodic => results.periodic(&out, &a),
                _ => results.transient(&out, &a, start.rows),
            }
            response = Some(out);
        }
        if plan.range {
            progress(Progress { phase: "vibration over the speed".into(), fraction: 0.6 });
            let ctx = start.context(case, &a);
            let speeds = speeds(case);
            let range =
                gudgeon_torsion::speed_range::speed_range(&ctx, &speeds).map_err(one)?.map_err(model)?;
            results.range(&range, &speeds, &a);
        }
        results.verdict(&modes, response.as_ref(), &a);
        result.seconds.insert("build".into(), built);
        result.seconds.insert("solve".into(), begin.elapsed().as_secs_f64() - built);
        Ok(result)
    }
}

/// Places of errors of models.
trait WithinModel {
    fn within_model(self, kind: &str) -> Self;
}

impl WithinModel for BuildError {
    /// An error about the line keeps its place; one about the model's own values goes to the model.
    fn within_model(self, kind: &str) -> Self {
        let of_line = ["shafts", "inertias", "drives", "throw_inertia", "time", "start"];
        if self.field == "time" || self.field == "start" {
            return Self { field: "time".into(), ..self };
        }
        if self.field == "throw_inertia" {
            return self.within("models");
        }
        if of_line.iter().any(|p| self.field.starts_with(p)) {
            return self;
        }
        self.within(&format!("models.{kind}"))
    }
}

/// Speeds of the range \[rad/s\].
fn speeds(case: &ShaftLineCase) -> Vec<f64> {
    let (Some(a), Some(b)) = (case.range.from, case.range.to) else { return Vec::new() };
    let n = case.range.points;
    (0..n).map(|k| a.si() + (b.si() - a.si()) * k as f64 / (n - 1) as f64).collect()
}

fn models(case: &ShaftLineCase, plan: &Plan) -> Vec<ModelUse> {
    let mut all: Vec<(&str, &str)> = Vec::new();
    let mut add = |kind: &'static str, name: &'static str| {
        if !all.contains(&(kind, name)) {
            all.push((kind, name));
        }
    };
    if plan.response || plan.range {
        add("torsion", case.models.torsion.typetag_name());
    }
    if plan.frequencies {
        add("natural_frequencies", case.models.natural_frequencies.typetag_name());
        add("natural_frequencies", "eigenvalues");
    }
    if plan.throws || plan.line() {
        for t in &case.throws {
            let inertia = t.throw_inertia.as_ref().unwrap_or(&case.models.throw_inertia);
            add("throw_inertia", inertia.typetag_name());
            add("kinematics", case.models.kinematics.typetag_name());
            for e in &t.ends {
                add("cylinder_pressure", e.cylinder_pressure.typetag_name());
            }
        }
    }
    if plan.line() {
        for s in &case.shafts {
            add("coupling", s.coupling.as_ref().map_or("linear", |c| c.typetag_name()));
        }
        for d in &case.drives {
            add("drive", d.drive.typetag_name());
        }
    }
    let registry = Registry::collect();
    all.into_iter().map(|(k, m)| model_use(&registry, k, m)).collect()
}

/// Most rows of a motion over time.
const ROWS: f64 = 4e5;
/// Most values of a motion over time: half a gigabyte.
const VALUES: f64 = 6e7;

fn legal_values(case: &ShaftLineCase) -> Vec<BuildError> {
    let mut errors = Vec::new();
    let r = &case.range;
    if r.orders.si() > 2000.0 {
        errors.push(BuildError::at("range.orders", "at most 2000 orders"));
    }
    if r.interference_orders.si() > 100.0 {
        errors.push(BuildError::at("range.interference_orders", "at most 100 orders"));
    }
    match (r.from, r.to) {
        (Some(a), Some(b)) if a.si() >= b.si() => {
            errors.push(BuildError::at("range.to", "must be above `from`"));
        }
        (Some(_), None) => errors.push(BuildError::at("range.to", "is missing beside `from`")),
        (None, Some(_)) => errors.push(BuildError::at("range.from", "is missing beside `to`")),
        _ => {}
    }
    if !(2..=20_000).contains(&r.points) {
        errors.push(BuildError::at("range.points", "between 2 and 20000 speeds"));
    }
    for (k, l) in case.limits.separation.iter().enumerate() {
        if l.orders.is_empty() && l.frequencies.is_empty() {
            let what = "names neither orders nor frequencies";
            errors.push(BuildError::at(format!("limits.separation.{k}"), what));
        }
        if l.orders.iter().any(|o| !(o.is_finite() && *o > 0.0)) {
            errors.push(BuildError::at(
                format!("limits.separation.{k}.orders"),
                "orders are greater than zero",
            ));
        }
    }
    for (k, l) in case.limits.torque.iter().enumerate() {
        if l.amplitude.is_none() && l.peak.is_none() {
            let what = "gives neither `amplitude` nor `peak`";
            errors.push(BuildError::at(format!("limits.torque.{k}"), what));
        }
    }
    errors
}

/// Most bytes of torques kept over the speed range.
const MOST_OF_A_RANGE: f64 = (1u64 << 30) as f64;

/// Torques over speed keep a complex number for every speed, order and shaft.
fn legal_memory(case: &ShaftLineCase, period: f64, links: usize) -> Option<BuildError> {
    if !Plan::new(case).range {
        return None;
    }
    let orders = (case.range.orders.si() * period / (2.0 * PI)).round();
    let bytes = case.range.points as f64 * orders * links as f64 * size_of::<[f64; 2]>() as f64;
    let gigabytes = |b: f64| b / (1u64 << 30) as f64;
    let what = || {
        format!(
            "{} speeds times {orders} orders times {links} shafts take {:.1} GiB, at most {} GiB is kept",
            case.range.points,
            gigabytes(bytes),
            gigabytes(MOST_OF_A_RANGE)
        )
    };
    (bytes > MOST_OF_A_RANGE)
        .then(|| BuildError::at("range.points", what()).help("fewer `points` or fewer `orders`"))
}

fn legal_names(case: &ShaftLineCase, line: &Line) -> Vec<BuildError> {
    let names: Vec<&str> = line.links.iter().map(|l| l.name.as_str()).collect();
    let l = &case.limits;
    let stress =
        l.stress.iter().enumerate().map(|(k, s)| (format!("limits.stress.{k}.shaft"), s.shaft.as_str()));
    let torque =
        l.torque.iter().enumerate().map(|(k, s)| (format!("limits.torque.{k}.shaft"), s.shaft.as_str()));
    let heat = l.heat.iter().enumerate().map(|(k, s)| (format!("limits.heat.{k}.shaft"), s.shaft.as_str()));
    stress
        .filter(|(_, n)| !n.is_empty())
        .chain(torque)
        .chain(heat)
        .filter(|(_, n)| !names.contains(n))
        .map(|(place, n)| {
            let what = format!("there is no shaft `{n}`; {}", crate::load::advice(n, &names));
            BuildError::at(place, what)
        })
        .collect()
}

/// Start and instants of a motion over time.
struct Start {
    angles: Vec<f64>,
    speeds: Vec<f64>,
    times: Vec<f64>,
    /// How many of the instants are rows of the series; the rest are the window.
    rows: usize,
    errors: Vec<BuildError>,
}

impl Start {
    fn new(case: &ShaftLineCase, n: usize) -> Self {
        let mut s = Self {
            angles: vec![0.0; n],
            speeds: vec![case.speed.si(); n],
            times: Vec::new(),
            rows: 0,
            errors: Vec::new(),
        };
        for (v, i) in s.speeds.iter_mut().zip(&case.inertias) {
            *v *= i.ratio.si();
        }
        let Some(t) = &case.time else {
            if case.models.torsion.answers() == TorsionAnswer::Time {
                let what = "a motion over time needs a table `time` with `duration` and `interval`";
                s.errors.push(BuildError::at("models.torsion", what));
            }
            return s;
        };
        match t.start_speeds.as_slice() {
            [] => {}
            [one] => s.speeds.fill(one.si()),
            many if many.len() == n => s.speeds = many.iter().map(|v| v.si()).collect(),
            many => s.errors.push(BuildError::at(
                "time.start_speeds",
                format!("{} speeds for {n} inertias; give one for each, one for all, or none", many.len()),
            )),
        }
        let (end, step) = (t.duration.si(), t.interval.si());
        let window = t.window.map_or(0.1 * end, |w| w.si()).min(end);
        let fine = t.window_interval.map_or(step, |w| w.si());
        if end / step + window / fine > ROWS {
            let what = format!("{:.1e} rows are more than {ROWS:.0e}", end / step + window / fine);
            s.errors.push(BuildError::at("time.interval", what));
            return s;
        }
        // Angles, speeds and torques of each are kept.
        let values = (end / step + window / fine) * 3.0 * n as f64;
        if values > VALUES {
            let what = format!("{values:.1e} values over time are more than {VALUES:.0e}");
            s.errors.push(BuildError::at("time.interval", what));
            return s;
        }
        let grid = |from: f64, step: f64| {
            let n = ((end - from) / step + 1e-9).floor() as usize;
            (0..=n).map(move |k| from + step * k as f64)
        };
        // Rows and window in one ascending list; the window's own instants come on top of the rows there.
        let begin = end - window;
        s.times = grid(0.0, step).filter(|t| *t < begin - 1e-12 * end).collect();
        s.rows = s.times.len();
        s.times.extend(grid(begin, fine));
        s
    }

    fn take_steady(&mut self, out: &TorsionOut) {
        self.angles.clone_from(&out.mean_angle);
        for o in &out.orders {
            for (i, a) in o.angle.iter().enumerate() {
                self.angles[i] += a[0];
                self.speeds[i] -= o.order * out.speed * a[1];
            }
        }
    }

    fn context<'a>(&'a self, case: &ShaftLineCase, a: &'a Assembled) -> TorsionCtx<'a> {
        let balance = a.line.drives.iter().find(|d| d.factor > 0.0 && d.drive.orders().is_empty());
        TorsionCtx {
            line: &a.line,
            speed: case.speed.si(),
            orders: case.range.orders.si(),
            period: a.period,
            balance: balance.map_or(0, |d| d.node),
            angles: &self.angles,
            speeds: &self.speeds,
            times: &self.times,
        }
    }
}

/// rad/s to rpm.
fn rpm(omega: f64) -> f64 {
    omega * 30.0 / PI
}
