//! Grooves and spaces between rails that are open to the crankcase, drained to it, or closed.

use gudgeon_core::geometry::{BackVolume, Drain, PackGeometry, RingPlace, Vent};
use gudgeon_core::kinds::{GasFlow, GasFlowCtx, GasFlowSpec, GasIn, GasOut, GasPartials};
use gudgeon_core::quantity::quantity;
use gudgeon_gas::{Orifice, OrificeNetwork, PackNetwork, PackOptions, PassageModel, Prescribed, plain_pack};

use crate::packs::{build, pack, place, specs, with_energy};

const CRANKCASE: f64 = 1.1e5;

fn drain(area: f64) -> Vent {
    Vent::Drain(Drain { area, discharge: 0.7 })
}

/// Three rings, the groove of the last one with `vent`.
fn oil_ring(vent: Vent) -> PackGeometry {
    let mut pack = pack(&[BackVolume::Geometric; 3]);
    pack.rings[2].vent = vent;
    pack
}

/// Two rings over two rails with a space between these, drains in the groove of ring 2 and in that space.
fn rails(vent: Vent) -> PackGeometry {
    let mut pack =
        pack(&[BackVolume::Geometric, BackVolume::Geometric, BackVolume::OpenBelow, BackVolume::OpenAbove]);
    pack.rings[1].vent = vent;
    pack.lands[3].vent = vent;
    pack
}

fn places(pack: &PackGeometry, h: f64) -> Vec<RingPlace> {
    let lift = [0.0, 0.4, 1.0, 0.2];
    (0..pack.rings.len()).map(|i| place(pack, i, h, lift[i], 5e-5)).collect()
}

/// Rates and flows at falling pressures of the lands.
fn instant(gas: &mut dyn GasFlow, rings: &[RingPlace]) -> (Vec<f64>, Vec<f64>, GasOut) {
    let n = rings.len();
    let inp = GasIn { p_cylinder: 60e5, p_crankcase: CRANKCASE, rings };
    let lands: Vec<f64> = [60e5, 12e5, 3e5, 1.7e5][..n].iter().copied().chain([CRANKCASE]).collect();
    let mut state = vec![0.0; gas.states().len()];
    gas.at_pressures(&inp, &lands, &mut state);
    let (mut d, mut out) = (vec![0.0; state.len()], GasOut::new(n));
    gas.rates(&inp, &state, &mut d, &mut out).expect("rates");
    (state, d, out)
}

#[test]
fn a_vented_last_groove_is_one_that_is_open_below() {
    let vented = oil_ring(Vent::Open);
    let below = pack(&[BackVolume::Geometric, BackVolume::Geometric, BackVolume::OpenBelow]);
    let rings = places(&vented, 3e-6);
    for spec in specs().into_iter().chain(with_energy()) {
        let [a, b] = [&vented, &below].map(|p| instant(&mut *build(&*spec, p), &rings));
        // Below the last ring is the crankcase: the same model, to the last bit.
        assert_eq!(a, b, "{spec:?}");
        assert_eq!(a.2.p_back[2], CRANKCASE);
    }
}

#[test]
fn a_groove_higher_up_is_vented_to_the_crankcase() {
    let mut open = pack(&[BackVolume::Geometric; 3]);
    open.rings[1].vent = Vent::Open;
    let rings = places(&open, 3e-6);
    for spec in specs() {
        let mut gas = build(&*spec, &open);
        let (_, d, out) = instant(&mut *gas, &rings);
        assert_eq!(out.p_back[1], CRANKCASE, "{spec:?}");
        assert!(gas.states().iter().all(|s| s.name != "mass of ring2.back"));
        // What goes past its upper flank is blow-by at once, and what comes past its lower flank, from the groove into the land, takes away from it.
        let lost: f64 = d.iter().sum::<f64>() - (out.flow_in[0] - out.flow_out[2]);
        assert!(lost.abs() <= 1e-14 * out.flow_in[0], "{spec:?} {lost:e}");
    }
}

#[test]
fn drains_lead_between_the_limits_of_closed_and_vented() {
    let rings = places(&oil_ring(Vent::Closed), 3e-6);
    for spec in specs() {
        let at = |vent| instant(&mut *build(&*spec, &oil_ring(vent)), &rings);
        let (closed, narrow, wide) = (at(Vent::Closed), at(drain(1e-16)), at(drain(1e-4)));
        // 1e-16 m² beside flanks of 1e-8 m² and more: 1e-8 of the flows, of which the smallest counts here.
        for (a, b) in closed.1.iter().zip(&narrow.1) {
            assert!((a - b).abs() <= 1e-7 * closed.2.flow_in[2].abs(), "{spec:?} {a:e} {b:e}");
        }
        // The groove, filled to the mean of land and crankcase, empties by the drain: the law of an opening of the area 0.7/C_d that of the drain.
        let emptied = wide.2.flow_out[2] - closed.2.flow_out[2];
        let rt = 287.0 * oil_ring(Vent::Closed).rings[2].back_temperature;
        let (p, r) = (closed.2.p_back[2], CRANKCASE / closed.2.p_back[2]);
        let g: f64 = 1.4;
        let psi = (2.0 * g / (g - 1.0) * (r.powf(2.0 / g) - r.powf((g + 1.0) / g))).sqrt();
        let expected = 0.7 * 1e-4 * p / rt.sqrt() * psi;
        // The coefficient of a pressure-dependent law, the laminar branch (0.1 % of the drop), throttling instead of nozzle flow and γ of burnt gas
        // take their parts; a wrong coefficient is a factor of 0.86 or 0.7.
        let plain = format!("{spec:?}");
        let own = ["BurntGas", "Labyrinth", "discharge_fall: 0.25"].iter().any(|s| plain.contains(s));
        if !own {
            assert!((emptied / expected - 1.0).abs() < 5e-3, "{spec:?} {emptied:e} {expected:e}");
        }
        assert!(emptied > 0.5 * expected && emptied < 1.1 * expected, "{spec:?} {emptied:e} {expected:e}");
    }
}

#[test]
fn a_drained_groove_settles_where_its_flows_balance() {
    // Steady: the groove takes on the pressure at which the drain passes what the flanks bring. A ring on its lower flank, the groove open to land 3.
    let spec = OrificeNetwork::default();
    let settle = |area: f64| {
        let pack = oil_ring(drain(area));
        let rings = places(&pack, 3e-6).into_iter().enumerate();
        let rings: Vec<_> =
            rings.map(|(i, p)| if i == 2 { place(&pack, 2, 3e-6, 0.0, 5e-5) } else { p }).collect();
        let mut gas = build(&spec, &pack);
        let inp = GasIn { p_cylinder: 60e5, p_crankcase: CRANKCASE, rings: &rings };
        let (mut state, _, mut out) = instant(&mut *gas, &rings);
        let k = state.len() - 1;
        assert_eq!(gas.states()[k].name, "mass of ring3.back");
        let mut d = vec![0.0; state.len()];
        // The mass of the groove alone is searched, the others are held: its rate falls as it grows.
        let (mut low, mut high) = (0.1 * state[k], 10.0 * state[k]);
        for _ in 0..80 {
            state[k] = 0.5 * (low + high);
            gas.rates(&inp, &state, &mut d, &mut out).expect("rates");
            if d[k] > 0.0 { low = state[k] } else { high = state[k] }
        }
        (out.p_back[2], out.flow_in[2])
    };
    let [(narrow, _), (middle, _), (wide, flow)] = [1e-12, 1e-5, 1e-2].map(settle);
    assert!(narrow > middle && middle > wide, "{narrow} {middle} {wide}");
    // On the laminar branch, far below ε = 1e-3, the drop is u = ψ sqrt(ε/2); ψ of the whole flow past ring 3, of which a part goes by the gap.
    let rt = 287.0 * oil_ring(Vent::Closed).rings[2].back_temperature;
    let psi = flow * rt.sqrt() / (0.7 * 1e-2 * CRANKCASE);
    let most = psi * 0.5e-3_f64.sqrt();
    // What goes directly by the gap and the seated flank is less than half; u² and u/ε add less than the fifth by which the bound is exceeded at most.
    let drop = wide / CRANKCASE - 1.0;
    assert!(drop > 0.5 * most && drop < 1.2 * most, "{drop:e} {most:e}");
}

#[test]
fn gas_closes_with_drains_and_rails() {
    for vent in [Vent::Closed, drain(2e-6), Vent::Open] {
        let pack = rails(vent);
        let rings = places(&pack, 3e-6);
        for spec in specs().into_iter().chain(with_energy()) {
            let mut gas = build(&*spec, &pack);
            let n = gas.n_masses();
            let (_, d, out) = instant(&mut *gas, &rings);
            let stored: f64 = d[..n].iter().sum();
            let most = out.flow_in.iter().chain(&out.flow_out).fold(0.0_f64, |m, f| m.max(f.abs()));
            // A few roundings of the largest flow.
            assert!((stored - (out.flow_in[0] - out.flow_out[3])).abs() <= 1e-14 * most, "{vent:?} {spec:?}");
            assert_eq!(
                (out.p_back[2], out.p_back[3]),
                (out.p_land[3], out.p_land[3]),
                "the space between the rails"
            );
            if vent == Vent::Open {
                assert_eq!(out.p_land[3], CRANKCASE);
                // Past the lower rail nothing flows, both sides being the crankcase; past the upper one goes the blow-by, and by the groove of ring 2.
                assert_eq!((out.flow_in[3], d.iter().all(|x| x.is_finite())), (0.0, true));
            }
        }
    }
}

#[test]
fn partials_and_single_rings_agree_with_whole_evaluations() {
    let mut compared = 0;
    for pack in [rails(drain(2e-6)), rails(Vent::Open), oil_ring(drain(2e-6))] {
        let rings = places(&pack, 3e-6);
        let n = rings.len();
        let inp = GasIn { p_cylinder: 60e5, p_crankcase: CRANKCASE, rings: &rings };
        for spec in specs() {
            let mut gas = build(&*spec, &pack);
            let (state, _, _) = instant(&mut *gas, &rings);
            let m = state.len();
            let mut partials = GasPartials::new(n, m);
            assert!(gas.partials(&inp, &state, &mut partials).expect("partials"));
            for k in 0..m {
                let step = 1e-5 * state[k];
                let [low, high] = [-step, step].map(|d| {
                    let mut moved = state.clone();
                    moved[k] += d;
                    let (mut rates, mut out) = (vec![0.0; m], GasOut::new(n));
                    gas.rates(&inp, &moved, &mut rates, &mut out).expect("rates");
                    out.flow_out
                });
                for i in 0..n {
                    let difference = (high[i] - low[i]) / (2.0 * step);
                    let known = partials.flow_out[i * m + k];
                    // Central differences of 1e-5: their cut-off is 1e-7 of the curvature, rounding 1e-11 of the flow over the step; choking and the
                    // truncated law have kinks, which 1e-5 of a mass does not reach here.
                    let noise = 1e-5 * known.abs() + 1e-10 * (high[i].abs() / step);
                    assert!((difference - known).abs() <= noise, "{spec:?} {i} {k} {difference:e} {known:e}");
                    compared += 1;
                }
            }
            for i in 0..n {
                let mut moved = rings.clone();
                moved[i] = place(&pack, i, 4e-6, 0.7, 5e-5);
                let inp_moved = GasIn { rings: &moved, ..inp };
                let (mut d, mut out) = (vec![0.0; m], GasOut::new(n));
                gas.rates(&inp, &state, &mut d, &mut out).expect("rates");
                gas.rates_moved(i, &inp_moved, &state, &mut d, &mut out).expect("rates");
                let (mut whole, mut all) = (vec![0.0; m], GasOut::new(n));
                build(&*spec, &pack).rates(&inp_moved, &state, &mut whole, &mut all).expect("rates");
                assert_eq!((d, out), (whole, all), "{spec:?} {i}");
            }
        }
    }
    assert!(compared > 500, "{compared}");
}

#[test]
fn what_cannot_be_drained_is_refused() {
    let refused = |spec: &dyn GasFlowSpec, pack: &PackGeometry| {
        spec.build(&GasFlowCtx { pack }).err().map(|e| e.message).unwrap_or_default()
    };
    let given = Prescribed { lands: vec![quantity(3e5), quantity(2e5)] };
    let what = refused(&given, &oil_ring(drain(1e-6)));
    assert_eq!(what, "the groove of ring 3 has a drain, and no flow is computed");
    let rails = rails(drain(1e-6));
    let given = Prescribed { lands: vec![quantity(3e5); 3] };
    assert_eq!(refused(&given, &rails), "the groove of ring 2 has a drain, and no flow is computed");
    for (area, discharge) in [(0.0, 0.7), (-1e-6, 0.7), (f64::NAN, 0.7), (1e-6, 0.0), (1e-6, 1.1)] {
        let what = refused(&OrificeNetwork::default(), &oil_ring(Vent::Drain(Drain { area, discharge })));
        assert!(what.starts_with("the groove of ring 3 has a drain of"), "{what}");
    }

    /// Passages of a model that knows of no drain.
    struct Tight;
    impl PassageModel<gudgeon_gas::Passage> for Tight {
        fn ring_passages(
            &self,
            _: usize,
            _: &gudgeon_core::geometry::RingGeometry,
            _: &gudgeon_gas::Openings,
        ) -> gudgeon_gas::RingPassages<gudgeon_gas::Passage> {
            gudgeon_gas::RingPassages::default()
        }
    }
    let (mut plain, _) = plain_pack(1);
    plain.rings[0].vent = drain(1e-6);
    let law = Orifice::default().build(1.4, 287.0).expect("builds");
    let tight = PackNetwork::new("tight", Tight, law, &plain, PackOptions::default());
    assert_eq!(
        tight.err().map(|e| e.message).as_deref(),
        Some("`tight` has no passage for the drain of a groove")
    );
}

#[test]
fn given_pressures_know_of_vents() {
    let rails = rails(Vent::Open);
    let rings = places(&rails, 3e-6);
    let mut gas = build(&Prescribed { lands: vec![quantity(3e5), quantity(2e5)] }, &rails);
    let (mut out, inp) = (GasOut::new(4), GasIn { p_cylinder: 9e5, p_crankcase: CRANKCASE, rings: &rings });
    gas.rates(&inp, &[], &mut [], &mut out).expect("nothing to refuse");
    assert_eq!(out.p_land, [9e5, 3e5, 2e5, CRANKCASE, CRANKCASE]);
    assert_eq!(out.p_back[1..], [CRANKCASE; 3]);
}
