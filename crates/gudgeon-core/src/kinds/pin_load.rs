use std::fmt::Debug;

use dyn_clone::DynClone;

use super::{CylinderPressure, Kinematics, PinForces};
use crate::file::Files;
use crate::result::Note;
use crate::{BuildError, register_kind};

/// One cylinder over its cycle, as another case describes it.
#[derive(Debug, Clone)]
pub struct EngineCycle {
    /// Cylinder bore \[m\].
    pub bore: f64,
    /// Piston motion.
    pub kinematics: Box<dyn Kinematics>,
    /// Cylinder pressure.
    pub pressure: Box<dyn CylinderPressure>,
    /// Pressure below the piston \[Pa\].
    pub crankcase_pressure: f64,
}

/// What a [`PinLoadSpec`] is built for.
pub struct PinLoadCtx<'a> {
    /// Piston diameter \[m\].
    pub bore: f64,
    /// Ratio of circumference to diameter, as [`PinStrengthCtx::pi`](super::PinStrengthCtx::pi).
    pub pi: f64,
    /// The files that the case names.
    pub files: &'a Files,
    /// Reads the cycle of another case file, by the name that this case gives it.
    pub cycle_of: &'a dyn Fn(&str) -> Result<EngineCycle, BuildError>,
}

/// Forces at one crank angle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PinInstant {
    /// Crank angle \[rad\].
    pub theta: f64,
    /// Cylinder pressure \[Pa\].
    pub pressure: f64,
    /// Forces on the pin.
    pub forces: PinForces,
}

/// What a pin is sized for.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PinLoadCase {
    /// The instant with the greatest force on the pin, in magnitude.
    pub design: PinInstant,
    /// Crank speed \[rad/s\], when the model has one.
    pub omega: Option<f64>,
    /// Ratio of crank radius to rod length, when the model has one.
    pub crank_ratio: Option<f64>,
    /// The cycle at equal distances, end excluded; empty when the model knows one instant only.
    pub cycle: Vec<PinInstant>,
    /// What a person should know about how the load came about: a filter of the cylinder pressure that acted.
    pub notes: Vec<Note>,
}

/// Configuration of a model of the force on the gudgeon pin.
#[register_kind(name = "pin_load", summary = "force of gas and inertia on the gudgeon pin")]
pub trait PinLoadSpec: Debug + DynClone + Send + Sync {
    /// Kind and name of the models inside.
    fn models(&self) -> Vec<(&'static str, &'static str)> {
        Vec::new()
    }
    /// Checks the numbers and evaluates the load.
    ///
    /// # Errors
    /// An engine that cannot be, another case that cannot be read, a load without any force.
    fn build(&self, ctx: &PinLoadCtx<'_>) -> Result<PinLoadCase, BuildError>;
}
