use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, register_kind};

/// Configuration of what supplies the films of a skirt with oil.
#[register_kind(
    name = "skirt_oil",
    summary = "where the oil of the skirt comes from, and whether its films keep what they hold"
)]
pub trait SkirtOilSpec: Debug + DynClone + Send + Sync {
    /// Whether the films keep their oil from instant to instant; otherwise every edge is flooded, and [`SkirtOilSpec::build`] gives `None`.
    fn keeps_oil(&self) -> bool {
        true
    }

    /// Takes the film \[m\] that the rings leave on the liner above the skirt when the piston moves up. Whether it counts: a specification that says that film
    /// itself does not take it.
    fn take_from_rings(&mut self, _film: f64) -> bool {
        false
    }

    /// Builds the running model; `None` when no oil is followed.
    ///
    /// # Errors
    /// Constants outside their range.
    fn build(&self) -> Result<Option<Box<dyn SkirtOil>>, BuildError>;
}

/// A running supply of a skirt whose films keep their oil.
pub trait SkirtOil: Debug + Send + Sync {
    /// Films \[m\] on the liner that the upper and the lower edge of the skirt meet at crank angle `theta` \[rad\]; the edge that the liner leaves meets none.
    fn arriving(&self, theta: f64) -> [f64; 2];

    /// Cross-section \[m²\] of the room between the oil ring and the skirt. What leaves over the upper edge waits there, as far as it finds room, and comes back
    /// over the same edge when the piston moves up; the rest drains.
    fn room_above(&self) -> f64 {
        0.0
    }

    /// Film \[m\] in the gap of the first cycle, where there is room for it.
    fn initial(&self) -> f64;

    /// Crank angle \[rad\] of a step in which oil is moved and booked, at most.
    fn step(&self) -> f64;
}
