//! Inter-ring gas flow.
//!
//! All models share one kernel, the [`Network`] of gas volumes joined by [`Passage`]s, and one law for sharp openings, the
//! [`OrificeLaw`]. They differ in what they take for the passages around a ring:
//!
//! | model | end gap | past the flanks | past the face |
//! |---|---|---|---|
//! | [`OrificeNetwork`] | orifice, from the geometry of the instant | orifice | orifice |
//! | [`GapOrifice`] | orifice, always open | orifice, closed when seated | closed |
//! | [`NarrowChannel`] | orifice | laminar channel | laminar channel |
//! | [`Prescribed`] | closed: land pressures are given | | |
//!
//! The gas in each volume is at the temperature of its walls, so its state is its mass alone.

mod gap_orifice;
mod heat_capacity;
mod narrow_channel;
mod network;
mod orifice;
mod orifice_network;
mod pack;
mod prescribed;

pub use gap_orifice::{BackVolumes, GapOrifice};
pub use heat_capacity::Gamma;
pub use narrow_channel::{ChannelFriction, GasViscosity, NarrowChannel};
pub use network::{Network, Passage, TRANSITION, channel_conductance, sutherland_viscosity};
pub use orifice::{FlowFunction, FlowSlopes, Orifice, OrificeFormula, OrificeLaw, Side, critical_ratio};
pub use orifice_network::OrificeNetwork;
pub use pack::{Elimination, FilmHeight};
pub use prescribed::Prescribed;
