//! The gas-flow models on whole ring packs: areas, balances, independence of what they claim not to use, errors.

use std::f64::consts::{PI, TAU};

use gudgeon_core::EvalError;
use gudgeon_core::geometry::{
    BackVolume, Chamfer, FaceProfile, LandGeometry, PackGeometry, RingGeometry, RingPlace,
};
use gudgeon_core::kinds::{GasFlow, GasFlowCtx, GasFlowSpec, GasIn, GasOut, GasSlopes};
use gudgeon_core::quantity::quantity;
use gudgeon_gas::{
    BackVolumes, ChannelFriction, Elimination, FilmHeight, Gamma, GapOrifice, GasViscosity, NarrowChannel,
    Orifice, OrificeFormula, OrificeNetwork, Prescribed, Side, channel_conductance,
};
use gudgeon_numerics::ode::{Flow, Integrator, OdeSystem, Options, Stats};
use gudgeon_numerics::radau::Radau5;

/// Deterministic numbers in 0…1 (Knuth's MMIX generator, upper bits).
struct Lcg(u64);
impl Lcg {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
    fn between(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.next()
    }
}

/// A ring of a 120 mm truck engine.
fn ring(back: BackVolume) -> RingGeometry {
    RingGeometry {
        height: 3.5e-3,
        width: 5e-3,
        mass: 0.043,
        tangential_force: 22.0,
        gap: 0.4e-3,
        gap_area: None,
        piston_radius_above: 0.05965,
        piston_radius_below: 0.0597,
        root_radius: 0.0543,
        slope_upper: 7.5f64.to_radians().tan(),
        slope_lower: 7.5f64.to_radians().tan(),
        groove_height_inner: 2.08e-3,
        clearance_inner: -1.05e-4,
        leak_upper: 2e-8,
        leak_lower: 3e-8,
        leak_face: 1e-7,
        chamfer: Chamfer { area_lower: 3e-8, area_upper: 5e-8 },
        back,
        back_temperature: 503.15,
        oil_fill: 0.6,
        face: FaceProfile::Table { length: 3e-3, drops: vec![0.0, 1e-6] },
        lands: 1,
        rails: 1,
        has_clearance: back != BackVolume::Sealed,
    }
}

fn pack(backs: &[BackVolume]) -> PackGeometry {
    PackGeometry {
        bore_radius: 0.06,
        rings: backs.iter().map(|&b| ring(b)).collect(),
        lands: (0..=backs.len())
            .map(|i| LandGeometry { volume: 9e-7 / (1.0 + i as f64), temperature: 523.15 - 20.0 * i as f64 })
            .collect(),
        gamma: 1.4,
        gas_constant: 287.0,
    }
}

/// The place of a ring at film thickness `h`, position `e` and liner distortion `delta`, as a scene computes it.
fn place(p: &PackGeometry, i: usize, h: f64, e: f64, delta: f64) -> RingPlace {
    let r = &p.rings[i];
    let liner_radius = p.bore_radius + delta;
    let behind = r.h_max(liner_radius) - h;
    let slope = r.slope_upper + r.slope_lower;
    let clearance = if r.has_clearance { r.clearance_inner + slope * behind } else { 0.0 };
    let r_inner = r.root_radius + behind;
    RingPlace {
        h,
        s: e * clearance,
        v: 0.0,
        clearance,
        e,
        liner_radius,
        r_inner,
        r_outer: r_inner + r.width,
        back_volume: (r.groove_height_inner + 0.5 * slope * behind)
            * PI
            * (r_inner * r_inner - r.root_radius * r.root_radius),
        ..RingPlace::default()
    }
}

fn build(spec: &dyn GasFlowSpec, pack: &PackGeometry) -> Box<dyn GasFlow> {
    spec.build(&GasFlowCtx { pack }).expect("builds")
}

fn specs() -> Vec<Box<dyn GasFlowSpec>> {
    let truncated = Orifice { law: OrificeFormula::IsentropicTruncated, ..Orifice::default() };
    let of_burnt_gas = Orifice { gamma: Gamma::BurntGas, ..Orifice::default() };
    vec![
        Box::new(OrificeNetwork::default()),
        Box::new(OrificeNetwork {
            orifice: truncated,
            chamfer_fade: quantity(0.0),
            ..OrificeNetwork::default()
        }),
        Box::new(OrificeNetwork { film_height: FilmHeight::Nominal, ..OrificeNetwork::default() }),
        Box::new(GapOrifice::default()),
        Box::new(GapOrifice { back_volumes: BackVolumes::Merged, ..GapOrifice::default() }),
        Box::new(NarrowChannel { friction: ChannelFriction::Blended, ..NarrowChannel::default() }),
        Box::new(OrificeNetwork { orifice: of_burnt_gas, ..OrificeNetwork::default() }),
        Box::new(NarrowChannel::default()),
        Box::new(NarrowChannel { film_height: FilmHeight::Nominal, ..NarrowChannel::default() }),
    ]
}

/// The same without a space behind any ring: a filling time that none exceeds.
fn eliminated() -> Vec<Box<dyn GasFlowSpec>> {
    let all = || quantity(1e3);
    let orifices =
        OrificeNetwork { eliminate: Elimination::Auto, eliminate_below: all(), ..OrificeNetwork::default() };
    let channels =
        NarrowChannel { eliminate: Elimination::Auto, eliminate_below: all(), ..NarrowChannel::default() };
    vec![Box::new(orifices), Box::new(channels)]
}

const BACKS: &[&[BackVolume]] = &[
    &[BackVolume::Geometric],
    &[BackVolume::Drained],
    &[BackVolume::Sealed],
    &[BackVolume::Geometric, BackVolume::Geometric, BackVolume::Drained],
    &[BackVolume::Fixed(2.9e-7), BackVolume::Fixed(2.9e-7), BackVolume::Sealed],
    &[
        BackVolume::Drained,
        BackVolume::Sealed,
        BackVolume::Fixed(1e-7),
        BackVolume::Geometric,
        BackVolume::Drained,
    ],
];

#[test]
fn mass_balance_holds_for_every_call() {
    let mut rng = Lcg(7);
    for spec in specs() {
        for backs in BACKS {
            let pack = pack(backs);
            let n = backs.len();
            let mut gas = build(spec.as_ref(), &pack);
            let mut out = GasOut::new(n);
            let mut state = vec![0.0; gas.n_states()];
            let mut d = vec![0.0; gas.n_states()];
            assert_eq!(gas.state_names().len(), gas.n_states());
            for _ in 0..200 {
                let rings: Vec<_> = (0..n)
                    .map(|i| {
                        let e = (rng.between(-0.3, 1.3)).clamp(0.0, 1.0);
                        place(&pack, i, rng.between(0.0, 1e-5), e, rng.between(0.0, 1e-4))
                    })
                    .collect();
                let inp = GasIn { p_cylinder: rng.between(0.5e5, 150e5), p_crankcase: 1e5, rings: &rings };
                let lands: Vec<_> = (0..=n).map(|_| rng.between(0.5e5, 30e5)).collect();
                gas.initial(&inp, &lands, &mut state);
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

/// Pressures of all gas spaces, whose quotients say how far each passage is from equal pressures.
fn spread(out: &GasOut) -> f64 {
    let p: Vec<f64> = out.p_land.iter().chain(&out.p_back).copied().collect();
    let mut least = f64::INFINITY;
    for (i, a) in p.iter().enumerate() {
        // A pressure that stands for another one is no passage.
        least = p[..i].iter().filter(|b| *b != a).map(|b| (a / b - 1.0).abs()).fold(least, f64::min);
    }
    least
}

#[test]
fn slopes_agree_with_differences() {
    let mut rng = Lcg(11);
    let (mut compared, mut reversed, mut choked) = (0, 0, 0);
    for spec in specs().into_iter().chain(eliminated()) {
        for backs in BACKS {
            let pack = pack(backs);
            let n = backs.len();
            let mut gas = build(spec.as_ref(), &pack);
            let m = gas.n_states();
            let (mut state, mut out) = (vec![0.0; m], GasOut::new(n));
            let (mut low, mut high) = ((vec![0.0; m], GasOut::new(n)), (vec![0.0; m], GasOut::new(n)));
            let (mut d, mut slopes) = (vec![0.0; m], GasSlopes::new(n, m));
            for _ in 0..40 {
                let rings: Vec<_> = (0..n)
                    .map(|i| {
                        let e = (rng.between(-0.3, 1.3)).clamp(0.0, 1.0);
                        place(&pack, i, rng.between(0.0, 1e-5), e, rng.between(0.0, 1e-4))
                    })
                    .collect();
                let inp = GasIn { p_cylinder: rng.between(0.5e5, 150e5), p_crankcase: 1e5, rings: &rings };
                let lands: Vec<_> = (0..=n).map(|_| rng.between(0.5e5, 30e5)).collect();
                gas.initial(&inp, &lands, &mut state);
                for m in &mut state {
                    *m *= rng.between(0.7, 1.4);
                }
                gas.rates(&inp, &state, &mut d, &mut out).expect("rates");
                assert!(gas.slopes(&inp, &state, &mut slopes).expect("slopes"));
                // The balance of masses holds for the derivatives too: up to 4 n of them are added in another order.
                for k in 0..m {
                    let column = |rows: &[f64]| rows.iter().skip(k).step_by(m).copied().collect::<Vec<_>>();
                    let (rates, into, from) =
                        (column(&slopes.d_state), column(&slopes.flow_in), column(&slopes.flow_out));
                    let scale: f64 = rates.iter().chain(&into).chain(&from).map(|x| x.abs()).sum();
                    let balance = rates.iter().sum::<f64>() - (into[0] - from[n - 1]);
                    assert!(balance.abs() <= 16.0 * n as f64 * f64::EPSILON * scale, "{spec:?} {balance:e}");
                }
                if spread(&out) < 3e-3 {
                    continue;
                }
                reversed += i32::from(out.flow_in.iter().any(|f| *f < 0.0));
                choked += i32::from(out.p_land.windows(2).any(|p| p[1] < 0.5 * p[0]));
                let flow =
                    d.iter().chain(&out.flow_in).chain(&out.flow_out).fold(0.0f64, |a, f| a.max(f.abs()));
                for k in 0..m {
                    compared += 1;
                    let (mass, step) = (state[k], 1e-6 * state[k]);
                    state[k] = mass - step;
                    gas.rates(&inp, &state, &mut low.0, &mut low.1).expect("rates");
                    let below = state[k];
                    state[k] = mass + step;
                    gas.rates(&inp, &state, &mut high.0, &mut high.1).expect("rates");
                    let width = state[k] - below;
                    state[k] = mass;
                    let check = |what: &str, is: &[f64], low: &[f64], high: &[f64], noise: f64| {
                        let column: Vec<f64> = is.iter().skip(k).step_by(m).copied().collect();
                        let size = column.iter().fold(0.0f64, |a, x| a.max(x.abs()));
                        assert_eq!(column.len(), low.len());
                        for ((is, low), high) in column.iter().zip(low).zip(high) {
                            let by = (high - low) / width;
                            // Central differences over 1e-6 of pressures that differ by 3e-3 and more: the root makes an error
                            // of (1e-6 / 3e-3)² 5/8 at most, more passages of a sum do not add to it. A volume's pressure is
                            // proportional to its mass.
                            assert!(
                                (is - by).abs() <= 2e-7 * size + noise,
                                "{spec:?} {backs:?} {what} {k}: {is:e} {by:e} of {size:e}"
                            );
                        }
                    };
                    // Each value is a sum of up to 16 rounded terms, of which the leak of merged volumes is the difference
                    // of two that are up to p / Δp = 300 times greater.
                    let noise = 16.0 * 300.0 * f64::EPSILON * flow / width;
                    check("rates", &slopes.d_state, &low.0, &high.0, noise);
                    check("in", &slopes.flow_in, &low.1.flow_in, &high.1.flow_in, noise);
                    check("out", &slopes.flow_out, &low.1.flow_out, &high.1.flow_out, noise);
                    // Two roundings of a pressure.
                    let noise = 4.0 * f64::EPSILON * 150e5 / width;
                    check("land", &slopes.p_land, &low.1.p_land, &high.1.p_land, noise);
                    check("back", &slopes.p_back, &low.1.p_back, &high.1.p_back, noise);
                }
            }
        }
    }
    assert!(compared > 2000 && reversed > 500 && choked > 500, "{compared} {reversed} {choked}");
}

#[test]
fn slopes_are_finite_at_equal_pressures() {
    for spec in specs().into_iter().chain(eliminated()) {
        let pack = pack(&[BackVolume::Geometric, BackVolume::Geometric, BackVolume::Drained]);
        let rings: Vec<_> = (0..3).map(|i| place(&pack, i, 3e-6, 0.5, 5e-5)).collect();
        let inp = GasIn { p_cylinder: 1e5, p_crankcase: 1e5, rings: &rings };
        let mut gas = build(spec.as_ref(), &pack);
        let n = gas.n_states();
        let (mut state, mut slopes) = (vec![0.0; n], GasSlopes::new(3, n));
        gas.initial(&inp, &[1e5; 4], &mut state);
        assert!(gas.slopes(&inp, &state, &mut slopes).expect("slopes"));
        assert!(slopes.d_state.iter().chain(&slopes.flow_in).chain(&slopes.flow_out).all(|x| x.is_finite()));
        // More gas in a volume, more flows out of it.
        assert!((0..n).all(|k| slopes.d_state[k * n + k] < 0.0), "{spec:?} {slopes:?}");
    }
    // Given pressures have no masses.
    let mut none = build(&Prescribed { lands: vec![quantity(2e5)] }, &pack(&BACKS[3][..2]));
    let rings = [place(&pack(BACKS[0]), 0, 3e-6, 0.5, 0.0); 2];
    let inp = GasIn { p_cylinder: 3e5, p_crankcase: 1e5, rings: &rings };
    assert!(!none.slopes(&inp, &[], &mut GasSlopes::new(2, 0)).expect("nothing to refuse"));
}

#[test]
fn one_moved_ring_gives_the_rates_of_all() {
    let mut rng = Lcg(5);
    for spec in specs().into_iter().chain(eliminated()) {
        for backs in BACKS {
            let pack = pack(backs);
            let n = backs.len();
            let mut gas = build(spec.as_ref(), &pack);
            let mut fresh = build(spec.as_ref(), &pack);
            let m = gas.n_states();
            let (mut state, mut slopes) = (vec![0.0; m], GasSlopes::new(n, m));
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
                gas.initial(&inp, &lands, &mut state);
                if round % 2 == 0 {
                    gas.rates(&inp, &state, &mut a.0, &mut a.1).expect("rates");
                } else {
                    assert!(gas.slopes(&inp, &state, &mut slopes).expect("slopes"));
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
            }
        }
    }
}

#[test]
fn each_volume_balances_its_own_flows() {
    let pack = pack(&[BackVolume::Geometric, BackVolume::Geometric, BackVolume::Drained]);
    let rings: Vec<_> = (0..3).map(|i| place(&pack, i, 3e-6, 0.3, 5e-5)).collect();
    let inp = GasIn { p_cylinder: 60e5, p_crankcase: 1e5, rings: &rings };
    for spec in specs() {
        let mut gas = build(spec.as_ref(), &pack);
        assert_eq!(gas.state_names(), ["ring1.back", "land2", "ring2.back", "land3"]);
        let (mut state, mut d, mut out) = ([0.0; 4], [0.0; 4], GasOut::new(3));
        gas.initial(&inp, &[60e5, 12e5, 3e5, 1e5], &mut state);
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

/// Flow by the orifice law with the default constants.
fn orifice(area: f64, p: (f64, f64), t: (f64, f64)) -> f64 {
    let law = Orifice::default().build(1.4, 287.0).expect("builds");
    let side = |p: f64, t: f64| Side { p, inv_sqrt_rt: 1.0 / (287.0 * t).sqrt() };
    law.flow_exact(area, side(p.0, t.0), side(p.1, t.1))
}

#[test]
fn orifice_network_areas() {
    let (h, delta) = (4e-6, 8e-5);
    for e in [0.0, 0.004, 0.37, 1.0] {
        for (back, last) in
            [(BackVolume::Geometric, false), (BackVolume::Drained, true), (BackVolume::Sealed, true)]
        {
            let pack = pack(&[back]);
            let r = &pack.rings[0];
            let at = place(&pack, 0, h, e, delta);
            let inp = GasIn { p_cylinder: 20e5, p_crankcase: 1e5, rings: &[at] };
            let mut gas = build(&OrificeNetwork::default(), &pack);
            let (mut state, mut d, mut out) =
                (vec![0.0; gas.n_states()], vec![0.0; gas.n_states()], GasOut::new(1));
            gas.initial(&inp, &[20e5, 1e5], &mut state);
            gas.rates(&inp, &state, &mut d, &mut out).expect("rates");
            // The published areas, with a chamfer that fades over 1 % of the clearance.
            let chamfer = match e {
                0.0 => 3e-8,
                1.0 => 5e-8,
                _ => 3e-8 * (1.0 - e / 0.01f64).max(0.0),
            };
            let gap = (0.4e-3 + TAU * delta) * (0.06 + delta - 0.05965 - h) + chamfer;
            let upper = TAU * 0.05965 * (at.clearance - at.s + r.leak_upper) + 0.5 * gap;
            let lower = TAU * 0.0597 * (at.s + r.leak_lower) + 0.5 * gap;
            let face = TAU * (0.06 + delta - h) * r.leak_face;
            let (t0, tb, t1) = (523.15, 503.15, 503.15);
            let (p0, p1, pb) = (20e5, 1e5, 10.5e5);
            let (flow_in, flow_out) = match (back, last) {
                (BackVolume::Sealed, _) => {
                    let f = orifice(face + gap, (p0, p1), (t0, t1));
                    (f, f)
                }
                (BackVolume::Drained, _) => {
                    let f = orifice(face + 0.5 * gap + upper, (p0, p1), (t0, t1));
                    (f, f)
                }
                _ => {
                    let direct = orifice(face + 0.5 * gap, (p0, p1), (t0, t1));
                    (direct + orifice(upper, (p0, pb), (t0, tb)), direct + orifice(lower, (pb, p1), (tb, t1)))
                }
            };
            // The fast flow function is right within 2e-9.
            assert!((out.flow_in[0] / flow_in - 1.0).abs() < 3e-9, "{back:?} {e}");
            assert!((out.flow_out[0] / flow_out - 1.0).abs() < 3e-9, "{back:?} {e}");
            match back {
                BackVolume::Drained => assert_eq!(out.p_back[0], p1),
                BackVolume::Sealed => assert_eq!(out.p_back[0], 0.5 * (p0 + p1)),
                _ => {}
            }
        }
    }
}

#[test]
fn chamfers_can_close_at_lift_off_as_published() {
    let pack = pack(&[BackVolume::Sealed]);
    let spec = OrificeNetwork { chamfer_fade: quantity(0.0), ..OrificeNetwork::default() };
    let mut gas = build(&spec, &pack);
    let mut flow = |e: f64| {
        let mut at = place(&pack, 0, 0.0, 0.5, 0.0);
        at.e = e;
        let mut out = GasOut::new(1);
        let inp = GasIn { p_cylinder: 2e5, p_crankcase: 1e5, rings: &[at] };
        gas.rates(&inp, &[], &mut [], &mut out).expect("rates");
        out.flow_in[0]
    };
    let (lower, lifted, upper) = (flow(0.0), flow(1e-9), flow(1.0));
    let per_area = orifice(1.0, (2e5, 1e5), (523.15, 503.15));
    assert!(((lower - lifted) / per_area / 3e-8 - 1.0).abs() < 1e-7);
    assert!(((upper - lifted) / per_area / 5e-8 - 1.0).abs() < 1e-7);
}

#[test]
fn gap_orifice_has_the_three_published_positions() {
    let mut pack = pack(&[BackVolume::Fixed(2.9e-7)]);
    pack.bore_radius = 0.0405;
    {
        let r = &mut pack.rings[0];
        r.chamfer = Chamfer::default();
        r.gap_area = Some(9.1e-8);
        (r.slope_upper, r.slope_lower, r.clearance_inner) = (0.0, 0.0, 30.6e-6);
        r.root_radius = 0.036;
        r.width = 3.25e-3;
    }
    let mut gas = build(&GapOrifice::default(), &pack);
    assert!(!gas.uses_film_height());
    let a2 = PI * 0.081 * 30.6e-6 / 2.0;
    assert!((a2 / 3.9e-6 - 1.0).abs() < 2e-3, "half the clearance area of the published case");
    let (p0, pb, p1) = (8e5, 4.5e5, 1e5);
    let (t0, tb, t1) = (523.15, 503.15, 503.15);
    for (e, above, below) in [(0.0, 2.0 * a2, 0.0), (0.5, a2, a2), (1.0, 0.0, 2.0 * a2)] {
        let at = place(&pack, 0, 2e-6, e, 0.0);
        let inp = GasIn { p_cylinder: p0, p_crankcase: p1, rings: &[at] };
        let (mut state, mut d, mut out) = ([0.0], [0.0], GasOut::new(1));
        gas.initial(&inp, &[p0, p1], &mut state);
        gas.rates(&inp, &state, &mut d, &mut out).expect("rates");
        let gap = orifice(9.1e-8, (p0, p1), (t0, t1));
        let flow_in = gap + orifice(above, (p0, pb), (t0, tb));
        let flow_out = gap + orifice(below, (pb, p1), (tb, t1));
        // The fast flow function is right within 2e-9.
        assert!((out.flow_in[0] / flow_in - 1.0).abs() < 3e-9, "{e}");
        assert!((out.flow_out[0] / flow_out - 1.0).abs() < 3e-9, "{e}");
    }
}

#[test]
fn merged_volumes_follow_the_land_they_face() {
    let pack = pack(&[BackVolume::Fixed(2.9e-7), BackVolume::Fixed(2.9e-7), BackVolume::Sealed]);
    let merged = GapOrifice { back_volumes: BackVolumes::Merged, ..GapOrifice::default() };
    for (e, faces) in [([0.0, 0.0], [0, 1]), ([1.0, 0.0], [1, 1]), ([1.0, 1.0], [1, 2])] {
        let rings: Vec<_> = (0..3).map(|i| place(&pack, i, 0.0, *e.get(i).unwrap_or(&0.0), 0.0)).collect();
        let inp = GasIn { p_cylinder: 30e5, p_crankcase: 1e5, rings: &rings };
        let mut gas = build(&merged, &pack);
        let n = gas.n_states();
        let (mut state, mut d, mut out) = (vec![0.0; n], vec![0.0; n], GasOut::new(3));
        gas.initial(&inp, &[30e5, 6e5, 2e5, 1e5], &mut state);
        // 20 µs in steps of a tenth of the merge time, explicitly.
        for _ in 0..2000 {
            gas.rates(&inp, &state, &mut d, &mut out).expect("rates");
            for (m, d) in state.iter_mut().zip(&d) {
                *m += 1e-8 * d;
            }
        }
        gas.rates(&inp, &state, &mut d, &mut out).expect("rates");
        for (i, land) in faces.into_iter().enumerate() {
            let difference = out.p_back[i] - out.p_land[land];
            // The seat is tight, so all that enters the volume comes through the leak `m/(p τ)` and the open flank beside it.
            let node = 2 * i;
            let bound = 1e-7 * (d[node] / state[node]).abs() * out.p_back[i];
            assert!(difference.abs() <= bound * (1.0 + 1e-9), "{e:?} ring {i}: {difference:e} {bound:e}");
            assert!(difference.abs() < 1e-4 * out.p_back[i]);
        }
    }
    // In mid-groove both models are the same.
    let rings: Vec<_> = (0..3).map(|i| place(&pack, i, 0.0, 0.5, 0.0)).collect();
    let inp = GasIn { p_cylinder: 30e5, p_crankcase: 1e5, rings: &rings };
    let [a, b] = [merged, GapOrifice::default()].map(|spec| {
        let mut gas = build(&spec, &pack);
        let n = gas.n_states();
        let (mut state, mut d, mut out) = (vec![0.0; n], vec![0.0; n], GasOut::new(3));
        gas.initial(&inp, &[30e5, 6e5, 2e5, 1e5], &mut state);
        gas.rates(&inp, &state, &mut d, &mut out).expect("rates");
        out
    });
    assert_eq!(a, b);
}

#[test]
fn narrow_channels_are_channels() {
    let mut pack = pack(&[BackVolume::Fixed(2.9e-7)]);
    {
        let r = &mut pack.rings[0];
        r.gap_area = Some(0.0);
        r.chamfer = Chamfer::default();
        (r.slope_upper, r.slope_lower, r.clearance_inner) = (0.0, 0.0, 4e-6);
    }
    let spec = NarrowChannel {
        gas_viscosity: GasViscosity::Constant,
        viscosity: quantity(2.4e-5),
        ..NarrowChannel::default()
    };
    let mut gas = build(&spec, &pack);
    let at = place(&pack, 0, 2e-6, 0.25, 0.0);
    let (p0, p1) = (1.2e5, 1e5);
    let inp = GasIn { p_cylinder: p0, p_crankcase: p1, rings: &[at] };
    let (mut state, mut d, mut out) = ([0.0], [0.0], GasOut::new(1));
    gas.initial(&inp, &[p0, p1], &mut state);
    gas.rates(&inp, &state, &mut d, &mut out).expect("rates");
    let pb: f64 = 1.1e5;
    let channel = |radius: f64, height: f64, length: f64, t: f64, a: f64, b: f64| {
        channel_conductance(TAU * radius, height, length, 2.4e-5, 287.0 * t) * (a * a - b * b)
    };
    let face = channel(0.06, 1e-7, 3e-3, 513.15, p0, p1);
    let upper = channel(0.05965, 3e-6 + 2e-8, 5e-3, 513.15, p0, pb);
    let lower = channel(0.0597, 1e-6 + 3e-8, 5e-3, 503.15, pb, p1);
    // A channel 3 µm high passes about 3 % of what its mouth would; the limiter takes off the square of that, 1e-3.
    assert!((out.flow_in[0] / (face + upper) - 1.0).abs() < 2e-3);
    assert!(out.flow_in[0] < face + upper);
    assert!((out.flow_out[0] / (face + lower) - 1.0).abs() < 1e-4);
    // A wide-open groove passes what an orifice does.
    pack.rings[0].clearance_inner = 1e-3;
    let mut gas = build(&spec, &pack);
    let rings = [place(&pack, 0, 0.0, 0.0, 0.0)];
    let inp = GasIn { p_cylinder: 5e5, p_crankcase: p1, rings: &rings };
    gas.initial(&inp, &[5e5, p1], &mut state);
    gas.rates(&inp, &state, &mut d, &mut out).expect("rates");
    let law = Orifice { laminar: quantity(0.0), ..Orifice::default() }.build(1.4, 287.0).expect("builds");
    let side = |p: f64, t: f64| Side { p, inv_sqrt_rt: 1.0 / (287.0 * t).sqrt() };
    let orifice = law.flow(TAU * 0.05965 * 1e-3, side(5e5, 523.15), side(3e5, 503.15));
    // The channel alone would pass some hundred times more; half its inverse is the deficit.
    assert!(out.flow_in[0] < orifice && out.flow_in[0] > 0.99 * orifice, "{} {orifice}", out.flow_in[0]);
}

#[test]
fn what_does_not_use_the_film_does_not_depend_on_it() {
    let with_film = pack(&[BackVolume::Geometric, BackVolume::Fixed(1e-7), BackVolume::Drained]);
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
            let n = gas.n_states();
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
    // Two nominal ones and both gap_orifice on either pack; the other five on the plain one.
    assert_eq!(independent, 13);
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
            gas.initial(&inp, &[30e5, 1e5], &mut state);
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
fn mass_is_conserved_over_an_explicit_cycle() {
    // Explicit steps conserve exactly what enters and leaves: Δ(Σ m) = Σ (in - out) Δt, with rings and films moving.
    let pack = pack(&[BackVolume::Geometric, BackVolume::Geometric, BackVolume::Drained]);
    for spec in specs() {
        let stiff = format!("{spec:?}").contains("Merged");
        let mut gas = build(spec.as_ref(), &pack);
        let n = gas.n_states();
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
                gas.initial(&inp, &[2e5, 1.5e5, 1.2e5, 1e5], &mut state);
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
fn eliminated_spaces_are_the_limit_of_small_ones() {
    let backs = [BackVolume::Fixed(1e-13), BackVolume::Fixed(1e-13), BackVolume::Drained];
    let p = pack(&backs);
    let mut rng = Lcg(5);
    let full: [Box<dyn GasFlowSpec>; 2] =
        [Box::new(OrificeNetwork::default()), Box::new(NarrowChannel::default())];
    for (full, eliminated) in full.iter().zip(eliminated()) {
        let (mut full, mut less) = (build(full.as_ref(), &p), build(eliminated.as_ref(), &p));
        assert_eq!(less.state_names(), ["land2", "land3"]);
        assert_eq!(full.state_names(), ["ring1.back", "land2", "ring2.back", "land3"]);
        for _ in 0..100 {
            let rings: Vec<_> =
                (0..3).map(|i| place(&p, i, rng.between(0.0, 1e-5), rng.between(0.0, 1.0), 0.0)).collect();
            let inp = GasIn { p_cylinder: rng.between(0.5e5, 150e5), p_crankcase: 1e5, rings: &rings };
            let lands = [inp.p_cylinder, rng.between(0.5e5, 30e5), rng.between(0.5e5, 30e5), 1e5];
            let (mut y, mut d, mut out) = ([0.0; 4], [0.0; 4], GasOut::new(3));
            full.initial(&inp, &lands, &mut y);
            let (mut z, mut e, mut got) = ([0.0; 2], [0.0; 2], GasOut::new(3));
            less.initial(&inp, &lands, &mut z);
            assert_eq!(z, [y[1], y[3]]);
            less.rates(&inp, &z, &mut e, &mut got).expect("rates");
            // The full network comes to rest behind each ring where its mass no longer changes, found by halving.
            for back in [0, 2] {
                let (mut low, mut high) = (1e-3 * y[back], 1e3 * y[back]);
                for _ in 0..200 {
                    y[back] = 0.5 * (low + high);
                    full.rates(&inp, &y, &mut d, &mut out).expect("rates");
                    *if d[back] > 0.0 { &mut low } else { &mut high } = y[back];
                }
            }
            for i in 0..3 {
                // Rounding of the pressure between, 1e-16, and of the mass that stands for it.
                assert!((got.p_back[i] / out.p_back[i] - 1.0).abs() < 1e-13, "{i}: {got:?} {out:?}");
                // An open flank turns that rounding into flow: 1e-16 of 100 bar through some square centimetres, beside which the flow
                // past the tighter flank is what counts. The eliminated form takes that one.
                let tight = (out.flow_in[i] / got.flow_in[i] - 1.0)
                    .abs()
                    .min((out.flow_out[i] / got.flow_out[i] - 1.0).abs());
                assert!(tight < 1e-9, "{i}: {tight:e} {got:?} {out:?}");
                assert_eq!(got.flow_in[i], got.flow_out[i]);
            }
            // Pressures alone give the same.
            let mut alone = GasOut::new(3);
            less.pressures(&inp, &z, &mut alone).expect("pressures");
            assert_eq!((&alone.p_land, &alone.p_back), (&got.p_land, &got.p_back));
            // What is in the lands is what came less what went: exactly the flows told.
            let balance = e[0] + e[1] - (got.flow_in[0] - got.flow_out[2]);
            let scale: f64 = got.flow_in.iter().map(|f| f.abs()).sum();
            assert!(balance.abs() <= 16.0 * f64::EPSILON * scale);
        }
    }
}

/// A gas-flow model under a combustion pulse, over seconds at 3000 rpm; rings at rest.
struct Cycle {
    gas: Box<dyn GasFlow>,
    rings: Vec<RingPlace>,
    out: GasOut,
}

impl Cycle {
    fn inputs(rings: &[RingPlace], time: f64) -> GasIn<'_> {
        let deg = 18_000.0 * time;
        let p_cylinder = 1e5 * (1.0 + 11.0 * (-((deg - 360.0) / 55.0).powi(2)).exp())
            + 68e5 * (-0.5 * ((deg - 370.0) / 18.0).powi(2)).exp();
        GasIn { p_cylinder, p_crankcase: 1e5, rings }
    }
}

impl OdeSystem for Cycle {
    fn dim(&self) -> usize {
        self.gas.n_states()
    }
    /// In at the top, out at the bottom \[kg\].
    fn quad_dim(&self) -> usize {
        2
    }
    fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        let (rates, flows) = f.split_at_mut(y.len());
        self.gas.rates(&Self::inputs(&self.rings, t), y, rates, &mut self.out)?;
        if let [top, bottom] = flows {
            (*top, *bottom) = (self.out.flow_in[0], self.out.flow_out[self.rings.len() - 1]);
        }
        Ok(())
    }
}

/// Blow-by of one cycle from rest \[kg\], and what the balance of mass lacks of it.
fn blow_by(spec: &OrificeNetwork, back: f64) -> (f64, f64) {
    let p = pack(&[BackVolume::Fixed(back), BackVolume::Fixed(back), BackVolume::Drained]);
    // The upper rings between the flanks: a few square centimetres into spaces of less than a cubic millimetre.
    let rings: Vec<_> = (0..3).map(|i| place(&p, i, 3e-6, 0.4, 0.0)).collect();
    let gas = build(spec, &p);
    let n = gas.n_states();
    let (mut start, mut totals, mut stats) = (vec![0.0; n], [0.0; 2], Stats::default());
    gas.initial(&Cycle::inputs(&rings, 0.0), &[1e5; 4], &mut start);
    let mut y = start.clone();
    let mut cycle = Cycle { gas, rings, out: GasOut::new(3) };
    let mut options = Options::new(1e-8, &start);
    options.max_steps = 1_000_000;
    Radau5::new(n, 2, None)
        .integrate(&mut cycle, (0.0, 0.04), &[], &mut y, &mut totals, &options, &mut stats, &mut |_, _| {
            Flow::Continue
        })
        .expect("integrates");
    let stored: f64 = y.iter().zip(&start).map(|(a, b)| a - b).sum();
    (totals[1], (totals[0] - totals[1] - stored) / totals[1])
}

#[test]
fn small_spaces_tend_to_eliminated_ones() {
    let auto = |limit| OrificeNetwork {
        eliminate: Elimination::Auto,
        eliminate_below: quantity(limit),
        ..OrificeNetwork::default()
    };
    let (none, lost) = blow_by(&auto(1.0), 1e-10);
    // The sum of the flows of every step keeps the balance to rounding: 1e-16 a step.
    assert!(lost.abs() < 1e-12, "{lost:e}");
    let [large, middle, small] = [1e-8, 1e-9, 1e-10].map(|v| {
        let (flow, lost) = blow_by(&OrificeNetwork::default(), v);
        assert!(lost.abs() < 1e-12, "{lost:e}");
        flow / none - 1.0
    });
    // What the spaces hold back goes with their size; a tenth of it within a tenth of itself.
    assert!(
        (middle / large - 0.1).abs() < 0.02 && (small / middle - 0.1).abs() < 0.02,
        "{large:e} {middle:e} {small:e}"
    );
    // Spaces of a tenth of a cubic millimetre fill in 4 ns: they are eliminated with the default limit of 10 ns, and change the
    // blow-by of this ring, which is open on both sides, by 2e-6.
    assert!(small.abs() < 3e-6, "{small:e}");
    let (by_default, _) =
        blow_by(&OrificeNetwork { eliminate: Elimination::Auto, ..OrificeNetwork::default() }, 1e-10);
    assert_eq!(by_default, none);
}

#[test]
fn only_spaces_that_fill_fast_are_eliminated() {
    // The room behind the rings of a truck engine fills in 10 µs between the flanks, a hundred-thousandth of it in 0.1 ns.
    let names = |volume: f64, limit: Option<f64>| {
        let mut spec = OrificeNetwork { eliminate: Elimination::Auto, ..OrificeNetwork::default() };
        if let Some(limit) = limit {
            spec.eliminate_below = quantity(limit);
        }
        build(&spec, &pack(&[BackVolume::Fixed(volume), BackVolume::Fixed(2.9e-7)])).state_names()
    };
    assert_eq!(names(2.9e-7, None), ["ring1.back", "land2", "ring2.back"]);
    assert_eq!(names(2.9e-12, None), ["land2", "ring2.back"]);
    assert_eq!(names(2.9e-12, Some(1e-12)), ["ring1.back", "land2", "ring2.back"]);
    // By default nothing is.
    let never = build(&OrificeNetwork::default(), &pack(&[BackVolume::Fixed(2.9e-12)]));
    assert_eq!(never.n_states(), 1);
}

#[test]
fn real_gas_of_the_upstream_side() {
    // Drained grooves leave orifices between nodes at known temperatures: the law of each is that for the gas it comes with.
    let backs = [BackVolume::Sealed, BackVolume::Sealed];
    let p = pack(&backs);
    let orifice = |gamma| Orifice { gamma, ..Orifice::default() };
    let spec = |gamma| OrificeNetwork { orifice: orifice(gamma), ..OrificeNetwork::default() };
    let rings: Vec<_> = (0..2).map(|i| place(&p, i, 0.0, 0.5, 0.0)).collect();
    // The second ring blows back.
    let inp = GasIn { p_cylinder: 50e5, p_crankcase: 4e5, rings: &rings };
    let lands = [50e5, 3e5, 4e5];
    let run = |gamma| {
        let mut gas = build(&spec(gamma), &p);
        let (mut y, mut d, mut out) = ([0.0], [0.0], GasOut::new(2));
        gas.initial(&inp, &lands, &mut y);
        gas.rates(&inp, &y, &mut d, &mut out).expect("rates");
        out.flow_in
    };
    let (constant, air) = (run(Gamma::Constant), run(Gamma::Air));
    for (i, (up, down)) in [(0, 1), (2, 1)].into_iter().enumerate() {
        let law = |gamma: f64| Orifice::default().build(gamma, 287.0).expect("builds");
        let side =
            |n: usize| Side { p: lands[n], inv_sqrt_rt: (287.0 * p.lands[n].temperature).sqrt().recip() };
        let ratio = |gamma: f64| {
            law(gamma).flow(1e-6, side(up), side(down)) / law(1.4).flow(1e-6, side(up), side(down))
        };
        let exact = ratio(Gamma::Air.at(p.lands[up].temperature, 1.4));
        // Both by the same fast form; a few roundings, that of the pressure from the mass among them.
        assert!((air[i] / constant[i] / exact - 1.0).abs() < 1e-13, "{i}");
        assert!((exact - 1.0).abs() > 1e-4);
    }
}

#[test]
fn prescribed_pressures() {
    let pack = pack(&[BackVolume::Geometric, BackVolume::Drained]);
    let spec = Prescribed { lands: vec![quantity(4e5)] };
    let mut gas = build(&spec, &pack);
    assert_eq!(gas.n_states(), 0);
    let rings = [place(&pack, 0, 0.0, 0.25, 0.0), place(&pack, 1, 0.0, 1.0, 0.0)];
    let inp = GasIn { p_cylinder: 8e5, p_crankcase: 1e5, rings: &rings };
    let mut out = GasOut { flow_in: vec![1.0; 2], flow_out: vec![1.0; 2], ..GasOut::new(2) };
    gas.rates(&inp, &[], &mut [], &mut out).expect("rates");
    assert_eq!(out.p_land, [8e5, 4e5, 1e5]);
    assert_eq!(out.p_back, [7e5, 1e5]);
    assert_eq!((out.flow_in, out.flow_out), (vec![0.0; 2], vec![0.0; 2]));
    let e = Prescribed::default().build(&GasFlowCtx { pack: &pack }).err().expect("wrong number");
    assert_eq!(e.field, "lands");
}

#[test]
fn impossible_packs_are_refused_with_the_numbers() {
    let refused = |change: &dyn Fn(&mut PackGeometry)| {
        let mut p = pack(&[BackVolume::Geometric, BackVolume::Fixed(1e-7)]);
        change(&mut p);
        specs()
            .iter()
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

#[test]
fn registered_and_readable() {
    let registry = gudgeon_core::Registry::collect();
    for name in ["orifice_network", "gap_orifice", "narrow_channel", "prescribed"] {
        assert!(registry.model("gas_flow", name).is_some(), "{name}");
    }
}

/// Gas passes the face of a ring further from the liner than its oil reaches, and of no other.
#[test]
fn a_ring_off_the_liner_lets_gas_past_its_face() {
    let mut pack = pack(&[BackVolume::Sealed]);
    let r = &mut pack.rings[0];
    (r.gap_area, r.leak_face, r.chamfer) = (Some(1e-8), 0.0, Chamfer::default());
    let specs: [Box<dyn GasFlowSpec>; 2] =
        [Box::new(OrificeNetwork::default()), Box::new(NarrowChannel::default())];
    for spec in specs {
        let mut gas = build(&*spec, &pack);
        let mut flow = |h: f64| {
            let mut out = GasOut::new(1);
            let inp = GasIn { p_cylinder: 2e5, p_crankcase: 1e5, rings: &[place(&pack, 0, h, 0.5, 0.0)] };
            gas.rates(&inp, &[], &mut [], &mut out).expect("rates");
            out.flow_in[0]
        };
        let closed = flow(1e-6);
        assert_eq!(flow(50e-6), closed);
        // Without a corner: the opening begins with the square of what is beyond, 0.2 um² over 5 um. A channel begins with the cube.
        assert!(flow(50.2e-6) > closed && flow(50.2e-6) < 1.5 * closed, "{} {closed}", flow(50.2e-6));
        // 2π 60 mm 0.3 mm is ten thousand times the gap.
        assert!(flow(350e-6) > 3e3 * closed, "{} {closed}", flow(350e-6));
    }
}
