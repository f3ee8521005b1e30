//! The running sub-models of a piston in its bore, and what acts on it.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{CylinderPressure, Kinematics, SecondaryMotion, SkirtProfile};
use gudgeon_skirt::{Instant, Piston};

use super::layout::Layout;
use super::oil::OilKept;

/// The piston with what drives it.
pub struct Assembly {
    /// Piston with both sides of its skirt.
    pub piston: Piston,
    /// Motion along the bore.
    pub kinematics: Box<dyn Kinematics>,
    /// Shape of the skirt.
    pub profile: Box<dyn SkirtProfile>,
    /// Gas.
    pub cylinder: Box<dyn CylinderPressure>,
    /// Motion across the bore.
    pub motion: Box<dyn SecondaryMotion>,
    /// Name of its model, for people.
    pub motion_name: &'static str,
    /// Where the states stand.
    pub layout: Layout,
    /// Area under the gas \[m²\].
    pub area: f64,
    /// Viscosity \[Pa s\].
    pub mu: f64,
    /// Crankcase pressure \[Pa\].
    pub p_crankcase: f64,
    /// Running radial clearance \[m\].
    pub clearance: f64,
    /// Length of the cycle \[rad\].
    pub period: f64,
    /// Crank angles where a right-hand side jumps or has a kink \[rad\].
    pub breakpoints: Vec<f64>,
    /// Whether the skirt yields.
    pub elastic: bool,
    /// Oil that the skirt keeps, when it keeps any.
    pub oil: Option<OilKept>,
    /// Film evaluations after which a search is given up.
    pub max_films: u64,
}

impl Assembly {
    /// What acts on the piston at crank angle `theta` \[rad\].
    #[must_use]
    pub fn instant(&self, theta: f64) -> Instant {
        let p = self.cylinder.pressure(theta) - self.p_crankcase;
        let motion = self.kinematics.motion(theta);
        self.piston.crank.instant(theta, &motion, p, self.area, self.mu)
    }

    /// Whether the films may be asked once more.
    ///
    /// # Errors
    /// They were asked too often.
    pub fn go_on(&self) -> Result<(), EvalError> {
        if self.piston.film_evaluations() <= self.max_films {
            return Ok(());
        }
        let what = format!(
            "given up after {} film evaluations: raise `solver.max_film_evaluations` to go on",
            self.max_films
        );
        Err(EvalError::fatal("piston_secondary", what))
    }

    /// Crank speed \[rad/s\].
    #[must_use]
    pub fn omega(&self) -> f64 {
        self.kinematics.omega()
    }

    /// Coordinates of the piston \[m\] for the states `y`, into `x`.
    pub fn coordinates(&self, y: &[f64], x: &mut [f64]) {
        let pose = self.motion.pose(&y[self.layout.motion.clone()]);
        x[..2].copy_from_slice(&pose.e);
        for (x, y) in x[2..].iter_mut().zip(&y[self.layout.shapes.clone()]) {
            *x = self.clearance * y;
        }
    }

    /// States with which the first cycle starts.
    pub fn initial(&mut self, y: &mut [f64]) {
        let (motion, shapes) = y.split_at_mut(self.layout.shapes.start);
        self.motion.initial(motion);
        let mut rest = shapes;
        for side in &mut self.piston.sides {
            let (own, others) = rest.split_at_mut(side.elastic());
            side.compliance.initial(own);
            rest = others;
        }
    }
}
