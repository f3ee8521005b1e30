//! Trajectories of elementary effects: Morris, "Factorial sampling plans for preliminary computational experiments", Technometrics 33 (1991)
//! 161-174.
//!
//! Two choices differ from the paper. Levels stand at the middles of equal cells, `(l + 1/2) / p`, not at `l / (p - 1)`: no unbounded
//! distribution is asked for its ends, and the step of `p / 2` levels, which makes all levels equally likely, is 1/2. And the levels at which the
//! trajectories begin are balanced over them in every input, not independent: each level begins as many as any other, or one more.

use gudgeon_core::BuildError;

use super::{Points, counted};
use crate::random::Stream;

/// Point `t (d + 1) + s` is that of trajectory `t` after `s` steps, each in another input.
#[derive(Debug, Clone)]
pub struct Morris {
    /// By input, the level at which each trajectory begins.
    start: Vec<Vec<usize>>,
    trajectories: usize,
    levels: usize,
    seed: u64,
}

impl Morris {
    /// Length of every step.
    pub const STEP: f64 = 0.5;

    /// # Errors
    /// No trajectory, no input, levels that are odd or fewer than two, too many points.
    pub fn new(trajectories: usize, dimensions: usize, levels: usize, seed: u64) -> Result<Self, BuildError> {
        counted("trajectories", trajectories, dimensions + 1, dimensions)?;
        if levels < 2 || levels % 2 == 1 || levels > 1000 {
            let what = format!("`levels` must be even, 2 to 1000, not {levels}");
            return Err(BuildError::at("levels", what));
        }
        let start = (0..dimensions)
            .map(|d| {
                let mut begin: Vec<usize> = (0..trajectories).map(|t| t % levels).collect();
                Stream::new(&[seed, 0, d as u64]).shuffle(&mut begin);
                begin
            })
            .collect();
        Ok(Self { start, trajectories, levels, seed })
    }

    /// Number of trajectories.
    #[must_use]
    pub const fn trajectories(&self) -> usize {
        self.trajectories
    }

    /// The inputs of a trajectory in the order in which they step.
    #[must_use]
    pub fn order(&self, trajectory: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.start.len()).collect();
        Stream::new(&[self.seed, 1, trajectory as u64]).shuffle(&mut order);
        order
    }

    /// Whether the step of an input leads upwards: where there is room for it, and nowhere else.
    #[must_use]
    pub fn rises(&self, trajectory: usize, input: usize) -> bool {
        self.start[input][trajectory] < self.levels / 2
    }
}

impl Points for Morris {
    fn len(&self) -> usize {
        self.trajectories * (self.start.len() + 1)
    }

    fn dimensions(&self) -> usize {
        self.start.len()
    }

    fn point(&self, k: usize) -> Vec<f64> {
        let (trajectory, steps) = (k / (self.start.len() + 1), k % (self.start.len() + 1));
        let place = |start: &Vec<usize>| (start[trajectory] as f64 + 0.5) / self.levels as f64;
        let mut u: Vec<f64> = self.start.iter().map(place).collect();
        for input in self.order(trajectory).into_iter().take(steps) {
            u[input] += if self.rises(trajectory, input) { Self::STEP } else { -Self::STEP };
        }
        u
    }
}
