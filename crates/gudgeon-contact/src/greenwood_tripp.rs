use gudgeon_core::kinds::{Contact, ContactSpec};
use gudgeon_core::quantity::{
    NonNegative, PosLength, PosPressure, PosRatio, PosSurfaceDensity, Ratio, quantity,
};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

use crate::asperity_integral::{f_1, f_2, f_5_2_field};

/// Elastic contact of two rough surfaces whose summit heights are Gaussian.
///
/// ```text
/// p(h) = (16 √2 π / 15) (η β σ)² √(σ/β) E' F_(5/2)(h/σ)
/// A_c/A = π² (η β σ)² F_2(h/σ)
/// F_n(λ) = (2π)^(-1/2) ∫_λ^∞ (s - λ)^n exp(-s²/2) ds
/// ```
///
/// `h` is the separation of the mean planes, `σ` the composite roughness `√(σ1² + σ2²)`, `η` the number of asperities per
/// area, `β` the radius of their summits, and `E'` the composite modulus in the convention of Greenwood and Tripp,
/// `1/E' = (1-ν1²)/E1 + (1-ν2²)/E2` ([`composite_modulus`]). **A source that writes `2/E' = Σ(1-ν²)/E`, as the ring-liner
/// form of Hu et al. does, prints an `E'` twice as large: halve it.**
///
/// Give either `asperity_density` and `asperity_radius`, or the two products `eta_beta_sigma` (usually 0.03 to 0.07) and
/// `sigma_over_beta` (usually 1e-4 to 1e-2).
///
/// The film between the surfaces is as thick as their mean gap, which stays above zero however deep the mean planes overlap:
///
/// ```text
/// h_film = σ F_1(-h/σ) = ∫ max(h + s, 0) exp(-s²/2σ²)/(√(2π) σ) ds        0.399 σ at h = 0, h beyond 3 σ
/// ```
///
/// Separations below zero (mean planes overlapping) are answered by the formula, `F_(5/2) → |λ|^(5/2)`: the load rises on and on. Summits are
/// pressed flat there, and the model says what a perfectly elastic surface would do.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GreenwoodTripp {
    /// Composite roughness σ of the two surfaces: `√(σ1² + σ2²)` of their rms roughness.
    pub roughness: PosLength,
    /// Composite modulus E' with `1/E' = Σ (1-ν²)/E`: about 115 GPa for steel on cast iron.
    pub composite_modulus: PosPressure,
    /// Asperities per area η; with `asperity_radius`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub asperity_density: Option<PosSurfaceDensity>,
    /// Radius of the asperity summits β; with `asperity_density`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub asperity_radius: Option<PosLength>,
    /// The product η β σ; with `sigma_over_beta`, instead of density and radius.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub eta_beta_sigma: Option<PosRatio>,
    /// The ratio σ/β; with `eta_beta_sigma`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sigma_over_beta: Option<PosRatio>,
    /// How F_5/2 is evaluated: exactly, or by a fit that published results were made with.
    #[serde(default)]
    pub integral: AsperityIntegralFormula,
    /// Coefficient of friction of the load that the asperities carry.
    #[serde(default = "boundary")]
    pub friction_coefficient: Ratio<NonNegative>,
}

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

fn boundary() -> Ratio<NonNegative> {
    quantity(0.10)
}

/// Composite modulus \[Pa\] of two materials in the convention of Greenwood and Tripp: `1/E' = (1-ν1²)/E1 + (1-ν2²)/E2`.
#[must_use]
pub fn composite_modulus(modulus: [f64; 2], poisson: [f64; 2]) -> f64 {
    1.0 / ((1.0 - poisson[0] * poisson[0]) / modulus[0] + (1.0 - poisson[1] * poisson[1]) / modulus[1])
}

/// Composite roughness `√(σ1² + σ2²)` of two rms roughness heights.
#[must_use]
pub fn composite_roughness(sigma: [f64; 2]) -> f64 {
    sigma[0].hypot(sigma[1])
}

/// Real over nominal area of contact, `π² (η β σ)² F_2(λ)` with `λ = h/σ`.
#[must_use]
pub fn real_area_ratio(eta_beta_sigma: f64, lambda: f64) -> f64 {
    (std::f64::consts::PI * eta_beta_sigma).powi(2) * f_2(lambda)
}

#[register_model(
    name = "greenwood_tripp",
    summary = "elastic contact pressure of Gaussian rough surfaces",
    equations = "p = (16 sqrt(2) pi/15) (eta beta sigma)^2 sqrt(sigma/beta) E' F_5/2(h/sigma);  F_n(l) = (2 pi)^-1/2 int_l^inf (s-l)^n exp(-s^2/2) ds;  1/E' = sum (1-nu^2)/E",
    validity = "Elastic, isotropic Gaussian roughness; separations between about 0.5 and 4 roughness heights. The fits `hu1994` and `quintic` deviate by more than 11 % there and expect E' in the convention of this model.",
    references = ["greenwood1970", "hu1994"],
    example = "roughness = \"0.4 um\"\ncomposite_modulus = \"115 GPa\"\neta_beta_sigma = 0.05\nsigma_over_beta = 1e-3\n",
)]
impl ContactSpec for GreenwoodTripp {
    fn build(&self) -> Result<Box<dyn Contact>, BuildError> {
        let sigma = self.roughness.si();
        let (ebs, ratio) =
            match (self.asperity_density, self.asperity_radius, self.eta_beta_sigma, self.sigma_over_beta) {
                (Some(eta), Some(beta), None, None) => (eta.si() * beta.si() * sigma, sigma / beta.si()),
                (None, None, Some(ebs), Some(ratio)) => (ebs.si(), ratio.si()),
                (Some(_), None, None, None) => return Err(missing("asperity_radius", "asperity_density")),
                (None, Some(_), None, None) => return Err(missing("asperity_density", "asperity_radius")),
                (None, None, Some(_), None) => return Err(missing("sigma_over_beta", "eta_beta_sigma")),
                (None, None, None, Some(_)) => return Err(missing("eta_beta_sigma", "sigma_over_beta")),
                (None, None, None, None) => {
                    return Err(BuildError::new("the asperities are not described").help(WAYS));
                }
                _ => return Err(BuildError::new("the asperities are described twice").help(WAYS)),
            };
        let scale = 16.0 * std::f64::consts::SQRT_2 * std::f64::consts::PI / 15.0
            * (ebs * ebs)
            * ratio.sqrt()
            * self.composite_modulus.si();
        let inverse_roughness = sigma.recip();
        if !(scale.is_finite() && scale > 0.0 && inverse_roughness.is_finite()) {
            let what = format!(
                "the contact pressure has no finite scale: eta_beta_sigma {ebs:e}, sigma_over_beta {ratio:e}, roughness {sigma:e} m"
            );
            return Err(BuildError::new(what));
        }
        Ok(Box::new(Asperities {
            sigma,
            inverse_roughness,
            scale,
            eta_beta_sigma: ebs,
            integral: self.integral,
            friction_coefficient: self.friction_coefficient.si(),
        }))
    }
}

const WAYS: &str = "give `asperity_density` and `asperity_radius`, or `eta_beta_sigma` and `sigma_over_beta`, not both pairs";

fn missing(field: &str, given: &str) -> BuildError {
    BuildError::at(field, format!("`{field}` is missing, it goes with `{given}`")).help(WAYS)
}

#[derive(Debug)]
struct Asperities {
    sigma: f64,
    inverse_roughness: f64,
    scale: f64,
    eta_beta_sigma: f64,
    integral: AsperityIntegralFormula,
    friction_coefficient: f64,
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
fn polynomial(lambda: f64) -> f64 {
    if lambda > POLYNOMIAL_TO {
        0.0
    } else if lambda >= POLYNOMIAL_FROM {
        log_polynomial(lambda).exp()
    } else {
        // d ln F/dλ at the joint x = -1: Σ k c_k (-1)^(k-1) / 4.
        let slope =
            POLYNOMIAL.iter().enumerate().skip(1).rev().fold(0.0, |s, (k, &c)| -s + k as f64 * c) * 0.25;
        let g = 1.0 + slope * (lambda - POLYNOMIAL_FROM) / 2.5;
        log_polynomial(POLYNOMIAL_FROM).exp() * (g * g * g.sqrt())
    }
}

fn hu1994(lambda: f64) -> f64 {
    if lambda < HU_TO { 4.4068e-5 * (HU_TO - lambda).powf(6.804) } else { 0.0 }
}

/// Falls monotonically wherever it is positive, below zero too.
fn quintic(lambda: f64) -> f64 {
    // Beyond its zero it would be negative; far below, its fifth power ends where numbers do.
    let l = lambda.max(-1e50);
    let p = 0.6167 + l * (-1.0776 + l * (0.7844 + l * (-0.2958 + l * (0.0574 - 0.0046 * l))));
    if l < QUINTIC_TO { p.max(0.0) } else { 0.0 }
}

impl Contact for Asperities {
    fn pressure(&self, separation: &[f64], pressure: &mut [f64]) {
        let (k, scale) = (self.inverse_roughness, self.scale);
        let pairs = pressure.iter_mut().zip(separation);
        match self.integral {
            AsperityIntegralFormula::Exact => f_5_2_field(separation, k, scale, pressure),
            AsperityIntegralFormula::Polynomial => pairs.for_each(|(p, h)| *p = scale * polynomial(h * k)),
            AsperityIntegralFormula::Hu1994 => pairs.for_each(|(p, h)| *p = scale * hu1994(h * k)),
            AsperityIntegralFormula::Quintic => pairs.for_each(|(p, h)| *p = scale * quintic(h * k)),
        }
    }
    fn range(&self) -> f64 {
        self.sigma
            * match self.integral {
                AsperityIntegralFormula::Exact | AsperityIntegralFormula::Polynomial => EXACT_RANGE,
                AsperityIntegralFormula::Hu1994 => HU_TO,
                AsperityIntegralFormula::Quintic => QUINTIC_TO,
            }
    }
    fn mean_gap(&self, separation: f64) -> f64 {
        self.sigma * f_1(-separation * self.inverse_roughness)
    }
    fn floor(&self) -> Option<f64> {
        None
    }
    fn friction_coefficient(&self) -> f64 {
        self.friction_coefficient
    }
    /// By the exact integral, whichever formula gives the pressure.
    fn real_area(&self, separation: &[f64], ratio: &mut [f64]) -> bool {
        for (r, h) in ratio.iter_mut().zip(separation) {
            *r = real_area_ratio(self.eta_beta_sigma, h * self.inverse_roughness);
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{asperity_integral, f_5_2};

    fn spec(integral: AsperityIntegralFormula) -> GreenwoodTripp {
        GreenwoodTripp {
            roughness: quantity(0.4e-6),
            composite_modulus: quantity(1.15e11),
            asperity_density: None,
            asperity_radius: None,
            eta_beta_sigma: Some(quantity(0.05)),
            sigma_over_beta: Some(quantity(0.001)),
            integral,
            friction_coefficient: boundary(),
        }
    }

    fn at(model: &dyn Contact, lambda: &[f64]) -> Vec<f64> {
        let h: Vec<f64> = lambda.iter().map(|l| l * 0.4e-6).collect();
        let mut p = vec![f64::NAN; h.len()];
        model.pressure(&h, &mut p);
        p
    }

    const ALL: [AsperityIntegralFormula; 4] = [
        AsperityIntegralFormula::Exact,
        AsperityIntegralFormula::Polynomial,
        AsperityIntegralFormula::Hu1994,
        AsperityIntegralFormula::Quintic,
    ];

    /// (λ, p, A_c/A) for ηβσ = 0.05, σ/β = 0.001, E' = 115 GPa, computed with 25 digits.
    const EXAMPLE: [(f64, f64, f64); 6] = [
        (0.0, 26_568_012.357_673_31, 0.012_337_005_501_361_698),
        (0.5, 10_357_829.169_557_507, 0.005_172_641_408_467_88),
        (1.0, 3_471_070.954_333_947_3, 0.001_858_934_643_166_996_4),
        (2.0, 233_683.214_897_745_4, 0.000_142_337_626_425_769_2),
        (3.0, 7_362.153_664_457_482, 5.019_559_414_274_276e-6),
        (4.0, 101.396_670_767_279_88, 7.624_782_874_639_625e-8),
    ];

    #[test]
    fn worked_example() {
        let model = spec(AsperityIntegralFormula::Exact).build().expect("builds");
        let p = at(&*model, &EXAMPLE.map(|e| e.0));
        for ((l, p_exact, area), p) in EXAMPLE.into_iter().zip(p) {
            // Separation / roughness is rounded before the integral sees it: 1 ulp of λ times d ln F/dλ <= 6.
            assert!((p / p_exact - 1.0).abs() < 1e-13, "{l}: {p}");
            // First neglected term of the Taylor pieces at λ <= 4.
            assert!((real_area_ratio(0.05, l) / area - 1.0).abs() < 1e-13, "{l}");
        }
    }

    #[test]
    fn separate_parameters_equal_their_products() {
        let (sigma, beta, eta) = (0.4e-6, 0.4e-3, 0.05 / (0.4e-3 * 0.4e-6));
        let separate = GreenwoodTripp {
            roughness: quantity(sigma),
            asperity_density: Some(quantity(eta)),
            asperity_radius: Some(quantity(beta)),
            eta_beta_sigma: None,
            sigma_over_beta: None,
            ..spec(AsperityIntegralFormula::Exact)
        };
        let a = at(&*separate.build().expect("builds"), &[0.0, 1.0]);
        let b = at(&*spec(AsperityIntegralFormula::Exact).build().expect("builds"), &[0.0, 1.0]);
        for (a, b) in a.iter().zip(&b) {
            // Three roundings in each product.
            assert!((a / b - 1.0).abs() < 2e-15);
        }
    }

    #[test]
    fn composite_modulus_is_the_convention_without_the_factor_two() {
        // Two equal materials: E' = E / (2 (1 - ν²)); the convention 2/E' = Σ would give E / (1 - ν²).
        assert!((composite_modulus([210e9, 210e9], [0.3, 0.3]) / (210e9 / 2.0 / 0.91) - 1.0).abs() < 1e-15);
        // A rigid partner leaves the plane-strain modulus of the other.
        assert!(
            (composite_modulus([100e9, f64::INFINITY], [0.25, 0.3]) / (100e9 / 0.9375) - 1.0).abs() < 1e-15
        );
        assert!((composite_roughness([0.3e-6, 0.4e-6]) / 0.5e-6 - 1.0).abs() < 1e-15);
    }

    #[test]
    fn fits_deviate_as_stated() {
        let worst = |f: fn(f64) -> f64, from: f64, to: f64| {
            let n = 4000;
            (0..=n)
                .map(|i| from + (to - from) * f64::from(i) / f64::from(n))
                .fold(0.0_f64, |w, l| w.max((f(l) / f_5_2(l) - 1.0).abs()))
        };
        // Stated error of the degree-8 fit: 5.91e-6 over its whole range.
        let w = worst(polynomial, -1.0, 7.0);
        assert!(w < 5.95e-6 && w > 5.0e-6, "{w:e}");
        // Deviations of the fit of Hu et al. from the integral: 10.770 % up to 2, 74.2 % up to 3, 0.550224 at 0. The
        // sampling of the published figures was coarser, so the fourth digit may differ.
        assert!((worst(hu1994, 0.0, 2.0) - 0.1077).abs() < 1e-4);
        assert!((worst(hu1994, 0.0, 3.0) - 0.7421).abs() < 1e-3);
        // The quintic, as stated and to the digits stated: 0.08 %, 1.5 %, 28 %; and what it leaves out at its end, 0.4 %.
        for (to, stated, unit) in [(1.0, 0.0008, 5e-5), (1.5, 0.015, 5e-4), (2.0, 0.28, 5e-3)] {
            assert!((worst(quintic, 0.0, to) - stated).abs() < unit, "{to}: {}", worst(quintic, 0.0, to));
        }
        assert!((f_5_2(QUINTIC_TO) / f_5_2(0.0) - 0.004).abs() < 5e-4);
        // Rounding of a power of 6.8 with a logarithm of 1.4: a few ulp.
        assert!((hu1994(0.0) / 0.550_223_989_828_918_9 - 1.0).abs() < 1e-14);
    }

    #[test]
    fn fits_deviate_as_stated_below_zero() {
        // Stated to a percent, or to a tenth of the integral.
        for (f, at, stated, unit) in [
            (polynomial as fn(f64) -> f64, -2.0, 0.93, 0.01),
            (polynomial, -6.0, 0.70, 0.01),
            (hu1994, -2.0, 1.05, 0.01),
            (hu1994, -6.0, 3.0, 0.1),
            (quintic, -2.0, 1.13, 0.01),
            (quintic, -6.0, 2.3, 0.1),
        ] {
            assert!((f(at) / f_5_2(at) - stated).abs() < unit, "{at}: {}", f(at) / f_5_2(at));
        }
    }

    #[test]
    fn mean_gap_stays_above_zero_and_meets_the_separation() {
        let m = spec(AsperityIntegralFormula::Exact).build().expect("builds");
        // σ/√(2π) where the mean planes touch: Taylor pieces to 1e-11.
        assert!((m.mean_gap(0.0) / (0.4e-6 / std::f64::consts::TAU.sqrt()) - 1.0).abs() < 1e-11);
        let mut last = 0.0;
        for k in -90..=90 {
            let g = m.mean_gap(0.4e-7 * f64::from(k));
            assert!(g > last, "{k}");
            last = g;
        }
        // Beyond the range the Gaussian tail that is left is 1e-11 of σ.
        assert!((m.mean_gap(m.range()) / m.range() - 1.0).abs() < 1e-11);
    }

    #[test]
    fn falls_with_separation_and_is_never_negative() {
        // From deep overlap to far beyond the range.
        let lambda: Vec<f64> = (0..6000).map(|i| -20.0 + 0.007 * f64::from(i)).collect();
        for integral in ALL {
            let p = at(&*spec(integral).build().expect("builds"), &lambda);
            assert!(p.iter().all(|p| p.is_finite() && *p >= 0.0), "{integral:?}");
            for (i, w) in p.windows(2).enumerate() {
                assert!(w[1] < w[0] || (w[0] == 0.0 && w[1] == 0.0), "{integral:?} at {}: {w:?}", lambda[i]);
            }
        }
    }

    #[test]
    fn range_is_where_the_pressure_has_gone() {
        for integral in ALL {
            let model = spec(integral).build().expect("builds");
            let reach = model.range() / 0.4e-6;
            let p = at(&*model, &[0.0, reach, reach - 0.1]);
            assert!(p[1] <= 1e-12 * p[0], "{integral:?}");
            // Not wastefully large either, except for the power law, which touches zero at its range.
            assert!(integral == AsperityIntegralFormula::Hu1994 || p[2] > 1e-12 * p[0]);
        }
    }

    #[test]
    fn slopes_are_continuous() {
        // d p/dλ from both sides of the joints; h = 1e-5, so the quotients differ by h F''/F' <= 1e-4 when smooth.
        for (f, joint) in
            [(polynomial as fn(f64) -> f64, POLYNOMIAL_FROM), (f_5_2, -8.0), (f_5_2, 0.0), (f_5_2, 4.0)]
        {
            let h = 1e-5;
            let left = (f(joint) - f(joint - h)) / h;
            let right = (f(joint + h) - f(joint)) / h;
            assert!((left / right - 1.0).abs() < 1e-4, "{joint}: {left} {right}");
            let exact = -2.5 * asperity_integral(1.5, joint);
            // At the end of its range the slope of the polynomial is off by the derivative of its 6e-6 ripple.
            assert!((left / exact - 1.0).abs() < 1e-3, "{joint}: {left} {exact}");
        }
    }

    #[test]
    fn refuses_half_a_description() {
        let base = spec(AsperityIntegralFormula::Exact);
        let e = |s: GreenwoodTripp| s.build().err().map(|e| (e.field, e.message));
        let only = GreenwoodTripp { sigma_over_beta: None, ..base.clone() };
        assert_eq!(e(only).map(|e| e.0), Some("sigma_over_beta".into()));
        let twice = GreenwoodTripp { asperity_radius: Some(quantity(1e-3)), ..base.clone() };
        assert!(e(twice).is_some_and(|e| e.1.contains("twice")));
        let none = GreenwoodTripp { sigma_over_beta: None, eta_beta_sigma: None, ..base.clone() };
        assert!(e(none).is_some_and(|e| e.1.contains("not described")));
        let tiny = GreenwoodTripp { eta_beta_sigma: Some(quantity(1e-300)), ..base };
        assert!(e(tiny).is_some_and(|e| e.1.contains("no finite scale")));
    }

    /// Run with `--release -- --ignored --nocapture`.
    #[test]
    #[ignore = "a measurement"]
    #[allow(clippy::print_stdout, reason = "a measurement")]
    fn nanoseconds_per_point() {
        let lambda: Vec<f64> = (0..1000).map(|i| 5.0 * f64::from((i * 617) % 1000) / 1000.0).collect();
        let h: Vec<f64> = lambda.iter().map(|l| l * 0.4e-6).collect();
        let mut p = vec![0.0; h.len()];
        for integral in ALL {
            let model = spec(integral).build().expect("builds");
            let mut best = f64::INFINITY;
            for _ in 0..50 {
                let start = std::time::Instant::now();
                for _ in 0..100 {
                    model.pressure(std::hint::black_box(&h), std::hint::black_box(&mut p));
                }
                best = best.min(start.elapsed().as_secs_f64() / 1e5);
            }
            println!("{integral:?}: {:.2} ns/point", best * 1e9);
        }
    }
}
