//! Angles and periods.

/// Length of a four-stroke cycle \[rad\].
pub const FOUR_STROKE: f64 = 4.0 * std::f64::consts::PI;

/// `theta` reduced to one period, `0 <= result < period`.
pub(crate) fn reduced(theta: f64, period: f64) -> f64 {
    if (0.0..period).contains(&theta) {
        return theta;
    }
    // The quotient may be rounded across a whole number, and the result by an ulp to either side of the interval.
    let x = theta - period * (theta / period).floor();
    // (A `theta` that is not a number stays one.)
    if x >= period || x < 0.0 { 0.0 } else { x }
}
