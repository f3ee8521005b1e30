//! The published search (`reimer1984`): raise the length, then reduce the bore, until no limit is exceeded.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{PinQuantity, PinSize};
use gudgeon_numerics::elementary;

use crate::design::Design;

/// Steps and arithmetic of the search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steps {
    /// Rise of the length \[m\].
    pub length: f64,
    /// Coarse reduction of the bore \[m\].
    pub coarse: f64,
    /// Fine reduction of the bore \[m\].
    pub fine: f64,
    /// Piston diameter that the length may not reach \[m\].
    pub bore: f64,
    /// Whether length and bore are accumulated with a mantissa of 32 bits, in millimetres, as the original computer did.
    pub mantissa_32: bool,
}

/// Phase of the search.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// Large steps of the bore.
    Coarse,
    /// Small steps of the bore.
    Fine,
}

/// How the search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// At a pin that keeps every limit.
    Found,
    /// The rod pressure exceeds its limit; no step changes it.
    RodPressure,
    /// The length reached the piston diameter.
    Length,
    /// The bore vanished while this limit was still exceeded.
    Bore(PinQuantity),
}

/// A search.
#[derive(Debug, Clone, PartialEq)]
pub struct Search {
    /// Where it ended \[m\].
    pub size: PinSize,
    /// How.
    pub end: End,
    /// Every exceeded limit it met, in order.
    pub trace: Vec<(Phase, PinQuantity)>,
    /// Evaluations of the limits.
    pub passes: u32,
    /// The bore was small enough from the start: the search stops one coarse step above it and its result is no optimum.
    pub bore_was_admitted: bool,
    /// The length was great enough from the start: it is never reduced, and the result may be too long.
    pub length_was_admitted: bool,
}

impl Search {
    /// How often a limit was met in a phase.
    #[must_use]
    pub fn count(&self, phase: Phase, q: PinQuantity) -> usize {
        self.trace.iter().filter(|t| **t == (phase, q)).count()
    }
}

/// Maximum number of passes: bounds a search whose steps are a nanometre.
const MAX_PASSES: u32 = 2_000_000;

/// Nearest number with a mantissa of 32 bits.
#[must_use]
pub fn with_mantissa_32(x: f64) -> f64 {
    if x == 0.0 || !x.is_finite() {
        return x;
    }
    let exponent = elementary::log2(x.abs()).floor() as i32 + 1;
    let unit = 2f64.powi(exponent - 32);
    if unit == 0.0 { x } else { (x / unit).round() * unit }
}

/// Searches from `start`.
///
/// The listing evaluates once more at a bore below zero before it gives up; here it gives up there.
///
/// # Errors
/// The model refused.
pub fn search(d: &Design<'_>, start: PinSize, steps: &Steps) -> Result<Search, EvalError> {
    let store = |mm: f64| if steps.mantissa_32 { with_mantissa_32(mm) } else { mm };
    // In millimetres, as the program counts.
    let (mut length, mut inner) = (store(1e3 * start.length), store(1e3 * start.inner));
    let [up, coarse, fine] = [steps.length, steps.coarse, steps.fine].map(|s| store(1e3 * s));
    let mut out = Search {
        size: start,
        end: End::Found,
        trace: Vec::new(),
        passes: 0,
        bore_was_admitted: false,
        length_was_admitted: true,
    };
    let mut phase = Phase::Coarse;
    let mut reduced = false;
    loop {
        out.passes += 1;
        if out.passes > MAX_PASSES {
            return Err(EvalError::fatal("as_published", "the steps are too small: the search does not end"));
        }
        out.size = PinSize { length: 1e-3 * length, outer: start.outer, inner: 1e-3 * inner };
        let u = d.utilisation(&out.size)?;
        let Some(q) = PinQuantity::ALL.into_iter().find(|q| u[*q as usize] > 1.0) else {
            if phase == Phase::Fine {
                return Ok(out);
            }
            out.bore_was_admitted = !reduced;
            phase = Phase::Fine;
            inner = store(inner + coarse);
            if 1e-3 * inner >= start.outer {
                // A bore within a coarse step of the outer diameter: there is no wall to look at.
                inner = store(inner - coarse);
                phase = Phase::Fine;
            }
            continue;
        };
        out.trace.push((phase, q));
        match q {
            PinQuantity::BossPressure => {
                out.length_was_admitted = false;
                length = store(length + up);
                if 1e-3 * length >= steps.bore {
                    out.end = End::Length;
                    return Ok(out);
                }
            }
            PinQuantity::RodPressure => {
                out.end = End::RodPressure;
                return Ok(out);
            }
            _ => {
                reduced = true;
                inner = store(inner - if phase == Phase::Coarse { coarse } else { fine });
                if inner < 0.0 {
                    out.end = End::Bore(q);
                    return Ok(out);
                }
            }
        }
    }
}
