use gudgeon_core::kinds::{Line, Mode, NaturalFrequencies, NaturalFrequenciesSpec};
use gudgeon_core::{BuildError, EvalError};
use serde::{Deserialize, Serialize};

use crate::tree::Tree;

/// A mistake, kept to reproduce a publication: the frequency of each inertia while its neighbours stand still.
///
/// `ω_i = √(K_ii/J_i)` by the diagonal of the stiffness matrix. These are no natural frequencies of the line: there is no rigid
/// mode, equal inertias give one value several times, and only the sum of their squares is right (it is the trace).
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ClampedNeighbours {}

gudgeon_core::register_model! {
    ClampedNeighbours, kind: "natural_frequencies", name: "clamped_neighbours",
    summary: "wrong on purpose: each inertia between neighbours that stand still, as published",
    equations: "omega_i = sqrt(K_ii/J_i)",
    validity: "For reproduction only: not the natural frequencies of the line. Listed by inertia, not by mode.",
    references: ["gomes2021"],
    example: "",
}

#[typetag::serde(name = "clamped_neighbours")]
impl NaturalFrequenciesSpec for ClampedNeighbours {
    fn build(&self, line: &Line) -> Result<Box<dyn NaturalFrequencies>, BuildError> {
        Ok(Box::new(Diagonal { tree: Tree::new(line)? }))
    }
    fn are_of_the_line(&self) -> bool {
        false
    }
}

#[derive(Debug)]
struct Diagonal {
    tree: Tree,
}

impl NaturalFrequencies for Diagonal {
    fn modes(&mut self) -> Result<Vec<Mode>, EvalError> {
        let t = &self.tree;
        let mut diagonal = t.ground.clone();
        for i in 0..t.len() {
            if t.parent[i] < t.len() {
                diagonal[i] += t.k[i];
                diagonal[t.parent[i]] += t.k[i];
            }
        }
        (0..t.len())
            .map(|node| {
                let p = t.position[node];
                let omega = (diagonal[p] / t.inertia[p]).sqrt();
                if !omega.is_finite() {
                    let what =
                        "a rigid link or an inertia of zero has no frequency between clamped neighbours";
                    return Err(EvalError::fatal("clamped_neighbours", what));
                }
                Ok(Mode { omega, ..Mode::default() })
            })
            .collect()
    }
}
