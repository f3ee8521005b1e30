//! A measured surface.

use gudgeon_contact::AbbottFirestone;
use gudgeon_core::kinds::{Contact, ContactSpec};
use gudgeon_core::quantity::quantity;

fn spec(rows: &[(f64, f64)]) -> AbbottFirestone {
    AbbottFirestone {
        height: rows.iter().map(|r| quantity(r.0)).collect(),
        material_ratio: rows.iter().map(|r| quantity(r.1)).collect(),
        hardness: quantity(2e9),
        friction_coefficient: quantity(0.1),
    }
}

fn pressure(m: &dyn Contact, h: f64) -> f64 {
    let mut p = [f64::NAN];
    m.pressure(&[h], &mut p);
    p[0]
}

/// Two rows are heights spread evenly, from any datum: the mean plane is the middle, and what is left between it and a plane follows by hand.
#[test]
fn heights_that_are_spread_evenly() {
    let m = spec(&[(7e-6, 1.0), (9e-6, 0.0)]).build().expect("builds");
    // Rounding of heights beside micrometres.
    assert!((m.range() - 1e-6).abs() < 1e-18);
    for (h, share, gap) in
        [(-1e-6, 1.0, 0.0), (0.0, 0.5, 0.25e-6), (0.5e-6, 0.25, 0.5625e-6), (1e-6, 0.0, 1e-6)]
    {
        assert!((pressure(&*m, h) / 2e9 - share).abs() < 1e-11, "{h}");
        assert!((m.mean_gap(h) - gap).abs() < 1e-17, "{h}: {}", m.mean_gap(h));
        let mut area = [f64::NAN];
        assert!(m.real_area(&[h], &mut area) && (area[0] - share).abs() < 1e-11);
    }
    assert_eq!((m.mean_gap(-3e-6), m.mean_gap(3e-6), pressure(&*m, 3e-6)), (0.0, 3e-6, 0.0));
    assert_eq!(pressure(&*m, -3e-6), 2e9);
}

/// The slope of the mean gap is the share of the surface that is lower.
#[test]
fn the_mean_gap_belongs_to_the_curve() {
    let rows = [(-4e-6, 1.0), (-1e-6, 0.97), (-0.3e-6, 0.8), (0.2e-6, 0.25), (0.6e-6, 0.02), (1.2e-6, 0.0)];
    let m = spec(&rows).build().expect("builds");
    let d = 1e-10;
    for k in -40..12 {
        let h = f64::from(k) * 1e-7 + 0.3e-8;
        let slope = (m.mean_gap(h + d) - m.mean_gap(h - d)) / (2.0 * d);
        // Rounding of gaps of micrometres over the step, and the third derivative of the gap times its square.
        assert!((slope - (1.0 - pressure(&*m, h) / 2e9)).abs() < 1e-6, "{h}: {slope}");
    }
}

#[test]
fn refusals_name_the_row() {
    let field = |rows: &[(f64, f64)]| spec(rows).build().expect_err("refused").field;
    assert_eq!(field(&[(0.0, 1.0)]), "height");
    assert_eq!(field(&[(0.0, 1.0), (0.0, 0.0)]), "height.1");
    assert_eq!(field(&[(0.0, 1.0), (1e-6, 0.2), (2e-6, 0.3), (3e-6, 0.0)]), "material_ratio.2");
    assert_eq!(field(&[(0.0, 0.9), (1e-6, 0.0)]), "material_ratio.0");
    assert_eq!(field(&[(0.0, 1.0), (1e-6, 0.1)]), "material_ratio.1");
    let mut short = spec(&[(0.0, 1.0), (1e-6, 0.0)]);
    short.material_ratio.pop();
    assert!(short.build().expect_err("refused").to_string().contains("1 shares beside 2"));
}
