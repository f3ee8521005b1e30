//! Integrals over a stretch of a crowned face in its natural coordinate, see [`super::crown`].

use super::moments::angle;

/// Smallest `X` beside `P2` and smallest `P3` beside `P1`: three digits are lost there.
const MIN_PART: f64 = 1e-3;

/// Farthest an angle is moved by the series of the arc tangent up to `z⁷/7`: what is left out is 6e-17.
const SHORT: f64 = 2e-2;

/// A stretch of the face whose one end is fixed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stretch {
    /// The moving end and `1/D` there.
    pub t: f64,
    pub r: f64,
    /// The fixed end.
    pub end: End,
    /// From the lower end to the upper one.
    pub angle: f64,
}

/// An edge of the face.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct End {
    pub t: f64,
    pub r: f64,
    /// 1 when it is the lower end of its stretch, -1 when it is the upper one.
    pub side: f64,
}

/// Integrals over a stretch.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sums {
    pub p1: f64,
    pub p2: f64,
    pub p3: f64,
    pub m2: f64,
    pub m3: f64,
    pub x: f64,
    pub e: f64,
}

impl Sums {
    /// Whether the differences they are made of leave digits enough.
    #[inline(always)]
    pub(super) fn sound(&self) -> bool {
        self.x > MIN_PART * self.p2 && self.p3 > MIN_PART * self.p1
    }
}

impl Stretch {
    #[inline(always)]
    pub(super) fn new(end: End, t: f64) -> Self {
        let r = 1.0 / (1.0 + t * t);
        Self { t, r, end, angle: angle(end.side * (t - end.t), 1.0 + t * end.t) }
    }

    /// With its free end moved by `d`.
    #[inline(always)]
    pub(super) fn moved(self, d: f64) -> Self {
        let t = self.t + d;
        let z = self.end.side * d / (1.0 + self.t * t);
        if z.abs() > SHORT {
            return Self::new(self.end, t);
        }
        let y = z * z;
        let angle = self.angle + (z - z * y * (1.0 / 3.0 - y * (0.2 - y * (1.0 / 7.0))));
        Self { t, r: 1.0 / (1.0 + t * t), angle, ..self }
    }

    #[inline(always)]
    pub(super) fn sums(&self) -> Sums {
        let (End { t: t1, r: r1, side }, t2, r2) = (self.end, self.t, self.r);
        let rr = r1 * r2 * (side * (t2 - t1));
        // Differences of t r, r and t r², upper end less lower end.
        let (d_tr, d_r) = (rr * (1.0 - t1 * t2), -rr * (t1 + t2));
        let d_trr = r2 * d_tr + t1 * r1 * d_r;
        let p2 = 0.5 * (self.angle + d_tr);
        let p3 = 0.75 * p2 + 0.25 * d_trr;
        Sums {
            p1: self.angle,
            p2,
            p3,
            m2: -0.5 * d_r,
            m3: -0.25 * d_r * (r1 + r2),
            x: p2 - p3,
            e: -0.25 * d_r * (t1 * t1 * r1 + t2 * t2 * r2),
        }
    }
}
