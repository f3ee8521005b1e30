//! Solid contact between a ring, or a skirt, and the liner: pressure of asperities, thresholds, floors, friction.
//!
//! | to do | use |
//! |---|---|
//! | compute a contact pressure, or its range | a specification below, [`build`](gudgeon_core::kinds::ContactSpec::build), then [`Contact`](gudgeon_core::kinds::Contact) |
//! | prepare material and roughness constants | [`composite_modulus`], [`composite_roughness`] |
//! | evaluate the integrals behind asperity models | [`f_5_2`], [`f_2`], [`f_3_2`], [`f_1`], [`asperity_integral()`], [`real_area_ratio`] |
//! | see what a published fit of `F_(5/2)` does | [`AsperityIntegralFormula`] |
//! | compute friction against sliding speed | [`Coulomb`], [`Stribeck`], [`ShearStrength`], then [`BoundaryFriction`](gudgeon_core::kinds::BoundaryFriction) |
//!
//! The models of the kind `contact`:
//!
//! | model | load carried by solids | friction |
//! |---|---|---|
//! | [`GreenwoodTripp`] | a pressure that grows smoothly as the surfaces approach | a coefficient times that pressure |
//! | [`GreenwoodWilliamson`] | the same for one rough surface on a plane | the same |
//! | [`KogutEtsion`] | the same, with summits that yield | the same |
//! | [`LoadSharing`] | that of summits on a plane, where the film thickness is the mean gap | the same |
//! | [`AbbottFirestone`] | the hardness times the share of a measured surface that would stand through the other | the same |
//! | [`CrestWedge`] | a pressure proportional to the overlap of wave crests | the same |
//! | [`LinearPenalty`] | a pressure proportional to the approach | the same |
//! | [`RoughnessThreshold`] | none until the film is as thin as the roughness, then whatever is left | the whole load rubs |
//! | [`FilmFloor`] | whatever is left at a smallest admitted film | none: the film keeps its viscous shear |
//! | [`Off`] | none | none |
//!
//! The coefficient of friction of these models does not depend on the sliding speed; a model of the kind `boundary_friction`
//! ([`Coulomb`], [`Stribeck`], [`Frictionless`]) gives one that does, or one that follows from the real area ([`ShearStrength`]).
//!
//! A contact alone:
//!
//! ```
//! use gudgeon_contact::{AsperityIntegralFormula, GreenwoodTripp, composite_modulus, f_5_2};
//! use gudgeon_core::kinds::{Contact, ContactSpec};
//! use gudgeon_core::quantity::quantity;
//!
//! # fn main() -> Result<(), gudgeon_core::BuildError> {
//! let steel_on_iron = composite_modulus([210e9, 110e9], [0.3, 0.26]); // Pa
//! let contact = GreenwoodTripp {
//!     roughness: quantity(0.4e-6),
//!     composite_modulus: quantity(steel_on_iron),
//!     eta_beta_sigma: Some(quantity(0.05)),
//!     sigma_over_beta: Some(quantity(1e-3)),
//!     asperity_density: None,
//!     asperity_radius: None,
//!     integral: AsperityIntegralFormula::Exact,
//!     friction_coefficient: quantity(0.1),
//! }
//! .build()?;
//! let mut pressure = [0.0; 3]; // Pa, at separations of 0, 1 and 2 roughness heights
//! contact.pressure(&[0.0, 0.4e-6, 0.8e-6], &mut pressure);
//! assert!((pressure[1] / pressure[0] - f_5_2(1.0) / f_5_2(0.0)).abs() < 1e-12);
//! # Ok(())
//! # }
//! ```
//!
//! Units are SI; separations are those of the mean planes, loads are nominal pressures.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]

mod abbott_firestone;
mod asperity_formula;
pub mod asperity_integral;
mod boundary_friction {
    //! Friction of solid contact against sliding speed, load and real area.
    mod check;
    pub mod coulomb;
    pub mod off;
    mod rounded_sign;
    pub mod shear_strength;
    pub mod stribeck;
}
mod crest_wedge;
mod film_floor;
mod greenwood_tripp;
mod greenwood_williamson;
mod kogut_etsion;
mod linear_penalty;
mod load_sharing;
mod log_table;
mod off;
mod roughness_threshold;
mod summits;

pub use abbott_firestone::AbbottFirestone;
pub use asperity_formula::AsperityIntegralFormula;
pub use asperity_integral::{asperity_integral, f_1, f_2, f_3_2, f_5_2};
pub use boundary_friction::coulomb::Coulomb;
pub use boundary_friction::off::Off as Frictionless;
pub use boundary_friction::shear_strength::ShearStrength;
pub use boundary_friction::stribeck::Stribeck;
pub use crest_wedge::CrestWedge;
pub use film_floor::FilmFloor;
pub use greenwood_tripp::{GreenwoodTripp, composite_modulus, composite_roughness, real_area_ratio};
pub use greenwood_williamson::GreenwoodWilliamson;
pub use kogut_etsion::KogutEtsion;
pub use linear_penalty::LinearPenalty;
pub use load_sharing::LoadSharing;
pub use off::Off;
pub use roughness_threshold::RoughnessThreshold;
pub use summits::SummitHeights;

gudgeon_core::link!(
    AbbottFirestone,
    Coulomb,
    CrestWedge,
    FilmFloor,
    Frictionless,
    GreenwoodTripp,
    GreenwoodWilliamson,
    KogutEtsion,
    LinearPenalty,
    LoadSharing,
    Off,
    RoughnessThreshold,
    ShearStrength,
    Stribeck,
);
