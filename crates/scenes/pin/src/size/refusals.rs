//! Why there is no pin, in sentences.

use gudgeon_core::BuildError;
use gudgeon_pin::design::{BlockingLimit, Design, LengthBound};
use gudgeon_pin::optimum::NoOptimum;

use crate::case::{Method, PinCase};
use crate::setup::Setup;
use gudgeon_scene::RunError;

/// Limits that leave no pin of a diameter, as a sentence.
pub fn because(blocking: &[BlockingLimit]) -> String {
    let one = |b: &BlockingLimit| {
        let limit = b.limit.words();
        match b.length {
            None => format!("{limit} exceeds its limit at any length"),
            Some(LengthBound::AtLeast(l)) => format!("{limit} needs a length of {:.3} mm or more", 1e3 * l),
            Some(LengthBound::AtMost(l)) => {
                format!("{limit} allows {:.3} mm at most even of the thickest wall", 1e3 * l)
            }
        }
    };
    blocking.iter().map(one).collect::<Vec<_>>().join(", ")
}

/// Why no search can find a pin, known before one runs: every limit is easier to keep with a larger outer diameter, so the largest one
/// of the range decides; the published search keeps the outer diameter of its start.
pub fn impossible(case: &PinCase, s: &Setup) -> Option<BuildError> {
    let o = case.optimise.as_ref()?;
    let d = s.design();
    match (o.method, s.given) {
        (Method::Exact, _) => {
            let high = d.outer.high;
            let blocking = d.blocking_limits(high);
            if blocking.is_empty() && d.min_inner(high) <= d.max_inner(high) {
                return None;
            }
            let RunError::Refused(what) = no_optimum(&d, NoOptimum::Infeasible(blocking)) else {
                return None;
            };
            let help = "a wider range of the outer diameter, a smaller load or a larger limit";
            Some(BuildError::at("optimise.outer", what).help(help))
        }
        // It knows no ranges of the other dimensions.
        (Method::AsPublished, Some(start)) if o.length.is_none() && o.inner.is_none() => {
            let blocking = d.blocking_limits(start.outer);
            let what = format!(
                "no pin of {:.4} mm outer diameter keeps the limits: {}",
                1e3 * start.outer,
                because(&blocking)
            );
            (!blocking.is_empty())
                .then(|| BuildError::at("pin.outer", what).help("a larger outer diameter is needed"))
        }
        _ => None,
    }
}

/// The refusal of a run that found no optimum.
pub fn no_optimum(d: &Design<'_>, e: NoOptimum) -> RunError {
    RunError::Refused(match e {
        NoOptimum::Infeasible(f) if f.is_empty() => {
            format!("no pin of the ranges keeps the limits with a wall of {} mm", 1e3 * d.min_wall)
        }
        NoOptimum::Infeasible(f) => format!(
            "no pin of the ranges keeps the limits: with an outer diameter of {:.4} mm {}",
            1e3 * d.outer.high,
            because(&f)
        ),
        NoOptimum::Unproven(o) => format!(
            "the optimum could not be proved: stationarity {:.1e}, infeasibility {:.1e}, complementarity {:.1e}",
            o.kkt.stationarity, o.kkt.infeasibility, o.kkt.complementarity
        ),
        NoOptimum::Model(e) => e.to_string(),
    })
}
