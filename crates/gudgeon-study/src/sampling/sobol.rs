//! The Sobol sequence with Owen's scrambling.
//!
//! Direction numbers: Joe and Kuo, "Constructing Sobol sequences with better two-dimensional projections", SIAM J. Sci. Comput. 30 (2008)
//! 2635-2654 (file `joe_kuo.txt` with its licence). Scrambling: Owen, "Randomly permuted (t,m,s)-nets and (t,s)-sequences", in Monte Carlo
//! and Quasi-Monte Carlo Methods in Scientific Computing (1995) 299-317; every digit is flipped or not by a hash of the digits before it.

use std::sync::OnceLock;

use gudgeon_core::BuildError;

use super::{Points, counted};
use crate::random::{hash, open_unit};

/// Binary digits of the sequence: it has 2^32 points.
const BITS: usize = 32;

/// Direction numbers of one dimension, that of the highest digit first.
type Directions = [u32; BITS];

/// A Sobol sequence in the order of Gray's code, scrambled or as it is.
#[derive(Debug, Clone)]
pub struct Sobol {
    points: usize,
    directions: &'static [Directions],
    seed: Option<u64>,
}

impl Sobol {
    /// Most dimensions.
    pub const MAX_DIMENSIONS: usize = 256;

    /// The first `points` points, scrambled: each is uniform in the unit cube, and together they stay as even as those of the sequence.
    ///
    /// # Errors
    /// No point or more than [`MAX_POINTS`](super::MAX_POINTS); no dimension or more than [`Sobol::MAX_DIMENSIONS`].
    pub fn scrambled(points: usize, dimensions: usize, seed: u64) -> Result<Self, BuildError> {
        Self::new(points, dimensions, Some(seed))
    }

    /// The first `points` points of the sequence itself, the first of them the origin.
    ///
    /// # Errors
    /// As [`Sobol::scrambled`].
    pub fn plain(points: usize, dimensions: usize) -> Result<Self, BuildError> {
        Self::new(points, dimensions, None)
    }

    fn new(points: usize, dimensions: usize, seed: Option<u64>) -> Result<Self, BuildError> {
        counted("points", points, 1, dimensions)?;
        match directions().get(..dimensions) {
            Some(directions) => Ok(Self { points, directions, seed }),
            None => Err(BuildError::new(format!(
                "a Sobol sequence has at most {} dimensions, not {dimensions}",
                Self::MAX_DIMENSIONS
            ))),
        }
    }
}

impl Points for Sobol {
    fn len(&self) -> usize {
        self.points
    }

    fn dimensions(&self) -> usize {
        self.directions.len()
    }

    fn point(&self, k: usize) -> Vec<f64> {
        let gray = (k ^ (k >> 1)) as u32;
        let digits = |v: &Directions| (0..BITS).filter(|b| gray >> b & 1 == 1).fold(0, |x, b| x ^ v[b]);
        let place = |(d, v): (usize, &Directions)| match self.seed {
            Some(seed) => scramble(digits(v), &[seed, d as u64]),
            None => f64::from(digits(v)) / (1_u64 << BITS) as f64,
        };
        self.directions.iter().enumerate().map(place).collect()
    }
}

/// Flips each digit by a hash of those before it; digits after the last one are random.
fn scramble(x: u32, key: &[u64; 2]) -> f64 {
    let mut out = 0;
    for b in 0..BITS as u32 {
        let before = u64::from(x).checked_shr(BITS as u32 - b).unwrap_or(0);
        let digit = x >> (BITS as u32 - 1 - b) & 1;
        out = out << 1 | (digit ^ (hash(&[key[0], key[1], u64::from(b), before]) & 1) as u32);
    }
    // 20 further digits: the sum is exact.
    let rest = open_unit(hash(&[key[0], key[1], BITS as u64, u64::from(x)]), 20);
    (f64::from(out) + rest) / (1_u64 << BITS) as f64
}

/// Direction numbers of all dimensions.
fn directions() -> &'static [Directions] {
    static ALL: OnceLock<Vec<Directions>> = OnceLock::new();
    ALL.get_or_init(|| {
        let first = std::array::from_fn(|b| 1 << (BITS - 1 - b));
        let lines = include_str!("joe_kuo.txt").lines().filter(|l| !l.starts_with('#'));
        std::iter::once(first).chain(lines.map(recurrence)).collect()
    })
}

/// From a line `dimension degree coefficients m_1 m_2 …`: the recurrence of Joe and Kuo, eq. (3).
fn recurrence(line: &str) -> Directions {
    let numbers: Vec<u32> = line.split_whitespace().filter_map(|n| n.parse().ok()).collect();
    let (degree, coefficients, initial) = (numbers[1] as usize, numbers[2], &numbers[3..]);
    let mut v = [0; BITS];
    for b in 0..BITS {
        if b < degree {
            v[b] = initial[b] << (BITS - 1 - b);
            continue;
        }
        v[b] = v[b - degree] ^ (v[b - degree] >> degree);
        for k in 1..degree {
            if coefficients >> (degree - 1 - k) & 1 == 1 {
                v[b] ^= v[b - k];
            }
        }
    }
    v
}
