//! Files and grids.

mod file;
mod film_2d;
