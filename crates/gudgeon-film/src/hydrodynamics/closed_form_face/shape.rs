//! What the film solver asks of a face.

use super::crown::Crown;
use super::moments::{Moments, PressureMoments};

/// What the film solver asks of a face. Coordinates `x` from 0 to [`Shape::length`]; piece `i` lies between nodes `i` and `i + 1`.
pub trait Shape: Send {
    /// Integrals from 0 as far as they come for free with the pressure.
    type Head: Copy;
    /// Length of the face.
    fn length(&self) -> f64;
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
    /// Pressure integrals from 0 to `x` in piece `i`.
    fn front(&self, i: usize, x: f64) -> PressureMoments {
        Self::three(&self.head(i, x))
    }
    /// The part of a head that the pressure needs.
    fn three(head: &Self::Head) -> PressureMoments;
    /// All integrals from 0 to `x` in piece `i`, of which the head is known.
    fn complete(&self, i: usize, x: f64, head: &Self::Head) -> Moments;
    /// Pressure integrals from `x` in piece `i` to the end.
    fn tail(&self, i: usize, x: f64) -> PressureMoments;
    /// The face as one crown under the present film, if it is one whose film has a natural coordinate.
    fn crown(&mut self) -> Option<&Crown> {
        None
    }
    /// Where `U d + V s - q` goes from negative to positive inside piece `i`: a minimum of pressure.
    fn pressure_minimum(&self, i: usize, u: f64, v: f64, q: f64) -> Option<f64>;
    /// Where it goes from positive to negative: a maximum of pressure.
    fn pressure_maximum(&self, i: usize, u: f64, v: f64, q: f64) -> Option<f64>;

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
