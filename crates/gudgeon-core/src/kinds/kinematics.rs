use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, register_kind};

/// What a [`KinematicsSpec`] is built for.
#[derive(Debug, Clone, Copy)]
pub struct KinematicsCtx {
    /// Crank radius \[m\].
    pub crank_radius: f64,
    /// Connecting-rod length between centres \[m\].
    pub rod_length: f64,
    /// Distance of the line of the pin's motion from the crank axis \[m\]: crank offset plus pin offset, positive on the
    /// side the crank throw moves to after top dead centre (thrust side opposite).
    pub offset: f64,
    /// Crank speed ω \[rad/s\], constant.
    pub omega: f64,
}

/// Position of the gudgeon pin along the cylinder axis.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PistonMotion {
    /// Height of the pin above the crank axis \[m\].
    pub y: f64,
    /// Velocity \[m/s\], towards the head positive.
    pub v: f64,
    /// Acceleration \[m/s²\].
    pub a: f64,
    /// Angle of the rod to the cylinder axis \[rad\].
    pub rod_angle: f64,
}

/// Configuration of a kinematics model.
#[register_kind(
    name = "kinematics",
    summary = "position, velocity and acceleration of the piston at a crank angle"
)]
pub trait KinematicsSpec: Debug + DynClone + Send + Sync {
    /// Checks the numbers and builds the running model.
    ///
    /// # Errors
    /// When the mechanism cannot turn (rod shorter than crank radius plus offset).
    fn build(&self, ctx: &KinematicsCtx) -> Result<Box<dyn Kinematics>, BuildError>;
}

/// A running kinematics model.
pub trait Kinematics: Debug + DynClone + Send + Sync {
    /// Motion at crank angle `theta` \[rad\] (any real number; period 2π).
    fn motion(&self, theta: f64) -> PistonMotion;
    /// Height of the pin above the crank axis \[m\] at crank angle `theta` \[rad\]: that of [`Self::motion`], which a model may know with less work.
    fn height(&self, theta: f64) -> f64 {
        self.motion(theta).y
    }
    /// Velocity \[m/s\], towards the head positive, at crank angle `theta` \[rad\]: that of [`Self::motion`] likewise.
    fn velocity(&self, theta: f64) -> f64 {
        self.motion(theta).v
    }
    /// Both at once.
    fn height_and_velocity(&self, theta: f64) -> (f64, f64) {
        let m = self.motion(theta);
        (m.y, m.v)
    }
    /// Highest position of the pin \[m\].
    fn y_tdc(&self) -> f64;
    /// Stroke \[m\].
    fn stroke(&self) -> f64;
    /// Crank speed \[rad/s\].
    fn omega(&self) -> f64;
}
dyn_clone::clone_trait_object!(Kinematics);
