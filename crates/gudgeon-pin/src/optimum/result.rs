//! The optimum, the residuals of its conditions, and why there may be none.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{PIN_QUANTITIES, PinQuantity, PinSize};

use crate::design::{BlockingLimit, Masses};

/// Bounds of the dimensions besides the limits of strength.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Bound {
    /// Minimum length.
    MinLength,
    /// Maximum length.
    MaxLength,
    /// Minimum outer diameter.
    MinOuter,
    /// Maximum outer diameter.
    MaxOuter,
    /// Minimum inner diameter.
    MinInner,
    /// Maximum inner diameter.
    MaxInner,
    /// Minimum wall thickness.
    MinWall,
    /// Minimum ratio of the diameters that the model holds for.
    MinBoreRatio,
}

/// Number of [`Bound`] values.
pub const BOUNDS: usize = 8;

impl Bound {
    /// All of them, in order.
    pub const ALL: [Self; BOUNDS] = [
        Self::MinLength,
        Self::MaxLength,
        Self::MinOuter,
        Self::MaxOuter,
        Self::MinInner,
        Self::MaxInner,
        Self::MinWall,
        Self::MinBoreRatio,
    ];

    /// Name in a sentence.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::MinLength => "smallest length",
            Self::MaxLength => "greatest length",
            Self::MinOuter => "smallest outer diameter",
            Self::MaxOuter => "greatest outer diameter",
            Self::MinInner => "smallest inner diameter",
            Self::MaxInner => "greatest inner diameter",
            Self::MinWall => "thinnest wall",
            Self::MinBoreRatio => "smallest bore of the model",
        }
    }
}

/// Residuals within which the conditions of Karush, Kuhn and Tucker count as proved.
pub const KKT_TOLERANCE: f64 = 1e-9;
/// Residuals of rounding alone.
const ROUNDING: f64 = 1e-13;

/// Residuals of the conditions of Karush, Kuhn and Tucker at an optimum, all without units.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct KktResiduals {
    /// Largest component of the gradient of mass plus multipliers times logarithms of utilisations, over the gradient of the mass.
    pub stationarity: f64,
    /// Maximum utilisation less one; negative or zero when every limit holds exactly.
    pub infeasibility: f64,
    /// Largest product of a multiplier, over the pin's mass, and the slack of its limit.
    pub complementarity: f64,
    /// Minimum curvature of the mass along the limits, over mass and square of the diameter; absent in a corner, where no direction is
    /// left.
    pub curvature: Option<f64>,
}

impl KktResiduals {
    /// Whether the conditions hold to `tolerance`: first order, and curvature where directions are left.
    #[must_use]
    pub fn hold(&self, tolerance: f64) -> bool {
        self.first_order_hold(tolerance) && self.curvature.is_none_or(|c| c >= -tolerance)
    }

    /// Whether the first-order conditions hold to rounding, 1e-13, as is expected away from degenerate corners.
    #[must_use]
    pub fn hold_to_rounding(&self) -> bool {
        self.first_order_hold(ROUNDING)
    }

    fn first_order_hold(&self, tolerance: f64) -> bool {
        self.stationarity <= tolerance && self.infeasibility <= tolerance && self.complementarity <= tolerance
    }
}

/// The lightest pin.
#[derive(Debug, Clone, PartialEq)]
pub struct Optimum {
    /// Dimensions \[m\].
    pub size: PinSize,
    /// Masses \[kg\].
    pub masses: Masses,
    /// Utilisation of each limit, in the worst corner of the tolerances.
    pub utilisation: [f64; PIN_QUANTITIES],
    /// Mass saved per relative rise of each limit \[kg\].
    pub multipliers: [f64; PIN_QUANTITIES],
    /// Mass saved per length by which a bound gives way \[kg/m\], in the order of [`Bound::ALL`].
    pub bounds: [f64; BOUNDS],
    /// Residuals of the conditions of an optimum.
    pub kkt: KktResiduals,
    /// Quadratic programs solved.
    pub iterations: u32,
}

impl Optimum {
    /// The limits with a multiplier, largest multiplier first.
    #[must_use]
    pub fn active(&self) -> Vec<PinQuantity> {
        let mut out: Vec<_> =
            PinQuantity::ALL.into_iter().filter(|q| self.multipliers[*q as usize] > 0.0).collect();
        out.sort_by(|a, b| self.multipliers[*b as usize].total_cmp(&self.multipliers[*a as usize]));
        out
    }
}

/// Why there is no optimum.
#[derive(Debug, Clone, PartialEq)]
pub enum NoOptimum {
    /// No pin of the ranges keeps the limits; these forbid the maximum outer diameter, its wall when there are none.
    Infeasible(Vec<BlockingLimit>),
    /// The conditions do not close; the best point found.
    Unproven(Box<Optimum>),
    /// The model refused.
    Model(EvalError),
}
