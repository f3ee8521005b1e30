//! The films by stroke: smallest gap of each side with its crank angle.

use std::f64::consts::PI;

use gudgeon_core::EvalError;
use gudgeon_core::result::{Column, Series};

use super::row::{Look, index};
use super::survey::{Survey, Which};

/// A row per stroke: for both sides the smallest gap and its crank angle.
///
/// # Errors
/// A gap that is none.
pub fn table(survey: &Survey, look: &mut Look<'_>) -> Result<Series, EvalError> {
    let strokes = (look.a.period / PI).round() as usize;
    let column = |name: String, unit: &str, values| Column { name, unit: unit.into(), values };
    let mut columns = Vec::new();
    for (side, name) in ["thrust", "anti_thrust"].into_iter().enumerate() {
        let gap = index(&format!("{name}.h_min"));
        let gaps = survey.values(|r| r[gap]);
        let mut at = |look: &mut Look<'_>, t: f64| Ok(look.gaps(t)?[side]);
        let (mut least, mut angles) = (Vec::new(), Vec::new());
        for stroke in 0..strokes {
            let window = (stroke as f64 * PI, (stroke + 1) as f64 * PI);
            let (h, t) = survey.extreme_of(look, Which::Min, window, &gaps, &mut at)?;
            least.push(h);
            angles.push(t.to_degrees());
        }
        columns.push(column(format!("{name}.h_min"), "m", least));
        columns.push(column(format!("{name}.h_min_angle"), "deg", angles));
    }
    let axis = column("stroke".into(), "1", (1..=strokes).map(|k| k as f64).collect());
    Ok(Series { axis, columns })
}
