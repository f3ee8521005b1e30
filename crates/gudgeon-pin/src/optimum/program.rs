//! Mass, limits and bounds of a design as functions of its scaled dimensions: length, outer and inner diameter over one unit.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{PIN_QUANTITIES, PinExpansion, PinQuantity, PinSize};
use gudgeon_numerics::elementary;
use gudgeon_numerics::jet::{Jet, PAIRS, Real};
use gudgeon_numerics::qp::{HalfSpace, MAX_CONSTRAINTS, Minimum};

use super::result::{BOUNDS, Bound};
use crate::design::{Design, GROWING_WITH_LENGTH, Range, corners};

/// Limits, then bounds.
pub const CONSTRAINTS: usize = PIN_QUANTITIES + BOUNDS;

/// Multipliers of the limits, then of the bounds.
pub type Multipliers = [f64; CONSTRAINTS];

/// Part of the bore that one step leaves.
const SHRINK: f64 = 0.4;

/// A nonlinear program of three variables.
pub struct Program<'a, 'b> {
    pub design: &'a Design<'b>,
    /// Length of one unit \[m\].
    pub unit: f64,
    /// Mass of one unit \[kg\].
    pub mass: f64,
    pub fixed: [bool; 3],
    /// Bounds of the scaled dimensions, where they can bind.
    pub bounds: [Option<HalfSpace>; BOUNDS],
}

/// Mass and limits with first and second derivatives at one point.
#[derive(Default)]
pub struct Expansion {
    pub mass: Jet,
    /// Logarithms of the utilisations; zero where there is no limit.
    pub limits: [Jet; PIN_QUANTITIES],
}

impl<'a, 'b> Program<'a, 'b> {
    pub fn new(design: &'a Design<'b>) -> Self {
        let unit = design.outer.high;
        let fixed = [design.length.is_fixed(), design.outer.is_fixed(), design.inner.is_fixed()];
        let bounds = bounds(design, unit, fixed);
        Self { design, unit, mass: design.density * unit * unit * unit, fixed, bounds }
    }

    /// The scaled dimensions of a pin, moved into the ranges.
    pub fn point_within_ranges(&self, s: &PinSize) -> [f64; 3] {
        let d = self.design;
        let clamp = |v: f64, r: Range| v.clamp(r.low, r.high.max(r.low)) / self.unit;
        [clamp(s.length, d.length), clamp(s.outer, d.outer), clamp(s.inner, d.inner)]
    }

    pub fn size(&self, x: &[f64; 3]) -> PinSize {
        PinSize { length: x[0] * self.unit, outer: x[1] * self.unit, inner: x[2] * self.unit }
    }

    /// A gradient without the components of fixed dimensions.
    pub fn free(&self, g: &[f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| if self.fixed[i] { 0.0 } else { g[i] })
    }

    /// `x + scale·step` in the free dimensions.
    pub fn moved(&self, x: &[f64; 3], scale: f64, step: &[f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| if self.fixed[i] { x[i] } else { x[i] + scale * step[i] })
    }

    /// Derivatives by metres become derivatives by units.
    fn scaled(&self, mut j: Jet) -> Jet {
        for g in &mut j.g {
            *g *= self.unit;
        }
        for h in &mut j.h {
            *h *= self.unit * self.unit;
        }
        j
    }

    fn mass_expansion(&self, s: &PinSize) -> Jet {
        let [l, o, i] = [Jet::variable(s.length, 0), Jet::variable(s.outer, 1), Jet::variable(s.inner, 2)];
        let mut m = self.design.pin_mass(l, o, i);
        if let Some(r) = &self.design.relief {
            m = m - r.mass(l);
        }
        self.scaled(m) / self.mass
    }

    /// Takes mass and limits around a point; what was there stays where there are none.
    pub fn expand(&self, x: &[f64; 3], at: &mut Expansion) -> Result<(), EvalError> {
        let (d, size) = (self.design, self.size(x));
        let (short, long) = corners(&size, &d.tolerance);
        let of_short = d.strength.expansion(&short, &d.load)?;
        let of_long = (short != long).then(|| d.strength.expansion(&long, &d.load)).transpose()?;
        for (k, limit) in d.limits.iter().enumerate().filter(|(_, limit)| limit.is_finite()) {
            at.limits[k] = match &of_long {
                Some(long) if k == PinQuantity::ResultantStress as usize => {
                    self.utilised(&resultant(&of_short, long), *limit)
                }
                Some(long) if GROWING_WITH_LENGTH.iter().any(|q| *q as usize == k) => {
                    self.utilised(&jet(long, k), *limit)
                }
                _ => self.utilised(&jet(&of_short, k), *limit),
            };
        }
        at.mass = self.mass_expansion(&size);
        Ok(())
    }

    /// Logarithm of a quantity over its limit, with derivatives by units.
    fn utilised(&self, q: &Jet, limit: f64) -> Jet {
        let r = self.unit / q.v;
        let g = q.g.map(|g| r * g);
        let second = r * self.unit;
        let h = std::array::from_fn(|k| {
            let (i, j) = PAIRS[k];
            second * q.h[k] - g[i] * g[j]
        });
        Jet { v: elementary::ln(q.v / limit), g, h }
    }

    /// Mass and weighted sum of the logarithms by which limits are exceeded.
    pub fn merit(&self, x: &[f64; 3], weight: f64) -> Option<f64> {
        let size = self.size(x);
        let u = self.design.utilisation(&size).ok()?;
        let over: f64 = u.iter().filter(|u| **u > 1.0).map(|u| elementary::ln(*u)).sum();
        let merit = self.design.masses(&size).differential() / self.mass + weight * over;
        merit.is_finite().then_some(merit)
    }

    /// The same where the expansion is known.
    pub fn merit_of(&self, at: &Expansion, weight: f64) -> f64 {
        at.mass.v + weight * at.limits.iter().map(|l| l.v.max(0.0)).sum::<f64>()
    }

    /// Hessian of the Lagrangian: second derivatives of mass plus multipliers times limits; one where a dimension is fixed.
    pub fn lagrangian_hessian(&self, at: &Expansion, mu: &Multipliers) -> [[f64; 3]; 3] {
        let mut sum = at.mass.h;
        for (c, mu) in at.limits.iter().zip(mu).filter(|(_, mu)| **mu > 0.0) {
            sum.iter_mut().zip(c.h).for_each(|(sum, h)| *sum += mu * h);
        }
        let mut w = [[0.0; 3]; 3];
        for (h, (i, j)) in sum.into_iter().zip(PAIRS) {
            let one = if i == j { 1.0 } else { 0.0 };
            let own = if self.fixed[i] || self.fixed[j] { one } else { h };
            (w[i][j], w[j][i]) = (own, own);
        }
        w
    }
}

/// A quantity with its derivatives by metres.
fn jet(e: &PinExpansion, k: usize) -> Jet {
    Jet { v: e.value[k], g: e.gradient[k], h: e.hessian[k] }
}

/// The resultant stress from its parts in the corners of the tolerances where each is worst.
fn resultant(short: &PinExpansion, long: &PinExpansion) -> Jet {
    let bending = jet(long, PinQuantity::BendingStress as usize);
    let ovalisation = jet(short, PinQuantity::OvalisationStress as usize);
    (bending.squared() + ovalisation.squared()).sqrt()
}

/// What is left of a bound at a point; negative where it is violated.
pub fn slack(bound: &HalfSpace, x: &[f64; 3]) -> f64 {
    bound.b - (bound.a[0] * x[0] + bound.a[1] * x[1] + bound.a[2] * x[2])
}

fn bounds(d: &Design<'_>, unit: f64, fixed: [bool; 3]) -> [Option<HalfSpace>; BOUNDS] {
    let face = |i: usize, sign: f64, at: f64| {
        let mut a = [0.0; 3];
        a[i] = sign;
        (!fixed[i] && at.is_finite()).then_some(HalfSpace { a, b: sign * at / unit })
    };
    let ratio = d.strength.min_bore_ratio();
    let movable = !(fixed[1] && fixed[2]);
    [
        face(0, -1.0, d.length.low),
        face(0, 1.0, d.length.high),
        face(1, -1.0, d.outer.low),
        face(1, 1.0, d.outer.high),
        face(2, -1.0, d.inner.low),
        face(2, 1.0, d.inner.high),
        movable.then_some(HalfSpace { a: [0.0, -1.0, 1.0], b: -2.0 * d.min_wall / unit }),
        (movable && ratio > 0.0).then_some(HalfSpace { a: [0.0, ratio, -1.0], b: 0.0 }),
    ]
}

/// Limits and bounds linearised at a point, as half spaces of the step from there.
pub struct Linearised {
    pub rows: [HalfSpace; MAX_CONSTRAINTS],
    /// Place of every row among the constraints.
    pub place: [usize; MAX_CONSTRAINTS],
    pub n: usize,
}

impl Linearised {
    pub fn new(p: &Program<'_, '_>, at: &Expansion, x: &[f64; 3]) -> Self {
        let mut out =
            Self { rows: [HalfSpace::default(); MAX_CONSTRAINTS], place: [0; MAX_CONSTRAINTS], n: 0 };
        for (k, c) in at.limits.iter().enumerate().filter(|(k, _)| p.design.limits[*k].is_finite()) {
            let a = p.free(&c.g);
            // A limit that no free dimension changes is a matter of feasibility, judged at the end.
            if a != [0.0; 3] {
                out.push(HalfSpace { a, b: -c.v }, k);
            }
        }
        for (k, bound) in p.bounds.iter().enumerate() {
            let Some(bound) = bound else { continue };
            let mut b = slack(bound, x);
            if Bound::ALL[k] == Bound::MinInner {
                // A bore shrinks by parts: at a solid pin the mass is stationary, and no step would leave it again.
                b = b.min((1.0 - SHRINK) * x[2]);
            }
            out.push(HalfSpace { a: p.free(&bound.a), b }, PIN_QUANTITIES + k);
        }
        out
    }

    fn push(&mut self, row: HalfSpace, place: usize) {
        (self.rows[self.n], self.place[self.n]) = (row, place);
        self.n += 1;
    }

    /// The multipliers of a step, by constraint.
    pub fn multipliers(&self, m: &Minimum) -> Multipliers {
        let mut mu = [0.0; CONSTRAINTS];
        for (place, multiplier) in self.place.iter().zip(m.multipliers).take(self.n) {
            mu[*place] = multiplier;
        }
        mu
    }
}
