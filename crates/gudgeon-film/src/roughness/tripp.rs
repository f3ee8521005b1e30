//! Flow factors of Tripp.

use gudgeon_core::kinds::{RoughFlow, RoughShear, Roughness, RoughnessSpec};
use gudgeon_core::quantity::{Length, NonNegative, PosRatio, quantity};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_numerics::elementary;
use serde::{Deserialize, Serialize};

use super::checks::{check_flow, check_shear};
use super::gaussian_gap::GaussianGap;
use super::held_above::held_above;

/// Average flow between Gaussian rough surfaces of any pattern, by the expansion of Tripp with the contact factor of Wu and Zheng.
///
/// With the composite roughness `σ = √(σ_liner² + σ_body²)`, `H = h/σ`, the pattern `γ` (ratio of the correlation lengths along and across the sliding
/// direction) and `D = 1/(1 + γ)`:
///
/// ```text
/// φ_x  = 1 + a/H²  (a > 0)   1/(1 - a/H²)  (a < 0)       a = 3 (1 - 3 D);   φ_y: D = γ/(1 + γ)
/// φ_c  = ∂h_T/∂h = ½ [1 + erf(H/√2)]                     h_c = h_T + 3 D (σ_liner² - σ_body²)/h_p
/// φ_f  = 1 + 1/H²      φ_fs = 3 D (σ_body² - σ_liner²)/h_p²      φ_fp = 1/(1 + 3 D/H²)
/// ```
///
/// Exact to the order `1/H²`: ridges across (`γ → 0`) have the mean of `h^-3` and ridges along (`γ → ∞`) that of `h³`. Tripp's `1 + a/H²` becomes negative
/// where the film is thin; `1/(1 - a/H²)`, equal to that order, does not. `φ_c` is the contact factor, the share of the surfaces that the film keeps apart;
/// its integral `h_T` is the film content. Below `H = 1` the factors stay at those of 0.9.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tripp {
    /// Roughness (rms) of the liner; zero when smooth.
    pub liner_roughness: Length<NonNegative>,
    /// Roughness (rms) of the ring or skirt; zero when smooth.
    pub body_roughness: Length<NonNegative>,
    /// Pattern γ of both surfaces: below 1 ridges across the sliding direction, above 1 along it.
    #[serde(default = "one")]
    pub pattern: PosRatio,
}

fn one() -> PosRatio {
    quantity(1.0)
}

#[register_model(
    name = "tripp",
    summary = "flow factors of Gaussian rough surfaces of any pattern by Tripp's expansion, with contact factor",
    equations = "D = 1/(1 + gamma), a = 3 (1 - 3 D);  phi_x = 1 + a/H^2 or 1/(1 - a/H^2);  phi_c = dh_T/dh = [1 + erf(H/sqrt 2)]/2;  h_c = h_T + 3 D (sigma_l^2 - sigma_b^2)/h;  phi_f = 1 + 1/H^2;  phi_fs = 3 D (sigma_b^2 - sigma_l^2)/h^2;  phi_fp = 1/(1 + 3 D/H^2)",
    validity = "Gaussian heights, full films; exact to 1/H^2, so H above 3. Below, continued without becoming negative; the factors stay at those of 0.9 below H = 1.",
    references = ["tripp1983", "wu1989"],
    example = "liner_roughness = \"0.3 um\"\nbody_roughness = \"0.2 um\"\npattern = 0.5\n",
)]
impl RoughnessSpec for Tripp {
    fn build(&self) -> Result<Box<dyn Roughness>, BuildError> {
        let (liner, body, gamma) = (self.liner_roughness.si(), self.body_roughness.si(), self.pattern.si());
        let sigma = elementary::hypot(liner, body);
        if sigma == 0.0 {
            return Err(BuildError::at("liner_roughness", "both surfaces are smooth")
                .help("use the model `off` for smooth surfaces"));
        }
        if !(sigma.is_normal() && sigma.recip().is_finite()) {
            let what =
                format!("the composite roughness {sigma:e} m is too small or too large to compute with");
            return Err(BuildError::at("liner_roughness", what));
        }
        let share = |s: f64| (s / sigma) * (s / sigma);
        let along = (1.0 + gamma).recip();
        Ok(Box::new(Expansion { sigma, along, across: 1.0 - along, apart: share(liner) - share(body) }))
    }
}

const MODEL: &str = "tripp";
/// Film over σ at which the factors end, and half of the stretch over which the film of the factors comes to rest there.
const ENDS: (f64, f64) = (0.9, 0.1);

#[derive(Debug)]
struct Expansion {
    sigma: f64,
    /// `D` along and across the sliding direction.
    along: f64,
    across: f64,
    /// `(σ_liner² - σ_body²)/σ²`.
    apart: f64,
}

impl Expansion {
    /// The film of the factors over σ.
    fn film(&self, gap: f64) -> f64 {
        held_above(gap, ENDS.0, ENDS.1)
    }
}

/// `φ` for `D` and `1/H²`.
fn pressure_flow(d: f64, square: f64) -> f64 {
    let a = 3.0 * (1.0 - 3.0 * d) * square;
    if a > 0.0 { 1.0 + a } else { 1.0 / (1.0 - a) }
}

impl Roughness for Expansion {
    fn held_below(&self) -> Option<f64> {
        Some(self.sigma * (ENDS.0 + ENDS.1))
    }

    fn flow(&self, h: &[f64], out: &mut RoughFlow) -> Result<(), EvalError> {
        check_flow(MODEL, h, out)?;
        let average = GaussianGap::new();
        let (sigma, inverse) = (self.sigma, self.sigma.recip());
        for (i, &h) in h.iter().enumerate() {
            let gap = h * inverse;
            let film = self.film(gap);
            let (content, slope) = average.at(gap);
            let shear = 3.0 * self.along * self.apart / film;
            // Below the end the liner carries a fixed share of the content.
            let carried =
                if film > gap { content * (1.0 + shear / average.at(film).0) } else { content + shear };
            let square = (film * film).recip();
            out.film[i] = sigma * film;
            out.phi_x[i] = pressure_flow(self.along, square);
            out.phi_y[i] = pressure_flow(self.across, square);
            out.transport[i] = sigma * carried;
            out.content[i] = sigma * content;
            out.content_derivative[i] = slope;
        }
        Ok(())
    }

    fn shear(&self, h: &[f64], out: &mut RoughShear) -> Result<(), EvalError> {
        check_shear(MODEL, h, out)?;
        for (i, &h) in h.iter().enumerate() {
            let film = self.film(h / self.sigma);
            let square = (film * film).recip();
            out.film[i] = self.sigma * film;
            out.phi_f[i] = 1.0 + square;
            out.phi_fs[i] = -3.0 * self.along * self.apart * square;
            out.phi_fp[i] = 1.0 / (1.0 + 3.0 * self.along * square);
        }
        Ok(())
    }
}
