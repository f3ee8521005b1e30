use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, register_kind};

/// Configuration of a contact model.
#[register_kind(name = "contact", summary = "solid contact of asperities and boundary friction")]
pub trait ContactSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model.
    ///
    /// # Errors
    /// Constants outside their range.
    fn build(&self) -> Result<Box<dyn Contact>, BuildError>;
}

/// A running contact model.
pub trait Contact: Debug + Send + Sync {
    /// Nominal contact pressure \[Pa\] for each separation \[m\] of the mean planes. Never negative, falls with separation. What is called separation
    /// here and below is how far apart the nominal shapes of the surfaces are; a model may take that for their mean gap, and says so by
    /// [`Contact::mean_planes`].
    fn pressure(&self, separation: &[f64], pressure: &mut [f64]);
    /// Separation \[m\] above which the pressure is zero or below 1e-12 of its value at zero separation. Zero when the model
    /// carries no load.
    fn range(&self) -> f64;
    /// Mean gap \[m\] that is left between the rough surfaces at a separation \[m\] of their mean planes: the thickness of a film there.
    /// Never negative, rises with the separation and is equal to it from [`Contact::range`] on. Where it is above zero at zero
    /// separation the surfaces may approach further, and the pressure goes on. The separation itself for smooth surfaces.
    fn mean_gap(&self, separation: f64) -> f64 {
        separation
    }
    /// Distance \[m\] of the mean planes at a separation, negative where they overlap. Rises with the separation.
    fn mean_planes(&self, separation: f64) -> f64 {
        separation
    }
    /// Film thickness \[m\] that a film cannot go below, when this model is a switch and not a pressure: the surfaces then
    /// carry the remaining load.
    fn floor(&self) -> Option<f64>;
    /// Coefficient of friction of the load that the solid contact carries.
    fn friction_coefficient(&self) -> f64;
    /// Real over nominal area of contact for each separation \[m\], where the model knows it: otherwise `false`, and `ratio` stays.
    fn real_area(&self, _separation: &[f64], _ratio: &mut [f64]) -> bool {
        false
    }
    /// Whether, on the floor, the whole radial load rubs with the boundary coefficient and the film contributes no shear.
    fn floor_replaces_film(&self) -> bool {
        false
    }
}
