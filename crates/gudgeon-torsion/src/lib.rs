//! Torsional vibration of shaft lines.
//!
//! | kind | models |
//! |---|---|
//! | `coupling` | [`coupling::Linear`], [`coupling::Progressive`], [`coupling::Piecewise`], [`coupling::LoadDependent`], [`coupling::FrequencyDependent`], [`coupling::Off`] |
//! | `drive` | [`drive::Constant`], [`drive::Linear`], [`drive::InductionMotor`], [`drive::PowerLaw`], [`drive::Table`], [`drive::Harmonics`], [`drive::Off`] |
//! | `throw_inertia` | [`throw_inertia::Mean`], [`throw_inertia::FirstHarmonic`], [`throw_inertia::Exact`], [`throw_inertia::Off`] |
//! | `natural_frequencies` | [`natural_frequencies::Eigenvalues`], [`natural_frequencies::ClampedNeighbours`] |
//! | `torsion` | [`torsion::Orders`], [`torsion::Modal`], [`torsion::HarmonicBalance`], [`torsion::Propagator`], [`torsion::RungeKutta`], [`torsion::Implicit`], [`torsion::Off`] |
//!
//! Everything rests on one data structure, the line as a tree in the order of its elimination: see [`tree`].

pub mod coupling;
mod crank_end;
pub mod critical;
pub mod cycle;
pub mod damper;
pub mod drive;
mod dynamics;
pub mod eigen;
pub mod forcing;
pub mod interpolant;
pub mod natural_frequencies;
mod receptance;
pub mod shaft;
pub mod steady;
pub mod sweep;
pub mod throw_inertia;
pub mod torsion;
pub mod tree;

pub use crank_end::CrankEnd;

gudgeon_core::link!(
    coupling::FrequencyDependent,
    coupling::Linear,
    coupling::LoadDependent,
    coupling::Off,
    coupling::Piecewise,
    coupling::Progressive,
    drive::Constant,
    drive::Harmonics,
    drive::InductionMotor,
    drive::Linear,
    drive::Off,
    drive::PowerLaw,
    drive::Table,
    natural_frequencies::ClampedNeighbours,
    natural_frequencies::Eigenvalues,
    throw_inertia::Exact,
    throw_inertia::FirstHarmonic,
    throw_inertia::Mean,
    throw_inertia::Off,
    torsion::HarmonicBalance,
    torsion::Implicit,
    torsion::Modal,
    torsion::Off,
    torsion::Orders,
    torsion::Propagator,
    torsion::RungeKutta,
);
