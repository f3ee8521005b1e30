use std::fmt::Debug;

use dyn_clone::DynClone;

use super::{Evaporation, FilmTemperature};
use crate::geometry::FaceProfile;
use crate::result::Note;
use crate::states::Stateful;
use crate::{BuildError, register_kind};

/// A running face and the room before its edges.
#[derive(Debug, Clone)]
pub struct OilFacePlace {
    /// Ring, from 0.
    pub ring: usize,
    /// Land of a twin-land ring, upper first.
    pub land: usize,
    /// Shape.
    pub profile: FaceProfile,
    /// Bottom edge above the pin \[m\].
    pub offset: f64,
    /// Radial clearance of the lands below and above \[m\]; `None` where oil drains at once.
    pub clearance: [Option<f64>; 2],
}

/// The land above a ring, and the ways past that ring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OilLand {
    /// Axial height \[m\].
    pub height: f64,
    /// Share of the circumference that the end gap of the ring leaves open.
    pub gap: f64,
    /// Whether oil that comes down the land drains through the groove of the ring.
    pub drained: bool,
}

/// Oil that evaporates from the liner above ring 1.
#[derive(Debug, Clone, Copy)]
pub struct Volatile<'a> {
    /// How.
    pub model: &'a (dyn Evaporation + 'static),
    /// What tells the temperature of the liner.
    pub temperature: &'a dyn FilmTemperature,
    /// Height of ring 1 at top dead centre over the crank axis \[m\], from which that counts its way down.
    pub top: f64,
}

/// What an [`OilTransportSpec`] is built for.
#[derive(Debug, Clone, Copy)]
pub struct OilTransportCtx<'a> {
    /// The faces, from the top down.
    pub faces: &'a [OilFacePlace],
    /// The lands, from the crown down, one a ring.
    pub lands: &'a [OilLand],
    /// Lowest and highest place of the pin \[m\].
    pub pin: (f64, f64),
    /// Crank speed \[rad/s\].
    pub omega: f64,
    /// Oil that evaporates, if any does.
    pub volatile: Option<Volatile<'a>>,
}

/// Configuration of a model of the oil on the liner and under the rings.
#[register_kind(
    name = "oil_transport",
    summary = "oil left on the liner, carried from ring to ring and from stroke to stroke"
)]
pub trait OilTransportSpec: Debug + DynClone + Send + Sync {
    /// Whether oil is followed; otherwise every face is fully flooded, and [`OilTransportSpec::build`] gives `None`.
    fn follows_oil(&self) -> bool {
        true
    }

    /// Builds the running model; `None` when no oil is followed.
    ///
    /// # Errors
    /// Constants outside their range.
    fn build(&self, ctx: &OilTransportCtx<'_>) -> Result<Option<Box<dyn OilTransport>>, BuildError>;
}

/// How far the film of a face reaches.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OilExtent {
    /// Lower end of the film, in coordinates of the face \[m\].
    pub from: f64,
    /// Upper end of the film \[m\].
    pub to: f64,
    /// Drops of the face at its bottom edge, at the lower and at the upper end of the film, at its top edge \[m\].
    pub drops: [f64; 4],
}

/// One face at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OilFaceIn {
    /// Film thickness \[m\].
    pub h: f64,
    /// Its rate \[m/s\].
    pub hdot: f64,
    /// Velocity of the liner seen from the ring, towards the top edge positive \[m/s\].
    pub u: f64,
    /// Flux of the film at its lower end \[m²/s\].
    pub flux: f64,
}

/// A step of the integration that was accepted.
#[derive(Debug, Clone, Copy)]
pub struct OilStep<'a> {
    /// States of the model at its start.
    pub y0: &'a [f64],
    /// States at its end.
    pub y1: &'a [f64],
    /// Place of the pin at its end \[m\].
    pub pin: f64,
    /// Film thicknesses of the rings at its end \[m\].
    pub films: &'a [f64],
    /// What moves the oil on the lands, as of its end.
    pub drive: OilDrive<'a>,
}

/// What moves the oil on the lands.
#[derive(Debug, Clone, Copy)]
pub struct OilDrive<'a> {
    /// Length of the step \[s\].
    pub dt: f64,
    /// Acceleration of the piston, towards the head positive \[m/s²\].
    pub acceleration: f64,
    /// Viscosity at each ring \[Pa s\].
    pub viscosity: &'a [f64],
    /// Pressures of the lands and of the crankcase \[Pa\].
    pub pressures: &'a [f64],
}

/// What left and what came, per circumference \[m²\].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct OilLedger {
    /// From the crankcase onto the liner, net of what was there.
    pub supplied: f64,
    /// Into the crankcase.
    pub drained: f64,
    /// As a liquid into the combustion chamber.
    pub thrown: f64,
    /// As vapour into the combustion chamber.
    pub evaporated: f64,
    /// Taken up by all faces.
    pub taken: f64,
}

impl OilLedger {
    /// What came less what went: what is stored more than before.
    #[must_use]
    pub fn gained(&self) -> f64 {
        self.supplied - self.drained - self.thrown - self.evaporated
    }
}

/// What a ring scraped and what passed its end gap, per circumference \[m²\].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct OilPassed {
    /// Upwards through the end gap.
    pub up: f64,
    /// Downwards through the end gap.
    pub down: f64,
    /// Scraped off the liner for want of room before the faces.
    pub scraped: f64,
}

/// A ring's oil at an instant.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct RingOil {
    /// Share of its faces under full film.
    pub wetted: f64,
    /// Oil held, per circumference \[m²\].
    pub held: f64,
    /// Film left on the liner \[m\].
    pub left: f64,
}

/// A running oil-transport model. Its states are its own; beside them it may carry a field on the liner from step to step, which is part of
/// the periodic state. Rates are by crank angle \[1/rad\].
pub trait OilTransport: Stateful + Debug + Send {
    /// Ring and land of every face.
    fn faces(&self) -> &[(usize, usize)];

    /// The ring under which state `k` lies.
    fn ring_of(&self, k: usize) -> usize;

    /// Takes the states `y` of an instant with the pin at `pin` \[m\].
    fn place(&mut self, y: &[f64], pin: f64);

    /// How far the film of face `k` reaches under a film of `h` \[m\].
    fn extent(&mut self, k: usize, h: f64) -> OilExtent;

    /// Rates \[1/rad\] of the states that belong to face `k`, into their places in `dy`, which is as long as all states.
    fn rates(&mut self, k: usize, face: &OilFaceIn, dy: &mut [f64]);

    /// Faces that hold a little under films of `films` \[m\], for the first cycle.
    fn first(&mut self, films: &[f64], y: &mut [f64]);

    /// Number of values of the field that is carried from step to step, in units of their own.
    fn carried(&self) -> usize;

    /// Value of the field that counts as one in the distance between the ends of a cycle.
    fn carried_scale(&self) -> f64;

    /// The field as it is.
    fn field(&self, out: &mut [f64]);

    /// Begins a cycle with the states `y` and a field, the pin at `pin` \[m\].
    fn begin_cycle(&mut self, y: &[f64], field: &[f64], pin: f64);

    /// Ends a cycle: what was booked beside the states becomes part of them; the field is handed out.
    fn end_cycle(&mut self, y: &mut [f64], field: &mut [f64]);

    /// Books an accepted step.
    fn book(&mut self, step: &OilStep<'_>);

    /// Longest way of a piston \[m\] over which a step may go whose method asks for rates alone: over a longer one a face takes up what the one before it leaves in the
    /// same step, which stages can tell that are solved in the order in which the faces pass.
    fn longest_way(&self) -> f64;

    /// What ring `i` does with the oil while the piston moves at `v` \[m/s\].
    fn ring(&self, i: usize, v: f64) -> RingOil;

    /// All oil per circumference \[m²\] for the states `y`.
    fn total(&self, y: &[f64]) -> f64;

    /// What came and went since the cycle began, or since the ledger was cleared.
    fn ledger(&self) -> OilLedger;

    /// Brings to its periodic state what acts on nothing else, after a cycle that repeats; the ledger and the total are then those of that cycle.
    fn settle(&mut self);

    /// What ring `i` scraped and let pass since then.
    fn passed(&self, i: usize) -> OilPassed;

    /// Oil on the land above ring `i`, per circumference \[m²\].
    fn on_land(&self, i: usize) -> f64;

    /// Height \[m\] of the liner within reach of ring 1 that evaporation has left without oil at some time since the cycle began.
    fn dried(&self) -> f64;

    /// Density of the oil \[kg/m³\].
    fn density(&self) -> f64;

    /// What a person should know about how this came about.
    fn notes(&self) -> Vec<Note>;

    /// Begins the ledger anew.
    fn clear_ledger(&mut self);

    /// Heights \[m\] of the middles of the cells of the liner over the crank axis, and the film there \[m\].
    fn liner(&self) -> (Vec<f64>, Vec<f64>);
}
