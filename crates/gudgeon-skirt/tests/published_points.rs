//! Films, contact and crank drive of the EA111 skirt of Loureiro (2009) at points that another implementation evaluated.

use std::f64::consts::PI;

use gudgeon_contact::CrestWedge;
use gudgeon_core::kinds::{Film2dSpec, KinematicsCtx, KinematicsSpec, RoughnessSpec, SkirtModes, SkirtProfileCtx, SkirtProfileSpec};
use gudgeon_core::quantity::quantity;
use gudgeon_film::film_2d::{CentralDifferences, Cavitation, Multigrid};
use gudgeon_film::{SawtoothWaviness, SmoothSurfaces, WavinessTransport};
use gudgeon_skirt::{Body, ContactGrid, Crank, Cylindrical, Panel, Rod, Side, SideLoads, SideSetup, Slopes};

const RADIUS: f64 = 0.03824;
const LENGTH: f64 = 0.0303;
const HALF: [f64; 2] = [0.6213, 0.5306];

fn body() -> Body {
    Body {
        piston_mass: 0.236,
        pin_mass: 0.052,
        inertia: 1.36e-4,
        length: LENGTH,
        pin: 8.4e-3,
        centre: 0.3e-3,
        centre_offset: -3.25e-4,
    }
}

fn crank() -> Crank {
    Crank {
        radius: 0.0378,
        rod_length: 0.144,
        omega: 2500.0 * PI / 30.0,
        pin_offset: 5e-4,
        crank_offset: 0.0,
        rod: Rod::default(),
    }
}

struct Setup<'a> {
    film: &'a dyn Film2dSpec,
    roughness: &'a dyn RoughnessSpec,
    intervals: usize,
}

fn side(which: usize, setup: &Setup<'_>) -> Side {
    let panel = Panel { radius: RADIUS, length: LENGTH, half_angle: HALF[which] };
    let folder = std::path::Path::new("");
    let profile = Cylindrical {}.build(&SkirtProfileCtx { length: LENGTH, radius: RADIUS, folder }).expect("builds");
    let contact = CrestWedge {
        amplitude: quantity(4e-6),
        pitch: quantity(0.25e-3),
        composite_modulus: quantity(44.52e9),
        deflection: quantity(1.077),
        friction_coefficient: quantity(0.15),
    };
    Side::new(SideSetup {
        panel,
        sign: [1.0, -1.0][which],
        clearance: 1e-5,
        grid: &panel.grid(setup.intervals, setup.intervals, 0.0),
        film: setup.film,
        roughness: setup.roughness,
        contact: &contact,
        contact_grid: ContactGrid { pitch: 0.25e-3, intervals: 20 },
        profile: &*profile,
        modes: &SkirtModes::default(),
        shear_thinning: None,
        p_cav: 0.0,
        floor: 1e-7,
    })
    .expect("builds")
}

fn waves(transport: WavinessTransport) -> SawtoothWaviness {
    SawtoothWaviness { amplitude: quantity(4e-6), transport }
}

/// Speed away from the head, acceleration and rod angle \[deg\] at a crank angle.
fn drive(deg: f64) -> (f64, f64, f64) {
    let c = crank();
    let k = gudgeon_kinematics_motion(&c, deg);
    let now = c.instant(deg.to_radians(), &k, 0.0, 0.0, 0.016);
    (now.speed, now.acceleration, -now.tangent.atan().to_degrees())
}

fn gudgeon_kinematics_motion(c: &Crank, deg: f64) -> gudgeon_core::kinds::PistonMotion {
    let ctx = KinematicsCtx {
        crank_radius: c.radius,
        rod_length: c.rod_length,
        offset: c.crank_offset - c.pin_offset,
        omega: c.omega,
    };
    gudgeon_kinematics::ExactSliderCrank {}.build(&ctx).expect("turns").motion(deg.to_radians())
}

/// Crank angle, eccentricities \[µm\], rates \[µm/s\]; per side lateral force, moment, friction, its moment; in brackets the lateral forces with 40
/// intervals.
#[allow(clippy::type_complexity)]
const POINTS: [(f64, [f64; 2], [f64; 2], [[f64; 4]; 2], [f64; 2]); 6] = [
    (90.0, [-2.8, -3.7], [0.0, 0.0], [[0.0, 0.0, -51.399, 1.82127], [-590.11, 3.84285, -16.843, -0.62238]], [0.0, -596.44]),
    (330.0, [0.5, -2.5], [400.0, -100.0], [[2205.20, -24.8245, 20.483, -0.72429], [-2.540, -0.01279, 13.115, 0.48478]], [2242.25, -5.598]),
    (390.0, [1.5, -3.3], [-800.0, -100.0], [[779.55, -0.83575, -20.850, 0.73726], [-85.707, 1.39713, -13.695, -0.50628]], [776.71, -85.308]),
    (390.0, [-0.5, -3.0], [-500.0, -50.0], [[1725.80, -5.60753, -23.177, 0.81979], [-14.847, 0.26577, -12.117, -0.44783]], [1729.02, -15.675]),
    (440.0, [-2.3, -3.45], [-240.0, -90.0], [[1151.20, -3.99497, -48.394, 1.71381], [-57.264, 0.75815, -17.991, -0.66480]], [1154.30, -57.727]),
    (180.0, [-2.0, -3.0], [100.0, 200.0], [[0.0, 0.0, 0.1494, -0.00529], [-785.64, 5.46705, 0.0483, 0.00178]], [0.0, -793.76]),
];

/// Lateral force, moment about the pin, friction and its moment.
fn loads(side: &mut Side, deg: f64, e: [f64; 2], v: [f64; 2]) -> [f64; 4] {
    let micro = |v: [f64; 2]| [v[0] * 1e-6, v[1] * 1e-6];
    let (speed, _, _) = drive(deg);
    side.place(micro(e), &[], speed).expect("a film");
    let mut l = SideLoads::default();
    side.loads(speed, 0.016, &micro(v), Slopes::Film, &mut l).expect("a film");
    let [force, moment] = body().about_pin([l.film[0], l.film[1]]);
    [force, moment, l.film[2], -side.sign * l.film[3] + crank().pin_offset * l.film[2]]
}

#[test]
fn static_points_on_the_published_mesh() {
    let roughness = waves(WavinessTransport::AsPublished);
    let setup = Setup { film: &CentralDifferences::default(), roughness: &roughness, intervals: 9 };
    let mut sides = [side(0, &setup), side(1, &setup)];
    for (deg, e, v, expected, _) in POINTS {
        for (k, side) in sides.iter_mut().enumerate() {
            let got = loads(side, deg, e, v);
            eprintln!("{deg} {k}: {got:?} {:?}", expected[k]);
        }
    }
}

#[test]
fn finite_volumes() {
    let roughness = waves(WavinessTransport::AsPublished);
    for film in [Cavitation::HalfSommerfeld] {
        let film = Multigrid { cavitation: film, ..Multigrid::default() };
        for n in [8, 12, 16, 24, 40, 80] {
            let setup = Setup { film: &film, roughness: &roughness, intervals: n };
            let mut sides = [side(0, &setup), side(1, &setup)];
            for (deg, e, v, _, fine) in POINTS {
                let got = [loads(&mut sides[0], deg, e, v)[0], loads(&mut sides[1], deg, e, v)[0]];
                eprintln!("{n} {deg}: {got:?} {fine:?}");
            }
        }
    }
    let _ = SmoothSurfaces {};
}
