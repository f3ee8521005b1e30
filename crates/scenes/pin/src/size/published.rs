//! The published search, beside the exact optimum.

use gudgeon_core::kinds::{PinQuantity, PinSize};
use gudgeon_core::result::{Note, RunResult, Series};
use gudgeon_pin::design::{Design, Range};
use gudgeon_pin::optimum::lightest;
use gudgeon_pin::stepper::{End, Phase, Search, Steps, search};

use super::refusals::because;
use crate::case::{Arithmetic, Optimise};
use crate::output::{column, model, result};
use crate::setup::Setup;
use gudgeon_scene::RunError;

/// Steps of the search in SI.
pub fn steps(s: &Setup, o: &Optimise) -> Steps {
    Steps {
        length: o.steps.length.si(),
        coarse: o.steps.coarse.si(),
        fine: o.steps.fine.si(),
        bore: s.bore,
        mantissa_32: o.steps.arithmetic == Arithmetic::Mantissa32,
    }
}

/// The pin at which the published search from `start` ends.
pub fn published(
    d: &Design<'_>,
    s: &Setup,
    start: PinSize,
    o: &Optimise,
    out: &mut RunResult,
) -> Result<PinSize, RunError> {
    let found = search(d, start, &steps(s, o)).map_err(model)?;
    if let Some(why) = failure(found.end) {
        return Err(RunError::Refused(no_pin(d, &start, found.end, &why)));
    }
    out.solver.method = "as published".into();
    out.solver.counters.insert("passes".into(), u64::from(found.passes));
    trace(d, &found, out);
    starts(&found, out);
    beside_exact(d, &start, &found, out);
    Ok(found.size)
}

/// Why a search ended without a pin; `None` when it found one.
fn failure(end: End) -> Option<String> {
    match end {
        End::Found => None,
        End::RodPressure => Some("rod pressure exceeds its limit, which no step changes".to_owned()),
        End::Length => Some("the length reached the piston diameter".to_owned()),
        End::Bore(q) => Some(format!("the bore vanished while {} still exceeded its limit", q.words())),
    }
}

/// The refusal of a search that ended without a pin.
fn no_pin(d: &Design<'_>, start: &PinSize, end: End, why: &str) -> String {
    let blocking = because(&d.blocking_limits(start.outer));
    // Nothing forbids such a pin: the search went past it.
    let advice = if matches!(end, End::Bore(_)) && blocking.is_empty() {
        "no limit forbids such a pin: start from a shorter one, for the search never shortens it, or take smaller steps"
    } else {
        "a larger outer diameter is needed"
    };
    let also =
        if blocking.is_empty() { String::new() } else { format!(" No search could do better: {blocking}.") };
    format!(
        "the published search ends without a pin of {:.4} mm outer diameter: {why}; {advice}.{also}",
        1e3 * start.outer
    )
}

/// Whether the start was admitted already: the result is no optimum then.
fn starts(found: &Search, out: &mut RunResult) {
    result(
        out,
        "start_bore_admitted",
        f64::from(u8::from(found.bore_was_admitted)),
        "",
        "1: the bore of the start kept the limits, the result is no optimum",
    );
    result(
        out,
        "start_length_admitted",
        f64::from(u8::from(found.length_was_admitted)),
        "",
        "1: the length of the start was never raised, the result may be too long",
    );
    if found.bore_was_admitted {
        out.solver.notes.push(Note::caution("not_an_optimum.bore", "The search started from a bore that keeps the limits already: it only stops one coarse step above it. This is no optimum."));
    }
    if found.length_was_admitted {
        out.solver.notes.push(Note::caution("not_an_optimum.length", "The search started from a length that is great enough already and never reduces it. This is no optimum."));
    }
}

/// The result of the search beside the exact optima of the same outer diameter and of all dimensions.
fn beside_exact(d: &Design<'_>, start: &PinSize, found: &Search, out: &mut RunResult) {
    let mut here = *d;
    here.outer = Range::at(start.outer);
    let free = lightest(d, None).ok();
    let same = lightest(&here, None).ok();
    let mine = d.masses(&found.size).differential();
    if let Some(o) = same {
        result(
            out,
            "excess_here",
            1e3 * (mine - o.masses.differential()),
            "g",
            "mass, less relief, above the exact optimum of the same outer diameter",
        );
    }
    if let Some(o) = free {
        let excess = mine - o.masses.differential();
        result(
            out,
            "excess",
            1e3 * excess,
            "g",
            "mass, less relief, above the exact optimum of all dimensions",
        );
        out.solver.notes.push(Note::info("exact_optimum", format!(
            "The exact optimum of all dimensions is {:.2} g lighter: length {:.3} mm, outer diameter {:.3} mm, inner diameter {:.3} mm.",
            1e3 * excess,
            1e3 * o.size.length,
            1e3 * o.size.outer,
            1e3 * o.size.inner
        )));
    }
}

/// Counts of the messages that the program prints, by phase.
fn trace(d: &Design<'_>, found: &Search, out: &mut RunResult) {
    for (phase, name) in [(Phase::Coarse, "coarse"), (Phase::Fine, "fine")] {
        for q in PinQuantity::ALL.into_iter().filter(|q| d.limits[*q as usize].is_finite()) {
            let n = found.count(phase, q) as f64;
            let what = format!("{name} steps that {} asked for", q.words());
            result(out, format!("{name}_{}", q.name()), n, "", what);
        }
    }
    let order = (1..=found.trace.len()).map(|k| k as f64).collect();
    let of = |f: &dyn Fn(&(Phase, PinQuantity)) -> f64| found.trace.iter().map(f).collect();
    out.tables.insert(
        "trace".into(),
        Series {
            axis: column("pass", "", order),
            columns: vec![
                column("limit", "", of(&|t| f64::from(t.1 as u8) + 1.0)),
                column("fine", "", of(&|t| f64::from(u8::from(t.0 == Phase::Fine)))),
            ],
        },
    );
}
