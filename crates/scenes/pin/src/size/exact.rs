//! The exact optimum with its conditions and its certificate.

use gudgeon_core::kinds::{PinQuantity, PinSize};
use gudgeon_core::result::{Note, RunResult};
use gudgeon_pin::certificate::{Certificate, certify};
use gudgeon_pin::design::Design;
use gudgeon_pin::optimum::{Bound, Optimum, lightest};

use super::refusals::no_optimum;
use crate::case::Optimise;
use crate::output::result;
use crate::setup::Setup;
use gudgeon_scene::RunError;

/// Maximum number of boxes of a certificate.
const MAX_BOXES: u32 = 200_000;

/// The lightest pin of the ranges.
pub fn exact(d: &Design<'_>, s: &Setup, o: &Optimise, out: &mut RunResult) -> Result<PinSize, RunError> {
    let (best, certificate) = certified(d, s, o)?;
    out.solver.method = "exact".into();
    out.solver.counters.insert("quadratic_programs".into(), u64::from(best.iterations));
    out.solver.counters.insert("boxes_of_the_certificate".into(), u64::from(certificate.boxes));
    multipliers(d, &best, out);
    conditions(&best, &certificate, out);
    out.solver.notes.push(Note::info("optimum", held_by(&best, &certificate, o)));
    if let Some(g) = &s.given {
        beside_given(d, g, &best, out);
    }
    Ok(best.size)
}

/// The optimum and the certificate that no pin elsewhere is lighter.
fn certified(d: &Design<'_>, s: &Setup, o: &Optimise) -> Result<(Optimum, Certificate), RunError> {
    let mut best = lightest(d, s.given).or_else(|_| lightest(d, None)).map_err(|e| no_optimum(d, e))?;
    let mut certificate = certify(d, &best.size, o.certificate.si(), MAX_BOXES);
    // The conditions hold in every local optimum; the certificate knows of a lighter pin elsewhere.
    for _ in 0..4 {
        let Some(lighter) = certificate.lighter else { break };
        let Ok(other) = lightest(d, Some(lighter)) else { break };
        best = other;
        certificate = certify(d, &best.size, o.certificate.si(), MAX_BOXES);
    }
    Ok((best, certificate))
}

/// Residuals of the conditions, gap of the certificate.
fn conditions(best: &Optimum, certificate: &Certificate, out: &mut RunResult) {
    let kkt = best.kkt;
    let what = "gradient of mass and limits left at the optimum, relative";
    result(out, "stationarity", kkt.stationarity, "", what);
    result(out, "infeasibility", kkt.infeasibility.max(0.0), "", "what the worst limit is exceeded by");
    result(out, "complementarity", kkt.complementarity, "", "multiplier times slack, over the mass");
    if let Some(c) = kkt.curvature {
        result(out, "curvature", c, "", "smallest curvature of the mass along the limits, relative");
    }
    let gap = (certificate.best - certificate.bound).max(0.0) / best.masses.pin;
    let what = "no pin of the ranges is lighter by more than this part of the pin";
    result(out, "certificate_gap", gap, "", what);
    let what = "no pin of the ranges weighs less, less relief: proved by branch and bound";
    result(out, "mass_bound", 1e3 * certificate.bound, "g", what);
}

/// What holds the optimum, and what was proved of it, in two sentences.
fn held_by(best: &Optimum, certificate: &Certificate, o: &Optimise) -> String {
    let limits = best.active().into_iter().map(PinQuantity::words);
    let bounds = Bound::ALL.into_iter().filter(|b| best.bounds[*b as usize] > 0.0).map(Bound::words);
    let active: Vec<&str> = limits.chain(bounds).collect();
    let held = if active.is_empty() { "nothing".to_owned() } else { active.join(", ") };
    let certified = if certificate.closed {
        format!(
            "No pin of the ranges is lighter by more than {:.2e} of it ({} boxes).",
            o.certificate.si(),
            certificate.boxes
        )
    } else {
        format!(
            "That no other pin of the ranges is lighter was proved only to {:.2e} of it.",
            (certificate.best - certificate.bound) / best.masses.pin
        )
    };
    format!("The optimum is held by {held}. {certified}")
}

/// The given pin beside the optimum.
fn beside_given(d: &Design<'_>, given: &PinSize, best: &Optimum, out: &mut RunResult) {
    let excess = d.masses(given).differential() - best.masses.differential();
    let what = "mass, less relief, of the given pin above the optimum";
    result(out, "excess_of_given", 1e3 * excess, "g", what);
    if d.utilisation(given).is_ok_and(|u| u.iter().all(|u| *u <= 1.0 + 1e-9)) {
        out.solver.notes.push(Note::info(
            "given_pin",
            format!("The given pin keeps the limits too and is {:.2} g heavier.", 1e3 * excess),
        ));
    }
}

/// Multipliers of the limits, sensitivities of the mass.
fn multipliers(d: &Design<'_>, best: &Optimum, out: &mut RunResult) {
    for q in PinQuantity::ALL.into_iter().filter(|q| d.limits[*q as usize].is_finite()) {
        let m = best.multipliers[q as usize];
        result(
            out,
            format!("multiplier_{}", q.name()),
            10.0 * m,
            "g/%",
            format!("mass saved by one per cent more {}", q.words()),
        );
    }
    // Every quantity is proportional to the force, deformations to the reciprocal of the modulus.
    let all: f64 = best.multipliers.iter().sum();
    let soft: f64 =
        PinQuantity::ALL.iter().filter(|q| q.is_length()).map(|q| best.multipliers[*q as usize]).sum();
    result(out, "sensitivity_force", 10.0 * all, "g/%", "mass added by one per cent more force");
    // Zero, not minus zero, where no deformation binds.
    result(out, "sensitivity_modulus", 0.0 - 10.0 * soft, "g/%", "mass added by one per cent more modulus");
}
