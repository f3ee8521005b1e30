//! A pin as it stands: dimensions, masses, quantities, loads, fatigue over the cycle.

use gudgeon_core::kinds::{PIN_QUANTITIES, PinInstant, PinQuantity, PinSize};
use gudgeon_core::result::{Note, RunResult, Series, VERDICT};
use gudgeon_pin::design::Design;
use gudgeon_pin::piston::mass_estimate;

use crate::case::PinCase;
use crate::output::{column, model, result};
use crate::setup::Setup;
use gudgeon_scene::RunError;

/// A force of the source's units is of no use to anyone: newtons, millimetres, megapascals, grams.
pub fn loads(case: &PinCase, s: &Setup, out: &mut RunResult) {
    let l = &s.load;
    let f = l.design.forces;
    result(out, "peak_pressure", 1e-6 * l.design.pressure, "MPa", "cylinder pressure of the design load");
    result(out, "gas_force", f.gas, "N", "gas force of the design load");
    result(out, "inertia_force", f.inertia, "N", "inertia force of the design load");
    result(out, "pin_force", f.total(), "N", "force on the pin");
    if let Some(ratio) = l.crank_ratio {
        result(out, "crank_ratio", ratio, "", "crank radius over rod length");
    }
    if !l.cycle.is_empty() {
        let angle = l.design.theta.to_degrees();
        result(out, "design_angle", angle, "deg", "crank angle of the greatest force on the pin");
    }
    let mass = mass_estimate(case.piston.apparent_density(), s.bore);
    result(out, "piston_mass_estimate", 1e3 * mass, "g", "apparent density times the cube of the diameter");
}

/// Unit and factor in which results give a quantity.
fn unit(q: PinQuantity) -> (&'static str, f64) {
    if q.is_length() { ("mm", 1e3) } else { ("MPa", 1e-6) }
}

/// What is made least, with flats on the piston.
const LESS_RELIEF: &str = "mass of the pin less that of the flats cut from the piston: what is made least, below zero where the flats weigh more";

/// Results of a pin: dimensions, masses, quantities, utilisations.
pub fn evaluate(
    case: &PinCase,
    s: &Setup,
    d: &Design<'_>,
    size: &PinSize,
    out: &mut RunResult,
) -> Result<(), RunError> {
    let q = d.strength.quantities(size, &d.load).map_err(model)?;
    let u = d.utilisation(size).map_err(model)?;
    result(out, "length", 1e3 * size.length, "mm", "length of the pin");
    result(out, "outer", 1e3 * size.outer, "mm", "outer diameter");
    result(out, "inner", 1e3 * size.inner, "mm", "inner diameter");
    let m = d.masses(size);
    result(out, "pin_mass", 1e3 * m.pin, "g", "mass of the pin");
    if s.relief.is_some() {
        result(out, "relieved_mass", 1e3 * m.relieved, "g", "mass of the flats cut from the piston");
        result(out, "mass_differential", 1e3 * m.differential(), "g", LESS_RELIEF);
    }
    let j = s.pi * (size.outer.powi(4) - size.inner.powi(4)) / 64.0;
    result(out, "second_moment", 1e12 * j, "mm4", "second moment of area");
    result(out, "section_modulus", 1e9 * 2.0 * j / size.outer, "mm3", "section modulus");
    let (offset, slope) = case.pin.as_ref().map_or((0.0, 0.0), |p| p.boss_bore.centres(s.boss_gap));
    let centres = offset + slope * size.length;
    result(out, "pressure_centres", 1e3 * centres, "mm", "distance of the pressure centres of the bosses");
    for k in PinQuantity::ALL {
        let (unit, factor) = unit(k);
        result(out, k.name(), factor * q[k as usize], unit, k.words());
    }
    utilisations(d, &u, out);
    Ok(())
}

/// Utilisation of every limit and the maximum of them; a caution where limits are exceeded.
fn utilisations(d: &Design<'_>, u: &[f64; PIN_QUANTITIES], out: &mut RunResult) {
    let mut max: Option<(f64, PinQuantity)> = None;
    for k in PinQuantity::ALL.into_iter().filter(|k| d.limits[*k as usize].is_finite()) {
        let v = u[k as usize];
        result(out, format!("utilisation_{}", k.name()), v, "", format!("{} over its limit", k.words()));
        if max.is_none_or(|(m, _)| v > m) {
            max = Some((v, k));
        }
    }
    let Some((v, k)) = max else { return };
    result(out, "utilisation", v, "", format!("greatest utilisation of a limit: {}", k.words()));
    if v <= 1.0 + 1e-9 {
        let all = d.limits.iter().filter(|l| l.is_finite()).count();
        let text =
            format!("all {all} limits are kept: the pin uses {:.1} % of that on {}", 100.0 * v, k.words());
        out.solver.notes.push(Note::info(VERDICT, text));
        return;
    }
    let over: Vec<&str> = PinQuantity::ALL
        .into_iter()
        .filter(|q| d.limits[*q as usize].is_finite() && u[*q as usize] > 1.0 + 1e-9)
        .map(PinQuantity::words)
        .collect();
    out.solver.notes.push(Note::exceeded(
        "pin_beyond_limits",
        format!(
            "The pin exceeds {}: {}; the most, {}, by {:.3} %.",
            if over.len() == 1 { "a limit" } else { "limits" },
            over.join(", "),
            k.words(),
            100.0 * (v - 1.0)
        ),
    ));
}

/// Forces and stress over the cycle, and fatigue.
pub fn cycle(
    case: &PinCase,
    s: &Setup,
    d: &Design<'_>,
    size: &PinSize,
    out: &mut RunResult,
) -> Result<(), RunError> {
    let q = d.strength.quantities(size, &d.load).map_err(model)?;
    let full = q[PinQuantity::ResultantStress as usize];
    let design = d.load.total();
    // Every stress is proportional to the force and changes its sign with it.
    let stress: Vec<f64> = s.load.cycle.iter().map(|i| full * i.forces.total() / design.abs()).collect();
    if !s.fatigue.is_off() {
        fatigue(case, s, &stress, full * design.signum(), out)?;
    }
    if stress.is_empty() {
        return Ok(());
    }
    let c = &s.load.cycle;
    let of = |f: &dyn Fn(&PinInstant) -> f64| c.iter().map(f).collect();
    out.series = Series::over_cycle(
        of(&|i| i.theta.to_degrees()),
        vec![
            column("cylinder.pressure", "Pa", of(&|i| i.pressure)),
            column("pin.gas_force", "N", of(&|i| i.forces.gas)),
            column("pin.inertia_force", "N", of(&|i| i.forces.inertia)),
            column("pin.force", "N", of(&|i| i.forces.total())),
            column("pin.resultant_stress", "Pa", stress),
        ],
    );
    Ok(())
}

/// Safety against fatigue of a stress over the cycle; `at_design` is the stress under the design load.
fn fatigue(
    case: &PinCase,
    s: &Setup,
    stress: &[f64],
    at_design: f64,
    out: &mut RunResult,
) -> Result<(), RunError> {
    // One instant known: the stress comes and goes.
    let ends = stress.iter().copied().chain([at_design]);
    let (mut low, mut high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
    if stress.is_empty() {
        (low, high) = (low.min(0.0), high.max(0.0));
    }
    if case.pin.as_ref().is_some_and(|p| p.turns) {
        high = high.abs().max(low.abs());
        low = -high;
    }
    let (mean, amplitude) = (0.5 * (high + low), 0.5 * (high - low));
    // Beside the fibre in tension lies one in compression: the mean counts with either sign.
    let safety = s.fatigue.safety(mean.abs(), amplitude).map_err(model)?;
    result(out, "fatigue_mean", 1e-6 * mean.abs(), "MPa", "mean of the resultant stress over the cycle");
    result(out, "fatigue_amplitude", 1e-6 * amplitude, "MPa", "its amplitude");
    result(out, "fatigue_safety", safety, "", "safety against fatigue");
    if safety < 1.0 {
        out.solver.notes.push(Note::caution("fatigue", format!(
            "The pin keeps its limits perhaps, but not for ever: the safety against fatigue is {safety:.2}."
        )));
    }
    Ok(())
}
