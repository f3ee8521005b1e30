//! Which choice of a comparison matters: shares of the choices in the variance of its results.

use serde::{Deserialize, Serialize};

/// What one choice, or several together, explain of a result.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Share {
    /// Part of the variance, 0 to 1. The parts of all effects make 1.
    pub share: f64,
    /// Largest magnitude of the effect, in the unit of [`ShareRow::spread`].
    pub largest: f64,
    /// Whether the numerical uncertainties of the results can make the whole effect.
    pub within_numerics: bool,
}

/// The shares of one result.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ShareRow {
    /// Name of the result.
    pub result: String,
    /// One line saying what it is.
    #[serde(default)]
    pub what: String,
    /// Unit of the result.
    pub unit: String,
    /// Whether it is among the results that a reader looks at first.
    pub headline: bool,
    /// A headline result with the same spread and the same shares: one is the other times a constant.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub same_as: Option<String>,
    /// Mean over the combinations, in `unit`; none where several cases are taken together.
    pub mean: Option<f64>,
    /// Standard deviation over the combinations of a case: in degrees for an angle, in per cent of the mean magnitude for anything else. Where
    /// several cases are taken together, the root of the mean square of theirs.
    pub spread: f64,
    /// Unit of `spread`: `%` or `deg`.
    pub spread_unit: String,
    /// By effect of the table; none where too many combinations are missing.
    pub shares: Vec<Option<Share>>,
    /// Part of the variance of the values themselves that the case explains, where several cases are taken together.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub between_cases: Option<f64>,
    /// Combinations that are analysed.
    pub combinations: usize,
    /// Levels (`gas_flow=prescribed`) that are left out because combinations with them have no result.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<String>,
}

/// Shares over the combinations of one case, or of several cases together.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ShareTable {
    /// The case; none where all are taken together. Each value then stands relative to its case: the mean of its case is taken off, and what is
    /// left is divided by the mean magnitude there (angles are not divided), so that a large engine counts as much as a small one.
    pub case: Option<String>,
    /// The choices: swaps, after `case` where all cases are taken together.
    pub factors: Vec<String>,
    /// Effects as numbers of their factors: single choices, then interactions of two, of three, and so on.
    pub effects: Vec<Vec<usize>>,
    /// Whether the numerical uncertainties were found by refinement; otherwise they are assumed.
    pub verified: bool,
    /// The results.
    pub rows: Vec<ShareRow>,
    /// What a reader concludes, a sentence each.
    pub findings: Vec<String>,
}

/// Name of the factor that tells cases apart.
pub const CASE: &str = "case";

impl ShareTable {
    /// An effect in words: `gas_flow`, `gas_flow × contact`.
    #[must_use]
    pub fn effect(&self, number: usize) -> String {
        let factors = self.effects.get(number).map_or(&[][..], Vec::as_slice);
        let names: Vec<&str> =
            factors.iter().filter_map(|f| self.factors.get(*f)).map(String::as_str).collect();
        names.join(" × ")
    }

    /// Whether an effect is an interaction with the case.
    #[must_use]
    pub fn with_case(&self, number: usize) -> bool {
        let is_case = |f: &usize| self.case.is_none() && self.factors.get(*f).is_some_and(|n| n == CASE);
        self.effects.get(number).is_some_and(|e| e.iter().any(is_case))
    }

    /// Results that a reader looks at first, without those that tell the same again.
    pub fn headlines(&self) -> impl Iterator<Item = &ShareRow> {
        self.rows.iter().filter(|r| r.headline && r.same_as.is_none())
    }
}
