//! What is wrong with a case by itself.

use std::f64::consts::PI;

use gudgeon_core::BuildError;
use gudgeon_skirt::CROWDING;

use super::case::PistonSecondaryCase;
use super::solver::check_tolerance;

/// Smallest and largest admitted intervals of a grid.
const INTERVALS: std::ops::RangeInclusive<u32> = 2..=1000;
/// Most maps of a cycle: each is as large as the grid of a side, and a page holds them all.
const MAX_MAPS: f64 = 20_000.0;

/// Radius of the skirt \[m\].
#[must_use]
pub fn radius(case: &PistonSecondaryCase) -> f64 {
    case.skirt.radius.map_or(0.5 * case.engine.bore.si() - case.skirt.clearance.si(), |r| r.si())
}

/// Radial clearance of the running engine \[m\].
#[must_use]
pub fn running_clearance(case: &PistonSecondaryCase, radius: f64) -> f64 {
    let cold = case.skirt.clearance.si();
    case.skirt.thermal.as_ref().map_or(cold, |t| {
        let grown = |expansion: f64, temperature: f64| expansion * (temperature - t.measured_at.si());
        cold + (radius + cold) * grown(t.bore_expansion.si(), t.bore.si())
            - radius * grown(t.skirt_expansion.si(), t.skirt.si())
    })
}

/// What is wrong with a case by itself.
pub fn legal(case: &PistonSecondaryCase) -> Vec<BuildError> {
    let mut errors = Vec::new();
    of_skirt(case, &mut errors);
    of_solver(case, &mut errors);
    of_outputs(case, &mut errors);
    errors.extend(case.solver.method.wrong(case.outputs.series_step.si()));
    errors
}

fn of_skirt(case: &PistonSecondaryCase, errors: &mut Vec<BuildError>) {
    let mut say = |place: &str, what: String| errors.push(BuildError::at(place, what));
    for (place, a) in [
        ("skirt.half_angle_thrust", Some(case.skirt.half_angle_thrust)),
        ("skirt.half_angle_anti_thrust", case.skirt.half_angle_anti_thrust),
    ] {
        if let Some(a) = a.filter(|a| a.si() >= 0.5 * PI) {
            say(place, format!("must be below 90 degrees, not {}", a.si().to_degrees()));
        }
    }
    if radius(case) <= 0.0 {
        say("skirt.clearance", "the clearance is larger than the bore".into());
    }
    let clearance = running_clearance(case, radius(case));
    if clearance.is_nan() || clearance <= 0.0 {
        say("skirt.thermal", format!("the running clearance is {:.3} um", 1e6 * clearance));
    }
    if case.gas.cavitation_pressure.is_some_and(|p| p.si() > case.gas.crankcase_pressure.si()) {
        let what = "films would cavitate above the pressure of the crankcase, which is that of their edges";
        say("gas.cavitation_pressure", what.into());
    }
}

fn of_solver(case: &PistonSecondaryCase, errors: &mut Vec<BuildError>) {
    let s = &case.solver;
    let mut say = |place: &str, what: String| errors.push(BuildError::at(place, what));
    for (place, n) in [
        ("solver.intervals_along", s.intervals_along),
        ("solver.intervals_across", s.intervals_across),
        ("solver.contact_intervals", s.contact_intervals),
    ] {
        if !INTERVALS.contains(&n) {
            say(place, format!("must be between {} and {}, not {n}", INTERVALS.start(), INTERVALS.end()));
        }
    }
    if !CROWDING.contains(&s.crowding.si()) {
        let what =
            format!("must be between {} and {}, not {}", CROWDING.start(), CROWDING.end(), s.crowding.si());
        say("solver.crowding", what);
    }
    if s.max_cycles == 0 {
        say("solver.max_cycles", "at least one cycle is needed".into());
    }
    if case.skirt.length.si() / s.contact_pitch.si() > 1e5 {
        say("solver.contact_pitch", "more than 100 000 rows of contact on the skirt".into());
    }
    errors.extend(check_tolerance("periodicity", s.periodicity.si()));
}

fn of_outputs(case: &PistonSecondaryCase, errors: &mut Vec<BuildError>) {
    let mut say = |place: &str, what: String| errors.push(BuildError::at(place, what));
    let rows = 4.0 * PI / case.outputs.series_step.si();
    if !(8.0..=1e6).contains(&rows) {
        say("outputs.series_step", format!("a series of {rows:.0} rows a cycle is none"));
    }
    let maps = case.outputs.map_step.map_or(0.0, |m| 4.0 * PI / m.si());
    if maps > MAX_MAPS {
        say("outputs.map_step", format!("{maps:.0} maps a cycle are more than {MAX_MAPS:.0}"));
    }
}
