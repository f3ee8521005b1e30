use gudgeon_core::kinds::{RoughFlow, RoughShear, Roughness, RoughnessSpec};
use gudgeon_core::quantity::{PosLength, PosRatio};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use super::held_above;

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

fn closest() -> PosRatio {
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
const SERIES: f64 = 0.2;

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
fn excess(r: f64) -> f64 {
    if r < SERIES {
        let rr = r * r;
        rr * (0..11).rev().fold(0.0, |s, k| s * rr + 1.0 / f64::from(2 * k + 3))
    } else {
        r.atanh() / r - 1.0
    }
}

impl Roughness for Waves {
    fn held_below(&self) -> Option<f64> {
        Some((2.0 * self.closest - 1.0) * self.omega)
    }

    fn flow(&self, h: &[f64], out: &mut RoughFlow) -> Result<(), EvalError> {
        super::check_flow(MODEL, h, out)?;
        let omega = self.omega;
        for (i, &h) in h.iter().enumerate() {
            let film = self.film(h);
            let r = omega / film;
            let rr = r * r;
            out.film[i] = film;
            out.phi_x[i] = (1.0 - rr) * (1.0 - rr);
            out.phi_y[i] = 1.0 + rr;
            out.transport[i] = film - self.shear * omega * r;
            (out.content[i], out.content_slope[i]) = if h >= omega {
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
        super::check_shear(MODEL, h, out)?;
        for (i, &h) in h.iter().enumerate() {
            let film = self.film(h);
            let r = self.omega / film;
            let excess = excess(r);
            out.film[i] = film;
            out.phi_f[i] = 1.0 + excess;
            out.phi_fs[i] = 3.0 * excess;
            out.phi_fp[i] = 1.0 - r * r;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use gudgeon_core::quantity::quantity;
    use gudgeon_numerics::quadrature::GaussLegendre;

    use super::*;
    use crate::roughness::test::{both, slopes_are_continuous};

    const OMEGA: f64 = 4e-6;

    fn model(transport: WavinessTransport) -> Box<dyn Roughness> {
        SawtoothWaviness { amplitude: quantity(OMEGA), transport, closest: closest() }
            .build()
            .expect("builds")
    }

    #[test]
    fn listed_values() {
        // Flow and friction factors for Ω = 4 µm as printed by Loureiro's equations, seven decimals.
        let listed = [
            (10e-6, [1.16, 0.7056, 0.4, 1.0591223, 0.1773670, 0.84]),
            (6.5e-6, [1.3786982, 0.3860158, 0.6153846, 1.1660062, 0.4980185, 0.6213018]),
        ];
        for (h, [phi_y, phi_x, phi_s, phi_f, phi_fs, phi_fp]) in listed {
            let (flow, shear) = both(&*model(WavinessTransport::Homogenised), h);
            let got = [
                (flow.phi_y[0], phi_y),
                (flow.phi_x[0], phi_x),
                ((h - flow.transport[0]) / OMEGA, phi_s),
                (shear.phi_f[0], phi_f),
                (shear.phi_fs[0], phi_fs),
                (shear.phi_fp[0], phi_fp),
            ];
            for (got, listed) in got {
                // A unit of the last decimal: some are cut, not rounded.
                assert!((got - listed).abs() < 1e-7, "{h}: {got} {listed}");
            }
        }
    }

    #[test]
    fn factors_are_the_averages() {
        let rule = GaussLegendre::new(60);
        for r in [1e-4, 0.01, 0.19, 0.21, 0.4, 0.6, 0.8] {
            let h = OMEGA / r;
            // The mean over an even spread of films; 60 nodes resolve (1 - 0.8 t)^-3 to rounding.
            let mean = |n: i32| 0.5 * rule.integrate(-1.0, 1.0, |t| (1.0 + r * t).powi(n));
            let (m1, m2, m3) = (mean(-1), mean(-2), mean(-3));
            let (flow, shear) = both(&*model(WavinessTransport::Homogenised), h);
            let pairs = [
                (flow.phi_x[0], 1.0 / m3),
                (flow.phi_y[0], mean(3)),
                (flow.transport[0] / h, m2 / m3),
                (shear.phi_f[0], m1),
                (shear.phi_fp[0], m2 / m3),
                (flow.content[0] / h, mean(1)),
            ];
            for (i, (got, exact)) in pairs.into_iter().enumerate() {
                // Sums of 60 terms of order one to 124.
                assert!((got - exact).abs() < 1e-13, "{i} at r = {r}: {got} {exact}");
            }
            // The difference of means cancels: the same absolute bound.
            assert!((shear.phi_fs[0] - 3.0 * (m1 - m2 * m2 / m3)).abs() < 3e-13, "{r}");
        }
    }

    #[test]
    fn series_meets_the_closed_form() {
        // Rounding of 1e-16 over the excess 0.0135 at the joint.
        let (below, above) = (excess(SERIES.next_down()), excess(SERIES));
        assert!((below / above - 1.0).abs() < 3e-14, "{below} {above}");
        // r²/3 + r⁴/5 where the closed form has no digit left.
        assert!((excess(1e-7) / (1e-14 / 3.0) - 1.0).abs() < 1e-13);
        assert_eq!(excess(0.0), 0.0);
    }

    #[test]
    fn signs_of_the_transport() {
        let at = |t| both(&*model(t), 8e-6).0.transport[0];
        // h ∓ Ω²/h = 8 ∓ 2 µm, two roundings.
        assert!((at(WavinessTransport::Homogenised) - 6e-6).abs() < 4e-21);
        assert!((at(WavinessTransport::AsPublished) - 10e-6).abs() < 4e-21);
        assert_eq!(at(WavinessTransport::Smooth), 8e-6);
        // Thick films know nothing of it.
        let (flow, shear) = both(&*model(WavinessTransport::Homogenised), 1.0);
        assert!((flow.phi_x[0] - 1.0).abs() < 1e-9 && (flow.transport[0] - 1.0).abs() < 1e-9);
        assert!(shear.phi_fs[0] > 0.0 && shear.phi_fs[0] < 1e-9);
    }

    #[test]
    fn content_is_the_average_gap() {
        let rule = GaussLegendre::new(4);
        for x in [-0.9, -0.3, 0.0, 0.5, 0.999, 1.0, 1.3] {
            // Mean of max(h + Ωt, 0) over -1 < t < 1, from where it opens: a polynomial of degree 1.
            let from = f64::max(-x, -1.0);
            let mean = 0.5 * rule.integrate(from, 1.0, |t| x + t);
            let (flow, _) = both(&*model(WavinessTransport::Smooth), x * OMEGA);
            assert!((flow.content[0] / OMEGA - mean).abs() < 1e-15, "{x}");
        }
    }

    #[test]
    fn smooth_everywhere_and_never_negative() {
        for transport in
            [WavinessTransport::Homogenised, WavinessTransport::AsPublished, WavinessTransport::Smooth]
        {
            let m = model(transport);
            slopes_are_continuous(&*m, OMEGA, &[-1.0, 0.0, 1.0, 1.02, 1.04, 5.0]);
        }
        for h in [-1e300, -1.0, 0.0, 1e-300, 1e-9, 1e300] {
            let (flow, shear) = both(&*model(WavinessTransport::Homogenised), h);
            let values =
                [flow.film, flow.phi_x, flow.phi_y, flow.transport, shear.film, shear.phi_f, shear.phi_fp];
            assert!(values.iter().all(|v| v[0].is_finite() && v[0] > 0.0), "{h}: {values:?}");
            assert!(flow.content[0].is_finite() && flow.content[0] >= 0.0 && shear.phi_fs[0].is_finite());
        }
    }

    #[test]
    fn an_amplitude_that_cannot_be_computed_with_is_refused() {
        let spec = SawtoothWaviness {
            amplitude: quantity(1e-200),
            transport: WavinessTransport::Homogenised,
            closest: closest(),
        };
        assert_eq!(spec.build().err().map(|e| e.field), Some("amplitude".into()));
    }
}
