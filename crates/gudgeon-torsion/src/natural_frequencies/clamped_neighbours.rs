use gudgeon_core::kinds::{Line, Mode, NaturalFrequencies, NaturalFrequenciesSpec};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use crate::tree::Tree;

/// A mistake, kept to reproduce a publication: the frequency of each inertia while its neighbours stand still.
///
/// `ω_i = √(K_ii/J_i)` by the diagonal of the stiffness matrix. These are no natural frequencies of the line: there is no rigid
/// mode, equal inertias give one value several times, and only the sum of their squares is right (it is the trace).
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ClampedNeighbours {}

#[register_model(
    name = "clamped_neighbours",
    summary = "wrong on purpose: each inertia between neighbours that stand still, as published",
    equations = "omega_i = sqrt(K_ii/J_i)",
    validity = "For reproduction only: not the natural frequencies of the line. Listed by inertia, not by mode.",
    references = ["gomes2021"],
    example = "",
)]
impl NaturalFrequenciesSpec for ClampedNeighbours {
    fn build(&self, line: &Line) -> Result<Box<dyn NaturalFrequencies>, BuildError> {
        let modes = modes(&Tree::new(line)?)
            .ok_or("a rigid link or an inertia of zero has no frequency between clamped neighbours")
            .map_err(|e| BuildError::at("", e).help("use `eigenvalues`, which joins them"))?;
        Ok(Box::new(Diagonal { modes }))
    }
    fn are_of_the_line(&self) -> bool {
        false
    }
}

/// The frequency of every inertia; none where one has no stiffness or no inertia that is finite.
fn modes(t: &Tree) -> Option<Vec<Mode>> {
    let mut diagonal = t.ground.clone();
    for i in 0..t.len() {
        if t.parent[i] < t.len() {
            diagonal[i] += t.k[i];
            diagonal[t.parent[i]] += t.k[i];
        }
    }
    let omegas = t.position.iter().take(t.len()).map(|&p| (diagonal[p] / t.inertia[p]).sqrt());
    omegas.map(|omega| omega.is_finite().then(|| Mode { omega, ..Mode::default() })).collect()
}

#[derive(Debug)]
struct Diagonal {
    modes: Vec<Mode>,
}

impl NaturalFrequencies for Diagonal {
    fn modes(&mut self) -> Result<Vec<Mode>, EvalError> {
        Ok(self.modes.clone())
    }
}
