//! The orifice law: values with many digits, limits, derivatives, errors.

use gudgeon_core::quantity::quantity;
use gudgeon_gas::{
    FlowFunction, FlowPartials, GasState, MIN_DROP, Orifice, OrificeFormula, OrificeLaw, TRUNCATED_RATIO,
    critical_ratio,
};

use crate::support::{Lcg, R};

fn side(p: f64, t: f64) -> GasState {
    GasState::new(p, R * t)
}

fn law(orifice: Orifice) -> OrificeLaw {
    orifice.build(1.4, 287.0).expect("builds")
}

fn bare(law: OrificeFormula) -> Orifice {
    Orifice { laminar: quantity(0.0), law, ..Orifice::default() }
}

// Computed with 50 digits from the closed form.
const CRITICAL: [(f64, f64, f64); 5] = [
    (1.4, 0.528281787717174106343528, 0.6847314563772703752971445),
    (1.35, 0.5368512183915568941465116, 0.6761448751411428996746332),
    (1.3, 0.545727733814064765935317, 0.6672623512408615719146144),
    (1.25, 0.5549289573066436349472472, 0.6580647917517493138173789),
    (5.0 / 3.0, 0.4871392896287467388045943, 0.7261843774138906659711123),
];
const PSI: [(f64, f64, f64); 20] = [
    (1.3, 0.0, 0.6672623512408615719146144),
    (1.3, 0.3, 0.6672623512408615719146144),
    (1.3, 0.5, 0.6672623512408615719146144),
    (1.3, 0.6, 0.6627125593389742694186967),
    (1.3, 0.75, 0.5979936170815713352817154),
    (1.3, 0.9, 0.4207473268571404999237088),
    (1.3, 0.95, 0.3069910379845298634070404),
    (1.3, 0.99, 0.1406034495108536560026962),
    (1.3, 0.999, 0.04469555242273978439012564),
    (1.3, 0.9999, 0.01414131971124154406748229),
    (1.4, 0.0, 0.6847314563772703752971445),
    (1.4, 0.3, 0.6847314563772703752971445),
    (1.4, 0.5, 0.6847314563772703752971445),
    (1.4, 0.6, 0.6769152528627222433809425),
    (1.4, 0.75, 0.6051546440529365430427052),
    (1.4, 0.9, 0.4225808638186363735445288),
    (1.4, 0.95, 0.307641100392039075574277),
    (1.4, 0.99, 0.1406617026042444210249625),
    (1.4, 0.999, 0.04469739525840761879079185),
    (1.4, 0.9999, 0.01414137798902830912687109),
];

#[test]
fn high_precision_table() {
    for (gamma, r_c, psi_c) in CRITICAL {
        let f = FlowFunction::new(gamma).expect("gamma");
        assert!((critical_ratio(gamma) / r_c - 1.0).abs() < 1e-15);
        assert!((1.0 - f.choking_drop() - r_c).abs() < 2e-16);
        // A few roundings.
        assert!((f.psi_exact(1.0) / psi_c - 1.0).abs() < 1e-15);
    }
    for (gamma, r, psi) in PSI {
        let f = FlowFunction::new(gamma).expect("gamma");
        // 1 - r carries an absolute rounding of 1e-16, half of it relative in the root of u >= 1e-4.
        assert!((f.psi_exact(1.0 - r) / psi - 1.0).abs() < 1e-12, "{gamma} {r}");
        assert!((f.psi(1.0 - r) / psi - 1.0).abs() < 2e-9, "{gamma} {r}");
    }
}

#[test]
fn fast_form_for_any_gamma() {
    let mut worst = 0.0f64;
    for k in 0..=66 {
        let gamma = (1.01 + 0.01 * f64::from(k)).min(5.0 / 3.0);
        let f = FlowFunction::new(gamma).expect("gamma");
        for i in 1..=2000 {
            // Denser towards zero.
            let u = (f64::from(i) / 2000.0).powi(2);
            worst = worst.max((f.psi(u) / f.psi_exact(u) - 1.0).abs());
        }
    }
    assert!(worst < 2e-9, "{worst:e}");
    for gamma in [1.0 + 1e-12, 1.0001, 2.0] {
        let f = FlowFunction::new(gamma).expect("gamma");
        for u in [1e-12, 1e-3, 0.3, 0.5, 1.0] {
            assert!((f.psi(u) / f.psi_exact(u) - 1.0).abs() < 2e-8, "{gamma} {u}");
        }
    }
    // The isothermal limit: ψ = r sqrt(-2 ln r), critical ratio 1/sqrt(e).
    let f = FlowFunction::new(1.0 + 1e-12).expect("gamma");
    assert!((f.choking_drop() - (1.0 - (-0.5f64).exp())).abs() < 1e-12);
    assert!((f.psi_exact(0.1) - 0.9 * (-2.0 * 0.9f64.ln()).sqrt()).abs() < 1e-12);
    for gamma in [1.0, 0.9, 2.5, f64::NAN, f64::INFINITY] {
        assert!(FlowFunction::new(gamma).is_err());
    }
}

#[test]
fn continuous_with_zero_slope_at_choking() {
    for eps in [f64::MIN_POSITIVE, 1e-3] {
        for (gamma, ..) in CRITICAL {
            let f = FlowFunction::new(gamma).expect("gamma");
            let (uc, d) = (f.choking_drop(), 1e-6);
            let psi = |u: f64| f.psi_laminar(u, eps);
            let (below, at, above) = (psi(uc - d), psi(uc), psi(uc + d));
            // The curvature of ψ is about -3, so the parabola falls by 2e-12 over d; the laminar factor has the slope ε/2u²;
            // the interpolation error 1e-9 of ψ has a slope of at most 9² 1e-9/u_c by Markov's inequality.
            let slope = eps / (2.0 * uc * uc) + 81.0 * 1e-9 / uc * 2.0;
            assert!((at - below).abs() < 1e-11 + slope * d && (above - at).abs() < 1e-11 + slope * d);
            // One-sided derivatives agree: C1.
            let jump = ((above - at) - (at - below)).abs() / d;
            assert!(jump < 5e-6 + 81.0 * 2e-9 / uc, "{gamma} {jump:e}");
        }
    }
}

#[test]
fn the_root_goes_over_to_a_parabola_near_equal_pressures() {
    let bare = FlowFunction::new(1.3).expect("gamma");
    for (f, least) in [(bare.clone(), MIN_DROP), (bare.clone(), 1e-5), (bare.clone(), 1e-12)] {
        let f = if least == MIN_DROP { f } else { f.with_least_drop(least) };
        let least = least.max(MIN_DROP);
        for eps in [0.0, 0.3 * least, 2.0 * least] {
            let psi = |x: f64| f.psi_laminar_derivative(x * least, eps);
            for x in [1e-6, 0.1, 0.5, 0.999, 1.001, 3.0] {
                // Differences of second order over a thousandth of the place, 1e-6; next to the corner of the second derivative half a thousandth.
                let d = 1e-3 * x;
                let slope = (f.psi_laminar((x + d) * least, eps) - f.psi_laminar((x - d) * least, eps))
                    / (2.0 * d * least);
                assert!((slope / psi(x).1 - 1.0).abs() < 5e-4, "{least:e} {eps:e} {x}");
                assert_eq!(psi(x).0, f.psi_laminar(x * least, eps));
            }
            assert_eq!(psi(0.0).0, 0.0);
        }
        // No higher than 3/2 of the derivative of the root at the least drop, doubled; above it the root itself.
        let (_, steepest) = f.psi_laminar_derivative(0.0, 0.0);
        assert!((steepest / (1.5 / least.sqrt() * f.psi(least) / least.sqrt()) - 1.0).abs() < 1e-3);
        assert_eq!(f.psi_laminar(2.0 * least, 0.0), f.psi(2.0 * least));
    }
}

#[test]
fn published_values_of_the_truncated_form() {
    let law = law(bare(OrificeFormula::IsentropicTruncated));
    let (a, b) = (500.0, 400.0);
    for (p_a, p_b, flow) in [
        (1e6, 7e5, 1.449135749e-4),
        (1e6, 5.3e5, 1.554497283e-4),
        (1e6, 1e5, 1.555683641e-4),
        (7e5, 1e6, -1.620183022e-4),
    ] {
        let f = law.flow(1e-7, &side(p_a, a), &side(p_b, b));
        // Ten digits are known.
        assert!((f / flow - 1.0).abs() < 5e-10, "{f:e} {flow:e}");
    }
    // The two pieces do not meet: 0.076 %.
    let jump = law.flow(1e-7, &side(1e6, a), &side(0.53e6 - 1.0, b))
        / law.flow(1e-7, &side(1e6, a), &side(0.53e6, b))
        - 1.0;
    assert!((jump - 7.6e-4).abs() < 0.1e-4, "{jump}");
    assert_eq!(law.flow(1e-7, &side(1e6, a), &side(1e6, b)), 0.0);
}

#[test]
fn published_values_of_the_isentropic_form() {
    let law = law(bare(OrificeFormula::Isentropic));
    let t = 473.15;
    for (p, flow) in [(4e5, 1.45418e-4), (8e5, 1.19069e-4), (9.9e5, 2.98728e-5)] {
        let f = law.flow(9.1e-8, &side(1e6, t), &side(p, t));
        // Six digits are known.
        assert!((f / flow - 1.0).abs() < 4e-6, "{f:e}");
    }
}

#[test]
fn antisymmetric_monotone_and_finite() {
    let mut rng = Lcg(1);
    for formula in [OrificeFormula::Isentropic, OrificeFormula::IsentropicTruncated] {
        for eps in [0.0, 1e-3, 0.1] {
            let law = law(Orifice { law: formula, laminar: quantity(eps), ..Orifice::default() });
            for _ in 0..2000 {
                let p_a = 10f64.powf(2.0 + 6.0 * rng.next());
                let p_b = p_a * 10f64.powf(-6.0 * rng.next().powi(3));
                let (a, b) = (side(p_a, 300.0 + 500.0 * rng.next()), side(p_b, 300.0 + 500.0 * rng.next()));
                let f = law.flow(1e-7, &a, &b);
                assert!(f.is_finite() && f >= 0.0);
                assert_eq!(law.flow(1e-7, &b, &a), if f == 0.0 { law.flow(1e-7, &b, &a) } else { -f });
                // More back pressure, not more flow. The polynomial's ripple at the flat top is 2e-9; the truncated form jumps
                // the other way.
                let less = law.flow(1e-7, &a, &b.with_pressure(p_b + 0.01 * (p_a - p_b)));
                assert!(less <= f * (1.0 + 4e-9));
                let exact = law.flow_exact(1e-7, &a, &b);
                if formula == OrificeFormula::Isentropic {
                    assert!((f - exact).abs() <= 2e-9 * exact, "{f} {exact}");
                } else {
                    assert_eq!(f, exact);
                }
            }
            assert_eq!(law.flow(1e-7, &side(1e5, 300.0), &side(1e5, 400.0)), 0.0);
            assert_eq!(law.flow(1e-7, &side(0.0, 300.0), &side(0.0, 400.0)), 0.0);
            assert!(law.flow(1e-7, &side(1e5, 300.0), &side(0.0, 400.0)).is_finite());
            assert_eq!(law.flow(0.0, &side(2e5, 300.0), &side(1e5, 400.0)), 0.0);
        }
    }
}

/// Derivative by central differences of fourth order, and what it cannot resolve.
fn central(f: impl Fn(f64) -> f64, x: f64, d: f64) -> (f64, f64) {
    let (near, far) = (f(x + d) - f(x - d), f(x + 2.0 * d) - f(x - 2.0 * d));
    let slope = (8.0 * near - far) / (12.0 * d);
    // Eight roundings of the values, divided by d.
    (slope, 8.0 * f64::EPSILON * f(x).abs() / d)
}

#[test]
fn partials_agree_with_differences() {
    let mut rng = Lcg(3);
    let (mut choked, mut laminar, mut reversed) = (0, 0, 0);
    for formula in [OrificeFormula::Isentropic, OrificeFormula::IsentropicTruncated] {
        for eps in [0.0, 1e-3, 0.1] {
            let law = law(Orifice { law: formula, laminar: quantity(eps), ..Orifice::default() });
            for k in 0..3000 {
                let p = 10f64.powf(4.0 + 3.0 * rng.next());
                // Drops from 1e-6 to nearly everything, evenly in their logarithm, in both directions.
                let u = 10f64.powf(-6.0 * rng.next());
                let (mut a, mut b) =
                    (side(p, 300.0 + 500.0 * rng.next()), side(p * (1.0 - u), 300.0 + 500.0 * rng.next()));
                if k % 2 == 1 {
                    (a, b) = (b, a);
                    reversed += 1;
                }
                let critical = match formula {
                    OrificeFormula::Isentropic => law.flow_function().choking_drop(),
                    OrificeFormula::IsentropicTruncated => 1.0 - TRUNCATED_RATIO,
                };
                choked += i32::from(u > critical);
                laminar += i32::from(u < eps);
                // A step of 2e-3 of the distance to the nearest singularity (equal pressures, the linear branch at ε, choking):
                // the error of fourth order is below 4e-12 times a derivative of fifth order scaled with that distance.
                let d = 1e-3 * p * u.min(1.0 - u).min((u - critical).abs());
                if d < 1e-9 * p {
                    continue;
                }
                for bare in [false, true] {
                    let flow = |a: &GasState, b: &GasState| {
                        if bare { law.flow_bare(1e-7, a, b) } else { law.flow(1e-7, a, b) }
                    };
                    let partials = if bare {
                        law.flow_bare_partials(1e-7, &a, &b)
                    } else {
                        law.flow_partials(1e-7, &a, &b)
                    };
                    assert_eq!(partials.flow, flow(&a, &b));
                    let (by_a, noise_a) = central(|p| flow(&a.with_pressure(p), &b), a.pressure(), d);
                    let (by_b, noise_b) = central(|p| flow(&a, &b.with_pressure(p)), b.pressure(), d);
                    // The drop itself is rounded to 1e-16 of p: 1e-16 p ∂²ṁ/∂p² at most, which is below slope 1e-16/u,
                    // and in each difference below slope 1e-16 p / d.
                    let size = partials.by_a.abs().max(partials.by_b.abs());
                    let rounding = 8.0 * f64::EPSILON * p / d * size;
                    for (is, by, noise) in [(partials.by_a, by_a, noise_a), (partials.by_b, by_b, noise_b)] {
                        assert!(
                            (is - by).abs() <= 1e-9 * size + noise + rounding,
                            "{formula:?} {eps} {bare} u {u:e}: {is:e} {by:e}"
                        );
                    }
                    // More pressure on its own side, more flow, always.
                    assert!(partials.by_a >= 0.0);
                }
            }
        }
    }
    assert!(choked > 500 && laminar > 1000 && reversed > 1000, "{choked} {laminar} {reversed}");
}

#[test]
fn partials_at_equal_pressures() {
    let (p, t) = (2e5, 400.0f64);
    let c = 0.86 * 1e-7 / (287.0 * t).sqrt();
    for eps in [1e-3f64, 0.1] {
        let law = law(Orifice { laminar: quantity(eps), ..Orifice::default() });
        let s = law.flow_partials(1e-7, &side(p, t), &side(p, t));
        // ψ_ε -> u sqrt(2/ε); the fast form of ψ is right within 2e-9.
        let slope = c * (2.0 / eps).sqrt();
        assert_eq!(s.flow, 0.0);
        assert!((s.by_a / slope - 1.0).abs() < 2e-9 && s.by_b == -s.by_a);
    }
    // The bare laws: infinite, given as at u = 1e-8, where ψ = sqrt(2u); the next term of ψ is of the order u. The parabola of the isentropic one starts with 3/2 of the slope
    // of the chord, which is twice the derivative of the root.
    for (formula, wanted) in [(OrificeFormula::Isentropic, 3.0), (OrificeFormula::IsentropicTruncated, 1.0)] {
        let law = law(bare(formula));
        let at = (side(p, t), side(p, t));
        for (s, wanted) in [
            (law.flow_partials(1e-7, &at.0, &at.1), wanted),
            (law.flow_bare_partials(1e-7, &at.0, &at.1), 1.0),
        ] {
            let ratio = s.by_a / (c * (0.5 / MIN_DROP).sqrt());
            assert!(
                (ratio / wanted - 1.0).abs() < 1e-7 && s.by_b == -s.by_a && s.flow == 0.0,
                "{s:?} {ratio}"
            );
        }
    }
    let law = law(Orifice::default());
    assert_eq!(law.flow_partials(1e-7, &side(0.0, t), &side(0.0, t)), FlowPartials::default());
}

#[test]
fn laminar_branch_is_linear() {
    let eps = 1e-3f64;
    let law = law(Orifice { laminar: quantity(eps), ..Orifice::default() });
    let (p, t) = (1e6, 450.0f64);
    // ψ_ε -> u sqrt(2/ε) for u << ε.
    let slope = 0.86 * 1e-7 * p / (287.0 * t).sqrt() * (2.0 / eps).sqrt();
    for u in [1e-12, 1e-9, 1e-7] {
        let f = law.flow(1e-7, &side(p, t), &side(p * (1.0 - u), t));
        // 1 - u is rounded to 1e-16; the next term is u/2ε.
        assert!((f / (slope * u) - 1.0).abs() < 2e-9 + 1.2e-16 / u + u / eps, "{u}");
    }
}

#[test]
fn refuses_impossible_constants() {
    let o = Orifice { discharge: quantity(1.5), ..Orifice::default() };
    assert_eq!(o.build(1.4, 287.0).expect_err("above 1").field, "discharge");
    assert!(Orifice::default().build(1.4, 0.0).is_err());
}
