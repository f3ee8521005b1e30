//! Density after Dowson and Higginson.

use gudgeon_core::kinds::CompressibilitySpec;
use gudgeon_core::quantity::quantity;
use gudgeon_film::DowsonHigginson;

fn at(p: f64) -> (f64, f64) {
    let m = DowsonHigginson::default().build().expect("builds");
    let (mut f, mut s) = ([0.0], [0.0]);
    m.factor(&[p], &mut f, &mut s).expect("in range");
    (f[0], s[0])
}

#[test]
fn the_published_curve() {
    // (1 + 2.3 p)/(1 + 1.7 p), p in GPa: the same curve as one fraction.
    for p in [0.0, 0.05, 0.4, 1.0, 3.0, -0.1] {
        let (f, s) = at(p * 1e9);
        assert!((f - (1.0 + 2.3 * p) / (1.0 + 1.7 * p)).abs() < 1e-15, "{p}");
        // Slope 0.6/(1 + 1.7 p)² per GPa.
        assert!((s * 1e9 - 0.6 / (1.0 + 1.7 * p).powi(2)).abs() < 1e-15, "{p}");
    }
    // Its limit 1 + 6/17.
    assert!((at(1e300).0 - 1.0 - 6.0 / 17.0).abs() < 1e-15 && at(1e308).1 >= 0.0);
}

#[test]
fn refuses_tension_and_nonsense() {
    let m = DowsonHigginson::default().build().expect("builds");
    let (mut f, mut s) = ([0.0], [0.0]);
    for p in [-4e8, f64::NAN, f64::INFINITY] {
        assert!(m.factor(&[p], &mut f, &mut s).is_err_and(|e| e.is_recoverable()));
    }
    let soft = DowsonHigginson { a: quantity(2e-9), b: quantity(1e-9) };
    assert_eq!(soft.build().err().map(|e| e.field), Some("a".into()));
}

#[test]
fn density_may_double_and_no_more() {
    // a = b: (1 + 2 b p)/(1 + b p), which tends to 2.
    let twice =
        DowsonHigginson { a: quantity(1e-9), b: quantity(1e-9) }.build().expect("the limit is allowed");
    let (mut f, mut s) = ([0.0; 3], [0.0; 3]);
    twice.factor(&[0.0, 1e9, 1e300], &mut f, &mut s).expect("in range");
    // Rounding of three operations.
    assert!(f.iter().zip([1.0, 1.5, 2.0]).all(|(f, want)| (f - want).abs() < 1e-15), "{f:?}");
    let more = DowsonHigginson { a: quantity(1e-9 * (1.0 + 1e-12)), b: quantity(1e-9) };
    assert!(more.build().is_err());
}
