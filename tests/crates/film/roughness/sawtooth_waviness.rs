//! Waves on the body across the sliding direction.

use gudgeon_core::quantity::quantity;
use gudgeon_numerics::quadrature::GaussLegendre;

use super::{both, slopes_are_continuous};
use gudgeon_core::kinds::{Roughness, RoughnessSpec};
use gudgeon_film::parts::sawtooth_waviness::{SERIES, closest, excess};
use gudgeon_film::{SawtoothWaviness, WavinessTransport};

const OMEGA: f64 = 4e-6;

fn model(transport: WavinessTransport) -> Box<dyn Roughness> {
    SawtoothWaviness { amplitude: quantity(OMEGA), transport, closest: closest() }.build().expect("builds")
}

#[test]
fn listed_values() {
    // Flow and friction factors for Ω = 4 µm as printed by Loureiro's equations, seven decimals.
    let listed = [
        (10e-6, [1.16, 0.7056, 0.4, 1.0591223, 0.1773670, 0.84]),
        (6.5e-6, [1.3786982, 0.3860158, 0.6153846, 1.1660062, 0.4980185, 0.6213018]),
    ];
    for (h, [phi_y, phi_x, phi_s, phi_f, phi_fs, phi_fp]) in listed {
        let (flow, shear) = both(&*model(WavinessTransport::Homogenised), h);
        let got = [
            (flow.phi_y[0], phi_y),
            (flow.phi_x[0], phi_x),
            ((h - flow.transport[0]) / OMEGA, phi_s),
            (shear.phi_f[0], phi_f),
            (shear.phi_fs[0], phi_fs),
            (shear.phi_fp[0], phi_fp),
        ];
        for (got, listed) in got {
            // A unit of the last decimal: some are cut, not rounded.
            assert!((got - listed).abs() < 1e-7, "{h}: {got} {listed}");
        }
    }
}

#[test]
fn factors_are_the_averages() {
    let rule = GaussLegendre::new(60);
    for r in [1e-4, 0.01, 0.19, 0.21, 0.4, 0.6, 0.8] {
        let h = OMEGA / r;
        // The mean over an even spread of films; 60 nodes resolve (1 - 0.8 t)^-3 to rounding.
        let mean = |n: i32| 0.5 * rule.integrate(-1.0, 1.0, |t| (1.0 + r * t).powi(n));
        let (m1, m2, m3) = (mean(-1), mean(-2), mean(-3));
        let (flow, shear) = both(&*model(WavinessTransport::Homogenised), h);
        let pairs = [
            (flow.phi_x[0], 1.0 / m3),
            (flow.phi_y[0], mean(3)),
            (flow.transport[0] / h, m2 / m3),
            (shear.phi_f[0], m1),
            (shear.phi_fp[0], m2 / m3),
            (flow.content[0] / h, mean(1)),
        ];
        for (i, (got, exact)) in pairs.into_iter().enumerate() {
            // Sums of 60 terms of order one to 124.
            assert!((got - exact).abs() < 1e-13, "{i} at r = {r}: {got} {exact}");
        }
        // The difference of means cancels: the same absolute bound.
        assert!((shear.phi_fs[0] - 3.0 * (m1 - m2 * m2 / m3)).abs() < 3e-13, "{r}");
    }
}

#[test]
fn series_meets_the_closed_form() {
    // Rounding of 1e-16 over the excess 0.0135 at the joint.
    let (below, above) = (excess(SERIES.next_down()), excess(SERIES));
    assert!((below / above - 1.0).abs() < 3e-14, "{below} {above}");
    // r²/3 + r⁴/5 where the closed form has no digit left.
    assert!((excess(1e-7) / (1e-14 / 3.0) - 1.0).abs() < 1e-13);
    assert_eq!(excess(0.0), 0.0);
}

#[test]
fn every_way_of_computing_leads_to_the_same_function() {
    for k in 0..1000 {
        // Both sides of the places where the way of computing changes: from centre to centre, and at 0.947.
        let r = 1e-3 + 0.998 * f64::from(k) / 1000.0;
        let (got, exact) = (1.0 + excess(r), r.atanh() / r);
        // Two quotients, a series and the sum: some roundings.
        assert!((got / exact - 1.0).abs() < 2e-15, "{r}: {got} {exact}");
    }
}

#[test]
fn signs_of_the_transport() {
    let at = |t| both(&*model(t), 8e-6).0.transport[0];
    // h ∓ Ω²/h = 8 ∓ 2 µm, two roundings.
    assert!((at(WavinessTransport::Homogenised) - 6e-6).abs() < 4e-21);
    assert!((at(WavinessTransport::AsPublished) - 10e-6).abs() < 4e-21);
    assert_eq!(at(WavinessTransport::Smooth), 8e-6);
    // Thick films know nothing of it.
    let (flow, shear) = both(&*model(WavinessTransport::Homogenised), 1.0);
    assert!((flow.phi_x[0] - 1.0).abs() < 1e-9 && (flow.transport[0] - 1.0).abs() < 1e-9);
    assert!(shear.phi_fs[0] > 0.0 && shear.phi_fs[0] < 1e-9);
}

#[test]
fn content_is_the_average_gap() {
    let rule = GaussLegendre::new(4);
    for x in [-0.9, -0.3, 0.0, 0.5, 0.999, 1.0, 1.3] {
        // Mean of max(h + Ωt, 0) over -1 < t < 1, from where it opens: a polynomial of degree 1.
        let from = f64::max(-x, -1.0);
        let mean = 0.5 * rule.integrate(from, 1.0, |t| x + t);
        let (flow, _) = both(&*model(WavinessTransport::Smooth), x * OMEGA);
        assert!((flow.content[0] / OMEGA - mean).abs() < 1e-15, "{x}");
    }
}

#[test]
fn smooth_everywhere_and_never_negative() {
    for transport in
        [WavinessTransport::Homogenised, WavinessTransport::AsPublished, WavinessTransport::Smooth]
    {
        let m = model(transport);
        slopes_are_continuous(&*m, OMEGA, &[-1.0, 0.0, 1.0, 1.02, 1.04, 5.0]);
    }
    for h in [-1e300, -1.0, 0.0, 1e-300, 1e-9, 1e300] {
        let (flow, shear) = both(&*model(WavinessTransport::Homogenised), h);
        let values =
            [flow.film, flow.phi_x, flow.phi_y, flow.transport, shear.film, shear.phi_f, shear.phi_fp];
        assert!(values.iter().all(|v| v[0].is_finite() && v[0] > 0.0), "{h}: {values:?}");
        assert!(flow.content[0].is_finite() && flow.content[0] >= 0.0 && shear.phi_fs[0].is_finite());
    }
}

#[test]
fn an_amplitude_that_cannot_be_computed_with_is_refused() {
    let spec = SawtoothWaviness {
        amplitude: quantity(1e-200),
        transport: WavinessTransport::Homogenised,
        closest: closest(),
    };
    assert_eq!(spec.build().err().map(|e| e.field), Some("amplitude".into()));
}
