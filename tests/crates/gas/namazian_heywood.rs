//! The classical crevice model.

use std::f64::consts::TAU;

use gudgeon_core::geometry::{BackVolume, Chamfer};
use gudgeon_core::kinds::{GasFlowSpec, GasIn, GasOut};
use gudgeon_core::quantity::quantity;
use gudgeon_gas::{
    ChannelFriction, GasState, GasViscosity, NamazianHeywood, NarrowChannel, Orifice, burnt_gas_viscosity,
};

use crate::packs::{build, pack, place};
use crate::support::R;

/// Flows into and out of one ring with a tight gap, at the height `clearance` of its groove and the position `e`; 20 bar, 10.5 bar behind, 1 bar.
fn flows(spec: &dyn GasFlowSpec, clearance: f64, e: f64, gap: f64) -> (f64, f64) {
    let mut pack = pack(&[BackVolume::Fixed(2.9e-7)]);
    let r = &mut pack.rings[0];
    (r.gap_area, r.chamfer, r.leak_face) = (Some(gap), Chamfer::default(), 0.0);
    (r.slope_upper, r.slope_lower, r.clearance_inner) = (0.0, 0.0, clearance);
    let mut gas = build(spec, &pack);
    let inp = GasIn { p_cylinder: 20e5, p_crankcase: 1e5, rings: &[place(&pack, 0, 2e-6, e, 0.0)] };
    let (mut state, mut d, mut out) = ([0.0], [0.0], GasOut::new(1));
    gas.at_pressures(&inp, &[20e5, 1e5], &mut state);
    gas.rates(&inp, &state, &mut d, &mut out).expect("rates");
    (out.flow_in[0], out.flow_out[0])
}

/// `W h³ (p_u² - p_d²)/(24 μ L R T)` with the radial thickness 5 mm of the ring.
fn channel(radius: f64, height: f64, t: f64, mu: f64, p: (f64, f64)) -> f64 {
    TAU * radius * height.powi(3) * (p.0 * p.0 - p.1 * p.1) / (24.0 * mu * 5e-3 * R * t)
}

#[test]
fn flanks_are_channels_without_a_mouth_whatever_their_height() {
    let behind = 10.5e5;
    for clearance in [2e-6, 2e-5, 2e-4] {
        for e in [0.0, 0.3, 1.0] {
            let (into, out) = flows(&NamazianHeywood::default(), clearance, e, 0.0);
            let upper = (1.0 - e) * clearance + 2e-8;
            let lower = e * clearance + 3e-8;
            let (t_upper, t_lower) = (0.5 * (523.15 + 503.15), 503.15);
            // The pressure behind is found back from its mass: some roundings, three times in the cube of a difference of heights.
            let exact = channel(0.05965, upper, t_upper, burnt_gas_viscosity(t_upper), (20e5, behind));
            assert!((into / exact - 1.0).abs() < 1e-13, "{clearance} {e} {}", into / exact - 1.0);
            let exact = channel(0.0597, lower, t_lower, burnt_gas_viscosity(t_lower), (behind, 1e5));
            assert!((out / exact - 1.0).abs() < 1e-13, "{clearance} {e} {}", out / exact - 1.0);
        }
    }
}

#[test]
fn the_gap_is_an_orifice() {
    let difference = flows(&NamazianHeywood::default(), 1e-6, 0.0, 1e-7).1
        - flows(&NamazianHeywood::default(), 1e-6, 0.0, 0.0).1;
    let law = Orifice::default().build(1.4, R).expect("builds");
    let exact = law.flow_exact(1e-7, &GasState::new(20e5, R * 523.15), &GasState::new(1e5, R * 503.15));
    // The fast flow function is right within 2e-9.
    assert!((difference / exact - 1.0).abs() < 3e-9);
}

/// Where the channel is narrow, `narrow_channel` is the same law; where it is wide, its mouth keeps it below.
#[test]
fn narrow_channel_departs_with_the_height() {
    let viscosity = quantity(2.4e-5);
    let classical =
        NamazianHeywood { gas_viscosity: GasViscosity::Constant, viscosity, ..NamazianHeywood::default() };
    let limited = NarrowChannel {
        friction: ChannelFriction::Laminar,
        gas_viscosity: GasViscosity::Constant,
        viscosity,
        ..NarrowChannel::default()
    };
    let mut last = 1.0;
    for clearance in [1e-7, 1e-6, 1e-5, 1e-4, 1e-3] {
        let share = flows(&limited, clearance, 0.5, 0.0).1 / flows(&classical, clearance, 0.5, 0.0).1;
        assert!(share < last, "{clearance} {share}");
        last = share;
    }
    // The flow of the mouth goes with the height, that of the channel with its cube: 0.305 kg/s and 124 kg/s at 500 µm, between 10.5 bar and 1 bar.
    assert!((last / (0.305 / 124.0) - 1.0).abs() < 0.02, "{last}");
    // At 0.08 µm the channel passes 1.3e-5 of what its mouth would, and the limiter takes off the square of that.
    let share = flows(&limited, 1e-7, 0.5, 0.0).1 / flows(&classical, 1e-7, 0.5, 0.0).1;
    assert!(1.0 - share < 1e-7, "{share}");
}
