//! Designs: where in the unit cube a study looks. A coordinate is the quantile at which an input is taken
//! ([`Distribution::quantile`](crate::distribution::Distribution::quantile)), one dimension an input.
//!
//! Points are functions of the design, its seed and their number: the same for ever, on every machine, in any order. All coordinates are above
//! 0 and below 1, so that no unbounded distribution is asked for its ends.

mod latin_hypercube;
mod medians;
mod morris;
mod one_at_a_time;
mod saltelli;
mod sobol;

use gudgeon_core::BuildError;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use latin_hypercube::LatinHypercube;
pub use medians::Medians;
pub use morris::Morris;
pub use one_at_a_time::OneAtATime;
pub use saltelli::Saltelli;
pub use sobol::Sobol;

/// Points of the unit cube by number.
pub trait Points: Send + Sync {
    /// How many there are.
    fn len(&self) -> usize;

    /// Whether there are none.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Coordinates of a point.
    fn dimensions(&self) -> usize;

    /// Point `k`, from 0; calculated without the points before it.
    ///
    /// # Panics
    /// `k` is not below [`Points::len`].
    fn point(&self, k: usize) -> Vec<f64>;
}

/// Most points of a design; each is a run.
pub const MAX_POINTS: usize = 1 << 20;

/// A method with its numbers, as a study file says it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "method", rename_all = "snake_case", deny_unknown_fields)]
pub enum Design {
    /// Every input takes each of `points` equally likely parts of its range once; the parts are combined at random. For bands of results and
    /// main effects.
    LatinHypercube {
        /// Number of runs.
        points: usize,
        /// Another seed makes other points.
        #[serde(default)]
        seed: u64,
    },
    /// Sobol sequence with Owen's scrambling: fills all dimensions evenly, best with a power of two of points. Can be made longer and keeps the
    /// points it has.
    Sobol {
        /// Number of runs.
        points: usize,
        /// Another seed makes other points.
        #[serde(default)]
        seed: u64,
    },
    /// Every input alone at a low and at a high quantile, the others at their medians: `2 d + 1` runs, for a tornado plot.
    OneAtATime {
        /// The low quantile.
        #[serde(default = "low")]
        low: f64,
        /// The high quantile.
        #[serde(default = "high")]
        high: f64,
    },
    /// Random ways along the edges of a grid, one step in every input each: `trajectories (d + 1)` runs, for screening many inputs.
    Morris {
        /// Number of ways, commonly 10 to 50.
        trajectories: usize,
        /// Levels of the grid in every input, even.
        #[serde(default = "levels")]
        levels: usize,
        /// Another seed makes other points.
        #[serde(default)]
        seed: u64,
    },
    /// Two independent samples and one mixture of them for each input: `base (d + 2)` runs, for first-order and total Sobol indices.
    Saltelli {
        /// Points of each sample, best a power of two.
        base: usize,
        /// Another seed makes other points.
        #[serde(default)]
        seed: u64,
    },
    /// One point with all inputs at their medians, and the derivatives there: bands and shares to first order, for the cost of a few runs where
    /// the scene has derivatives of its own.
    Linear {},
}

const fn low() -> f64 {
    0.05
}

const fn high() -> f64 {
    0.95
}

const fn levels() -> usize {
    4
}

impl Design {
    /// The points for a number of inputs.
    ///
    /// # Errors
    /// Numbers that make no design, at their keys.
    pub fn points(&self, dimensions: usize) -> Result<Box<dyn Points>, BuildError> {
        Ok(match *self {
            Self::LatinHypercube { points, seed } => Box::new(LatinHypercube::new(points, dimensions, seed)?),
            Self::Sobol { points, seed } => Box::new(Sobol::scrambled(points, dimensions, seed)?),
            Self::OneAtATime { low, high } => Box::new(OneAtATime::new(dimensions, low, high)?),
            Self::Morris { trajectories, levels, seed } => {
                Box::new(Morris::new(trajectories, dimensions, levels, seed)?)
            }
            Self::Linear {} => Box::new(Medians::new(dimensions)?),
            Self::Saltelli { base, seed } => Box::new(Saltelli::new(base, dimensions, seed)?),
        })
    }
}

/// Refuses designs without inputs and those of more than [`MAX_POINTS`] points. `key` gives `given`, and each of these makes `each` points.
fn counted(key: &str, given: usize, each: usize, dimensions: usize) -> Result<(), BuildError> {
    if dimensions == 0 {
        return Err(BuildError::new("a design needs an input to vary"));
    }
    let most = MAX_POINTS / each;
    if (1..=most).contains(&given) {
        return Ok(());
    }
    let what = format!("`{key}` must be 1 to {most}, not {given}");
    Err(BuildError::at(key, what).help(format!("a design has at most {MAX_POINTS} points")))
}
