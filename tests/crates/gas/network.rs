//! Networks of volumes: closed forms, conservation, reference solutions, errors.

use gudgeon_gas::{Network, OrificeFormula, Passage};

use crate::support::{R, isentropic, law, rk4};

#[test]
fn labyrinth_passes_the_same_flow_everywhere() {
    // Pressures of 2, 3 and 5 equal orifices in series between 50 bar and 1 bar, γ = 1.4, with the flow p ψ; 25 digits.
    let cases: [(&[f64], f64); 3] = [
        (&[5e6, 4037291.647775880506623197, 1e5], 2764460.589801368356122553),
        (&[5e6, 4330714.559772494691558063, 3496871.54421417840905119, 1e5], 2394417.945234008797724973),
        (
            &[
                5e6,
                4575641.023314173384465554,
                4101443.292001157998426206,
                3552436.036150129271888198,
                2868444.067601394563767816,
                1e5,
            ],
            1964113.883945444297182067,
        ),
    ];
    let t = 400.0;
    for (p, norm) in cases {
        let n = p.len() - 1;
        let links: Vec<_> = (0..n).map(|i| (i, i + 1)).collect();
        let mut net = Network::new(isentropic(0.0), R, &vec![t; n + 1], 0, &links).expect("builds");
        for (i, &p) in p.iter().enumerate() {
            net.set_pressure("test", i, p).expect("p");
        }
        for l in 0..n {
            net.set_passage(l, Passage::Orifice { area: 1e-7 });
        }
        net.update_flows();
        for l in 0..n {
            let scaled = net.flow(l) / 1e-7 * (R * t).sqrt();
            // The fast form of ψ.
            assert!((scaled / norm - 1.0).abs() < 2e-9, "{l} {scaled}");
        }
    }
}

#[test]
fn choked_vessel_with_the_published_constants() {
    // p = p0 exp(-t/τ), τ = V/(0.259 k A R T sqrt(3.5·2/(R T))) = 0.01573926 s.
    let (volume, t, area, p0) = (5e-7, 450.0, 1.5e-7, 50e5);
    let law = law(OrificeFormula::IsentropicTruncated, 0.86, 0.0, 1.4);
    let mut net = Network::new(law, R, &[t, t], 1, &[(0, 1)]).expect("builds");
    net.set_passage(0, Passage::Orifice { area });
    net.set_pressure("test", 1, 1e5).expect("p");
    let mut f = |m: f64| {
        net.set_mass("test", 0, m, volume).expect("mass");
        net.update_flows();
        let mut d = [0.0];
        net.rates(&mut d);
        d[0]
    };
    let mut m = p0 * volume / (R * t);
    let tau = -m / f(m);
    assert!((tau / 0.01573926 - 1.0).abs() < 4e-7, "{tau}");
    let steps = 15_361; // The published explicit step 1.302e-6 s.
    let dt = 0.02 / f64::from(steps);
    for _ in 0..steps {
        m += dt * f(m);
    }
    let p = m * R * t / volume;
    // (1 - dt/τ)^n against exp: -t dt/(2 τ²) = -5.3e-5.
    assert!((p / 14.0316e5 - 1.0 + 5.3e-5).abs() < 0.5e-5, "{p}");
}

#[test]
fn blow_down_of_an_isothermal_vessel() {
    // 0.2 cm³ at 50 bar and 400 K through C_d A = 0.02 mm² into 1 bar, γ = 1.4; times from quadrature with 25 digits.
    let (volume, t, area, p_back) = (2e-7, 400.0, 2e-8, 1e5);
    let mut net = Network::new(isentropic(0.0), R, &[t, t], 1, &[(0, 1)]).expect("builds");
    net.set_passage(0, Passage::Orifice { area });
    net.set_pressure("test", 1, p_back).expect("p");
    let to_p = R * t / volume;
    let rate = |net: &mut Network, m: f64| {
        net.set_mass("test", 0, m, volume).expect("mass");
        net.update_flows();
        let mut d = [0.0];
        net.rates(&mut d);
        d[0]
    };
    // Steps of 1/40000 of the time; the law is smooth but for a jump of the third derivative at the choking point, which costs
    // dt³ there, 1e-10 of the time scale. ψ itself is right within 2e-9.
    let tolerance = 1e-8;
    let mut y = [5e6 / to_p];
    let dt = 0.1411152215951236159775142 / 40_000.0;
    let expected = [2205520.473109538790333043, 972864.1114610647636692721, 189292.9158737854088107288];
    let mut time = 0.0;
    let mut ratios = vec![
        (0.6, 0.1466225236848892669558042),
        (0.8, 0.1600403753911447764360531),
        (0.9, 0.1670407944979906629207547),
        (0.99, 0.1767768590811943182134717),
        (0.999, 0.1796517250930519803580495),
    ]
    .into_iter()
    .peekable();
    for step in 1..60_000 {
        let before = y[0];
        rk4(&mut y, 0.0, dt, |_, y, d| d[0] = rate(&mut net, y[0]));
        for (k, at) in [10_000, 20_000, 40_000].into_iter().enumerate() {
            if step == at {
                assert!((y[0] * to_p / expected[k] - 1.0).abs() < tolerance);
            }
        }
        if let Some(&(ratio, at)) = ratios.peek()
            && p_back / (y[0] * to_p) >= ratio
        {
            // Back to the crossing by one integral over the mass, dt = dm/m'.
            let target = p_back / ratio / to_p;
            let dm = target - before;
            let inverse: f64 = [(0.0, 1.0), (0.5, 4.0), (1.0, 1.0)]
                .into_iter()
                .map(|(x, w)| w / 6.0 / rate(&mut net, before + x * dm))
                .sum();
            let crossing = time + dm * inverse;
            assert!((crossing / at - 1.0).abs() < tolerance, "{ratio}: {crossing} {at}");
            ratios.next();
        }
        time += dt;
        if ratios.peek().is_none() {
            return;
        }
    }
    panic!("did not reach the last ratio");
}

#[test]
fn isolated_volume_and_two_vessels() {
    // Closed: nothing changes.
    let mut net = Network::new(isentropic(1e-3), R, &[350.0, 600.0], 2, &[(0, 1)]).expect("builds");
    let volumes = [3e-7, 1e-7];
    let mut d = [1.0; 2];
    for i in 0..2 {
        net.set_mass("test", i, 1e-6, volumes[i]).expect("mass");
    }
    net.update_flows();
    net.rates(&mut d);
    assert_eq!(d, [0.0; 2]);
    // Open: the pressures meet monotonically at m R/(V1/T1 + V2/T2).
    net.set_passage(0, Passage::Orifice { area: 1e-7 });
    let mut y = [1e-8, 3e-6];
    let total: f64 = y.iter().sum();
    let end = total * R / (volumes[0] / 350.0 + volumes[1] / 600.0);
    let mut last = f64::INFINITY;
    // The linear branch decays within 1e-5 s; steps a tenth of that.
    for _ in 0..40_000 {
        rk4(&mut y, 0.0, 1e-6, |_, y, d| {
            for i in 0..2 {
                net.set_mass("test", i, y[i], volumes[i]).expect("mass");
            }
            net.update_flows();
            net.rates(d);
        });
        let difference = net.pressure(1) - net.pressure(0);
        // At the end both pressures are equal within a few roundings.
        assert!(difference >= -1e-14 * end && difference <= last + 1e-14 * end);
        last = difference;
    }
    assert!((y[0] + y[1] - total).abs() <= 40_000.0 * 1.2e-16 * total, "mass");
    for i in 0..2 {
        assert!((net.pressure(i) / end - 1.0).abs() < 1e-11, "{}", net.pressure(i) / end - 1.0);
    }
}

#[test]
fn says_what_is_wrong() {
    let law = isentropic(1e-3);
    assert!(Network::new(law.clone(), R, &[300.0, 0.0], 1, &[]).is_err());
    assert!(Network::new(law.clone(), R, &[300.0], 1, &[(0, 1)]).is_err());
    assert!(Network::new(law.clone(), R, &[300.0], 2, &[]).is_err());
    assert!(Network::new(law.clone(), R, &[300.0, f64::INFINITY], 1, &[]).is_err());
    assert!(Network::new(law.clone(), -R, &[-300.0], 1, &[]).is_ok_and(|net| net.volumes() == 1));
    let mut net = Network::new(law, R, &[300.0, 300.0], 1, &[(0, 1)]).expect("builds");
    for (m, v) in [(0.0, 1.0), (-1.0, 1.0), (1.0, 0.0), (f64::NAN, 1.0), (f64::MAX, f64::MIN_POSITIVE)] {
        assert!(net.set_mass("test", 0, m, v).expect_err("refused").is_recoverable());
    }
    for p in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(net.set_pressure("test", 1, p).is_err());
    }
}
