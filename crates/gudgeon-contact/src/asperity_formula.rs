//! `F_(5/2)` exactly, and by fits that published results were made with.

use serde::{Deserialize, Serialize};

use crate::asperity_integral::f_5_2;
use gudgeon_numerics::elementary;

/// Evaluation of `F_(5/2)`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AsperityIntegralFormula {
    /// To a relative error below 1e-9 (1e-11 up to 6.7 roughness heights).
    #[default]
    Exact,
    /// Exponential of a polynomial of degree 8, relative error 6e-6 between -1 and 7 roughness heights, zero beyond 7; below -1 a power
    /// law in its place, 7 % low at -2 and 30 % at -6.
    Polynomial,
    /// `4.4068e-5 (4-λ)^6.804` (Hu et al. 1994), zero beyond 4: 11 % low at contact of the mean planes, 74 % off near 3. A fit for
    /// separations above zero: 5 % high at -2, three times the integral at -6.
    Hu1994,
    /// `0.6167 - 1.0776 λ + 0.7844 λ² - 0.2958 λ³ + 0.0574 λ⁴ - 0.0046 λ⁵`, much used for rings: 0.08 % off up to 1 roughness
    /// height, 1.5 % to 1.5, 28 % to 2; zero beyond 2.224, where the integral is still 0.4 % of its value at contact of the mean
    /// planes. A fit for separations above zero: 13 % high at -2, 2.3 times the integral at -6.
    Quintic,
}

impl AsperityIntegralFormula {
    /// `F_(5/2)(λ)` as this formula gives it, for every finite `λ = h/σ`. Never negative, never rises with `λ`.
    #[must_use]
    pub fn value(self, lambda: f64) -> f64 {
        match self {
            Self::Exact => f_5_2(lambda),
            Self::Polynomial => polynomial(lambda),
            Self::Hu1994 => hu1994(lambda),
            Self::Quintic => quintic(lambda),
        }
    }

    /// `λ` from which on the value is at most 1e-12 of that at zero.
    #[must_use]
    pub const fn range(self) -> f64 {
        match self {
            Self::Exact | Self::Polynomial => EXACT_RANGE,
            Self::Hu1994 => HU_TO,
            Self::Quintic => QUINTIC_TO,
        }
    }
}

/// `F_(5/2)` has fallen to 1e-12 of its value at zero separation here.
const EXACT_RANGE: f64 = 6.58;
const POLYNOMIAL_FROM: f64 = -1.0;
const POLYNOMIAL_TO: f64 = 7.0;
const HU_TO: f64 = 4.0;
/// Zero of the quintic.
const QUINTIC_TO: f64 = 2.223_916_060_754_65;

/// `ln F_(5/2)` in powers of `(λ-3)/4`: fitted to the exact integral over `-1 <= λ <= 7` for the largest relative error.
const POLYNOMIAL: [f64; 9] = [
    -8.674_589_989_605_307,
    -15.448_215_760_129_276,
    -6.634_015_140_951_041,
    -0.590_272_383_086_350_7,
    0.229_734_553_737_150_13,
    -0.069_702_425_143_529_66,
    0.004_637_503_470_173_8,
    0.013_685_358_805_275_012,
    -0.006_676_853_601_016_46,
];

fn log_polynomial(lambda: f64) -> f64 {
    let x = (lambda - 3.0) * 0.25;
    POLYNOMIAL.iter().rev().fold(0.0, |s, &c| s * x + c)
}

/// Below its range the fit continues as a power law of the right exponent (`F_(5/2) -> |λ|^(5/2)`) with the value and the
/// slope of the fit at the joint: it stays monotone and finite where the polynomial itself would turn around.
pub(crate) fn polynomial(lambda: f64) -> f64 {
    if lambda > POLYNOMIAL_TO {
        0.0
    } else if lambda >= POLYNOMIAL_FROM {
        elementary::exp(log_polynomial(lambda))
    } else {
        // d ln F/dλ at the joint x = -1: Σ k c_k (-1)^(k-1) / 4.
        let slope =
            POLYNOMIAL.iter().enumerate().skip(1).rev().fold(0.0, |s, (k, &c)| -s + k as f64 * c) * 0.25;
        let g = 1.0 + slope * (lambda - POLYNOMIAL_FROM) / 2.5;
        elementary::exp(log_polynomial(POLYNOMIAL_FROM)) * (g * g * g.sqrt())
    }
}

pub(crate) fn hu1994(lambda: f64) -> f64 {
    if lambda < HU_TO { 4.4068e-5 * elementary::powf(HU_TO - lambda, 6.804) } else { 0.0 }
}

/// Falls monotonically wherever it is positive, below zero too.
pub(crate) fn quintic(lambda: f64) -> f64 {
    // Beyond its zero it would be negative; far below, its fifth power ends where numbers do.
    let l = lambda.max(-1e50);
    let p = 0.6167 + l * (-1.0776 + l * (0.7844 + l * (-0.2958 + l * (0.0574 - 0.0046 * l))));
    if l < QUINTIC_TO { p.max(0.0) } else { 0.0 }
}
