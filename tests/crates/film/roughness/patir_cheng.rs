//! Flow factors of Patir and Cheng.

use gudgeon_core::quantity::quantity;
use gudgeon_numerics::quadrature::GaussLegendre;

use super::{both, slopes_are_continuous};
use gudgeon_core::kinds::{Roughness, RoughnessSpec};
use gudgeon_film::parts::patir_cheng::{BLEND, GRADIENT_BLEND, sliding_stress};
use gudgeon_film::{PatirCheng, Pattern};

const SIGMA: f64 = 0.5e-6;

// H = 2, γ = 1.
const PHI_X: f64 = 0.706_348_184_839_264_4;
const CONTENT: f64 = 2.008_490_702_616_829_7;
const PHI_S: f64 = 0.726_593_335_636_420_9;
const PHI_F: f64 = 1.745_975_092_323_876_6;
const PHI_FS: f64 = 0.732_065_780_792_155_1;
const PHI_FP: f64 = 0.626_010_577_247_809_5;

fn spec(liner: f64, body: f64, pattern: Pattern) -> PatirCheng {
    PatirCheng {
        liner_roughness: quantity(liner * SIGMA),
        body_roughness: quantity(body * SIGMA),
        pattern,
        liner_pattern: None,
        body_pattern: None,
    }
}

fn model(liner: f64, body: f64, pattern: Pattern) -> Box<dyn Roughness> {
    spec(liner, body, pattern).build().expect("builds")
}

#[test]
fn pieces_of_the_shear_flow_meet() {
    for p in Pattern::ALL {
        let c = p.constants();
        let miss = c.shear_flow_near(5.0) / c.shear_flow_far(5.0) - 1.0;
        // The four-digit constants of both pieces were fitted to meet: 0.08 % is what their rounding leaves.
        assert!(miss.abs() < 8.5e-4, "{p:?}: {miss:e}");
        // The blend stays between the pieces, which are apart by their slopes times half a unit.
        for gap in [4.6, 5.0, 5.4] {
            let (a, b, f) = (c.shear_flow_near(gap), c.shear_flow_far(gap), c.shear_flow(gap));
            assert!(f >= a.min(b) && f <= a.max(b), "{p:?} {gap}");
        }
    }
}

#[test]
fn pressure_flow_vanishes_where_the_constants_say() {
    // Zero of 1 - C exp(-r H): ln C / r = 0.93, 0.77, 0.39, below the validity limit and below where the film ends.
    for (p, zero) in [(Pattern::Ninth, 0.93), (Pattern::Sixth, 0.77), (Pattern::Third, 0.39)] {
        let c = p.constants();
        let at = c.c.ln() / c.r;
        // Half a unit of the second decimal.
        assert!((at - zero).abs() < 0.0051, "{p:?}: {at}");
        assert!(c.pressure_flow(at).abs() < 1e-15 && at < c.limit - BLEND);
    }
}

#[test]
fn constants_follow_an_independent_fit() {
    // Functions of γ from a public program (R. Boman, EHD, flow factors after Patir and Cheng), which were fitted to the same
    // tables: they leave 1 % of C for γ <= 1, 5 % above, and 0.5 % of r.
    for p in Pattern::ALL {
        let (c, g) = (p.constants(), p.gamma());
        let (cx, rx) = if g <= 1.0 {
            (0.89679 - 0.26591 * g.ln(), 0.43006 - 0.10828 * g + 0.23821 * g * g)
        } else {
            (-0.10667 + 0.1075 * g, 1.5)
        };
        assert!((c.c / cx - 1.0).abs() < if g <= 1.0 { 0.01 } else { 0.05 }, "C {p:?}");
        assert!((c.r / rx - 1.0).abs() < 0.005, "r {p:?}");
    }
}

#[test]
fn listed_values() {
    // The equations with the constants of the tables, evaluated apart with 30 digits.
    let (flow, shear) = both(&*model(1.0, 0.0, Pattern::One), 2.0 * SIGMA);
    let pairs = [
        (flow.phi_x[0], PHI_X),
        (flow.content[0] / SIGMA, CONTENT),
        ((flow.transport[0] - flow.content[0]) / SIGMA, PHI_S),
        (shear.phi_f[0], PHI_F),
        (-shear.phi_fs[0], PHI_FS),
        (shear.phi_fp[0], PHI_FP),
    ];
    for (i, (got, listed)) in pairs.into_iter().enumerate() {
        // Rounding of exponentials, and of the sum of transport and content.
        assert!((got / listed - 1.0).abs() < 4e-15, "{i}: {got} {listed}");
    }
}

#[test]
fn stress_of_sliding_is_the_average_of_the_inverse_film() {
    let rule = GaussLegendre::new(40);
    for z in [1.02, 1.3, 2.0, 2.99, 3.0, 3.01, 5.0, 30.0, 1e3] {
        // ∫ 35/32 (1 - t²)³ z/(z + t) dt; towards t = -1 by dyadic stretches, where the kernel is steep for z near 1.
        let f = |s: f64| {
            let t = s - 1.0;
            35.0 / 32.0 * (1.0 - t * t).powi(3) * z / (z + t)
        };
        let mut sum = rule.integrate(0.0, 2.0 * 0.5f64.powi(20), f);
        sum += (0..20).map(|k| 0.5f64.powi(k)).map(|w| rule.integrate(w, 2.0 * w, f)).sum::<f64>();
        // The closed form loses up to 3e-13 just below z = 3.
        assert!((sliding_stress(z) / sum - 1.0).abs() < 5e-13, "{z}: {} {sum}", sliding_stress(z));
    }
    // Where the closed form has lost every digit: 1 + 1/(9 z²).
    assert!((sliding_stress(1e4) - 1.0 - 1e-8 / 9.0).abs() < 3e-16);
    assert_eq!(sliding_stress(1e200), 1.0);
}

#[test]
fn pieces_of_the_sliding_stress_meet() {
    // Both at z = 1: 35/32 · 16/15, and the slope of z² P(z) there is the same; the cube vanishes with two derivatives.
    for z in [1.0, 1.0f64.next_up()] {
        assert!((sliding_stress(z) - 7.0 / 6.0).abs() < 1e-15, "{z}");
    }
    let d = 1e-6;
    let (left, right) =
        (sliding_stress(1.0) - sliding_stress(1.0 - d), sliding_stress(1.0 + d) - sliding_stress(1.0));
    // Curvature of order one times d.
    assert!((left - right).abs() < 10.0 * d * d);
}

#[test]
fn thick_films_are_smooth() {
    for p in Pattern::ALL {
        let (flow, shear) = both(&*model(0.8, 0.6, p), 1e4 * SIGMA);
        // C H^-1.5 = 9e-7 at most; φ_f - 1 = 1/H² = 1e-8.
        assert!((flow.phi_x[0] - 1.0).abs() < 1e-6 && (flow.phi_y[0] - 1.0).abs() < 1e-6);
        assert!((flow.transport[0] / (1e4 * SIGMA) - 1.0).abs() < 1e-15);
        assert!((shear.phi_f[0] - 1.0).abs() < 1.1e-8 && shear.phi_fs[0] == 0.0);
        assert!((shear.phi_fp[0] - 1.0).abs() < 1e-15);
    }
}

#[test]
fn directions_and_sides() {
    let h = 2.3 * SIGMA;
    for p in Pattern::ALL {
        let (a, _) = both(&*model(1.0, 0.0, p), h);
        let (b, _) = both(&*model(1.0, 0.0, p.turned()), h);
        assert_eq!((a.phi_x[0], a.phi_y[0]), (b.phi_y[0], b.phi_x[0]));
        // Transverse ridges hinder the flow along, longitudinal ones help it.
        assert!(if p.gamma() <= 1.0 { a.phi_x[0] < 1.0 } else { a.phi_x[0] > 1.0 });
        // A rough liner carries more oil than a rough body, by as much as equal surfaces carry in between.
        let (body, on_body) = both(&*model(0.0, 1.0, p), h);
        let (liner, on_liner) = both(&*model(1.0, 0.0, p), h);
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let (equal, of_equal) = both(&*model(half, half, p), h);
        assert!(liner.transport[0] > equal.transport[0] && equal.transport[0] > body.transport[0]);
        assert_eq!(equal.transport[0], equal.content[0]);
        assert_eq!((on_body.phi_fs[0], of_equal.phi_fs[0]), (-on_liner.phi_fs[0], 0.0));
        // The smooth liner against a rough body is what φ_fs adds to.
        assert!(on_body.phi_fs[0] > 0.0);
    }
    // Surfaces of different pattern: half of each.
    let mixed = PatirCheng {
        liner_pattern: Some(Pattern::Nine),
        body_pattern: Some(Pattern::Ninth),
        ..spec(std::f64::consts::FRAC_1_SQRT_2, std::f64::consts::FRAC_1_SQRT_2, Pattern::One)
    };
    let (flow, shear) = both(&*mixed.build().expect("builds"), h);
    let (nine, ninth) = (Pattern::Nine.constants(), Pattern::Ninth.constants());
    let phi_s = 0.5 * (nine.shear_flow(2.3) - ninth.shear_flow(2.3));
    let phi_fs = 0.5 * (ninth.shear_stress(2.3) - nine.shear_stress(2.3));
    // Rounding of h/σ and of the shares.
    assert!(((flow.transport[0] - flow.content[0]) / SIGMA / phi_s - 1.0).abs() < 1e-13);
    assert!((shear.phi_fs[0] / phi_fs - 1.0).abs() < 1e-13);
}

#[test]
fn smooth_everywhere() {
    for p in Pattern::ALL {
        for (liner, body) in [(1.0, 0.0), (0.0, 1.0), (0.8, 0.6)] {
            let m = model(liner, body, p);
            let limit = p.constants().limit.max(p.turned().constants().limit);
            let at = |d: f64| (1.0 - d) / p.constants().gradient[0];
            // Where φ_fp is ±GRADIENT_BLEND: exp(-s H) = (1 ∓ 0.01)/D.
            let gradient = [-GRADIENT_BLEND, GRADIENT_BLEND].map(|d| -at(d).ln() / p.constants().gradient[1]);
            let joints = [
                limit - 2.0 * BLEND,
                limit - BLEND,
                limit,
                gradient[0],
                gradient[1],
                3.0,
                4.5,
                5.0,
                5.5,
                7.0,
                9.0,
                -0.7,
                0.0,
            ];
            slopes_are_continuous(&*m, SIGMA, &joints);
        }
    }
}

#[test]
fn never_negative_never_infinite() {
    for p in Pattern::ALL {
        for (liner, body) in [(1.0, 0.0), (0.0, 1.0), (0.8, 0.6)] {
            let m = model(liner, body, p);
            let h: Vec<f64> =
                (-400..2000).map(|i| 0.01 * f64::from(i)).chain([1e3, 1e9, 1e250, -1e250]).collect();
            for gap in h {
                let (flow, shear) = both(&*m, gap * SIGMA);
                let positive = [flow.film[0], flow.phi_x[0], flow.phi_y[0], shear.film[0], shear.phi_f[0]];
                assert!(positive.iter().all(|v| *v > 0.0 && v.is_finite()), "{p:?} {gap}: {positive:?}");
                let not_negative =
                    [flow.transport[0], flow.content[0], flow.content_derivative[0], shear.phi_fp[0]];
                assert!(
                    not_negative.iter().all(|v| *v >= 0.0 && v.is_finite()),
                    "{p:?} {gap}: {not_negative:?}"
                );
                assert!(shear.phi_fs[0].is_finite() && flow.content_derivative[0] <= 1.0 + 1e-15);
            }
        }
    }
}

#[test]
fn says_what_is_wrong() {
    let e = spec(0.0, 0.0, Pattern::One).build().expect_err("refused");
    assert_eq!(e.field, "liner_roughness");
    let tiny = PatirCheng { liner_roughness: quantity(1e-320), ..spec(0.0, 0.0, Pattern::One) };
    assert!(tiny.build().is_err());
    // Patterns between the tabulated ones are refused with the list.
    let text = "liner_roughness = 3e-7\nbody_roughness = 0.0\npattern = \"2\"\n";
    let e = toml::from_str::<PatirCheng>(text).expect_err("refused").to_string();
    assert!(["`1/9`", "`1/6`", "`1/3`", "`1`", "`3`", "`6`", "`9`"].iter().all(|p| e.contains(p)), "{e}");
}
