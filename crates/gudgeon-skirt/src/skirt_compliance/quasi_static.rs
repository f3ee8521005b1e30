//! Shapes that yield without inertia.

use gudgeon_core::kinds::{SkirtCompliance, SkirtComplianceCtx};
use gudgeon_core::states::{Signals, StateInfo, Stateful};

/// Shapes that yield without inertia, each by itself: `K_k (q_k + τ dq_k/dt) = ∫ φ_k (p - p_crankcase) dA`.
///
/// The shapes are orthogonal with respect to the compliance, so each yields to its own part of the load alone. The relaxation `τ` is a little inner
/// damping, without which nothing would hold a surface under a cavity.
///
/// States: the amplitudes `q_k` in clearances.
#[derive(Debug, Clone, PartialEq)]
pub struct QuasiStaticShapes {
    states: Vec<StateInfo>,
    shapes: Vec<f64>,
    stiffness: Vec<f64>,
    relaxation: f64,
}

impl QuasiStaticShapes {
    /// Shapes at the nodes of the grid of `ctx`, shape after shape, and the stiffness of each \[N/m\].
    #[must_use]
    pub fn new(ctx: &SkirtComplianceCtx<'_>, shapes: Vec<f64>, stiffness: Vec<f64>) -> Self {
        let state = |k: usize| {
            StateInfo::new(format!("shape {} of the {}", k + 1, ctx.side))
                .absolute(1.0)
                .changes(Signals::FILM_THICKNESS)
        };
        let states = (0..stiffness.len()).map(state).collect();
        Self { states, shapes, stiffness, relaxation: ctx.relaxation }
    }

    /// Stiffness of every shape \[N/m\].
    #[must_use]
    pub fn stiffness(&self) -> &[f64] {
        &self.stiffness
    }
}

impl Stateful for QuasiStaticShapes {
    fn states(&self) -> &[StateInfo] {
        &self.states
    }
}

impl SkirtCompliance for QuasiStaticShapes {
    fn shapes(&self) -> &[f64] {
        &self.shapes
    }
    fn resistance(&self, k: usize, q: f64, rate: f64) -> f64 {
        self.stiffness[k] * (q + self.relaxation * rate)
    }
    fn resistance_by_rate(&self, k: usize, _: f64, _: f64) -> f64 {
        self.relaxation * self.stiffness[k]
    }
    fn rest(&self, k: usize, load: f64) -> f64 {
        load / self.stiffness[k]
    }
}
