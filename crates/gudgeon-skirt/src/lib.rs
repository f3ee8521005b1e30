//! The skirt of a piston between its liner: gap, films and solid contact of both sides, how the skirt yields, and the balance of all forces across
//! the bore.
//!
//! # Where to begin
//!
//! | what you have | what to use |
//! |---|---|
//! | one side at a place and at velocities, and you want its forces | [`Side`]: [`Side::place`], then [`Side::loads`] |
//! | a whole piston, and you want to know how it moves | [`Piston`]: [`Piston::ask`] answers with velocities or forces |
//! | masses and crank drive | [`Body`], [`Crank`], [`Instant`] |
//! | a model of your own | the traits of `gudgeon_core::kinds`; [`QuasiStatic`] and [`Modal`] are short examples |
//!
//! Coordinates of a [`Piston`] are the displacements of the upper and the lower edge of its skirt towards the anti-thrust side, then the amplitudes of
//! the elastic shapes of the thrust side, then those of the other. All quantities are SI; pressures count above that of the crankcase.
//!
//! # Models
//!
//! Lateral motions ([`FullInertia`], [`QuasiStatic`], [`Held`]) and compliances ([`Rigid`], [`Modal`], [`InfluenceMatrix`]) own their states;
//! shapes ([`Cylindrical`], [`Barrel`], [`Table`]), frictions ([`PinCoulomb`], [`GrooveCoulomb`]) and the supply of oil ([`FillHistory`]) have none. Each is registered and is read from a
//! case file by its name. Films, rough surfaces and contact come from other crates, by the traits of `gudgeon_core`.
//!
//! # Example
//!
//! How hard the rod presses a piston against its liner, and how far a skirt that yields gives way there:
//!
//! ```
//! use gudgeon_core::{file::Files, kinds::*, quantity::quantity};
//! use gudgeon_skirt::{Body, Crank, Modal, Panel, Rod, Shape};
//!
//! let (piston_mass, pin_mass, inertia) = (0.236, 0.052, 1.36e-4);
//! let body = Body { piston_mass, pin_mass, inertia, length: 0.03, pin: 8e-3, centre: 3e-4, centre_offset: 0.0 };
//! let (radius, rod_length, pin_offset) = (0.038, 0.144, 5e-4);
//! let crank = Crank { radius, rod_length, omega: 260.0, pin_offset, crank_offset: 0.0, rod: Rod::default() };
//! // 30 deg after firing, at 20 bar above the crankcase.
//! let motion = PistonMotion { v: -6.0, a: -2600.0, ..Default::default() };
//! let now = crank.instant(30f64.to_radians(), &motion, 2e6, 4.6e-3, 0.016);
//! let force = body.rod_lateral(&now, 0.0);
//! assert!(force < -1000.0, "towards the thrust side: {force} N");
//!
//! let panel = Panel { radius: 0.038, length: body.length, half_angle: 0.6 };
//! let (grid, files) = (panel.grid(16, 12, 0.0), Files::default());
//! let bulge = Modal { stiffness: vec![quantity(3e8)], shapes: vec![Shape { power: 0, waves: 1 }], file: None };
//! let skirt = bulge.build(&SkirtComplianceCtx::new(&grid, panel.length, panel.radius, panel.half_angle, &files))?;
//! assert!((2e-6..1e-5).contains(&skirt.rest(0, -force)), "some micrometres");
//! # Ok::<(), gudgeon_core::BuildError>(())
//! ```
#![cfg_attr(doctest, doc = include_str!("../README.md"))]

mod body;
mod geometry;
mod groove_friction;
mod pin_friction;
mod piston;
mod secondary_motion;
mod side;
mod skirt_compliance;
mod skirt_oil;
mod skirt_profile;

pub use body::{Body, Crank, Instant, Rod};
pub use geometry::{CROWDING, Panel};
pub use groove_friction::{Coulomb as GrooveCoulomb, Off as NoGrooveFriction};
pub use pin_friction::{Coulomb as PinCoulomb, Off as NoPinFriction};
pub use piston::{Asked, Momentum, Partials, Piston, Summary};
pub use secondary_motion::{FullInertia, Held, QuasiStatic};
pub use side::{ContactGrid, Filling, OilMoved, OilWay, Side, SideLoads, SideSetup, Slopes};
pub use skirt_compliance::{InfluenceMatrix, Modal, QuasiStaticShapes, Rigid, Shape};
pub use skirt_oil::{FillHistory, Off as NoSkirtOil};
pub use skirt_profile::{Barrel, Cylindrical, Table};

gudgeon_core::link!(
    Barrel,
    Cylindrical,
    FillHistory,
    FullInertia,
    GrooveCoulomb,
    Held,
    InfluenceMatrix,
    Modal,
    NoGrooveFriction,
    NoPinFriction,
    NoSkirtOil,
    PinCoulomb,
    QuasiStatic,
    Rigid,
    Table,
);
