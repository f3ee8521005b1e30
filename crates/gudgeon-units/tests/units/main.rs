//! Quantities and their spelling.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

mod quantities;
mod spelling;
