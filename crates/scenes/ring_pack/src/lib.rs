//! The scene `ring_pack`: one cylinder's rings with their gas, films and axial motion.
//!
//! `geometry` resolves dimensions, `plan` decides what must run, `assemble` builds the sub-models into a `pack::Pack`,
//! one of `implicit`, `substep_march` and `degree_march` solves it. `measure` gathers what the results need on the steps of the last cycle,
//! `results` says it, `record` holds the series.

pub mod assemble;
pub mod case;
pub mod contact_line;
pub mod degree_march;
mod end_gap;
mod error;
mod forces;
pub mod geometry;
pub mod implicit;
pub mod instant;
pub mod jacobian;
pub mod layout;
pub mod limits;
pub mod liner;
mod loads;
pub mod measure;
pub mod modes;
mod oil_faces;
pub mod pack;
pub mod plan;
pub mod record;
pub mod results;
pub mod ring;
pub mod rows;
mod scene;
mod stepping;
pub mod substep_march;
mod used;
pub mod watch;

use std::time::Instant;

use gudgeon_core::result::{Branch, Event, Note, Series, SolverReport};
use gudgeon_core::{BuildError, EvalError};
use gudgeon_numerics::panel::TRAPEZIUM;
use indexmap::IndexMap;

use crate::case::{Method, RingPackCase, Scheme};
pub use error::RingPackError;
use gudgeon_scene::{Progress, RunError};
use measure::Measures;
use pack::Pack;
use record::Record;
use results::{Cycle, Meter};
use rows::Rows;
use watch::Watch;

/// A solved pack: the last cycle of the first start, and what else was found.
pub struct Solved {
    /// Film on the liner at the dead centres, when oil is followed.
    pub liner: Option<Series>,
    /// The series of the last cycle.
    pub record: Record,
    /// The last cycle.
    pub cycle: Cycle,
    /// Periodic solutions, when there are several or the start matters.
    pub branches: Vec<Branch>,
    /// Rings that left the liner.
    pub retreats: Vec<Event>,
    /// Work.
    pub report: SolverReport,
    /// Wall time of the solver \[s\], recording excluded.
    pub seconds: f64,
}

/// One start brought to its periodic state.
struct Found {
    /// Film on the liner at the dead centres, when oil is followed.
    liner: Option<Series>,
    record: Recorded,
    cycle: Cycle,
    period: u32,
    cycles: f64,
    counters: IndexMap<String, u64>,
    notes: Vec<Note>,
    retreats: Vec<Event>,
    seconds: f64,
}

/// The series of a cycle, or what it is evaluated from.
enum Recorded {
    Series(Record),
    Rows(Rows),
}

/// Starts when the case names none.
fn starts(case: &RingPackCase, pack: &Pack) -> Vec<f64> {
    if !case.solver.starts.is_empty() {
        return case.solver.starts.iter().map(|p| p.si()).collect();
    }
    let mut s = vec![pack.p_crankcase];
    if pack.decision_interval().is_some() {
        s.push(6e5);
    }
    s
}

/// A result whose cycle is farther from repeating than this many times the tolerance is not the periodic one.
const NOT_PERIODIC: f64 = 10.0;

/// What to say of a marching scheme whose state changed by the part `change` over its last cycle.
fn unsettled(change: f64, tolerance: f64, cycles: u32, start: f64, advice: &str) -> Option<Note> {
    if change <= tolerance {
        return None;
    }
    let text = format!(
        "started with all lands at {:.2} bar, the state still changed by {:.2} % over cycle {cycles}, the last, where `solver.periodicity` asks \
         for {:.2} %: raise `solver.{advice}`",
        start / 1e5,
        100.0 * change,
        100.0 * tolerance,
    );
    let of = if change > NOT_PERIODIC * tolerance { Note::failure } else { Note::caution };
    Some(of("not_periodic".to_owned(), text).amount("change", change, "1").amount(
        "tolerance",
        tolerance,
        "1",
    ))
}

/// Two periodic solutions count as one when their results agree within this relative difference.
const SAME: f64 = 5e-3;

/// Solves the case.
///
/// # Errors
/// What stopped the solver.
pub fn solve(
    case: &RingPackCase,
    pack: &mut Pack,
    progress: &mut dyn FnMut(Progress),
) -> Result<Solved, RunError> {
    let starts = starts(case, pack);
    let total = starts.len() as f64;
    let mut found: Vec<(f64, Found)> = Vec::new();
    for (k, start) in starts.iter().enumerate() {
        let phase =
            if starts.len() > 1 { format!("start at {:.2} bar", start / 1e5) } else { "solving".to_owned() };
        let mut tell = |f: f64| progress(Progress { phase: phase.clone(), fraction: (k as f64 + f) / total });
        found.push((*start, one_start(case, pack, *start, &mut tell)?));
    }
    let m = meter(case);
    let mut branches: Vec<Branch> = Vec::new();
    for (start, f) in &found {
        let results = f.cycle.results(pack, m);
        let name = format!("{:.2} bar", start / 1e5);
        let alike = |b: &&mut Branch| {
            results.iter().filter(|(k, _)| k.as_str() != "periodicity_error" && !k.ends_with("_angle")).all(
                |(k, v)| {
                    b.results.get(k).is_some_and(|w| {
                        (v.value - w.value).abs() <= SAME * v.value.abs().max(w.value.abs()) + 1e-12
                    })
                },
            )
        };
        match branches.iter_mut().find(alike) {
            Some(b) => {
                b.start.push_str(" and ");
                b.start.push_str(&name);
            }
            None => {
                branches.push(Branch { start: format!("all lands at {name}"), period: f.period, results })
            }
        }
    }
    let mut report = SolverReport {
        method: method_name(case).into(),
        notes: pack.cylinder.notes(),
        ..SolverReport::default()
    };
    if branches.len() > 1 {
        report.notes.push(Note::caution(
            "several_solutions",
            format!(
                "this case has {} periodic solutions; the results are those of the first start ({})",
                branches.len(),
                branches[0].start
            ),
        ));
    }
    for b in &branches {
        match b.period {
            1 => {}
            // A marching scheme has said by how much.
            0 if case.solver.method == Method::AsPublished => {}
            0 => report.notes.push(Note::failure(
                "not_periodic",
                format!("started with {}, the cycle did not become periodic", b.start),
            )),
            p => report.notes.push(Note::caution(
                "subharmonic",
                format!("started with {}, the cycle repeats only every {p} cycles", b.start),
            )),
        }
    }
    if branches.len() < 2 {
        branches.clear();
    }
    let mut seconds = 0.0;
    for (_, f) in &found {
        seconds += f.seconds;
        for (name, n) in &f.counters {
            *report.counters.entry(name.clone()).or_insert(0) += n;
        }
        for n in &f.notes {
            // What acted is told once, for the reported cycle; how well a cycle repeats, for every start.
            let told = n.topic != "not_periodic" && report.notes.iter().any(|m| m.topic == n.topic);
            if !told && !report.notes.contains(n) {
                report.notes.push(n.clone());
            }
        }
    }
    report.counters.insert("cycles".into(), found.iter().map(|(_, f)| f.cycles).sum::<f64>().ceil() as u64);
    report.counters.insert("states".into(), pack.layout.n as u64);
    report.counters.insert("film_evaluations".into(), pack.counters.film);
    report.counters.insert("gas_evaluations".into(), pack.counters.gas);
    let (_, first) = found.swap_remove(0);
    let record = match first.record {
        Recorded::Series(record) => record,
        Recorded::Rows(rows) => rows
            .record(pack)
            .map_err(|source| RunError::Eval { theta_deg: pack.at.theta.to_degrees(), source })?,
    };
    Ok(Solved {
        liner: first.liner,
        record,
        cycle: first.cycle,
        branches,
        retreats: first.retreats,
        report,
        seconds,
    })
}

fn method_name(case: &RingPackCase) -> &'static str {
    match (case.solver.method, case.solver.scheme) {
        (Method::Implicit, _) => "implicit",
        (Method::AsPublished, Scheme::SubstepMarch) => "as_published/substep_march",
        (Method::AsPublished, Scheme::DegreeMarch) => "as_published/degree_march",
    }
}

/// Steps of mechanics per crank degree, and of gas per step of mechanics, of a published scheme.
fn marching_steps(case: &RingPackCase, rings: usize) -> (u32, u32) {
    let s = &case.solver;
    let own = match s.scheme {
        Scheme::SubstepMarch => (rings as u32 + 1, 1 << (rings + 1).min(20)),
        Scheme::DegreeMarch => (1, 10),
    };
    let or = |given: u32, own: u32| if given == 0 { own } else { given };
    (or(s.steps_per_degree, own.0), or(s.gas_steps, own.1))
}

/// Gas steps of a published scheme that are longer than the gas model can be marched with.
fn too_long(case: &RingPackCase, pack: &Pack) -> Option<BuildError> {
    let (steps, gas_steps) = marching_steps(case, pack.n_rings());
    let mechanics = 1f64.to_radians() / pack.omega / f64::from(steps);
    let (own, longest) = (mechanics / f64::from(gas_steps), pack.gas.max_explicit_step()?);
    (case.solver.method == Method::AsPublished && own > longest).then(|| {
        let (enough, ratio) = ((mechanics / longest).ceil(), own / longest);
        let what = format!(
            "an explicit gas step of {own:.2e} s is longer than the {longest:.2e} s within which `models.gas_flow` lets merged volumes come together: \
             masses would fall below zero"
        );
        BuildError::at("solver.gas_steps", what).help(format!(
            "`solver.gas_steps = {enough}`, or a `models.gas_flow.merge_time` {:.2} times as long, or `solver.method = \"implicit\"`",
            ratio * 1.01
        ))
    })
}

fn one_start(
    case: &RingPackCase,
    pack: &mut Pack,
    start: f64,
    progress: &mut dyn FnMut(f64),
) -> Result<Found, RunError> {
    let s = &case.solver;
    let begin = Instant::now();
    let mut record = Record::new(pack);
    let mut measures = Measures::new(pack, TRAPEZIUM, case.outputs.seat.si());
    let at = |pack: &Pack| {
        let theta_deg = pack.at.theta.to_degrees();
        move |source: EvalError| RunError::Eval { theta_deg, source }
    };
    match (s.method, s.scheme) {
        (Method::Implicit, _) => implicit::run(case, pack, start, progress),
        (Method::AsPublished, Scheme::SubstepMarch) => {
            let (steps, gas_steps) = marching_steps(case, pack.n_rings());
            let set = substep_march::Settings {
                cycles: if s.cycles == 0 { 2 } else { s.cycles },
                steps,
                gas_steps,
                passes: s.passes,
                clamp: s.clamp,
            };
            let mut watch = Watch::new(pack);
            let outcome =
                substep_march::run(pack, set, start, (&mut record, &mut measures, &mut watch), progress);
            let (totals, steps) = outcome.map_err(at(pack))?;
            watch.carried(pack)?;
            let mut notes = watch.notes(pack);
            notes.extend(unsettled(
                totals.periodicity_error,
                s.periodicity.si(),
                set.cycles,
                start,
                "cycles",
            ));
            Ok(Found {
                liner: None,
                record: Recorded::Series(record),
                cycle: Cycle { totals, measures },
                period: 1,
                cycles: f64::from(set.cycles),
                counters: [("steps".to_owned(), steps)].into_iter().collect(),
                notes,
                retreats: watch.events(),
                seconds: begin.elapsed().as_secs_f64(),
            })
        }
        (Method::AsPublished, Scheme::DegreeMarch) => {
            let (steps, gas_steps) = marching_steps(case, pack.n_rings());
            let set = degree_march::Settings {
                cycles: s.cycles,
                max_cycles: s.max_cycles,
                steps,
                gas_steps,
                tolerance: s.periodicity.si(),
            };
            let mut watch = Watch::new(pack);
            let outcome =
                degree_march::run(pack, set, start, (&mut record, &mut measures, &mut watch), progress)
                    .map_err(at(pack))?;
            watch.carried(pack)?;
            let mut notes = watch.notes(pack);
            let change = outcome.totals.periodicity_error;
            let advice = if set.cycles > 0 { "cycles" } else { "max_cycles" };
            if outcome.period == 0 {
                notes.extend(unsettled(change, set.tolerance, outcome.cycles, start, advice));
            }
            Ok(Found {
                liner: None,
                record: Recorded::Series(record),
                cycle: Cycle { totals: outcome.totals, measures },
                period: outcome.period,
                cycles: f64::from(outcome.cycles),
                counters: [("steps".to_owned(), outcome.steps)].into_iter().collect(),
                notes,
                retreats: watch.events(),
                seconds: begin.elapsed().as_secs_f64(),
            })
        }
    }
}

/// Combinations that mean nothing, with the reason.
#[must_use]
pub fn legal(case: &RingPackCase) -> Vec<BuildError> {
    let mut errors = Vec::new();
    let s = &case.solver;
    if s.max_cycles == 0 {
        errors.push(BuildError::at("solver.max_cycles", "at least one cycle is needed"));
    }
    if s.tolerance.si() > 0.1 || s.tolerance.si() < 1e-12 {
        errors.push(BuildError::at("solver.tolerance", "the tolerance must be between 1e-12 and 0.1"));
    }
    let l = &s.limits;
    for (from, full, key) in [
        (l.drag_from.si(), l.drag_full.si(), "drag_full"),
        (l.drag_gap_from.si(), l.drag_gap_full.si(), "drag_gap_full"),
    ] {
        if from >= full {
            errors.push(BuildError::at(
                format!("solver.limits.{key}"),
                format!("the drag cannot count in full at {full} when it begins to count at {from}"),
            ));
        }
    }
    if s.method == Method::AsPublished {
        if case.models.oil_transport.follows_oil() {
            errors.push(
                BuildError::at(
                    "models.oil_transport",
                    "the published schemes have flooded faces and follow no oil",
                )
                .help("use `solver.method = \"implicit\"`, or `oil_transport = { model = \"off\" }`"),
            );
        }
        let name = case.models.ring_motion.typetag_name();
        let steps = u64::from(s.steps_per_degree.max(1)) * u64::from(s.gas_steps.max(1));
        if steps > 1_000_000 {
            errors.push(BuildError::at(
                "solver.gas_steps",
                format!("{steps} gas steps per degree would run for days"),
            ));
        }
        match s.scheme {
            Scheme::SubstepMarch => {
                if name == "three_seat" {
                    errors.push(
                        BuildError::at("solver.scheme", "`substep_march` integrates the ring's motion; `three_seat` decides seats by the degree")
                            .help("use `scheme = \"degree_march\"`, or `ring_motion` `newton_groove` or `seated`"),
                    );
                }
                if s.passes == 0 || s.passes > 7200 {
                    errors.push(
                        BuildError::at(
                            "solver.passes",
                            format!("{} one-degree passes do not make a cycle", s.passes),
                        )
                        .help("720, or 721 as the source's listing runs"),
                    );
                }
            }
            Scheme::DegreeMarch => {
                if !matches!(name, "three_seat" | "seated") {
                    errors.push(
                        BuildError::at("solver.scheme", format!("`degree_march` decides seats by the degree; `{name}` needs the ring's motion integrated"))
                            .help("use `scheme = \"substep_march\"`, or `ring_motion` `three_seat` or `seated`"),
                    );
                }
            }
        }
    }
    errors
}

/// Names of the states in the order of the state vector.
#[must_use]
pub fn state_names(pack: &Pack) -> Vec<String> {
    let mut names: Vec<String> = pack.layout.states.iter().map(|s| s.name.clone()).collect();
    for (i, r) in pack.rings.iter().enumerate() {
        if r.is_decided() {
            names.push(format!("seat of ring{} (decided in steps)", i + 1));
        }
    }
    names
}

/// How blow-by is metered.
#[must_use]
pub fn meter(case: &RingPackCase) -> Meter {
    let g = &case.gas;
    Meter {
        density: g.meter_pressure.si() / (g.gas_constant.si() * g.meter_temperature.si()),
        cylinders: f64::from(case.engine.cylinders),
    }
}
