//! Integrals over a line.

use super::panel::Stretch;

/// Integrals over the line, in the direction of sliding.
#[derive(Debug, Clone, Copy, Default)]
pub struct Sums {
    pub load: f64,
    pub moment: f64,
    pub slope: f64,
    pub couette: f64,
    pub gradient: f64,
    /// Shear of sliding that the moving surface has more, and the other less.
    pub difference: f64,
}

impl Sums {
    /// Adds a stretch of full film between the pressures `pa` and `pb` with the flux `q`; `more` is load that a flux changing
    /// along it makes.
    #[inline]
    pub fn film(&mut self, s: &Stretch, u: f64, q: f64, (pa, pb): (f64, f64), more: f64) {
        let b = s.bulge(u, q, pb - pa);
        let part = 0.5 * s.dx * (pa + pb) + b.load + more;
        self.load += part;
        self.moment += b.moment + (s.x + 0.5 * s.dx) * part;
        self.slope -= part * s.slope;
        self.slide(s, u, b.i1);
        self.gradient += b.gradient;
    }

    /// Adds a stretch without full film under the pressure `p`; `wet` is `∫ θ dx/h`.
    #[inline]
    pub fn void(&mut self, s: &Stretch, u: f64, p: f64, wet: f64) {
        let part = p * s.dx;
        self.load += part;
        self.moment += part * (s.x + 0.5 * s.dx);
        self.slope -= p * (s.hb - s.ha);
        self.slide(s, u, wet);
    }

    /// Adds the shear of sliding of a stretch; `wet` is `∫ θ dx/h`.
    #[inline]
    fn slide(&mut self, s: &Stretch, u: f64, wet: f64) {
        let shear = s.mu * u * wet;
        self.couette += shear * s.rough.sliding_shear;
        self.difference += shear * s.rough.shear_difference;
    }

    /// Adds the load on a step of the gap.
    #[inline]
    pub fn step(&mut self, p: f64, height: f64) {
        self.slope -= p * height;
    }
}
