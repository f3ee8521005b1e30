//! The EA111 skirt of Loureiro (2009), whole and in parts.

use std::f64::consts::PI;

use gudgeon_contact::CrestWedge;
use gudgeon_core::file::Files;
use gudgeon_core::kinds::{
    Film2dGrid, Film2dSpec, GrooveFrictionCtx, GrooveFrictionSpec, KinematicsCtx, KinematicsSpec,
    PinFrictionSpec, PistonMotion, RoughnessSpec, SkirtCompliance, SkirtComplianceCtx, SkirtComplianceSpec,
    SkirtProfileCtx, SkirtProfileSpec,
};
use gudgeon_core::quantity::quantity;
use gudgeon_film::film_2d::{Cavitation, Direct};
use gudgeon_film::{SawtoothWaviness, WavinessTransport};
use gudgeon_skirt::{
    Body, ContactGrid, Crank, Cylindrical, Modal, NoGrooveFriction, NoPinFriction, Panel, Piston, Rigid, Rod,
    Shape, Side, SideSetup,
};

pub const RADIUS: f64 = 0.03824;
pub const LENGTH: f64 = 0.0303;
pub const HALF: [f64; 2] = [0.6213, 0.5306];

pub fn body() -> Body {
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

pub fn crank() -> Crank {
    Crank {
        radius: 0.0378,
        rod_length: 0.144,
        omega: 2500.0 * PI / 30.0,
        pin_offset: 5e-4,
        crank_offset: 0.0,
        rod: Rod::default(),
    }
}

pub struct Setup<'a> {
    pub film: &'a dyn Film2dSpec,
    pub roughness: &'a dyn RoughnessSpec,
    pub intervals: usize,
}

pub fn side(which: usize, setup: &Setup<'_>) -> Side {
    let panel = Panel { radius: RADIUS, length: LENGTH, half_angle: HALF[which] };
    side_of(panel, [1.0, -1.0][which], setup)
}

/// A side that does not yield.
pub fn rigid(grid: &Film2dGrid) -> Box<dyn SkirtCompliance> {
    Rigid {}.build(&SkirtComplianceCtx::new(grid, LENGTH, RADIUS, 0.6, &Files::default())).expect("builds")
}

pub fn side_of(panel: Panel, sign: f64, setup: &Setup<'_>) -> Side {
    let files = &Files::default();
    let profile =
        Cylindrical {}.build(&SkirtProfileCtx { length: LENGTH, radius: RADIUS, files }).expect("builds");
    let contact = CrestWedge {
        amplitude: quantity(4e-6),
        pitch: quantity(0.25e-3),
        composite_modulus: quantity(44.52e9),
        deflection: quantity(1.077),
        friction_coefficient: quantity(0.15),
    };
    let grid = panel.grid(setup.intervals, setup.intervals, 0.0);
    Side::new(SideSetup {
        panel,
        sign,
        clearance: 1e-5,
        grid: &grid,
        film: setup.film,
        roughness: setup.roughness,
        contact: &contact,
        boundary_friction: None,
        contact_grid: ContactGrid { pitch: 0.25e-3, intervals: 20 },
        profile: &*profile,
        compliance: rigid(&grid),
        shear_thinning: None,
        p_cav: 0.0,
        floor: 1e-7,
    })
    .expect("builds")
}

pub fn waves(transport: WavinessTransport) -> SawtoothWaviness {
    SawtoothWaviness { amplitude: quantity(4e-6), transport, closest: quantity(1.02) }
}

pub fn slider_crank(c: &Crank, deg: f64) -> PistonMotion {
    let ctx = KinematicsCtx {
        crank_radius: c.radius,
        rod_length: c.rod_length,
        offset: c.crank_offset - c.pin_offset,
        omega: c.omega,
    };
    gudgeon_kinematics::ExactSliderCrank {}.build(&ctx).expect("turns").motion(deg.to_radians())
}

pub fn piston(transport: WavinessTransport, centre_offset: f64) -> Piston {
    let roughness = waves(transport);
    let film = Direct { cavitation: Cavitation::HalfSommerfeld, ..Direct::default() };
    let setup = Setup { film: &film, roughness: &roughness, intervals: 12 };
    let free = (NoPinFriction {}.build(), NoGrooveFriction {}.build(&GrooveFrictionCtx { bore: 0.07651 }));
    let (Ok(pin), Ok(groove)) = free else { panic!("builds") };
    Piston::new([side(0, &setup), side(1, &setup)], Body { centre_offset, ..body() }, crank(), pin, groove)
}

/// A side that yields in two shapes, which come back to rest within `relaxation` seconds.
pub fn yielding_side(film: &dyn Film2dSpec, relaxation: f64) -> Side {
    yielding(film, 1.0, HALF[0], [3e8, 8e8], relaxation)
}

/// One side that yields in two shapes of the given stiffness.
pub fn yielding(
    film: &dyn Film2dSpec,
    sign: f64,
    half_angle: f64,
    stiffness: [f64; 2],
    relaxation: f64,
) -> Side {
    yielding_at(film, sign, half_angle, stiffness, relaxation, 0.0)
}

/// The same with a film that cavitates at `p_cav` above the pressure of the crankcase \[Pa\].
pub fn yielding_at(
    film: &dyn Film2dSpec,
    sign: f64,
    half_angle: f64,
    stiffness: [f64; 2],
    relaxation: f64,
    p_cav: f64,
) -> Side {
    let panel = Panel { radius: RADIUS, length: LENGTH, half_angle };
    let files = &Files::default();
    let modal = Modal {
        stiffness: stiffness.map(quantity).to_vec(),
        shapes: vec![Shape { power: 2, waves: 1 }, Shape { power: 0, waves: 1 }],
        file: None,
    };
    let roughness = waves(WavinessTransport::Homogenised);
    let profile =
        Cylindrical {}.build(&SkirtProfileCtx { length: LENGTH, radius: RADIUS, files }).expect("builds");
    let grid = panel.grid(12, 12, 0.0);
    let ctx = SkirtComplianceCtx::new(&grid, LENGTH, RADIUS, half_angle, files).relaxing(relaxation);
    let compliance = modal.build(&ctx).expect("shapes");
    Side::new(SideSetup {
        panel,
        sign,
        clearance: 1e-5,
        grid: &grid,
        film,
        roughness: &roughness,
        contact: &gudgeon_contact::Off {},
        boundary_friction: None,
        contact_grid: ContactGrid { pitch: 1e-3, intervals: 4 },
        profile: &*profile,
        compliance,
        shear_thinning: None,
        p_cav,
        floor: 1e-7,
    })
    .expect("builds")
}
