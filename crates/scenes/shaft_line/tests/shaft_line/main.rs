//! Tests of the scene `shaft_line`.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

mod tors;
