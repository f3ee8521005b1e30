//! Tests of the scene `shaft_line`.

mod tors;
