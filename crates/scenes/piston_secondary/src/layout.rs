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
    /// Lays out the states of the lateral motion and of both sides.
    #[must_use]
    pub fn new(motion: &dyn SecondaryMotion, sides: &[Side; 2]) -> Self {
        let mut states = motion.states().to_vec();
        let own = states.len();
        states.extend(sides.iter().flat_map(|s| s.compliance.states().iter().cloned()));
        let n = states.len();
        let periodic = (0..motion.n_periodic().min(own)).chain(own..n).collect();
        Self { motion: 0..own, shapes: own..n, n, states, periodic }
    }

    /// Whether state `k` changes the gap.
    #[must_use]
    pub fn changes_gap(&self, k: usize) -> bool {
        self.states[k].changes.meets(Signals::FILM_THICKNESS)
    }
}
