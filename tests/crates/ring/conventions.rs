//! The laws in which published programs differ, against equilibrium and closed forms.

use std::f64::consts::PI;

use gudgeon_core::geometry::{BackVolume, Chamfer, FaceProfile, RingGeometry, RingPlace, RingSection, Vent};
use gudgeon_core::kinds::{
    AxialGasSpec, CavitationDatumSpec, DragSpec, FaceForces, FilmForceSpec, HoopSpec, RadialGasSpec,
    TwinLandFrictionSpec,
};
use gudgeon_ring::{axial_gas, cavitation_datum, drag, film_force, hoop, radial_gas, twin_land_friction};

const BORE_RADIUS: f64 = 0.06;

fn ring() -> RingGeometry {
    RingGeometry {
        height: 3e-3,
        width: 5e-3,
        mass: 0.04,
        tangential_force: 30.0,
        gap: 0.4e-3,
        gap_area: None,
        piston_radius_above: 59.5e-3,
        piston_radius_below: 59.7e-3,
        root_radius: 54e-3,
        slope_upper: 0.0,
        slope_lower: 0.0,
        groove_height_inner: 3.1e-3,
        clearance_inner: 0.1e-3,
        leak_upper: 0.0,
        leak_lower: 0.0,
        leak_face: 0.0,
        chamfer: Chamfer::default(),
        back: BackVolume::Geometric,
        vent: Vent::Closed,
        back_temperature: 450.0,
        oil_fill: 0.5,
        face: FaceProfile::Parabola { length: 1.8e-3, curvature: 20.0, apex: 0.9e-3 },
        lands: 1,
        rails: 1,
        has_clearance: true,
        expander_slope: 0.0,
    }
}

fn place() -> RingPlace {
    RingPlace {
        h: 1e-6,
        s: 0.0,
        v: 0.0,
        clearance: 1e-4,
        lift_fraction: 0.0,
        twist: 0.0,
        twist_rate: 0.0,
        liner_radius: BORE_RADIUS,
        r_inner: BORE_RADIUS - 5e-3,
        r_outer: BORE_RADIUS,
        back_volume: 1e-6,
        ..RingPlace::default()
    }
}

/// Equal to rounding: some ten operations at 1.1e-16 each.
fn close(a: f64, b: f64) {
    assert!((a - b).abs() <= 2e-15 * a.abs().max(b.abs()), "{a:e} {b:e}");
}

#[test]
fn tension_is_the_equilibrium_of_half_a_ring() {
    let correct = hoop::Correct {}.build().expect("builds").radial_force(30.0);
    // An even pressure 2 F/(D b) on the cylinder pi D b.
    let (diameter, height) = (2.0 * BORE_RADIUS, 3e-3);
    close(correct, 2.0 * 30.0 / (diameter * height) * PI * diameter * height);
    close(correct, PI * hoop::AsPrinted {}.build().expect("builds").radial_force(30.0));
}

#[test]
fn under_one_pressure_everywhere_a_split_ring_carries_it_on_its_running_face() {
    let (ring, place) = (ring(), place());
    let p = 40e5;
    let load = |spec: &dyn RadialGasSpec, cavitation: f64| {
        spec.build()
            .expect("builds")
            .load(&RingSection::new(&ring, &place, BORE_RADIUS).under(p, p, p, cavitation))
    };
    for cavitation in [0.0, 1e5] {
        close(load(&radial_gas::BackFaceAndGap {}, cavitation), (p - cavitation) * ring.face.length());
    }
    // Without the end faces of the gap, p b w / r_o is missing.
    let missing = p * ring.height * ring.width / BORE_RADIUS;
    close(load(&radial_gas::BackFaceAndGap {}, 0.0) - missing, load(&radial_gas::BackAndFace {}, 0.0));
    close(load(&radial_gas::BackOnly {}, 0.0), p * ring.height * place.r_inner / place.r_outer);
    close(load(&radial_gas::BorePerimeter {}, 0.0), p * ring.height);
}

#[test]
fn pressures_press_the_way_they_stand() {
    let (ring, place) = (ring(), place());
    let base = RingSection::new(&ring, &place, BORE_RADIUS);
    let law = radial_gas::BackFaceAndGap {}.build().expect("builds");
    let more = |above: f64, below: f64, back: f64| {
        law.load(&base.under(2e5 + above, 2e5 + below, 2e5 + back, 0.0))
            - law.load(&base.under(2e5, 2e5, 2e5, 0.0))
    };
    // Half of the 1.2 mm beside the running face against half of the 0.4 mm of the gap outside the groove, over the outer radius.
    let lands = -0.5 * (3e-3 - 1.8e-3) + 0.5 * 3e-3 * (60e-3 - 59.6e-3) / BORE_RADIUS;
    let behind = 3e-3 * 55e-3 / BORE_RADIUS + 3e-3 * (59.6e-3 - 55e-3) / BORE_RADIUS;
    // Loads of 1 kN/m are subtracted: their rounding is 1e-13 N/m, on 6 N/m.
    for (got, expected) in [
        (more(1e4, 0.0, 0.0), lands * 1e4),
        (more(0.0, 1e4, 0.0), lands * 1e4),
        (more(0.0, 0.0, 1e4), behind * 1e4),
    ] {
        assert!((got - expected).abs() < 1e-11 * expected.abs(), "{got} {expected}");
    }
    let twin = RingGeometry {
        lands: 2,
        face: FaceProfile::Parabola { length: 0.5e-3, curvature: 20.0, apex: 0.25e-3 },
        ..ring.clone()
    };
    let beside = RingSection::new(&twin, &place, BORE_RADIUS).under(9e5, 2e5, 3e5, 1e5).gas_beside_face();
    // Slots join the space between the lands with that behind the ring.
    close(beside, (3e-3 - 1e-3) * 2e5);
    close(law.circumference(&base), 2.0 * PI * place.r_outer);
    let moved = RingPlace { r_outer: 0.061, ..place };
    close(
        radial_gas::BorePerimeter {}.build().expect("builds").circumference(&RingSection::new(
            &ring,
            &moved,
            BORE_RADIUS,
        )),
        2.0 * PI * BORE_RADIUS,
    );
}

#[test]
fn axial_gas_force_has_the_mean_of_a_laminar_profile() {
    let (ring, place) = (ring(), place());
    let (above, below, back) = (60e5, 3e5, 50e5);
    let section = RingSection::new(&ring, &place, BORE_RADIUS).under(above, below, back, 1e5);
    let force = |spec: &dyn AxialGasSpec| spec.build().expect("builds").force(&section);
    // Simpson's rule over sqrt(a² + (b² - a²) x): 1e-9 at 4000 intervals, the lower end is far from zero.
    let mean = |a: f64, b: f64| {
        let n = 4000;
        let f = |k: usize| (a * a + (b * b - a * a) * k as f64 / f64::from(n)).sqrt();
        let n = n as usize;
        (0..=n)
            .map(|k| {
                f(k) * if k == 0 || k == n {
                    1.0
                } else if k % 2 == 1 {
                    4.0
                } else {
                    2.0
                }
            })
            .sum::<f64>()
            / (3 * n) as f64
    };
    let expected = place.flank_area() * (mean(back, below) - mean(back, above));
    let got = force(&axial_gas::LaminarProfile {});
    assert!((got / expected - 1.0).abs() < 1e-8, "{got} {expected}");
    assert!(got < 0.0, "pressure above pushes down");
    close(force(&axial_gas::LinearProfile {}), 0.5 * place.flank_area() * (below - above));
    close(force(&axial_gas::FullPerimeter {}), 2.0 * PI * BORE_RADIUS * ring.width * (below - above));
    // Small differences: the profile of a gas is that of a liquid. Second order in 1e-4.
    let section = section.under(1.0001e5, 1e5, 1.0e5, 1e5);
    let ratio = axial_gas::LaminarProfile {}.build().expect("builds").force(&section)
        / axial_gas::LinearProfile {}.build().expect("builds").force(&section);
    assert!((ratio - 1.0).abs() < 1e-4, "{ratio}");
}

#[test]
fn films_push_and_rub_as_the_convention_says() {
    let film = FaceForces {
        load: 1e3,
        squeeze_damping: 1.0,
        ring_shear: 2.0,
        liner_shear: 3.0,
        slope_force: 5.0,
        flux: 0.0,
    };
    let force = |spec: &dyn FilmForceSpec| spec.build().expect("builds").per_length(&film, 0.25);
    assert_eq!(force(&film_force::Total {}), 7.25);
    assert_eq!(force(&film_force::LinerReaction {}), 3.0);
    assert_eq!(force(&film_force::FaceShear {}), 2.0);
    let (liner, face) =
        (drag::Liner {}.build().expect("builds"), drag::FaceShear {}.build().expect("builds"));
    assert_eq!((liner.shear(&film), face.shear(&film)), (3.0, 2.0));
    assert_eq!((liner.power(3.0, -2.0), face.power(3.0, -2.0)), (-6.0, 6.0));
}

#[test]
fn films_cavitate_at_the_datum() {
    let gauge = cavitation_datum::Gauge {}.build().expect("builds");
    assert_eq!(gauge.pressure(1e5, 5e5, 2e5), 1e5);
    assert_eq!(gauge.pressure(1e5, 0.5e5, 2e5), 0.5e5);
    assert_eq!(gauge.pressure(1e5, 5e5, 0.2e5), 0.2e5);
    assert_eq!(cavitation_datum::Absolute {}.build().expect("builds").pressure(1e5, 5e5, 2e5), 0.0);
}

#[test]
fn twin_lands_share_their_friction() {
    assert_eq!(twin_land_friction::BothLands {}.build().expect("builds").shares(), [1.0, 1.0]);
    // Upper first: the listing counts the lower one twice.
    assert_eq!(twin_land_friction::LowerTwice {}.build().expect("builds").shares(), [0.0, 2.0]);
}
