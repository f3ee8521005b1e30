use std::fmt::Debug;
use std::sync::{Arc, OnceLock};

use dyn_clone::DynClone;
use gudgeon_numerics::elementary;
use gudgeon_numerics::linalg::Complex;
use indexmap::IndexMap;

use super::{Coupling, CylinderPressure, Drive, Kinematics, OrderResponses, ThrowInertia};
use crate::result::Note;
use crate::{BuildError, EvalError, register_kind};

/// One inertia of a shaft line.
#[derive(Debug, Clone, PartialEq)]
pub struct LineNode {
    /// Name.
    pub name: String,
    /// Constant inertia \[kg m²\]; zero is admitted. Throws add theirs.
    pub inertia: f64,
    /// Damping against the ground \[N m s/rad\].
    pub damping: f64,
    /// Stiffness against the ground \[N m/rad\]; zero for a shaft that turns.
    pub ground: f64,
    /// Speed by the speed of the reference shaft.
    pub ratio: f64,
}

/// A link between two inertias that turn at the same speed.
#[derive(Debug, Clone)]
pub struct LineLink {
    /// Name.
    pub name: String,
    /// The inertias it joins; torque is positive when the first drives the second.
    pub nodes: [usize; 2],
    /// Law of torque. For inertias of different speed (a gear mesh) the twist is that of the first less that of the second by their
    /// ratio of speeds, and the torque that on the first.
    pub coupling: Box<dyn Coupling>,
}

/// How the torque of a throw is made from its gas force.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize, schemars::JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub enum Obliquity {
    /// `r (sin θ + cos θ tan φ)`, the rate of the piston's way.
    #[default]
    Exact,
    /// `r (sin θ - cos θ tan φ)`: the sign of the rod's obliquity as a published program has it. For reproduction only.
    Reversed,
}

/// One gas space that acts on a throw.
#[derive(Debug, Clone)]
pub struct GasEnd {
    /// Motion of the piston towards this end.
    pub kinematics: Box<dyn Kinematics>,
    /// Gas pressure over the angle of the throw.
    pub pressure: Box<dyn CylinderPressure>,
    /// Area the gas acts on \[m²\].
    pub area: f64,
    /// Pressure \[Pa\] on the other side of that area.
    pub back_pressure: f64,
    /// Share of the gas torque that reaches the crank (mechanical efficiency of a driving piston).
    pub factor: f64,
    /// Crank radius \[m\], for the published obliquity.
    pub crank_radius: f64,
    /// Which lever.
    pub obliquity: Obliquity,
}

impl GasEnd {
    /// Torque \[N m\] on the throw at its angle `theta`, in the direction of rotation; a model that goes by fixed angles decides
    /// at `decided_at`.
    #[must_use]
    pub fn torque(&self, decided_at: f64, theta: f64) -> f64 {
        let (height, velocity) = self.kinematics.height_and_velocity(theta);
        self.torque_at(velocity, self.pressure.pressure_at_height(decided_at, theta, height), theta)
    }

    /// Torque \[N m\] of a pressure \[Pa\] on the throw at its angle `theta`.
    #[must_use]
    pub fn torque_of(&self, pressure: f64, theta: f64) -> f64 {
        self.torque_at(self.kinematics.velocity(theta), pressure, theta)
    }

    /// The same where the velocity of the piston is known.
    fn torque_at(&self, velocity: f64, pressure: f64, theta: f64) -> f64 {
        let mut way = velocity / self.kinematics.omega();
        if self.obliquity == Obliquity::Reversed {
            // The crank end sees the motion turned about, and its lever with it.
            let m = self.kinematics.motion(theta);
            let sign = if m.y < 0.0 { -1.0 } else { 1.0 };
            way += sign * 2.0 * self.crank_radius * elementary::cos(theta) * elementary::tan(m.rod_angle);
        }
        -self.factor * way * (pressure - self.back_pressure) * self.area
    }
}

/// Harmonics of the torques of a throw, kept by their number.
#[derive(Debug, Default)]
struct Harmonics {
    gas: OnceLock<Vec<Complex>>,
    masses: OnceLock<Vec<Complex>>,
}

/// A crank throw on an inertia: as it is made, so it stays.
#[derive(Debug, Clone)]
pub struct LineThrow {
    /// The inertia it belongs to.
    pub node: usize,
    /// Angle of the throw when its inertia is at zero \[rad\].
    pub phase: f64,
    /// Inertia over the angle.
    pub inertia: Box<dyn ThrowInertia>,
    /// Gas spaces.
    pub ends: Vec<GasEnd>,
    /// Shared by throws that are alike.
    harmonics: Arc<Harmonics>,
}

impl LineThrow {
    /// A throw of its own.
    #[must_use]
    pub fn new(node: usize, phase: f64, inertia: Box<dyn ThrowInertia>, ends: Vec<GasEnd>) -> Self {
        Self { node, phase, inertia, ends, harmonics: Arc::default() }
    }

    /// The same throw on another inertia, at another phase: what depends on neither is worked out once for both.
    #[must_use]
    pub fn alike(&self, node: usize, phase: f64) -> Self {
        Self { node, phase, ..self.clone() }
    }

    /// Whether it differs from another in nothing but inertia and phase, as far as it is known.
    #[must_use]
    pub fn is_like(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.harmonics, &other.harmonics)
    }

    /// Mean and harmonics up to `count` of the gas torque over the angle of the throw, which `make` works out where they are not known.
    #[must_use]
    pub fn gas_harmonics(&self, count: usize, make: impl FnOnce() -> Vec<Complex>) -> Vec<Complex> {
        kept(&self.harmonics.gas, count, make)
    }

    /// The same of the torque of the moving masses at unit speed.
    #[must_use]
    pub fn mass_harmonics(&self, count: usize, make: impl FnOnce() -> Vec<Complex>) -> Vec<Complex> {
        kept(&self.harmonics.masses, count, make)
    }

    /// Gas torque \[N m\] at angle `theta` of its inertia.
    #[must_use]
    pub fn gas_torque(&self, decided_at: f64, theta: f64) -> f64 {
        self.ends.iter().map(|e| e.torque(decided_at + self.phase, theta + self.phase)).sum()
    }
}

/// As many harmonics of those that are kept, or what is made where these are fewer; the first that are made are kept.
fn kept(known: &OnceLock<Vec<Complex>>, count: usize, make: impl FnOnce() -> Vec<Complex>) -> Vec<Complex> {
    match known.get() {
        Some(own) if own.len() > count => own[..=count].to_vec(),
        Some(_) => make(),
        None => known.get_or_init(make).clone(),
    }
}

/// A torque on an inertia.
#[derive(Debug, Clone)]
pub struct LineDrive {
    /// The inertia.
    pub node: usize,
    /// Angle added to that of the inertia \[rad\].
    pub phase: f64,
    /// Sign and share: 1 for a drive, -1 for a load.
    pub factor: f64,
    /// The torque.
    pub drive: Box<dyn Drive>,
}

/// A shaft line: inertias, links between them, throws and torques.
#[derive(Debug, Clone, Default)]
pub struct Line {
    /// Inertias.
    pub nodes: Vec<LineNode>,
    /// Links.
    pub links: Vec<LineLink>,
    /// Throws.
    pub throws: Vec<LineThrow>,
    /// Drives and loads.
    pub drives: Vec<LineDrive>,
}

impl Line {
    /// Inertia of a node with the mean of its throws \[kg m²\].
    #[must_use]
    pub fn mean_inertia(&self, node: usize) -> f64 {
        let throws = self.throws.iter().filter(|t| t.node == node).map(|t| t.inertia.mean());
        self.nodes[node].inertia + throws.sum::<f64>()
    }
}

/// What a response is wanted for.
#[derive(Debug, Clone)]
pub struct TorsionCtx<'a> {
    /// The shaft line.
    pub line: &'a Line,
    /// Mean speed of the reference shaft \[rad/s\].
    pub speed: f64,
    /// Highest order of the reference shaft that is looked at.
    pub orders: f64,
    /// Period of the torques over the angle of the reference shaft \[rad\].
    pub period: f64,
    /// Shares of the inertias in the torque that keeps the mean speed, counted at the reference shaft; their sum is 1, missing ones are
    /// zero. Mean angles count from the mean of the inertias with these shares.
    pub balance: &'a [f64],
    /// Angles of the inertias at the start of a transient \[rad\].
    pub angles: &'a [f64],
    /// Speeds of the inertias at the start of a transient \[rad/s\].
    pub speeds: &'a [f64],
    /// Instants at which a transient is wanted \[s\], ascending.
    pub times: &'a [f64],
}

/// Configuration of how the response of a shaft line is computed.
#[register_kind(name = "torsion", summary = "response of a shaft line to its torques, steady or in time")]
pub trait TorsionSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model.
    ///
    /// # Errors
    /// A shaft line that the model does not cover, each with the reason.
    fn build(&self, ctx: &TorsionCtx<'_>) -> Result<Box<dyn Torsion>, BuildError>;
    /// What kind of answer it gives.
    fn answers(&self) -> TorsionAnswer;
    /// The model that has what this one leaves out of a line; `None` when it leaves nothing out.
    fn fuller(&self, _: &Line) -> Option<Box<dyn TorsionSpec>> {
        None
    }
    /// Models of this kind that solve the same equations by another method: the first one gives `bench` its reference.
    fn same_equations(&self) -> &'static [&'static str] {
        &[]
    }
    /// Whether its answers are solutions of linear equations, good to rounding: differences of them are then derivatives.
    fn is_linear(&self) -> bool {
        false
    }
    /// Whether steps of fixed length `h` make a motion `e^{zt}` grow that the line damps; `zh` is given by its real and imaginary
    /// part. `None` for models without fixed steps.
    fn grows(&self, _: [f64; 2]) -> Option<bool> {
        None
    }
}

/// Kinds of answer of a [`TorsionSpec`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TorsionAnswer {
    /// None: the shaft turns at constant speed and stays untwisted.
    Nothing,
    /// The periodic motion at the mean speed.
    Periodic,
    /// The motion over time.
    Time,
}

/// What a torsion model found.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TorsionOut {
    /// Periodic motion by order, ascending.
    pub orders: OrderResponses,
    /// Mean torques in the links \[N m\].
    pub mean_torque: Vec<f64>,
    /// Mean angles of the inertias against what balances, \[rad\].
    pub mean_angle: Vec<f64>,
    /// Mean torque \[N m\] that holds the speed, at the reference shaft.
    pub balance_torque: f64,
    /// Mean speed \[rad/s\] of the periodic motion.
    pub speed: f64,
    /// Instants of a transient \[s\].
    pub times: Vec<f64>,
    /// Angles of the inertias at each instant \[rad\].
    pub angles: Vec<Vec<f64>>,
    /// Speeds of the inertias at each instant \[rad/s\].
    pub speeds: Vec<Vec<f64>>,
    /// Torques in the links at each instant \[N m\]; may be left empty where their laws give them, so not with rigid links.
    pub torque: Vec<Vec<f64>>,
    /// Torques of the throws at each instant as the method used them \[N m\].
    pub gas: Vec<Vec<f64>>,
    /// Torques of the drives at each instant as the method used them \[N m\].
    pub drive: Vec<Vec<f64>>,
    /// Work: time steps, right-hand sides, linear solutions.
    pub counters: IndexMap<String, u64>,
    /// What a person should read.
    pub notes: Vec<Note>,
}

/// A running torsion model.
pub trait Torsion: Debug + Send {
    /// Computes the response. What `out` held before is overwritten.
    ///
    /// # Errors
    /// An undamped resonance that is hit, a step that blows up, no convergence.
    fn run(&mut self, out: &mut TorsionOut) -> Result<(), EvalError>;
    /// Goes to another mean speed \[rad/s\], where the next [`Torsion::run`] answers as if it had been built there. A model that
    /// iterates starts from its last motion.
    ///
    /// # Errors
    /// A model whose answer is no periodic motion (Fatal).
    fn set_speed(&mut self, _: f64) -> Result<(), EvalError> {
        Err(EvalError::fatal("torsion", "this model gives no periodic motion at a constant mean speed"))
    }
}
