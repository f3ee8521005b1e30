//! Oils by their data sheet.

use gudgeon_core::kinds::{Oil, OilSpec};
use gudgeon_core::quantity::quantity;
use gudgeon_film::Walther;

const CELSIUS: f64 = 273.15;

fn spec(nu_cold: f64, nu_hot: f64) -> Walther {
    Walther {
        nu_cold: quantity(nu_cold),
        nu_hot: quantity(nu_hot),
        cold: quantity(40.0 + CELSIUS),
        hot: quantity(100.0 + CELSIUS),
        density: quantity(880.0),
        expansion: quantity(7e-4),
    }
}

fn oil(nu_cold: f64, nu_hot: f64) -> Box<dyn Oil> {
    spec(nu_cold, nu_hot).build().expect("an oil")
}

#[test]
fn the_equation_passes_through_its_points() {
    let o = oil(95.0, 10.7);
    for (celsius, nu) in [(40.0, 95.0), (100.0, 10.7)] {
        let t = CELSIUS + celsius;
        let exact = nu * 1e-6 * 880.0 * (1.0 - 7e-4 * (t - 288.15));
        // Two logarithms and two powers, each good to a few ulp; the double exponential magnifies by at most
        // nu ln(nu + 0.7) ln(10) w / nu, about 20.
        let value = o.viscosity(t);
        assert!((value / exact - 1.0).abs() < 1e-13, "{value} at {celsius} degC, exact {exact}");
    }
}

/// Independent numbers: mpmath with 30 digits, `A = w1 + B log10 T1`, `B = (w1 - w2)/(log10 T2 - log10 T1)`, `w = log10 log10(ν + 0.7)`,
/// `μ = 1e-6 (10^(10^(A - B log10 T)) - 0.7) 880 (1 - 7e-4 (T - 288.15))`.
#[test]
fn independent_numbers() {
    let o = oil(95.0, 10.7);
    for (celsius, mu) in REFERENCE {
        let value = o.viscosity(CELSIUS + celsius);
        // As above; at 0 degC the magnification is ln(10) w ln(nu + 0.7), about 40.
        assert!((value / mu - 1.0).abs() < 1e-12, "{value} at {celsius} degC, mpmath {mu}");
    }
}

const REFERENCE: [(f64, f64); 4] = [
    (0.0, 1.518825273371767),
    (60.0, 0.03231396251871721),
    (120.0, 0.005565168919167045),
    (180.0, 0.002073769990948671),
];

#[test]
fn no_temperature_gives_nonsense() {
    let o = oil(95.0, 10.7);
    let mut last = f64::INFINITY;
    for k in 1..=3000 {
        let mu = o.viscosity(f64::from(k));
        assert!(mu.is_finite() && mu > 0.0 && mu <= last, "{mu} Pa s at {k} K");
        last = mu;
    }
}

#[test]
fn what_is_no_oil_is_refused_at_its_place() {
    for (cold, hot, place) in [(10.0, 20.0, "nu_hot"), (0.2, 0.1, "nu_cold"), (50.0, 0.25, "nu_hot")] {
        let e = spec(cold, hot).build().expect_err("no oil");
        assert_eq!(e.field, place, "{cold} and {hot} mm2/s");
    }
    let e = Walther { hot: quantity(313.15), ..spec(95.0, 10.7) }.build().expect_err("one temperature");
    assert_eq!(e.field, "hot");
}
