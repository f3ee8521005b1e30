//! Drawings of the report: section of pin and bosses, utilisation bars, design map, skirt. Coordinates in millimetres.

mod map;
mod section;
mod shapes;
mod skirt;

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{PIN_QUANTITIES, PinQuantity, PinSize};
use gudgeon_core::result::{Bar, FigureKind, RunResult};
use gudgeon_pin::design::Design;

pub use map::map;
pub use section::section;
pub use skirt::skirt;

/// Bars of all limits.
pub fn utilisation(d: &Design<'_>, size: &PinSize, out: &mut RunResult) -> Result<(), EvalError> {
    let u: [f64; PIN_QUANTITIES] = d.utilisation(size)?;
    let bars: Vec<Bar> = PinQuantity::ALL
        .into_iter()
        .filter(|q| d.limits[*q as usize].is_finite())
        .map(|q| Bar { label: q.words().into(), value: u[q as usize], limit: Some(1.0) })
        .collect();
    if !bars.is_empty() {
        let hint = "each quantity over its limit".to_owned();
        shapes::figure(
            out,
            "Utilisation of the limits",
            hint,
            FigureKind::Bars { unit: String::new(), bars },
        );
    }
    Ok(())
}
