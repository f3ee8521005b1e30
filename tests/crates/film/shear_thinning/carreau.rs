//! Shear thinning after Carreau.

use gudgeon_core::kinds::{ShearThinning, ShearThinningSpec};
use gudgeon_core::quantity::quantity;
use gudgeon_film::Carreau;

fn at(m: &dyn ShearThinning, rate: f64) -> (f64, f64) {
    let (mut f, mut s) = ([0.0], [0.0]);
    m.factor(&[rate], &mut f, &mut s).expect("finite");
    (f[0], s[0])
}

fn carreau(n: f64, m: f64) -> Box<dyn ShearThinning> {
    Carreau { critical_shear_rate: quantity(1e5), exponent: quantity(n), high_shear_ratio: quantity(m) }
        .build()
        .expect("builds")
}

#[test]
fn known_points() {
    let m = carreau(0.5, 0.4);
    assert_eq!(at(&*m, 0.0), (1.0, 0.0));
    // At γ̇_c: 0.4 + 0.6 · 2^(-1/4).
    assert!((at(&*m, 1e5).0 - (0.4 + 0.6 * 0.5f64.powf(0.25))).abs() < 2e-16);
    // Far above: the plateau, from a power law x^(-1/2) = 1e-5.
    assert!((at(&*m, 1e15).0 - 0.4 - 0.6e-5).abs() < 1e-15);
    // n = 1 does not thin.
    assert_eq!(at(&*carreau(1.0, 0.2), 1e9), (1.0, 0.0));
}

#[test]
fn even_and_its_slope_odd() {
    let m = carreau(0.3, 0.2);
    for rate in [1.0, 3e4, 1e5, 1e7, 1e12] {
        let ((f, s), (g, t)) = (at(&*m, rate), at(&*m, -rate));
        assert_eq!((f, s), (g, -t));
        let d = 1e-4 * rate;
        let central = (at(&*m, rate + d).0 - at(&*m, rate - d).0) / (2.0 * d);
        // Truncation 1e-8 of the slope, rounding 1e-16/d.
        assert!((central - s).abs() < 2e-8 * s.abs() + 2e-16 / d, "{rate}: {central} {s}");
    }
}

#[test]
fn extremes() {
    let m = carreau(0.0, 0.0);
    for rate in [1e300, -f64::MAX, f64::MIN_POSITIVE] {
        let (f, s) = at(&*m, rate);
        assert!(f > 0.0 && f <= 1.0 && s.is_finite(), "{rate}: {f} {s}");
    }
    assert!(m.factor(&[f64::NAN], &mut [0.0], &mut [0.0]).is_err_and(|e| e.is_recoverable()));
    assert!(m.factor(&[1.0], &mut [0.0; 2], &mut [0.0]).is_err_and(|e| !e.is_recoverable()));
}
