//! Packs of a truck engine, places of their rings, and the models that are tried on them.

use std::f64::consts::PI;

use gudgeon_core::geometry::{
    BackVolume, Chamfer, FaceProfile, LandGeometry, PackGeometry, RingGeometry, RingPlace, Vent,
};
use gudgeon_core::kinds::{GasFlow, GasFlowCtx, GasFlowSpec};
use gudgeon_core::quantity::quantity;
use gudgeon_gas::{
    BackVolumes, ChannelFriction, Elimination, FilmHeight, Gamma, GapOrifice, GasTemperature, Labyrinth,
    Mouth, NamazianHeywood, NarrowChannel, Orifice, OrificeFormula, OrificeNetwork,
};

/// A ring of a 120 mm truck engine.
pub fn ring(back: BackVolume) -> RingGeometry {
    RingGeometry {
        height: 3.5e-3,
        width: 5e-3,
        mass: 0.043,
        tangential_force: 22.0,
        gap: 0.4e-3,
        gap_area: None,
        piston_radius_above: 0.05965,
        piston_radius_below: 0.0597,
        root_radius: 0.0543,
        slope_upper: 7.5f64.to_radians().tan(),
        slope_lower: 7.5f64.to_radians().tan(),
        groove_height_inner: 2.08e-3,
        clearance_inner: -1.05e-4,
        leak_upper: 2e-8,
        leak_lower: 3e-8,
        leak_face: 1e-7,
        chamfer: Chamfer { area_lower: 3e-8, area_upper: 5e-8 },
        back,
        vent: Vent::Closed,
        back_temperature: 503.15,
        oil_fill: 0.6,
        face: FaceProfile::Table { length: 3e-3, drops: vec![0.0, 1e-6] },
        lands: 1,
        rails: 1,
        has_clearance: back != BackVolume::Sealed,
        expander_slope: 0.0,
    }
}

pub fn pack(backs: &[BackVolume]) -> PackGeometry {
    PackGeometry {
        bore_radius: 0.06,
        rings: backs.iter().map(|&b| ring(b)).collect(),
        lands: (0..=backs.len())
            .map(|i| LandGeometry {
                volume: 9e-7 / (1.0 + i as f64),
                temperature: 523.15 - 20.0 * i as f64,
                vent: Vent::Closed,
            })
            .collect(),
        gamma: 1.4,
        gas_constant: 287.0,
    }
}

/// The place of a ring at film thickness `h`, position `e` and liner distortion `delta`, as a scene computes it.
pub fn place(p: &PackGeometry, i: usize, h: f64, e: f64, delta: f64) -> RingPlace {
    let r = &p.rings[i];
    let liner_radius = p.bore_radius + delta;
    let behind = r.h_max(liner_radius) - h;
    let slope = r.slope_upper + r.slope_lower;
    let clearance = if r.has_clearance { r.clearance_inner + slope * behind } else { 0.0 };
    let r_inner = r.root_radius + behind;
    RingPlace {
        h,
        s: e * clearance,
        v: 0.0,
        clearance,
        lift_fraction: e,
        liner_radius,
        r_inner,
        r_outer: r_inner + r.width,
        back_volume: (r.groove_height_inner + 0.5 * slope * behind)
            * PI
            * (r_inner * r_inner - r.root_radius * r.root_radius),
        ..RingPlace::default()
    }
}

pub fn build(spec: &dyn GasFlowSpec, pack: &PackGeometry) -> Box<dyn GasFlow> {
    spec.build(&GasFlowCtx { pack }).expect("builds")
}

pub fn specs() -> Vec<Box<dyn GasFlowSpec>> {
    let truncated = Orifice { law: OrificeFormula::IsentropicTruncated, ..Orifice::default() };
    let sharp_edged = Orifice { discharge_fall: quantity(0.25), ..Orifice::default() };
    let of_burnt_gas = Orifice { gamma: Gamma::BurntGas, ..Orifice::default() };
    vec![
        Box::new(OrificeNetwork::default()),
        Box::new(OrificeNetwork {
            orifice: truncated,
            chamfer_fade: quantity(0.0),
            ..OrificeNetwork::default()
        }),
        Box::new(OrificeNetwork { film_height: FilmHeight::Nominal, ..OrificeNetwork::default() }),
        Box::new(GapOrifice::default()),
        Box::new(GapOrifice { back_volumes: BackVolumes::Merged, ..GapOrifice::default() }),
        Box::new(NarrowChannel { friction: ChannelFriction::Blended, ..NarrowChannel::default() }),
        Box::new(OrificeNetwork { orifice: of_burnt_gas, ..OrificeNetwork::default() }),
        Box::new(NarrowChannel::default()),
        Box::new(NarrowChannel { film_height: FilmHeight::Nominal, ..NarrowChannel::default() }),
        Box::new(NarrowChannel {
            mouth: Mouth::Automatic,
            friction: ChannelFriction::Blended,
            ..NarrowChannel::default()
        }),
        Box::new(OrificeNetwork { orifice: sharp_edged, ..OrificeNetwork::default() }),
        Box::new(NamazianHeywood::default()),
        Box::new(Labyrinth::default()),
    ]
}

/// Models with a balance of energy.
pub fn with_energy() -> Vec<Box<dyn GasFlowSpec>> {
    let gas_temperature = GasTemperature::EnergyBalance;
    vec![
        Box::new(OrificeNetwork { gas_temperature, ..OrificeNetwork::default() }),
        Box::new(NarrowChannel { gas_temperature, ..NarrowChannel::default() }),
        Box::new(NamazianHeywood {
            gas_temperature,
            film_height: FilmHeight::Nominal,
            ..NamazianHeywood::default()
        }),
    ]
}

/// The same without a space behind any ring: a filling time that none exceeds.
pub fn eliminated() -> Vec<Box<dyn GasFlowSpec>> {
    let all = || quantity(1e3);
    let orifices =
        OrificeNetwork { eliminate: Elimination::Auto, eliminate_below: all(), ..OrificeNetwork::default() };
    let channels =
        NarrowChannel { eliminate: Elimination::Auto, eliminate_below: all(), ..NarrowChannel::default() };
    vec![Box::new(orifices), Box::new(channels)]
}

pub const BACKS: &[&[BackVolume]] = &[
    &[BackVolume::Geometric],
    &[BackVolume::OpenBelow],
    &[BackVolume::Sealed],
    &[BackVolume::Geometric, BackVolume::Geometric, BackVolume::OpenBelow],
    &[BackVolume::Fixed(2.9e-7), BackVolume::Fixed(2.9e-7), BackVolume::Sealed],
    &[
        BackVolume::OpenBelow,
        BackVolume::Sealed,
        BackVolume::Fixed(1e-7),
        BackVolume::Geometric,
        BackVolume::OpenBelow,
    ],
];

/// Names of the states.
pub fn names(gas: &dyn GasFlow) -> Vec<String> {
    gas.states().iter().map(|s| s.name.clone()).collect()
}
