//! Torsional vibration of shaft lines: natural frequencies, forced vibration order by order, motion over time.
//!
//! A line is a tree of inertias and links ([`Line`](gudgeon_core::kinds::Line)); [`chain()`] makes one of a plain shaft. Angles are in rad, torques in N m,
//! inertias in kg m², frequencies in rad/s. What is wanted decides where to go on:
//!
//! | wanted | where |
//! |---|---|
//! | natural frequencies, shapes, damped eigenvalues | [`tree::Tree::new`], then [`eigen::natural_frequencies`], [`eigen::shapes`], [`eigen::roots`] |
//! | response to torques of one frequency; of several speeds side by side | [`tree::Tree::solve`]; [`sweep::Sweep`] |
//! | response at a constant mean speed: mean torques, orders, critical speeds | [`steady::Steady`]; of many orders at once [`receptance::Receptance`] |
//! | torques of gas and moving masses as harmonics | [`forcing::Excitation`], [`forcing::series`] |
//! | maximum and minimum over the cycle of a sum of orders | [`cycle::Cycle`] |
//! | stiffness and stress of round shafts, optimal dampers | [`shaft`], [`damper`] |
//! | everything of a line at once, periodic or over time | a model of the kind `torsion`, below |
//!
//! The natural frequency of two inertias on a shaft is `√(k (1/J₁ + 1/J₂))`:
//!
//! ```
//! use gudgeon_torsion::{chain, eigen::natural_frequencies, tree::Tree};
//!
//! let (j1, j2, k) = (2.0, 0.5, 8e3);
//! let shaft = Tree::new(&chain(&[j1, j2], &[k])?)?;
//! let omega = natural_frequencies(&shaft, 2)?;
//! let exact = f64::sqrt(k * (1.0 / j1 + 1.0 / j2));
//! // The rigid mode is exact, the other right to rounding.
//! assert!(omega[0] == 0.0 && (omega[1] / exact - 1.0).abs() < 1e-15);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The models, by kind, as case files name them:
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
#![cfg_attr(doctest, doc = include_str!("../README.md"))]

mod bracket;
mod chain;
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
pub mod receptance;
pub mod shaft;
pub mod steady;
pub mod sweep;
pub mod throw_inertia;
pub mod torsion;
pub mod tree;

pub use chain::chain;
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
