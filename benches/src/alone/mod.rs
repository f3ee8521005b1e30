//! Every registered model alone: built from its registered example, under the conditions of an ordinary machine, and asked what its kind is
//! asked most.
//!
//! The list of [`KINDS`] names each kind once; models come from the registry, so that a new one takes part by itself.

mod engine;
mod film;
mod gas;
mod pin;
mod rig;
mod ring;
mod shaft;
mod skirt;

use std::fmt::Display;
use std::hint::black_box;

use gudgeon_core::registry::Kind;
use gudgeon_core::{EvalError, ModelInfo, Registry};

/// A model that stands alone.
pub struct Alone {
    /// Builds it from its specification.
    pub build: Box<dyn FnMut()>,
    /// Asks the running model, which keeps what it remembers from one call to the next.
    pub ask: Box<dyn FnMut()>,
}

/// How the models of a kind are reached.
#[derive(Clone, Copy)]
pub enum Reach {
    /// Alone. The function builds a model and asks it once, so that one that fails is not timed.
    Alone(fn(&ModelInfo) -> Result<Alone, String>),
    /// Only within a scene, whose other parts it asks: why.
    Within(&'static str),
}

/// All kinds, by name.
pub const KINDS: &[(&str, Reach)] = &[
    ("axial_gas", Reach::Alone(ring::axial_gas)),
    ("boundary_friction", Reach::Alone(film::boundary_friction)),
    ("cavitation_datum", Reach::Alone(ring::cavitation_datum)),
    ("compressibility", Reach::Alone(film::compressibility)),
    ("contact", Reach::Alone(film::contact)),
    ("coupling", Reach::Alone(shaft::coupling)),
    ("cylinder_pressure", Reach::Alone(engine::cylinder_pressure)),
    ("drag", Reach::Alone(ring::drag)),
    ("drive", Reach::Alone(shaft::drive)),
    ("evaporation", Reach::Alone(film::evaporation)),
    ("fatigue", Reach::Alone(pin::fatigue)),
    ("film_1d", Reach::Alone(film::film_1d)),
    ("film_2d", Reach::Alone(film::film_2d)),
    ("film_force", Reach::Alone(ring::film_force)),
    ("film_temperature", Reach::Alone(film::film_temperature)),
    ("flank", Reach::Alone(ring::flank)),
    ("flank_friction", Reach::Alone(ring::flank_friction)),
    ("gas_flow", Reach::Alone(gas::gas_flow)),
    ("groove_friction", Reach::Alone(skirt::groove_friction)),
    ("hoop", Reach::Alone(ring::hoop)),
    ("hydrodynamics", Reach::Alone(film::hydrodynamics)),
    ("kinematics", Reach::Alone(engine::kinematics)),
    ("natural_frequencies", Reach::Alone(shaft::natural_frequencies)),
    ("oil", Reach::Alone(film::oil)),
    ("oil_transport", Reach::Alone(film::oil_transport)),
    ("piezoviscosity", Reach::Alone(film::piezoviscosity)),
    ("pin_friction", Reach::Alone(skirt::pin_friction)),
    ("pin_load", Reach::Alone(pin::pin_load)),
    ("pin_strength", Reach::Alone(pin::pin_strength)),
    ("piston_solver", Reach::Within("a solver asks the films of both sides of a piston")),
    ("profile_curve", Reach::Alone(skirt::profile_curve)),
    ("radial_gas", Reach::Alone(ring::radial_gas)),
    (
        "radial_motion",
        Reach::Within("the motion asks film and contact of a ring for the velocity at which they balance"),
    ),
    ("rig", Reach::Alone(rig::rig)),
    ("ring_motion", Reach::Alone(ring::ring_motion)),
    ("ring_pack_solver", Reach::Within("a solver asks gas, films and motions of a ring pack")),
    ("roughness", Reach::Alone(film::roughness)),
    (
        "secondary_motion",
        Reach::Within(
            "the motion asks the films of both sides of a piston for the velocities at which they balance",
        ),
    ),
    ("shear_thinning", Reach::Alone(film::shear_thinning)),
    ("skirt_compliance", Reach::Alone(skirt::skirt_compliance)),
    ("skirt_oil", Reach::Alone(skirt::skirt_oil)),
    ("skirt_profile", Reach::Alone(skirt::skirt_profile)),
    ("throw_inertia", Reach::Alone(shaft::throw_inertia)),
    ("torsion", Reach::Alone(shaft::torsion)),
    ("twin_land_friction", Reach::Alone(ring::twin_land_friction)),
];

/// How the models of the kind `kind` are reached; `None` for a kind that [`KINDS`] does not name.
#[must_use]
pub fn reach(kind: &str) -> Option<Reach> {
    KINDS.iter().find(|(name, _)| *name == kind).map(|(_, reach)| *reach)
}

/// Every registered model, by kind and name.
#[must_use]
pub fn models() -> Vec<&'static ModelInfo> {
    let registry = Registry::collect();
    registry.kinds().flat_map(|k| registry.models(k.kind).to_vec()).collect()
}

/// The model `m` of the kind `S`, built by `build` from its example and asked by `ask`.
fn alone<S, R, E>(
    m: &ModelInfo,
    build: impl Fn(&S) -> Result<R, E> + 'static,
    mut ask: impl FnMut(&mut R) -> Result<(), EvalError> + 'static,
) -> Result<Alone, String>
where
    S: ?Sized + Kind + 'static,
    R: 'static,
    E: Display + 'static,
{
    let spec = gudgeon_testkit::example_of::<S>(m)?;
    let mut running = build(&spec).map_err(|e| e.to_string())?;
    ask(&mut running).map_err(|e| e.to_string())?;
    Ok(Alone {
        build: Box::new(move || drop(black_box(build(black_box(&spec))))),
        // It answered once, and what is asked stays the same.
        ask: Box::new(move || drop(black_box(ask(black_box(&mut running))))),
    })
}

/// The kind's model named `name`, from its example: a part that others stand on.
fn part<S: ?Sized + Kind + 'static>(name: &str) -> Result<Box<S>, String> {
    let registry = Registry::collect();
    let m = registry.model(S::NAME, name).ok_or_else(|| format!("there is no {}/{name}", S::NAME))?;
    gudgeon_testkit::example_of(m)
}

/// A value that is used, whatever the optimiser thinks.
fn seen<T>(value: T) -> Result<(), EvalError> {
    black_box(value);
    Ok(())
}
