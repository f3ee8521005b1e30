use gudgeon_core::kinds::{PIN_QUANTITIES, PinForces, PinQuantity, PinSize, PinStrength, resultant_stress};

use crate::differences::{Tolerance, partials};

/// Complaints about a running model of pin strength, at the pin `size` under `load`:
///
/// - values of [`PinStrength::expansion`] that are not those of [`PinStrength::quantities`], gradients and second derivatives that difference
///   quotients over 1e-5 of each dimension do not show within `tolerance`;
/// - what a solver relies on ([`PinStrength`]): which quantity may rise with which dimension, and what the resultant is, over pins up to a fifth
///   larger and smaller in each dimension;
/// - a pin without a wall that is not refused.
///
/// A refusal of `size` is a complaint too.
#[must_use]
pub fn pin_strength(
    model: &dyn PinStrength,
    size: &PinSize,
    load: &PinForces,
    tolerance: Tolerance,
) -> Vec<String> {
    let (Ok(value), Ok(e)) = (model.quantities(size, load), model.expansion(size, load)) else {
        return vec![format!("{size:?} is refused")];
    };
    let mut wrong = Vec::new();
    if value.iter().any(|v| !v.is_finite()) {
        wrong.push(format!("not finite: {value:?}"));
    }
    if value.iter().zip(e.value).any(|(a, b)| (a - b).abs() > 1e-12 * a.abs()) {
        wrong.push(format!("the expansion is about {:?}, the quantities are {value:?}", e.value));
    }
    let x = [size.length, size.outer, size.inner];
    let of = |x: &[f64]| PinSize { length: x[0], outer: x[1], inner: x[2] };
    let step = x.map(|x| 1e-5 * x);
    let first = |x: &[f64], out: &mut [f64]| match model.quantities(&of(x), load) {
        Ok(v) => out.copy_from_slice(&v),
        Err(_) => out.fill(f64::NAN),
    };
    wrong.extend(partials(first, &x, &step, e.gradient.as_flattened(), tolerance));
    let second = |x: &[f64], out: &mut [f64]| match model.expansion(&of(x), load) {
        Ok(e) => out.copy_from_slice(e.gradient.as_flattened()),
        Err(_) => out.fill(f64::NAN),
    };
    let [ll, lo, li, oo, oi, ii] = [0, 1, 2, 3, 4, 5];
    let hessian: Vec<f64> =
        e.hessian.iter().flat_map(|h| [ll, lo, li, lo, oo, oi, li, oi, ii].map(|k: usize| h[k])).collect();
    wrong.extend(partials(second, &x, &step, &hessian, tolerance));
    wrong.extend(monotone(model, size, load, &value));
    if model.quantities(&PinSize { inner: size.outer, ..*size }, load).is_ok() {
        wrong.push("a pin without a wall is not refused".into());
    }
    wrong
}

/// Whether a quantity may rise with the length.
fn rises_with_length(q: PinQuantity) -> bool {
    matches!(q, PinQuantity::Deflection | PinQuantity::BendingStress)
}

fn monotone(
    model: &dyn PinStrength,
    size: &PinSize,
    load: &PinForces,
    value: &[f64; PIN_QUANTITIES],
) -> Vec<String> {
    let mut wrong = Vec::new();
    // Roundings of a formula of some ten operations.
    let above = |a: f64, b: f64| a > b * (1.0 + 1e-13);
    for part in [0.8, 0.9, 0.99, 1.01, 1.1, 1.2] {
        let larger = part > 1.0;
        let pins = [
            ("length", PinSize { length: part * size.length, ..*size }),
            ("outer", PinSize { outer: part * size.outer, ..*size }),
            ("inner", PinSize { inner: part * size.inner, ..*size }),
        ];
        for (what, pin) in pins {
            // A pin may lie outside the theory.
            let Ok(v) = model.quantities(&pin, load) else { continue };
            for q in PinQuantity::ALL {
                let (own, other) = (value[q as usize], v[q as usize]);
                let rises = if larger { above(other, own) } else { above(own, other) };
                let falls = if larger { above(own, other) } else { above(other, own) };
                let broken = match what {
                    "length" if q == PinQuantity::ResultantStress => false,
                    "length" if rises_with_length(q) => falls,
                    "length" | "outer" => rises,
                    _ => falls,
                };
                if broken {
                    wrong.push(format!(
                        "the {} goes the wrong way with the dimension `{what}`: {own:e}, {other:e}",
                        q.words()
                    ));
                }
            }
            let [b, o, r] =
                [PinQuantity::BendingStress, PinQuantity::OvalisationStress, PinQuantity::ResultantStress]
                    .map(|q| v[q as usize]);
            if (r - resultant_stress(b, o)).abs() > 1e-12 * r {
                wrong.push(format!("the resultant stress is {r:e} Pa of {b:e} and {o:e} Pa"));
            }
        }
    }
    wrong
}
