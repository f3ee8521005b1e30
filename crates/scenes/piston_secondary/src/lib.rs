//! The scene `piston_secondary`: lateral motion and tilt of one piston on the films and crests of its skirt.
//!
//! `assemble` builds the sub-models into an `assembly`, `layout` places their states, `equations` gives the rates of all states, `implicit`, its `stages` and `backward_euler` integrate
//! them, `march` finds the periodic motion and `search` the motions on the way to it, `row` and `survey` look at a cycle, `spectrum` takes its lateral forces apart into harmonics, `results`, `record` and `draw` turn it into results, rows and pictures.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]

pub mod assemble;
pub mod assembly;
pub mod backward_euler;
pub mod case;
mod draw;
mod elsewhere;
pub mod equations;
mod explained;
mod film_strokes;
mod headlines;
pub mod implicit;
mod impossible;
pub mod layout;
mod legal;
pub mod march;
mod methods;
mod notes;
pub mod oil;
pub mod peak_width;
pub mod places;
pub mod plan;
pub mod record;
pub mod results;
pub mod row;
mod scene;
mod search;
pub mod solver;
pub mod spectrum;
pub mod stages;
pub mod survey;
pub mod trajectory;

use case::PistonSecondaryCase;

gudgeon_scene::register_scene! {
    PistonSecondaryCase,
    name: "piston_secondary",
    summary: "the lateral motion and the tilt of a piston in its bore",
    equations: "forces and moments of films, contact, rod, gas and friction balance mass times acceleration in two coordinates e_t, e_b and one for every shape of an elastic side",
    validity: "Motion in the plane of the rod; one viscosity for both sides; inertia of shapes left out.",
    references: ["loureiro2009", "zhu1992"],
}

gudgeon_core::link!(PistonSecondaryCase, backward_euler::BackwardEuler, implicit::Implicit);
