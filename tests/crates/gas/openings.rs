//! Openings and volumes that follow from where the rings are: nominal films, unbound lifts, filling times.

use std::f64::consts::TAU;

use gudgeon_core::geometry::{BackVolume, Chamfer, PackGeometry, RingPlace};
use gudgeon_core::kinds::{GasFlowSpec, GasIn, GasOut};
use gudgeon_core::quantity::quantity;
use gudgeon_gas::{
    BackVolumes, Elimination, FilmHeight, FlankGap, GapOrifice, GasState, NarrowChannel, Orifice,
    OrificeFormula, OrificeNetwork,
};

use crate::packs::{build, pack, place};
use crate::support::R;

const BACKS: [BackVolume; 3] = [BackVolume::Geometric, BackVolume::Fixed(2e-7), BackVolume::OpenBelow];

/// Rates and outputs of a model with the masses of 20, 8, 3 and 1 bar at the given places.
fn run(
    spec: &dyn GasFlowSpec,
    pack: &PackGeometry,
    rings: &[RingPlace],
    unbound: bool,
) -> (Vec<f64>, GasOut) {
    let mut gas = build(spec, pack);
    if unbound {
        gas.unbound();
    }
    let inp = GasIn { p_cylinder: 20e5, p_crankcase: 1e5, rings };
    let n = gas.n_masses();
    let (mut y, mut d, mut out) = (vec![0.0; n], vec![0.0; n], GasOut::new(rings.len()));
    gas.at_pressures(&inp, &[20e5, 8e5, 3e5, 1e5][..=rings.len()], &mut y);
    gas.rates(&inp, &y, &mut d, &mut out).expect("rates");
    y.extend(d);
    (y, out)
}

#[test]
fn a_nominal_film_is_a_film_of_that_thickness() {
    let pack = pack(&BACKS);
    let film = 7e-6;
    let specs = |height| -> [Box<dyn GasFlowSpec>; 2] {
        let nominal_film = quantity(film);
        [
            Box::new(OrificeNetwork { film_height: height, nominal_film, ..OrificeNetwork::default() }),
            Box::new(NarrowChannel { film_height: height, nominal_film, ..NarrowChannel::default() }),
        ]
    };
    for (nominal, instant) in specs(FilmHeight::Nominal).iter().zip(specs(FilmHeight::Instantaneous)) {
        for e in [0.0, 0.3, 1.0] {
            let at = |h: f64| -> Vec<_> { (0..3).map(|i| place(&pack, i, h, e, 6e-5)).collect() };
            let (y, out) = run(nominal.as_ref(), &pack, &at(1e-6), false);
            let (z, same) = run(instant.as_ref(), &pack, &at(film), false);
            // The same sums in another order: the clearance is the difference of 0.1 mm and a few µm.
            for (a, b) in y.iter().zip(&z).chain(out.flow_in.iter().zip(&same.flow_in)) {
                assert!((a / b - 1.0).abs() < 1e-11, "{e}: {a:e} {b:e}");
            }
            for (a, b) in out.flow_out.iter().zip(&same.flow_out).chain(out.p_back.iter().zip(&same.p_back)) {
                assert!((a / b - 1.0).abs() < 1e-11, "{e}: {a:e} {b:e}");
            }
        }
    }
}

/// The orifice network as its source has it, whose scheme takes lifts as they come.
fn published() -> OrificeNetwork {
    let orifice = Orifice { law: OrificeFormula::IsentropicTruncated, ..Orifice::default() };
    OrificeNetwork { orifice, ..OrificeNetwork::default() }
}

/// Choked flow through an area, by the same law: `C_d p/√(R T) √(2γ/(γ-1)) 0.259`.
fn per_area(from: (f64, f64)) -> f64 {
    0.86 * from.0 / (R * from.1).sqrt() * 7.0_f64.sqrt() * 0.259
}

#[test]
fn unbound_lifts_are_taken_as_they_come() {
    let mut pack = pack(&[BackVolume::OpenBelow]);
    {
        let r = &mut pack.rings[0];
        (r.gap_area, r.chamfer, r.leak_face) = (Some(1e-7), Chamfer::default(), 0.0);
        (r.slope_upper, r.slope_lower, r.clearance_inner) = (0.0, 0.0, 5e-5);
    }
    let open = per_area((20e5, 523.15));
    for s in [-1e-5, 0.0, 2e-5, 5e-5, 8e-5] {
        let at = RingPlace { s, ..place(&pack, 0, 0.0, (s / 5e-5_f64).clamp(0.0, 1.0), 0.0) };
        let area = |upper: f64| TAU * 0.05965 * (upper + 2e-8) + 1e-7;
        let (_, bounded) = run(&published(), &pack, &[at], false);
        let (_, unbound) = run(&published(), &pack, &[at], true);
        // A few roundings of areas that are sums of positive and negative parts of up to 2e-5 m².
        let within = 1e-15 * open * 2e-5 * 10.0;
        assert!((bounded.flow_in[0] - open * area((5e-5 - s).clamp(0.0, 5e-5))).abs() < within, "{s}");
        assert!((unbound.flow_in[0] - open * area(5e-5 - s)).abs() < within, "{s}");
        // A height whose cube counts, and lifts that a model only has three of, stay bounded.
        let others: [Box<dyn GasFlowSpec>; 2] =
            [Box::new(NarrowChannel::default()), Box::new(GapOrifice::default())];
        for spec in others {
            assert_eq!(run(spec.as_ref(), &pack, &[at], false).1, run(spec.as_ref(), &pack, &[at], true).1);
        }
    }
}

#[test]
fn an_unbound_gap_may_be_negative() {
    let mut pack = pack(&[BackVolume::Sealed]);
    {
        let r = &mut pack.rings[0];
        (r.chamfer, r.leak_face) = (Chamfer::default(), 0.0);
    }
    let open = per_area((20e5, 523.15));
    // A ring 0.4 mm off the liner is 0.05 mm behind its land.
    let at = place(&pack, 0, 0.4e-3, 0.0, 0.0);
    let beyond = 0.4e-3 - 50e-6;
    let face = TAU * (0.06 - 0.4e-3) * (beyond * beyond / (beyond + 5e-6));
    let (_, bounded) = run(&published(), &pack, &[at], false);
    let (_, unbound) = run(&published(), &pack, &[at], true);
    // A few roundings, and those of the distances of 50 and 400 µm from radii of 60 mm: 1e-17/5e-5.
    assert!((bounded.flow_in[0] / (open * face) - 1.0).abs() < 1e-12);
    let area = face + 0.4e-3 * (0.06 - 0.05965 - 0.4e-3);
    assert!((unbound.flow_in[0] / (open * area) - 1.0).abs() < 1e-12);
}

#[test]
fn merged_volumes_limit_explicit_steps() {
    let merged = GapOrifice { back_volumes: BackVolumes::Merged, ..GapOrifice::default() };
    let step = |spec: &GapOrifice, pack: &PackGeometry| build(spec, pack).max_explicit_step();
    let fixed = |volumes: &[f64]| pack(&volumes.iter().map(|v| BackVolume::Fixed(*v)).collect::<Vec<_>>());
    let p = fixed(&[2e-7, 3e-7, 5e-7]);
    assert_eq!(step(&GapOrifice::default(), &p), None);
    // One ring has no land between.
    assert_eq!(step(&merged, &fixed(&[2e-7])), Some(1e-7));
    // Land 2 of 0.45 cm³ at 503.15 K between the spaces 1 and 2, land 3 of 0.3 cm³ at 483.15 K between 2 and 3, at 503.15 K each.
    let ratios = [(2e-7 + 3e-7) / (9e-7 / 2.0), (3e-7 + 5e-7) / 503.15 * 483.15 / (9e-7 / 3.0)];
    let expected = 1e-7 / (1.0 + f64::max(ratios[0], ratios[1]));
    let is = step(&merged, &p).expect("tied");
    // A few roundings.
    assert!((is / expected - 1.0).abs() < 1e-14, "{is:e} {expected:e}");
    // Drained grooves store nothing, those of the geometry what is behind the ring without a film.
    let mut p = pack(&[BackVolume::Geometric, BackVolume::OpenBelow]);
    p.lands[1].temperature = 503.15;
    let behind = place(&p, 0, 0.0, 0.0, 0.0).back_volume;
    let is = step(&merged, &p).expect("tied");
    assert!((is / (1e-7 / (1.0 + behind / 4.5e-7)) - 1.0).abs() < 1e-14);
}

#[test]
fn spaces_are_eliminated_below_their_filling_time() {
    let film = 3e-6;
    for back in [BackVolume::Fixed(2.9e-7), BackVolume::Geometric] {
        for gap_area in [Some(2e-7), None] {
            let mut p = pack(&[back]);
            p.rings[0].gap_area = gap_area;
            let at = place(&p, 0, film, 0.0, 0.0);
            let volume = if let BackVolume::Fixed(v) = back { v } else { at.back_volume };
            let gap = gap_area.unwrap_or(0.4e-3 * (0.06 - 0.05965 - film));
            let law = Orifice::default().build(1.4, R).expect("builds");
            let rt = R * 503.15;
            let flow = |area: f64| law.flow_exact(area, &GasState::new(1e5, rt), &GasState::new(0.9e5, rt));
            // The longest: on the flank where the smaller radius has the whole clearance.
            let longest = [0.0, 0.5, 1.0].into_iter().fold(0.0_f64, |longest, e| {
                let upper = TAU * 0.05965 * ((1.0 - e) * at.clearance + 2e-8) + 0.5 * gap;
                let lower = TAU * 0.0597 * (e * at.clearance + 3e-8) + 0.5 * gap;
                longest.max(volume * 1e4 / (rt * (flow(upper) + flow(lower))))
            });
            let states = |limit: f64| {
                let spec = OrificeNetwork {
                    eliminate: Elimination::Auto,
                    eliminate_below: quantity(limit),
                    film_height: FilmHeight::Nominal,
                    nominal_film: quantity(film),
                    ..OrificeNetwork::default()
                };
                build(&spec, &p).n_masses()
            };
            // The fast flow function is right within 2e-9.
            assert_eq!((states(longest * (1.0 - 1e-8)), states(longest * (1.0 + 1e-8))), (1, 0), "{back:?}");
        }
    }
}

/// A wedge passes what parallel gaps in series along its width pass.
#[test]
fn wedges_at_the_flanks() {
    for (mean, rise) in [(3e-5, 1e-5), (3e-5, -1e-5), (2e-6, 1.9e-6), (5e-5, 0.0)] {
        let gap = FlankGap::wedge(mean, rise);
        assert!((gap.outer - gap.inner - 2.0 * rise).abs() < 1e-20);
        assert!((0.5 * (gap.outer + gap.inner) - mean).abs() < 1e-20);
        assert_eq!(gap.narrowest(), mean - rise.abs());
        // Mean of 1/h³ over the width by the midpoint rule in ln h, which makes the integrand smooth: dx/width = h d(ln h)/(b - a).
        let resistance = if rise == 0.0 {
            mean.powi(-3)
        } else {
            let (a, b, n) = (gap.inner.ln(), gap.outer.ln(), 4000);
            let step = (b - a) / f64::from(n);
            (0..n).map(|k| (-2.0 * (a + (f64::from(k) + 0.5) * step)).exp() * step).sum::<f64>()
                / (gap.outer - gap.inner)
        };
        // Midpoint rule of exp(-2x): relative error step²/6, below 2e-7 for steps of 1e-3.
        assert!((gap.laminar().powi(-3) / resistance - 1.0).abs() < 1e-6, "{mean} {rise}");
    }
    // Closed at one edge: nothing gets through either way. A gap below zero stays what it is while it is parallel.
    for rise in [4e-5, -4e-5] {
        let gap = FlankGap::wedge(3e-5, rise);
        assert_eq!((gap.narrowest(), gap.laminar()), (0.0, 0.0));
    }
    assert_eq!(FlankGap::wedge(-1e-6, 0.0), FlankGap::parallel(-1e-6));
    assert_eq!((FlankGap::parallel(-1e-6).narrowest(), FlankGap::parallel(2e-6).laminar()), (-1e-6, 2e-6));
}
