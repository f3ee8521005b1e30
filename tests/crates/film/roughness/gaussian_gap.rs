//! Average gap between Gaussian surfaces.

use gudgeon_film::parts::GaussianGap;

/// `G` by Gauss-Legendre rules of 30 nodes on stretches of one half.
fn quadrature(gap: f64) -> (f64, f64) {
    let rule = gudgeon_numerics::quadrature::GaussLegendre::new(30);
    let density = |s: f64| (-0.5 * s * s).exp() / std::f64::consts::TAU.sqrt();
    let (mut value, mut slope) = (0.0, 0.0);
    for k in 0..40 {
        let a = (-gap).max(-12.0) + 0.5 * f64::from(k);
        value += rule.integrate(a, a + 0.5, |s| (gap + s) * density(s));
        slope += rule.integrate(a, a + 0.5, density);
    }
    (value, slope)
}

#[test]
fn meets_the_quadrature() {
    let table = GaussianGap::new();
    let mut gap = -8.4;
    while gap < 9.0 {
        let ((g, s), (exact, slope)) = (table.at(gap), quadrature(gap));
        // Rounding of 40 sums of up to 9; the tail relative to itself as documented at TERMS.
        assert!(
            (g - exact).abs() < 1e-13 * exact.max(1e-3) + 4e-12 * exact * f64::from(gap < -4.0),
            "{gap}: {g} {exact}"
        );
        assert!((s - slope).abs() < 2e-13, "{gap}: {s} {slope}");
        gap += 0.0371;
    }
    // G(0) = 1/√(2π), G'(0) = ½: rounding only.
    let (g, s) = table.at(0.0);
    assert!((g - 1.0 / std::f64::consts::TAU.sqrt()).abs() < 2e-16 && (s - 0.5).abs() < 2e-16);
}

#[test]
fn far_away() {
    let table = GaussianGap::new();
    assert_eq!(table.at(1e300), (1e300, 1.0));
    assert_eq!(table.at(-1e300), (0.0, 0.0));
    assert_eq!(table.at(9.0), (9.0, 1.0));
    // The symmetry G(H) - G(-H) = H; at 8.4 to rounding.
    for gap in [0.3, 1.7, 4.4, 8.4] {
        assert!((table.at(gap).0 - table.at(-gap).0 - gap).abs() < 4e-15);
    }
}
