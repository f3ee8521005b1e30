use gudgeon_core::kinds::{Line, Mode, NaturalFrequencies, NaturalFrequenciesSpec};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use crate::eigen;
use crate::tree::Tree;

/// The eigenvalues of the line, undamped and damped.
///
/// `(K - ω² J) φ = 0` with rigid modes at exactly zero; `det(K + z C + z² J) = 0` for the damped ones. Chains by root-free QL on the
/// differences of the shafts, everything else by counts of negative pivots of the tree; see [`crate::tree`] for why their accuracy
/// does not depend on the ratio of stiffnesses. Holzer's residual of every mode is its check.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-renamed" = { "most": "max_modes" }))]
pub struct Eigenvalues {
    /// Maximum number of modes, the lowest first; rigid ones count.
    #[serde(default = "max_modes")]
    #[schemars(range(min = 1, max = 2000))]
    pub max_modes: usize,
}

fn max_modes() -> usize {
    40
}

impl Default for Eigenvalues {
    fn default() -> Self {
        Self { max_modes: max_modes() }
    }
}

#[register_model(
    name = "eigenvalues",
    summary = "eigenvalues of the whole line with shapes, undamped and damped",
    equations = "(K - omega^2 J) phi = 0;  det(K + z C + z^2 J) = 0, z = -decay + i omega_d",
    validity = "Small vibration; inertia of throws at its mean, couplings over the frequency at their first row, drives without damping. The scene takes couplings that depend on their load at the mean torque.",
    references = ["holzer1921", "reinsch1973", "wilkinson1971", "aberth1973"],
    example = "",
)]
impl NaturalFrequenciesSpec for Eigenvalues {
    fn build(&self, line: &Line) -> Result<Box<dyn NaturalFrequencies>, BuildError> {
        if self.max_modes == 0 {
            return Err(BuildError::at("max_modes", "at least one mode must be wanted"));
        }
        Ok(Box::new(Solver { tree: Tree::new(line)?, max_modes: self.max_modes }))
    }
}

#[derive(Debug)]
struct Solver {
    tree: Tree,
    max_modes: usize,
}

impl NaturalFrequencies for Solver {
    fn modes(&mut self) -> Result<Vec<Mode>, EvalError> {
        eigen::modes(&self.tree, self.max_modes, true)
    }
}
