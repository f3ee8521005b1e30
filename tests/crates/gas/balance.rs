//! Balances of mass, continuity, and what flows depend on, of all models on whole packs.

use std::f64::consts::TAU;

use gudgeon_core::geometry::BackVolume;
use gudgeon_core::kinds::{GasIn, GasOut, GasPartials};

use crate::packs::{BACKS, build, eliminated, names, pack, place, specs, with_energy};
use crate::support::Lcg;

#[test]
fn mass_balance_holds_for_every_call() {
    let mut rng = Lcg(7);
    for spec in specs() {
        for backs in BACKS {
            let pack = pack(backs);
            let n = backs.len();
            let mut gas = build(spec.as_ref(), &pack);
            let mut out = GasOut::new(n);
            let mut state = vec![0.0; gas.n_masses()];
            let mut d = vec![0.0; gas.n_masses()];
            for _ in 0..200 {
                let rings: Vec<_> = (0..n)
                    .map(|i| {
                        let e = (rng.between(-0.3, 1.3)).clamp(0.0, 1.0);
                        place(&pack, i, rng.between(0.0, 1e-5), e, rng.between(0.0, 1e-4))
                    })
                    .collect();
                let inp = GasIn { p_cylinder: rng.between(0.5e5, 150e5), p_crankcase: 1e5, rings: &rings };
                let lands: Vec<_> = (0..=n).map(|_| rng.between(0.5e5, 30e5)).collect();
                gas.at_pressures(&inp, &lands, &mut state);
                gas.rates(&inp, &state, &mut d, &mut out).expect("rates");
                let sum: f64 = d.iter().sum();
                let scale: f64 = out.flow_in.iter().chain(&out.flow_out).map(|f| f.abs()).sum();
                let balance = sum - (out.flow_in[0] - out.flow_out[n - 1]);
                // Up to 4 n link flows are added in another order. With merged volumes the linear leak past a flank is part of them.
                assert!(balance.abs() <= 16.0 * n as f64 * f64::EPSILON * scale, "{spec:?} {balance:e}");
                assert!(d.iter().chain(&out.flow_in).chain(&out.p_back).all(|x| x.is_finite()));
                // `initial` is the inverse of the pressures.
                for i in 0..n {
                    if i > 0 {
                        assert!((out.p_land[i] / lands[i] - 1.0).abs() < 1e-14);
                    }
                    if matches!(backs[i], BackVolume::Geometric | BackVolume::Fixed(_)) {
                        let mean = 0.5 * (lands[i] + lands[i + 1]);
                        assert!((out.p_back[i] / mean - 1.0).abs() < 1e-14);
                    }
                }
                let mut only = GasOut::new(n);
                gas.pressures(&inp, &state, &mut only).expect("pressures");
                assert_eq!((&only.p_land, &only.p_back), (&out.p_land, &out.p_back));
            }
        }
    }
}

#[test]
fn each_volume_balances_its_own_flows() {
    let pack = pack(&[BackVolume::Geometric, BackVolume::Geometric, BackVolume::OpenBelow]);
    let rings: Vec<_> = (0..3).map(|i| place(&pack, i, 3e-6, 0.3, 5e-5)).collect();
    let inp = GasIn { p_cylinder: 60e5, p_crankcase: 1e5, rings: &rings };
    for spec in specs() {
        let mut gas = build(spec.as_ref(), &pack);
        assert_eq!(
            names(&*gas),
            ["mass of ring1.back", "mass of land2", "mass of ring2.back", "mass of land3"]
        );
        let (mut state, mut d, mut out) = ([0.0; 4], [0.0; 4], GasOut::new(3));
        gas.at_pressures(&inp, &[60e5, 12e5, 3e5, 1e5], &mut state);
        gas.rates(&inp, &state, &mut d, &mut out).expect("rates");
        let expected = [
            out.flow_in[0] - out.flow_out[0],
            out.flow_out[0] - out.flow_in[1],
            out.flow_in[1] - out.flow_out[1],
            out.flow_out[1] - out.flow_in[2],
        ];
        for (a, b) in d.iter().zip(expected) {
            assert!((a - b).abs() <= 1e-14 * out.flow_in[0].abs().max(out.flow_out[0].abs()));
        }
        assert_eq!(out.p_back[2], out.p_land[3], "drained");
        assert_eq!(out.flow_in[2], out.flow_out[2], "drained");
        // Everything flows downwards here.
        assert!(out.flow_in.iter().chain(&out.flow_out).all(|&f| f > 0.0));
    }
}

#[test]
fn mass_is_conserved_over_an_explicit_cycle() {
    // Explicit steps conserve exactly what enters and leaves: Δ(Σ m) = Σ (in - out) Δt, with rings and films moving.
    let pack = pack(&[BackVolume::Geometric, BackVolume::Geometric, BackVolume::OpenBelow]);
    for spec in specs() {
        let stiff = format!("{spec:?}").contains("Merged");
        let mut gas = build(spec.as_ref(), &pack);
        let n = gas.n_masses();
        let (mut state, mut d, mut out) = (vec![0.0; n], vec![0.0; n], GasOut::new(3));
        let (steps, dt) = if stiff { (200_000, 1e-8) } else { (20_000, 1e-7) };
        let (mut entered, mut throughput) = (0.0, 0.0);
        let mut start = 0.0;
        for k in 0..steps {
            let x = TAU * f64::from(k) / f64::from(steps);
            let rings: Vec<_> = (0..3)
                .map(|i| {
                    let e = (0.5 - 0.8 * (x + i as f64).cos()).clamp(0.0, 1.0);
                    place(&pack, i, 4e-6 * (1.1 + x.sin()), e, 2e-5)
                })
                .collect();
            let inp = GasIn { p_cylinder: 30e5 - 28e5 * x.cos(), p_crankcase: 1e5, rings: &rings };
            if k == 0 {
                gas.at_pressures(&inp, &[2e5, 1.5e5, 1.2e5, 1e5], &mut state);
                start = state.iter().sum();
            }
            gas.rates(&inp, &state, &mut d, &mut out).expect("rates");
            for (m, d) in state.iter_mut().zip(&d) {
                *m += dt * d;
            }
            entered += dt * (out.flow_in[0] - out.flow_out[2]);
            throughput += dt * (out.flow_in[0].abs() + out.flow_out[2].abs());
        }
        let balance = state.iter().sum::<f64>() - start - entered;
        // One rounding of 1e-16 of the content per step, random in sign, against 1e-12 of the throughput.
        assert!(balance.abs() <= 1e-12 * throughput, "{spec:?} {balance:e} of {throughput:e}");
    }
}

#[test]
fn flows_are_continuous_in_position_and_film() {
    let pack = pack(&[BackVolume::Geometric]);
    for (k, spec) in specs().into_iter().enumerate() {
        if k == 1 {
            continue; // The published chamfer closes at lift-off: discontinuous on purpose.
        }
        let mut gas = build(spec.as_ref(), &pack);
        let mut flow = |e: f64, h: f64| {
            let rings = [place(&pack, 0, h, e, 0.0)];
            let inp = GasIn { p_cylinder: 30e5, p_crankcase: 1e5, rings: &rings };
            let (mut state, mut d, mut out) = ([0.0], [0.0], GasOut::new(1));
            gas.at_pressures(&inp, &[30e5, 1e5], &mut state);
            gas.rates(&inp, &state, &mut d, &mut out).expect("rates");
            (out.flow_in[0], out.flow_out[0])
        };
        let step = 1e-9;
        for k in 0..=1000 {
            let e = f64::from(k) / 1000.0;
            let (a, b) = (flow(e, 1e-6), flow((e + step).min(1.0), 1e-6 + 1e-12));
            // The flow changes by its own size over 1e-3 of the groove at most (chamfer and narrow channels).
            for (a, b) in [(a.0, b.0), (a.1, b.1)] {
                assert!((a - b).abs() <= 1e-5 * a.abs().max(b.abs()), "{spec:?} {e}: {a:e} {b:e}");
            }
        }
    }
}

#[test]
fn what_does_not_use_the_film_does_not_depend_on_it() {
    let with_film = pack(&[BackVolume::Geometric, BackVolume::Fixed(1e-7), BackVolume::OpenBelow]);
    let mut plain = with_film.clone();
    for r in &mut plain.rings {
        r.gap_area = Some(1e-7);
        (r.slope_upper, r.slope_lower, r.clearance_inner) = (0.0, 0.0, 5e-5);
        r.leak_face = 0.0;
        if r.back == BackVolume::Geometric {
            r.back = BackVolume::Fixed(3e-7);
        }
    }
    let mut independent = 0;
    for spec in specs() {
        for pack in [&with_film, &plain] {
            let mut gas = build(spec.as_ref(), pack);
            let n = gas.n_masses();
            let mut at = |h: f64| {
                // The same position in the groove, another film.
                let rings: Vec<_> = (0..3).map(|i| place(pack, i, h, 0.4, 3e-5)).collect();
                let inp = GasIn { p_cylinder: 30e5, p_crankcase: 1e5, rings: &rings };
                let (mut d, mut out) = (vec![0.0; n], GasOut::new(3));
                let state: Vec<_> = (0..n).map(|i| 2e-6 / (1.0 + i as f64)).collect();
                gas.rates(&inp, &state, &mut d, &mut out).expect("rates");
                (d, out)
            };
            let (a, b) = (at(1e-6), at(9e-6));
            if gas.uses_film_height() {
                assert_ne!(a, b, "{spec:?}");
            } else {
                assert_eq!(a, b, "{spec:?}");
                independent += 1;
            }
        }
    }
    // Two nominal ones and both gap_orifice on either pack; the other nine on the plain one.
    assert_eq!(independent, 17);
}

#[test]
fn one_moved_ring_gives_the_rates_of_all() {
    let mut rng = Lcg(5);
    for spec in specs().into_iter().chain(eliminated()).chain(with_energy()) {
        for backs in BACKS {
            let pack = pack(backs);
            let n = backs.len();
            let mut gas = build(spec.as_ref(), &pack);
            let mut fresh = build(spec.as_ref(), &pack);
            let m = gas.states().len();
            let (mut state, mut partials) = (vec![0.0; m], GasPartials::new(n, m));
            let (mut a, mut b) = ((vec![0.0; m], GasOut::new(n)), (vec![0.0; m], GasOut::new(n)));
            for round in 0..40 {
                let mut random = |i: usize| {
                    let e = (rng.between(-0.3, 1.3)).clamp(0.0, 1.0);
                    place(&pack, i, rng.between(0.0, 1e-5), e, rng.between(0.0, 1e-4))
                };
                let mut rings: Vec<_> = (0..n).map(&mut random).collect();
                let moved: Vec<_> = (0..n).map(&mut random).collect();
                let p_cylinder = rng.between(0.5e5, 150e5);
                let lands: Vec<_> = (0..=n).map(|_| rng.between(0.5e5, 30e5)).collect();
                let inp = GasIn { p_cylinder, p_crankcase: 1e5, rings: &rings };
                gas.at_pressures(&inp, &lands, &mut state);
                if round % 2 == 0 || gas.has_energy() {
                    gas.rates(&inp, &state, &mut a.0, &mut a.1).expect("rates");
                } else {
                    assert!(gas.partials(&inp, &state, &mut partials).expect("partials"));
                }
                // Each ring away and back, twice over, and once to where it cannot be.
                for i in (0..n).chain(0..n) {
                    let home = std::mem::replace(&mut rings[i], moved[i]);
                    let inp = GasIn { p_cylinder, p_crankcase: 1e5, rings: &rings };
                    gas.rates_moved(i, &inp, &state, &mut a.0, &mut a.1).expect("rates");
                    fresh.rates(&inp, &state, &mut b.0, &mut b.1).expect("rates");
                    assert_eq!(a, b, "{spec:?} {backs:?} {i}");
                    rings[i].liner_radius = 0.0;
                    let inp = GasIn { p_cylinder, p_crankcase: 1e5, rings: &rings };
                    let refused = gas.rates_moved(i, &inp, &state, &mut a.0, &mut a.1);
                    assert_eq!(refused.is_err(), fresh.rates(&inp, &state, &mut b.0, &mut b.1).is_err());
                    rings[i] = home;
                }
                // Other pressures while the rings stand.
                let inp = GasIn { p_cylinder, p_crankcase: 1e5, rings: &rings };
                gas.rates(&inp, &state, &mut a.0, &mut a.1).expect("rates");
                let inp = GasIn { p_cylinder: 1.1 * p_cylinder, ..inp };
                state.iter_mut().for_each(|m| *m *= 0.9);
                gas.rates_standing(&inp, &state, &mut a.0, &mut a.1).expect("rates");
                fresh.rates(&inp, &state, &mut b.0, &mut b.1).expect("rates");
                assert_eq!(a, b, "{spec:?} {backs:?}");
            }
        }
    }
}
