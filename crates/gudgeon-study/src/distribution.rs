//! What an uncertain input may be.

use gudgeon_core::BuildError;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::normal;

/// Distribution of an uncertain input. `T` is how its values are written: a number with its unit in a file, an `f64` in a calculation
/// ([`Distribution::try_map`] leads from one to the other).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "shape", rename_all = "snake_case", deny_unknown_fields)]
pub enum Distribution<T = f64> {
    /// Everything between two ends is equally likely.
    Uniform {
        /// Lower end.
        from: T,
        /// Upper end.
        to: T,
    },
    /// The logarithm is uniform: 1 to 10 is as likely as 10 to 100. Both ends are above zero.
    LogUniform {
        /// Lower end.
        from: T,
        /// Upper end.
        to: T,
    },
    /// Normal (Gaussian); cut off below `from` and above `to` where they are given.
    Normal {
        /// Mean of what is not cut off.
        mean: T,
        /// Standard deviation of what is not cut off.
        deviation: T,
        /// No value is below.
        #[serde(skip_serializing_if = "Option::is_none")]
        from: Option<T>,
        /// No value is above.
        #[serde(skip_serializing_if = "Option::is_none")]
        to: Option<T>,
    },
    /// Density that rises linearly to the mode and falls linearly from there: for tolerances of which no more is known.
    Triangular {
        /// Lower end.
        from: T,
        /// The most likely value.
        mode: T,
        /// Upper end.
        to: T,
    },
    /// One of some values, with equal weights where none are given. The values may be words too, such as names of models.
    Discrete {
        /// The values.
        values: Vec<T>,
        /// How likely they are, relative to each other.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        weights: Vec<f64>,
    },
}

impl<T> Distribution<T> {
    /// The same distribution with its values written in another way.
    ///
    /// # Errors
    /// The first error of `f`, which gets the key and the value.
    pub fn try_map<U, E>(
        &self,
        mut f: impl FnMut(&'static str, &T) -> Result<U, E>,
    ) -> Result<Distribution<U>, E> {
        Ok(match self {
            Self::Uniform { from, to } => Distribution::Uniform { from: f("from", from)?, to: f("to", to)? },
            Self::LogUniform { from, to } => {
                Distribution::LogUniform { from: f("from", from)?, to: f("to", to)? }
            }
            Self::Normal { mean, deviation, from, to } => Distribution::Normal {
                mean: f("mean", mean)?,
                deviation: f("deviation", deviation)?,
                from: from.as_ref().map(|v| f("from", v)).transpose()?,
                to: to.as_ref().map(|v| f("to", v)).transpose()?,
            },
            Self::Triangular { from, mode, to } => {
                Distribution::Triangular { from: f("from", from)?, mode: f("mode", mode)?, to: f("to", to)? }
            }
            Self::Discrete { values, weights } => Distribution::Discrete {
                values: values.iter().map(|v| f("values", v)).collect::<Result<_, _>>()?,
                weights: weights.clone(),
            },
        })
    }

    /// Where a discrete distribution has its quantile `u`, 0 <= u <= 1, as an index of its values; none where the distribution is
    /// continuous.
    #[must_use]
    pub fn choice(&self, u: f64) -> Option<usize> {
        let Self::Discrete { values, weights } = self else { return None };
        let last = values.len().checked_sub(1)?;
        if weights.is_empty() {
            return Some(((u * values.len() as f64) as usize).min(last));
        }
        let wanted = u * weights.iter().sum::<f64>();
        let mut sum = 0.0;
        let found = weights.iter().position(|w| {
            sum += w;
            wanted < sum
        });
        // Rounding of the sum must not choose a value of weight zero.
        found.or_else(|| weights.iter().rposition(|w| *w > 0.0)).map(|k| k.min(last))
    }

    fn weights_are_legal(&self) -> Result<(), BuildError> {
        let Self::Discrete { values, weights } = self else { return Ok(()) };
        if values.is_empty() {
            return Err(BuildError::at("values", "a discrete distribution needs a value"));
        }
        if !weights.is_empty() && weights.len() != values.len() {
            let what = format!("there are {} values and {} weights", values.len(), weights.len());
            return Err(BuildError::at("weights", what));
        }
        let wrong = weights.iter().any(|w| !w.is_finite() || *w < 0.0);
        if wrong || (!weights.is_empty() && weights.iter().sum::<f64>() <= 0.0) {
            return Err(BuildError::at("weights", "weights are at least 0, one of them above"));
        }
        Ok(())
    }
}

impl Distribution {
    /// Whether the parameters make a distribution.
    ///
    /// # Errors
    /// What is wrong, at the key that is wrong.
    pub fn check(&self) -> Result<(), BuildError> {
        self.weights_are_legal()?;
        self.try_map(|key, v| match v.is_finite() {
            true => Ok(()),
            false => Err(BuildError::at(key, format!("{v} is not a finite number"))),
        })?;
        let order = |lower: f64, upper: f64| {
            if lower < upper && (upper - lower).is_finite() {
                return Ok(());
            }
            Err(BuildError::at("to", format!("`to` must be above `from`, and {upper} is not above {lower}")))
        };
        match *self {
            Self::Uniform { from, to } => order(from, to),
            Self::LogUniform { from, .. } if from <= 0.0 => {
                let what = format!("`from` of a log-uniform distribution must be above 0, not {from}");
                Err(BuildError::at("from", what))
            }
            Self::LogUniform { from, to } => order(from, to),
            Self::Triangular { from, mode, to } => {
                order(from, to)?;
                if (from..=to).contains(&mode) {
                    return Ok(());
                }
                Err(BuildError::at("mode", format!("`mode` must lie between {from} and {to}")))
            }
            Self::Normal { deviation, .. } if deviation <= 0.0 => {
                Err(BuildError::at("deviation", format!("the deviation must be above 0, not {deviation}")))
            }
            Self::Normal { mean, deviation, from, to } => {
                let (from, to) = (from.unwrap_or(f64::NEG_INFINITY), to.unwrap_or(f64::INFINITY));
                if from >= to {
                    let what = format!("`to` must be above `from`, and {to} is not above {from}");
                    return Err(BuildError::at("to", what));
                }
                // Below this what is left has no digits.
                let left = probability_between((from - mean) / deviation, (to - mean) / deviation);
                if left > 1e-12 {
                    return Ok(());
                }
                let what = format!("between `from` and `to` lies only a part {left:.0e} of the distribution");
                Err(BuildError::at("from", what))
            }
            Self::Discrete { .. } => Ok(()),
        }
    }

    /// The value below which a part `u` of all lies: finite for 0 < u < 1, never beyond the ends.
    #[must_use]
    pub fn quantile(&self, u: f64) -> f64 {
        match self {
            Self::Uniform { from, to } => (from + u * (to - from)).clamp(*from, *to),
            Self::LogUniform { from, to } => (from * libm::exp(u * libm::log(to / from))).clamp(*from, *to),
            Self::Normal { mean, deviation, from, to } => truncated_normal(*mean, *deviation, *from, *to, u),
            Self::Triangular { from, mode, to } => triangular(*from, *mode, *to, u),
            Self::Discrete { values, .. } => self.choice(u).map_or(f64::NAN, |k| values[k]),
        }
    }
}

/// Probability that a standard normal variable lies between two values, from the tail that holds its digits.
fn probability_between(a: f64, b: f64) -> f64 {
    if a > 0.0 { normal::cdf(-a) - normal::cdf(-b) } else { normal::cdf(b) - normal::cdf(a) }
}

fn truncated_normal(mean: f64, deviation: f64, from: Option<f64>, to: Option<f64>, u: f64) -> f64 {
    let standard = |v: f64| (v - mean) / deviation;
    let (a, b) = (from.map_or(f64::NEG_INFINITY, standard), to.map_or(f64::INFINITY, standard));
    // In the upper half the small numbers are those above: the calculation is mirrored there.
    let z = if a > 0.0 {
        let (above, below) = (normal::cdf(-b), normal::cdf(-a));
        -normal::quantile(below + u * (above - below))
    } else {
        let (below, above) = (normal::cdf(a), normal::cdf(b));
        normal::quantile(below + u * (above - below))
    };
    (mean + deviation * z).clamp(from.unwrap_or(f64::NEG_INFINITY), to.unwrap_or(f64::INFINITY))
}

fn triangular(from: f64, mode: f64, to: f64, u: f64) -> f64 {
    let rise = (mode - from) / (to - from);
    let v = if u < rise {
        from + libm::sqrt(u * (to - from) * (mode - from))
    } else {
        to - libm::sqrt((1.0 - u) * (to - from) * (to - mode))
    };
    v.clamp(from, to)
}
