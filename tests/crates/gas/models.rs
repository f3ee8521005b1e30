//! What each model takes for the passages around a ring.

use std::f64::consts::{PI, TAU};

use gudgeon_core::geometry::{BackVolume, Chamfer, RingPlace};
use gudgeon_core::kinds::{GasFlowCtx, GasFlowSpec, GasIn, GasOut};
use gudgeon_core::quantity::quantity;
use gudgeon_gas::{
    BackVolumes, ChannelFriction, Gamma, GapOrifice, GasState, GasViscosity, NarrowChannel, Orifice,
    OrificeNetwork, Prescribed, TRANSITION, channel_conductance, sutherland_viscosity,
};

use crate::packs::{build, pack, place};
use crate::support::R;

/// Flow by the orifice law with the default constants.
fn orifice(area: f64, p: (f64, f64), t: (f64, f64)) -> f64 {
    let law = Orifice::default().build(1.4, 287.0).expect("builds");
    let side = |p: f64, t: f64| GasState::new(p, R * t);
    law.flow_exact(area, &side(p.0, t.0), &side(p.1, t.1))
}

#[test]
fn orifice_network_areas() {
    let (h, delta) = (4e-6, 8e-5);
    for e in [0.0, 0.004, 0.37, 1.0] {
        for (back, last) in
            [(BackVolume::Geometric, false), (BackVolume::OpenBelow, true), (BackVolume::Sealed, true)]
        {
            let pack = pack(&[back]);
            let r = &pack.rings[0];
            let at = place(&pack, 0, h, e, delta);
            let inp = GasIn { p_cylinder: 20e5, p_crankcase: 1e5, rings: &[at] };
            let mut gas = build(&OrificeNetwork::default(), &pack);
            let (mut state, mut d, mut out) =
                (vec![0.0; gas.n_masses()], vec![0.0; gas.n_masses()], GasOut::new(1));
            gas.at_pressures(&inp, &[20e5, 1e5], &mut state);
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
                (BackVolume::OpenBelow, _) => {
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
                BackVolume::OpenBelow => assert_eq!(out.p_back[0], p1),
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
        at.lift_fraction = e;
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
        gas.at_pressures(&inp, &[p0, p1], &mut state);
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
        let n = gas.n_masses();
        let (mut state, mut d, mut out) = (vec![0.0; n], vec![0.0; n], GasOut::new(3));
        gas.at_pressures(&inp, &[30e5, 6e5, 2e5, 1e5], &mut state);
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
        let n = gas.n_masses();
        let (mut state, mut d, mut out) = (vec![0.0; n], vec![0.0; n], GasOut::new(3));
        gas.at_pressures(&inp, &[30e5, 6e5, 2e5, 1e5], &mut state);
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
        friction: ChannelFriction::Laminar,
        gas_viscosity: GasViscosity::Constant,
        viscosity: quantity(2.4e-5),
        ..NarrowChannel::default()
    };
    let mut gas = build(&spec, &pack);
    let at = place(&pack, 0, 2e-6, 0.25, 0.0);
    let (p0, p1) = (1.2e5, 1e5);
    let inp = GasIn { p_cylinder: p0, p_crankcase: p1, rings: &[at] };
    let (mut state, mut d, mut out) = ([0.0], [0.0], GasOut::new(1));
    gas.at_pressures(&inp, &[p0, p1], &mut state);
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
    gas.at_pressures(&inp, &[5e5, p1], &mut state);
    gas.rates(&inp, &state, &mut d, &mut out).expect("rates");
    let law = Orifice { laminar: quantity(0.0), ..Orifice::default() }.build(1.4, 287.0).expect("builds");
    let side = |p: f64, t: f64| GasState::new(p, R * t);
    let orifice = law.flow(TAU * 0.05965 * 1e-3, &side(5e5, 523.15), &side(3e5, 503.15));
    // The channel alone would pass some hundred times more; half its inverse is the deficit.
    assert!(out.flow_in[0] < orifice && out.flow_in[0] > 0.99 * orifice, "{} {orifice}", out.flow_in[0]);
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
        gas.at_pressures(&inp, &lands, &mut y);
        gas.rates(&inp, &y, &mut d, &mut out).expect("rates");
        out.flow_in
    };
    let (constant, air) = (run(Gamma::Constant), run(Gamma::Air));
    for (i, (up, down)) in [(0, 1), (2, 1)].into_iter().enumerate() {
        let law = |gamma: f64| Orifice::default().build(gamma, 287.0).expect("builds");
        let side = |n: usize| GasState::new(lands[n], R * p.lands[n].temperature);
        let ratio = |gamma: f64| {
            law(gamma).flow(1e-6, &side(up), &side(down)) / law(1.4).flow(1e-6, &side(up), &side(down))
        };
        let exact = ratio(Gamma::Air.at(p.lands[up].temperature, 1.4));
        // Both by the same fast form; a few roundings, that of the pressure from the mass among them.
        assert!((air[i] / constant[i] / exact - 1.0).abs() < 1e-13, "{i}");
        assert!((exact - 1.0).abs() > 1e-4);
    }
}

#[test]
fn prescribed_pressures() {
    let pack = pack(&[BackVolume::Geometric, BackVolume::OpenBelow]);
    let spec = Prescribed { lands: vec![quantity(4e5)] };
    let mut gas = build(&spec, &pack);
    assert_eq!(gas.n_masses(), 0);
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
fn registered_and_readable() {
    let registry = gudgeon_core::Registry::collect();
    for name in
        ["orifice_network", "gap_orifice", "labyrinth", "namazian_heywood", "narrow_channel", "prescribed"]
    {
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

/// A sealed ring has its gap, and what passes its face, in every model.
#[test]
fn sealed_rings_leak_at_gap_and_face() {
    let mut pack = pack(&[BackVolume::Sealed]);
    {
        let r = &mut pack.rings[0];
        (r.gap_area, r.chamfer, r.leak_face) = (Some(2e-7), Chamfer::default(), 3e-6);
    }
    let (p, t) = ((20e5, 1e5), (523.15, 503.15));
    let laminar = NarrowChannel { friction: ChannelFriction::Laminar, ..NarrowChannel::default() };
    let specs: [(Box<dyn GasFlowSpec>, f64); 3] = [
        (Box::new(GapOrifice::default()), orifice(2e-7, p, t)),
        (Box::new(OrificeNetwork::default()), orifice(2e-7 + TAU * 0.06 * 3e-6, p, t)),
        (Box::new(laminar), {
            // The channel along the face of 3 mm, at the mean temperature, limited by its mouth: losses add as c and o².
            let mean = 513.15;
            let mu = sutherland_viscosity(mean);
            let c = channel_conductance(TAU * 0.06, 3e-6, 3e-3, mu, R * mean) * (p.0 * p.0 - p.1 * p.1);
            let law = Orifice { laminar: quantity(0.0), ..Orifice::default() }.build(1.4, R).expect("builds");
            let o = law.flow(TAU * 0.06 * 3e-6, &GasState::new(p.0, R * t.0), &GasState::new(p.1, R * t.1));
            orifice(2e-7, p, t) + 2.0 * c * o / (o + (o * o + 4.0 * c * c).sqrt())
        }),
    ];
    for (spec, flow) in specs {
        let mut gas = build(spec.as_ref(), &pack);
        assert_eq!(gas.n_masses(), 0);
        let mut out = GasOut::new(1);
        let inp = GasIn { p_cylinder: p.0, p_crankcase: p.1, rings: &[place(&pack, 0, 0.0, 0.0, 0.0)] };
        gas.rates(&inp, &[], &mut [], &mut out).expect("rates");
        // The fast flow function is right within 2e-9.
        assert!((out.flow_in[0] / flow - 1.0).abs() < 3e-9, "{spec:?}: {:e} {flow:e}", out.flow_in[0]);
        assert_eq!(out.flow_in, out.flow_out);
    }
}

/// Friction that turns turbulent takes off what its law says, and nothing where the flow is slow.
#[test]
fn blended_friction_of_a_face() {
    let mut pack = pack(&[BackVolume::Sealed]);
    {
        let r = &mut pack.rings[0];
        (r.gap_area, r.chamfer) = (Some(0.0), Chamfer::default());
    }
    for (height, p0) in [(1e-6, 2e5), (3e-5, 60e5), (3e-4, 60e5)] {
        pack.rings[0].leak_face = height;
        let spec = NarrowChannel {
            friction: ChannelFriction::Blended,
            gas_viscosity: GasViscosity::Constant,
            viscosity: quantity(2.5e-5),
            ..NarrowChannel::default()
        };
        let mut gas = build(&spec, &pack);
        let mut out = GasOut::new(1);
        let inp = GasIn { p_cylinder: p0, p_crankcase: 1e5, rings: &[place(&pack, 0, 0.0, 0.0, 0.0)] };
        gas.rates(&inp, &[], &mut [], &mut out).expect("rates");
        let laminar = channel_conductance(TAU * 0.06, height, 3e-3, 2.5e-5, R * 513.15) * (p0 * p0 - 1e10);
        // Re = ṁ/(π R μ), and the flow [1 + (Re/Re_c)³]^(-1/7) times the laminar one, behind its mouth.
        let reynolds = laminar / (PI * 0.06 * 2.5e-5);
        let c = laminar * (1.0 + (reynolds / TRANSITION).powi(3)).powf(-1.0 / 7.0);
        let law = Orifice { laminar: quantity(0.0), ..Orifice::default() }.build(1.4, R).expect("builds");
        let o =
            law.flow(TAU * 0.06 * height, &GasState::new(p0, R * 523.15), &GasState::new(1e5, R * 503.15));
        let flow = 2.0 * c * o / (o + (o * o + 4.0 * c * c).sqrt());
        // A few roundings of a power.
        assert!((out.flow_in[0] / flow - 1.0).abs() < 1e-12, "{height}: {:e} {flow:e}", out.flow_in[0]);
    }
}

/// Prescribed pressures refuse boundaries that are none, and take positions between the flanks.
#[test]
fn prescribed_pressures_of_impossible_boundaries() {
    let pack = pack(&[BackVolume::Geometric]);
    let mut gas = build(&Prescribed::default(), &pack);
    assert!(!gas.uses_end_gaps() && !gas.uses_film_height() && gas.states().is_empty());
    let mut at = |p_cylinder: f64, p_crankcase: f64, e: f64| {
        let rings = [RingPlace { lift_fraction: e, ..place(&pack, 0, 0.0, 0.5, 0.0) }];
        let mut out = GasOut::new(1);
        gas.pressures(&GasIn { p_cylinder, p_crankcase, rings: &rings }, &[], &mut out)
            .map(|()| out.p_back[0])
    };
    for p in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(at(p, 1e5, 0.5).is_err_and(|e| e.is_recoverable()));
        assert!(at(1e5, p, 0.5).is_err_and(|e| e.is_recoverable()));
    }
    assert_eq!(at(4e5, 1e5, -1.0).ok(), Some(4e5));
    assert_eq!(at(4e5, 1e5, 2.0).ok(), Some(1e5));
}
