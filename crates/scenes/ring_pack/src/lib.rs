//! The scene `ring_pack`: one cylinder's rings with their gas, films and axial motion.
//!
//! `geometry` resolves dimensions, `plan` decides what must run, `assemble` builds the sub-models into a `pack::Pack`,
//! one of `implicit`, `substep_march` and `degree_march` solves it. `measure` gathers what the results need on the steps of the last cycle,
//! `results` says it, `record` holds the series.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]

pub mod acted;
pub mod around;
pub mod assemble;
pub mod case;
mod closing_film;
pub mod contact_line;
pub mod conventions;
pub mod degree_march;
pub mod distortion;
mod draw;
mod end_gap;
mod error;
mod evaporation;
mod film_strokes;
mod films_between;
mod forces;
mod gas_balance;
mod gas_ledger;
pub mod geometry;
mod headlines;
pub mod implicit;
pub mod instant;
pub mod jacobian;
pub mod layout;
pub mod limits;
pub mod liner;
pub mod liner_wear;
mod loads;
pub mod marching;
pub mod measure;
pub mod modes;
mod oil_faces;
pub mod pack;
pub mod plan;
mod plausible;
pub mod rails;
pub mod record;
pub mod results;
mod rheology;
pub mod ring;
pub mod rows;
pub mod rubbing;
mod scene;
pub mod solve;
pub mod solver;
pub mod staged;
mod stepping;
pub mod substep_march;
mod twin;
mod used;
mod vent;
pub mod watch;
mod waveform;

use gudgeon_core::BuildError;

use case::RingPackCase;
pub use error::RingPackError;
use pack::Pack;
use results::Meter;

/// Combinations that mean nothing, with the reason.
#[must_use]
pub fn legal(case: &RingPackCase) -> Vec<BuildError> {
    let mut errors = Vec::new();
    let l = &case.solver.limits;
    for (from, full, key) in [
        (l.drag_from.si(), l.drag_full.si(), "drag_full"),
        (l.drag_gap_from.si(), l.drag_gap_full.si(), "drag_gap_full"),
    ] {
        if from >= full {
            errors.push(BuildError::at(
                format!("solver.limits.{key}"),
                format!("the drag cannot count in full at {full} when it begins to count at {from}"),
            ));
        }
    }
    errors
}

/// Names of the states in the order of the state vector.
#[must_use]
pub fn state_names(pack: &Pack) -> Vec<String> {
    let mut names: Vec<String> = pack.layout.states.iter().map(|s| s.name.clone()).collect();
    for (i, r) in pack.rings.iter().enumerate() {
        if r.is_decided() {
            names.push(format!("seat of ring{} (decided in steps)", i + 1));
        }
    }
    names
}

/// How blow-by is metered.
#[must_use]
pub fn meter(case: &RingPackCase) -> Meter {
    let g = &case.gas;
    Meter {
        density: g.meter_pressure.si() / (g.gas_constant.si() * g.meter_temperature.si()),
        cylinders: f64::from(case.engine.cylinders),
        pressure: g.meter_pressure.si(),
    }
}

gudgeon_core::link!(RingPackCase, degree_march::DegreeMarch, implicit::Implicit, substep_march::SubstepMarch,);
