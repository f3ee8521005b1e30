//! Channels and their combinations with orifices.

use gudgeon_gas::{
    GasState, Network, Passage, PassageLaw, TRANSITION, channel_conductance, sutherland_viscosity,
    turbulent_share,
};

use crate::support::{R, isentropic};

#[test]
fn channel_and_viscosity() {
    // w h³ (p1² - p2²)/(24 μ R T L) with w 0.3 m, h 10 µm, L 2 mm, μ 20 µPa s, T 450 K, 10 and 2 bar; 25-digit value.
    let conductance = channel_conductance(0.3, 1e-5, 2e-3, 2e-5, R * 450.0);
    let mut net = Network::new(isentropic(0.0), R, &[450.0, 450.0], 0, &[(0, 1)]).expect("builds");
    net.set_pressure("test", 0, 1e6).expect("p");
    net.set_pressure("test", 1, 2e5).expect("p");
    net.set_passage(0, Passage::Channel { conductance });
    net.update_flows();
    assert!((net.flow(0) / 0.002322880371660859465737515 - 1.0).abs() < 1e-14);
    // Handbook values for air, against the 2 % the law claims.
    for (t, mu) in [(200.0, 13.25e-6), (300.0, 18.46e-6), (500.0, 27.01e-6), (700.0, 33.88e-6)] {
        assert!((sutherland_viscosity(t) / mu - 1.0).abs() < 0.02);
    }
    assert_eq!(sutherland_viscosity(273.15), 1.716e-5);
}

#[test]
fn limited_channel_lies_below_both_and_joins_them() {
    let mut net =
        Network::new(isentropic(1e-3), R, &[500.0, 400.0], 0, &[(0, 1), (0, 1), (0, 1)]).expect("builds");
    let bare = isentropic(0.0);
    for height in [1e-7, 1e-6, 1e-5, 1e-4, 1e-3] {
        let (perimeter, length) = (0.37, 5e-3);
        let area = perimeter * height;
        let conductance = channel_conductance(perimeter, height, length, 2.5e-5, R * 450.0);
        net.set_passage(0, Passage::LimitedChannel { conductance, area });
        net.set_passage(1, Passage::Channel { conductance });
        for (p_a, p_b) in [(1e7, 1e5), (2e5, 1e5), (1e5, 9.99e4), (1e5, 1e5), (3e5, 7e6)] {
            net.set_pressure("test", 0, p_a).expect("p");
            net.set_pressure("test", 1, p_b).expect("p");
            net.update_flows();
            let (both, channel) = (net.flow(0), net.flow(1));
            let orifice = bare.flow(area, &GasState::new(p_a, R * 500.0), &GasState::new(p_b, R * 400.0));
            assert!(both.abs() <= channel.abs() && both.abs() <= orifice.abs() && both * channel >= 0.0);
            // c/o is the small parameter of one limit, o/c of the other.
            if orifice != 0.0 {
                let x = channel / orifice;
                assert!((both / channel - 1.0).abs() <= x * x * 1.0001 + 1e-15);
                assert!((both / orifice - 1.0).abs() <= 0.5001 / x);
                // The pressure losses add: both/c + (both/o)² = 1.
                assert!((both / channel + (both / orifice).powi(2) - 1.0).abs() < 1e-13);
            }
        }
    }
}

#[test]
fn turbulent_friction_far_above_the_transition() {
    assert!((TRANSITION / (96.0_f64 / 0.3164).powf(4.0 / 3.0) - 1.0).abs() < 1e-15);
    // Far above, the flow has the Reynolds number Re with f = 0.3164 Re^(-1/4) and f Re² = 96 Re_laminar; far below it is laminar.
    // What is left of the other branch is x^∓3/7: 1e-9 each at 2e2.7 times the transition.
    for laminar in [1e9, 1e12] {
        let re = turbulent_share(laminar).0 * laminar;
        assert!((0.3164 * re.powf(1.75) / (96.0 * laminar) - 1.0).abs() < 1e-9);
    }
    assert!((turbulent_share(2.0).0 - 1.0).abs() < 2e-10);
    // 2^(-1/7) at the transition.
    assert!((turbulent_share(TRANSITION).0 - 0.5f64.powf(1.0 / 7.0)).abs() < 1e-15);
    // The share of the slope is the derivative of the flow by the laminar flow.
    for re in [10.0, 1e3, 2e3, 1e4, 1e7] {
        let d = 1e-5 * re;
        let flow = |re: f64| re * turbulent_share(re).0;
        let central = (flow(re + d) - flow(re - d)) / (2.0 * d);
        // Truncation 1e-10, rounding 1e-16/1e-5.
        assert!((central - turbulent_share(re).1).abs() < 1e-9, "{re}");
    }
    // Overflowing Reynolds numbers leave a share that is a number.
    assert!(turbulent_share(f64::INFINITY).0 > 0.0);
}

#[test]
fn blended_channel_lies_below_the_laminar_one() {
    let law = isentropic(0.0);
    let b = GasState::new(1e5, R * 450.0);
    for p in [1.0001e5, 2e5, 1e6, 1e7] {
        let a = b.with_pressure(p);
        for height in [1e-6, 1e-5, 1e-4] {
            let (conductance, area) = (channel_conductance(0.3, height, 2e-3, 2e-5, R * 450.0), 0.3 * height);
            let limited = Passage::LimitedChannel { conductance, area };
            let blended = Passage::BlendedChannel { conductance, area, unit_flow: 0.5 * 0.3 * 2e-5 };
            let (l, f) = (law.mass_flow(limited, &a, &b), law.mass_flow(blended, &a, &b));
            assert!(f > 0.0 && f <= l, "{p} {height}");
            assert_eq!(law.mass_flow(blended, &b, &a), -f);
            // Reynolds number of the laminar channel 2 c/(w μ): the two differ by x³/7 while that is small.
            let x = conductance * (p * p - 1e10) / (0.5 * 0.3 * 2e-5) / TRANSITION;
            if x < 0.1 {
                assert!(1.0 - f / l <= x * x * x / 7.0 + 1e-15);
            }
            let s = law.mass_flow_partials(blended, &a, &b);
            let d = 1e-4 * (p - 1e5);
            let shifted = |delta: f64| law.mass_flow(blended, &a.with_pressure(p + delta), &b);
            let central = (shifted(d) - shifted(-d)) / (2.0 * d);
            // Truncation 1e-8; the flow function's own derivative is good to 1e-7.
            assert!((central / s.by_a - 1.0).abs() < 3e-7, "{p} {height}: {central} {}", s.by_a);
            assert!((s.flow / f - 1.0).abs() < 1e-14);
        }
    }
}
