//! Grooves without oil.

use gudgeon_core::geometry::FlankOil;
use gudgeon_core::kinds::{FlankCtx, FlankLaw, FlankSpec};
use gudgeon_core::quantity::quantity;
use gudgeon_ring::Dry;

const C: f64 = 7e-5;
const A: f64 = 1.8e-3;
const WIDTH: f64 = 5e-3;
const SIGMA: f64 = 0.4e-6;

fn law(spec: &Dry) -> Box<dyn FlankLaw> {
    spec.build(&FlankCtx::new(0, 3, 0.0, WIDTH, 0.01)).expect("builds").law()
}

/// Mean pressure of Reynolds' film between walls that approach: `1/w ∫ 6 μ v (w²/4 - x²)/H³ dx`, by the midpoint rule.
fn squeezed(mu: f64, gap: f64, v: f64) -> f64 {
    let n = 10_000;
    let dx = WIDTH / f64::from(n);
    (0..n)
        .map(|k| {
            let x = (f64::from(k) + 0.5) * dx - 0.5 * WIDTH;
            6.0 * mu * v * (0.25 * WIDTH * WIDTH - x * x) / gap.powi(3) * dx / WIDTH
        })
        .sum()
}

#[test]
fn gas_resists_an_approach_as_a_squeeze_film() {
    let law = law(&Dry::default());
    // Far from the upper flank, of which a hundred thousandth is left.
    let far = 50.0 * C;
    for s in [0.0, 1e-6, 2e-5] {
        let exact = A * squeezed(27e-6, s + SIGMA, 1e-3);
        let force = law.force(&FlankOil::default(), s, -1e-3, far, A);
        // The midpoint rule of a parabola errs by 1/(2 n²) = 5e-9, the other flank adds (20/3480)³ = 2e-7.
        assert!((force / exact - 1.0).abs() < 1e-6, "{s}: {force:e} {exact:e}");
    }
}

#[test]
fn a_ring_torn_off_its_flank_hangs_on_no_more_than_the_pressure_around_it() {
    let law = law(&Dry::default());
    let held = -law.force(&FlankOil::default(), 0.0, 10.0, 50.0 * C, A);
    // The flank it goes to, 3.5 mm away, adds 1e-4 N.
    assert!(held < 1e5 * A + 2e-4 && held > 0.99e5 * A, "{held}");
}

#[test]
fn nothing_resists_without_gas() {
    let law = law(&Dry { gas_viscosity: quantity(0.0), ..Dry::default() });
    for (s, v) in [(0.0, -1.0), (0.3 * C, 1.0), (C, 1.0)] {
        assert_eq!(law.force(&FlankOil::default(), s, v, C, A), 0.0);
    }
}
