//! Quantities and their spelling.

mod quantities;
mod spelling;
