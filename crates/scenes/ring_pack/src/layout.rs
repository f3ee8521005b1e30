//! Where the states of the models stand in the state vector.

use std::ops::Range;

use gudgeon_core::kinds::{FilmTemperature, GasFlow, OilTransport};
use gudgeon_core::states::{Signals, StateInfo};

use super::ring::Ring;

/// Where things are in the state vector: the gas, each state over its value at 1 bar; the radial motion of every ring; the motion of every ring in its
/// groove; the oil on its flanks; the oil on the liner; the film temperatures.
#[derive(Debug, Clone, Default)]
pub struct Layout {
    /// Gas.
    pub gas: Range<usize>,
    /// Radial motion per ring.
    pub radial: Vec<Range<usize>>,
    /// Motion in the groove per ring.
    pub motion: Vec<Range<usize>>,
    /// Oil on the flanks per ring.
    pub flank: Vec<Range<usize>>,
    /// Oil.
    pub oil: Range<usize>,
    /// Film temperatures.
    pub temperature: Range<usize>,
    /// Number of states.
    pub n: usize,
    /// Values that are carried from step to step behind the states.
    pub carried: usize,
    /// What the models say of the states.
    pub states: Vec<StateInfo>,
    /// What the film of each ring depends on, and what moves with it: radial motion, oil, temperature.
    pub film_reads: Vec<Signals>,
    /// Whether the oil on any flank is followed.
    wet_flanks: bool,
    /// Whether each ring twists.
    pub twists: Vec<bool>,
    /// What the motion of each ring in its groove and the oil there depend on.
    pub motion_reads: Vec<Signals>,
    /// Whether the gas has a balance of energy.
    gas_has_energy: bool,
    /// Passages of the gas whose flows are carried as quadratures: all of them while [`Pack::follow_passages`](super::pack::Pack::follow_passages) holds.
    pub(super) passages: usize,
}

impl Layout {
    /// Lays out the states of all models; radial motion and oil only where films are solved.
    #[must_use]
    pub fn new(
        gas: &dyn GasFlow,
        rings: &[Ring],
        films: bool,
        oil: Option<&dyn OilTransport>,
        temperature: &dyn FilmTemperature,
    ) -> Self {
        let mut layout = Self { carried: oil.map_or(0, OilTransport::carried), ..Self::default() };
        layout.gas = layout.add(gas.states().iter().cloned());
        layout.gas_has_energy = gas.has_energy();
        for r in rings {
            let own = if films && !r.films.is_empty() { r.radial.states() } else { &[] };
            let range = layout.add(own.iter().cloned());
            layout.radial.push(range);
        }
        for r in rings {
            let range = layout.add(r.motion.states().iter().cloned());
            layout.motion.push(range);
        }
        for r in rings {
            let range = layout.add(r.flank.states().iter().cloned());
            layout.flank.push(range);
        }
        layout.oil = layout.add(oil.into_iter().flat_map(|o| o.states().iter().cloned()));
        let own = if films { temperature.states() } else { &[] };
        layout.temperature = layout.add(own.iter().cloned());
        let mut also = oil.map_or(Signals::NONE, |o| o.reads());
        if !layout.temperature.is_empty() {
            also |= temperature.reads();
        }
        let twists = |r: &Ring| r.motion.states().iter().any(|s| s.changes.meets(Signals::TWIST));
        layout.twists = rings.iter().map(twists).collect();
        let of_twist = |r: &Ring| if twists(r) { Signals::TWIST } else { Signals::NONE };
        layout.film_reads = rings.iter().map(|r| r.radial.reads() | also | of_twist(r)).collect();
        let of_flank = |r: &Ring| if r.flank.states().is_empty() { Signals::NONE } else { r.flank.reads() };
        layout.motion_reads = rings.iter().map(|r| r.motion.reads() | of_flank(r)).collect();
        layout.wet_flanks = layout.flank.iter().any(|own| !own.is_empty());
        layout
    }

    /// Number of quadratures: flow into each ring, flow out of the last, friction work of each ring and its part of solid contact, where oil on flanks is followed what each ring
    /// gained and lost of it, what is brought to gas with a balance of energy, and, last, the flow through each passage of the gas where that is followed.
    #[must_use]
    pub fn quads(&self) -> usize {
        self.passage_quad() + self.passages
    }

    /// The quadratures of friction.
    #[must_use]
    pub fn friction_quads(&self) -> Range<usize> {
        let n = self.flank.len();
        n + 1..3 * n + 1
    }

    /// The quadrature of the flow through the first passage of the gas, where passages are followed.
    #[must_use]
    pub fn passage_quad(&self) -> usize {
        let n = self.flank.len();
        3 * n + 1 + if self.wet_flanks { 2 * n } else { 0 } + usize::from(self.gas_has_energy)
    }

    /// The quadrature of the oil that came to the flanks of ring `i`; that of what left them is the next. None where it is not followed.
    #[must_use]
    pub fn flank_quad(&self, i: usize) -> Option<usize> {
        self.wet_flanks.then_some(3 * self.flank.len() + 1 + 2 * i)
    }

    /// The quadrature of the energy that is brought to the gas; none without a balance of it.
    #[must_use]
    pub fn gas_quad(&self) -> Option<usize> {
        self.gas_has_energy.then(|| self.passage_quad() - 1)
    }

    /// Out of the quadratures `q`, the gas \[kg\] that passed each ring, the last of them to the crankcase, and each passage that is followed.
    pub fn passed(&self, q: &[f64]) -> impl Iterator<Item = f64> {
        q[..=self.flank.len()].iter().chain(&q[self.passage_quad()..]).copied()
    }

    fn add(&mut self, states: impl Iterator<Item = StateInfo>) -> Range<usize> {
        let first = self.states.len();
        self.states.extend(states);
        self.n = self.states.len();
        first..self.n
    }
}
