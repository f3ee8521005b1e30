//! Viscosity under pressure after Barus.

use gudgeon_core::quantity::quantity;

use gudgeon_core::kinds::PiezoviscositySpec;
use gudgeon_film::Barus;

#[test]
fn exponential_with_its_slope() {
    let model = Barus { pressure_viscosity: quantity(2e-8) }.build().expect("builds");
    let p = [0.0, 5e7, 1e8, -1e5];
    let (mut f, mut s) = ([0.0; 4], [0.0; 4]);
    model.factor(0.01, &p, &mut f, &mut s).expect("finite");
    // e^1 and e^2: an ulp of the exponent.
    assert_eq!(f[0], 1.0);
    assert!(
        (f[1] / std::f64::consts::E - 1.0).abs() < 4e-16 && (f[2] / 7.389_056_098_930_65 - 1.0).abs() < 8e-16
    );
    for i in 0..4 {
        assert!((s[i] / (2e-8 * f[i]) - 1.0).abs() < 4e-16);
    }
}

#[test]
fn no_pressure_overflows() {
    let model = Barus { pressure_viscosity: quantity(1e3) }.build().expect("builds");
    let (mut f, mut s) = ([0.0; 3], [0.0; 3]);
    model.factor(0.01, &[1e306, -1e306, 1.0], &mut f, &mut s).expect("finite");
    assert!(
        f.iter().chain(&s).all(|v| v.is_finite() && *v >= 0.0) && f.iter().all(|v| *v > 0.0),
        "{f:?} {s:?}"
    );
    assert!(model.factor(0.01, &[f64::NAN; 3], &mut f, &mut s).is_err_and(|e| e.is_recoverable()));
}
