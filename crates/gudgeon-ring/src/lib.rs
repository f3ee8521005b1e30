//! Motion of piston rings: axially between the flanks of their grooves, radially on their films, and the forces that published programs
//! count differently.
//!
//! A ring moves along the cylinder under gas, inertia, weight, the film on its face and the oil in its groove, and across it under tension and
//! gas against film and contact. Each part is a kind with several models:
//!
//! | kind | question | models |
//! |---|---|---|
//! | [`ring_motion`](gudgeon_core::kinds::RingMotionSpec) | where is the ring between its flanks? | [`NewtonGroove`] (mass between stiff flanks), [`ThreeSeat`] (sits where the forces point), [`Seated`] (stays) |
//! | [`flank`](gudgeon_core::kinds::FlankSpec) | what does the oil between ring and flanks do to ring and gas? | [`WettedStrip`], [`SqueezeFilm`], [`TangentRadians`], [`TangentDegrees`], [`Dry`] |
//! | [`flank_friction`](gudgeon_core::kinds::FlankFrictionSpec) | how does a flank resist radial motion? | [`TanhStribeck`], [`RationalSaturation`], [`FrictionOff`] |
//! | [`radial_motion`](gudgeon_core::kinds::RadialMotionSpec) | how fast does the film thickness change? | [`FilmBalance`] |
//! | [`hoop`], [`radial_gas`], [`axial_gas`], [`cavitation_datum`], [`film_force`], [`drag`], [`twin_land_friction`] | which surfaces and which forces count? | the laws in which published programs differ, a module each |
//!
//! All are used in the same way: a specification is a plain struct with its settings, `build` checks them and gives the running model, which
//! allocates nothing when it is asked. A model that integrates something declares its states by
//! [`Stateful`](gudgeon_core::states::Stateful); the crate [`gudgeon_core::kinds`] says what each running model answers.
//!
//! # Example
//!
//! A ring of the flank area `A` that approaches a flank at the distance `h` with the velocity `v` squeezes the oil that wets the fraction `f` of its
//! width `w` out with the force `μ A w² f³ v/(h + σ)³`, with the roughness distance `σ` of the flanks.
//!
//! ```
//! use gudgeon_core::geometry::FlankOil;
//! use gudgeon_core::kinds::{FlankCtx, FlankSpec};
//! use gudgeon_core::quantity::quantity;
//! use gudgeon_ring::SqueezeFilm;
//!
//! let spec = SqueezeFilm { roughness: quantity(0.4e-6), separation: quantity(0.0), ..SqueezeFilm::default() };
//! let oil = spec.build(&FlankCtx::new(0, 3, 0.6, 5e-3, 0.01))?.law();
//! let (s, v, clearance, area) = (2e-5_f64, -1e-3, 1e-4, 1.8e-3);
//! let exact = 0.01 * area * 5e-3_f64.powi(2) * 0.6_f64.powi(3) * 1e-3 / (s + 0.4e-6).powi(3);
//! assert!((oil.force(&FlankOil::default(), s, v, clearance, area) / exact - 1.0).abs() < 1e-14);
//! # Ok::<(), gudgeon_core::BuildError>(())
//! ```
//!
//! Units are SI. Heights `s` are measured from the lower groove flank, velocities and forces are positive towards the head.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]

pub mod axial_gas;
pub mod cavitation_datum;
pub mod drag;
pub mod film_force;
mod flank;
mod flank_friction;
pub mod hoop;
pub mod radial_gas;
mod radial_motion;
mod ring_motion;
pub mod twin_land_friction;

pub use flank::dry::Dry;
pub use flank::squeeze_film::SqueezeFilm;
pub use flank::tangent_degrees::TangentDegrees;
pub use flank::tangent_radians::TangentRadians;
pub use flank::wetted_strip::WettedStrip;
pub use flank_friction::off::Off as FrictionOff;
pub use flank_friction::rational_saturation::RationalSaturation;
pub use flank_friction::tanh_stribeck::TanhStribeck;
pub use radial_motion::film_balance::FilmBalance;
pub use ring_motion::newton_groove::NewtonGroove;
pub use ring_motion::seated::{Flank, Seated};
pub use ring_motion::three_seat::ThreeSeat;

/// Parts that the tests of this crate look at. No interface: they change without notice.
#[doc(hidden)]
pub mod parts {
    pub use crate::flank_friction::tanh_stribeck;
    pub use crate::radial_motion::search::soft;
    pub use crate::ring_motion::groove_flank::GrooveFlank;
    pub use crate::ring_motion::hold::{Balance, Groove, Hold, Holding};
}

gudgeon_core::link!(
    Dry,
    FilmBalance,
    FrictionOff,
    NewtonGroove,
    RationalSaturation,
    Seated,
    SqueezeFilm,
    TangentDegrees,
    TangentRadians,
    TanhStribeck,
    ThreeSeat,
    WettedStrip,
    axial_gas::FullPerimeter,
    axial_gas::LaminarProfile,
    axial_gas::LinearProfile,
    cavitation_datum::Absolute,
    cavitation_datum::Gauge,
    drag::FaceShear,
    drag::Liner,
    film_force::FaceShear,
    film_force::LinerReaction,
    film_force::Total,
    hoop::AsPrinted,
    hoop::Correct,
    radial_gas::BackAndFace,
    radial_gas::BackFaceAndGap,
    radial_gas::BackOnly,
    radial_gas::BorePerimeter,
    twin_land_friction::BothLands,
    twin_land_friction::LowerTwice,
);
