use std::fmt::Debug;

use dyn_clone::DynClone;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{BuildError, EvalError, register_kind};

/// What limits a gudgeon pin, in the order in which the published program tests it (`reimer1984`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PinQuantity {
    /// Mean pressure between pin and piston bosses \[Pa\].
    BossPressure,
    /// Shortening of the pin's diameter under the load \[m\].
    Ovalisation,
    /// Deflection of the middle of the pin against the bosses \[m\].
    Deflection,
    /// Mean pressure between pin and small end \[Pa\].
    RodPressure,
    /// Longitudinal bending stress \[Pa\].
    BendingStress,
    /// Hoop stress from ovalisation \[Pa\].
    OvalisationStress,
    /// Transverse shear stress \[Pa\].
    ShearStress,
    /// Root of the sum of the squares of both bending stresses \[Pa\].
    ResultantStress,
}

/// Number of [`PinQuantity`] values.
pub const PIN_QUANTITIES: usize = 8;

impl PinQuantity {
    /// All of them, in order; `ALL[k] as usize == k`.
    pub const ALL: [Self; PIN_QUANTITIES] = [
        Self::BossPressure,
        Self::Ovalisation,
        Self::Deflection,
        Self::RodPressure,
        Self::BendingStress,
        Self::OvalisationStress,
        Self::ShearStress,
        Self::ResultantStress,
    ];

    /// Name in case files and results.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::BossPressure => "boss_pressure",
            Self::Ovalisation => "ovalisation",
            Self::Deflection => "deflection",
            Self::RodPressure => "rod_pressure",
            Self::BendingStress => "bending_stress",
            Self::OvalisationStress => "ovalisation_stress",
            Self::ShearStress => "shear_stress",
            Self::ResultantStress => "resultant_stress",
        }
    }

    /// Name in a sentence.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::BossPressure => "boss pressure",
            Self::Ovalisation => "ovalisation",
            Self::Deflection => "deflection",
            Self::RodPressure => "rod pressure",
            Self::BendingStress => "bending stress",
            Self::OvalisationStress => "ovalisation stress",
            Self::ShearStress => "shear stress",
            Self::ResultantStress => "resultant stress",
        }
    }

    /// Whether it is a length; the others are pressures.
    #[must_use]
    pub const fn is_length(self) -> bool {
        matches!(self, Self::Ovalisation | Self::Deflection)
    }
}

/// Where the pressure of a boss on the pin has its centre.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BossBore {
    /// Profiled bore, with oil pockets: the middle of the boss, centres `a = (L + D3)/2` apart.
    #[default]
    Profiled,
    /// Cylindrical bore: a quarter of the boss from its inner edge, `a = D3 + (L - D3)/4`.
    Cylindrical,
}

impl BossBore {
    /// Distance of the pressure centres as `offset + slope·L`, for bosses `gap` apart.
    #[must_use]
    pub const fn centres(self, gap: f64) -> (f64, f64) {
        match self {
            Self::Profiled => (0.5 * gap, 0.5),
            Self::Cylindrical => (0.75 * gap, 0.25),
        }
    }
}

/// What a [`PinStrengthSpec`] is built for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PinStrengthCtx {
    /// Free distance between the bosses D3 \[m\].
    pub boss_gap: f64,
    /// Width of the small end B \[m\], at most the boss gap.
    pub rod_width: f64,
    /// Form of the bore of the bosses.
    pub boss_bore: BossBore,
    /// Young's modulus \[Pa\].
    pub modulus: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Ratio of circumference to diameter: a published program may have mistyped it.
    pub pi: f64,
}

/// Dimensions of a hollow pin \[m\].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PinSize {
    /// Length L.
    pub length: f64,
    /// Outer diameter.
    pub outer: f64,
    /// Inner diameter, zero for a solid pin.
    pub inner: f64,
}

/// Forces on the pin \[N\], towards the crankshaft positive.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PinForces {
    /// Gas force on the piston.
    pub gas: f64,
    /// Inertia force of the piston, negative at the firing dead centre.
    pub inertia: f64,
}

impl PinForces {
    /// Gas and inertia.
    #[must_use]
    pub fn total(self) -> f64 {
        self.gas + self.inertia
    }
}

/// Quantities with their exact derivatives by length, outer and inner diameter; second derivatives in the order LL, Lo, Li, oo,
/// oi, ii.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PinExpansion {
    /// Values, in the order of [`PinQuantity::ALL`], SI.
    pub value: [f64; PIN_QUANTITIES],
    /// First derivatives.
    pub gradient: [[f64; 3]; PIN_QUANTITIES],
    /// Second derivatives.
    pub hessian: [[f64; 6]; PIN_QUANTITIES],
}

/// Configuration of a model of pin strength.
#[register_kind(
    name = "pin_strength",
    summary = "pressures, deformations and stresses of a gudgeon pin under its force"
)]
pub trait PinStrengthSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model.
    ///
    /// # Errors
    /// Constants outside their range, a small end wider than the gap between the bosses.
    fn build(&self, ctx: &PinStrengthCtx) -> Result<Box<dyn PinStrength>, BuildError>;
}

/// A running model of pin strength.
///
/// What a solver may rely on, for an inner diameter from `min_bore_ratio` times the outer one upwards: boss pressure, ovalisation,
/// ovalisation stress and shear stress do not rise with the length, deflection and bending stress do not fall with it; no quantity
/// rises with the outer diameter or falls with the inner one; the rod pressure depends on the outer diameter alone, the boss pressure
/// not on the inner one; the resultant is [`resultant_stress`] of the two bending stresses.
pub trait PinStrength: Debug + Send + Sync {
    /// The eight quantities, in the order of [`PinQuantity::ALL`], SI.
    ///
    /// # Errors
    /// Dimensions outside `boss_gap < length`, `min_bore_ratio·outer <= inner < outer` (Recoverable).
    fn quantities(&self, size: &PinSize, load: &PinForces) -> Result<[f64; PIN_QUANTITIES], EvalError>;

    /// The same with derivatives.
    ///
    /// # Errors
    /// As [`PinStrength::quantities`].
    fn expansion(&self, size: &PinSize, load: &PinForces) -> Result<PinExpansion, EvalError>;

    /// Minimum ratio of the inner to the outer diameter that the theory holds for.
    fn min_bore_ratio(&self) -> f64 {
        0.0
    }
}

/// Resultant of the longitudinal and the transverse bending stress, which act in perpendicular planes (`reimer1984`).
#[must_use]
pub fn resultant_stress(bending: f64, ovalisation: f64) -> f64 {
    (bending * bending + ovalisation * ovalisation).sqrt()
}
