//! Analysis of variance over a full factorial: which share of a result's variance each factor and each interaction explains.
//!
//! With the mean `m_T` over all combinations that agree in the factors `T`, the effect of the factors `S` and its variance are
//!
//! ```text
//! e_S = Σ_{T ⊆ S} (-1)^{|S| - |T|} m_T,      V_S = mean(e_S²),      Σ_S V_S = V
//! ```
//!
//! (functional analysis of variance: Efron and Stein, Annals of Statistics 9 (1981) 586-596; for equal numbers of observations it is the
//! classical table of Fisher). The shares `V_S / V` are those of the combinations at hand, every level counted alike: they are no estimate for
//! levels that were not tried, and there is no residual, because a run is repeated exactly.

mod block;

use serde::Serialize;

pub use block::{Blocks, Kept, largest_full_block};

/// What one factor, or several together, explain.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Effect {
    /// Numbers of the factors, ascending: one for a main effect, several for an interaction.
    pub factors: Vec<usize>,
    /// Variance of the effect.
    pub variance: f64,
    /// Its part of the variance of the result, 0 to 1; all parts together make 1. 0 where the result does not vary at all.
    pub share: f64,
    /// Largest magnitude of the effect over the levels.
    pub largest: f64,
    /// Whether no value of the effect is larger than what the uncertainties of the results can make.
    pub within_numerics: bool,
}

/// The variance of a result, taken apart.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Anova {
    /// Mean over all combinations.
    pub mean: f64,
    /// Variance over all combinations, by their number.
    pub variance: f64,
    /// Main effects in the order of the factors, then interactions of two, of three, and so on. Factors of one level have no effects.
    pub effects: Vec<Effect>,
}

impl Anova {
    /// The share in which a factor takes part, alone or with others.
    #[must_use]
    pub fn total(&self, factor: usize) -> f64 {
        self.effects.iter().filter(|e| e.factors.contains(&factor)).map(|e| e.share).sum()
    }
}

/// Why there is no analysis.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NoAnova {
    /// The numbers do not fit together.
    #[error("{levels} combinations of levels, {results} results and {uncertainties} uncertainties")]
    Length {
        /// Product of the numbers of levels.
        levels: usize,
        /// Results.
        results: usize,
        /// Uncertainties.
        uncertainties: usize,
    },
    /// A combination has no finite result: [`largest_full_block`] finds those that can be analysed.
    #[error("combination {0} has no result")]
    Missing(usize),
    /// More interactions than anybody reads.
    #[error("{0} factors with more than one level, at most {MAX_FACTORS} are analysed")]
    Factors(usize),
}

/// Most factors with more than one level; they have 1023 effects.
pub const MAX_FACTORS: usize = 10;

/// Takes the variance of a result apart. `levels` are the numbers of levels of the factors; `results` and their numerical `uncertainties`
/// stand in the order of the combinations, the last factor the fastest.
///
/// An effect is within the numerics where, for each of its levels, it is at most `Σ |w_c| u_c`: the result is a sum `Σ w_c y_c` over the
/// combinations, and each `y_c` is wrong by at most `u_c`. Nothing smaller can be promised, because numerical errors of similar runs are no
/// random numbers.
///
/// # Errors
/// As [`NoAnova`] says.
pub fn anova(levels: &[usize], results: &[f64], uncertainties: &[f64]) -> Result<Anova, NoAnova> {
    let combinations = levels.iter().product();
    if results.len() != combinations || uncertainties.len() != combinations {
        return Err(NoAnova::Length {
            levels: combinations,
            results: results.len(),
            uncertainties: uncertainties.len(),
        });
    }
    if let Some(k) = results.iter().position(|v| !v.is_finite()) {
        return Err(NoAnova::Missing(k));
    }
    let free: Vec<usize> = (0..levels.len()).filter(|f| levels[*f] > 1).collect();
    if free.len() > MAX_FACTORS {
        return Err(NoAnova::Factors(free.len()));
    }
    // Around the first result: rounding is that of the differences.
    let origin = results.first().copied().unwrap_or(0.0);
    let y: Vec<f64> = results.iter().map(|v| v - origin).collect();
    let mean = mean_of(&y);
    let variance = mean_square(&y.iter().map(|v| v - mean).collect::<Vec<_>>());
    let effects = subsets(&free)
        .into_iter()
        .map(|factors| effect(levels, factors, &y, uncertainties, variance))
        .collect();
    Ok(Anova { mean: origin + mean, variance, effects })
}

/// Subsets of some factors but the empty one, the small ones first.
fn subsets(free: &[usize]) -> Vec<Vec<usize>> {
    let of = |bits: usize| (0..free.len()).filter(|k| bits >> k & 1 == 1).map(|k| free[k]).collect();
    let mut all: Vec<Vec<usize>> = (1..1_usize << free.len()).map(of).collect();
    all.sort_by(|a, b| (a.len(), a).cmp(&(b.len(), b)));
    all
}

fn effect(levels: &[usize], factors: Vec<usize>, y: &[f64], u: &[f64], variance: f64) -> Effect {
    let (mut e, mut bound) = (y.to_vec(), u.to_vec());
    let mut stride = y.len();
    for (f, n) in levels.iter().copied().enumerate() {
        stride /= n;
        let inside = factors.contains(&f);
        along(&mut e, n, stride, |line| project(line, inside));
        along(&mut bound, n, stride, |line| worst(line, inside));
    }
    let own = mean_square(&e);
    Effect {
        factors,
        variance: own,
        share: if variance > 0.0 { own / variance } else { 0.0 },
        largest: e.iter().fold(0.0, |m, v| v.abs().max(m)),
        within_numerics: e.iter().zip(&bound).all(|(e, b)| e.abs() <= *b),
    }
}

/// Applies `f` to every line of a table along one of its factors.
fn along(table: &mut [f64], n: usize, stride: usize, mut f: impl FnMut(&mut [f64])) {
    let mut line = vec![0.0; n];
    for block in table.chunks_mut(n * stride) {
        for first in 0..stride {
            for (k, v) in line.iter_mut().enumerate() {
                *v = block[first + k * stride];
            }
            f(&mut line);
            for (k, v) in line.iter().enumerate() {
                block[first + k * stride] = *v;
            }
        }
    }
}

/// The mean along a factor, or what is left of it.
fn project(line: &mut [f64], inside: bool) {
    let mean = mean_of(line);
    line.iter_mut().for_each(|v| *v = if inside { *v - mean } else { mean });
}

/// The same with the magnitudes of the weights: `1/n`, or `1 - 1/n` at the level itself and `1/n` at the others.
fn worst(line: &mut [f64], inside: bool) {
    let (mean, n) = (mean_of(line), line.len() as f64);
    line.iter_mut().for_each(|v| *v = if inside { *v * (1.0 - 2.0 / n) + mean } else { mean });
}

fn mean_of(y: &[f64]) -> f64 {
    y.iter().sum::<f64>() / y.len().max(1) as f64
}

fn mean_square(y: &[f64]) -> f64 {
    y.iter().map(|v| v * v).sum::<f64>() / y.len().max(1) as f64
}
