use gudgeon_core::elementary;
use gudgeon_core::kinds::{Kinematics, KinematicsCtx, KinematicsSpec, PistonMotion};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

use crate::mechanism::check_mechanism;

/// The slider-crank mechanism as it is, offset included.
///
/// ```text
/// sin φ = (r sin θ - e)/l
/// y = r cos θ + l cos φ
/// v = -ω r sin(θ + φ)/cos φ
/// a = -ω² r cos θ - l (φ'² cos φ + φ'' sin φ),  φ' = ω r cos θ/(l cos φ),  φ'' = (φ'² sin φ - ω² (r/l) sin θ)/cos φ
/// ```
///
/// `r` crank radius, `l` rod length, `e` offset, positive on the side the throw moves to after top dead centre. The highest
/// and lowest positions are `√((l±r)² - e²)`, reached at `sin θ = e/(l±r)`.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExactSliderCrank {}

#[register_model(
    name = "exact_slider_crank",
    summary = "exact slider-crank with crank or pin offset",
    equations = "y = r cos(theta) + l cos(phi);  sin(phi) = (r sin(theta) - e)/l;  v = -omega r sin(theta + phi)/cos(phi);  a = dv/dt",
    validity = "Rigid parts, constant crank speed, rod longer than crank radius plus offset.",
    references = ["zottin1992", "heywood1988"],
    example = "",
)]
impl KinematicsSpec for ExactSliderCrank {
    fn build(&self, ctx: &KinematicsCtx) -> Result<Box<dyn Kinematics>, BuildError> {
        check_mechanism(ctx)?;
        let KinematicsCtx { crank_radius: r, rod_length: l, offset: e, omega } = *ctx;
        // √((l+r)² - e²) without squaring the large sum twice, and the difference of the two dead centres without
        // cancellation: stroke = 4 l r/(top + bottom).
        let (top, bottom) = (((l + r - e) * (l + r + e)).sqrt(), ((l - r - e) * (l - r + e)).sqrt());
        Ok(Box::new(Exact { r, l, e, omega, y_tdc: top, stroke: 4.0 * l * r / (top + bottom) }))
    }
}

#[derive(Debug, Clone)]
pub(crate) struct Exact {
    pub(crate) r: f64,
    pub(crate) l: f64,
    pub(crate) e: f64,
    pub(crate) omega: f64,
    pub(crate) y_tdc: f64,
    pub(crate) stroke: f64,
}

impl Kinematics for Exact {
    fn motion(&self, theta: f64) -> PistonMotion {
        let Self { r, l, e, omega, .. } = *self;
        let (sin, cos) = elementary::sin_cos(theta);
        let sin_phi = (r * sin - e) / l;
        let cos_phi = ((1.0 - sin_phi) * (1.0 + sin_phi)).sqrt();
        let tan_phi = sin_phi / cos_phi;
        // φ' = ω q with q = r cos θ/(l cos φ). With φ'' inserted, l (φ'² cos φ + φ'' sin φ) = ω² (l q²/cos φ - r sin θ tan φ).
        let q = r * cos / (l * cos_phi);
        PistonMotion {
            y: r * cos + l * cos_phi,
            v: -omega * r * (sin + cos * tan_phi),
            a: -omega * omega * (r * (cos - sin * tan_phi) + l * q * q / cos_phi),
            rod_angle: elementary::asin(sin_phi),
        }
    }
    fn height(&self, theta: f64) -> f64 {
        let Self { r, l, e, .. } = *self;
        let (sin, cos) = elementary::sin_cos(theta);
        let sin_phi = (r * sin - e) / l;
        r * cos + l * ((1.0 - sin_phi) * (1.0 + sin_phi)).sqrt()
    }
    fn velocity(&self, theta: f64) -> f64 {
        let Self { r, l, e, omega, .. } = *self;
        let (sin, cos) = elementary::sin_cos(theta);
        let sin_phi = (r * sin - e) / l;
        let tan_phi = sin_phi / ((1.0 - sin_phi) * (1.0 + sin_phi)).sqrt();
        -omega * r * (sin + cos * tan_phi)
    }
    fn height_and_velocity(&self, theta: f64) -> (f64, f64) {
        let Self { r, l, e, omega, .. } = *self;
        let (sin, cos) = elementary::sin_cos(theta);
        let sin_phi = (r * sin - e) / l;
        let cos_phi = ((1.0 - sin_phi) * (1.0 + sin_phi)).sqrt();
        (r * cos + l * cos_phi, -omega * r * (sin + cos * (sin_phi / cos_phi)))
    }
    fn y_tdc(&self) -> f64 {
        self.y_tdc
    }
    fn stroke(&self) -> f64 {
        self.stroke
    }
    fn omega(&self) -> f64 {
        self.omega
    }
}
