//! The distorted liner of a case.

use gudgeon_core::BuildError;

use super::case::RingPackCase;
use super::liner::LinerShape;

/// The distortion of a case, and the height of ring 1 above the pin \[m\]; the lowest ring is `spacing` \[m\] below ring 1.
///
/// # Errors
/// A table that does not cover the travel of the rings or goes back and forth.
pub fn liner_shape(case: &RingPackCase, stroke: f64, spacing: f64) -> Result<(LinerShape, f64), BuildError> {
    let table = &case.liner.distortion;
    let pin = case.piston.pin_to_ring1.map_or(0.0, |p| p.si());
    if table.is_empty() {
        return Ok((LinerShape::default(), pin));
    }
    if case.piston.pin_to_ring1.is_none() {
        return Err(BuildError::at("piston", "a distorted liner needs `pin_to_ring1`")
            .help("the heights of `liner.distortion` count from the gudgeon pin at top dead centre"));
    }
    if table.len() < 2 {
        return Err(BuildError::at("liner.distortion", "a distortion table needs at least two points"));
    }
    let mut points: Vec<(f64, f64)> =
        table.iter().map(|d| (d.position.si(), d.diametral.si() / 2.0)).collect();
    let descending = points[1].0 < points[0].0;
    for (k, pair) in points.windows(2).enumerate() {
        if pair[0].0 == pair[1].0 || (pair[1].0 < pair[0].0) != descending {
            return Err(BuildError::at(
                format!("liner.distortion.{}.position", k + 1),
                "positions must all fall or all rise",
            ));
        }
    }
    if descending {
        points.reverse();
    }
    let (low, high) = (pin - stroke - spacing, pin);
    let (first, last) = (points[0].0, points[points.len() - 1].0);
    if first > low + 1e-9 || last < high - 1e-9 {
        return Err(BuildError::at(
            "liner.distortion",
            format!(
                "the rings travel from {:.1} mm to {:.1} mm, but the table spans {:.1} mm to {:.1} mm",
                1e3 * high,
                1e3 * low,
                1e3 * last,
                1e3 * first
            ),
        )
        .help("add points that cover the whole travel"));
    }
    let (position, growth) = points.into_iter().unzip();
    Ok((LinerShape { position, growth }, pin))
}
