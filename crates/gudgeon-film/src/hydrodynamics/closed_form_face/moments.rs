//! Closed-form integrals of a film under a ring face.
//!
//! A face is a row of pieces, each one parabola or one straight line, with the film `h(x) = h + d(x)`. Pressure, load and
//! shear of a Reynolds film need only eight integrals of each piece ([`Moments`]), and all of them are elementary.
//! They are written here so that nothing cancels: not for a flat face, not for a short piece, not far out on the flank of a
//! thin film, where the textbook primitives (`atan t + t/(1+t²) + …`) lose all digits.
//!
//! With `L = b - a`, `h_a`, `h_b` the film at the ends of a piece of curvature `κ`, `P = h_a h_b`, `m = h + κab` (mean film less
//! `κL²/2`) and `G = P - m²`, everything follows from
//!
//! ```text
//! τ  = (1/L) ∫ dx/h            (one arc tangent, or a logarithm when G < 0)
//! β1 = (τ - m/P) / G
//! β2 = (3 β1/2 - m/P²) / G
//! ```
//!
//! For small `G/m²` both quotients are replaced by the series of `β2 m⁵ = 4/5 ₂F₁(3, 5/2; 7/2; -G/m²)`.

/// Integrals over a part of a face. `s = x - x_ref`, `d` the drop, `h` the film.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Moments {
    /// `∫ dx/h`
    pub i1: f64,
    /// `∫ dx/h²`
    pub i2: f64,
    /// `∫ dx/h³`
    pub i3: f64,
    /// `∫ s dx/h²`
    pub x2: f64,
    /// `∫ s dx/h³`
    pub x3: f64,
    /// `∫ s² dx/h³`
    pub xx3: f64,
    /// `∫ d dx/h³`
    pub d2: f64,
    /// `∫ s d dx/h³`
    pub e2: f64,
}

impl Moments {
    /// Adds the integrals over another part.
    pub fn add(&mut self, o: &Self) {
        self.i1 += o.i1;
        self.i2 += o.i2;
        self.i3 += o.i3;
        self.x2 += o.x2;
        self.x3 += o.x3;
        self.xx3 += o.xx3;
        self.d2 += o.d2;
        self.e2 += o.e2;
    }

    /// Adds the integrand at `s`, where the drop is `d` and the film `h`, with the weight `w`.
    #[inline(always)]
    pub fn sample(&mut self, w: f64, s: f64, d: f64, h: f64) {
        let r = 1.0 / h;
        let w1 = w * r;
        let w2 = w1 * r;
        let w3 = w2 * r;
        let (s3, d3) = (w3 * s, w3 * d);
        self.i1 += w1;
        self.i2 += w2;
        self.i3 += w3;
        self.x2 += w2 * s;
        self.x3 += s3;
        self.xx3 += s3 * s;
        self.d2 += d3;
        self.e2 += d3 * s;
    }

    /// The three that the pressure needs.
    pub const fn pressure(&self) -> PressureMoments {
        PressureMoments { i3: self.i3, x3: self.x3, d2: self.d2 }
    }
}

/// The part of [`Moments`] that the pressure needs.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PressureMoments {
    pub i3: f64,
    pub x3: f64,
    pub d2: f64,
}

impl PressureMoments {
    #[must_use]
    pub fn plus(self, o: Self) -> Self {
        Self { i3: self.i3 + o.i3, x3: self.x3 + o.x3, d2: self.d2 + o.d2 }
    }

    #[must_use]
    pub fn minus(self, o: Self) -> Self {
        Self { i3: self.i3 - o.i3, x3: self.x3 - o.x3, d2: self.d2 - o.d2 }
    }

    /// `∫ (U d + V s - q)/h³ dx`: the pressure rise over `12 μ`.
    pub fn rise(self, u: f64, v: f64, q: f64) -> f64 {
        u * self.d2 + v * self.x3 - q * self.i3
    }
}

/// `4/5 ₂F₁(3, 5/2; 7/2; -z)` for |z| ≤ 1/8, relative error 6e-16 (Chebyshev fit in 40 digits).
fn beta2_series(z: f64) -> f64 {
    const C: [f64; 14] = [
        0.800_000_000_000_000_4,
        -1.714_285_714_285_714_6,
        2.666_666_666_663_971_3,
        -3.636_363_636_360_757_7,
        4.615_384_618_141_866,
        -5.600_000_002_944_925,
        6.588_234_237_290_042,
        -7.578_946_239_643_698,
        8.571_621_191_985_79,
        -9.565_423_130_655_734,
        10.542_025_521_8,
        -11.536_356_001_217_918,
        13.378_117_386_257_337,
        -14.431_186_409_330_149,
    ];
    // In pairs, then Horner in z²: half the latency.
    let zz = z * z;
    let pair = |k: usize| C[k] + C[k + 1] * z;
    let low = pair(0) + zz * (pair(2) + zz * pair(4));
    let high = pair(6) + zz * (pair(8) + zz * (pair(10) + zz * pair(12)));
    low + zz * zz * zz * high
}

/// Widest `|G|/m²` for which the series is used. The quotients lose about `1/z²` of a digit's worth: 2e-14 here.
pub const SERIES: f64 = 0.125;

/// `(τ, β1, β2, 1/P)` of a piece, `root = √G`; see the module text. Long hollow pieces (`G < 0`) have their own ways.
#[inline(always)]
pub fn core(m: f64, p: f64, g: f64, root: f64) -> (f64, f64, f64, f64) {
    let ip = 1.0 / p;
    let mm = m * m;
    if m > 0.0 && g.abs() <= SERIES * mm {
        let n = 1.0 / m;
        let nn = n * n;
        let z = g * nn;
        let b2 = beta2_series(z);
        let r = mm * ip;
        let b1 = (z * b2 + r * r) * (2.0 / 3.0);
        ((r + z * b1) * n, b1 * n * nn, b2 * n * nn * nn, ip)
    } else {
        let ig = 1.0 / g;
        let tau = angle(root, m) * (root * ig);
        let b1 = (tau - m * ip) * ig;
        (tau, b1, (1.5 * b1 - m * ip * ip) * ig, ip)
    }
}

/// Angle of the point `(x, y)`, `y > 0`, to 2 ulp: `y.atan2(x)` without the cases that do not occur here, at half its cost.
/// `(arctan t / t - 1)/t²` up to `t = tan(π/8)` is a Chebyshev fit in `t²`, relative error of the angle 3e-18.
#[inline]
pub fn angle(y: f64, x: f64) -> f64 {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
    const C: [f64; 12] = [
        -0.333_333_333_333_333_3,
        0.199_999_999_999_998_04,
        -0.142_857_142_856_598_28,
        0.111_111_111_051_554_41,
        -0.090_909_087_535_006_36,
        0.076_922_963_750_251_54,
        -0.066_664_248_856_127_43,
        0.058_789_289_963_916_344,
        -0.052_304_542_600_213_69,
        0.045_515_931_721_424_79,
        -0.034_570_560_734_512_43,
        0.016_285_755_473_349_803,
    ];
    let w = x.abs();
    let (low, high) = if y < w { (y, w) } else { (w, y) };
    // Beyond tan(π/8) turn by π/4.
    let turn = low > 0.414_213_562_373_095_03 * high;
    let t = if turn { (low - high) / (low + high) } else { low / high };
    let z = t * t;
    let zz = z * z;
    let pair = |k: usize| C[k] + C[k + 1] * z;
    let sum =
        (pair(0) + zz * (pair(2) + zz * pair(4))) + zz * zz * zz * (pair(6) + zz * (pair(8) + zz * pair(10)));
    let a = t + t * z * sum;
    let a = if turn { FRAC_PI_4 + a } else { a };
    let a = if y < w { a } else { FRAC_PI_2 - a };
    if x < 0.0 { PI - a } else { a }
}
