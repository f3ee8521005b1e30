//! Partial derivatives against difference quotients.

/// How far a partial derivative may be from a difference quotient, beside what the quotient says of its own error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// Part of the larger of the two derivatives.
    pub relative: f64,
    /// Difference of the value over the whole step that counts as nothing, as a part of the value: what the function rounds.
    pub rounding: f64,
}

impl Default for Tolerance {
    /// For a closed form of some ten operations: no part of the derivative, and 16 roundings of the value.
    fn default() -> Self {
        Self { relative: 0.0, rounding: 16.0 * f64::EPSILON }
    }
}

/// Complaints about `partials` (row-major, a row for each value of `f`, a column for each `x`) at `x`: central differences of `f` over `±step` and
/// half of it differ from them by more than both differ from each other, by more than the tolerance, and by more than rounding explains.
///
/// Where `f` has a kink within a step of `x`, there is no derivative to compare: choose another place.
pub fn partials(
    mut f: impl FnMut(&[f64], &mut [f64]),
    x: &[f64],
    step: &[f64],
    partials: &[f64],
    tolerance: Tolerance,
) -> Vec<String> {
    if step.len() != x.len() || x.is_empty() || !partials.len().is_multiple_of(x.len()) {
        return vec![format!("{} steps and {} partials for {} inputs", step.len(), partials.len(), x.len())];
    }
    let rows = partials.len() / x.len();
    let mut wrong = Vec::new();
    let (mut up, mut down) = (vec![0.0; rows], vec![0.0; rows]);
    for k in 0..x.len() {
        let mut quotient = |h: f64| -> (Vec<f64>, Vec<f64>) {
            let mut at = x.to_vec();
            at[k] = x[k] + h;
            let above = at[k];
            f(&at, &mut up);
            at[k] = x[k] - h;
            f(&at, &mut down);
            // Over the step that was taken, which is rounded.
            let width = above - at[k];
            let slopes = up.iter().zip(&down).map(|(u, d)| (u - d) / width).collect();
            let noise = up.iter().zip(&down).map(|(u, d)| u.abs().max(d.abs()) / width.abs()).collect();
            (slopes, noise)
        };
        let (coarse, _) = quotient(step[k]);
        let (fine, noise) = quotient(0.5 * step[k]);
        for i in 0..rows {
            let given = partials[i * x.len() + k];
            let own = (coarse[i] - fine[i]).abs();
            let admitted =
                own + tolerance.relative * given.abs().max(fine[i].abs()) + tolerance.rounding * noise[i];
            let distance = (given - fine[i]).abs();
            if distance > admitted || !distance.is_finite() || !admitted.is_finite() {
                wrong.push(format!(
                    "value {i} by input {k}: the partial is {given:e}, differences give {:e} and {:e}",
                    coarse[i], fine[i]
                ));
            }
        }
    }
    wrong
}
