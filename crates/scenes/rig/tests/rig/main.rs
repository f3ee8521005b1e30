//! Tests of the crate as one program.

mod bad_inputs;
mod films_along_and_across;
mod films_along_lines;
mod physics;
mod profile;
mod sheet;
mod validity;
