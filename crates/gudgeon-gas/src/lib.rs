//! Gas flow between, behind and past piston rings.
//!
//! Gas spaces hold gas at the temperature of their walls, so the mass of each is its only state (with a balance of energy,
//! [`GasTemperature`], its energy is another); passages between them let gas
//! through by a law of pressures. The crate has one interface for each half of that, and everything built in is an instance of it.
//!
//! | to do | use |
//! |---|---|
//! | compute the flow through one opening | [`Orifice::build`], then [`OrificeLaw::flow`]; an example is at [`OrificeLaw`] |
//! | compute the flow through a narrow channel | a [`Passage`] with [`OrificeLaw::mass_flow`](PassageLaw::mass_flow), [`channel_conductance`] |
//! | fill and empty vessels | [`Network`]: volumes, boundaries, passages; rates and their Jacobian |
//! | write a new law of flow | implement [`PassageLaw`]: flow and partial derivatives of one passage |
//! | put it on a ring pack | [`PackNetwork`] with [`OrificeAreas`]; the example there is a whole model |
//! | choose other passages around a ring | implement [`PassageModel`] |
//! | run a built-in model | [`OrificeNetwork`], [`NarrowChannel`], [`NamazianHeywood`], [`GapOrifice`], [`Labyrinth`], [`Prescribed`] |
//!
//! The built-in models of the kind [`gas_flow`](gudgeon_core::kinds::GasFlowSpec) share the [`OrificeLaw`] with its [`Passage`]s, but
//! for [`Labyrinth`] with its [`ThrottlingLaw`], and differ in their passages around a ring:
//!
//! | model | end gap | past the flanks | past the face |
//! |---|---|---|---|
//! | [`OrificeNetwork`] | orifice, from the geometry of the instant | orifice | orifice |
//! | [`GapOrifice`] | orifice, always open | orifice, closed when seated | closed |
//! | [`NarrowChannel`] | orifice | laminar channel behind its mouth | the same |
//! | [`NamazianHeywood`] | orifice | laminar channel | closed; laminar channel behind its mouth when lifted |
//! | [`Labyrinth`] | throttling | throttling | throttling |
//! | [`Prescribed`] | closed: land pressures are given | | |
//!
//! Units are SI, pressures are absolute, flows are positive towards the crankcase.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]

mod channel;
mod directed;
mod flow_function;
mod gap_orifice;
mod gas_temperature;
mod gas_viscosity;
mod heat_capacity;
mod labyrinth;
mod namazian_heywood;
mod narrow_channel;
mod network;
mod options;
mod orifice;
mod orifice_law;
mod orifice_network;
mod pack_gas_flow;
mod pack_network;
mod passage;
mod passage_law;
mod plain_pack;
mod prescribed;
mod ring_channels;
mod ring_passages;
mod series;
mod spaces;
mod throttling_law;
mod validate;

pub use channel::{
    TRANSITION, burnt_gas_viscosity, channel_conductance, sutherland_viscosity, turbulent_share,
};
pub use flow_function::{FlowFunction, MIN_DROP, critical_ratio};
pub use gap_orifice::{BackVolumes, GapOrifice};
pub use gas_temperature::GasTemperature;
pub use gas_viscosity::GasViscosity;
pub use heat_capacity::Gamma;
pub use labyrinth::Labyrinth;
pub use namazian_heywood::NamazianHeywood;
pub use narrow_channel::{ChannelFriction, Mouth, NarrowChannel};
pub use network::Network;
pub use options::{Elimination, FilmHeight};
pub use orifice::{Orifice, OrificeFormula};
pub use orifice_law::{OrificeLaw, TRUNCATED_RATIO};
pub use orifice_network::{OrificeAreas, OrificeNetwork};
pub use pack_network::{PackNetwork, PackOptions};
pub use passage::Passage;
pub use passage_law::{Area, FlowPartials, GasState, Link, Node, PassageLaw};
pub use plain_pack::plain_pack;
pub use prescribed::Prescribed;
pub use ring_passages::{FlankGap, Openings, PassageModel, RingPassages};
pub use throttling_law::{THROTTLING_RATIO, ThrottlingLaw};

gudgeon_core::link!(GapOrifice, Labyrinth, NamazianHeywood, NarrowChannel, OrificeNetwork, Prescribed,);
