//! Gudgeon pins and pistons: strength of the pin, its lightest dimensions, rules of piston design.
//!
//! | kind | models |
//! |---|---|
//! | `pin_strength` | [`ThinRing`], [`ShearBeam`], [`CurvedRing`], [`ElasticRing`] |
//! | `pin_load` | [`PeakPressureRule`], [`Given`], [`Cycle`], [`OtherCase`] |
//! | `fatigue` | [`Goodman`], [`Gerber`], [`Soderberg`], [`Off`] |
//! | `profile_curve` | [`Lagrange`], [`MonotoneCubic`], [`Linear`] |
//!
//! [`design`] says what a pin must keep, [`optimum`] finds the lightest one and proves it, [`certificate`] shows that no other part of the
//! design space holds a lighter one, [`stepper`] is the published search, [`stock`] chooses from sizes that can be had. [`piston`] holds rules of piston design.

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
