//! What a gudgeon pin must keep, what it weighs, and which dimensions the limits leave.

mod feasibility;

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{PIN_QUANTITIES, PinForces, PinQuantity, PinSize, PinStrength, resultant_stress};
use gudgeon_numerics::jet::Real;

pub use feasibility::{BlockingLimit, LengthBound};

/// The flats ("espelhos") cut from the sides of a piston beyond the ends of the pin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Relief {
    /// Piston diameter D \[m\].
    pub bore: f64,
    /// Height of the flats \[m\].
    pub height: f64,
    /// Density of the piston \[kg/m³\].
    pub density: f64,
}

impl Relief {
    /// Mass removed \[kg\]: two circular segments beyond `±L/2`,
    /// `A = D²/2 acos(L/D) - L/2 √(D² - L²)`.
    pub fn mass<T: Real>(&self, length: T) -> T {
        let d = self.bore;
        let segments =
            (length / d).acos() * (0.5 * d * d) - length * (-length.squared() + d * d).sqrt() * 0.5;
        segments * (self.height * self.density)
    }
}

/// Masses that the design weighs \[kg\].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Masses {
    /// The pin.
    pub pin: f64,
    /// What is relieved on the piston.
    pub relieved: f64,
}

impl Masses {
    /// What is minimised: the mass of the pin less that of the relief \[kg\].
    #[must_use]
    pub fn differential(&self) -> f64 {
        self.pin - self.relieved
    }
}

/// Minimum and maximum \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Minimum.
    pub low: f64,
    /// Maximum.
    pub high: f64,
}

impl Range {
    /// One value.
    #[must_use]
    pub const fn at(v: f64) -> Self {
        Self { low: v, high: v }
    }
    /// Whether it holds one value only.
    #[must_use]
    pub fn is_fixed(&self) -> bool {
        self.high <= self.low
    }
}

/// A pin to be sized: model, load, limits, weights, ranges.
#[derive(Debug, Clone, Copy)]
pub struct Design<'a> {
    /// Model of strength.
    pub strength: &'a dyn PinStrength,
    /// Force.
    pub load: PinForces,
    /// Maximum of each quantity, SI, in the order of [`PinQuantity::ALL`]; infinite where nothing is limited.
    pub limits: [f64; PIN_QUANTITIES],
    /// Density of the pin \[kg/m³\].
    pub density: f64,
    /// Ratio of circumference to diameter.
    pub pi: f64,
    /// Flats on the piston; without them the pin's own mass counts.
    pub relief: Option<Relief>,
    /// Free distance between the bosses \[m\].
    pub boss_gap: f64,
    /// Admitted lengths \[m\], above `boss_gap` and below the piston diameter.
    pub length: Range,
    /// Admitted outer diameters \[m\].
    pub outer: Range,
    /// Admitted inner diameters \[m\].
    pub inner: Range,
    /// Minimum wall thickness \[m\].
    pub min_wall: f64,
    /// Half widths of the tolerances \[m\]: limits hold in every corner.
    pub tolerance: PinSize,
}

/// How the corners of the tolerances stand: shortest and longest pin with the minimum outer and maximum inner diameter.
pub(crate) fn corners(size: &PinSize, tol: &PinSize) -> (PinSize, PinSize) {
    let worn = PinSize { length: size.length, outer: size.outer - tol.outer, inner: size.inner + tol.inner };
    (
        PinSize { length: size.length - tol.length, ..worn },
        PinSize { length: size.length + tol.length, ..worn },
    )
}

/// The quantities whose maximum is that of the longest pin; of the others it is that of the shortest, the resultant follows its parts.
pub(crate) const GROWING_WITH_LENGTH: [PinQuantity; 2] =
    [PinQuantity::Deflection, PinQuantity::BendingStress];

impl Design<'_> {
    /// Quantities over their limits, each in the worst corner of the tolerances, in the order of [`PinQuantity::ALL`].
    ///
    /// # Errors
    /// Dimensions outside the model.
    pub fn utilisation(&self, size: &PinSize) -> Result<[f64; PIN_QUANTITIES], EvalError> {
        let (short, long) = corners(size, &self.tolerance);
        self.utilisation_between(&short, &long)
    }

    /// Quantities that fall with the length from `short`, those that grow with it from `long`, over their limits: bounds of the
    /// utilisation over a range of lengths, and the worst corner of tolerances.
    pub(crate) fn utilisation_between(
        &self,
        short: &PinSize,
        long: &PinSize,
    ) -> Result<[f64; PIN_QUANTITIES], EvalError> {
        let mut v = self.strength.quantities(short, &self.load)?;
        if short != long {
            let w = self.strength.quantities(long, &self.load)?;
            for q in GROWING_WITH_LENGTH {
                v[q as usize] = w[q as usize];
            }
            v[PinQuantity::ResultantStress as usize] = resultant_stress(
                v[PinQuantity::BendingStress as usize],
                v[PinQuantity::OvalisationStress as usize],
            );
        }
        for (v, limit) in v.iter_mut().zip(self.limits) {
            *v /= limit;
        }
        Ok(v)
    }

    /// Mass of the pin and of the relief at the nominal dimensions.
    #[must_use]
    pub fn masses(&self, size: &PinSize) -> Masses {
        let PinSize { length, outer, inner } = *size;
        Masses {
            pin: self.pin_mass(length, outer, inner),
            relieved: self.relief.map_or(0.0, |r| r.mass(length.min(r.bore))),
        }
    }

    /// `ρ π/4 (d_o² - d_i²) L`.
    pub(crate) fn pin_mass<T: Real>(&self, length: T, outer: T, inner: T) -> T {
        (outer - inner) * (outer + inner) * length * (0.25 * self.pi * self.density)
    }

    /// Minimum inner diameter at an outer one.
    #[must_use]
    pub fn min_inner(&self, outer: f64) -> f64 {
        // The model must hold in the corner of the tolerances too.
        self.inner.low.max(self.strength.min_bore_ratio() * outer)
    }

    /// Maximum inner diameter at an outer one that leaves a wall, in every corner of the tolerances.
    #[must_use]
    pub fn max_inner(&self, outer: f64) -> f64 {
        let play = self.tolerance.outer + self.tolerance.inner;
        self.inner.high.min(outer - 2.0 * self.min_wall).min((outer - play) * (1.0 - 1e-9))
    }
}
