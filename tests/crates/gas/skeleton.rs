//! The public skeleton with a law of one's own: Darcy flow, whose solutions are known in closed form.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use gudgeon_core::BuildError;
use gudgeon_core::geometry::BackVolume;
use gudgeon_core::kinds::{GasFlow, GasIn, GasOut, GasPartials};
use gudgeon_gas::{
    Area, FlowPartials, GasState, Link, Network, Node, OrificeAreas, PackNetwork, PackOptions, PassageLaw,
    plain_pack,
};

use crate::support::R;

/// `ṁ = k A (p_a² - p_b²)`.
#[derive(Debug, Clone)]
struct Darcy {
    k: f64,
}

impl PassageLaw for Darcy {
    type Passage = Area;

    fn mass_flow_partials(&self, Area(area): Area, a: &GasState, b: &GasState) -> FlowPartials {
        let (c, p, q) = (self.k * area, a.pressure(), b.pressure());
        FlowPartials { flow: c * (p * p - q * q), by_a: 2.0 * c * p, by_b: -2.0 * c * q }
    }
}

#[test]
fn state_of_the_gas() {
    let gas = GasState::new(2e5, 120_000.0);
    assert_eq!((gas.pressure(), gas.rt()), (2e5, 120_000.0));
    // One rounding each.
    assert!((gas.density() - 2e5 / 120_000.0).abs() < 1e-15);
    assert!((gas.inv_pressure() * 2e5 - 1.0).abs() < 2e-16);
    assert!((gas.inv_sqrt_rt().powi(2) * 120_000.0 - 1.0).abs() < 4e-16);
    let other = gas.with_pressure(5e5);
    assert_eq!((other.pressure(), other.rt(), other.inv_sqrt_rt()), (5e5, gas.rt(), gas.inv_sqrt_rt()));
    assert_eq!(other, GasState::new(5e5, 120_000.0));
    // A vacuum has numbers too.
    assert_eq!((gas.with_pressure(0.0).inv_pressure(), GasState::new(0.0, 1.0).inv_pressure()), (0.0, 0.0));
}

#[test]
fn a_network_of_any_law() {
    const LINKS: [(usize, usize); 7] = [(2, 0), (0, 1), (1, 3), (2, 1), (0, 2), (1, 0), (2, 3)];
    let (k, areas) = (1e-9, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0].map(|a| a * 1e-7));
    let mut net = Network::new(Darcy { k }, R, &[300.0, 400.0, 500.0, 600.0], 2, &LINKS).expect("builds");
    let (volumes, p) = ([1e-3, 2e-3], [3e5, 2e5, 7e5, 1e5]);
    for i in 0..2 {
        let mass = p[i] * volumes[i] / (R * [300.0, 400.0][i]);
        net.set_mass("test", i, mass, volumes[i]).expect("mass");
        net.set_pressure("test", i + 2, p[i + 2]).expect("p");
    }
    for (link, area) in areas.into_iter().enumerate() {
        net.set_passage(link, Area(area));
    }
    net.update_flows();
    let mut rates = [0.0; 2];
    net.rates(&mut rates);
    let mut expected = [0.0; 2];
    for (link, (a, b)) in LINKS.into_iter().enumerate() {
        let flow = k * areas[link] * (p[a] * p[a] - p[b] * p[b]);
        // A few roundings, of the pressures set by a mass among them; differences of squares lose a digit here.
        assert!((net.flow(link) / flow - 1.0).abs() < 1e-14, "{link}");
        for (node, sign) in [(a, -1.0), (b, 1.0)] {
            if node < 2 {
                expected[node] += sign * flow;
            }
        }
    }
    for (rate, expected) in rates.iter().zip(expected) {
        assert!((rate / expected - 1.0).abs() < 1e-13);
    }
    // The Jacobian: d rate_i / d m_j = Σ ± ∂ṁ/∂p_j R T_j / V_j.
    net.update_partials();
    let mut jac = [0.0; 4];
    net.jacobian(&mut jac);
    let per_mass = [0, 1].map(|i| R * [300.0, 400.0][i] / volumes[i]);
    let mut exact = [0.0; 4];
    for (link, (a, b)) in LINKS.into_iter().enumerate() {
        let partials = [2.0 * k * areas[link] * p[a], -2.0 * k * areas[link] * p[b]];
        for (is, exact) in net.partials(link).into_iter().zip(partials) {
            assert!((is / exact - 1.0).abs() < 1e-14);
        }
        let mut gradient = [1.0; 2];
        net.add_flow_gradient(link, -2.0, &mut gradient);
        let mut direct = [1.0; 2];
        for (node, partial) in [(a, partials[0]), (b, partials[1])] {
            if node < 2 {
                direct[node] += -2.0 * partial * per_mass[node];
                if a < 2 {
                    exact[a * 2 + node] -= partial * per_mass[node];
                }
                if b < 2 {
                    exact[b * 2 + node] += partial * per_mass[node];
                }
            }
        }
        for (is, exact) in gradient.iter().zip(direct) {
            assert!((is / exact - 1.0).abs() < 1e-13);
        }
    }
    for (is, exact) in jac.iter().zip(exact) {
        assert!((is / exact - 1.0).abs() < 1e-13);
    }
    assert!((net.pressure_per_mass(1) / per_mass[1] - 1.0).abs() < 1e-15);
}

#[test]
fn two_darcy_passages_in_series() {
    // p² falls in proportion to the resistances: p_m² = (A_1 p_a² + A_2 p_b²)/(A_1 + A_2).
    let (k, a1, a2, p) = (1e-9, 2e-7, 3e-7, [6e5_f64, 1e5_f64]);
    let mut net = Network::new(Darcy { k }, R, &[400.0; 2], 0, &[(0, 1), (1, 0)]).expect("builds");
    net.split_link(0, R * 450.0);
    net.set_split_passages(0, Area(a1), Area(a2));
    net.set_passage(1, Area(a1));
    for (i, p) in p.into_iter().enumerate() {
        net.set_pressure("test", i, p).expect("p");
    }
    let middle = ((a1 * p[0] * p[0] + a2 * p[1] * p[1]) / (a1 + a2)).sqrt();
    let together = k * a1 * a2 / (a1 + a2);
    let flow = together * (p[0] * p[0] - p[1] * p[1]);
    for partials in [false, true] {
        if partials {
            net.update_partials();
        } else {
            net.update_flows();
        }
        // The search ends within rounding of the pressure between.
        assert!((net.middle_pressure(0) / middle - 1.0).abs() < 1e-15);
        assert!((net.flow(0) / flow - 1.0).abs() < 1e-14);
        assert!((net.flow(1) / (k * a1 * (p[1] * p[1] - p[0] * p[0])) - 1.0).abs() < 1e-15);
    }
    for (end, sign) in [(0, 1.0), (1, -1.0)] {
        assert!((net.partials(0)[end] / (sign * 2.0 * together * p[end]) - 1.0).abs() < 1e-14);
        let by = [a1, a2][end] * p[end] / ((a1 + a2) * middle);
        assert!((net.middle_partials(0)[end] / by - 1.0).abs() < 1e-14);
    }
    // A single passage in its place.
    net.set_passage(0, Area(a2));
    net.update_flows();
    assert!((net.flow(0) / (k * a2 * (p[0] * p[0] - p[1] * p[1])) - 1.0).abs() < 1e-15);
}

#[test]
fn laws_of_the_source() {
    // Gas from node 0 has twice the constant of gas from node 1.
    let mut net = Network::new(Darcy { k: 1.0 }, R, &[400.0; 2], 0, &[(0, 1), (1, 0)]).expect("builds");
    net.set_source_laws(vec![Darcy { k: 2e-9 }, Darcy { k: 1e-9 }]);
    net.set_passage(0, Area(1e-7));
    net.set_passage(1, Area(1e-7));
    let mut at = |p: [f64; 2]| {
        net.set_pressure("test", 0, p[0]).expect("p");
        net.set_pressure("test", 1, p[1]).expect("p");
        net.update_flows();
        let flows = [net.flow(0), net.flow(1)];
        net.update_partials();
        assert_eq!(flows, [net.flow(0), net.flow(1)]);
        flows
    };
    let (there, back) = (at([2e5, 1e5]), at([1e5, 2e5]));
    // The same terms in the same order.
    assert_eq!((there[0], there[1]), (-2.0 * back[0], -2.0 * back[1]));
    assert!(there[0] > 0.0 && there[1] == -there[0]);
}

/// Flow in, flow out and pressures of a pack of `rings` under Darcy's law.
fn darcy(options: PackOptions, backs: BackVolume, k_of: Option<&dyn Fn(f64) -> f64>) -> (GasOut, Vec<f64>) {
    let (mut pack, places) = plain_pack(2);
    for r in &mut pack.rings {
        r.back = backs;
    }
    pack.lands[1].temperature = 500.0;
    let mut gas = PackNetwork::new("darcy", OrificeAreas::default(), Darcy { k: 1e-9 }, &pack, options)
        .expect("builds");
    if let Some(k_of) = k_of {
        gas = gas.with_source_laws(|t| Ok(Darcy { k: k_of(t) })).expect("builds");
    }
    let inputs = GasIn { p_cylinder: 9e5, p_crankcase: 1e5, rings: &places };
    let n = gas.n_masses();
    let (mut y, mut d, mut out) = (vec![0.0; n], vec![0.0; n], GasOut::new(2));
    gas.at_pressures(&inputs, &[9e5, 4e5, 1e5], &mut y);
    gas.rates(&inputs, &y, &mut d, &mut out).expect("rates");
    let mut partials = GasPartials::new(2, n);
    assert!(gas.partials(&inputs, &y, &mut partials).expect("partials"));
    for k in 0..n {
        let keep = y[k];
        let mut ends = [(vec![0.0; n], GasOut::new(2)), (vec![0.0; n], GasOut::new(2))];
        for (end, d) in ends.iter_mut().zip([-1e-4, 1e-4]) {
            y[k] = keep * (1.0 + d);
            gas.rates(&inputs, &y, &mut end.0, &mut end.1).expect("rates");
        }
        y[k] = keep;
        for i in 0..n {
            let central = (ends[1].0[i] - ends[0].0[i]) / (2e-4 * keep);
            let size = partials.d_state.iter().fold(0.0f64, |a, x| a.max(x.abs()));
            // Darcy's flow is quadratic in the masses: nothing is truncated but through the pressure between two passages, 1e-8;
            // rounding 1e-15/1e-4 of terms that cancel in part.
            assert!((central - partials.d_state[i * n + k]).abs() < 3e-8 * size, "{i} {k}");
        }
    }
    (out, d)
}

#[test]
fn a_pack_of_any_law() {
    let (out, d) = darcy(PackOptions::default(), BackVolume::Fixed(3e-7), None);
    // Half of the gap through the groove, flanks that leak through 0.1 µm, the upper one open by 50 µm.
    let radius = 0.05 - 0.3e-3;
    let around = |height: f64| std::f64::consts::TAU * radius * height;
    let (upper, lower, gap) = (around(50e-6 + 1e-7) + 2.5e-8, around(1e-7) + 2.5e-8, 2.5e-8);
    let flow = |area: f64, p: f64, q: f64| 1e-9 * area * (p * p - q * q);
    for (i, [above, below]) in [[9e5, 4e5], [4e5, 1e5]].into_iter().enumerate() {
        let behind = 0.5 * (above + below);
        let (into, from) = (
            flow(upper, above, behind) + flow(gap, above, below),
            flow(lower, behind, below) + flow(gap, above, below),
        );
        // A few roundings of differences of squares.
        assert!((out.flow_in[i] / into - 1.0).abs() < 1e-13, "{i}");
        assert!((out.flow_out[i] / from - 1.0).abs() < 1e-13, "{i}");
    }
    assert_eq!(d.len(), 3);
    let sum: f64 = d.iter().sum();
    assert!((sum - (out.flow_in[0] - out.flow_out[1])).abs() < 1e-14 * out.flow_in[0]);
}

#[test]
fn a_pack_of_any_law_without_room_behind_its_rings() {
    let options = PackOptions { eliminate_below: Some(1e9), ..PackOptions::default() };
    let (out, d) = darcy(options, BackVolume::Fixed(3e-7), None);
    assert_eq!(d.len(), 1);
    assert_eq!(out.flow_in, out.flow_out);
    let (drained, _) = darcy(PackOptions::default(), BackVolume::OpenBelow, None);
    let (sealed, _) = darcy(PackOptions::default(), BackVolume::Sealed, None);
    // A flank in the way of the gas, none, and no way past the flanks.
    assert!(drained.flow_in[0] > out.flow_in[0] && out.flow_in[0] > sealed.flow_in[0]);
    assert_eq!((drained.p_back[0], sealed.p_back[0]), (drained.p_land[1], 0.5 * (9e5 + sealed.p_land[1])));
}

#[test]
fn laws_of_the_temperature() {
    // Chamber, crankcase and spaces behind the rings are at 450 K, the land between at 500 K, all gas goes down.
    let k_of = |t: f64| if t == 500.0 { 3e-9 } else { 1e-9 };
    let (plain, _) = darcy(PackOptions::default(), BackVolume::Sealed, None);
    let (own, _) = darcy(PackOptions::default(), BackVolume::Sealed, Some(&k_of));
    assert_eq!(own.flow_in[0], plain.flow_in[0]);
    assert!((own.flow_in[1] / plain.flow_in[1] - 3.0).abs() < 1e-14);
    let (pack, _) = plain_pack(1);
    let gas =
        PackNetwork::new("darcy", OrificeAreas::default(), Darcy { k: 1e-9 }, &pack, PackOptions::default());
    let refused = gas.expect("builds").with_source_laws(|_| Err(BuildError::new("no law")));
    assert_eq!(refused.err().map(|e| e.message), Some("no law".to_owned()));
}

#[test]
fn errors_carry_the_name_of_the_model() {
    let (pack, places) = plain_pack(1);
    let mut gas =
        PackNetwork::new("my_law", OrificeAreas::default(), Darcy { k: 1e-9 }, &pack, PackOptions::default())
            .expect("builds");
    let inputs = GasIn { p_cylinder: 9e5, p_crankcase: 1e5, rings: &places };
    let e = gas.rates(&inputs, &[0.0], &mut [0.0], &mut GasOut::new(1)).expect_err("no mass");
    assert!(e.is_recoverable() && e.to_string().contains("my_law"), "{e}");
}

/// Darcy's law, all links of a network at once, with the square of the pressure computed once a node; it counts its single flows.
#[derive(Debug, Clone)]
struct AtOnce {
    law: Darcy,
    single: Arc<AtomicUsize>,
}

impl PassageLaw for AtOnce {
    type Passage = Area;

    fn mass_flow_partials(&self, area: Area, a: &GasState, b: &GasState) -> FlowPartials {
        self.single.fetch_add(1, Ordering::Relaxed);
        self.law.mass_flow_partials(area, a, b)
    }

    fn node_factor(&self, gas: &GasState) -> f64 {
        gas.pressure() * gas.pressure()
    }

    fn mass_flows(&self, links: &[Link<Area>], nodes: &[Node], flow: &mut [f64]) {
        assert_eq!(flow.len(), links.len());
        for (link, flow) in links.iter().zip(flow) {
            let (a, b) = (&nodes[link.from()], &nodes[link.to()]);
            assert_eq!(a.factor(), a.gas().pressure().powi(2));
            if !link.is_split() {
                *flow = self.law.k * link.passage().0 * (a.factor() - b.factor());
            }
        }
    }
}

#[test]
fn a_law_that_computes_all_links_at_once() {
    const LINKS: [(usize, usize); 5] = [(0, 1), (1, 2), (2, 0), (2, 1), (0, 2)];
    let single = Arc::new(AtomicUsize::new(0));
    let law = AtOnce { law: Darcy { k: 1e-9 }, single: single.clone() };
    let mut net = Network::new(law, R, &[400.0; 3], 0, &LINKS).expect("builds");
    let mut plain = Network::new(Darcy { k: 1e-9 }, R, &[400.0; 3], 0, &LINKS).expect("builds");
    net.split_link(3, R * 400.0);
    net.set_split_passages(3, Area(3e-7), Area(1e-7));
    plain.split_link(3, R * 400.0);
    plain.set_split_passages(3, Area(3e-7), Area(1e-7));
    for (node, p) in [3e5, 7e5, 1e5].into_iter().enumerate() {
        net.set_pressure("test", node, p).expect("p");
        plain.set_pressure("test", node, p).expect("p");
    }
    for link in [0, 1, 2, 4] {
        let area = Area(1e-7 * (link + 1) as f64);
        net.set_passage(link, area);
        plain.set_passage(link, area);
    }
    net.update_flows();
    plain.update_flows();
    for link in 0..LINKS.len() {
        assert_eq!(net.flow(link), plain.flow(link), "{link}");
    }
    // Only the two passages in series were asked one by one: Newton's method on a function that bends a little needs few steps, each
    // with both passages, after two flows for the start. Halving alone would need fifty.
    let asked = single.load(Ordering::Relaxed);
    assert!((4..=2 + 2 * 9).contains(&asked), "{asked}");
}

#[test]
fn the_plain_pack_is_as_described() {
    let (pack, places) = plain_pack(3);
    assert_eq!((pack.rings.len(), pack.lands.len(), places.len()), (3, 4, 3));
    for (ring, place) in pack.rings.iter().zip(&places) {
        assert_eq!((place.h, place.s, place.lift_fraction, place.liner_radius), (2e-6, 0.0, 0.0, 0.05));
        assert_eq!((ring.clearance_inner, place.clearance, ring.gap_area), (50e-6, 50e-6, Some(5e-8)));
        assert_eq!((ring.back, place.back_volume), (BackVolume::Fixed(3e-7), 3e-7));
        // The flanks of a ring of this radial thickness; the groove is higher than the ring by the clearance.
        assert_eq!((place.r_outer, place.r_outer - place.r_inner), (0.05, 0.05 - (0.05 - ring.width)));
        assert!((ring.groove_height_inner - ring.height - place.clearance).abs() < 1e-18);
        assert!(ring.root_radius < place.r_inner && ring.piston_radius_above < 0.05);
    }
}
