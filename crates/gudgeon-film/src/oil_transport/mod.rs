//! Models of the oil on the liner.

pub(crate) mod carried;
pub(crate) mod face;
pub(crate) mod land_cycle;
pub(crate) mod lands;
pub(crate) mod law;
mod liner;
mod liner_film;
mod off;
pub(crate) mod side;
mod vapour;

pub use liner_film::LinerFilm;
pub use off::Off;
