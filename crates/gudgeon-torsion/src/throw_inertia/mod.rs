//! Inertia of crank, rod and piston as the shaft feels it.

mod exact;
mod first_harmonic;
mod mean;
mod off;

pub use exact::Exact;
pub use first_harmonic::FirstHarmonic;
pub use mean::Mean;
pub use off::Off;

use gudgeon_core::BuildError;
use gudgeon_core::kinds::ThrowCtx;

/// The throw with its rod as two masses and what inertia they leave over.
#[derive(Debug, Clone, Copy)]
pub struct Lumped {
    /// Crank and big-end mass at the crank radius \[kg m²\].
    pub turning: f64,
    /// Small-end mass and reciprocating mass \[kg\].
    pub oscillating: f64,
    /// Rod inertia that two masses do not have; may be negative \[kg m²\].
    pub residual: f64,
    /// Crank radius \[m\].
    pub r: f64,
    /// Rod length \[m\].
    pub l: f64,
    /// Offset \[m\].
    pub e: f64,
}

impl Lumped {
    /// `m₁ = (1 - j) m_r` at the big end, `m₂ = j m_r` at the small one, `I₂ = I_G - m_r j (1 - j) l²`.
    ///
    /// # Errors
    /// A mechanism that cannot turn, masses that are not numbers.
    pub fn new(c: &ThrowCtx) -> Result<Self, BuildError> {
        for (name, v) in [("crank_radius", c.crank_radius), ("rod_length", c.rod_length)] {
            if !(v.is_finite() && v > 0.0) {
                return Err(BuildError::at(name, format!("{name} is {v}, it must be greater than zero")));
            }
        }
        if c.rod_length.is_nan() || c.rod_length <= c.crank_radius + c.offset.abs() {
            let what = format!(
                "the crank cannot turn: the rod ({} m) must be longer than the crank radius ({} m) plus the offset ({} m)",
                c.rod_length,
                c.crank_radius,
                c.offset.abs()
            );
            return Err(BuildError::at("rod_length", what));
        }
        let (j, l) = (c.rod_centre, c.rod_length);
        let r = c.crank_radius;
        let two_masses = c.rod_mass * j * (1.0 - j) * l * l;
        Ok(Self {
            turning: c.crank_inertia + (1.0 - j) * c.rod_mass * r * r,
            oscillating: j * c.rod_mass + c.reciprocating_mass,
            residual: c.rod_inertia.map_or(0.0, |i| i - two_masses),
            r,
            l,
            e: c.offset,
        })
    }
}
