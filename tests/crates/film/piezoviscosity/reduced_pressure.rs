//! The reduced pressure against closed forms.

use std::sync::Arc;

use gudgeon_core::kinds::{Piezoviscosity, PiezoviscositySpec};
use gudgeon_core::quantity::quantity;
use gudgeon_film::parts::ReducedPressure;
use gudgeon_film::{Barus, Roelands};

#[test]
fn of_barus_is_the_closed_form() {
    let alpha = 2e-8;
    let law = Barus { pressure_viscosity: quantity(alpha) }.build().expect("builds");
    let mut r = ReducedPressure::new(Arc::from(law));
    r.set(0.01);
    for p in [-1e4, 1e3, 1e5, 2.5e6, 3e7, 1e8, 3e8] {
        let exact = if p < 0.0 { p } else { -f64::exp_m1(-alpha * p) / alpha };
        let reduced = r.of(p).expect("a pressure");
        // Rounding of a sum of up to a hundred steps.
        assert!((reduced / exact - 1.0).abs() < 1e-12, "{p}: {reduced} {exact}");
        let (back, f) = r.back(reduced).expect("the same");
        // Near its bound 1/alpha the reduced pressure tells the pressure to rounding times exp(alpha p).
        let lost = 1e-13 * (1.0 + (alpha * p).exp());
        assert!((back / p - 1.0).abs() < lost, "{p}: {back}");
        assert!(p < 0.0 || (f / (alpha * p).exp() - 1.0).abs() < lost * alpha * p + 1e-12, "{p}: {f}");
    }
    // Beyond a thickening of 1000, at 345 MPa, the oil keeps its viscosity to within a step of the ladder, 11 MPa there or a factor 1.25; the way there and
    // back stays one.
    let (far, f) = r.back(1.2 / alpha).expect("a pressure");
    assert!((1000.0..1250.0).contains(&f) && far > 1e9, "{f} {far}");
    assert!((r.of(far).expect("a pressure") * alpha / 1.2 - 1.0).abs() < 1e-12);
    assert!(r.back(1.3 / alpha).is_ok_and(|(more, same)| more > far && same == f));
}

#[test]
fn of_roelands_is_near_and_follows_the_viscosity() {
    let law = Roelands { exponent: Some(quantity(0.6)), pressure_viscosity: None }.build().expect("builds");
    let law: Arc<dyn Piezoviscosity> = Arc::from(law);
    let mut r = ReducedPressure::new(law.clone());
    for mu in [0.02, 0.004] {
        r.set(mu);
        // Simpson's rule on 1000 panels, its own error below 1e-12.
        let inverse = |p: f64| {
            let (mut f, mut s) = ([0.0], [0.0]);
            law.factor(mu, &[p], &mut f, &mut s).expect("a pressure");
            1.0 / f[0]
        };
        let p = 8e7;
        let panel = p / 1000.0;
        let exact: f64 = (0..1000)
            .map(|k| {
                let a = panel * f64::from(k);
                panel / 6.0 * (inverse(a) + 4.0 * inverse(a + 0.5 * panel) + inverse(a + panel))
            })
            .sum();
        let reduced = r.of(p).expect("a pressure");
        // As documented: ln f straight between rungs, 5e-5 of f at most, and of one sign.
        assert!((reduced / exact - 1.0).abs() < 5e-5, "{reduced} {exact}");
        let (back, f) = r.back(reduced).expect("the same");
        assert!((back / p - 1.0).abs() < 1e-12 && (f * inverse(p) - 1.0).abs() < 5e-5);
    }
}
