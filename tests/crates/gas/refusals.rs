//! Packs and instants that are not possible.

use gudgeon_core::geometry::{BackVolume, PackGeometry, RingPlace};
use gudgeon_core::kinds::{GasFlowCtx, GasIn, GasOut};

use crate::packs::{build, pack, place, specs};

#[test]
fn impossible_packs_are_refused_with_the_numbers() {
    let refused = |change: &dyn Fn(&mut PackGeometry)| {
        let mut p = pack(&[BackVolume::Geometric, BackVolume::Fixed(1e-7)]);
        change(&mut p);
        specs()
            .iter()
            // An isothermal law: the ratio of specific heats does not count.
            .filter(|s| p.gamma > 1.0 || !format!("{s:?}").starts_with("Labyrinth"))
            .map(|s| s.build(&GasFlowCtx { pack: &p }).err().expect("refused").message)
            .collect::<Vec<_>>()
    };
    for m in refused(&|p| p.rings[0].piston_radius_above = 0.061) {
        assert!(m.contains("ring 1") && m.contains("0.061000 m in a liner of 0.060000 m"), "{m}");
    }
    for m in refused(&|p| p.lands[1].volume = 0.0) {
        assert!(m.contains("land 2") && m.contains("0e0 m3"), "{m}");
    }
    for m in refused(&|p| p.rings[1].back = BackVolume::Fixed(0.0)) {
        assert!(m.contains("behind ring 2"), "{m}");
    }
    for m in refused(&|p| p.rings[0].root_radius = 0.056) {
        assert!(m.contains("behind ring 1"), "{m}");
    }
    for m in refused(&|p| p.lands[2].temperature = 0.0) {
        assert!(m.contains("temperature"), "{m}");
    }
    for m in refused(&|p| p.gamma = 1.0) {
        assert!(m.contains("specific heats"), "{m}");
    }
    for m in refused(&|p| p.rings.clear()) {
        assert!(m.contains("at least one ring"), "{m}");
    }
}

#[test]
fn impossible_instants_are_errors_not_numbers() {
    let mut p = pack(&[BackVolume::Geometric]);
    p.rings[0].gap = -0.2e-3;
    for spec in specs() {
        let mut gas = build(spec.as_ref(), &p);
        let (mut d, mut out) = ([0.0], GasOut::new(1));
        let mut rates = |place: RingPlace, m: f64, p_cylinder: f64| {
            let inp = GasIn { p_cylinder, p_crankcase: 1e5, rings: &[place] };
            gas.rates(&inp, &[m], &mut d, &mut out)
        };
        let (cold, warm) = (place(&p, 0, 0.0, 0.0, 0.0), place(&p, 0, 0.0, 0.0, 1e-4));
        let e = rates(cold, 1e-6, 1e5).expect_err("the gap is closed");
        assert!(!e.is_recoverable() && e.to_string().contains("gap of ring 1 closes when hot"), "{e}");
        assert!(e.to_string().contains("-2e-4"), "{e}");
        rates(warm, 1e-6, 1e5).expect("the liner's growth opens it");
        for (m, p_cyl) in [(0.0, 1e5), (-1e-9, 1e5), (f64::NAN, 1e5), (1e-6, 0.0), (1e-6, f64::NAN)] {
            assert!(rates(warm, m, p_cyl).expect_err("refused").is_recoverable());
        }
    }
}
