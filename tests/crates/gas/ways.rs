//! The passages that a model names: what comes into a space through them and does not leave it is stored there, in every pack.

use gudgeon_core::geometry::{BackVolume, Drain, PackGeometry, Vent};
use gudgeon_core::kinds::{GasFlow, GasIn, GasOut, GasPartials, GasPassage, GasSpace, GasWay};

use crate::packs::{BACKS, build, eliminated, pack, place, specs, with_energy};

/// Packs of all kinds of grooves, closed, drained and vented.
fn packs() -> Vec<PackGeometry> {
    let mut all: Vec<PackGeometry> = BACKS.iter().map(|backs| pack(backs)).collect();
    let rails = [BackVolume::Geometric, BackVolume::Geometric, BackVolume::OpenBelow, BackVolume::OpenAbove];
    for vent in [Vent::Open, Vent::Drain(Drain { area: 1e-6, discharge: 0.7 })] {
        for ring in 0..3 {
            let mut grooves = pack(&[BackVolume::Geometric; 3]);
            grooves.rings[ring].vent = vent;
            all.push(grooves);
        }
        let mut spaces = pack(&rails);
        spaces.rings[1].vent = vent;
        spaces.lands[3].vent = vent;
        all.push(spaces);
    }
    all
}

/// The factor with which the flow of a passage comes into a space.
fn into(space: GasSpace) -> impl Fn(&GasPassage) -> f64 {
    let side = move |there: GasSpace| f64::from(u8::from(there == space));
    move |p| side(p.to) - side(p.from)
}

/// Of the volume of a state, by its name.
fn space(name: &str) -> GasSpace {
    let digit = |name: &str| name.parse::<usize>().expect("a number") - 1;
    match name.strip_prefix("mass of land") {
        Some(land) => GasSpace::Land(digit(land)),
        None => GasSpace::Behind(digit(name.trim_start_matches("mass of ring").trim_end_matches(".back"))),
    }
}

/// What the passages of an instant pass, against rates and flows; sums of a few flows, each rounded once, are within `16 ε` of their magnitudes.
fn holds(gas: &mut dyn GasFlow, pack: &PackGeometry, what: &str) {
    let n = pack.rings.len();
    let lift = [0.0, 0.4, 1.0, 0.2, 0.7];
    let rings: Vec<_> = (0..n).map(|i| place(pack, i, 3e-6, lift[i], 5e-5)).collect();
    let inp = GasIn { p_cylinder: 60e5, p_crankcase: 1.1e5, rings: &rings };
    let lands: Vec<f64> = [60e5, 12e5, 3e5, 1.7e5, 1.4e5][..n].iter().copied().chain([1.1e5]).collect();
    let states = gas.states().len();
    let (mut y, mut d) = (vec![0.0; states], vec![0.0; states]);
    gas.at_pressures(&inp, &lands, &mut y);
    let passages = gas.passages().to_vec();
    let mut out = GasOut { passages: vec![f64::NAN; passages.len()], ..GasOut::new(n) };
    gas.rates(&inp, &y, &mut d, &mut out).expect("rates");
    let admitted = 16.0 * f64::EPSILON * out.passages.iter().map(|f| f.abs()).sum::<f64>();
    let sum = |factor: &dyn Fn(&GasPassage) -> f64| -> f64 {
        passages.iter().zip(&out.passages).map(|(p, flow)| factor(p) * flow).sum()
    };
    let same = |a: f64, b: f64, of: &str| assert!((a - b).abs() <= admitted, "{what}: {of}, {a:e} {b:e}");
    let volumes: Vec<GasSpace> = gas.states()[..gas.n_masses()].iter().map(|s| space(&s.name)).collect();
    for (rate, space) in d.iter().zip(&volumes) {
        same(*rate, sum(&into(*space)), "stored");
    }
    same(out.flow_out[n - 1], sum(&into(GasSpace::Land(n))), "blow-by");
    let flank = |way: GasWay| matches!(way, GasWay::UpperFlank | GasWay::LowerFlank | GasWay::Groove);
    for (i, told) in out.flow_in.iter().enumerate() {
        let first = passages.iter().position(|p| p.ring == i && flank(p.way));
        let through = first.map_or(0.0, |k| out.passages[k]);
        let direct =
            |p: &GasPassage| f64::from(u8::from(p.ring == i && !flank(p.way) && p.way != GasWay::Drain));
        same(*told, through + sum(&direct), "into a ring");
    }
    let mut partials = GasPartials::new(n, states);
    partials.passages = vec![f64::NAN; passages.len() * states];
    if gas.partials(&inp, &y, &mut partials).expect("partials") {
        for (row, space) in partials.d_state.chunks_exact(states.max(1)).zip(&volumes) {
            for (k, by) in row.iter().enumerate() {
                let each = || passages.iter().zip(partials.passages.chunks_exact(states.max(1)));
                let of = |space: GasSpace| -> f64 { each().map(|(p, row)| into(space)(p) * row[k]).sum() };
                let size: f64 = each().map(|(_, row)| row[k].abs()).sum();
                assert!((by - of(*space)).abs() <= 16.0 * f64::EPSILON * size, "{what}: a partial");
            }
        }
    }
}

#[test]
fn what_the_passages_bring_is_stored() {
    for spec in specs().into_iter().chain(with_energy()).chain(eliminated()) {
        for pack in packs() {
            holds(&mut *build(spec.as_ref(), &pack), &pack, &format!("{spec:?}, {:?}", pack.lands));
        }
    }
}
