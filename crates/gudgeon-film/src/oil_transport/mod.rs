//! Models of the oil on the liner.

mod carried;
mod face;
mod law;
mod liner;
mod liner_film;
mod off;

pub use liner_film::LinerFilm;
pub use off::Off;
