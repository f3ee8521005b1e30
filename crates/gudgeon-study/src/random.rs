//! Random numbers that are the same for ever, on every machine, and that need no state: a number is a function of its seed and its place.
//!
//! The mixing function and the increment are those of SplitMix64: Steele, Lea and Flood, "Fast splittable pseudorandom number generators",
//! Proc. OOPSLA 2014, with the constants of Stafford's variant 13. What is computed here must never change: points of studies that were
//! begun depend on it.

/// Increment of SplitMix64, the golden ratio in 64 bits.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// 64 bits out of 64 bits, one to one, every bit of the result depending on every bit of `z`.
const fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// 64 random bits that belong to a sequence of words (seed, dimension, index, …).
pub(crate) fn hash(words: &[u64]) -> u64 {
    words.iter().fold(0, |h, w| mix(h.wrapping_add(GOLDEN) ^ mix(w.wrapping_add(GOLDEN))))
}

/// The upper `bits` of 64 random ones as a number above 0 and below 1, at the middle of 2^bits equal cells; at most 52 bits.
pub(crate) fn open_unit(random: u64, bits: u32) -> f64 {
    ((random >> (64 - bits)) as f64 + 0.5) / (1_u64 << bits) as f64
}

/// A sequence of random numbers.
#[derive(Debug, Clone)]
pub(crate) struct Stream(u64);

impl Stream {
    /// The sequence that belongs to some words.
    pub(crate) fn new(words: &[u64]) -> Self {
        Self(hash(words))
    }

    /// The next 64 bits.
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(GOLDEN);
        mix(self.0)
    }

    /// A whole number below `n`, all equally likely but for 2^-64 `n`.
    pub(crate) fn below(&mut self, n: usize) -> usize {
        ((u128::from(self.bits()) * n as u128) >> 64) as usize
    }

    /// Puts `items` into random order (Fisher and Yates).
    pub(crate) fn shuffle<T>(&mut self, items: &mut [T]) {
        for k in (1..items.len()).rev() {
            items.swap(k, self.below(k + 1));
        }
    }
}
