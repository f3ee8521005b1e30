//! Squeeze films on the flanks.

use gudgeon_core::geometry::FlankOil;
use gudgeon_core::kinds::{FlankCtx, FlankLaw, FlankSpec};
use gudgeon_core::quantity::quantity;
use gudgeon_ring::SqueezeFilm;

const C: f64 = 1e-4;
const A: f64 = 1.8e-3;

fn ctx() -> FlankCtx {
    FlankCtx::new(0, 3, 0.6, 5e-3, 0.01)
}

fn built(spec: &SqueezeFilm) -> Box<dyn FlankLaw> {
    spec.build(&ctx()).expect("builds").law()
}

#[test]
fn mirrored_passive_and_continuous() {
    let m = built(&SqueezeFilm::default());
    for k in -2..=52 {
        let s = C * k as f64 / 50.0;
        for v in [1e-9, 1e-6, 1e-3, 1.0] {
            let up = m.force(&FlankOil::default(), s, v, C, A);
            let down = m.force(&FlankOil::default(), s, -v, C, A);
            assert!(up < 0.0 && down > 0.0, "opposes the motion");
            let mirrored = -m.force(&FlankOil::default(), C - s, -v, C, A);
            // C - s is off by 1e-20 m, against the smallest gap of 0.4 µm, cubed.
            assert!((up - mirrored).abs() <= 1e-12 * up.abs(), "{up} {mirrored}");
        }
        assert_eq!(m.force(&FlankOil::default(), s, 0.0, C, A), 0.0);
    }
}

#[test]
fn tension_is_limited_approach_is_not() {
    let m = built(&SqueezeFilm::default());
    // Drawn off the lower flank: 1 bar on the wetted 60 % of 18 cm² is 108 N, and the upper film 0.1 mm away adds
    // μ A w² f³ v/c³ = 9.7e-11/1e-12·v, at 1e-3 m/s 0.1 N.
    let pull = -m.force(&FlankOil::default(), 0.0, 1e-3, C, A);
    assert!(pull > 107.0 && pull < 108.2, "{pull}");
    assert!(m.force(&FlankOil::default(), 0.0, -1e-3, C, A) > 1e4);
    // Without separation the film above the ring is the only resistance.
    let free = built(&SqueezeFilm { separation: quantity(0.0), ..SqueezeFilm::default() });
    let expected = 0.01 * A * 25e-6 * 0.216 * 1e-3 / (C + 0.4e-6).powi(3);
    assert!((-free.force(&FlankOil::default(), 0.0, 1e-3, C, A) / expected - 1.0).abs() < 1e-12);
}

#[test]
fn massless_fall_follows_the_closed_form() {
    // W = μ L³ (A/w) h'/h³ integrates to t = μ A w² f³/(2 W) (1/h2² - 1/h1²), h = s + σ. A massless ring far from the upper flank;
    // the separating film above is off.
    let spec = SqueezeFilm { separation: quantity(0.0), ..SqueezeFilm::default() };
    let m = built(&spec);
    let (load, sigma) = (50.0, 0.4e-6);
    let k = 0.01 * A * 25e-6 * 0.216;
    let (h1, h2): (f64, f64) = (2e-5, 1e-6);
    let exact = k / (2.0 * load) * (h2.powi(-2) - h1.powi(-2));
    // Integrate dt = dh / v in ln h by Simpson's rule, v from the model's force (linear while approaching).
    let n = 4000;
    let (a, b) = (h2.ln(), h1.ln());
    let step = (b - a) / n as f64;
    let f = |x: f64| {
        let h = x.exp();
        h * m.force(&FlankOil::default(), h - sigma, -1.0, C, A) / load
    };
    let t: f64 = (0..=n)
        .map(|i| {
            let w = if i == 0 || i == n {
                1.0
            } else if i % 2 == 1 {
                4.0
            } else {
                2.0
            };
            w * f(a + step * i as f64)
        })
        .sum::<f64>()
        * step
        / 3.0;
    // Simpson's error for exp(-2x) over steps of 7.5e-4 is (2·7.5e-4)^4/180 ~ 3e-14; the rest is rounding of h - σ + σ.
    assert!((t / exact - 1.0).abs() < 1e-11, "{t} {exact}");
}
