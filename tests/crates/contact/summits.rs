//! Spherical summits of one rough surface on a plane: elastic, and with yield.

use gudgeon_contact::{GreenwoodWilliamson, KogutEtsion, SummitHeights};
use gudgeon_core::kinds::{Contact, ContactSpec};
use gudgeon_core::quantity::quantity;

const SIGMA: f64 = 0.4e-6;

fn elastic() -> GreenwoodWilliamson {
    GreenwoodWilliamson {
        roughness: quantity(SIGMA),
        composite_modulus: quantity(1.15e11),
        eta_beta_sigma: quantity(0.05),
        sigma_over_beta: quantity(1e-3),
        summit_heights: SummitHeights::RandomField,
        friction_coefficient: quantity(0.1),
    }
}

fn yielding(hardness: f64) -> Box<dyn Contact> {
    let GreenwoodWilliamson {
        roughness,
        composite_modulus,
        eta_beta_sigma,
        sigma_over_beta,
        summit_heights,
        friction_coefficient,
    } = elastic();
    let spec = KogutEtsion {
        roughness,
        composite_modulus,
        hardness: quantity(hardness),
        poisson_ratio: quantity(0.26),
        eta_beta_sigma,
        sigma_over_beta,
        summit_heights,
        friction_coefficient,
    };
    spec.build().expect("builds")
}

/// Pressure and real area at a separation in roughness heights.
fn at(m: &dyn Contact, heights: f64) -> (f64, f64) {
    let (mut p, mut a) = ([f64::NAN], [f64::NAN]);
    m.pressure(&[heights * SIGMA], &mut p);
    assert!(m.real_area(&[heights * SIGMA], &mut a));
    (p[0], a[0])
}

/// (h/σ, p, A_c/A) for ηβσ = 0.05, σ/β = 0.001, E' = 115 GPa, by quadrature with 30 digits.
const ELASTIC: [(f64, f64, f64); 6] = [
    (0.0, 300_615_189.996_841_83, 0.156_507_216_291_908_72),
    (0.5, 167_729_679.233_256_2, 0.096_576_704_084_972_9),
    (1.0, 81_277_563.009_902_82, 0.051_671_941_383_953_08),
    (2.0, 11_287_252.668_889_233, 0.008_613_923_642_977_998),
    (3.0, 677_613.384_187_764_7, 0.000_603_983_586_952_219_6),
    (4.0, 15_650.223_185_373_655, 1.587_350_149_280_202e-5),
];

#[test]
fn elastic_summits_by_many_digits() {
    let m = elastic().build().expect("builds");
    for (h, pressure, area) in ELASTIC {
        let (p, a) = at(&*m, h);
        // The distance of the summits is rounded before the integral sees it, times a slope of at most 5.
        assert!((p / pressure - 1.0).abs() < 1e-12 && (a / area - 1.0).abs() < 1e-12, "{h}: {p} {a}");
    }
    // Gaussian surfaces whose mean planes meet are σ/√(2π) apart on average.
    assert!((m.mean_gap(0.0) / (SIGMA / std::f64::consts::TAU.sqrt()) - 1.0).abs() < 1e-12);
}

/// (H, h/σ, p, A_c/A), K = 0.5606, otherwise as above. Summits yield at 0.25 of their deviation, and at 1.6e-4 of it.
const YIELDING: [(f64, f64, f64, f64); 12] = [
    (2e9, -1.0, 568_623_542.876_711, 0.393_388_320_797_718),
    (2e9, 0.0, 259_339_567.993_196, 0.190_963_534_588_687),
    (2e9, 1.0, 73_635_516.996_855_2, 0.059_128_051_048_178_5),
    (2e9, 2.0, 10_560_678.229_813_8, 0.009_367_453_986_062_86),
    (2e9, 3.0, 647_731.713_125_989, 0.000_634_148_088_734_284),
    (2e9, 4.0, 15_184.673_702_602_9, 1.629_084_936_159_66e-5),
    (5e7, -1.0, 30_240_810.640_468_3, 0.604_816_366_492_971),
    (5e7, 0.0, 15_650_610.792_182_7, 0.313_013_020_933_621),
    (5e7, 1.0, 5_167_014.768_546_49, 0.103_341_598_323_258),
    (5e7, 2.0, 861_302.687_186_42, 0.017_226_705_191_917_4),
    (5e7, 3.0, 60_384.507_689_581_5, 0.001_207_790_777_074_85),
    (5e7, 4.0, 1_586.689_229_827_15, 3.173_858_617_842_74e-5),
];

#[test]
fn summits_that_yield_by_many_digits() {
    for (hardness, h, pressure, area) in YIELDING {
        let (p, a) = at(&*yielding(hardness), h);
        // What a cubic of the logarithm misses between rows an eighth of a deviation apart.
        assert!((p / pressure - 1.0).abs() < 1e-6, "{hardness} {h}: {}", p / pressure - 1.0);
        assert!((a / area - 1.0).abs() < 1e-6, "{hardness} {h}: {}", a / area - 1.0);
    }
}

#[test]
fn hard_summits_are_elastic_and_soft_ones_flow_under_their_hardness() {
    let (elastic, hard) = (elastic().build().expect("builds"), yielding(2e11));
    for h in [-2.0, 0.0, 1.3, 2.6, 4.0] {
        let ((p, a), (p_hard, a_hard)) = (at(&*elastic, h), at(&*hard, h));
        // No summit yields; the rest is the table.
        assert!((p_hard / p - 1.0).abs() < 1e-6 && (a_hard / a - 1.0).abs() < 1e-6, "{h}: {p_hard} {p}");
        // Summits that yield at 1.6e-4 of their deviation have all but a tenth of a thousandth of the load beyond full yield where many touch.
        let (p, a) = at(&*yielding(5e7), h.min(1.3));
        assert!((p / (5e7 * a) - 1.0).abs() < 1e-3, "{h}: {}", p / (5e7 * a));
    }
}

#[test]
fn a_product_that_no_surface_has_is_refused() {
    let mut spec = elastic();
    spec.eta_beta_sigma = quantity(0.02);
    let e = spec.build().expect_err("no Gaussian field").to_string();
    assert!(e.contains("eta_beta_sigma"), "{e}");
    spec.summit_heights = SummitHeights::AsSurface;
    let m = spec.build().expect("builds");
    // (4/3) ηβσ √(σ/β) E' F_(3/2)(0), the last 0.430019993662.
    let p = 4.0 / 3.0 * 0.02 * 1e-3_f64.sqrt() * 1.15e11 * 0.430_019_993_662_259_8;
    // A few roundings.
    assert!((at(&*m, 0.0).0 / p - 1.0).abs() < 1e-13);
}
