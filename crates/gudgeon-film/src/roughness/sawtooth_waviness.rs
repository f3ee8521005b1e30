//! Waves on the body across the sliding direction.

use gudgeon_core::kinds::{RoughFlow, RoughShear, Roughness, RoughnessSpec};
use gudgeon_core::quantity::{PosLength, PosRatio};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_numerics::elementary;
use gudgeon_numerics::vectors::{Vectorised, widest};
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

/// `Ω/h` up to which `artanh(r)/r - 1` is summed, `tanh 0.2`: what is left out is of the order `0.2^22` of it, what the closed form would lose is
/// rounding over `r²/3`.
pub const SERIES: f64 = 0.197_375_320_224_904;

/// Places that lead below [`SERIES`] by `artanh r = artanh c + artanh((r - c)/(1 - r c))`: the `r` from which one serves, the place `c`, and its `artanh c`.
const CENTRES: [[f64; 3]; 4] = [
    [SERIES, 0.379_948_962_255_224_9, 0.4],
    [0.537_049_566_998_035_3, 0.664_036_770_267_849, 0.8],
    [0.761_594_155_955_764_9, 0.833_654_607_012_155_2, 1.2],
    [0.885_351_648_202_262_5, 0.921_668_554_406_471_3, 1.6],
];
/// `Ω/h` up to which the last of them leads there, `tanh 1.8`.
const REACH: f64 = 0.946_806_012_846_268_3;

#[derive(Debug)]
struct Waves {
    omega: f64,
    shear: f64,
    /// Film that the factors end at, in amplitudes.
    closest: f64,
}

impl Waves {
    /// Separation up to which the film is held open.
    fn held_up_to(&self) -> f64 {
        (2.0 * self.closest - 1.0) * self.omega
    }

    /// Films of separations, the smallest of which is `thinnest`.
    fn films(&self, h: &[f64], thinnest: f64, film: &mut [f64]) {
        film.copy_from_slice(h);
        if thinnest < self.held_up_to() {
            let (floor, blend) = (self.closest * self.omega, (self.closest - 1.0) * self.omega);
            for film in film {
                *film = held_above(*film, floor, blend);
            }
        }
    }
}

/// `artanh(r)/r - 1`, `0 <= r < 1`.
pub fn excess(r: f64) -> f64 {
    if r <= REACH { excess_within_reach(r, 1.0) } else { elementary::atanh(r) / r - 1.0 }
}

/// The same for `r = omega/film` up to [`REACH`], without a branch: loops over it work on several values at once.
#[inline(always)]
fn excess_within_reach(omega: f64, film: f64) -> f64 {
    let (mut c, mut angle) = (0.0, 0.0);
    for [from, centre, its_angle] in CENTRES {
        let is_reached = omega > from * film;
        c = if is_reached { centre } else { c };
        angle = if is_reached { its_angle } else { angle };
    }
    let t = (omega - c * film) / (film - c * omega);
    let tt = t * t;
    let mut series = 0.0;
    for k in (0..11).rev() {
        series = series * tt + 1.0 / f64::from(2 * k + 3);
    }
    series *= tt;
    let closed = (angle + t * (1.0 + series)) * film / omega - 1.0;
    if angle == 0.0 { series } else { closed }
}

/// Flow factors of films.
struct Flow<'a> {
    waves: &'a Waves,
    h: &'a [f64],
    thinnest: f64,
    out: &'a mut RoughFlow,
}

impl Vectorised for Flow<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { waves, h, thinnest, out } = self;
        let omega = waves.omega;
        let RoughFlow { film, phi_x, phi_y, transport, content, content_derivative } = out;
        for (((phi_x, phi_y), transport), film) in phi_x.iter_mut().zip(phi_y).zip(transport).zip(&*film) {
            let r = omega / film;
            let rr = r * r;
            *phi_x = (1.0 - rr) * (1.0 - rr);
            *phi_y = 1.0 + rr;
            *transport = film - waves.shear * omega * r;
        }
        if thinnest >= omega {
            content.copy_from_slice(h);
            content_derivative.fill(1.0);
            return;
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
    }
}

/// Factors of the shear stresses of films.
struct Shear<'a> {
    waves: &'a Waves,
    thinnest: f64,
    out: &'a mut RoughShear,
}

impl Vectorised for Shear<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { waves, thinnest, out } = self;
        let omega = waves.omega;
        let RoughShear { film, phi_f, phi_fs, phi_fp } = out;
        let thinnest = thinnest.max(waves.closest * omega);
        if omega <= REACH * thinnest {
            for (e, film) in phi_f.iter_mut().zip(&*film) {
                *e = excess_within_reach(omega, *film);
            }
        } else {
            for (e, film) in phi_f.iter_mut().zip(&*film) {
                *e = excess(omega / film);
            }
        }
        for (((phi_f, phi_fs), phi_fp), film) in phi_f.iter_mut().zip(phi_fs).zip(phi_fp).zip(&*film) {
            let r = omega / film;
            *phi_fs = 3.0 * *phi_f;
            *phi_f += 1.0;
            *phi_fp = 1.0 - r * r;
        }
    }
}

impl Roughness for Waves {
    fn held_below(&self) -> Option<f64> {
        Some(self.held_up_to())
    }

    fn flow(&self, h: &[f64], out: &mut RoughFlow) -> Result<(), EvalError> {
        let thinnest = check_flow(MODEL, h, out)?;
        self.films(h, thinnest, &mut out.film);
        widest(Flow { waves: self, h, thinnest, out });
        Ok(())
    }

    fn shear(&self, h: &[f64], out: &mut RoughShear) -> Result<(), EvalError> {
        let thinnest = check_shear(MODEL, h, out)?;
        self.films(h, thinnest, &mut out.film);
        widest(Shear { waves: self, thinnest, out });
        Ok(())
    }
}
