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

use crate::crown::Crown;

/// Integrals over a part of a face. `s = x - x_ref`, `d` the drop, `h` the film.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Moments {
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
    fn sample(&mut self, w: f64, s: f64, d: f64, h: f64) {
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
    pub const fn pressure(&self) -> Three {
        Three { i3: self.i3, x3: self.x3, d2: self.d2 }
    }
}

/// The part of [`Moments`] that the pressure needs.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Three {
    pub i3: f64,
    pub x3: f64,
    pub d2: f64,
}

impl Three {
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
const SERIES: f64 = 0.125;

/// `(τ, β1, β2, 1/P)` of a piece, `root = √G`; see the module text. Long hollow pieces (`G < 0`) have their own ways.
#[inline(always)]
fn core(m: f64, p: f64, g: f64, root: f64) -> (f64, f64, f64, f64) {
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
pub(crate) fn angle(y: f64, x: f64) -> f64 {
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

/// What the film solver asks of a face. Coordinates `x` from 0 to [`Shape::len`]; piece `i` lies between nodes `i` and `i + 1`.
pub(crate) trait Shape: Send {
    /// Integrals from 0 as far as they come for free with the pressure.
    type Head: Copy;
    /// Length of the face.
    fn len(&self) -> f64;
    /// Number of pieces.
    fn pieces(&self) -> usize;
    /// Position of node `i`.
    fn node(&self, i: usize) -> f64;
    /// Origin of `s`.
    fn x_ref(&self) -> f64;
    /// Drop at `x` in piece `i`.
    fn drop(&self, i: usize, x: f64) -> f64;
    /// Second derivative of the drop.
    fn bend(&self) -> f64;
    /// Slope of the drop at `x` in piece `i`.
    fn slope(&self, i: usize, x: f64) -> f64;
    /// Smallest drop anywhere on the face.
    fn lowest(&self) -> f64;
    /// Smallest drop between `xa` in piece `ia` and `xb` in piece `ib`.
    fn lowest_between(&self, ia: usize, xa: f64, ib: usize, xb: f64) -> f64;
    /// Whether the slope never decreases, so that a film moving along `+x` has one cavity at most.
    fn convex(&self) -> bool;
    /// Confines the face to what lies between `from` and `to` of the whole; `x` then counts from `from`. The film has to be set
    /// again.
    fn crop(&mut self, from: f64, to: f64);
    /// Tilts the face by an angle \[rad\], its top edge towards the liner positive, about its narrowest place: whether the shape can be tilted.
    fn tilt(&mut self, _angle: f64) -> bool {
        false
    }
    /// Fixes the film thickness at zero drop and prepares the integrals of the pieces.
    fn set_film(&mut self, h: f64);
    /// Film thickness at zero drop.
    fn film(&self) -> f64;
    /// Integrals over the whole face.
    fn whole(&mut self) -> Moments;
    /// Integrals from `xa` in piece `ia` to `xb` in piece `ib`.
    fn span(&self, ia: usize, xa: f64, ib: usize, xb: f64) -> Moments;
    /// Integrals from 0 to `x` in piece `i`.
    fn head(&self, i: usize, x: f64) -> Self::Head;
    /// The part of a head that the pressure needs.
    fn three(head: &Self::Head) -> Three;
    /// All integrals from 0 to `x` in piece `i`, of which the head is known.
    fn complete(&self, i: usize, x: f64, head: &Self::Head) -> Moments;
    /// Pressure integrals from `x` in piece `i` to the end.
    fn tail(&self, i: usize, x: f64) -> Three;
    /// The face as one crown under the present film, if it is one whose film has a natural coordinate.
    fn crown(&mut self) -> Option<&Crown> {
        None
    }
    /// Where `U d + V s - q` goes from negative to positive inside piece `i`: a minimum of pressure.
    fn valley(&self, i: usize, u: f64, v: f64, q: f64) -> Option<f64>;
    /// Where it goes from positive to negative: a maximum of pressure.
    fn crest(&self, i: usize, u: f64, v: f64, q: f64) -> Option<f64>;

    /// `s` at `x`.
    #[inline]
    fn s(&self, x: f64) -> f64 {
        x - self.x_ref()
    }

    /// `m`, integrals over a stretch of length `span`, and those from `xa` to `xb` in the same piece `i` added, when those two
    /// are so near that a few samples give them to rounding.
    ///
    /// Between them the film may change by `ε`, by `ε²` beside its tangent, and the stretch by `ε` of its length. Gauss's rule
    /// of three points is off by some `ε⁶/100` of what is added, the midpoint alone by `ε²`.
    #[inline(always)]
    fn nearby(&self, m: &Moments, span: f64, i: usize, xa: f64, xb: f64) -> Option<Moments> {
        const NEAR: f64 = 2e-2;
        const NEXT: f64 = 1e-5;
        let l = xb - xa;
        let mid = 0.5 * (xa + xb);
        let (s, d, slope, bend) = (self.s(mid), self.drop(i, mid), self.slope(i, mid), self.bend());
        let h = self.film() + d;
        let curved = (bend * l * l).abs();
        let change = (slope * l).abs() + 0.5 * curved;
        let mut m = *m;
        if l.abs() <= NEXT * span && change <= NEXT * h && curved <= NEXT * NEXT * h {
            m.sample(l, s, d, h);
        } else if l.abs() <= NEAR * span && change <= NEAR * h && curved <= NEAR * NEAR * h {
            m.sample(4.0 / 9.0 * l, s, d, h);
            let reach = 0.387_298_334_620_741_7 * l;
            let (rise, d) = (slope * reach, d + 0.5 * bend * reach * reach);
            m.sample(5.0 / 18.0 * l, s - reach, d - rise, self.film() + (d - rise));
            m.sample(5.0 / 18.0 * l, s + reach, d + rise, self.film() + (d + rise));
        } else {
            return None;
        }
        Some(m)
    }

    /// The piece that holds `x`.
    #[inline]
    fn piece_of(&self, x: f64) -> usize {
        let mut i = 0;
        while i + 1 < self.pieces() && self.node(i + 1) < x {
            i += 1;
        }
        i
    }
}

/// One parabola, `d = κ (x - apex)²`.
#[derive(Debug, Clone)]
pub(crate) struct Parabola {
    len: f64,
    curvature: f64,
    apex: f64,
    x_ref: f64,
    /// `x_ref` is the apex: every integral is then a sum of like signs on each flank.
    about_apex: bool,
    lowest: f64,
    h: f64,
    /// `√(h κ)`
    root: f64,
    whole: Option<Moments>,
    /// Coordinates of a crowned face under the present film.
    crown: Option<Crown>,
    /// `1/κ`
    radius: f64,
    /// Apex on the whole face.
    uncropped_apex: f64,
    /// How far a tilt has moved it towards the top edge.
    moved: f64,
    /// Where the part begins that the film is confined to.
    from: f64,
}

impl Parabola {
    pub fn new(len: f64, curvature: f64, apex: f64) -> Self {
        let mut face = Self {
            len,
            curvature,
            apex,
            x_ref: 0.0,
            about_apex: false,
            lowest: 0.0,
            h: f64::NAN,
            root: f64::NAN,
            whole: None,
            crown: None,
            radius: 1.0 / curvature,
            uncropped_apex: apex,
            moved: 0.0,
            from: 0.0,
        };
        face.place(len, apex);
        face
    }

    /// Sets what follows from length and apex.
    fn place(&mut self, len: f64, apex: f64) {
        let curvature = self.curvature;
        let inside = (0.0..=len).contains(&apex);
        let (a, b) = (curvature * apex * apex, curvature * (len - apex) * (len - apex));
        (self.len, self.apex) = (len, apex);
        self.x_ref = if inside { apex } else { 0.5 * len };
        self.about_apex = inside;
        self.lowest = if inside { a.min(b).min(0.0) } else { a.min(b) };
        (self.h, self.whole, self.crown) = (f64::NAN, None, None);
    }

    fn apex_on_whole(&self) -> f64 {
        self.uncropped_apex + self.moved
    }

    #[must_use]
    pub fn mirrored(&self) -> Self {
        Self::new(self.len, self.curvature, self.len - self.apex)
    }

    fn moments(&self, xa: f64, xb: f64) -> Moments {
        let (k, h) = (self.curvature, self.h);
        let (a, b) = (xa - self.apex, xb - self.apex);
        let l = xb - xa;
        let (da, db) = (k * a * a, k * b * b);
        let (ha, hb) = (h + da, h + db);
        let (p, m, kll) = (ha * hb, h + k * a * b, k * l * l);
        if k < 0.0 && -h * kll > SERIES * m * m {
            return self.hollow(xa, xb);
        }
        let (tau, b1, b2, ip) = core(m, p, h * kll, self.root * l);
        let ip2 = ip * ip;
        let hs = 0.5 * (ha + hb);
        let c = 0.5 * (a + b);
        let i1 = l * tau;
        let i2 = l * (ip + 0.5 * kll * b1);
        let i3 = l * ((hs + 0.5 * kll) * ip2 + 0.25 * kll * kll * b2);
        let xx3 = l * (m * c * c * ip2 + 0.125 * l * l * b1);
        let d2 = k * xx3;
        if self.about_apex {
            Moments {
                i1,
                i2,
                i3,
                x2: l * c * ip,
                x3: l * c * hs * ip2,
                xx3,
                d2,
                e2: l * c * ip2 * (0.5 * h * (da + db) + da * db),
            }
        } else {
            // About the middle of this piece, then moved: the apex may be metres away.
            let sll = (db - da) * l * l;
            let y2 = -0.25 * sll * b1;
            let y3 = -sll * (0.25 * ip2 + 0.125 * kll * b2);
            let yy3 = l * l * l * (0.125 * b1 + 0.0625 * (db - da) * (db - da) * b2);
            let t = 0.5 * (xa + xb) - self.x_ref;
            Moments {
                i1,
                i2,
                i3,
                x2: y2 + t * i2,
                x3: y3 + t * i3,
                xx3: yy3 + t * (2.0 * y3 + t * i3),
                d2,
                e2: y2 - h * y3 + t * d2,
            }
        }
    }

    /// [`Self::moments`] of a long stretch of a hollow face. When the film nearly vanishes at its ends, `β1` and `β2` are large
    /// differences; the textbook primitives are sums of like signs there.
    #[cold]
    fn hollow(&self, xa: f64, xb: f64) -> Moments {
        let (k, h) = (self.curvature, self.h);
        let (a, b) = (xa - self.apex, xb - self.apex);
        let l = xb - xa;
        let (da, db) = (k * a * a, k * b * b);
        let (ha, hb) = (h + da, h + db);
        let (p, m) = (ha * hb, h + k * a * b);
        let q = (-h * k).sqrt();
        let i1 = ((q * l + m) / p.sqrt()).ln() / q;
        let i2 = 0.5 / h * (i1 + (b / hb - a / ha));
        let i3 = 0.25 / h * (3.0 * i2 + (b / (hb * hb) - a / (ha * ha)));
        let c = 0.5 * (a + b);
        let x2 = l * c / p;
        let x3 = l * c * 0.5 * (ha + hb) / (p * p);
        let xx3 = (i2 - h * i3) / k;
        let d2 = i2 - h * i3;
        let e2 = l * c / (p * p) * (0.5 * h * (da + db) + da * db);
        let t = self.apex - self.x_ref;
        Moments {
            i1,
            i2,
            i3,
            x2: x2 + t * i2,
            x3: x3 + t * i3,
            xx3: xx3 + t * (2.0 * x3 + t * i3),
            d2,
            e2: e2 + t * d2,
        }
    }

    /// The two zeros of `U d + V s - q`: where it rises, where it falls.
    fn zero(&self, u: f64, v: f64, q: f64, rising: bool) -> Option<f64> {
        let a = u * self.curvature;
        let c = v * (self.apex - self.x_ref) - q;
        let disc = v * v - 4.0 * a * c;
        if disc <= 0.0 {
            return None;
        }
        let r = disc.sqrt();
        let t = match (rising, v > 0.0) {
            (true, true) => -2.0 * c / (v + r),
            (true, false) => (r - v) / (2.0 * a),
            (false, true) => -(v + r) / (2.0 * a),
            (false, false) => -2.0 * c / (v - r),
        };
        let x = self.apex + t;
        (x > 0.0 && x < self.len).then_some(x)
    }
}

impl Shape for Parabola {
    type Head = Moments;

    #[inline]
    fn len(&self) -> f64 {
        self.len
    }
    #[inline]
    fn pieces(&self) -> usize {
        1
    }
    #[inline]
    fn node(&self, i: usize) -> f64 {
        if i == 0 { 0.0 } else { self.len }
    }
    #[inline]
    fn x_ref(&self) -> f64 {
        self.x_ref
    }
    #[inline]
    fn drop(&self, _: usize, x: f64) -> f64 {
        self.curvature * (x - self.apex) * (x - self.apex)
    }
    #[inline]
    fn slope(&self, _: usize, x: f64) -> f64 {
        2.0 * self.curvature * (x - self.apex)
    }
    #[inline]
    fn bend(&self) -> f64 {
        2.0 * self.curvature
    }
    fn lowest(&self) -> f64 {
        self.lowest
    }
    fn lowest_between(&self, _: usize, xa: f64, _: usize, xb: f64) -> f64 {
        let ends = self.drop(0, xa).min(self.drop(0, xb));
        if (xa..=xb).contains(&self.apex) { ends.min(0.0) } else { ends }
    }
    fn crop(&mut self, from: f64, to: f64) {
        self.from = from;
        self.place(to - from, self.apex_on_whole() - from);
    }
    /// A parabola stays one, its apex moves by `angle / 2κ`.
    fn tilt(&mut self, angle: f64) -> bool {
        if self.curvature <= 0.0 {
            return false;
        }
        self.moved = 0.5 * angle * self.radius;
        self.place(self.len, self.apex_on_whole() - self.from);
        true
    }
    #[inline]
    fn convex(&self) -> bool {
        self.curvature >= 0.0
    }
    #[inline]
    fn set_film(&mut self, h: f64) {
        if self.h.to_bits() != h.to_bits() {
            self.h = h;
            self.root = (h * self.curvature).max(0.0).sqrt();
            (self.whole, self.crown) = (None, None);
        }
    }
    #[inline]
    fn film(&self) -> f64 {
        self.h
    }
    #[inline]
    fn crown(&mut self) -> Option<&Crown> {
        if self.crown.is_none() && self.about_apex && self.curvature > 0.0 {
            self.crown = Some(Crown::new(self.len, self.apex, self.curvature, self.radius, self.h));
        }
        self.crown.as_ref()
    }
    #[inline]
    fn whole(&mut self) -> Moments {
        if let Some(m) = self.whole {
            return m;
        }
        let m = self.moments(0.0, self.len);
        self.whole = Some(m);
        m
    }
    #[inline]
    fn span(&self, _: usize, xa: f64, _: usize, xb: f64) -> Moments {
        self.moments(xa, xb)
    }
    #[inline]
    fn head(&self, _: usize, x: f64) -> Moments {
        self.moments(0.0, x)
    }
    #[inline]
    fn three(head: &Moments) -> Three {
        head.pressure()
    }
    #[inline]
    fn complete(&self, _: usize, _: f64, head: &Moments) -> Moments {
        *head
    }
    #[inline]
    fn tail(&self, _: usize, x: f64) -> Three {
        self.moments(x, self.len).pressure()
    }
    #[inline]
    fn valley(&self, _: usize, u: f64, v: f64, q: f64) -> Option<f64> {
        self.zero(u, v, q, true)
    }
    #[inline]
    fn crest(&self, _: usize, u: f64, v: f64, q: f64) -> Option<f64> {
        self.zero(u, v, q, false)
    }
}

/// One straight line: its ends, the drops there, and its slope.
#[derive(Debug, Clone, Copy)]
struct Line {
    x0: f64,
    x1: f64,
    d0: f64,
    d1: f64,
    slope: f64,
}

/// Straight lines between nodes.
#[derive(Debug, Clone)]
pub(crate) struct Table {
    len: f64,
    nodes: Vec<f64>,
    drops: Vec<f64>,
    lines: Vec<Line>,
    x_ref: f64,
    lowest: f64,
    convex: bool,
    h: f64,
    parts: Vec<Moments>,
    heads: Vec<Three>,
    tails: Vec<Three>,
    whole: Moments,
    /// Nodes and drops of the whole face.
    uncropped: (Vec<f64>, Vec<f64>),
    /// Drops of the whole face that is not tilted.
    upright: Vec<f64>,
    /// Where the part begins that the film is confined to.
    from: f64,
}

/// Leaves out the nodes of a straight line: those that lie on the line through their neighbours but for the rounding of the
/// drops, a few units of the highest.
fn straighten(nodes: &mut Vec<f64>, drops: &mut Vec<f64>) {
    let highest = drops.iter().fold(0.0_f64, |a, d| a.max(d.abs()));
    let slack = 4.0 * f64::EPSILON * highest;
    let (mut x, mut d) = (vec![nodes[0]], vec![drops[0]]);
    let mut from = 0;
    for to in 2..nodes.len() {
        let slope = (drops[to] - drops[from]) / (nodes[to] - nodes[from]);
        let straight = (from + 1..to)
            .all(|k| (drops[from] + slope * (nodes[k] - nodes[from]) - drops[k]).abs() <= slack);
        if !straight {
            from = to - 1;
            x.push(nodes[from]);
            d.push(drops[from]);
        }
    }
    x.extend(nodes.last());
    d.extend(drops.last());
    (*nodes, *drops) = (x, d);
}

impl Table {
    /// Through two or more nodes (`x`, drop), the first at 0.
    pub fn new(points: &[(f64, f64)]) -> Self {
        let len = points.last().map_or(0.0, |p| p.0);
        let (mut nodes, mut drops): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
        straighten(&mut nodes, &mut drops);
        let mut low = 0;
        for (i, d) in drops.iter().enumerate() {
            if *d < drops[low] {
                low = i;
            }
        }
        Self::with_ref(len, nodes, drops, low)
    }

    fn with_ref(len: f64, nodes: Vec<f64>, drops: Vec<f64>, low: usize) -> Self {
        let n = drops.len() - 1;
        let mut face = Self {
            len,
            x_ref: nodes[low],
            lowest: drops[low],
            convex: false,
            lines: Vec::with_capacity(n),
            uncropped: (nodes.clone(), drops.clone()),
            upright: drops.clone(),
            from: 0.0,
            nodes,
            drops,
            h: f64::NAN,
            parts: vec![Moments::default(); n],
            heads: vec![Three::default(); n + 1],
            tails: vec![Three::default(); n + 1],
            whole: Moments::default(),
        };
        face.join();
        face
    }

    /// Draws the lines between the nodes.
    fn join(&mut self) {
        let (nodes, drops) = (&self.nodes, &self.drops);
        self.lines.clear();
        self.lines.extend((0..drops.len() - 1).map(|i| {
            let (x0, x1, d0, d1) = (nodes[i], nodes[i + 1], drops[i], drops[i + 1]);
            Line { x0, x1, d0, d1, slope: (d1 - d0) / (x1 - x0) }
        }));
        self.convex = self.lines.windows(2).all(|l| l[1].slope >= l[0].slope);
    }

    #[must_use]
    pub fn mirrored(&self) -> Self {
        let n = self.drops.len() - 1;
        let nodes: Vec<f64> = self.nodes.iter().rev().map(|x| self.len - x).collect();
        let drops: Vec<f64> = self.drops.iter().rev().copied().collect();
        let low = self.nodes.iter().position(|x| *x == self.x_ref).unwrap_or(0);
        Self::with_ref(self.len, nodes, drops, n - low)
    }

    /// Near and far end seen from `x_ref`: (length, drop near, drop far, distance of the near end, side).
    #[inline]
    fn sides(&self, i: usize, xa: f64, xb: f64) -> (f64, f64, f64, f64, f64) {
        let (da, db) = (self.drop(i, xa), self.drop(i, xb));
        if self.nodes[i] >= self.x_ref {
            (xb - xa, da, db, xa - self.x_ref, 1.0)
        } else {
            (xb - xa, db, da, self.x_ref - xb, -1.0)
        }
    }

    fn stretch(&self, i: usize, xa: f64, xb: f64) -> Three {
        let (l, dn, df, c, side) = self.sides(i, xa, xb);
        let (hn, hf) = (self.h + dn, self.h + df);
        let ip = 1.0 / (hn * hf);
        let i3 = l * 0.5 * (hn + hf) * ip * ip;
        Three {
            i3,
            x3: side * (c * i3 + 0.5 * l * l * ip / hf),
            d2: l * ip * ip * (0.5 * self.h * (dn + df) + dn * df),
        }
    }

    fn moments(&self, i: usize, xa: f64, xb: f64) -> Moments {
        let (l, dn, df, c, side) = self.sides(i, xa, xb);
        let (hn, hf) = (self.h + dn, self.h + df);
        let (p, hs, sigma) = (hn * hf, 0.5 * (hn + hf), df - dn);
        let ss = sigma * sigma;
        let ip = 1.0 / p;
        let ip2 = ip * ip;
        let i2 = l * ip;
        let i3 = l * hs * ip2;
        // About the near end of the piece: s' from 0 to l, away from x_ref.
        let a3 = 0.5 * l * l * ip2 * hn;
        let (tau, a2, aa3) = if 0.25 * ss <= SERIES * hs * hs {
            let (tau, b1, b2, _) = core(hs, p, -0.25 * ss, 0.0);
            (
                tau,
                l * l * (0.5 * ip - 0.25 * sigma * b1),
                l * l * l * (0.125 * b1 + 0.0625 * ss * b2 + 0.25 * ip2 * (hs - sigma)),
            )
        } else {
            let per = 1.0 / sigma;
            let tau = (hf * hf * ip).ln() * per;
            let a2 = l * l * per * (tau - hn * ip);
            (tau, a2, l * per * (a2 - hn * a3))
        };
        let d2 = l * ip2 * (0.5 * self.h * (dn + df) + dn * df);
        Moments {
            i1: l * tau,
            i2,
            i3,
            x2: side * (c * i2 + a2),
            x3: side * (c * i3 + a3),
            xx3: c * c * i3 + 2.0 * c * a3 + aa3,
            d2,
            e2: side * (c * d2 + dn * a3 + if l > 0.0 { sigma / l * aa3 } else { 0.0 }),
        }
    }

    #[inline]
    fn slope_term(&self, i: usize, u: f64, v: f64, q: f64) -> (f64, f64) {
        let n = |j: usize| u * self.drops[j] + v * (self.nodes[j] - self.x_ref) - q;
        (n(i), n(i + 1))
    }
}

impl Shape for Table {
    type Head = Three;

    #[inline]
    fn len(&self) -> f64 {
        self.len
    }
    #[inline]
    fn pieces(&self) -> usize {
        self.parts.len()
    }
    #[inline]
    fn node(&self, i: usize) -> f64 {
        self.nodes[i]
    }
    #[inline]
    fn x_ref(&self) -> f64 {
        self.x_ref
    }
    #[inline]
    fn drop(&self, i: usize, x: f64) -> f64 {
        // From the nearer node, so that both nodes give their own drop exactly.
        let l = &self.lines[i];
        let (a, b) = (x - l.x0, l.x1 - x);
        if a <= b { l.d0 + l.slope * a } else { l.d1 - l.slope * b }
    }
    #[inline]
    fn slope(&self, i: usize, _: f64) -> f64 {
        self.lines[i].slope
    }
    #[inline]
    fn bend(&self) -> f64 {
        0.0
    }
    fn lowest(&self) -> f64 {
        self.lowest
    }
    fn lowest_between(&self, ia: usize, xa: f64, ib: usize, xb: f64) -> f64 {
        let ends = self.drop(ia, xa).min(self.drop(ib, xb));
        self.drops[ia + 1..=ib].iter().fold(ends, |a, d| a.min(*d))
    }
    #[inline]
    fn convex(&self) -> bool {
        self.convex
    }
    fn crop(&mut self, from: f64, to: f64) {
        let (x, d) = &self.uncropped;
        let n = x.len() - 1;
        // Drop of the whole face at an end of the part.
        let at = |p: f64| {
            let k = x.partition_point(|v| *v <= p).clamp(1, n) - 1;
            d[k] + (d[k + 1] - d[k]) * ((p - x[k]) / (x[k + 1] - x[k]))
        };
        self.nodes.clear();
        self.drops.clear();
        self.nodes.push(0.0);
        self.drops.push(if from <= 0.0 { d[0] } else { at(from) });
        // A node so near to an end that its line would have no slope to speak of belongs to the end.
        let slack = 1e-9 * (to - from);
        for (v, w) in x.iter().zip(d) {
            if *v > from + slack && *v < to - slack {
                self.nodes.push(v - from);
                self.drops.push(*w);
            }
        }
        self.nodes.push(to - from);
        self.drops.push(if to >= x[n] { d[n] } else { at(to) });
        let low = (0..self.drops.len()).fold(0, |l, k| if self.drops[k] < self.drops[l] { k } else { l });
        (self.len, self.x_ref, self.lowest) = (to - from, self.nodes[low], self.drops[low]);
        let pieces = self.drops.len() - 1;
        self.parts.resize(pieces, Moments::default());
        self.heads.resize(pieces + 1, Three::default());
        self.tails.resize(pieces + 1, Three::default());
        self.tails[pieces] = Three::default();
        self.join();
        (self.from, self.h) = (from, f64::NAN);
    }
    /// Straight lines stay straight; the drops count from the narrowest place again.
    fn tilt(&mut self, angle: f64) -> bool {
        let (x, d) = &mut self.uncropped;
        for ((d, x), base) in d.iter_mut().zip(x.iter()).zip(&self.upright) {
            *d = base - angle * x;
        }
        let lowest = |d: &[f64]| d.iter().copied().fold(f64::INFINITY, f64::min);
        let low = lowest(d) - lowest(&self.upright);
        d.iter_mut().for_each(|d| *d -= low);
        self.crop(self.from, self.from + self.len);
        true
    }
    fn set_film(&mut self, h: f64) {
        if self.h.to_bits() == h.to_bits() {
            return;
        }
        self.h = h;
        let n = self.parts.len();
        self.whole = Moments::default();
        for i in 0..n {
            let m = self.moments(i, self.nodes[i], self.nodes[i + 1]);
            self.parts[i] = m;
            self.whole.add(&m);
            self.heads[i + 1] = self.heads[i].plus(m.pressure());
        }
        for i in (0..n).rev() {
            self.tails[i] = self.tails[i + 1].plus(self.parts[i].pressure());
        }
    }
    #[inline]
    fn film(&self) -> f64 {
        self.h
    }
    #[inline]
    fn whole(&mut self) -> Moments {
        self.whole
    }
    fn span(&self, ia: usize, xa: f64, ib: usize, xb: f64) -> Moments {
        if ia == ib {
            return self.moments(ia, xa, xb);
        }
        let mut m =
            if xa == self.nodes[ia] { self.parts[ia] } else { self.moments(ia, xa, self.nodes[ia + 1]) };
        for part in &self.parts[ia + 1..ib] {
            m.add(part);
        }
        if xb == self.nodes[ib + 1] {
            m.add(&self.parts[ib]);
        } else {
            m.add(&self.moments(ib, self.nodes[ib], xb));
        }
        m
    }
    #[inline]
    fn head(&self, i: usize, x: f64) -> Three {
        self.heads[i].plus(self.stretch(i, self.nodes[i], x))
    }
    #[inline]
    fn three(head: &Three) -> Three {
        *head
    }
    #[inline]
    fn complete(&self, i: usize, x: f64, _: &Three) -> Moments {
        self.span(0, 0.0, i, x)
    }
    #[inline]
    fn tail(&self, i: usize, x: f64) -> Three {
        self.tails[i + 1].plus(self.stretch(i, x, self.nodes[i + 1]))
    }
    #[inline]
    fn valley(&self, i: usize, u: f64, v: f64, q: f64) -> Option<f64> {
        let (n0, n1) = self.slope_term(i, u, v, q);
        (n0 < 0.0 && n1 >= 0.0)
            .then(|| self.nodes[i] + (self.nodes[i + 1] - self.nodes[i]) * (n0 / (n0 - n1)))
            .filter(|x| *x < self.len)
    }
    #[inline]
    fn crest(&self, i: usize, u: f64, v: f64, q: f64) -> Option<f64> {
        let (n0, n1) = self.slope_term(i, u, v, q);
        (n0 > 0.0 && n1 <= 0.0)
            .then(|| self.nodes[i] + (self.nodes[i + 1] - self.nodes[i]) * (n0 / (n0 - n1)))
    }
}

#[cfg(test)]
mod tests {
    /// Nodes at equal spacings.
    fn equal(length: f64, drops: &[f64]) -> Vec<(f64, f64)> {
        gudgeon_core::geometry::FaceProfile::Table { length, drops: drops.to_vec() }
            .nodes()
            .unwrap_or_default()
    }
    use super::*;

    /// The integrals by Gauss's 10-point rule on `n` panels.
    fn by_quadrature(n: u32, h: f64, drop: &dyn Fn(f64) -> f64, xa: f64, xb: f64, x_ref: f64) -> Moments {
        const X: [f64; 5] = [
            0.148_874_338_981_631_22,
            0.433_395_394_129_247_2,
            0.679_409_568_299_024_4,
            0.865_063_366_688_984_5,
            0.973_906_528_517_171_7,
        ];
        const W: [f64; 5] = [
            0.295_524_224_714_752_87,
            0.269_266_719_309_996_35,
            0.219_086_362_515_982_04,
            0.149_451_349_150_580_6,
            0.066_671_344_308_688_14,
        ];
        let mut m = Moments::default();
        for k in 0..n {
            let w = 0.5 * (xb - xa) / f64::from(n);
            let c = xa + w * f64::from(2 * k + 1);
            for (x, g) in X.iter().zip(W) {
                for x in [c - w * x, c + w * x] {
                    let (s, d) = (x - x_ref, drop(x));
                    let f = h + d;
                    let g = g * w;
                    m.add(&Moments {
                        i1: g / f,
                        i2: g / (f * f),
                        i3: g / (f * f * f),
                        x2: g * s / (f * f),
                        x3: g * s / (f * f * f),
                        xx3: g * s * s / (f * f * f),
                        d2: g * d / (f * f * f),
                        e2: g * s * d / (f * f * f),
                    });
                }
            }
        }
        m
    }

    fn compare(a: &Moments, b: &Moments, arm: f64, drop: f64, tol: f64, what: &str) {
        let pairs = [
            ("i1", a.i1, b.i1, b.i1),
            ("i2", a.i2, b.i2, b.i2),
            ("i3", a.i3, b.i3, b.i3),
            ("x2", a.x2, b.x2, arm * b.i2),
            ("x3", a.x3, b.x3, arm * b.i3),
            ("xx3", a.xx3, b.xx3, b.xx3),
            ("d2", a.d2, b.d2, b.d2.abs().max(1e-6 * drop * b.i3)),
            ("e2", a.e2, b.e2, arm * b.d2.abs().max(1e-6 * drop * b.i3)),
        ];
        for (name, x, y, size) in pairs {
            assert!((x - y).abs() <= tol * size.abs(), "{what} {name}: {x:e} {y:e} {:e}", (x - y) / size);
        }
    }

    #[test]
    fn parabola_against_quadrature() {
        let l = 1.2e-3;
        for apex in [0.5 * l, 0.3 * l, 0.0, l, -0.1 * l, -2.0 * l, 30.0 * l] {
            for drop in [0.0, 1e-12, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4] {
                for h in [1e-7, 1e-6, 2e-5] {
                    let k = drop / (l * l);
                    let mut p = Parabola::new(l, k, apex);
                    p.set_film(h);
                    for (xa, xb) in
                        [(0.0, l), (0.0, 0.2 * l), (0.9 * l, l), (0.4 * l, 0.45 * l), (0.31 * l, 0.99 * l)]
                    {
                        let q = by_quadrature(400, h, &|x| k * (x - apex) * (x - apex), xa, xb, p.x_ref());
                        let arm = (xa - p.x_ref()).abs().max((xb - p.x_ref()).abs());
                        // The sum over 4000 nodes is itself good to some 1e-13.
                        compare(
                            &p.span(0, xa, 0, xb),
                            &q,
                            arm,
                            drop,
                            3e-13,
                            &format!("{apex} {drop} {h} {xa} {xb}"),
                        );
                    }
                }
            }
            // Hollow: the film vanishes at the farther edge but for a thousandth.
            let k = -1e-6 / (l * l);
            let mut p = Parabola::new(l, k, apex);
            let h = -p.lowest() * 1.001;
            p.set_film(h);
            let q = by_quadrature(8000, h, &|x| k * (x - apex) * (x - apex), 0.0, l, p.x_ref());
            // The film at that edge is known to 1e-13 of itself, and moments about an apex 30 lengths away lose 30².
            compare(&p.span(0, 0.0, 0, l), &q, l, 1e-6, 1e-10, "hollow");
        }
    }

    #[test]
    fn table_against_quadrature() {
        let l = 1.2e-3;
        let drops = [5e-6, 3e-6, 1e-6, 1e-7, 0.0, 0.0, 1e-9, 2e-7, 4e-6, 3.9e-6, 9e-6];
        let mut t = Table::new(&equal(l, &drops));
        for h in [1e-8, 1e-7, 1e-6, 2e-5] {
            t.set_film(h);
            let mut sum = Moments::default();
            for i in 0..t.pieces() {
                let (a, b) = (t.node(i), t.node(i + 1));
                let c = 0.3 * a + 0.7 * b;
                for (xa, xb) in [(a, b), (a, c), (c, b)] {
                    let q = by_quadrature(400, h, &|x| t.drop(i, x), xa, xb, t.x_ref());
                    let arm = (xa - t.x_ref()).abs().max((xb - t.x_ref()).abs());
                    // As above; steep pieces of a thin film end at 1/1000 of their drop.
                    compare(&t.span(i, xa, i, xb), &q, arm, 1e-6, 3e-12, &format!("{h} {i} {xa} {xb}"));
                    if xa == a && xb == b {
                        sum.add(&q);
                    }
                }
            }
            compare(&t.whole(), &sum, l, 1e-6, 3e-12, "whole");
            let (i, x) = (6, 0.65 * l);
            let all = t.head(i, x).plus(t.tail(i, x));
            let w = t.whole().pressure();
            assert!((all.i3 - w.i3).abs() <= 1e-14 * w.i3 && (all.d2 - w.d2).abs() <= 1e-13 * w.d2);
        }
    }

    /// `nearby` from every place to every other that it accepts, against the integrals themselves.
    fn extends<S: Shape>(face: &mut S, film: f64) {
        face.set_film(film);
        let l = face.len();
        let mut accepted = 0;
        for i in 0..face.pieces() {
            let (a, b) = (face.node(i), face.node(i + 1));
            for from in [0.3, 0.5, 0.9] {
                let x0 = a + from * (b - a);
                let m0 = face.span(0, 0.0, i, x0);
                for step in [1e-9, -1e-7, 9e-6, -1e-4, 1e-3, -1e-2, 0.019, 0.1] {
                    let x = x0 + step * x0;
                    if x <= a || x >= b {
                        continue;
                    }
                    let Some(m) = face.nearby(&m0, x, i, x0, x) else { continue };
                    accepted += 1;
                    let want = face.span(0, 0.0, i, x);
                    let arm = face.x_ref().max(l - face.x_ref());
                    // The integrals themselves are good to 3e-13; what the samples add is less.
                    compare(&m, &want, arm, 1e-6, 6e-13, &format!("{film} {i} {x0} {x}"));
                }
            }
        }
        assert!(accepted >= 10, "{accepted}");
    }

    #[test]
    fn integrals_extend_to_places_nearby() {
        let l = 1.2e-3;
        for h in [1e-7, 1e-6, 2e-5] {
            for apex in [0.5 * l, 0.3 * l, -0.1 * l] {
                for drop in [0.0, 1e-9, 1e-6, 1e-5] {
                    extends(&mut Parabola::new(l, drop / (l * l), apex), h);
                }
            }
            extends(&mut Table::new(&equal(l, &[5e-6, 3e-6, 1e-6, 1e-7, 0.0, 0.0, 1e-9, 2e-7, 4e-6])), h);
            extends(&mut Table::new(&equal(l, &[0.0, 35e-6])), h);
        }
    }

    #[test]
    fn straight_lines_are_one_piece() {
        let rise: Vec<f64> = (0..=10).map(|k| 35e-6 * f64::from(k) / 10.0).collect();
        assert_eq!(Table::new(&equal(2.6e-3, &rise)).pieces(), 1);
        assert_eq!(Table::new(&equal(2.6e-3, &[0.0; 7])).pieces(), 1);
        // Kinks stay, also one of a hundred roundings.
        let t = Table::new(&equal(4e-3, &[1e-6, 0.0, 0.0, 0.0, 1e-6 * (1.0 + 1e-13), 2e-6 * (1.0 + 3e-13)]));
        assert_eq!(t.pieces(), 4);
        assert_eq!((t.node(1), t.node(2)), (4e-3 / 5.0, 4e-3 * 3.0 / 5.0));
    }

    #[test]
    fn angle_is_the_arc_tangent() {
        for k in 0..=4000 {
            let y = 1e-6 * 1.01_f64.powi(k - 600);
            for x in [1e-6, -1e-6, 0.0] {
                let (a, b) = (angle(y, x), y.atan2(x));
                assert!((a - b).abs() <= 4.0 * f64::EPSILON * b, "{y} {x} {a} {b}");
            }
        }
    }

    #[test]
    fn series_meets_the_quotients() {
        // On both sides of the change-over the two forms agree, but for what the quotients lose: 1/z and 1/z² of a rounding
        // of the numerators, some eight units.
        let z = SERIES;
        let below = core(1.0, 1.0 + z, z * (1.0 - 1e-15), z.sqrt());
        let above = core(1.0, 1.0 + z, z * (1.0 + 1e-15), z.sqrt());
        assert!((below.0 - above.0).abs() < 2e-15);
        assert!((below.1 - above.1).abs() < 2e-14);
        assert!((below.2 - above.2).abs() < 3e-13);
    }
}
