//! The tangent law with radians.

use gudgeon_core::geometry::FlankOil;
use gudgeon_core::kinds::{FlankCtx, FlankSpec};
use gudgeon_ring::TangentRadians;

#[test]
fn factor_at_the_flanks_and_in_the_middle() {
    for (oil_fill, factor) in [(0.6, 9.2), (0.9, 2.4)] {
        let ctx = FlankCtx::new(0, 3, oil_fill, 4e-3, 0.008);
        let m = TangentRadians::default().build(&ctx).expect("builds").law();
        let force = |e: f64, v: f64| m.force(&FlankOil::default(), e * 1e-4, v, 1e-4, 1.2e-3);
        // Circumference 0.3 m, μ v F_a0 = 8000 N/m at 1 m/s. The factor is printed with two digits.
        let at_flank = force(0.0, 1.0) / (-0.3 * 0.008 * 1e6);
        assert!((at_flank - factor).abs() < 0.051, "{at_flank}");
        assert!((force(0.0, 1.0) - force(1.0, 1.0)).abs() <= 1e-12 * force(0.0, 1.0).abs());
        assert_eq!(force(0.5, 1.0), 0.0);
        assert_eq!(force(0.3, 1.0), -force(0.3, -1.0));
        assert!(force(0.2, 1.0) < 0.0, "opposes the motion");
    }
}
