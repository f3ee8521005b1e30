//! Flow factors of Patir and Cheng.

use gudgeon_core::kinds::{RoughFlow, RoughShear, Roughness, RoughnessSpec};
use gudgeon_core::quantity::{Length, NonNegative};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_numerics::elementary;
use serde::{Deserialize, Serialize};

use super::checks::{check_flow, check_shear};
use super::gaussian_gap::GaussianGap;
use super::held_above::held_above;

/// Average flow between Gaussian rough surfaces, by the factors of Patir and Cheng.
///
/// With the composite roughness `σ = √(σ_liner² + σ_body²)`, `H = h/σ` and the pattern `γ`, the ratio of the correlation lengths
/// along and across the sliding direction:
///
/// ```text
/// φ_x  = 1 - C exp(-r H)  (γ <= 1)        1 + C H^(-r)  (γ > 1)        φ_y(H, γ) = φ_x(H, 1/γ)
/// h_T  = h/2 [1 + erf(H/√2)] + σ exp(-H²/2)/√(2π)
/// h_c  = h_T + σ φ_s            φ_s  = (σ_liner/σ)² Φ_s(H, γ_liner) - (σ_body/σ)² Φ_s(H, γ_body)
/// Φ_s  = A1 H^α1 exp(-α2 H + α3 H²)  (H <= 5)        A2 exp(-H/4)  (H > 5)
/// φ_fs = (σ_body/σ)² Φ_fs(H, γ_body) - (σ_liner/σ)² Φ_fs(H, γ_liner)
/// Φ_fs = A3 H^α4 exp(-α5 H + α6 H²)  (H < 7)         φ_fp = 1 - D exp(-s H)
/// φ_f  = z ∫ 35/32 (1 - t²)³/(z + t) dt over z + t > 1/300,  z = H/3;  for z < 1 to 0.2 %, as published
/// ```
///
/// `∂h_T/∂h = ½ [1 + erf(H/√2)]` is the contact factor of Wu and Zheng (wu1989).
///
/// The constants are tabulated for seven patterns and not interpolated. What the published pieces leave open is closed so that
/// everything has a continuous slope:
///
/// - The pieces of `Φ_s` miss each other by less than 0.1 % at `H` = 5: they are blended from 4.5 to 5.5.
/// - `Φ_fs` passes into zero from 7 to 9.
/// - Below the validity limit (`H` = 1 for γ or 1/γ of 6 and 9, 0.75 for 3, 0.5 for 1) the factors would become negative. The film
///   of the factors passes from there with continuous slope into one that is 0.05 lower, and stays; film content and transport
///   follow the real separation, in a fixed ratio. `φ_fp`, which turns negative at the limit for γ = 1, ends at zero.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PatirCheng {
    /// Roughness (rms) of the liner; zero when smooth.
    pub liner_roughness: Length<NonNegative>,
    /// Roughness (rms) of the ring or skirt; zero when smooth.
    pub body_roughness: Length<NonNegative>,
    /// Pattern γ of both surfaces together.
    #[serde(default)]
    pub pattern: Pattern,
    /// Pattern of the liner alone, for the shear flow; as `pattern` when not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub liner_pattern: Option<Pattern>,
    /// Pattern of the ring or skirt alone, for the shear flow; as `pattern` when not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub body_pattern: Option<Pattern>,
}

/// Ratio γ of the correlation lengths of a rough surface along and across the sliding direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
pub enum Pattern {
    /// Strongly transverse ridges.
    #[serde(rename = "1/9")]
    Ninth,
    /// Transverse ridges.
    #[serde(rename = "1/6")]
    Sixth,
    /// Mildly transverse ridges.
    #[serde(rename = "1/3")]
    Third,
    /// No direction.
    #[default]
    #[serde(rename = "1")]
    One,
    /// Mildly longitudinal ridges.
    #[serde(rename = "3")]
    Three,
    /// Longitudinal ridges.
    #[serde(rename = "6")]
    Six,
    /// Strongly longitudinal ridges.
    #[serde(rename = "9")]
    Nine,
}

impl Pattern {
    /// All patterns, γ ascending: the pattern `1/γ` stands at the mirrored place.
    pub const ALL: [Self; 7] =
        [Self::Ninth, Self::Sixth, Self::Third, Self::One, Self::Three, Self::Six, Self::Nine];

    /// The pattern with both directions exchanged.
    #[must_use]
    pub const fn turned(self) -> Self {
        Self::ALL[6 - self as usize]
    }

    /// γ.
    #[must_use]
    pub const fn gamma(self) -> f64 {
        [1.0 / 9.0, 1.0 / 6.0, 1.0 / 3.0, 1.0, 3.0, 6.0, 9.0][self as usize]
    }

    #[doc(hidden)]
    pub const fn constants(self) -> &'static Constants {
        &TABLE[self as usize]
    }
}

#[register_model(
    name = "patir_cheng",
    summary = "flow and shear factors of Gaussian rough surfaces by Patir and Cheng",
    equations = "H = h/sigma;  phi_x = 1 - C exp(-r H) (gamma <= 1), 1 + C H^-r (gamma > 1);  phi_y(gamma) = phi_x(1/gamma);  h_T = h/2 [1 + erf(H/sqrt 2)] + sigma exp(-H^2/2)/sqrt(2 pi);  h_c = h_T + sigma phi_s;  Phi_s = A1 H^a1 exp(-a2 H + a3 H^2), A2 exp(-H/4) for H > 5;  Phi_fs = A3 H^a4 exp(-a5 H + a6 H^2);  phi_fp = 1 - D exp(-s H);  phi_f = mean of h/h_local",
    validity = "Gaussian heights, gamma 1/9, 1/6, 1/3, 1, 3, 6 or 9, full films; H above 1 (gamma or 1/gamma of 6 and 9), 0.75 (3) or 0.5 (1). Below, the factors stay at those of 0.05 less than that limit.",
    references = ["patir1978", "patir1979", "wu1989"],
    example = "liner_roughness = \"0.3 um\"\nbody_roughness = \"0.2 um\"\npattern = \"1/3\"\n",
)]
impl RoughnessSpec for PatirCheng {
    fn build(&self) -> Result<Box<dyn Roughness>, BuildError> {
        let (liner, body) = (self.liner_roughness.si(), self.body_roughness.si());
        let sigma = elementary::hypot(liner, body);
        if sigma == 0.0 {
            return Err(BuildError::at("liner_roughness", "both surfaces are smooth")
                .help("use the model `off` for smooth surfaces"));
        }
        if !(sigma.is_normal() && sigma.recip().is_finite()) {
            return Err(BuildError::at(
                "liner_roughness",
                format!("the composite roughness {sigma:e} m is too small or too large to compute with"),
            ));
        }
        let share = |s: f64| (s / sigma) * (s / sigma);
        let (along, across) = (self.pattern.constants(), self.pattern.turned().constants());
        Ok(Box::new(AverageFlow {
            sigma,
            along,
            across,
            liner: (share(liner), self.liner_pattern.unwrap_or(self.pattern).constants()),
            body: (share(body), self.body_pattern.unwrap_or(self.pattern).constants()),
            limit: along.limit.max(across.limit),
        }))
    }
}

#[doc(hidden)]
/// One row of the tables of Patir and Cheng, 1978 (pressure flow) and 1979 (shear flow and stress).
#[derive(Debug)]
pub struct Constants {
    /// `φ_x` is `1 - c exp(-r H)` below γ = 1, `1 + c H^(-r)` above.
    pub c: f64,
    pub r: f64,
    pub transverse: bool,
    /// `H` from which on `φ_x` is meant.
    pub limit: f64,
    /// `A1`, `α1`, `α2`, `α3`, `A2`.
    pub flow: [f64; 5],
    /// `A3`, `α4`, `α5`, `α6`.
    pub stress: [f64; 4],
    /// `D`, `s`.
    pub gradient: [f64; 2],
}

/// The constants as tabulated. How far each was confirmed, the tables themselves not being at hand:
///
/// - `A1`, `α1` to `α3`, `A2`: the two pieces of `Φ_s` meet at `H` = 5 within 0.08 % for every row, which no slip of a digit would.
/// - `C`, `r`: within 1 % (`C` above γ = 1: 5 %) of functions that a public program (R. Boman, EHD, after the same paper) fits to
///   them: `C = 0.8968 - 0.2659 ln γ`, `r = 0.4301 - 0.1083 γ + 0.2382 γ²` for γ <= 1, `C = -0.1067 + 0.1075 γ`, `r = 1.5` above.
/// - The row γ = 1 of `Φ_fs` and `φ_fp`, and `φ_f`: equal in that program.
/// - `Φ_fs` and `φ_fp` of the other rows: from one transcription only; they follow the trends of the row γ = 1.
#[rustfmt::skip]
const TABLE: [Constants; 7] = [
    Constants { c: 1.48, r: 0.42, transverse: true, limit: 1.0, flow: [2.046, 1.12, 0.78, 0.03, 1.856], stress: [14.1, 2.45, 2.30, 0.10], gradient: [1.51, 0.52] },
    Constants { c: 1.38, r: 0.42, transverse: true, limit: 1.0, flow: [1.962, 1.08, 0.77, 0.03, 1.754], stress: [13.4, 2.42, 2.30, 0.10], gradient: [1.51, 0.54] },
    Constants { c: 1.18, r: 0.42, transverse: true, limit: 0.75, flow: [1.858, 1.01, 0.76, 0.03, 1.561], stress: [12.3, 2.32, 2.30, 0.10], gradient: [1.47, 0.58] },
    Constants { c: 0.90, r: 0.56, transverse: true, limit: 0.5, flow: [1.899, 0.98, 0.92, 0.05, 1.126], stress: [11.1, 2.31, 2.38, 0.11], gradient: [1.40, 0.66] },
    Constants { c: 0.225, r: 1.5, transverse: false, limit: 0.5, flow: [1.560, 0.85, 1.13, 0.08, 0.556], stress: [9.8, 2.25, 2.80, 0.18], gradient: [0.98, 0.79] },
    Constants { c: 0.520, r: 1.5, transverse: false, limit: 0.5, flow: [1.290, 0.62, 1.09, 0.08, 0.388], stress: [10.1, 2.25, 2.90, 0.18], gradient: [0.97, 0.91] },
    Constants { c: 0.870, r: 1.5, transverse: false, limit: 0.5, flow: [1.011, 0.54, 1.07, 0.08, 0.295], stress: [8.7, 2.15, 2.97, 0.18], gradient: [0.73, 0.91] },
];

const MODEL: &str = "patir_cheng";
/// Half of the stretch below the validity limit over which the film of the factors comes to rest, so that it ends as far below it.
pub const BLEND: f64 = 0.05;
/// Where the blend of the two pieces of `Φ_s` starts and ends.
const PIECES_MEET: [f64; 2] = [4.5, 5.5];
/// Where `Φ_fs` ends, and where it has passed into zero.
const STRESS_ENDS: [f64; 2] = [7.0, 9.0];
/// Half width of the passage of `φ_fp` into zero.
pub const GRADIENT_BLEND: f64 = 0.01;

#[doc(hidden)]
impl Constants {
    /// `φ_x`.
    #[inline]
    pub fn pressure_flow(&self, gap: f64) -> f64 {
        if self.transverse {
            1.0 - self.c * elementary::exp(-self.r * gap)
        } else {
            1.0 + self.c / (gap * gap.sqrt())
        }
    }

    /// The piece of `Φ_s` for films up to `H` = 5.
    #[inline]
    pub fn shear_flow_near(&self, gap: f64) -> f64 {
        let [a1, e1, e2, e3, _] = self.flow;
        // One exponential for the power and the exponential.
        a1 * elementary::exp(e1 * elementary::ln(gap) - gap * (e2 - e3 * gap))
    }

    /// The piece of `Φ_s` for films from `H` = 5 on.
    #[inline]
    pub fn shear_flow_far(&self, gap: f64) -> f64 {
        self.flow[4] * elementary::exp(-0.25 * gap)
    }

    /// `Φ_s`.
    #[inline]
    pub fn shear_flow(&self, gap: f64) -> f64 {
        let [from, to] = PIECES_MEET;
        if gap <= from {
            self.shear_flow_near(gap)
        } else if gap >= to {
            self.shear_flow_far(gap)
        } else {
            let t = (gap - from) / (to - from);
            let w = t * t * (3.0 - 2.0 * t);
            (1.0 - w) * self.shear_flow_near(gap) + w * self.shear_flow_far(gap)
        }
    }

    /// `Φ_fs`.
    #[inline]
    pub fn shear_stress(&self, gap: f64) -> f64 {
        let [a3, e4, e5, e6] = self.stress;
        let formula = |gap: f64| a3 * elementary::exp(e4 * elementary::ln(gap) - gap * (e5 - e6 * gap));
        let [from, to] = STRESS_ENDS;
        if gap <= from {
            formula(gap)
        } else if gap >= to {
            0.0
        } else {
            // The cubic with the value and the slope of the formula at one end, zero and flat at the other.
            let value = formula(from);
            let slope = value * (e4 / from - e5 + 2.0 * e6 * from) * (to - from);
            let t = (gap - from) / (to - from);
            (1.0 - t) * (1.0 - t) * (value * (1.0 + 2.0 * t) + slope * t)
        }
    }

    /// `φ_fp`.
    #[inline]
    pub fn gradient_stress(&self, gap: f64) -> f64 {
        let [d, s] = self.gradient;
        held_above(1.0 - d * elementary::exp(-s * gap), 0.0, GRADIENT_BLEND)
    }
}

/// Even moments `μ_k = ∫ 35/32 (1 - t²)³ t^(2k) dt` of the height distribution: `μ_(k+1)/μ_k = (2k+1)/(2k+9)`.
const MOMENTS: [f64; 17] = {
    let mut m = [1.0; 17];
    let mut k = 0;
    while k < 16 {
        m[k + 1] = m[k] * (2 * k + 1) as f64 / (2 * k + 9) as f64;
        k += 1;
    }
    m
};

/// `z` from which on `φ_f = Σ μ_k z^(-2k)` is summed: what is left out is below `3^-34`. The closed form loses some `z⁸` of rounding,
/// 3e-13 there.
const SERIES_FROM: f64 = 3.0;

/// `φ_f`: heights distributed as `35/32 (1 - t²)³` over three standard deviations, films cut off at a hundredth of the roughness.
pub fn sliding_stress(z: f64) -> f64 {
    let zz = z * z;
    if z >= SERIES_FROM {
        let y = 1.0 / zz;
        return MOMENTS.iter().rev().fold(0.0, |s, &m| s * y + m);
    }
    let cube = (1.0 - zz) * (1.0 - zz) * (1.0 - zz);
    if z > 1.0 {
        35.0 / 32.0
            * z
            * (cube * elementary::ln((z + 1.0) / (z - 1.0)) + z / 15.0 * (66.0 + zz * (30.0 * zz - 80.0)))
    } else {
        let rest = -55.0 + z * (132.0 + z * (345.0 + z * (-160.0 + z * (-405.0 + z * (60.0 + 147.0 * z)))));
        35.0 / 32.0 * z * (cube * elementary::ln(300.0 * (z + 1.0)) + rest / 60.0)
    }
}

#[derive(Debug)]
struct AverageFlow {
    sigma: f64,
    along: &'static Constants,
    across: &'static Constants,
    /// Share of the roughness, `(σ_i/σ)²`, and constants.
    liner: (f64, &'static Constants),
    body: (f64, &'static Constants),
    limit: f64,
}

impl AverageFlow {
    /// `liner - body` of a function, each weighed with its share.
    #[inline]
    fn difference(&self, f: impl Fn(&Constants) -> f64) -> f64 {
        let ((liner, a), (body, b)) = (self.liner, self.body);
        if std::ptr::eq(a, b) {
            // Equal surfaces cancel, and need not be asked.
            if liner == body { 0.0 } else { (liner - body) * f(a) }
        } else {
            let part = |share: f64, c: &Constants| if share > 0.0 { share * f(c) } else { 0.0 };
            part(liner, a) - part(body, b)
        }
    }

    /// The film of the factors over σ.
    #[inline]
    fn film(&self, gap: f64) -> f64 {
        held_above(gap, self.limit - BLEND, BLEND)
    }
}

impl Roughness for AverageFlow {
    fn held_below(&self) -> Option<f64> {
        Some(self.sigma * self.limit)
    }

    fn flow(&self, h: &[f64], out: &mut RoughFlow) -> Result<(), EvalError> {
        check_flow(MODEL, h, out)?;
        let average = GaussianGap::new();
        let (sigma, inverse) = (self.sigma, self.sigma.recip());
        for (i, &h) in h.iter().enumerate() {
            let gap = h * inverse;
            let film = self.film(gap);
            let (content, slope) = average.at(gap);
            let shear = self.difference(|c| c.shear_flow(film));
            // Below the limit the liner carries a fixed share of the content.
            let carried =
                if film > gap { content * (1.0 + shear / average.at(film).0) } else { content + shear };
            out.film[i] = sigma * film;
            out.phi_x[i] = self.along.pressure_flow(film);
            out.phi_y[i] = if std::ptr::eq(self.along, self.across) {
                out.phi_x[i]
            } else {
                self.across.pressure_flow(film)
            };
            out.transport[i] = sigma * carried;
            out.content[i] = sigma * content;
            out.content_derivative[i] = slope;
        }
        Ok(())
    }

    fn shear(&self, h: &[f64], out: &mut RoughShear) -> Result<(), EvalError> {
        check_shear(MODEL, h, out)?;
        let (sigma, inverse) = (self.sigma, self.sigma.recip());
        for (i, &h) in h.iter().enumerate() {
            let film = self.film(h * inverse);
            out.film[i] = sigma * film;
            out.phi_f[i] = sliding_stress(film / 3.0);
            out.phi_fs[i] = -self.difference(|c| c.shear_stress(film));
            out.phi_fp[i] = self.along.gradient_stress(film);
        }
        Ok(())
    }
}
