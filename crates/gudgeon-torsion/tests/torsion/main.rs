//! Tests of shaft lines against exact solutions, conservation laws and independent methods.

mod common;
mod compressor;
mod couplings;
mod cycle;
mod drives;
mod eigenvalues;
mod forced;
mod interpolant;
mod time;
