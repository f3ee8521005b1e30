//! Partial derivatives of all models on whole packs, against differences.

use gudgeon_core::geometry::BackVolume;
use gudgeon_core::kinds::{GasIn, GasOut, GasPartials};
use gudgeon_core::quantity::quantity;
use gudgeon_gas::Prescribed;

use crate::packs::{BACKS, build, eliminated, pack, place, specs};
use crate::support::Lcg;

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
fn partials_agree_with_differences() {
    let mut rng = Lcg(11);
    let (mut compared, mut reversed, mut choked) = (0, 0, 0);
    for spec in specs().into_iter().chain(eliminated()) {
        for backs in BACKS {
            let pack = pack(backs);
            let n = backs.len();
            let mut gas = build(spec.as_ref(), &pack);
            let m = gas.n_masses();
            let (mut state, mut out) = (vec![0.0; m], GasOut::new(n));
            let (mut low, mut high) = ((vec![0.0; m], GasOut::new(n)), (vec![0.0; m], GasOut::new(n)));
            let (mut d, mut partials) = (vec![0.0; m], GasPartials::new(n, m));
            for _ in 0..40 {
                let rings: Vec<_> = (0..n)
                    .map(|i| {
                        let e = (rng.between(-0.3, 1.3)).clamp(0.0, 1.0);
                        place(&pack, i, rng.between(0.0, 1e-5), e, rng.between(0.0, 1e-4))
                    })
                    .collect();
                let inp = GasIn { p_cylinder: rng.between(0.5e5, 150e5), p_crankcase: 1e5, rings: &rings };
                let lands: Vec<_> = (0..=n).map(|_| rng.between(0.5e5, 30e5)).collect();
                gas.at_pressures(&inp, &lands, &mut state);
                for m in &mut state {
                    *m *= rng.between(0.7, 1.4);
                }
                gas.rates(&inp, &state, &mut d, &mut out).expect("rates");
                assert!(gas.partials(&inp, &state, &mut partials).expect("partials"));
                // The balance of masses holds for the derivatives too: up to 4 n of them are added in another order.
                for k in 0..m {
                    let column = |rows: &[f64]| rows.iter().skip(k).step_by(m).copied().collect::<Vec<_>>();
                    let (rates, into, from) =
                        (column(&partials.d_state), column(&partials.flow_in), column(&partials.flow_out));
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
                    check("rates", &partials.d_state, &low.0, &high.0, noise);
                    check("in", &partials.flow_in, &low.1.flow_in, &high.1.flow_in, noise);
                    check("out", &partials.flow_out, &low.1.flow_out, &high.1.flow_out, noise);
                    // Two roundings of a pressure.
                    let noise = 4.0 * f64::EPSILON * 150e5 / width;
                    check("land", &partials.p_land, &low.1.p_land, &high.1.p_land, noise);
                    check("back", &partials.p_back, &low.1.p_back, &high.1.p_back, noise);
                }
            }
        }
    }
    assert!(compared > 2000 && reversed > 500 && choked > 500, "{compared} {reversed} {choked}");
}

#[test]
fn partials_are_finite_at_equal_pressures() {
    for spec in specs().into_iter().chain(eliminated()) {
        let pack = pack(&[BackVolume::Geometric, BackVolume::Geometric, BackVolume::OpenBelow]);
        let rings: Vec<_> = (0..3).map(|i| place(&pack, i, 3e-6, 0.5, 5e-5)).collect();
        let inp = GasIn { p_cylinder: 1e5, p_crankcase: 1e5, rings: &rings };
        let mut gas = build(spec.as_ref(), &pack);
        let n = gas.n_masses();
        let (mut state, mut partials) = (vec![0.0; n], GasPartials::new(3, n));
        gas.at_pressures(&inp, &[1e5; 4], &mut state);
        assert!(gas.partials(&inp, &state, &mut partials).expect("partials"));
        assert!(
            partials.d_state.iter().chain(&partials.flow_in).chain(&partials.flow_out).all(|x| x.is_finite())
        );
        // More gas in a volume, more flows out of it.
        assert!((0..n).all(|k| partials.d_state[k * n + k] < 0.0), "{spec:?} {partials:?}");
    }
    // Given pressures have no masses.
    let mut none = build(&Prescribed { lands: vec![quantity(2e5)] }, &pack(&BACKS[3][..2]));
    let rings = [place(&pack(BACKS[0]), 0, 3e-6, 0.5, 0.0); 2];
    let inp = GasIn { p_cylinder: 3e5, p_crankcase: 1e5, rings: &rings };
    assert!(!none.partials(&inp, &[], &mut GasPartials::new(2, 0)).expect("nothing to refuse"));
}
