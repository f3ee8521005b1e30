use std::fmt::Debug;

use dyn_clone::DynClone;

use super::Contact;
use crate::{BuildError, EvalError, register_kind};

/// Configuration of a model of the friction of solid contact.
#[register_kind(
    name = "boundary_friction",
    summary = "friction of solid contact against sliding speed, load and real area"
)]
pub trait BoundaryFrictionSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model.
    ///
    /// # Errors
    /// Constants outside their range.
    fn build(&self) -> Result<Box<dyn BoundaryFriction>, BuildError>;
}

/// Surfaces that rub on each other: one value for each place, or for each body with the means of its contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rubbing<'a> {
    /// Sliding speeds of either sign \[m/s\].
    pub speed: &'a [f64],
    /// Nominal contact pressures \[Pa\], zero or more.
    pub pressure: &'a [f64],
    /// Real over nominal areas of contact, zero or more; zero where no model knows them.
    pub real_area: &'a [f64],
}

/// A running friction model of solid contact.
pub trait BoundaryFriction: Debug + Send + Sync {
    /// Whether there is no friction at any speed.
    fn is_off(&self) -> bool {
        false
    }

    /// Whether [`Rubbing::real_area`] matters: a contact model that does not know its real area cannot be used then.
    fn uses_real_area(&self) -> bool {
        false
    }

    /// `coefficient[i]`, odd in the sliding speed \[m/s\] and of its sign, so that the force on the slower surface is it times the
    /// contact load; and `slope[i]`, its derivative with respect to the speed \[s/m\]. Where nothing is pressed together any finite value is right.
    ///
    /// # Errors
    /// A speed, pressure or area that is not finite (Recoverable), slices of different length (Fatal).
    fn coefficient(
        &self,
        at: &Rubbing<'_>,
        coefficient: &mut [f64],
        slope: &mut [f64],
    ) -> Result<(), EvalError>;

    /// The coefficient alone of one body: sliding speed \[m/s\], nominal contact pressure \[Pa\], real over nominal area.
    ///
    /// # Errors
    /// As [`BoundaryFriction::coefficient`].
    fn of_body(&self, speed: f64, pressure: f64, real_area: f64) -> Result<f64, EvalError> {
        let (mut coefficient, mut slope) = ([0.0], [0.0]);
        let at = Rubbing { speed: &[speed], pressure: &[pressure], real_area: &[real_area] };
        self.coefficient(&at, &mut coefficient, &mut slope)?;
        Ok(coefficient[0])
    }
}

/// Whether a contact model, which a case names so, knows what a friction model asks of it.
///
/// # Errors
/// The friction needs the real area of contact, and the contact model does not know it.
pub fn real_area_is_known(
    friction: &dyn BoundaryFriction,
    contact: &dyn Contact,
    name: &str,
) -> Result<(), BuildError> {
    if !friction.uses_real_area() || contact.real_area(&[0.0], &mut [0.0]) {
        return Ok(());
    }
    let what = format!(
        "this friction needs the real area of contact, which the contact model `{name}` does not know"
    );
    Err(BuildError::new(what)
        .help("use a contact model of rough surfaces such as `greenwood_tripp`, or the friction `coulomb`"))
}
