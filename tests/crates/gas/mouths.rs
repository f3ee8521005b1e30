//! The automatic change between orifice and channel, and the viscosity of the gas in channels.

use gudgeon_core::geometry::BackVolume;
use gudgeon_core::kinds::{GasFlowCtx, GasFlowSpec};
use gudgeon_core::quantity::quantity;
use gudgeon_gas::{
    FlowPartials, GasState, GasViscosity, Mouth, NarrowChannel, Orifice, Passage, PassageLaw,
    burnt_gas_viscosity, channel_conductance, sutherland_viscosity, turbulent_share,
};

use crate::packs::pack;
use crate::support::{R, isentropic};

const PERIMETER: f64 = 0.37;
const LENGTH: f64 = 5e-3;
const MU: f64 = 2.5e-5;

/// The passage of a height, its channel alone and its cross section.
fn automatic(height: f64, unit_flow: f64, sharpness: f64) -> (Passage, f64, f64) {
    let (conductance, area) =
        (channel_conductance(PERIMETER, height, LENGTH, MU, R * 450.0), PERIMETER * height);
    (Passage::AutomaticChannel { conductance, area, unit_flow, sharpness }, conductance, area)
}

#[test]
fn the_lesser_of_both_laws_governs() {
    let law = isentropic(1e-3);
    let b = GasState::new(1e5, R * 450.0);
    let (mut channels, mut orifices) = (0, 0);
    for n in [1.0, 4.0, 20.0] {
        for height in [1e-7, 1e-6, 1e-5, 3e-5, 1e-4, 1e-3] {
            let (passage, conductance, area) = automatic(height, f64::INFINITY, n);
            for p in [1.0001e5, 1.1e5, 1e6, 1e7] {
                let a = b.with_pressure(p);
                let (c, o) = (conductance * (p * p - 1e10), law.flow_bare(area, &a, &b));
                let flow = law.mass_flow(passage, &a, &b);
                assert_eq!(law.mass_flow(passage, &b, &a), -flow);
                let (low, high) = (c.min(o), c.max(o));
                assert!(flow <= low);
                // (1 + x)^(-1/n) is 1 - x/n and a positive rest; p² - q² is rounded to 1e-16/(1 - q/p).
                assert!(1.0 - flow / low <= (low / high).powf(n) / n + 1e-11, "{n} {height} {p}");
                channels += i32::from(c < 0.5 * o);
                orifices += i32::from(o < 0.5 * c);
            }
        }
    }
    assert!(channels > 10 && orifices > 10, "{channels} {orifices}");
}

/// Both give the same at the Reynolds number `48 C_d² L/H`, and `2^(-1/n)` of it passes.
#[test]
fn the_change_is_at_the_reynolds_number_of_its_length() {
    let orifice = Orifice { laminar: quantity(0.0), ..Orifice::default() };
    let law = orifice.build(1.4, R).expect("builds");
    // A small difference: the law of the nozzle departs from that of Bernoulli by 3/4 of it, the density of a channel by half.
    let (a, b) = (GasState::new(1.0001e5, R * 450.0), GasState::new(1e5, R * 450.0));
    let difference = 1.0001e5f64.powi(2) - 1e10;
    let surplus = |height: f64| {
        let (_, conductance, area) = automatic(height, f64::INFINITY, 4.0);
        conductance * difference - law.flow_bare(area, &a, &b)
    };
    let (mut low, mut high) = (1e-6, 1e-3);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if surplus(middle) < 0.0 { low = middle } else { high = middle }
    }
    let (passage, conductance, _) = automatic(low, f64::INFINITY, 4.0);
    let c = conductance * difference;
    let reynolds = 2.0 * c / (PERIMETER * MU);
    assert!((reynolds / (48.0 * 0.86 * 0.86 * LENGTH / low) - 1.0).abs() < 1e-4, "{reynolds}");
    // The bisection leaves a rounding of the height, three of which are in the flow of the channel.
    assert!((law.mass_flow(passage, &a, &b) / c - 0.5f64.powf(0.25)).abs() < 1e-12);
}

#[test]
fn continuous_with_its_derivative() {
    let law = isentropic(0.0);
    let b = GasState::new(1e5, R * 450.0);
    for unit_flow in [f64::INFINITY, 0.5 * PERIMETER * MU] {
        for height in [1e-6, 1e-5, 3e-5, 1e-4, 1e-3] {
            let (passage, conductance, _) = automatic(height, unit_flow, 4.0);
            for p in [1.0001e5, 1.01e5, 2.3e5, 1e6, 1e7] {
                let a = b.with_pressure(p);
                let s: FlowPartials = law.mass_flow_partials(passage, &a, &b);
                assert!((s.flow / law.mass_flow(passage, &a, &b) - 1.0).abs() < 1e-14);
                let d = 1e-4 * (p - 1e5);
                let shifted = |delta: f64| law.mass_flow(passage, &a.with_pressure(p + delta), &b);
                let central = (shifted(d) - shifted(-d)) / (2.0 * d);
                // Truncation 1e-8 of a law whose sharpness of 4 bends it four times as much; the flow function's own derivative 1e-7.
                assert!((central / s.by_a - 1.0).abs() < 3e-7, "{p} {height}: {central} {}", s.by_a);
            }
            // At equal pressures the channel governs, whatever its height.
            let s = law.mass_flow_partials(passage, &b, &b);
            assert!(s.flow == 0.0 && s.by_a == 2e5 * conductance && s.by_b == -s.by_a);
        }
    }
}

#[test]
fn turbulent_where_it_is_asked_for() {
    let law = isentropic(0.0);
    let (a, b) = (GasState::new(1e7, R * 450.0), GasState::new(1e5, R * 450.0));
    let unit = 0.5 * PERIMETER * MU;
    let ((laminar, conductance, _), (blended, ..)) =
        (automatic(6e-6, f64::INFINITY, 30.0), automatic(6e-6, unit, 30.0));
    let c = conductance * (1e14 - 1e10);
    let share = turbulent_share(c / unit).0;
    assert!(share < 0.9, "the Reynolds number {} is above the transition", c / unit);
    // The orifice lets through twice as much and more: 2^-30/30, 3e-11.
    assert!((law.mass_flow(laminar, &a, &b) / c - 1.0).abs() < 3.2e-11);
    assert!((law.mass_flow(blended, &a, &b) / (c * share) - 1.0).abs() < 3.2e-11);
}

#[test]
fn a_sharpness_below_one_is_refused() {
    let spec =
        NarrowChannel { mouth: Mouth::Automatic, mouth_sharpness: quantity(0.5), ..NarrowChannel::default() };
    let pack = pack(&[BackVolume::Geometric]);
    assert_eq!(spec.build(&GasFlowCtx { pack: &pack }).err().expect("below 1").field, "mouth_sharpness");
}

#[test]
fn viscosities() {
    // 3.3e-7 500^0.7/1.027, 30-digit value.
    assert!((burnt_gas_viscosity(500.0) / VISCOSITY_AT_500 - 1.0).abs() < 1e-14);
    // Heywood's fits differ by the 2.7 % of the products; that for air is within 5 % of Sutherland's law where both are said to hold.
    for t in [500.0, 600.0, 700.0, 1000.0] {
        assert!((1.027 * burnt_gas_viscosity(t) / sutherland_viscosity(t) - 1.0).abs() < 0.05);
    }
    for t in [300.0, 700.0] {
        assert_eq!(GasViscosity::Sutherland.at(t, 1.0), sutherland_viscosity(t));
        assert_eq!(GasViscosity::BurntGas.at(t, 1.0), burnt_gas_viscosity(t));
        assert_eq!(GasViscosity::Constant.at(t, 2e-5), 2e-5);
    }
}

const VISCOSITY_AT_500: f64 = 0.00002490132745330824036308289;
