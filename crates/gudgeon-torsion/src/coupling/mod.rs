//! Couplings: what joins two inertias.

mod frequency_dependent;
mod linear;
mod load_dependent;
mod off;
mod piecewise;
mod progressive;

pub use frequency_dependent::FrequencyDependent;
pub use linear::Linear;
pub use load_dependent::LoadDependent;
pub use off::Off;
pub use piecewise::Piecewise;
pub use progressive::Progressive;

use gudgeon_core::BuildError;

/// Checks a table: at least `min_rows` rows, columns of one length, finite, the first one ascending.
pub(crate) fn check_table(
    name: &str,
    x: &[f64],
    columns: &[(&str, &[f64])],
    min_rows: usize,
) -> Result<(), BuildError> {
    if x.len() < min_rows {
        return Err(BuildError::at(name, format!("{} rows, at least {min_rows} are needed", x.len())));
    }
    for (other, c) in columns {
        if c.len() != x.len() {
            let what = format!("{} values beside {} of `{name}`", c.len(), x.len());
            return Err(BuildError::at(*other, what));
        }
        if let Some(i) = c.iter().position(|v| !v.is_finite()) {
            return Err(BuildError::at(format!("{other}.{i}"), "is not a finite number"));
        }
    }
    if let Some(i) = x.iter().position(|v| !v.is_finite()) {
        return Err(BuildError::at(format!("{name}.{i}"), "is not a finite number"));
    }
    for (i, w) in x.windows(2).enumerate() {
        if w[1] <= w[0] {
            let what = format!("{} does not follow {}: the values must ascend", w[1], w[0]);
            return Err(BuildError::at(format!("{name}.{}", i + 1), what));
        }
    }
    Ok(())
}

/// Straight lines between the rows, constant beyond the ends.
fn interpolate(x: &[f64], y: &[f64], at: f64) -> f64 {
    let n = x.len();
    if at <= x[0] {
        return y[0];
    }
    if at >= x[n - 1] {
        return y[n - 1];
    }
    let i = x.partition_point(|v| *v <= at).clamp(1, n - 1);
    let f = (at - x[i - 1]) / (x[i] - x[i - 1]);
    y[i - 1] + f * (y[i] - y[i - 1])
}
