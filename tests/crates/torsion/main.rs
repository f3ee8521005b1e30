//! Tests of shaft lines against exact solutions, conservation laws and independent methods.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

mod balance;
mod common;
mod compressor;
mod couplings;
mod cycle;
mod drives;
mod eigenvalues;
mod elimination;
mod forced;
mod interpolant;
mod laws;
mod motion;
mod spectra;
mod steady;
mod time;
