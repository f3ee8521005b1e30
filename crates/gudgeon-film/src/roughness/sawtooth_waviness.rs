//! Waves on the body across the sliding direction.

use gudgeon_core::kinds::{RoughFlow, RoughShear, Roughness, RoughnessSpec};
use gudgeon_core::quantity::{PosLength, PosRatio};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_numerics::elementary;
use serde::{Deserialize, Serialize};

use super::checks::{check_flow, check_shear};
use super::held_above::held_above;

/// Machining grooves of triangular profile across the sliding direction on the body, exactly homogenised.
///
/// The local film is spread evenly over `h - Ω … h + Ω`. With `⟨·⟩` the mean over it and `r = Ω/h`:
///
/// ```text
/// φ_x  = 1/(h³ ⟨h⁻³⟩)               = (1 - r²)²
/// φ_y  = ⟨h³⟩/h³                    = 1 + r²
/// h_c  = ⟨h⁻²⟩/⟨h⁻³⟩                = h - Ω r
/// φ_f  = h ⟨h⁻¹⟩                    = artanh(r)/r
/// φ_fs = 3h (⟨h⁻¹⟩ - ⟨h⁻²⟩²/⟨h⁻³⟩)  = 3 (φ_f - 1)
/// φ_fp = ⟨h⁻²⟩/(h ⟨h⁻³⟩)            = 1 - r²
/// h_T  = ⟨max(h, 0)⟩                = h,  (h + Ω)²/(4Ω) for |h| < Ω
/// ```
///
/// The factors are singular where crests touch, at `h = Ω`. From `1.04 Ω` on they are those of a film that passes with continuous
/// slope into `1.02 Ω` (`closest`) and stays there; the film content follows the real separation.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SawtoothWaviness {
    /// Amplitude Ω of the waviness: half the distance from trough to crest.
    pub amplitude: PosLength,
    /// How the waves change the flow that the sliding liner carries along.
    #[serde(default)]
    pub transport: WavinessTransport,
    /// Film, in amplitudes, that the factors end at: below twice its distance from 1 the film is held open. The nearer to 1, the higher the pressures that a
    /// film between touching crests takes. From 1.001 to 2.
    #[serde(default = "closest")]
    pub closest: PosRatio,
}

/// Default of [`SawtoothWaviness::closest`].
pub fn closest() -> PosRatio {
    gudgeon_core::quantity::quantity(1.02)
}

/// Couette flow between a plane liner and a wavy body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WavinessTransport {
    /// `h_c = h - Ω²/h`: exact (`k_s = +1` in the equations of Loureiro). Waves strengthen the wedge of a tilted side: the EA111 piston is drawn to
    /// one side until its crests touch.
    #[default]
    Homogenised,
    /// `h_c = h + Ω²/h`: the sign that the program of Loureiro has (`k_s = -1`), by which waves weaken the wedge; what reproduces his results.
    AsPublished,
    /// `h_c = h`: the waves do not change it (`k_s = 0`).
    Smooth,
}

#[register_model(
    name = "sawtooth_waviness",
    summary = "triangular machining grooves across the sliding direction, exactly homogenised",
    equations = "r = Omega/h;  phi_x = (1 - r^2)^2;  phi_y = 1 + r^2;  h_c = h - k Omega r, k = 1 (homogenised), -1 (as_published), 0 (smooth);  phi_f = artanh(r)/r;  phi_fs = 3 (phi_f - 1);  phi_fp = 1 - r^2;  h_T = h, (h + Omega)^2/(4 Omega) for |h| < Omega",
    validity = "Waves much shorter than the film's length and much longer than its thickness, on the body that the frame moves with; full films, h > 1.04 Omega. Below, all but the film content are those of h = 1.02 Omega (closest).",
    references = ["loureiro2009", "elrod1979"],
    example = "amplitude = \"4 um\"\ntransport = \"homogenised\"\nclosest = 1.02\n",
)]
impl RoughnessSpec for SawtoothWaviness {
    fn build(&self) -> Result<Box<dyn Roughness>, BuildError> {
        let omega = self.amplitude.si();
        if !(omega.recip().is_finite() && (omega * omega).is_normal()) {
            return Err(BuildError::at(
                "amplitude",
                format!("the amplitude {omega:e} m is too small or too large to compute with"),
            ));
        }
        let shear = match self.transport {
            WavinessTransport::Homogenised => 1.0,
            WavinessTransport::AsPublished => -1.0,
            WavinessTransport::Smooth => 0.0,
        };
        let closest = self.closest.si();
        if !(1.001..=2.0).contains(&closest) {
            return Err(BuildError::at("closest", format!("must be between 1.001 and 2, not {closest}")));
        }
        Ok(Box::new(Waves { omega, shear, closest }))
    }
}

const MODEL: &str = "sawtooth_waviness";

/// `Ω/h` up to which `artanh(r)/r - 1` is summed: what is left out is of the order `0.2^22` of it, what the closed form would lose is
/// rounding over `r²/3`.
pub const SERIES: f64 = 0.2;

/// `Ω/h` up to which `artanh(r) = 2 artanh(r/(1 + √(1 - r²)))`, three times over, leads below [`SERIES`]: `tanh(8 artanh(0.2)) = 0.925`.
const HALVED: f64 = 0.92;

#[derive(Debug)]
struct Waves {
    omega: f64,
    shear: f64,
    /// Film that the factors end at, in amplitudes.
    closest: f64,
}

impl Waves {
    #[inline]
    fn film(&self, h: f64) -> f64 {
        held_above(h, self.closest * self.omega, (self.closest - 1.0) * self.omega)
    }
}

/// `artanh(r)/r - 1`, `0 <= r < 1`.
pub fn excess(r: f64) -> f64 {
    if r <= HALVED { excess_of_halves(r) } else { elementary::atanh(r) / r - 1.0 }
}

/// The same for `r` up to [`HALVED`], without a branch: loops over it work on several values at once.
#[inline(always)]
fn excess_of_halves(r: f64) -> f64 {
    let half = |x: f64| x / (1.0 + (1.0 - x * x).sqrt());
    let is_small = r < SERIES;
    let divided = half(half(half(r)));
    let u = if is_small { r } else { divided };
    let uu = u * u;
    let series = uu * (0..11).rev().fold(0.0, |s, k| s * uu + 1.0 / f64::from(2 * k + 3));
    let closed = 8.0 * (divided / r) * (1.0 + series) - 1.0;
    if is_small { series } else { closed }
}

impl Roughness for Waves {
    fn held_below(&self) -> Option<f64> {
        Some((2.0 * self.closest - 1.0) * self.omega)
    }

    fn flow(&self, h: &[f64], out: &mut RoughFlow) -> Result<(), EvalError> {
        check_flow(MODEL, h, out)?;
        let omega = self.omega;
        let RoughFlow { film, phi_x, phi_y, transport, content, content_derivative } = out;
        film.iter_mut().zip(h).for_each(|(film, h)| *film = self.film(*h));
        let factors = phi_x.iter_mut().zip(phi_y).zip(transport);
        for (((phi_x, phi_y), transport), film) in factors.zip(&*film) {
            let r = omega / film;
            let rr = r * r;
            *phi_x = (1.0 - rr) * (1.0 - rr);
            *phi_y = 1.0 + rr;
            *transport = film - self.shear * omega * r;
        }
        for ((content, slope), &h) in content.iter_mut().zip(content_derivative).zip(h) {
            (*content, *slope) = if h >= omega {
                (h, 1.0)
            } else if h > -omega {
                let up = h + omega;
                (0.25 * up * up / omega, 0.5 * up / omega)
            } else {
                (0.0, 0.0)
            };
        }
        Ok(())
    }

    fn shear(&self, h: &[f64], out: &mut RoughShear) -> Result<(), EvalError> {
        check_shear(MODEL, h, out)?;
        let RoughShear { film, phi_f, phi_fs, phi_fp } = out;
        film.iter_mut().zip(h).for_each(|(film, h)| *film = self.film(*h));
        let thinnest = film.iter().fold(f64::INFINITY, |a, &b| if b < a { b } else { a });
        if self.omega <= HALVED * thinnest {
            phi_f.iter_mut().zip(&*film).for_each(|(e, film)| *e = excess_of_halves(self.omega / film));
        } else {
            phi_f.iter_mut().zip(&*film).for_each(|(e, film)| *e = excess(self.omega / film));
        }
        for ((phi_f, phi_fs), (phi_fp, film)) in
            phi_f.iter_mut().zip(phi_fs).zip(phi_fp.iter_mut().zip(&*film))
        {
            let r = self.omega / film;
            *phi_fs = 3.0 * *phi_f;
            *phi_f += 1.0;
            *phi_fp = 1.0 - r * r;
        }
        Ok(())
    }
}
