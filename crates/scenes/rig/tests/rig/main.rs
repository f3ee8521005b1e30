//! Tests of the crate as one program.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

mod bad_inputs;
mod films_along_and_across;
mod films_along_lines;
mod physics;
mod profile;
mod sheet;
mod validity;
