//! Values of files, files and grids.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

mod content;
mod file;
mod film_2d;
