//! Differences between the results of two runs, with what the numerics of both leave open.

use serde::{Deserialize, Serialize};

/// Crank angles \[deg\] after which an engine is where it was.
const CYCLE: f64 = 720.0;

/// Change from one value to another, in their unit; of angles (`deg`) the shorter way around the cycle.
#[must_use]
pub fn change(from: f64, to: f64, unit: &str) -> f64 {
    let d = to - from;
    if unit == "deg" && d.abs() > 0.5 * CYCLE { d - CYCLE.copysign(d) } else { d }
}

/// Whether a difference is larger than its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Confidence {
    /// Both values are the same number.
    Equal,
    /// Larger than its uncertainty: its sign is that of the solved equations.
    Resolved,
    /// Not larger than its uncertainty: the numerical errors alone can make it.
    NotResolved,
    /// The numerical uncertainty of one of the two is not known.
    Unknown,
}

impl Confidence {
    /// Its name in files: `equal`, `resolved`, `not_resolved`, `unknown`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Equal => "equal",
            Self::Resolved => "resolved",
            Self::NotResolved => "not_resolved",
            Self::Unknown => "unknown",
        }
    }
}

/// How a result of a run differs from that of the base, with the uncertainty of that.
///
/// Numerical errors of two runs are no independent random numbers: the same discretisation of similar cases errs to the same side, or, with other models, to
/// opposite ones. Nothing is known but their magnitudes, so they are added, which is a bound, and not the root of the sum of their squares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// In the unit of the result.
    pub absolute: f64,
    /// Bound of the error of `absolute`: the sum of both uncertainties.
    pub uncertainty: Option<f64>,
    /// Of the magnitude of the base \[%\]. None where that says nothing: the zero of the unit is arbitrary (`deg`, `degC`), or the base may be zero.
    pub percent: Option<f64>,
    /// Bound of the error of `percent` \[%\], that of the base in the denominator included.
    pub percent_uncertainty: Option<f64>,
}

impl Difference {
    /// Of two values with their uncertainties, all in `unit`; none where one is not finite.
    #[must_use]
    pub fn between(base: (f64, Option<f64>), other: (f64, Option<f64>), unit: &str) -> Option<Self> {
        let absolute = change(base.0, other.0, unit);
        if !absolute.is_finite() {
            return None;
        }
        let known = base.1.zip(other.1).filter(|(a, b)| (a + b).is_finite());
        let size = base.0.abs();
        let relative = !matches!(unit, "deg" | "degC") && size > known.map_or(0.0, |(a, _)| a);
        let percent = Some(100.0 * absolute / size).filter(|p| relative && p.is_finite());
        // The quotient of two values that are each as far off as they can be.
        let bound = |(a, b): (f64, f64)| 100.0 * (b + a * (other.0 / base.0).abs()) / (size - a);
        Some(Self {
            absolute,
            uncertainty: known.map(|(a, b)| a + b),
            percent,
            percent_uncertainty: percent.and(known).map(bound),
        })
    }

    /// Whether it can be told from the numerics.
    #[must_use]
    pub fn confidence(&self) -> Confidence {
        match self.uncertainty {
            _ if self.absolute == 0.0 => Confidence::Equal,
            None => Confidence::Unknown,
            Some(u) if self.absolute.abs() > u => Confidence::Resolved,
            Some(_) => Confidence::NotResolved,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn difference(base: (f64, Option<f64>), other: (f64, Option<f64>), unit: &str) -> Difference {
        Difference::between(base, other, unit).expect("finite")
    }

    #[test]
    fn uncertainties_are_added() {
        let d = difference((100.0, Some(2.0)), (110.0, Some(3.0)), "N");
        assert_eq!((d.absolute, d.uncertainty), (10.0, Some(5.0)));
        assert_eq!(d.confidence(), Confidence::Resolved);
        // Added in squares, 3.5 and 4 are 5.3, and this would be resolved.
        let d = difference((100.0, Some(3.5)), (107.0, Some(4.0)), "N");
        assert_eq!(d.confidence(), Confidence::NotResolved);
        // The bound itself is not exceeded.
        assert_eq!(difference((4.0, Some(1.0)), (6.0, Some(1.0)), "N").confidence(), Confidence::NotResolved);
    }

    #[test]
    fn one_uncertainty_alone_is_none() {
        for (a, b) in [(None, Some(1.0)), (Some(1.0), None), (None, None), (Some(f64::INFINITY), Some(1.0))] {
            let d = difference((1.0, a), (100.0, b), "N");
            assert_eq!((d.uncertainty, d.percent_uncertainty), (None, None));
            assert_eq!(d.confidence(), Confidence::Unknown);
            assert_eq!(d.percent, Some(9900.0));
        }
        assert_eq!(difference((7.0, None), (7.0, None), "N").confidence(), Confidence::Equal);
        assert!(Difference::between((f64::NAN, None), (1.0, None), "N").is_none());
    }

    /// The bound in per cent against all corners of both intervals.
    #[test]
    fn per_cent_holds_for_all_values_within_the_uncertainties() {
        for (base, other) in [(100.0, 300.0), (-50.0, -40.0), (100.0, -20.0), (2.0, 0.0)] {
            let (a, b) = (0.3 * f64::abs(base), 7.0);
            let d = difference((base, Some(a)), (other, Some(b)), "N");
            let (p, u) = (d.percent.expect("told"), d.percent_uncertainty.expect("told"));
            assert_eq!(p, 100.0 * (other - base) / base.abs());
            let corners = [(-a, -b), (-a, b), (a, -b), (a, b)]
                .map(|(i, j)| 100.0 * (other + j - base - i) / (base + i).abs() - p);
            let worst = corners.iter().fold(0.0, |m: f64, e| m.max(e.abs()));
            // Rounding of some operations of numbers of some hundred.
            assert!((worst - u).abs() < 1e-11, "{worst} {u}");
        }
    }

    #[test]
    fn no_per_cent_of_angles_and_of_what_may_be_zero() {
        assert_eq!(difference((370.0, Some(0.5)), (372.0, Some(0.5)), "deg").percent, None);
        assert_eq!(difference((180.0, None), (190.0, None), "degC").percent, None);
        assert_eq!(difference((0.0, None), (1.0, None), "N").percent, None);
        let d = difference((1.0, Some(1.0)), (9.0, Some(1.0)), "N");
        assert_eq!((d.percent, d.percent_uncertainty, d.confidence()), (None, None, Confidence::Resolved));
    }

    #[test]
    fn angles_go_the_shorter_way_around() {
        assert_eq!(change(719.0, 1.0, "deg"), 2.0);
        assert_eq!(change(1.0, 719.0, "deg"), -2.0);
        assert_eq!(change(719.0, 1.0, "N"), -718.0);
        assert_eq!(change(0.0, 360.0, "deg"), 360.0);
        let d = difference((719.5, Some(0.5)), (0.5, Some(0.25)), "deg");
        assert_eq!((d.absolute, d.confidence()), (1.0, Confidence::Resolved));
    }
}
