//! What `bench` races on a shaft line: the vibration at the mean speed by the model of the case, and by those that solve the same equations.

use std::f64::consts::TAU;

use gudgeon_core::kinds::{NaturalFrequenciesSpec, TorsionAnswer, TorsionSpec};
use gudgeon_numerics::elementary;
use gudgeon_scene::{OtherMethod, Reference, WorkPrecision};
use gudgeon_torsion::natural_frequencies::Eigenvalues;

use super::assemble::Assembled;
use super::case::ShaftLineCase;

/// What is left of a start that is not periodic when a motion over time is looked at.
const LEFT: f64 = 1e-7;
/// Most periods of a motion over time; lines that are damped so little are not followed.
const PERIODS: f64 = 3000.0;
/// Instants a period at which extremes are looked for: at order 100 the top between two of them is missed by 1e-4 of its part.
const INSTANTS: f64 = 20_000.0;
/// Tolerance of a reference over time, and of the coarser one that tells how far it can be trusted.
const TIGHT: [f64; 2] = [1e-9, 1e-8];

/// Methods and reference for diagrams of run time against error.
pub fn work_precision(case: &ShaftLineCase, a: &Assembled) -> WorkPrecision {
    let torsion = &case.models.torsion;
    let over_time = motion(case, a);
    let methods: Vec<(Way, OtherMethod)> =
        torsion.same_equations().iter().filter_map(|model| other(model, over_time.as_ref())).collect();
    let reference = methods.iter().find_map(|(way, m)| match way {
        Way::OverTime => over_time.as_ref().map(|t| reference(&m.label, t)),
        Way::Periodic => None,
    });
    WorkPrecision {
        reference,
        own: torsion.typetag_name().into(),
        others: methods.into_iter().map(|(_, m)| m).collect(),
        all: response_alone(case),
        // A motion over time knows no orders.
        idle: if torsion.answers() == TorsionAnswer::Time { vec!["orders"] } else { Vec::new() },
        results: results(a),
        ..WorkPrecision::default()
    }
}

/// How a model answers.
enum Way {
    Periodic,
    OverTime,
}

/// A registered model in place of that of the case; none where the line does not allow it.
fn other(model: &str, over_time: Option<&Motion>) -> Option<(Way, OtherMethod)> {
    let spec: Box<dyn TorsionSpec> = gudgeon_core::spec::plain_model(model).ok()?;
    let mut set = vec![format!("models.torsion.model={model}")];
    let way = match spec.answers() {
        TorsionAnswer::Nothing => return None,
        TorsionAnswer::Periodic => Way::Periodic,
        TorsionAnswer::Time => {
            set.push(over_time?.table(1.0));
            Way::OverTime
        }
    };
    Some((way, OtherMethod { label: model.into(), set }))
}

/// The motion over time at tight tolerances; half as long it tells what is left of its start.
fn reference(model: &str, motion: &Motion) -> Reference {
    let at = |tolerance: f64, share: f64| {
        let own = format!("models.torsion={{ model = \"{model}\", tolerance = {tolerance:e} }}");
        vec![own, motion.table(share)]
    };
    Reference {
        set: at(TIGHT[0], 1.0),
        check: at(TIGHT[1], 0.5),
        is: format!(
            "`{model}`, {:.3} s from the motion of `orders` at the held mean speed, tolerance {:.0e}; differs from half that time at {:.0e}",
            motion.duration, TIGHT[0], TIGHT[1]
        ),
        independent: true,
        told_as: Vec::new(),
    }
}

/// A motion over time that ends in the periodic one.
struct Motion {
    /// Its length \[s\], whole periods.
    duration: f64,
    /// A period \[s\].
    period: f64,
}

impl Motion {
    /// The table `time`, for a part of the whole length.
    fn table(&self, share: f64) -> String {
        let duration = (share * self.duration / self.period).ceil() * self.period;
        format!(
            "time={{ duration = \"{duration} s\", interval = \"{} s\", window = \"{} s\", window_interval = \"{} s\", start_steady = true, hold_speed = true }}",
            self.period,
            self.period,
            self.period / INSTANTS
        )
    }
}

/// How long the line takes to forget its start; none where it hardly does.
fn motion(case: &ShaftLineCase, a: &Assembled) -> Option<Motion> {
    let modes = Eigenvalues::default().build(&a.line).ok()?.modes().ok()?;
    let slowest = modes.iter().filter_map(|m| m.damped).map(|(decay, _)| decay).reduce(f64::min)?;
    let period = a.period.max(TAU) / case.speed.si();
    let periods = (-elementary::ln(LEFT) / (slowest * period)).ceil();
    (slowest > 0.0 && periods <= PERIODS).then_some(Motion { duration: periods * period, period })
}

/// Changes that leave nothing but the vibration at the mean speed.
fn response_alone(case: &ShaftLineCase) -> Vec<String> {
    let mut set =
        vec![r#"outputs.groups=["response"]"#.to_owned(), "limits={}".into(), "load_steps=[]".into()];
    if case.operating.is_some() {
        let speed = case.speed.si();
        set.push(format!("operating={{ from = {speed:e}, to = {speed:e} }}"));
    }
    set
}

/// Torque and speed at both ends of the line: its last inertia feels the high orders most.
fn results(a: &Assembled) -> Vec<String> {
    let ends = |n: usize| if n > 1 { vec![1, n] } else { vec![1] };
    let torque = ends(a.line.links.len()).into_iter().map(|k| format!("shaft{k}.torque_amplitude"));
    let speed = ends(a.line.nodes.len()).into_iter().map(|k| format!("inertia{k}.speed_swing"));
    torque.chain(speed).collect()
}
