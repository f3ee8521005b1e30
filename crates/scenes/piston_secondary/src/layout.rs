//! Where the states of the models stand in the state vector.

use std::ops::Range;

use gudgeon_core::kinds::SecondaryMotion;
use gudgeon_core::states::{Signals, StateInfo};
use gudgeon_skirt::Side;

/// States of the lateral motion, then the amplitudes of the elastic shapes of the thrust side, then those of the other.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// Lateral motion.
    pub motion: Range<usize>,
    /// Elastic shapes of both sides.
    pub shapes: Range<usize>,
    /// Number of states.
    pub n: usize,
    /// What the models say of the states.
    pub states: Vec<StateInfo>,
    /// States with which a cycle ends as it began when it is periodic; the others follow from them at its start.
    pub periodic: Vec<usize>,
}

impl Layout {
    /// Lays out the states of the lateral motion and of both sides; `all`: none follows from the others at the start of a cycle, as where films that are not full
    /// hold nothing.
    #[must_use]
    pub fn new(motion: &dyn SecondaryMotion, sides: &[Side; 2], all: bool) -> Self {
        let mut states = motion.states().to_vec();
        let own = states.len();
        states.extend(sides.iter().flat_map(|s| s.compliance.states().iter().cloned()));
        let n = states.len();
        let first = if all { own } else { motion.n_periodic().min(own) };
        let periodic = (0..first).chain(own..n).collect();
        Self { motion: 0..own, shapes: own..n, n, states, periodic }
    }

    /// Whether state `k` changes the gap.
    #[must_use]
    pub fn changes_gap(&self, k: usize) -> bool {
        self.states[k].changes.meets(Signals::FILM_THICKNESS)
    }
}
