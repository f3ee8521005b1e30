//! The film thickness as the mean gap of rough surfaces.

use gudgeon_contact::{GreenwoodWilliamson, LoadSharing, SummitHeights, asperity_integral};
use gudgeon_core::kinds::{Contact, ContactSpec};
use gudgeon_core::quantity::quantity;

const SIGMA: f64 = 0.4e-6;

fn sharing() -> Box<dyn Contact> {
    let spec = LoadSharing {
        roughness: quantity(SIGMA),
        composite_modulus: quantity(1.15e11),
        eta_beta_sigma: quantity(0.05),
        sigma_over_beta: quantity(1e-3),
        summit_heights: SummitHeights::RandomField,
        friction_coefficient: quantity(0.1),
    };
    spec.build().expect("builds")
}

fn over_mean_planes() -> Box<dyn Contact> {
    let spec = GreenwoodWilliamson {
        roughness: quantity(SIGMA),
        composite_modulus: quantity(1.15e11),
        eta_beta_sigma: quantity(0.05),
        sigma_over_beta: quantity(1e-3),
        summit_heights: SummitHeights::RandomField,
        friction_coefficient: quantity(0.1),
    };
    spec.build().expect("builds")
}

fn pressure(m: &dyn Contact, h: f64) -> f64 {
    let mut p = [f64::NAN];
    m.pressure(&[h], &mut p);
    p[0]
}

/// (h/σ, D, p, A_c/A, dp/dh) for σ = 0.4 um, ηβσ = 0.05, σ/β = 0.001, E' = 115 GPa: `D Φ(D) + φ(D) = h/σ` solved and the integrals over the summits by
/// quadrature, 30 digits (mpmath); dp/dh = -(3/2) F_(1/2)/F_(3/2) p/(σ_s Φ(D)).
const DIGITS: [(f64, f64, f64, f64, f64); 7] = [
    (
        0.001,
        -2.717_805_515_231_757,
        1_722_514_255.150_138,
        0.571_250_565_054_988_3,
        -5.230_817_380_827_908e17,
    ),
    (
        0.01,
        -1.938_356_307_290_102,
        1_217_820_779.299_274_1,
        0.448_852_827_508_141_9,
        -5.758_061_100_328_219e16,
    ),
    (
        0.1,
        -0.902_346_347_510_034_5,
        657_140_604.774_524_7,
        0.287_397_037_667_204_5,
        -6.408_914_328_717_502e15,
    ),
    (
        1.0,
        0.899_471_561_253_743_6,
        95_216_322.467_319_15,
        0.059_356_896_801_694_28,
        -4.497_935_981_311_421e14,
    ),
    (
        2.0,
        1.991_309_537_554_579_4,
        11_521_728.923_328_66,
        0.008_779_921_792_614_582,
        -6.966_024_986_232_042e13,
    ),
    (
        3.0,
        2.999_617_328_791_227_2,
        678_463.166_519_754_9,
        0.000_604_708_283_458_638_5,
        -5.562_334_428_048_08e12,
    ),
    (
        4.0,
        3.999_992_854_515_258,
        15_650.700_998_833_293,
        1.587_397_276_624_949_5e-5,
        -1.671_809_168_225_646e11,
    ),
];

#[test]
fn by_many_digits() {
    let m = sharing();
    for (x, d, p, area, slope) in DIGITS {
        let h = x * SIGMA;
        // F_2 + λ F_1 loses two digits of 1e-13; a slope of at most 5 carries the distance into the pressure.
        assert!((m.mean_planes(h) / SIGMA - d).abs() < 1e-11, "{x}: {}", m.mean_planes(h) / SIGMA);
        assert!((pressure(&*m, h) / p - 1.0).abs() < 1e-10, "{x}: {}", pressure(&*m, h) / p - 1.0);
        let mut a = [0.0];
        assert!(m.real_area(&[h], &mut a) && (a[0] / area - 1.0).abs() < 1e-10, "{x}: {}", a[0]);
        // The stencil of four places misses d⁴ f⁽⁵⁾/30: at the far end, where p falls by exp(-5 h/σ), (5 · 0.008)⁴/30 = 9e-8.
        let step = 0.002 * h;
        let f = |k: f64| pressure(&*m, h + k * step);
        let by_differences = (8.0 * (f(1.0) - f(-1.0)) - (f(2.0) - f(-2.0))) / (12.0 * step);
        assert!((by_differences / slope - 1.0).abs() < 1e-7, "{x}: {by_differences:e} {slope:e}");
    }
}

#[test]
fn as_greenwood_williamson_at_the_distance_of_the_mean_planes_and_heavier_at_the_same_length() {
    let (m, planes) = (sharing(), over_mean_planes());
    for k in -60..=15 {
        let h = SIGMA * (f64::from(k) / 8.0).exp();
        if h > SIGMA * asperity_integral(1.0, 3.0) {
            // Two roundings in the distance.
            let same = pressure(&*planes, m.mean_planes(h));
            assert!((pressure(&*m, h) / same - 1.0).abs() < 1e-12, "{h:e}");
        }
        assert!(pressure(&*m, h) >= pressure(&*planes, h) * (1.0 - 1e-12), "{h:e}");
    }
    // A thousandth of the roughness: pressed by 2.7 roughness heights instead of none.
    assert!(pressure(&*m, 1e-3 * SIGMA) > 5.0 * pressure(&*planes, 1e-3 * SIGMA));
    // The mean gap at 4.5 σ is 4.5 σ + σ F_1(4.5) = 4.5 σ + 7e-7 σ, and p'/p = 5 there.
    assert!((pressure(&*m, 4.5 * SIGMA) / pressure(&*planes, 4.5 * SIGMA) - 1.0).abs() < 5e-6);
}

#[test]
fn goes_on_below_nothing_with_the_slope_that_it_had() {
    let m = sharing();
    let joint = SIGMA * asperity_integral(1.0, 3.0);
    let slope = |h: f64| {
        let d = 1e-4 * joint;
        (pressure(&*m, h + d) - pressure(&*m, h - d)) / (2.0 * d)
    };
    // 2e-4 of the film on either side, over which the slope changes like 1/h.
    assert!((slope(joint * (1.0 + 2e-4)) / slope(joint * (1.0 - 2e-4)) - 1.0).abs() < 1e-3);
    // A straight line: rounding of a pressure over a difference of 1e-4 of it.
    assert!((slope(-SIGMA) / slope(0.5 * joint) - 1.0).abs() < 1e-6);
    // Value and slope of the gap meet, and it never ends.
    assert_eq!(m.mean_gap(joint * 1.001), joint * 1.001);
    // Half the square of the distance.
    assert!((m.mean_gap(joint * 0.999) / (joint * 0.999) - 1.0).abs() < 1e-6);
    assert!(m.mean_gap(0.0) > 0.0 && m.mean_gap(-joint) > 0.0);
}
