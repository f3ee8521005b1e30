use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, register_kind};

/// Configuration of a model of the oil on the liner and under the rings.
#[register_kind(
    name = "oil_transport",
    summary = "oil left on the liner, carried from ring to ring and from stroke to stroke"
)]
pub trait OilTransportSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model; `None` when every face is fully flooded and no oil is followed.
    ///
    /// # Errors
    /// Constants outside their range.
    fn build(&self) -> Result<Option<Box<dyn OilTransport>>, BuildError>;
}

/// A running oil-transport model. The scene keeps the volumes; the model says what follows from them.
pub trait OilTransport: Debug + Send + Sync {
    /// Thickness \[m\] of the film that the meniscus at a trailing edge leaves on the liner, for the gap \[m\] at the meniscus
    /// and the sliding speed \[m/s\].
    fn left_behind(&self, gap: f64, speed: f64) -> f64;
    /// Flux \[m²/s\] that the valleys of rough surfaces carry through a gap \[m\] beside what the smooth film does, at the sliding
    /// speed \[m/s\].
    fn through_valleys(&self, gap: f64, speed: f64) -> f64;
    /// Film \[m\] that the crankcase leaves on the liner below the ring pack.
    fn supply(&self) -> f64;
    /// Axial spacing of the film on the liner \[m\], at most.
    fn spacing(&self) -> f64;
    /// Highest wave of oil that stands before an edge \[m\]; what comes on top of it leaves.
    fn highest_wave(&self) -> f64;
    /// Film \[m\] with which the first cycle starts.
    fn initial(&self) -> f64;
}
