//! The balance of energy of the gas on the lands and behind the rings.

use std::f64::consts::TAU;

use gudgeon_core::geometry::{BackVolume, Chamfer, PackGeometry, RingPlace};
use gudgeon_core::kinds::{GasFlow, GasFlowCtx, GasFlowSpec, GasIn, GasOut, GasPartials};
use gudgeon_core::quantity::quantity;
use gudgeon_gas::{GasTemperature, OrificeNetwork, sutherland_viscosity};

use crate::packs::{build, names, pack, place, with_energy};
use crate::support::{R, rk4};

const GAMMA: f64 = 1.4;

fn spec(nusselt: f64) -> OrificeNetwork {
    OrificeNetwork {
        gas_temperature: GasTemperature::EnergyBalance,
        nusselt: quantity(nusselt),
        ..OrificeNetwork::default()
    }
}

/// Two rings without room behind them, whose gaps have these areas: the land between is a vessel of 0.45 cm³ at 503.15 K.
fn vessel(gaps: [f64; 2]) -> PackGeometry {
    let mut p = pack(&[BackVolume::Sealed, BackVolume::Sealed]);
    for (ring, gap) in p.rings.iter_mut().zip(gaps) {
        (ring.gap_area, ring.leak_face, ring.chamfer) = (Some(gap), 0.0, Chamfer::default());
    }
    p
}

/// Follows the vessel for `steps` of `dt` \[s\] and gives its mass and energy.
fn follow(pack: &PackGeometry, nusselt: f64, p: [f64; 3], steps: usize, dt: f64) -> ([f64; 2], [f64; 2]) {
    let mut gas = build(&spec(nusselt), pack);
    let rings = [place(pack, 0, 0.0, 0.5, 0.0), place(pack, 1, 0.0, 0.5, 0.0)];
    let inp = GasIn { p_cylinder: p[0], p_crankcase: p[2], rings: &rings };
    let mut y = [0.0; 2];
    gas.at_pressures(&inp, &p, &mut y);
    let start = y;
    let mut out = GasOut::new(2);
    for _ in 0..steps {
        rk4(&mut y, 0.0, dt, |_, y, d| gas.rates(&inp, y, d, &mut out).expect("rates"));
    }
    (start, y)
}

/// `U = m c_v T`, `c_p = γ R/(γ - 1)`.
fn temperature(m: f64, u: f64) -> f64 {
    u * (GAMMA - 1.0) / (m * R)
}

#[test]
fn filling_without_heat() {
    // All that enters brings c_p T of the cylinder, 523.15 K: U - U_0 = c_p T (m - m_0).
    let (start, end) = follow(&vessel([1e-7, 0.0]), 0.0, [20e5, 1e5, 1e5], 2000, 1e-5);
    let brought = GAMMA / (GAMMA - 1.0) * R * 523.15 * (end[0] - start[0]);
    assert!(end[0] > 5.0 * start[0]);
    // One rounding a step.
    assert!(((end[1] - start[1]) / brought - 1.0).abs() < 1e-12);
    // The gas gets warmer than both the walls and the gas that enters.
    assert!(temperature(end[0], end[1]) > 600.0);
}

#[test]
fn emptying_without_heat_is_isentropic() {
    let (start, end) = follow(&vessel([0.0, 1e-7]), 0.0, [1e5, 20e5, 1e5], 2000, 3e-5);
    assert!(end[0] < 0.3 * start[0]);
    let [before, after] = [start, end].map(|y| temperature(y[0], y[1]));
    // Steps of Runge-Kutta's method of fourth order: 2000 over a few time constants, error below 1e-10.
    assert!((after / before / (end[0] / start[0]).powf(GAMMA - 1.0) - 1.0).abs() < 1e-9);
}

#[test]
fn heat_to_the_walls() {
    // Nothing flows: dT/dt = -Nu λ V/s² (T - T_w)/(m c_v), λ = μ c_p/0.7, and the rate of T is that of U over m c_v.
    let pack = vessel([0.0, 0.0]);
    let rings = [place(&pack, 0, 0.0, 0.5, 0.0), place(&pack, 1, 0.0, 0.5, 0.0)];
    let inp = GasIn { p_cylinder: 1e5, p_crankcase: 1e5, rings: &rings };
    let (wall, s, volume) = (503.15, 0.06 - 0.05965, 4.5e-7);
    let mut gas = build(&spec(7.54), &pack);
    let (mut y, mut d, mut out) = ([0.0; 2], [0.0; 2], GasOut::new(2));
    gas.at_pressures(&inp, &[1e5, 8e5, 1e5], &mut y);
    assert!((temperature(y[0], y[1]) / wall - 1.0).abs() < 1e-14);
    gas.rates(&inp, &y, &mut d, &mut out).expect("rates");
    // Roundings of the temperature, at walls of the same.
    assert!(d[0] == 0.0 && d[1].abs() < 1e-10);
    y[1] *= 1.2;
    gas.rates(&inp, &y, &mut d, &mut out).expect("rates");
    let conductivity = sutherland_viscosity(wall) * GAMMA / (GAMMA - 1.0) * R / 0.7;
    let heat = 7.54 * conductivity * volume / (s * s) * 0.2 * wall;
    // The difference of temperatures is a sixth of the higher one: a few roundings.
    assert!((-d[1] / heat - 1.0).abs() < 1e-13 && out.power == d[1]);
    assert!(
        (out.p_land[1] / 9.6e5 - 1.0).abs() < 1e-14,
        "at constant volume the pressure follows the temperature"
    );
    // Handbook: air at 500 K conducts 0.0405 W/(m K); c_p of 1004.5 and a Prandtl number of 0.7 make it 4 % less.
    assert!((conductivity / 0.0405 - 1.0).abs() < 0.05);
}

/// Without heat and flow `p V^γ` stays, for the state does.
#[test]
fn compression_without_heat() {
    let mut pack = pack(&[BackVolume::Geometric]);
    let ring = &mut pack.rings[0];
    (ring.gap_area, ring.leak_face, ring.leak_upper, ring.leak_lower) = (Some(0.0), 0.0, 0.0, 0.0);
    (ring.slope_upper, ring.slope_lower, ring.clearance_inner) = (0.0, 0.0, 0.0);
    ring.chamfer = Chamfer::default();
    let alone = OrificeNetwork { gap_split: quantity(0.0), ..spec(0.0) };
    let mut gas = build(&alone, &pack);
    let (mut y, mut d, mut out) = ([0.0; 2], [0.0; 2], GasOut::new(1));
    let at = |delta: f64| [place(&pack, 0, 0.0, 0.0, delta)];
    let inputs = |rings| GasIn { p_cylinder: 9e5, p_crankcase: 1e5, rings };
    let (wide, narrow) = (at(1e-4), at(0.0));
    gas.at_pressures(&inputs(&wide), &[9e5, 5e5], &mut y);
    gas.rates(&inputs(&narrow), &y, &mut d, &mut out).expect("rates");
    assert_eq!((d, out.flow_in[0]), ([0.0; 2], 0.0));
    let ratio = wide[0].back_volume / narrow[0].back_volume;
    assert!(ratio > 1.1);
    // A few roundings and two powers.
    assert!((out.p_back[0] / (7e5 * ratio.powf(GAMMA)) - 1.0).abs() < 1e-13);
}

/// With the temperature of the walls in all spaces, flows are those of the model without a balance of energy.
#[test]
fn the_same_flows_at_the_temperature_of_the_walls() {
    let pack = pack(&[BackVolume::Geometric, BackVolume::Geometric, BackVolume::OpenBelow]);
    let rings: Vec<_> = (0..3).map(|i| place(&pack, i, 3e-6, 0.3, 5e-5)).collect();
    let inp = GasIn { p_cylinder: 60e5, p_crankcase: 1e5, rings: &rings };
    let run = |spec: &dyn GasFlowSpec| {
        let mut gas = build(spec, &pack);
        let n = gas.states().len();
        let (mut y, mut d, mut out) = (vec![0.0; n], vec![0.0; n], GasOut::new(3));
        gas.at_pressures(&inp, &[60e5, 12e5, 3e5, 1e5], &mut y);
        gas.rates(&inp, &y, &mut d, &mut out).expect("rates");
        assert_eq!(gas.n_masses(), 4);
        (out, d)
    };
    let (walls, rates) = run(&OrificeNetwork::default());
    let (balance, both) = run(&spec(7.54));
    let same = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
    // Roundings of pressures and temperatures; a flow is the smaller part of a difference of pressures of a fifth and more.
    assert!(walls.flow_in.iter().zip(&balance.flow_in).all(|(a, b)| same(*a, *b)));
    assert!(walls.p_back.iter().zip(&balance.p_back).all(|(a, b)| same(*a, *b)));
    assert!(rates.iter().zip(&both).all(|(a, b)| (a - b).abs() < 1e-12 * walls.flow_in[0]));
    assert_eq!(walls.power, 0.0);
    let gas = build(&spec(7.54), &pack);
    assert_eq!(
        names(&*gas)[4..],
        ["ring1.back", "land2", "ring2.back", "land3"].map(|n| format!("energy of {n}"))
    );
    let columns: Vec<_> = gas.columns().into_iter().map(|c| c.name).collect();
    assert_eq!(columns[..2], ["ring1.back.temperature", "land2.temperature"]);
}

/// Energy held, with the volumes and pressures of all spaces.
fn held(gas: &dyn GasFlow) -> (f64, Vec<(f64, f64)>) {
    let (mut content, mut spaces) = (0.0, Vec::new());
    gas.each_space(&mut |p, v, u| {
        content += u;
        spaces.push((p, v));
    });
    (content, spaces)
}

/// Inputs at a part `x` of a cycle.
fn moving(x: f64, rings: &[RingPlace]) -> GasIn<'_> {
    GasIn { p_cylinder: 30e5 - 28e5 * (TAU * x).cos(), p_crankcase: 1e5, rings }
}

/// What gas brings, less heat and work on the walls, is stored: over a cycle in which the rings move up and down and in and out.
#[test]
fn energy_is_conserved_over_a_cycle() {
    let pack = pack(&[BackVolume::Geometric, BackVolume::Geometric, BackVolume::OpenBelow]);
    for spec in with_energy() {
        let mut gas = build(spec.as_ref(), &pack);
        let n = gas.states().len();
        let (mut y, mut out) = (vec![0.0; n], GasOut::new(3));
        let (steps, dt) = (20_000, 1e-7);
        let period = dt * f64::from(steps);
        let places = |t: f64| -> Vec<RingPlace> {
            let x = TAU * t / period;
            let e = |i: usize| (0.5 - 0.8 * (x + i as f64).cos()).clamp(0.0, 1.0);
            // The liner grows and shrinks by 0.1 mm: the space behind a ring by a tenth.
            (0..3).map(|i| place(&pack, i, 4e-6, e(i), 5e-5 * (1.1 + x.sin()))).collect()
        };
        let first = places(0.0);
        gas.at_pressures(&moving(0.0, &first), &[2e5, 1.5e5, 1.2e5, 1e5], &mut y);
        gas.pressures(&moving(0.0, &first), &y, &mut out).expect("pressures");
        let (start, mut before) = held(&*gas);
        let (mut work, mut span) = (0.0, 0.0);
        // What is brought is one more state, so that it is integrated as the others are.
        y.push(0.0);
        for k in 0..steps {
            let t = dt * f64::from(k);
            rk4(&mut y, t, dt, |t, y, d| {
                let rings = places(t);
                gas.rates(&moving(t / period, &rings), &y[..n], &mut d[..n], &mut out).expect("rates");
                d[n] = out.power;
            });
            let rings = places(t + dt);
            gas.pressures(&moving((t + dt) / period, &rings), &y[..n], &mut out).expect("pressures");
            let (now, spaces) = held(&*gas);
            for ((p, v), (q, w)) in spaces.iter().zip(&before) {
                work += 0.5 * (p + q) * (v - w);
            }
            before = spaces;
            span = f64::max(span, now);
        }
        let (end, _) = held(&*gas);
        let open = y[n] - work - (end - start);
        assert!(work.abs() > 1e-3 * span, "{spec:?}: the rings do {work:e} J of {span:e} J");
        // The trapezium of the work: 20 000 steps with an error of their square, the movement of a ring between corners its greatest part.
        assert!(open.abs() < 1e-6 * span, "{spec:?}: {open:e} J of {span:e} J");
    }
}

#[test]
fn derivatives_are_left_to_differences() {
    let pack = pack(&[BackVolume::Geometric]);
    let mut gas = build(&spec(7.54), &pack);
    let rings = [place(&pack, 0, 1e-6, 0.0, 0.0)];
    let inp = GasIn { p_cylinder: 5e5, p_crankcase: 1e5, rings: &rings };
    let mut y = [0.0; 2];
    gas.at_pressures(&inp, &[5e5, 1e5], &mut y);
    assert!(!gas.partials(&inp, &y, &mut GasPartials::new(1, 2)).expect("no derivatives"));
}

#[test]
fn impossible_energies_and_widths_are_refused() {
    let mut p = pack(&[BackVolume::Fixed(2e-7)]);
    let mut gas = build(&spec(7.54), &p);
    let rings = [place(&p, 0, 1e-6, 0.0, 0.0)];
    let inp = GasIn { p_cylinder: 5e5, p_crankcase: 1e5, rings: &rings };
    let (mut d, mut out) = ([0.0; 2], GasOut::new(1));
    for y in [[1e-6, 0.0], [1e-6, -1.0], [1e-6, f64::NAN], [0.0, 0.1], [-1e-6, -0.1], [1e-6, f64::INFINITY]] {
        assert!(gas.rates(&inp, &y, &mut d, &mut out).expect_err("refused").is_recoverable(), "{y:?}");
    }
    // The volume is given, but the ring leaves no room behind it.
    p.rings[0].root_radius = 0.056;
    let e = spec(7.54).build(&GasFlowCtx { pack: &p }).err().expect("no room");
    assert!(e.field == "gas_temperature" && e.message.contains("behind ring 1"), "{} {}", e.field, e.message);
    assert!(OrificeNetwork::default().build(&GasFlowCtx { pack: &p }).is_ok());
}
