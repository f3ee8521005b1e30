//! Shear thinning after Cross.

use gudgeon_core::kinds::{ShearThinning, ShearThinningSpec};
use gudgeon_core::quantity::quantity;
use gudgeon_film::Cross;

fn at(m: &dyn ShearThinning, rate: f64) -> (f64, f64) {
    let (mut f, mut s) = ([0.0], [0.0]);
    m.factor(&[rate], &mut f, &mut s).expect("finite");
    (f[0], s[0])
}

fn cross(k: f64, m: f64) -> Box<dyn ShearThinning> {
    Cross { critical_shear_rate: quantity(5e5), exponent: quantity(k), high_shear_ratio: quantity(m) }
        .build()
        .expect("builds")
}

#[test]
fn known_points() {
    for k in [0.5, 1.0, 2.0] {
        let m = cross(k, 0.4);
        assert_eq!(at(&*m, 0.0), (1.0, 0.0));
        // Half-way at γ̇_c, whatever the exponent.
        assert!((at(&*m, 5e5).0 - 0.7).abs() < 2e-16);
    }
    // k = 1, x = 3: 0.4 + 0.6/4, and the form [1 + m x]/[1 + x].
    assert!((at(&*cross(1.0, 0.4), 1.5e6).0 - (1.0 + 0.4 * 3.0) / 4.0).abs() < 2e-16);
}

#[test]
fn even_and_its_slope_odd() {
    for k in [0.6, 1.0, 2.0] {
        let m = cross(k, 0.2);
        for rate in [1e3, 5e5, 1e7, 1e10] {
            let ((f, s), (g, t)) = (at(&*m, rate), at(&*m, -rate));
            assert_eq!((f, s), (g, -t));
            let d = 1e-4 * rate;
            let central = (at(&*m, rate + d).0 - at(&*m, rate - d).0) / (2.0 * d);
            // Truncation 1e-8 of the slope, rounding 1e-16/d.
            assert!((central - s).abs() < 2e-8 * s.abs() + 2e-16 / d, "{rate}: {central} {s}");
        }
    }
}

#[test]
fn extremes() {
    for k in [0.1, 1.0, 10.0] {
        let m = cross(k, 0.0);
        for rate in [1e300, -f64::MAX, f64::MIN_POSITIVE, -1e-300] {
            let (f, s) = at(&*m, rate);
            assert!(f > 0.0 && f <= 1.0 && s.is_finite(), "{rate}: {f} {s}");
        }
    }
    let m = cross(1.0, 0.5);
    assert!(m.factor(&[f64::NAN], &mut [0.0], &mut [0.0]).is_err_and(|e| e.is_recoverable()));
    assert!(m.factor(&[1.0], &mut [0.0; 2], &mut [0.0]).is_err_and(|e| !e.is_recoverable()));
}
