//! A panel of a line, or a part of one, and the integrals of a film over it.
//!
//! In a panel the gap is linear, `h = h_m (1 + t w)`, `-1 ≤ w ≤ 1`, and the flux `q` constant, so that
//!
//! ```text
//! p' = 12 μ/φ_p (u φ_s h/2 - q)/h³
//! q  = c θ_a + g (p_a - p_b),   1/g = 12 μ/φ_p ∫dx/h³,   c = u φ_s/2 ∫dx/h² / ∫dx/h³
//! ```
//!
//! exactly, with `θ_a` the filled fraction at the upstream node. All integrals of pressure and shear follow from `t²` and
//! `A1 = (artanh t/t - 1)/t²` without cancellation.

use gudgeon_core::kinds::PanelFactors;
use gudgeon_numerics::elementary;

use super::cavity_shear::Shear;

/// `(artanh t/t - 1)/t²` of `z = t²`, `0 ≤ z < 1`.
#[inline]
fn a1(z: f64) -> f64 {
    if z < 1e-3 {
        // 1e-18 of the series is left out.
        return 1.0 / 3.0 + z * (0.2 + z * (1.0 / 7.0 + z * (1.0 / 9.0 + z * (1.0 / 11.0 + z / 13.0))));
    }
    if z < 0.06 {
        let mut sum = 0.0;
        // 0.06^14/31 = 3e-19.
        for k in (0..14).rev() {
            sum = sum * z + 1.0 / (2 * k + 3) as f64;
        }
        return sum;
    }
    let t = z.sqrt();
    (elementary::atanh(t) / t - 1.0) / z
}

/// Integrals over a panel of full film, of what lies above the straight line between the pressures of its nodes.
pub struct Bulge {
    pub load: f64,
    /// About the middle of the panel, the straight line included.
    pub moment: f64,
    /// `½ ∫ h p' dx`
    pub gradient: f64,
    /// `∫ dx/h`
    pub i1: f64,
}

/// A stretch of a panel.
#[derive(Debug, Clone, Copy)]
pub struct Stretch {
    /// From where.
    pub x: f64,
    pub dx: f64,
    pub ha: f64,
    pub hb: f64,
    pub mu: f64,
    /// `μ/φ_p`
    pub thick: f64,
    /// Slope of the gap.
    pub slope: f64,
    pub rough: PanelFactors,
}

impl Stretch {
    /// Integrals over the stretch under full film with the flux `q` and the sliding velocity `u`.
    #[inline]
    pub fn bulge(&self, u: f64, q: f64, rise: f64) -> Bulge {
        let (dx, f) = (self.dx, &self.rough);
        let r = 2.0 / (self.ha + self.hb);
        let t = 0.5 * (self.hb - self.ha) * r;
        let z = t * t;
        let y = 1.0 / (1.0 - z);
        let a = a1(z);
        let i1 = dx * r * (1.0 + z * a);
        let i2 = dx * r * r * y;
        let uf = u * f.sliding_flow;
        let k = 3.0 * self.thick * dx * dx;
        Bulge {
            load: k * t * r * r * (uf * (y - a) - 2.0 * q * r * y * y),
            moment: 0.125 * dx * dx * rise
                - 0.5 * k * dx * r * r * (0.5 * uf * (y - 2.0 * a) - q * r * (a + z * y * y)),
            gradient: 3.0 * self.thick * (uf * i1 - 2.0 * q * i2) * f.pressure_shear,
            i1,
        }
    }

    /// The part from `x` to the end (`after`), or from the beginning to `x`, where the film is `h`.
    pub fn cut(&self, x: f64, h: f64, after: bool) -> Self {
        if after {
            Self { x, dx: (self.x + self.dx - x).max(0.0), ha: h, ..*self }
        } else {
            Self { dx: (x - self.x).max(0.0), hb: h, ..*self }
        }
    }

    /// Gap that the flux fills without a gradient of pressure; more than any without sliding.
    pub fn filled(&self, u: f64, q: f64) -> f64 {
        let uf = u * self.rough.sliding_flow;
        if uf > 0.0 { 2.0 * q / uf } else { f64::INFINITY }
    }

    /// `∫ θ dx/h` without full film; `layer`: before the film of a starved inlet, where the oil touches one surface alone.
    pub fn wet(&self, u: f64, q: f64, shear: Shear, layer: bool) -> f64 {
        match shear {
            Shear::None => 0.0,
            Shear::Full => self.i1(),
            Shear::Streamers if layer || u == 0.0 => 0.0,
            Shear::Streamers => {
                self.filled(u, q).max(0.0).min(self.ha.max(self.hb)) * self.dx / (self.ha * self.hb)
            }
        }
    }

    /// `∫ dx/h`
    pub fn i1(&self) -> f64 {
        let r = 2.0 / (self.ha + self.hb);
        let t = 0.5 * (self.hb - self.ha) * r;
        self.dx * r * (1.0 + t * t * a1(t * t))
    }

    /// Rise of pressure over it under full film.
    pub fn rise(&self, u: f64, q: f64) -> f64 {
        let r = 1.0 / (self.ha * self.hb);
        let k = 6.0 * self.thick * self.dx * r;
        k * (u * self.rough.sliding_flow - q * (self.ha + self.hb) * r)
    }

    /// Fall of pressure over it for a flux of 1.
    pub fn resistance(&self) -> f64 {
        let r = 1.0 / (self.ha * self.hb);
        6.0 * self.thick * self.dx * (self.ha + self.hb) * r * r
    }

    /// Where the gap is `h`, when that is inside.
    pub fn place(&self, h: f64) -> Option<f64> {
        let inside = (self.ha < h && h < self.hb) || (self.hb < h && h < self.ha);
        inside.then(|| self.x + self.dx * ((h - self.ha) / (self.hb - self.ha)))
    }

    /// Where the pressure, `p` at the end, has come down to nothing, not before `lo`; and the gap there.
    pub fn front(&self, u: f64, q: f64, p: f64, mut lo: f64) -> (f64, f64) {
        let end = self.x + self.dx;
        let gap = |x: f64| self.hb - self.slope * (end - x);
        let k = 12.0 * self.thick;
        let uf = u * self.rough.sliding_flow;
        let (mut hi, mut x) = (end, end);
        for _ in 0..200 {
            let h = gap(x);
            let here = p - self.cut(x, h, true).rise(u, q);
            if here > 0.0 {
                hi = x;
            } else {
                lo = x;
            }
            let step = -here * (h * h * h) / (k * (0.5 * uf * h - q));
            let next = x + step;
            let next = if next > lo && next < hi { next } else { 0.5 * (lo + hi) };
            if next == x || here == 0.0 || hi - lo <= f64::EPSILON * self.dx {
                break;
            }
            x = next;
        }
        (x, gap(x))
    }
}
