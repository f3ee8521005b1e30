//! Two passages in series.

use gudgeon_gas::{GasState, Network, Passage, PassageLaw};

use crate::support::{Lcg, R, isentropic};

#[test]
fn two_passages_in_series() {
    let mut rng = Lcg(1);
    let mut number = |from: f64, to: f64| rng.log_between(from, to);
    for case in 0..2000 {
        let eps = [0.0, 1e-3, 1e-6][case % 3];
        let law = isentropic(eps);
        let ends = |n: &mut Network, p: [f64; 2]| {
            n.set_pressure("test", 0, p[0]).expect("p");
            n.set_pressure("test", 1, p[1]).expect("p");
        };
        let t = [number(300.0, 900.0), number(300.0, 900.0)];
        let mut net = Network::new(law.clone(), R, &t, 0, &[(0, 1)]).expect("builds");
        net.split_link(0, R * 500.0);
        let areas = [number(1e-12, 1e-4), number(1e-12, 1e-4)];
        let passage = |k: usize| match (case / 3 + k) % 3 {
            0 => Passage::Orifice { area: areas[k] },
            1 => Passage::Channel { conductance: 1e-7 * areas[k] },
            _ => Passage::LimitedChannel { conductance: 1e-6 * areas[k], area: areas[k] },
        };
        net.set_split_passages(0, passage(0), passage(1));
        let p = [number(5e4, 1e7), number(5e4, 1e7)];
        ends(&mut net, p);
        net.update_partials();
        let (flow, slope, middle, by) =
            (net.flow(0), net.partials(0), net.middle_pressure(0), net.middle_partials(0));
        assert!(middle >= p[0].min(p[1]) && middle <= p[0].max(p[1]));
        assert!(flow == 0.0 || (flow > 0.0) == (p[0] > p[1]), "{case}: {flow} {p:?}");
        // What comes in leaves, but for the rounding of the pressure between: the search ends at
        // 2 ε of it and the drop is rounded, together below 9 ε, times how the flows depend on it. (Below a
        // relative pressure drop of 1e-8 a mouth without laminar branch gives a slope that stands for a much larger one.)
        let [a, b] = [0, 1].map(|end| GasState::new(p[end], R * t[end]));
        let between = GasState::new(middle, R * 500.0);
        let [inflow, outflow] = [
            law.mass_flow_partials(passage(0), &a, &between),
            law.mass_flow_partials(passage(1), &between, &b),
        ];
        let smallest = p.map(|p| (p / middle - 1.0).abs()).into_iter().fold(1.0, f64::min);
        let rounding = 2e-15 * middle * (inflow.by_b.abs() + outflow.by_a);
        assert!(
            smallest < 1e-8 || (inflow.flow - outflow.flow).abs() <= rounding + 1e-14 * inflow.flow.abs(),
            "{case}: {:e} {:e} {rounding:e}",
            inflow.flow,
            outflow.flow
        );
        // The same at once with the other call, to the last bit.
        net.update_flows();
        assert_eq!((net.flow(0), net.middle_pressure(0)), (flow, middle));
        if smallest < 1e-4 || (p[0] / p[1]).ln().abs() < 1e-2 {
            continue;
        }
        for end in 0..2 {
            let mut at = |d: f64| {
                let mut q = p;
                q[end] += d;
                ends(&mut net, q);
                net.update_flows();
                (net.flow(0), net.middle_pressure(0))
            };
            let d = 1e-5 * p[end];
            let (up, down) = (at(d), at(-d));
            let central = [(up.0 - down.0) / (2.0 * d), (up.1 - down.1) / (2.0 * d)];
            // Truncation and the kink where a passage chokes: 1e-5 of the scales flow/p and 1; rounding of the pressure between,
            // 1e-16/1e-5, on what depends on it.
            let scale = flow.abs() / p[end];
            assert!(
                (central[0] - slope[end]).abs() < 1e-3 * (scale + slope[end].abs()),
                "{case} {end}: {:e} {:e}",
                central[0],
                slope[end]
            );
            assert!(
                (central[1] - by[end]).abs() < 1e-3 * (1.0 + by[end].abs() + middle / p[end]),
                "{case} {end}"
            );
        }
    }
    // Closed on one side, on both, and equal pressures.
    let mut net = Network::new(isentropic(1e-3), R, &[400.0; 2], 0, &[(0, 1)]).expect("builds");
    net.split_link(0, R * 400.0);
    net.set_pressure("test", 0, 3e5).expect("p");
    net.set_pressure("test", 1, 1e5).expect("p");
    let open = Passage::Orifice { area: 1e-7 };
    for (first, second, p) in [
        (open, Passage::Closed, Some(3e5)),
        (Passage::Closed, open, Some(1e5)),
        (Passage::Closed, Passage::Closed, None),
    ] {
        net.set_split_passages(0, first, second);
        net.update_partials();
        assert_eq!((net.flow(0), net.partials(0)), (0.0, [0.0; 2]));
        // The laminar branch ends within rounding of the open side.
        assert!(p.is_none_or(|p: f64| (net.middle_pressure(0) / p - 1.0).abs() < 1e-15));
    }
    net.set_split_passages(0, open, open);
    net.set_pressure("test", 1, 3e5).expect("p");
    net.update_flows();
    assert_eq!((net.flow(0), net.middle_pressure(0)), (0.0, 3e5));
}
