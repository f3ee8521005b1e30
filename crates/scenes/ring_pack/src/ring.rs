//! One ring with its models.

use gudgeon_core::kinds::{Flank, FlankFriction, Hydrodynamics, RadialMotion, RingMotion};

use super::contact_line::ContactLine;
use super::rubbing::FaceFriction;

/// One ring with its models.
pub struct Ring {
    /// One film per running land, upper land first. Empty when no film is needed.
    pub films: Vec<Box<dyn Hydrodynamics>>,
    /// Film thickness below which their flow factors are held at those of a thicker film \[m\].
    pub factors_end: Option<f64>,
    /// Whether the films resist being squeezed; without them the ring rides on its contact alone.
    pub resists: bool,
    /// Solid contact of the whole face as a function of film thickness.
    pub contact: ContactLine,
    /// Friction of that contact, where the case has a model for it; the coefficient of the contact model otherwise.
    pub rubbing: Option<FaceFriction>,
    /// Oil on the flanks of the groove.
    pub flank: Box<dyn Flank>,
    /// Motion in the groove, under the force of that oil.
    pub motion: Box<dyn RingMotion>,
    /// Whether the balance of that motion counts the force of the film, and the weight.
    pub counts: (bool, bool),
    /// The name of that model, for messages.
    pub motion_name: &'static str,
    /// Motion towards the liner; asked only while films are solved.
    pub radial: Box<dyn RadialMotion>,
    /// Radial friction, unless it is off.
    pub friction: Option<Box<dyn FlankFriction>>,
    /// Radial force of the tension of one rail \[N\].
    pub pull: f64,
    /// Axial force of an expander on a rail \[N\], towards the head positive.
    pub expander: f64,
    /// Distance below ring 1 \[m\].
    pub spacing: f64,
    /// Viscosity when it does not change over the cycle \[Pa s\].
    pub mu: Option<f64>,
    /// Film thickness used when there is no film \[m\].
    pub nominal_film: f64,
}

impl Ring {
    /// Whether anything could carry the ring against the liner: a film, or contact.
    #[must_use]
    pub fn carries(&self) -> bool {
        self.resists || self.contact.carries()
    }

    /// Whether the place of the ring in its groove is integrated.
    #[must_use]
    pub fn is_integrated(&self) -> bool {
        !self.motion.states().is_empty()
    }

    /// Whether the place of the ring in its groove is decided in steps.
    #[must_use]
    pub fn is_decided(&self) -> bool {
        self.motion.decision_interval().is_some()
    }
}
