//! Coefficients of the resistance, against the printed laws.

use gudgeon_core::geometry::{FlankOil, RingPlace};
use gudgeon_core::kinds::{Flank, FlankCtx, FlankSpec};
use gudgeon_core::quantity::quantity;
use gudgeon_ring::{Dry, SqueezeFilm, TangentDegrees, TangentRadians, WettedStrip};

const C: f64 = 7e-5;
const A: f64 = 1.8e-3;
const WIDTH: f64 = 5e-3;
const MU: f64 = 0.01;
const MU_GAS: f64 = 27e-6;
const SIGMA: f64 = 0.4e-6;
const CHI: f64 = 0.1;
const TENSION: f64 = 1e5;

fn ctx(fill: f64) -> FlankCtx {
    FlankCtx::new(0, 2, fill, WIDTH, MU).at_speed(200.0)
}

/// Random numbers between 0 and 1, the same in every run.
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1u64 << 53) as f64
}

/// A film `b` wide per circumference, as it is printed: `f = μ b³ v/H³` for an approach, `X/(1 + X/(p_t b))`, `X = χ μ b³ v/H³` for a separation.
fn film(mu: f64, chi: f64, b: f64, h: f64, rate: f64) -> f64 {
    let x = mu * (b / (h.max(0.0) + SIGMA)).powi(3) * rate;
    if rate >= 0.0 || b <= 0.0 { x } else { chi * x / (1.0 - chi * x / (TENSION * b)) }
}

/// A place and a velocity: slightly outside the groove to the other flank, and up to 10 m/s in both directions.
fn random_motion(seed: &mut u64) -> (f64, f64) {
    let s = C * (1.02 * random(seed) - 0.01);
    let v = 10.0_f64.powf(13.0 * random(seed) - 12.0);
    (s, if random(seed) < 0.5 { v } else { -v })
}

#[test]
fn strips_and_gas_resist_as_printed() {
    let mut seed = 5;
    for _ in 0..5000 {
        let (s, v) = random_motion(&mut seed);
        let mut width = || WIDTH * (1.1 * random(&mut seed) - 0.1).clamp(-0.05, 1.0);
        let oil = FlankOil { wetted: [width(), width()], open: [1.0; 2] };
        let [strips, none] = [
            WettedStrip::default().build(&ctx(0.3)).expect("builds").law(),
            Dry::default().build(&ctx(0.3)).expect("builds").law(),
        ];
        let flank = |b: f64, h: f64, rate: f64| {
            film(MU, CHI, b.max(0.0), h, rate) + film(MU_GAS, 1.0, WIDTH - b, h, rate)
        };
        let want = A / WIDTH * (flank(oil.wetted[0], s, -v) - flank(oil.wetted[1], C - s, v));
        let got = strips.force(&oil, s, v, C, A);
        // All terms have one sign: some ten roundings.
        assert!((got - want).abs() <= 1e-14 * want.abs(), "{oil:?} {s:e} {v:e}: {got:e} {want:e}");
        let gas = |h: f64, rate: f64| film(MU_GAS, 1.0, WIDTH, h, rate);
        let want = A / WIDTH * (gas(s, -v) - gas(C - s, v));
        let got = none.force(&oil, s, v, C, A);
        assert!((got - want).abs() <= 1e-14 * want.abs(), "{s:e} {v:e}: {got:e} {want:e}");
    }
}

#[test]
fn squeeze_films_resist_as_printed() {
    let (mut seed, fill) = (6, 0.6);
    let law = SqueezeFilm::default().build(&ctx(fill)).expect("builds").law();
    for _ in 0..5000 {
        let (s, v) = random_motion(&mut seed);
        let one = |h: f64, rate: f64| film(MU, CHI, fill * WIDTH, h, rate);
        let want = A / WIDTH * (one(s, -v) - one(C - s, v));
        let got = law.force(&FlankOil::default(), s, v, C, A);
        // As above.
        assert!((got - want).abs() <= 1e-14 * want.abs(), "{s:e} {v:e}: {got:e} {want:e}");
    }
}

#[test]
fn coefficients_tell_force_slope_and_bend() {
    let mut models: Vec<(Box<dyn Flank>, f64)> = Vec::new();
    for fill in [0.0, 0.3, 1.0] {
        models.push((Dry::default().build(&ctx(fill)).expect("builds"), fill));
        models.push((SqueezeFilm::default().build(&ctx(fill)).expect("builds"), fill));
        models.push((
            SqueezeFilm { separation: quantity(0.0), ..SqueezeFilm::default() }
                .build(&ctx(fill))
                .expect("builds"),
            fill,
        ));
        models.push((WettedStrip::default().build(&ctx(fill)).expect("builds"), fill));
        models.push((TangentDegrees::default().build(&ctx(fill)).expect("builds"), fill));
        models.push((TangentRadians::default().build(&ctx(fill)).expect("builds"), fill));
    }
    let mut seed = 8;
    for (model, fill) in &models {
        let law = model.law();
        for _ in 0..500 {
            let (s, v) = random_motion(&mut seed);
            let place = RingPlace { s, v, clearance: C, ..RingPlace::default() };
            let oil = model.oil(&[], &place);
            let r = law.resistance(&oil, s, C, A).expect("tells");
            let force = |v: f64| law.force(&oil, s, v, C, A);
            assert_eq!(r.force(v), force(v), "{fill} {s:e} {v:e}");
            let [value, slope, bend] = r.at(v);
            assert!(value >= 0.0 && slope >= 0.0 && bend <= 0.0, "opposes, grows, bends down");
            assert_eq!(law.force_and_damping(&oil, s, v, C, A), (force(v), slope));
            let d = 1e-4 * v;
            let [low, high] = [v - d, v + d].map(|v| r.at(v));
            // The third derivative is at most six times the resistance over the cube of the speed: 1e-8 of it; rounding over 1e-4 is less.
            let scale = value / v.abs();
            let by_difference = (high[0] - low[0]) / (2.0 * d.abs());
            assert!(
                (slope - by_difference).abs() <= 2e-8 * scale,
                "{s:e} {v:e}: {slope:e} {by_difference:e}"
            );
            let by_difference = (high[1] - low[1]) / (2.0 * d.abs());
            // The fourth, twenty-four times.
            assert!((bend - by_difference).abs() <= 1e-7 * scale / v.abs(), "{s:e} {v:e}: {bend:e}");
        }
    }
}
