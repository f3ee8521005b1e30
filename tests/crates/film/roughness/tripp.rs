//! The expansion for rough surfaces of any pattern.

use gudgeon_core::kinds::{Roughness, RoughnessSpec};
use gudgeon_core::quantity::quantity;
use gudgeon_film::{PatirCheng, Pattern, SawtoothWaviness, Tripp, WavinessTransport};

use super::{both, slopes_are_continuous};

fn model(liner: f64, body: f64, gamma: f64) -> Box<dyn Roughness> {
    Tripp { liner_roughness: quantity(liner), body_roughness: quantity(body), pattern: quantity(gamma) }
        .build()
        .expect("builds")
}

/// Ridges across the sliding direction on the body have, to the order of `(σ/h)²`, the factors of triangular waves of that roughness, `σ = Ω/√3`, whose
/// average is exact.
#[test]
fn ridges_across_are_waves() {
    let omega = 3e-6;
    let sigma = omega / 3f64.sqrt();
    let waves = SawtoothWaviness {
        amplitude: quantity(omega),
        transport: WavinessTransport::Homogenised,
        closest: quantity(1.02),
    }
    .build()
    .expect("builds");
    let ridges = model(0.0, sigma, 1e-12);
    for ratio in [0.02, 0.05, 0.1] {
        let h = sigma / ratio;
        let ((f, s), (g, t)) = (both(&*ridges, h), both(&*waves, h));
        let pairs = [
            (f.phi_x[0], g.phi_x[0]),
            (f.phi_y[0], g.phi_y[0]),
            (f.transport[0] / h, g.transport[0] / h),
            (s.phi_f[0], t.phi_f[0]),
            (s.phi_fs[0], t.phi_fs[0]),
            (s.phi_fp[0], t.phi_fp[0]),
        ];
        for (k, (ours, exact)) in pairs.into_iter().enumerate() {
            // The next order: 36 - 9 = 27 for the pressure flow, less for the others.
            assert!((ours - exact).abs() < 30.0 * ratio.powi(4), "{k} at {ratio}: {ours} {exact}");
            // The bound is no match for the term that is tested.
            assert!(
                (exact - 1.0).abs() < 1e-12 || k == 4 || (exact - 1.0).abs() > 0.9 * ratio * ratio,
                "{k}"
            );
        }
    }
}

/// Ridges along the sliding direction: `φ_x = <h³>/h³ = 1 + 3/H²`, which is exact; sliding carries the film content and nothing else.
#[test]
fn ridges_along_have_the_mean_cube() {
    let m = model(0.3e-6, 0.4e-6, 1e12);
    for gap in [1.2, 3.0, 8.0] {
        let (f, s) = both(&*m, gap * 0.5e-6);
        // 3 D = 3e-12.
        assert!((f.phi_x[0] - 1.0 - 3.0 / (gap * gap)).abs() < 1e-11);
        assert!((f.transport[0] / f.content[0] - 1.0).abs() < 1e-11);
        assert!((s.phi_fp[0] - 1.0).abs() < 1e-11 && s.phi_fs[0].abs() < 1e-11);
    }
}

/// Surfaces without direction: the factors of Patir and Cheng are fits to numbers of a dozen rough surfaces, with a scatter of some per cent.
#[test]
fn without_direction_near_patir_and_cheng() {
    let tripp = model(0.4e-6, 0.3e-6, 1.0);
    let fit = PatirCheng {
        liner_roughness: quantity(0.4e-6),
        body_roughness: quantity(0.3e-6),
        pattern: Pattern::One,
        liner_pattern: None,
        body_pattern: None,
    }
    .build()
    .expect("builds");
    for gap in [3.0, 4.0, 6.0, 10.0] {
        let ((f, s), (g, t)) = (both(&*tripp, gap * 0.5e-6), both(&*fit, gap * 0.5e-6));
        assert!((f.phi_x[0] / g.phi_x[0] - 1.0).abs() < 0.06, "{gap}: {} {}", f.phi_x[0], g.phi_x[0]);
        // The next order of the drag, 3/H^4.
        assert!(
            (s.phi_f[0] / t.phi_f[0] - 1.0).abs() < 4.5 / gap.powi(4),
            "{gap}: {} {}",
            s.phi_f[0],
            t.phi_f[0]
        );
        assert_eq!(f.content, g.content);
    }
}

/// `∂h_T/∂h` against the fit of Wu and Zheng, `exp(-0.6912 + 0.782 H - 0.304 H² + 0.0401 H³)` for `0 <= H < 3`.
#[test]
fn the_contact_factor_of_wu_and_zheng() {
    let m = model(0.4e-6, 0.3e-6, 3.0);
    for k in 0..=30 {
        let gap = f64::from(k) / 10.0;
        let fit = (-0.6912 + gap * (0.782 + gap * (-0.304 + 0.0401 * gap))).exp();
        let factor = both(&*m, gap * 0.5e-6).0.content_derivative[0];
        // What four digits of a cubic leave.
        assert!((factor / fit - 1.0).abs() < 4e-3, "{gap}: {factor} {fit}");
    }
}

#[test]
fn continuous_and_finite_however_thin() {
    for gamma in [0.1, 1.0, 2.0, 9.0] {
        let m = model(0.4e-6, 0.3e-6, gamma);
        // Where the film of the factors begins to be held and where it has come to rest.
        slopes_are_continuous(&*m, 0.5e-6, &[0.8, 1.0]);
        for gap in [-1e9, -8.0, 0.0, 0.5, 1e9] {
            let (f, s) = both(&*m, gap * 0.5e-6);
            assert!(f.phi_x[0] > 0.0 && f.phi_y[0] > 0.0 && f.transport[0] >= 0.0);
            assert!(
                [f.phi_x[0], f.phi_y[0], s.phi_f[0], s.phi_fs[0], s.phi_fp[0]].iter().all(|v| v.is_finite())
            );
        }
        assert_eq!(m.held_below(), Some(0.5e-6));
    }
    let none =
        Tripp { liner_roughness: quantity(0.0), body_roughness: quantity(0.0), pattern: quantity(1.0) };
    assert_eq!(none.build().err().map(|e| e.field), Some("liner_roughness".into()));
}
