//! A face that is one parabola.

use super::crown::Crown;
use super::moments::{Moments, PressureMoments, SERIES, core};
use super::shape::Shape;
use gudgeon_numerics::elementary;

/// One parabola, `d = κ (x - apex)²`.
#[derive(Debug, Clone)]
pub struct Parabola {
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
    /// A face from 0 to `len` \[m\] with the curvature `κ` \[1/m\] of the drop and the place \[m\] of its apex, which may lie beyond the face.
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

    /// The same face seen from its other edge.
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

    /// The part of [`Self::moments`] that the pressure needs.
    fn pressure_moments(&self, xa: f64, xb: f64) -> PressureMoments {
        let (k, h) = (self.curvature, self.h);
        let (a, b) = (xa - self.apex, xb - self.apex);
        let l = xb - xa;
        let (ha, hb) = (h + k * a * a, h + k * b * b);
        let (p, m, kll) = (ha * hb, h + k * a * b, k * l * l);
        if !self.about_apex || k < 0.0 {
            return self.moments(xa, xb).pressure();
        }
        let (_, b1, b2, ip) = core(m, p, h * kll, self.root * l);
        let ip2 = ip * ip;
        let hs = 0.5 * (ha + hb);
        let c = 0.5 * (a + b);
        PressureMoments {
            i3: l * ((hs + 0.5 * kll) * ip2 + 0.25 * kll * kll * b2),
            x3: l * c * hs * ip2,
            d2: k * (l * (m * c * c * ip2 + 0.125 * l * l * b1)),
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
        let i1 = elementary::ln((q * l + m) / p.sqrt()) / q;
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
    fn length(&self) -> f64 {
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
    fn front(&self, _: usize, x: f64) -> PressureMoments {
        self.pressure_moments(0.0, x)
    }
    #[inline]
    fn three(head: &Moments) -> PressureMoments {
        head.pressure()
    }
    #[inline]
    fn complete(&self, _: usize, _: f64, head: &Moments) -> Moments {
        *head
    }
    #[inline]
    fn tail(&self, _: usize, x: f64) -> PressureMoments {
        self.pressure_moments(x, self.len)
    }
    #[inline]
    fn pressure_minimum(&self, _: usize, u: f64, v: f64, q: f64) -> Option<f64> {
        self.zero(u, v, q, true)
    }
    #[inline]
    fn pressure_maximum(&self, _: usize, u: f64, v: f64, q: f64) -> Option<f64> {
        self.zero(u, v, q, false)
    }
}
