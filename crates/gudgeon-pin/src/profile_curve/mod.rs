//! Curves through the ordinates of a skirt profile.

pub mod lagrange;
pub mod linear;
pub mod monotone_cubic;

use gudgeon_core::BuildError;

/// Refuses points that no curve goes through.
fn check(x: &[f64], y: &[f64]) -> Result<(), BuildError> {
    if x.len() != y.len() || x.len() < 2 {
        let what = format!("{} abscissae with {} ordinates: a curve needs two points", x.len(), y.len());
        return Err(BuildError::new(what));
    }
    if x.iter().chain(y).any(|v| !v.is_finite()) {
        return Err(BuildError::new("a point of the profile is not a number"));
    }
    match x.windows(2).find(|w| w[1] <= w[0]) {
        Some(w) => Err(BuildError::new(format!("{} m does not lie above {} m", w[1], w[0]))),
        None => Ok(()),
    }
}
