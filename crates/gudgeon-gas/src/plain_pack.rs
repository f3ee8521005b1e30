//! A ring pack to try a gas law on.

use gudgeon_core::geometry::{
    BackVolume, Chamfer, FaceProfile, LandGeometry, PackGeometry, RingGeometry, RingPlace, Vent,
};

/// Radius of the liner \[m\].
const BORE_RADIUS: f64 = 0.05;
/// Axial clearance of the rings \[m\].
const CLEARANCE: f64 = 50e-6;
/// Volume behind a ring \[m³\].
const BACK_VOLUME: f64 = 3e-7;

/// A pack of equal rectangular rings in plain grooves of a 100 mm bore, and their places at rest on the lower flank under 2 µm of
/// oil: to try a gas law on, in examples and tests.
///
/// End gaps 0.05 mm², axial clearance 50 µm, flanks that leak through 0.1 µm when seated, 0.3 cm³ behind each ring at 450 K, 0.5 cm³
/// on each land at 450 K; air.
#[must_use]
pub fn plain_pack(rings: usize) -> (PackGeometry, Vec<RingPlace>) {
    let land = LandGeometry { volume: 5e-7, temperature: 450.0, vent: Vent::Closed };
    let pack = PackGeometry {
        bore_radius: BORE_RADIUS,
        rings: vec![plain_ring(); rings],
        lands: vec![land; rings + 1],
        gamma: 1.4,
        gas_constant: 287.0,
    };
    let place = RingPlace {
        h: 2e-6,
        clearance: CLEARANCE,
        liner_radius: BORE_RADIUS,
        r_inner: BORE_RADIUS - 4e-3,
        r_outer: BORE_RADIUS,
        back_volume: BACK_VOLUME,
        ..RingPlace::default()
    };
    (pack, vec![place; rings])
}

fn plain_ring() -> RingGeometry {
    RingGeometry {
        height: 2e-3,
        width: 4e-3,
        mass: 0.02,
        tangential_force: 15.0,
        gap: 0.3e-3,
        gap_area: Some(5e-8),
        piston_radius_above: BORE_RADIUS - 0.3e-3,
        piston_radius_below: BORE_RADIUS - 0.3e-3,
        root_radius: BORE_RADIUS - 4.5e-3,
        slope_upper: 0.0,
        slope_lower: 0.0,
        groove_height_inner: 2e-3 + CLEARANCE,
        clearance_inner: CLEARANCE,
        leak_upper: 1e-7,
        leak_lower: 1e-7,
        leak_face: 0.0,
        chamfer: Chamfer::default(),
        back: BackVolume::Fixed(BACK_VOLUME),
        vent: Vent::Closed,
        back_temperature: 450.0,
        oil_fill: 0.0,
        face: FaceProfile::Parabola { length: 2e-3, curvature: 10.0, apex: 1e-3 },
        lands: 1,
        rails: 1,
        has_clearance: true,
        expander_slope: 0.0,
    }
}
