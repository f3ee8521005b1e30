//! Names of the results that a case can have, known before it runs.
//!
//! Which of them a run gives may depend on what it finds (a critical speed lies in the range or not): these are all that can be.

use std::f64::consts::PI;

use gudgeon_core::kinds::TorsionAnswer;

use super::assemble::Assembled;
use super::case::ShaftLineCase;
use super::plan::Plan;

/// Orders of a shaft's torque that are results.
pub const ORDERS: usize = 12;

/// All names of a case. `excited` are the orders that something excites.
pub fn names(case: &ShaftLineCase, plan: &Plan, a: &Assembled, excited: &[f64]) -> Vec<String> {
    let line = &a.line;
    let mut all = Names::default();
    if plan.throws {
        let of =
            ["mean_inertia", "mean_torque", "torque_max", "torque_min", "work", "power", "p_min", "p_max"];
        all.each("throw", line.throws.len(), &of);
    }
    if plan.frequencies {
        frequencies(&mut all, case, a);
    }
    let answers = case.models.torsion.answers();
    if plan.response && answers == TorsionAnswer::Periodic {
        periodic(&mut all, case, a, excited);
    }
    if plan.response && answers == TorsionAnswer::Time {
        over_time(&mut all, a);
    }
    if plan.range {
        all.each("range.shaft", line.links.len(), &["torque_amplitude"]);
        all.plain(&["range.worst_speed", "strongest_critical_speed"]);
    }
    if plan.verdict {
        all.plain(&["limits_broken", "worst_utilisation"]);
        let of = ["torque_amplitude", "stress_amplitude", "speed", "order", "load_step", "heat"];
        all.each("envelope.shaft", line.links.len(), &of);
        all.each("envelope.inertia", line.nodes.len(), &["irregularity"]);
    }
    all.0
}

fn frequencies(all: &mut Names, case: &ShaftLineCase, a: &Assembled) {
    let modes = a.line.nodes.len();
    all.plain(&["rigid_modes", "holzer_residual", "critical_speeds", "nearest_critical_speed"]);
    all.plain(&["distance_to_critical", "stable_step"]);
    if !case.models.natural_frequencies.are_of_the_line() {
        all.each("published.", modes, &["frequency", "omega"]);
    }
    all.each("mode.", modes, &["frequency", "omega", "damping_ratio", "decay", "damped_frequency", "nodes"]);
    let step = 2.0 * PI / a.period;
    let most = (case.range.interference_orders.si() / step + 1e-9).floor() as usize;
    for k in 1..=most {
        let order = k as f64 * step;
        all.0.extend((1..=modes).map(|m| format!("critical_speed.mode{m}.order{order}")));
    }
}

fn periodic(all: &mut Names, case: &ShaftLineCase, a: &Assembled, excited: &[f64]) {
    let links = a.line.links.len();
    all.plain(&["balance_torque"]);
    let of = [
        "mean_torque",
        "torque_max",
        "torque_min",
        "torque_amplitude",
        "strongest_order",
        "stiffness",
        "damping",
        "heat",
        "stress_amplitude",
        "stress_max",
    ];
    all.each("shaft", links, &of);
    all.each("inertia", a.line.nodes.len(), &["speed_swing", "irregularity", "angle_amplitude"]);
    let step = 2.0 * PI / a.period;
    let whole = (1..=ORDERS).map(|k| k as f64 * step).filter(|o| *o <= case.range.orders.si() + 1e-9);
    let mut orders: Vec<f64> = excited.iter().copied().take(ORDERS).chain(whole).collect();
    orders.sort_by(f64::total_cmp);
    orders.dedup();
    for o in orders {
        all.0.extend((1..=links).map(|l| format!("shaft{l}.order{o}")));
    }
}

fn over_time(all: &mut Names, a: &Assembled) {
    let line = &a.line;
    all.plain(&["time", "mean_speed", "window", "turns", "cycle_time", "acceleration", "most_swing"]);
    let of = ["speed_swing", "speed_end", "angle_end", "settled_5", "settled_1", "speed_max", "speed_min"];
    all.each("inertia", line.nodes.len(), &of);
    let of = ["torque_amplitude", "torque_peak", "twist_peak", "stress_peak", "heat", "stiffness", "damping"];
    all.each("shaft", line.links.len(), &of);
    all.each("throw", line.throws.len(), &["lag", "gas_max", "gas_min"]);
    all.each("drive", line.drives.len(), &["torque", "torque_end"]);
}

#[derive(Default)]
struct Names(Vec<String>);

impl Names {
    fn plain(&mut self, names: &[&str]) {
        self.0.extend(names.iter().map(|n| (*n).to_owned()));
    }

    /// `throw1.work`, `throw2.work`, …
    fn each(&mut self, what: &str, count: usize, of: &[&str]) {
        for k in 1..=count {
            self.0.extend(of.iter().map(|n| format!("{what}{k}.{n}")));
        }
    }
}
