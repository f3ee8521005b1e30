use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::geometry::{PackGeometry, RingPlace};
use crate::states::{Signals, StateInfo, Stateful};
use crate::{BuildError, EvalError, register_kind};

/// What a [`GasFlowSpec`] is built for.
#[derive(Debug, Clone, Copy)]
pub struct GasFlowCtx<'a> {
    /// The pack.
    pub pack: &'a PackGeometry,
}

/// Configuration of an inter-ring gas-flow model.
#[register_kind(name = "gas_flow", summary = "gas flow between the lands, past and behind the rings")]
pub trait GasFlowSpec: Debug + DynClone + Send + Sync {
    /// Checks the geometry it needs and builds the running model.
    ///
    /// # Errors
    /// A volume or gap that the geometry does not give.
    fn build(&self, ctx: &GasFlowCtx<'_>) -> Result<Box<dyn GasFlow>, BuildError>;
}

/// The boundary and the rings at an instant.
#[derive(Debug, Clone, Copy)]
pub struct GasIn<'a> {
    /// Cylinder pressure \[Pa\].
    pub p_cylinder: f64,
    /// Crankcase pressure \[Pa\].
    pub p_crankcase: f64,
    /// One place per ring.
    pub rings: &'a [RingPlace],
}

/// A space that gas passes from or to, counted from 0 at the crown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GasSpace {
    /// A land: the first is the combustion chamber, the last the crankcase, with all that is open to it.
    Land(usize),
    /// The space behind a ring.
    Behind(usize),
}

/// What a passage of the gas is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum GasWay {
    /// The end gap, or the part of it that leads directly from land to land.
    Gap,
    /// Likewise, as one opening with what passes between face and liner.
    GapAndFace,
    /// Between face and liner.
    Face,
    /// Over the ring: past the upper flank of its groove.
    UpperFlank,
    /// Under the ring: past the lower flank.
    LowerFlank,
    /// Past both flanks, one after the other: a groove that stores nothing.
    Groove,
    /// A drain to the crankcase.
    Drain,
}

/// A passage of the gas: flow from `from` to `to` is positive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct GasPassage {
    /// The ring that it is at, or below the land that it drains, counted from 0 at the crown.
    pub ring: usize,
    /// What it is.
    pub way: GasWay,
    /// Where it starts.
    pub from: GasSpace,
    /// Where it ends.
    pub to: GasSpace,
}

/// Pressures and flows of the pack with `n` rings.
#[derive(Debug, PartialEq, Default)]
pub struct GasOut {
    /// Pressures \[Pa\] of the `n + 1` lands, cylinder first, crankcase last.
    pub p_land: Vec<f64>,
    /// Pressures \[Pa\] behind the `n` rings.
    pub p_back: Vec<f64>,
    /// Flow \[kg/s\] leaving the land above each ring towards the ring (gap, face and upper flank), downwards positive.
    pub flow_in: Vec<f64>,
    /// Flow \[kg/s\] arriving in the land below each ring from the ring, downwards positive. Differs from `flow_in` by what
    /// the space behind the ring stores and drains. The last one is the blow-by: with it goes all that drains lead to the crankcase.
    pub flow_out: Vec<f64>,
    /// Flow \[kg/s\] through each of [`GasFlow::passages`]: as many as the caller gives room for, none in [`new`](Self::new).
    pub passages: Vec<f64>,
    /// Energy \[W\] that gas brings to all volumes over the boundaries, less the heat to their walls; 0 in a model without a balance of energy.
    pub power: f64,
}

impl Clone for GasOut {
    fn clone(&self) -> Self {
        let mut copy = Self::default();
        copy.clone_from(self);
        copy
    }
    /// Into the buffers that are there.
    fn clone_from(&mut self, other: &Self) {
        self.p_land.clone_from(&other.p_land);
        self.p_back.clone_from(&other.p_back);
        self.flow_in.clone_from(&other.flow_in);
        self.flow_out.clone_from(&other.flow_out);
        self.passages.clone_from(&other.passages);
        self.power = other.power;
    }
}

impl GasOut {
    /// Buffers for `rings` rings.
    #[must_use]
    pub fn new(rings: usize) -> Self {
        Self {
            p_land: vec![0.0; rings + 1],
            p_back: vec![0.0; rings],
            flow_in: vec![0.0; rings],
            flow_out: vec![0.0; rings],
            passages: Vec::new(),
            power: 0.0,
        }
    }
}

/// Partial derivatives of pressures and flows by the states of the gas, the places of the rings and the boundary pressures kept: one row per
/// quantity, row-major, one column per state. The units are those of states that are masses.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct GasPartials {
    /// Of the rates of the states \[1/s\].
    pub d_state: Vec<f64>,
    /// Of the `n + 1` land pressures \[Pa/kg\].
    pub p_land: Vec<f64>,
    /// Of the `n` pressures behind the rings \[Pa/kg\].
    pub p_back: Vec<f64>,
    /// Of `flow_in` \[1/s\].
    pub flow_in: Vec<f64>,
    /// Of `flow_out` \[1/s\].
    pub flow_out: Vec<f64>,
    /// Of `passages` \[1/s\]: as many rows as the caller gives room for, none in [`new`](Self::new).
    pub passages: Vec<f64>,
}

impl GasPartials {
    /// Zeros for `rings` rings and `states` states.
    #[must_use]
    pub fn new(rings: usize, states: usize) -> Self {
        Self {
            d_state: vec![0.0; states * states],
            p_land: vec![0.0; (rings + 1) * states],
            p_back: vec![0.0; rings * states],
            flow_in: vec![0.0; rings * states],
            flow_out: vec![0.0; rings * states],
            passages: Vec::new(),
        }
    }
}

/// Description of the gas mass of a volume as a state, for [`Stateful::states`](crate::states::Stateful::states) of a gas-flow model: `land2`,
/// `ring1.back`. In the state vector it stands over its value at 1 bar; a tenth of that counts as one in the error of a step, and a cycle starts with
/// a hundredth at least: an extrapolated state may have lost its gas.
#[must_use]
pub fn gas_mass(volume: &str) -> StateInfo {
    StateInfo::new(format!("mass of {volume}"))
        .relative(0.1)
        .over_cycle(1.0, true)
        .at_least(0.01)
        .changes(Signals::PRESSURE)
}

/// Description of the energy of the gas in a volume as a state, judged like its mass ([`gas_mass`]).
#[must_use]
pub fn gas_energy(volume: &str) -> StateInfo {
    StateInfo { name: format!("energy of {volume}"), ..gas_mass(volume) }
}

/// A running gas-flow model. Its first [`n_masses`](Self::n_masses) states are the gas masses \[kg\] of its volumes ([`gas_mass`]), so that any
/// linear-invariant-preserving integrator closes the mass balance to round-off: the sum of their rates is `flow_in[0] - flow_out[n-1]` in every
/// call. More states may follow, such as temperatures.
///
/// The functions of this trait take states and rates in SI units and by time. In the state vector of a scene, of which
/// [`Stateful`](crate::states::Stateful) sees its part, each stands over its value at 1 bar, which must be positive.
pub trait GasFlow: Stateful + Send {
    /// Whether gas passes through the end gaps of the rings, so that a gap that closes leaves no model.
    fn uses_end_gaps(&self) -> bool {
        true
    }

    /// The passages of its gas, in the order of [`GasOut::passages`]: what comes into a space through them less what leaves it is stored there. Of a
    /// ring, the upper flank comes before the lower one; the first of its flanks passes, with gap and face, [`GasOut::flow_in`]. None, the default, where no
    /// gas flows, or where the model does not tell its passages apart.
    fn passages(&self) -> &[GasPassage] {
        &[]
    }

    /// Whether the temperature of its gas follows from a balance of energy, whose ledger [`GasOut::power`] and [`each_space`](Self::each_space) are.
    fn has_energy(&self) -> bool {
        false
    }

    /// Calls `visit` with pressure \[Pa\], size \[m³\] and energy \[J\] of the gas of every volume at the last instant: none in a model without a
    /// balance of energy.
    fn each_space(&self, _visit: &mut dyn FnMut(f64, f64, f64)) {}

    /// Number of volumes with a mass of their own: as many of the states, from the first.
    fn n_masses(&self) -> usize {
        self.states().len()
    }
    /// Whether flows or volumes depend on the film thickness of the rings (`RingPlace::h`).
    fn uses_film_height(&self) -> bool;
    /// States at the given pressures \[Pa\] of all volumes: `p_land[i]` for lands, for the space behind ring i the
    /// mean of `p_land[i]` and `p_land[i+1]`, as start of a run.
    fn at_pressures(&self, inp: &GasIn<'_>, p_land: &[f64], state: &mut [f64]);
    /// Pressures only: `out.p_land`, `out.p_back`.
    ///
    /// # Errors
    /// A mass that is not positive.
    fn pressures(&mut self, inp: &GasIn<'_>, state: &[f64], out: &mut GasOut) -> Result<(), EvalError>;
    /// Pressures, flows and rates of change of the states, masses in kg/s.
    ///
    /// # Errors
    /// A mass that is not positive.
    fn rates(
        &mut self,
        inp: &GasIn<'_>,
        state: &[f64],
        d_state: &mut [f64],
        out: &mut GasOut,
    ) -> Result<(), EvalError>;

    /// The same as [`rates`](Self::rates) to the last bit, when no ring has moved since the last call of `rates` or [`partials`](Self::partials), and that one
    /// succeeded: passages are what they were.
    ///
    /// # Errors
    /// As [`rates`](Self::rates).
    fn rates_standing(
        &mut self,
        inp: &GasIn<'_>,
        state: &[f64],
        d_state: &mut [f64],
        out: &mut GasOut,
    ) -> Result<(), EvalError> {
        self.rates(inp, state, d_state, out)
    }

    /// Largest explicit time step \[s\] at which the pressures of volumes that the model couples by a linear leak approach each other without
    /// overshoot; `None` when it couples none. The limit set by the other passages depends on the pressures and is not part of it.
    fn max_explicit_step(&self) -> Option<f64> {
        None
    }

    /// Takes lifts and gaps as they come from now on, below zero too, as a published explicit scheme does: a ring at rest on its upper flank,
    /// whose clearance shrinks as the liner narrows, then leaves less than nothing there until it moves again. Nothing changes in a model
    /// for which that means nothing.
    fn unbound(&mut self) {}

    /// Partial derivatives of all that [`rates`](Self::rates) gives by the states, all of `out` written. One-sided where the flow has a
    /// kink; always finite. `Ok(false)`, the default: they are not known, and `out` is as it was.
    ///
    /// # Errors
    /// As [`rates`](Self::rates).
    fn partials(
        &mut self,
        _inp: &GasIn<'_>,
        _state: &[f64],
        _out: &mut GasPartials,
    ) -> Result<bool, EvalError> {
        Ok(false)
    }

    /// The same as [`rates`](Self::rates) to the last bit, when nothing but the place of one ring has changed since the last call of
    /// `rates` or [`partials`](Self::partials), and that one succeeded: a model may compute anew only what the ring touches. Such
    /// calls may follow each other for any rings; each means that last call, with no ring moved but its own.
    ///
    /// # Errors
    /// As [`rates`](Self::rates).
    fn rates_moved(
        &mut self,
        _ring: usize,
        inp: &GasIn<'_>,
        state: &[f64],
        d_state: &mut [f64],
        out: &mut GasOut,
    ) -> Result<(), EvalError> {
        self.rates(inp, state, d_state, out)
    }
}
