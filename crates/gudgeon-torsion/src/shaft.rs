//! Stiffness and stress of round shafts.

use std::f64::consts::PI;

/// A cylindrical piece of a shaft: every length greater than zero, the bore less than the diameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Length \[m\].
    pub length: f64,
    /// Outer diameter \[m\].
    pub diameter: f64,
    /// Diameter of the bore \[m\].
    pub bore: f64,
}

impl Piece {
    /// Polar second moment of area `π (d⁴ - b⁴)/32` \[m⁴\].
    #[must_use]
    pub fn polar_moment(&self) -> f64 {
        // Without the difference of fourth powers.
        let (d, b) = (self.diameter, self.bore);
        PI / 32.0 * (d - b) * (d + b) * (d * d + b * b)
    }

    /// Inertia of the piece about its axis \[kg m²\] for a density \[kg/m³\].
    #[must_use]
    pub fn inertia(&self, density: f64) -> f64 {
        density * self.length * self.polar_moment()
    }

    /// Maximum shear stress \[Pa\] under a torque \[N m\]: `T d/(2 I_p)`.
    #[must_use]
    pub fn stress(&self, torque: f64) -> f64 {
        torque * 0.5 * self.diameter / self.polar_moment()
    }
}

/// Stiffness \[N m/rad\] of pieces in series, `1/Σ L/(G I_p)`, for a shear modulus \[Pa\].
#[must_use]
pub fn stiffness(pieces: &[Piece], shear_modulus: f64) -> f64 {
    shear_modulus / pieces.iter().map(|p| p.length / p.polar_moment()).sum::<f64>()
}

/// The piece of maximum stress under a torque.
#[must_use]
pub fn weakest(pieces: &[Piece]) -> Option<&Piece> {
    pieces.iter().max_by(|a, b| a.stress(1.0).total_cmp(&b.stress(1.0)))
}
