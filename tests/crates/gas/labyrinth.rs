//! Martin's labyrinth: one throttling, many in series.

use gudgeon_core::geometry::{BackVolume, Chamfer, LandGeometry, Vent};
use gudgeon_core::kinds::{GasFlowCtx, GasFlowSpec, GasIn, GasOut, GasPartials};
use gudgeon_core::quantity::quantity;
use gudgeon_gas::{Area, GasState, Labyrinth, PassageLaw, THROTTLING_RATIO, ThrottlingLaw};
use gudgeon_numerics::linalg::{lu_factor, lu_solve};

use crate::packs::{build, pack, place};
use crate::support::R;

fn martin(area: f64, p0: f64, pn: f64, rt: f64, n: f64) -> f64 {
    let r: f64 = pn / p0;
    area * p0 * ((1.0 - r * r) / (rt * (n - r.ln()))).sqrt()
}

#[test]
fn one_throttling() {
    let law = ThrottlingLaw::new(1.0, 0.0);
    let a = GasState::new(3e5, R * 450.0);
    for r in [0.48, 0.6, 0.9, 0.999] {
        let b = GasState::new(3e5 * r, R * 400.0);
        // A few roundings; that of the drop counts 1e-16/(1 - r).
        let exact = martin(2e-7, 3e5, 3e5 * r, R * 450.0, 1.0);
        assert!((law.mass_flow(Area(2e-7), &a, &b) / exact - 1.0).abs() < 1e-12);
        assert_eq!(law.mass_flow(Area(2e-7), &b, &a), -law.mass_flow(Area(2e-7), &a, &b));
    }
    // Most at the critical ratio, and choked below: 1 - r² = 2 r² (1 - ln r) there, and φ = 0.666278746566433720073665302826 (mpmath).
    let r: f64 = THROTTLING_RATIO;
    assert!((1.0 - r * r - 2.0 * r * r * (1.0 - r.ln())).abs() < 1e-15);
    let choked = 3e5 / (R * 450.0f64).sqrt() * 0.666278746566433720073665302826;
    for r in [THROTTLING_RATIO, 0.3, 1e-6] {
        // A few roundings.
        assert!((law.mass_flow(Area(1.0), &a, &a.with_pressure(3e5 * r)) / choked - 1.0).abs() < 1e-14);
    }
}

#[test]
fn its_derivatives() {
    for laminar in [0.0, 1e-3] {
        let law = ThrottlingLaw::new(0.86, laminar);
        let a = GasState::new(3e5, R * 450.0);
        for r in [0.1, 0.4, 0.5, 0.7, 0.95, 0.999] {
            let b = GasState::new(3e5 * r, R * 400.0);
            let s = law.mass_flow_partials(Area(1e-7), &a, &b);
            assert_eq!(s.flow, law.mass_flow(Area(1e-7), &a, &b));
            // Central differences over a thousandth of the distance to the singularity at equal pressures: 1e-6 of what they say.
            let d = 1e-3 * (1.0 - r) * r * 3e5;
            let at = |p: f64, q: f64| law.mass_flow(Area(1e-7), &a.with_pressure(p), &b.with_pressure(q));
            let by_a = (at(3e5 + d, 3e5 * r) - at(3e5 - d, 3e5 * r)) / (2.0 * d);
            let by_b = (at(3e5, 3e5 * r + d) - at(3e5, 3e5 * r - d)) / (2.0 * d);
            let size = s.by_a.abs().max(s.by_b.abs());
            assert!((s.by_a - by_a).abs() < 2e-6 * size && (s.by_b - by_b).abs() < 2e-6 * size, "{r} {s:?}");
            assert!(s.by_a > 0.0 && s.by_b <= 0.0);
        }
        // Finite where the pressures are equal.
        let s = law.mass_flow_partials(Area(1e-7), &a, &a);
        assert!(s.flow == 0.0 && s.by_a > 0.0 && s.by_a.is_finite() && s.by_b == -s.by_a);
    }
}

/// Rings with equal gaps at one temperature, in the steady state: Martin's formula, and every land at `p_k² - p_(k+1)²` of its share.
#[test]
fn rings_in_series_are_martins_labyrinth() {
    for n in [1, 2, 3, 5] {
        let mut pack = pack(&vec![BackVolume::Sealed; n]);
        for ring in &mut pack.rings {
            (ring.gap_area, ring.leak_face, ring.chamfer) = (Some(1e-7), 0.0, Chamfer::default());
        }
        pack.lands = vec![LandGeometry { volume: 5e-7, temperature: 450.0, vent: Vent::Closed }; n + 1];
        let spec = Labyrinth { discharge: quantity(1.0), laminar: quantity(0.0), ..Labyrinth::default() };
        let mut gas = build(&spec, &pack);
        let rings: Vec<_> = (0..n).map(|i| place(&pack, i, 0.0, 0.5, 0.0)).collect();
        let (p0, pn) = (2e5, 1.1e5);
        let inp = GasIn { p_cylinder: p0, p_crankcase: pn, rings: &rings };
        let m = gas.n_masses();
        assert_eq!(m, n - 1);
        let (mut y, mut d) = (vec![0.0; m], vec![0.0; m]);
        let lands: Vec<f64> = (0..=n).map(|k| p0 + (pn - p0) * k as f64 / n as f64).collect();
        gas.at_pressures(&inp, &lands, &mut y);
        let mut out = GasOut::new(n);
        // Newton's method from pressures in equal steps; ten steps are far more than quadratic convergence needs.
        for _ in 0..10 {
            gas.rates(&inp, &y, &mut d, &mut out).expect("rates");
            let mut partials = GasPartials::new(n, m);
            assert!(gas.partials(&inp, &y, &mut partials).expect("partials"));
            let (mut a, mut pivots) = (partials.d_state, vec![0; m]);
            assert!(lu_factor(&mut a, m, &mut pivots).is_ok());
            lu_solve(&a, m, &pivots, &mut d);
            for (y, d) in y.iter_mut().zip(&d) {
                *y -= d;
            }
        }
        gas.rates(&inp, &y, &mut d, &mut out).expect("rates");
        let exact = martin(1e-7, p0, pn, R * 450.0, n as f64);
        for k in 0..n {
            // Roundings of pressures that differ by a tenth and more.
            assert!((out.flow_in[k] / exact - 1.0).abs() < 1e-13, "{n} {k} {}", out.flow_in[k] / exact - 1.0);
        }
    }
}

#[test]
fn refuses_more_than_all_of_the_gap() {
    let spec = Labyrinth { discharge: quantity(1.2), ..Labyrinth::default() };
    let pack = pack(&[BackVolume::Geometric]);
    assert_eq!(spec.build(&GasFlowCtx { pack: &pack }).err().expect("above 1").field, "discharge");
}
