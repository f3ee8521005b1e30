//! Solid contact between a ring and the liner: asperity pressure, thresholds, floors.
//!
//! | model | load carried by solids | friction |
//! |---|---|---|
//! | [`GreenwoodTripp`] | a pressure that grows smoothly as the surfaces approach | a coefficient times that pressure |
//! | [`CrestWedge`] | a pressure proportional to the overlap of wave crests | the same |
//! | [`LinearPenalty`] | a pressure proportional to the approach | the same |
//! | [`RoughnessThreshold`] | none until the film is as thin as the roughness, then whatever is left | the whole load rubs |
//! | [`FilmFloor`] | whatever is left at a smallest admitted film | none: the film keeps its viscous shear |
//! | [`Off`] | none | none |
//!
//! The coefficient of these models does not depend on the sliding speed; the kind `boundary_friction` says how one may.
//!
//! The integrals behind the asperity models are public: [`asperity_integral()`], [`f_5_2`], [`f_2`], [`f_1`], [`real_area_ratio`].

pub mod asperity_integral;
mod boundary_friction {
    //! Friction of solid contact against sliding speed.
    pub mod coulomb;
    pub mod off;
    pub mod stribeck;
}
mod crest_wedge;
mod film_floor;
mod greenwood_tripp;
mod linear_penalty;
mod off;
mod roughness_threshold;

pub use asperity_integral::{asperity_integral, f_1, f_2, f_5_2};
pub use boundary_friction::coulomb::Coulomb;
pub use boundary_friction::off::Off as Frictionless;
pub use boundary_friction::stribeck::Stribeck;
pub use crest_wedge::CrestWedge;
pub use film_floor::FilmFloor;
pub use greenwood_tripp::{
    AsperityIntegralFormula, GreenwoodTripp, composite_modulus, composite_roughness, real_area_ratio,
};
pub use linear_penalty::LinearPenalty;
pub use off::Off;
pub use roughness_threshold::RoughnessThreshold;

use gudgeon_core::EvalError;

/// Whether speeds are finite and every buffer has their number.
fn check(model: &'static str, speed: &[f64], lengths: &[usize]) -> Result<(), EvalError> {
    if lengths.iter().any(|&n| n != speed.len()) {
        let what = format!("{} speeds for buffers of {lengths:?}", speed.len());
        return Err(EvalError::fatal(model, what));
    }
    match speed.iter().find(|v| !v.is_finite()) {
        Some(v) => Err(EvalError::recoverable(model, format!("the sliding speed {v} m/s is not finite"))),
        None => Ok(()),
    }
}

#[cfg(test)]
mod test {
    use gudgeon_core::kinds::BoundaryFriction;

    /// Coefficient and slope at one speed.
    pub fn friction(m: &dyn BoundaryFriction, speed: f64) -> (f64, f64) {
        let (mut c, mut s) = ([f64::NAN], [f64::NAN]);
        m.coefficient(&[speed], &mut c, &mut s).expect("finite");
        (c[0], s[0])
    }

    /// Odd, of the sign of the speed, with the slope it says, finite at extremes, and errors for bad input.
    pub fn odd_with_its_slope(m: &dyn BoundaryFriction, scale: f64) {
        for v in [1e-3, 0.03, 0.1, 0.4, 1.0, 3.0, 20.0].map(|v| v * scale) {
            let ((f, s), (g, t)) = (friction(m, v), friction(m, -v));
            assert!(f > 0.0 && f == -g && s == t, "{v}");
            let d = 1e-4 * v;
            let central = (friction(m, v + d).0 - friction(m, v - d).0) / (2.0 * d);
            // Truncation 1e-8 of the terms f/v and of the slope at rest, which cancel in part; rounding 1e-17/d.
            assert!((central - s).abs() < 1e-7 * (s.abs() + f / v) + 1e-16 / d, "{v}: {central} {s}");
        }
        for v in [f64::MAX, -1e200, 1e-300] {
            let (f, s) = friction(m, v);
            assert!(f.is_finite() && s.is_finite(), "{v}");
        }
        let (mut c, mut s) = ([0.0], [0.0]);
        assert!(m.coefficient(&[f64::NAN], &mut c, &mut s).is_err_and(|e| e.is_recoverable()));
        assert!(m.coefficient(&[0.0, 0.0], &mut c, &mut s).is_err_and(|e| !e.is_recoverable()));
    }
}
