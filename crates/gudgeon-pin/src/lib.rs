//! Gudgeon pins and pistons: strength of the pin, the lightest pin that keeps its limits, rules of piston design.
//!
//! # From a load to a pin
//!
//! 1. A `pin_load` gives the forces on the pin, a `pin_strength` its eight quantities (pressures, stresses, deformations) with first and
//!    second derivatives by length and diameters.
//! 2. [`design::Design`] puts them together with limits, ranges, tolerances and weights. It gives the utilisation of every limit, masses,
//!    the maximum bore that the limits admit, and the limits that leave no pin at all.
//! 3. [`optimum::lightest`] minimises the mass and returns the residuals of the conditions of an optimum; [`certificate::certify`] bounds the
//!    mass of every other pin of the ranges by branch and bound; [`stepper`] is the published search, [`stock`] chooses from sizes that can
//!    be had.
//!
//! [`piston`] holds rules of piston design: clearance, profile and ovality of the skirt, crown recess, main dimensions, alloys.
//!
//! ```
//! use gudgeon_core::kinds::{BossBore, PinForces, PinQuantity, PinSize, PinStrengthCtx, PinStrengthSpec};
//! use gudgeon_pin::ElasticRing;
//! use gudgeon_pin::certificate::certify;
//! use gudgeon_pin::design::{Design, Range};
//! use gudgeon_pin::optimum::{KKT_TOLERANCE, lightest};
//!
//! let around = PinStrengthCtx {
//!     boss_gap: 32e-3,
//!     rod_width: 30e-3,
//!     boss_bore: BossBore::Profiled,
//!     modulus: 206e9,
//!     poisson: 0.3,
//!     pi: std::f64::consts::PI,
//! };
//! let strength = ElasticRing { plane_strain: false }.build(&around)?;
//! let mut limits = [f64::INFINITY; 8];
//! limits[PinQuantity::BossPressure as usize] = 60e6;
//! limits[PinQuantity::BendingStress as usize] = 450e6;
//! limits[PinQuantity::OvalisationStress as usize] = 350e6;
//! let design = Design {
//!     strength: &*strength,
//!     load: PinForces { gas: 60e3, inertia: -2e3 },
//!     limits,
//!     density: 7850.0,
//!     pi: around.pi,
//!     relief: None,
//!     boss_gap: around.boss_gap,
//!     length: Range { low: 33e-3, high: 80e-3 },
//!     outer: Range { low: 15e-3, high: 40e-3 },
//!     inner: Range { low: 0.0, high: 40e-3 },
//!     min_wall: 0.0,
//!     tolerance: PinSize::default(),
//! };
//! let best = lightest(&design, None).expect("such a pin exists");
//! assert!(best.kkt.hold(KKT_TOLERANCE));
//! // Three dimensions, three limits: all of them are used up.
//! assert_eq!(best.active().len(), 3);
//! // No pin of the ranges is lighter by more than a thousandth.
//! let certificate = certify(&design, &best.size, 1e-3, 100_000);
//! assert!(certificate.closed && certificate.lighter.is_none());
//! # Ok::<(), gudgeon_core::BuildError>(())
//! ```
//!
//! # Models
//!
//! | kind | models |
//! |---|---|
//! | `pin_strength` | [`ThinRing`], [`ShearBeam`], [`CurvedRing`], [`ElasticRing`] |
//! | `pin_load` | [`PeakPressureRule`], [`Given`], [`Cycle`], [`OtherCase`] |
//! | `fatigue` | [`Goodman`], [`Gerber`], [`Soderberg`], [`Off`] |
//! | `profile_curve` | [`Lagrange`], [`MonotoneCubic`], [`Linear`] |
#![cfg_attr(doctest, doc = include_str!("../README.md"))]

pub mod certificate;
pub mod design;
mod fatigue;
pub mod optimum;
mod pin_load;
mod pin_strength;
pub mod piston;
mod profile_curve;
pub mod stepper;
pub mod stock;

pub use fatigue::gerber::Gerber;
pub use fatigue::goodman::Goodman;
pub use fatigue::off::Off;
pub use fatigue::soderberg::Soderberg;
pub use pin_load::cycle::Cycle;
pub use pin_load::given::Given;
pub use pin_load::other_case::OtherCase;
pub use pin_load::peak_pressure_rule::PeakPressureRule;
pub use pin_strength::curved_ring::CurvedRing;
pub use pin_strength::elastic_ring::ElasticRing;
pub use pin_strength::shear_beam::ShearBeam;
pub use pin_strength::thin_ring::ThinRing;
pub use profile_curve::lagrange::Lagrange;
pub use profile_curve::linear::Linear;
pub use profile_curve::monotone_cubic::MonotoneCubic;

gudgeon_core::link!(
    CurvedRing,
    Cycle,
    ElasticRing,
    Gerber,
    Given,
    Goodman,
    Lagrange,
    Linear,
    MonotoneCubic,
    Off,
    OtherCase,
    PeakPressureRule,
    ShearBeam,
    Soderberg,
    ThinRing,
);
