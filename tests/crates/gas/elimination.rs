//! Spaces behind rings that store nothing.

use gudgeon_core::EvalError;
use gudgeon_core::geometry::{BackVolume, RingPlace};
use gudgeon_core::kinds::{GasFlow, GasFlowSpec, GasIn, GasOut};
use gudgeon_core::quantity::quantity;
use gudgeon_gas::{Elimination, NarrowChannel, OrificeNetwork};
use gudgeon_numerics::ode::{Flow, Integrator, OdeSystem, Options, Stats};
use gudgeon_numerics::radau::Radau5;

use crate::packs::{build, eliminated, names, pack, place};
use crate::support::Lcg;

#[test]
fn eliminated_spaces_are_the_limit_of_small_ones() {
    let backs = [BackVolume::Fixed(1e-13), BackVolume::Fixed(1e-13), BackVolume::OpenBelow];
    let p = pack(&backs);
    let mut rng = Lcg(5);
    let full: [Box<dyn GasFlowSpec>; 2] =
        [Box::new(OrificeNetwork::default()), Box::new(NarrowChannel::default())];
    for (full, eliminated) in full.iter().zip(eliminated()) {
        let (mut full, mut less) = (build(full.as_ref(), &p), build(eliminated.as_ref(), &p));
        assert_eq!(names(&*less), ["mass of land2", "mass of land3"]);
        assert_eq!(
            names(&*full),
            ["mass of ring1.back", "mass of land2", "mass of ring2.back", "mass of land3"]
        );
        for _ in 0..100 {
            let rings: Vec<_> =
                (0..3).map(|i| place(&p, i, rng.between(0.0, 1e-5), rng.between(0.0, 1.0), 0.0)).collect();
            let inp = GasIn { p_cylinder: rng.between(0.5e5, 150e5), p_crankcase: 1e5, rings: &rings };
            let lands = [inp.p_cylinder, rng.between(0.5e5, 30e5), rng.between(0.5e5, 30e5), 1e5];
            let (mut y, mut d, mut out) = ([0.0; 4], [0.0; 4], GasOut::new(3));
            full.at_pressures(&inp, &lands, &mut y);
            let (mut z, mut e, mut got) = ([0.0; 2], [0.0; 2], GasOut::new(3));
            less.at_pressures(&inp, &lands, &mut z);
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
        self.gas.n_masses()
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
    let p = pack(&[BackVolume::Fixed(back), BackVolume::Fixed(back), BackVolume::OpenBelow]);
    // The upper rings between the flanks: a few square centimetres into spaces of less than a cubic millimetre.
    let rings: Vec<_> = (0..3).map(|i| place(&p, i, 3e-6, 0.4, 0.0)).collect();
    let gas = build(spec, &p);
    let n = gas.n_masses();
    let (mut start, mut totals, mut stats) = (vec![0.0; n], [0.0; 2], Stats::default());
    gas.at_pressures(&Cycle::inputs(&rings, 0.0), &[1e5; 4], &mut start);
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
        names(&*build(&spec, &pack(&[BackVolume::Fixed(volume), BackVolume::Fixed(2.9e-7)])))
    };
    let all = ["mass of ring1.back", "mass of land2", "mass of ring2.back"];
    assert_eq!(names(2.9e-7, None), all);
    assert_eq!(names(2.9e-12, None), all[1..]);
    assert_eq!(names(2.9e-12, Some(1e-12)), all);
    // By default nothing is.
    let never = build(&OrificeNetwork::default(), &pack(&[BackVolume::Fixed(2.9e-12)]));
    assert_eq!(never.n_masses(), 1);
}
