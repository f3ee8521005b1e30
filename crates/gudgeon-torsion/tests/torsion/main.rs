//! Tests of shaft lines against exact solutions, conservation laws and independent methods.

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
