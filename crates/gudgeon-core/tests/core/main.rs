//! Values of files, files and grids.

mod content;
mod file;
mod film_2d;
