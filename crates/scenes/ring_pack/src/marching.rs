//! What the published marching schemes share: steps, what they cannot do, how their cycle is told.

use gudgeon_core::result::Note;
use gudgeon_core::{BuildError, EvalError, Stopwatch};
use gudgeon_numerics::panel::TRAPEZIUM;
use gudgeon_scene::{MethodSetting, RunError};
use serde_json::Value;

use super::measure::Measures;
use super::pack::Pack;
use super::record::{Record, Totals};
use super::results::Cycle;
use super::solver::{NOT_PERIODIC, Recorded, Solution, Wanted};
use super::watch::Watch;

/// Steps of mechanics per crank degree, and of gas per step of mechanics.
pub type Steps = (u32, u32);

/// The given numbers, or those of the source where they are zero.
pub fn steps(given: Steps, own: Steps) -> Steps {
    let or = |given: u32, own: u32| if given == 0 { own } else { given };
    (or(given.0, own.0), or(given.1, own.1))
}

/// What no marching scheme can do.
pub fn refuses(pack: &Pack, given: Steps, own: Steps) -> Vec<BuildError> {
    let mut errors = Vec::new();
    if pack.oil_pack.is_some() {
        errors.push(
            BuildError::at(
                "models.oil_transport",
                "the published schemes have flooded faces and follow no oil",
            )
            .help("use `solver.method = \"implicit\"`, or `oil_transport = { model = \"off\" }`"),
        );
    }
    if let Some(state) = pack.layout.flank.iter().find(|own| !own.is_empty()) {
        let name = &pack.layout.states[state.start].name;
        let what = format!("the published schemes do not integrate the {name}");
        errors.push(
            BuildError::at("models.flank", what)
                .help("use `solver.method = \"implicit\"`, or a `flank` without volume, as `squeeze_film`"),
        );
    }
    if !pack.layout.temperature.is_empty() {
        let what = "the published schemes integrate no film temperature";
        errors
            .push(BuildError::at("models.film_temperature", what).help("use `solver.method = \"implicit\"`"));
    }
    let all = u64::from(given.0.max(1)) * u64::from(given.1.max(1));
    if all > 1_000_000 {
        let what = format!("{all} gas steps per degree would run for days");
        errors.push(BuildError::at("solver.gas_steps", what));
    }
    errors.extend(too_long(pack, steps(given, own)));
    errors
}

/// Gas steps that are longer than the gas model can be marched with.
fn too_long(pack: &Pack, (steps, gas_steps): Steps) -> Option<BuildError> {
    let mechanics = 1f64.to_radians() / pack.omega / f64::from(steps);
    let (own, longest) = (mechanics / f64::from(gas_steps), pack.gas.max_explicit_step()?);
    (own > longest).then(|| {
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

/// What a scheme writes while it marches.
pub struct Books {
    /// The series.
    pub record: Record,
    /// What results are made of.
    pub measures: Measures,
    /// What limits did.
    pub watch: Watch,
    seat: f64,
    begin: Stopwatch,
}

/// How a scheme ended.
pub struct Ended {
    /// Totals of the last cycle.
    pub totals: Totals,
    /// Marching steps.
    pub steps: u64,
    /// Cycles run.
    pub cycles: u32,
    /// Cycles after which the state repeats; 0 when none was seen.
    pub period: u32,
}

impl Books {
    /// Opens the books of a pack, whose friction changes over at a film floor at once, as in the sources.
    pub fn open(pack: &mut Pack, wanted: &Wanted<'_>) -> Self {
        pack.hard_floor = true;
        pack.follow_passages(false);
        Self {
            record: Record::new(pack, 0),
            measures: Measures::new(pack, TRAPEZIUM, wanted.seat),
            watch: Watch::new(pack),
            seat: wanted.seat,
            begin: Stopwatch::start(),
        }
    }

    /// The cycle that begins is the recorded one.
    pub fn begin_recorded(&mut self, pack: &mut Pack) {
        pack.follow_passages(true);
        self.measures = Measures::new(pack, TRAPEZIUM, self.seat);
        self.watch = Watch::new(pack);
    }

    /// Closes them.
    ///
    /// # Errors
    /// A sub-model refused, or a ring rests on next to nothing.
    pub fn close(
        self,
        pack: &Pack,
        ended: Result<Ended, EvalError>,
        unsettled: impl FnOnce(&Ended) -> Option<Note>,
    ) -> Result<Solution, RunError> {
        let theta_deg = pack.at.theta.to_degrees();
        let ended = ended.map_err(|source| RunError::Eval { theta_deg, source })?;
        self.watch.carried(pack)?;
        let mut notes = self.watch.notes(pack);
        notes.extend(unsettled(&ended));
        Ok(Solution {
            liner: None,
            record: Recorded::Series(self.record),
            cycle: Cycle { totals: ended.totals, measures: self.measures },
            period: ended.period,
            cycles: f64::from(ended.cycles),
            counters: [("steps".to_owned(), ended.steps)].into_iter().collect(),
            notes,
            retreats: self.watch.events(),
            seconds: self.begin.seconds(),
        })
    }
}

/// What to say of a marching scheme whose state changed by the part `change` over its last cycle.
pub fn unsettled(change: f64, tolerance: f64, cycles: u32, start: f64, advice: &str) -> Option<Note> {
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

/// A method whose steps per degree are refined: one, two, four and eight times those of the source. A case that has it keeps its gas steps.
pub fn refined(method: &str, own: u32, case: Option<&Value>, more: &[&str]) -> Vec<MethodSetting> {
    let gas = case.and_then(|c| c["gas_steps"].as_u64()).unwrap_or(0);
    let setting = |factor: u32| {
        let steps = own * factor;
        let mut set = vec![
            format!("solver.method={method}"),
            format!("solver.steps_per_degree={steps}"),
            format!("solver.gas_steps={gas}"),
        ];
        set.extend(more.iter().map(|s| (*s).to_owned()));
        MethodSetting {
            method: method.into(),
            setting: format!("{steps} steps per degree"),
            is_default: factor == 1 && case.is_some(),
            set,
            asked: None,
        }
    };
    [1, 2, 4, 8].map(setting).into()
}
