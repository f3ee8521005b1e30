//! The scene `shaft_line`: torsional vibration of compressors and engines.
//!
//! A case is assembled once for each load step (`assemble`, `steps`) and each of these lines is asked for its vibration at one
//! speed after the other (`machine`). The case as it stands gives the results at the mean speed and the diagrams (`results`); all
//! of them give the verdict (`verdict`).
#![cfg_attr(doctest, doc = include_str!("../README.md"))]

pub mod assemble;
mod balance;
pub mod case;
mod draw;
mod gradients;
mod headlines;
mod hold;
mod legal;
mod machine;
mod methods;
mod names;
pub mod plan;
mod results;
mod start;
mod steps;
mod tables;
pub mod tors;
mod verdict;

use std::f64::consts::PI;

use gudgeon_core::kinds::{NaturalFrequenciesSpec, TorsionAnswer, TorsionCtx, TorsionOut, TorsionSpec};
use gudgeon_core::result::{Gradients, ModelUse, Note, RunResult};
use gudgeon_core::{BuildError, EvalError, Registry, Stopwatch};
use gudgeon_torsion::torsion::Orders;

use assemble::{Assembled, assemble, renamed};
use case::ShaftLineCase;
use gudgeon_case::Loaded;
use gudgeon_scene::{
    Explanation, GradientError, Progress, RunError, SceneCase, Stopped, Varied, WorkPrecision, model_use,
};
use machine::{Machine, Point};
use plan::Plan;
use results::Results;
use start::Start;

impl SceneCase for ShaftLineCase {
    type Built = Assembled;

    fn build(loaded: &Loaded<Self>) -> Result<Assembled, Vec<BuildError>> {
        let case = &loaded.value;
        let mut errors = legal::legal_values(case);
        let built = assemble(case, &loaded.source.files);
        match &built {
            Ok(a) => {
                errors.extend(legal::legal_names(case, &a.line));
                let start = Start::new(case, a.line.nodes.len());
                errors.extend(start.errors.iter().cloned());
                if errors.is_empty() {
                    errors.extend(legal_machine(case, a, &start));
                }
            }
            Err(e) => errors.extend(e.iter().cloned()),
        }
        // What is wrong with the case would come back in every load step.
        if errors.is_empty() {
            errors.extend(steps::legal(loaded));
        }
        built.and_then(|a| if errors.is_empty() { Ok(a) } else { Err(Vec::new()) }).map_err(|_| errors)
    }

    fn explain(
        loaded: &Loaded<Self>,
        _: &mut Assembled,
        told: &mut Explanation,
    ) -> Result<Vec<ModelUse>, RunError> {
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

    fn result_names(loaded: &Loaded<Self>, a: &mut Assembled) -> Option<Vec<String>> {
        let case = &loaded.value;
        let plan = Plan::new(case);
        let start = Start::new(case, a.line.nodes.len());
        let excited = gudgeon_torsion::steady::Steady::new(&start.context(case, a)).ok()?.excitation;
        let orders: Vec<f64> = excited.orders.iter().map(|o| o.order).collect();
        Some(names::names(case, &plan, a, &orders))
    }

    fn work_precision(loaded: &Loaded<Self>, a: &mut Assembled) -> Result<WorkPrecision, String> {
        Ok(methods::work_precision(&loaded.value, a))
    }

    fn run(
        loaded: &Loaded<Self>,
        a: Assembled,
        progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
    ) -> Result<RunResult, RunError> {
        run(loaded, &a, &Plan::new(&loaded.value), progress)
    }

    /// Those at the mean speed.
    fn gradients(
        loaded: &Loaded<Self>,
        a: Assembled,
        varied: &dyn Fn() -> Result<Vec<Varied<Self>>, GradientError>,
        progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
    ) -> Result<Gradients, GradientError> {
        gradients::gradients(loaded, &a, varied, progress)
    }
}

/// Runs what is planned.
fn run(
    loaded: &Loaded<ShaftLineCase>,
    a: &Assembled,
    plan: &Plan,
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<RunResult, RunError> {
    let begin = Stopwatch::start();
    let case = &loaded.value;
    let files = &loaded.source.files;
    let mut result =
        RunResult { models: models(case, plan), skipped: plan.skipped.clone(), ..RunResult::default() };
    result.solver.method = case.models.torsion.typetag_name().into();
    for counter in ["lines_built", "time_steps", "linear_solutions", "pivot_counts"] {
        result.solver.counters.insert(counter.into(), 0);
    }
    let mut results = Results::new(case, &mut result);
    if !plan.line() {
        if plan.throws {
            let throws = assemble::throws_alone(case, files, case.speed.si()).map_err(refused)?;
            results.throws(&throws);
        }
        result.seconds.insert("solve".into(), begin.seconds());
        return Ok(result);
    }
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
    if plan.throws {
        results.throws(&a.line.throws);
    }
    let start = Start::new(case, a.line.nodes.len());
    let mut run = Run { loaded, plan, a, start, results };
    progress(Progress { phase: "natural frequencies".into(), fraction: 0.0 })?;
    if plan.frequencies {
        run.frequencies()?;
    }
    progress(Progress { phase: "response".into(), fraction: 0.1 })?;
    run.response_and_verdict(progress)?;
    tables::figures(case, &a.line, &mut result);
    result.headlines = headlines::headlines(case, a, &result);
    result.lead = draw::CAMPBELL.into();
    result.seconds.insert("solve".into(), begin.seconds());
    Ok(result)
}

fn refused(errors: Vec<BuildError>) -> RunError {
    RunError::Refused(errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))
}

fn one(error: BuildError) -> RunError {
    refused(vec![error])
}

fn failed(source: EvalError) -> RunError {
    RunError::Model { source }
}

/// What is wrong with a line as its models see it.
fn legal_machine(case: &ShaftLineCase, a: &Assembled, start: &Start) -> Vec<BuildError> {
    let ctx = start.context(case, a);
    let mut errors = Vec::new();
    if let Err(e) = case.models.torsion.build(&ctx) {
        errors.push(renamed(e).within_model("torsion"));
    }
    if let Err(e) = case.models.natural_frequencies.build(&a.line) {
        errors.push(renamed(e).within_model("natural_frequencies"));
    }
    errors
}

/// A run of a case whose line stands.
struct Run<'r> {
    loaded: &'r Loaded<ShaftLineCase>,
    plan: &'r Plan,
    a: &'r Assembled,
    start: Start,
    results: Results<'r>,
}

impl Run<'_> {
    /// Natural frequencies about the mean torque.
    fn frequencies(&mut self) -> Result<(), RunError> {
        let (case, a) = (&self.loaded.value, self.a);
        let wanted = &case.models.natural_frequencies;
        let ctx = self.start.context(case, a);
        let line = gudgeon_torsion::steady::about_mean_torque(&ctx).map_err(one)?;
        let mut modes = wanted.build(&line).map_err(one)?.modes().map_err(failed)?;
        if !wanted.are_of_the_line() {
            // A model that is known to be wrong stands beside the truth.
            self.results.published(&modes, &a.line);
            let truth = gudgeon_torsion::natural_frequencies::Eigenvalues::default();
            modes = truth.build(&line).map_err(one)?.modes().map_err(failed)?;
        }
        self.results.modes(&modes, &a.line);
        let mut steady = gudgeon_torsion::steady::Steady::new(&ctx).map_err(one)?;
        self.results.critical_speeds(&modes, &mut steady, a).map_err(failed)?;
        self.results.stable_step(&modes);
        Ok(())
    }

    /// What the torsion model answers, for the case and its load steps.
    fn response_and_verdict(
        &mut self,
        progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
    ) -> Result<(), RunError> {
        let case = &self.loaded.value;
        match case.models.torsion.answers() {
            TorsionAnswer::Time => self.over_time(progress),
            TorsionAnswer::Periodic => self.periodic(progress),
            TorsionAnswer::Nothing => self.separation_alone(),
        }
    }

    /// Vibration at the mean speed, over the diagram's speeds, and the verdict over the operating range.
    fn periodic(
        &mut self,
        progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
    ) -> Result<(), RunError> {
        let (case, a, plan) = (&self.loaded.value, self.a, self.plan);
        let start = self.start.clone();
        let mut machine = machine_of(&start, case, a)?;
        machine.speed_fluctuation = !case.limits.irregularity.is_empty();
        machine.by_order = plan.range;
        if plan.response {
            let out = machine.motion(case.speed.si()).map_err(failed)?;
            self.results.periodic(&out, &mut machine);
            self.results.balanced(&a.line, &out);
            if plan.fuller {
                self.left_out(&out, &mut machine);
            }
        }
        let speeds = if plan.range { speeds(case) } else { Vec::new() };
        let mut worst = 0;
        let mut peaks = Vec::new();
        if plan.range {
            progress(Progress { phase: "vibration over the speed".into(), fraction: 0.3 })?;
            self.results.gas_over_speed(a, &self.loaded.source.files, &speeds);
            (worst, peaks) = self.results.range(&mut machine, &speeds).map_err(failed)?;
        }
        if !plan.verdict {
            let mut alone = [(steps::AS_IT_STANDS.to_owned(), machine)];
            if plan.range {
                self.results.over_speed(&mut alone, 0, (&speeds, &peaks), worst).map_err(failed)?;
            }
            self.results.work(&alone[0].1);
            return Ok(());
        }
        progress(Progress { phase: "verdict".into(), fraction: 0.6 })?;
        let steps = self.load_steps()?;
        let starts: Vec<Start> =
            steps.iter().map(|(c, a)| Start::new(&c.value, a.line.nodes.len())).collect();
        let mut machines = Vec::new();
        for ((c, a), start) in steps.iter().zip(&starts) {
            let mut m = machine_of(start, &c.value, a)?;
            m.speed_fluctuation = machine.speed_fluctuation;
            machines.push(m);
        }
        let mut own = Some(machine);
        let mut changed = machines.into_iter();
        let mut all: Vec<(String, Machine<'_>)> = Vec::new();
        for (name, step) in steps::all(case) {
            let next = if step.is_some() { changed.next() } else { own.take() };
            all.extend(next.map(|m| (name.to_owned(), m)));
        }
        let peaks = self.results.verdict(&mut all, &speeds, plan.forced).map_err(failed)?;
        let own = steps::all(case).iter().position(|s| s.1.is_none());
        if let Some(own) = own.filter(|_| plan.range) {
            self.results.over_speed(&mut all, own, (&speeds, &peaks), worst).map_err(failed)?;
        }
        let machines: Vec<&Assembled> = all.iter().map(|(_, m)| m.a).collect();
        self.results.gas_loads(&machines);
        for (_, m) in &all {
            self.results.work(m);
        }
        Ok(())
    }

    /// Load steps that change something, each read and assembled once.
    fn load_steps(&mut self) -> Result<Vec<(Loaded<ShaftLineCase>, Assembled)>, RunError> {
        let mut all = Vec::new();
        for (_, step) in steps::all(&self.loaded.value) {
            let Some(step) = step else { continue };
            let changed = steps::read(self.loaded, step).map_err(|r| RunError::Refused(r.to_string()))?;
            let a = assemble(&changed.value, &changed.source.files).map_err(refused)?;
            self.results.count("lines_built", 1);
            all.push((changed, a));
        }
        Ok(all)
    }

    /// Says how much a model leaves out, by the one that has it, at the mean speed.
    fn left_out(&mut self, out: &TorsionOut, machine: &mut Machine<'_>) {
        let (case, a) = (&self.loaded.value, self.a);
        let Some(fuller) = case.models.torsion.fuller(&a.line) else { return };
        let mut whole = TorsionOut::default();
        let answer = fuller
            .build(&self.start.context(case, a))
            .map_err(|e| e.to_string())
            .and_then(|mut m| m.run(&mut whole).map_err(|e| e.to_string()));
        let (name, better) = (case.models.torsion.typetag_name(), fuller.typetag_name());
        let what = format!(
            "`{name}` leaves out what variable inertia and stiffness and the true angle do to the vibration"
        );
        if let Err(e) = answer {
            let text = format!("{what}; how much cannot be told: `{better}` gives no answer ({e})");
            self.results.note(&[Note::caution("left_out", text)]);
            return;
        }
        let mut amplitudes = |o: &TorsionOut| -> Vec<f64> {
            let cycle = machine.extremes(o);
            (0..a.line.links.len())
                .map(|l| cycle.extremes(0.0, o.orders.torque(l)))
                .map(|[top, bottom]| 0.5 * (top - bottom))
                .collect()
        };
        let (less, more) = (amplitudes(out), amplitudes(&whole));
        let largest = more.iter().copied().fold(0.0, f64::max);
        // Shafts that hardly vibrate say nothing.
        let change = |l: usize| if more[l] > 0.05 * largest { less[l] / more[l] - 1.0 } else { 0.0 };
        let Some(l) = (0..more.len()).max_by(|x, y| change(*x).abs().total_cmp(&change(*y).abs())) else {
            return;
        };
        let text = format!(
            "{what}: with it ({better}) the torque amplitude of {} at the mean speed is {:.0} N m instead of {:.0} N m, {name} has {:+.2} % there",
            a.line.links[l].name,
            more[l],
            less[l],
            100.0 * change(l)
        );
        let note = Note::caution("left_out", text);
        self.results.note(&[note.amount("largest_change", 100.0 * change(l), "%")]);
    }

    /// Motion over time, of the case and of its load steps where limits need them.
    fn over_time(
        &mut self,
        progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
    ) -> Result<(), RunError> {
        let (case, a, plan) = (&self.loaded.value, self.a, self.plan);
        let mut judged = Vec::new();
        if plan.response {
            let out = motion(case, a, &mut self.start)?;
            judged.push(self.results.transient(&out, a, self.start.rows));
        }
        if !plan.verdict {
            return Ok(());
        }
        let steps = self.load_steps()?;
        for (k, (changed, a)) in steps.iter().enumerate().filter(|_| plan.response) {
            let fraction = (k + 1) as f64 / (steps.len() + 1) as f64;
            progress(Progress { phase: "load steps".into(), fraction })?;
            let mut start = Start::new(&changed.value, a.line.nodes.len());
            let out = motion(&changed.value, a, &mut start)?;
            let mut aside = RunResult::default();
            judged.push(Results::new(&changed.value, &mut aside).transient(&out, a, start.rows));
        }
        self.verdict_of(&steps, &judged)
    }

    /// Limits on natural frequencies, without any vibration.
    fn separation_alone(&mut self) -> Result<(), RunError> {
        if !self.plan.verdict {
            return Ok(());
        }
        let steps = self.load_steps()?;
        self.verdict_of(&steps, &[])
    }

    /// The verdict with vibration that is known already, of the case and of the load steps that change something.
    fn verdict_of(
        &mut self,
        steps: &[(Loaded<ShaftLineCase>, Assembled)],
        judged: &[Point],
    ) -> Result<(), RunError> {
        let case = &self.loaded.value;
        let mut lines = vec![self.a];
        lines.extend(steps.iter().map(|(_, a)| a));
        let starts: Vec<Start> = lines.iter().map(|a| Start::new(case, a.line.nodes.len())).collect();
        let mut all = Vec::new();
        let mut next = 1;
        for (name, step) in steps::all(case) {
            let k = step.map_or(0, |_| next);
            next += usize::from(step.is_some());
            let mut m = Machine::new(starts[k].context(case, lines[k]), lines[k], &Orders {}).map_err(one)?;
            if let Some(p) = judged.get(k) {
                m.given(case.speed.si(), p.clone());
            }
            all.push((name.to_owned(), m));
        }
        self.results.verdict(&mut all, &[], !judged.is_empty()).map_err(failed)?;
        Ok(())
    }
}

/// A line with the model of its case.
fn machine_of<'a>(start: &'a Start, case: &ShaftLineCase, a: &'a Assembled) -> Result<Machine<'a>, RunError> {
    Machine::new(start.context(case, a), a, &*case.models.torsion).map_err(one)
}

/// Motion over time of a line.
fn motion(case: &ShaftLineCase, a: &Assembled, start: &mut Start) -> Result<TorsionOut, RunError> {
    if case.time.as_ref().is_some_and(|t| t.start_steady) {
        let mut steady = TorsionOut::default();
        Orders {}.build(&start.context(case, a)).map_err(one)?.run(&mut steady).map_err(failed)?;
        start.take_steady(&steady);
    }
    let held = match case.time.as_ref().is_some_and(|t| t.hold_speed) {
        true => Some(hold::held(&start.context(case, a))?),
        false => None,
    };
    let ctx = TorsionCtx { line: held.as_ref().unwrap_or(&a.line), ..start.context(case, a) };
    let mut torsion = case.models.torsion.build(&ctx).map_err(one)?;
    let mut out = TorsionOut::default();
    torsion.run(&mut out).map_err(failed)?;
    // The torque that holds the speed is no drive of the case.
    out.drive.iter_mut().for_each(|d| d.truncate(a.line.drives.len()));
    Ok(out)
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

/// A speed \[rad/s\] in words.
fn told(omega: f64) -> String {
    format!("{:.2} rpm", rpm(omega))
}

/// rad/s to rpm.
fn rpm(omega: f64) -> f64 {
    omega * 30.0 / PI
}

gudgeon_scene::register_scene! {
    ShaftLineCase,
    name: "shaft_line",
    summary: "a shaft line that twists",
    equations: "J(theta) theta'' + J'(theta) theta'^2 / 2 + C theta' + K theta = T(theta, t) for every inertia of a tree of shafts",
    validity: "Torsion alone: no bending, no axial vibration; rigid throws.",
    references: ["gomes2021"],
}

gudgeon_core::link!(case::ShaftLineCase,);
