use gudgeon_core::kinds::Contact;

/// Places over the range of a contact, and as many where the mean planes overlap.
const PLACES: i32 = 200;
/// Part of a value by which what should fall may rise: a model may read a table or polynomials in pieces.
const PIECES: f64 = 1e-8;

/// Complaints about a running contact model, at separations from minus to twice its range:
///
/// - a pressure that is negative or not finite, rises with the separation, is more than 1e-12 of that at zero separation beyond the range, or
///   depends on what else is asked at once;
/// - a mean gap that is negative, falls with the separation, or is not the separation beyond the range;
/// - a real area of contact that is negative or rises with the separation;
/// - a coefficient of friction or a floor that is negative or not finite.
#[must_use]
pub fn contact(model: &dyn Contact) -> Vec<String> {
    let mut wrong = constants(model);
    let range = model.range();
    if !(range >= 0.0 && range.is_finite()) {
        wrong.push(format!("the range is {range} m"));
        return wrong;
    }
    // A model without a range has no length of its own: a micrometre.
    let unit = if range > 0.0 { range } else { 1e-6 };
    let places: Vec<f64> = (-PLACES..=2 * PLACES).map(|k| unit * f64::from(k) / f64::from(PLACES)).collect();
    wrong.extend(pressures(model, &places, range));
    wrong.extend(gaps(model, &places, range));
    let mut area = vec![0.0; places.len()];
    if model.real_area(&places, &mut area) {
        wrong.extend(falls("real area", &places, &area));
    }
    wrong
}

fn constants(model: &dyn Contact) -> Vec<String> {
    let friction = ("coefficient of friction", Some(model.friction_coefficient()));
    [friction, ("floor", model.floor())]
        .into_iter()
        .filter_map(|(what, v)| Some((what, v.filter(|v| !(*v >= 0.0 && v.is_finite()))?)))
        .map(|(what, v)| format!("the {what} is {v}"))
        .collect()
}

fn pressures(model: &dyn Contact, places: &[f64], range: f64) -> Vec<String> {
    let mut all = vec![0.0; places.len()];
    model.pressure(places, &mut all);
    let mut wrong = falls("pressure", places, &all);
    for (s, p) in places.iter().zip(&all) {
        let mut alone = [0.0];
        model.pressure(&[*s], &mut alone);
        if alone[0].to_bits() != p.to_bits() {
            wrong.push(format!("the pressure at {s:e} m is {:e} alone and {p:e} among others", alone[0]));
        }
    }
    let mut touching = [0.0];
    model.pressure(&[0.0], &mut touching);
    let beyond = places.iter().zip(&all).find(|(s, p)| **s > range && **p > 1e-12 * touching[0]);
    wrong.extend(
        beyond.map(|(s, p)| format!("the pressure is {p:e} Pa at {s:e} m, beyond the range {range:e} m")),
    );
    wrong
}

fn gaps(model: &dyn Contact, places: &[f64], range: f64) -> Vec<String> {
    let gaps: Vec<f64> = places.iter().map(|s| model.mean_gap(*s)).collect();
    let mut wrong = Vec::new();
    // Smooth surfaces have no gap where they overlap, and no model is asked there.
    let rough = model.mean_gap(0.0) > 0.0;
    for k in 0..places.len() {
        let (s, gap) = (places[k], gaps[k]);
        if s < 0.0 && !rough {
            continue;
        }
        if !(gap >= 0.0 && gap.is_finite()) {
            wrong.push(format!("the mean gap at {s:e} m is {gap:e} m"));
        }
        if k > 0 && (rough || s > 0.0) && gap < gaps[k - 1] * (1.0 - PIECES) {
            wrong.push(format!("the mean gap falls to {gap:e} m at {s:e} m"));
        }
        // The range is where the pressure has faded, and the gap is then the separation to as many digits as matter to a film.
        if s > range && (gap / s - 1.0).abs() > 1e-3 {
            wrong.push(format!("the mean gap at {s:e} m, beyond the range, is {gap:e} m"));
        }
    }
    wrong
}

/// Complaints about what should be positive and fall with the separation.
fn falls(what: &str, places: &[f64], values: &[f64]) -> Vec<String> {
    let mut wrong = Vec::new();
    for k in 0..places.len() {
        let (s, v) = (places[k], values[k]);
        if !(v >= 0.0 && v.is_finite()) {
            wrong.push(format!("the {what} at {s:e} m is {v:e}"));
        }
        if k > 0 && v > values[k - 1] * (1.0 + PIECES) {
            wrong.push(format!("the {what} rises to {v:e} at {s:e} m"));
        }
    }
    wrong
}
