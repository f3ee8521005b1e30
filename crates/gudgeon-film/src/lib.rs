//! Lubricant films: pressure, load and friction of thin oil films, and the properties of the oil in them.
//!
//! A film is a thin gap `h` between two surfaces, filled with oil of viscosity `μ`, one surface sliding with the velocity `u` along `x`. Its pressure `p`
//! follows from Reynolds' equation,
//!
//! `∂/∂x(h³/(12 μ) ∂p/∂x) + ∂/∂y(h³/(12 μ) ∂p/∂y) = ∂/∂x(u h/2) + ∂h/∂t`,
//!
//! with a condition for where it would fall below the cavitation pressure. This crate solves it on three kinds of gap:
//!
//! | gap | interface | models |
//! |---|---|---|
//! | along any line, given by its panels | [`Film1dSpec`](gudgeon_core::kinds::Film1dSpec), [`Film1d`](gudgeon_core::kinds::Film1d) | module [`film_1d`]: [`Complementarity`](film_1d::Complementarity), [`FrontTracking`](film_1d::FrontTracking), [`ElrodAdams`](film_1d::ElrodAdams) |
//! | along and across the motion, on a grid | [`Film2dSpec`](gudgeon_core::kinds::Film2dSpec), [`Film2d`](gudgeon_core::kinds::Film2d) | module [`film_2d`]: [`Multigrid`](film_2d::Multigrid), [`Direct`](film_2d::Direct), [`Sor`](film_2d::Sor), [`CentralDifferences`](film_2d::CentralDifferences) |
//! | under the running face of a piston ring | [`HydrodynamicsSpec`](gudgeon_core::kinds::HydrodynamicsSpec), [`Hydrodynamics`](gudgeon_core::kinds::Hydrodynamics) | [`ClosedFormFace`], [`GriddedFace`] |
//!
//! Each is used in the same way: choose a model (a plain struct with its settings, most have a default), `build` it once for a geometry, which
//! allocates what it needs, and ask it for a film as often as needed, which allocates nothing. The oil and the surfaces have models of their own:
//!
//! | property | models |
//! |---|---|
//! | viscosity over temperature | [`Constant`], [`Vogel`], [`VogelGrade`], [`Walther`] |
//! | viscosity under pressure | [`Barus`], [`Roelands`], [`Isoviscous`] |
//! | viscosity under shear | [`Cross`], [`Carreau`], [`Newtonian`] |
//! | density under pressure | [`DowsonHigginson`], [`Incompressible`] |
//! | flow between rough surfaces | [`PatirCheng`], [`Tripp`], [`SawtoothWaviness`], [`SmoothSurfaces`] |
//! | temperature of the film under each ring | [`Given`], [`LinerLinear`], [`LandWallMean`], [`EnergyBalance`] |
//! | oil that rings leave on the liner | module [`oil_transport`] |
//! | oil that evaporates from there | module [`evaporation`] |
//!
//! A viscosity that depends on pressure or shear goes around a film along a line by [`film_1d::ViscosityLoop`].
//!
//! # Example
//!
//! A linear slider of length `l` whose gap narrows from `k h` to `h` carries `6 μ u (l/h)²/(k - 1)² (ln k - 2 (k - 1)/(k + 1))` per metre of width.
//!
//! ```
//! use gudgeon_core::kinds::{Film1dCtx, Film1dIn, Film1dSpec, FilmEnd, FilmTime};
//! use gudgeon_film::film_1d::Complementarity;
//!
//! let (l, h, k, mu, u) = (0.01, 10e-6, 2.0_f64, 0.02, 5.0);
//! let x: Vec<f64> = (0..=100).map(|i| l * f64::from(i) / 100.0).collect();
//! let gap: Vec<f64> = x.iter().map(|x| h * (k - (k - 1.0) * x / l)).collect();
//! let mut film = Complementarity::default().build(&Film1dCtx { x: &x })?;
//! let ends = [FilmEnd::Flooded { p: 0.0 }; 2];
//! let (h_a, h_b, mu_all) = (&gap[..100], &gap[1..], [mu; 100]);
//! let time = FilmTime::Steady;
//! let found = film.solve(&Film1dIn { h_a, h_b, mu: &mu_all, factors: None, u, ends, p_cav: 0.0, time })?;
//! let exact = 6.0 * mu * u * (l / h / (k - 1.0)).powi(2) * (k.ln() - 2.0 * (k - 1.0) / (k + 1.0));
//! assert!((found.load / exact - 1.0).abs() < 1e-12); // panels with a linear gap are exact
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Units are SI. Pressures are absolute, loads count from the cavitation pressure, and forces are per metre across the film.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]

mod cavitation;
mod compressibility;
pub mod evaporation;
pub mod film_1d;
pub mod film_2d;
mod film_temperature;
mod hydrodynamics;
mod oil;
pub mod oil_transport;
mod piezoviscosity;
mod roughness;
mod shear_thinning;
mod slices;

pub use cavitation::Cavitation;
pub use compressibility::dowson_higginson::DowsonHigginson;
pub use compressibility::off::Off as Incompressible;
pub use film_temperature::{EnergyBalance, Given, LandWallMean, LinerLinear};
pub use hydrodynamics::{CavityShear, ClosedFormFace, GriddedFace, Off};
pub use oil::{Constant, Grade, Table, Vogel, VogelGrade, VogelTable, Walther};
pub use piezoviscosity::barus::Barus;
pub use piezoviscosity::off::Off as Isoviscous;
pub use piezoviscosity::roelands::Roelands;
pub use roughness::off::Off as SmoothSurfaces;
pub use roughness::patir_cheng::{PatirCheng, Pattern};
pub use roughness::sawtooth_waviness::{SawtoothWaviness, WavinessTransport};
pub use roughness::tripp::Tripp;
pub use shear_thinning::carreau::Carreau;
pub use shear_thinning::cross::Cross;
pub use shear_thinning::off::Off as Newtonian;

gudgeon_core::link!(
    Barus,
    Carreau,
    ClosedFormFace,
    Constant,
    Cross,
    DowsonHigginson,
    EnergyBalance,
    Given,
    GriddedFace,
    Incompressible,
    Isoviscous,
    LandWallMean,
    LinerLinear,
    Newtonian,
    Off,
    PatirCheng,
    Roelands,
    SawtoothWaviness,
    SmoothSurfaces,
    Table,
    Tripp,
    Vogel,
    VogelGrade,
    Walther,
    evaporation::HeatMassAnalogy,
    evaporation::Off,
    film_1d::Complementarity,
    film_1d::ElrodAdams,
    film_1d::FrontTracking,
    film_1d::Off,
    film_2d::CentralDifferences,
    film_2d::Direct,
    film_2d::Multigrid,
    film_2d::Off,
    film_2d::Sor,
    oil_transport::LinerFilm,
    oil_transport::Off,
);

/// Parts that the tests of this crate look at. No interface: they change without notice.
#[doc(hidden)]
pub mod parts {
    pub use crate::evaporation::petroleum::{diffusivity, lewis_number, molar_mass, vapour_pressure};
    pub use crate::film_1d::line::Line;
    pub use crate::film_1d::rows::{Node, Rows};
    pub use crate::hydrodynamics::closed_form_face::crown::{Asked, Crown, Crowned};
    pub use crate::hydrodynamics::closed_form_face::moments::{Moments, SERIES, angle, core};
    pub use crate::hydrodynamics::closed_form_face::parabola::Parabola;
    pub use crate::hydrodynamics::closed_form_face::shape::Shape;
    pub use crate::hydrodynamics::closed_form_face::table::Table;
    pub use crate::oil_transport::carried::Carried;
    pub use crate::oil_transport::face::{MIN_REACH, SIDES, WAVE_SLOPE};
    pub use crate::oil_transport::land_cycle::LandCycle;
    pub use crate::oil_transport::lands::Lands;
    pub use crate::oil_transport::law::Law;
    pub use crate::oil_transport::side::Side;
    pub use crate::piezoviscosity::reduced_pressure::ReducedPressure;
    pub use crate::piezoviscosity::tame_exp;
    pub use crate::roughness::{GaussianGap, patir_cheng, sawtooth_waviness};
}
