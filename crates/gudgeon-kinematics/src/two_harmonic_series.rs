use gudgeon_core::elementary;
use gudgeon_core::kinds::{Kinematics, KinematicsCtx, KinematicsSpec, PistonMotion};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

use crate::mechanism::check_mechanism;

/// The slider-crank mechanism to first order in the ratio of crank radius to rod length.
///
/// ```text
/// a = -r ω² (cos θ + λ cos 2θ)
/// v = -r ω (sin θ + ½ λ sin 2θ)
/// y = l - ¼ r λ + r (cos θ + ¼ λ cos 2θ),   λ = r/l
/// ```
///
/// Velocity and position are the exact integrals of the acceleration, so that work and impulse over a cycle close. The
/// dead centres and the stroke `2r` are exact. Compared with the exact mechanism the terms of order `λ³` are missing: at
/// λ = 0.27 the acceleration differs by at most 1.1 % of `r ω²`, the velocity by 0.33 % of `r ω`.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TwoHarmonicSeries {}

#[register_model(
    name = "two_harmonic_series",
    summary = "slider-crank as two harmonics, first order in r/l",
    equations = "a = -r omega^2 (cos(theta) + lambda cos(2 theta));  v = -r omega (sin(theta) + lambda/2 sin(2 theta));  y = l - r lambda/4 + r (cos(theta) + lambda/4 cos(2 theta));  lambda = r/l",
    validity = "No offset. Error of order (r/l)^3: 1.1 % of r omega^2 at r/l = 0.27.",
    references = ["tomanik1993", "heywood1988"],
    example = "",
)]
impl KinematicsSpec for TwoHarmonicSeries {
    fn build(&self, ctx: &KinematicsCtx) -> Result<Box<dyn Kinematics>, BuildError> {
        check_mechanism(ctx)?;
        let KinematicsCtx { crank_radius: r, rod_length: l, offset, omega } = *ctx;
        if offset != 0.0 {
            let what = format!("the two-harmonic series has no offset, here it is {offset} m");
            return Err(BuildError::at("offset", what).help("use `exact_slider_crank`"));
        }
        Ok(Box::new(Series { r, l, lambda: r / l, omega }))
    }
}

#[derive(Debug, Clone)]
struct Series {
    r: f64,
    l: f64,
    lambda: f64,
    omega: f64,
}

impl Kinematics for Series {
    fn motion(&self, theta: f64) -> PistonMotion {
        let Self { r, l, lambda, omega } = *self;
        let (sin, cos) = elementary::sin_cos(theta);
        let cos2 = (cos - sin) * (cos + sin);
        PistonMotion {
            // cos 2θ - 1 = -2 sin²θ keeps y at the dead centres exact.
            y: l + r * (cos - 0.5 * lambda * sin * sin),
            v: -omega * r * sin * (1.0 + lambda * cos),
            a: -omega * omega * r * (cos + lambda * cos2),
            rod_angle: elementary::asin(lambda * sin),
        }
    }
    fn y_tdc(&self) -> f64 {
        self.l + self.r
    }
    fn stroke(&self) -> f64 {
        2.0 * self.r
    }
    fn omega(&self) -> f64 {
        self.omega
    }
}
