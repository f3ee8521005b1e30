//! Oil and its rheology, film temperature, rough surfaces, the film under a ring face, and films along a line and along and across
//! the motion.

mod closed_form_face;
mod constant;
mod crown;
mod face;
pub mod film_1d;
pub mod film_2d;
mod given;
mod gridded_face;
mod land_wall_mean;
mod liner_linear;
mod off;
pub mod oil_transport;
mod piezoviscosity;
mod roughness;
mod slices;
mod compressibility {
    //! Density under pressure.
    pub mod dowson_higginson;
    pub mod off;
}
mod shear_thinning {
    //! Viscosity under shear.
    pub mod carreau;
    pub mod cross;
    pub mod off;
}
mod vogel;
mod vogel_grade;

pub use closed_form_face::{Cavitation, CavityShear, ClosedFormFace};
pub use compressibility::dowson_higginson::DowsonHigginson;
pub use compressibility::off::Off as Incompressible;
pub use constant::Constant;
pub use given::Given;
pub use gridded_face::GriddedFace;
pub use land_wall_mean::LandWallMean;
pub use liner_linear::LinerLinear;
pub use off::Off;
pub use piezoviscosity::barus::Barus;
pub use piezoviscosity::off::Off as Isoviscous;
pub use piezoviscosity::roelands::Roelands;
pub use roughness::off::Off as SmoothSurfaces;
pub use roughness::patir_cheng::{PatirCheng, Pattern};
pub use roughness::sawtooth_waviness::{SawtoothWaviness, WavinessTransport};
pub use shear_thinning::carreau::Carreau;
pub use shear_thinning::cross::Cross;
pub use shear_thinning::off::Off as Newtonian;
pub use vogel::Vogel;
pub use vogel_grade::{Grade, VogelGrade, VogelTable};

gudgeon_core::link!(
    Barus,
    Carreau,
    ClosedFormFace,
    Constant,
    Cross,
    DowsonHigginson,
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
    Vogel,
    VogelGrade,
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
