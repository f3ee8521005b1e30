//! The lightest pin, exactly, with the proof that it is one.
//!
//! Sequential quadratic programming with exact second derivatives on the logarithms of the utilisations, which makes the limits nearly
//! linear. At a corner of three limits the steps are Newton's method on those limits; elsewhere they are Newton's method on the
//! conditions of Karush, Kuhn and Tucker. Both end at rounding, and the conditions are evaluated there and handed out.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{PIN_QUANTITIES, PinQuantity, PinSize};
use gudgeon_numerics::jet::{Jet, Real};
use gudgeon_numerics::qp::{self, HalfSpace, MAX_CONSTRAINTS, QpError};

use crate::design::{Design, Forbids, Masses, corners, grows_with_length};

/// Bounds of the dimensions besides the limits of strength.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Bound {
    /// Smallest length.
    LeastLength,
    /// Greatest length.
    GreatestLength,
    /// Smallest outer diameter.
    LeastOuter,
    /// Greatest outer diameter.
    GreatestOuter,
    /// Smallest inner diameter.
    LeastInner,
    /// Greatest inner diameter.
    GreatestInner,
    /// Thinnest wall.
    LeastWall,
    /// Smallest ratio of the diameters that the model holds for.
    BoreRatio,
}

/// Number of [`Bound`] values.
pub const BOUNDS: usize = 8;

impl Bound {
    /// All of them, in order.
    pub const ALL: [Self; BOUNDS] = [
        Self::LeastLength,
        Self::GreatestLength,
        Self::LeastOuter,
        Self::GreatestOuter,
        Self::LeastInner,
        Self::GreatestInner,
        Self::LeastWall,
        Self::BoreRatio,
    ];

    /// Name in a sentence.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::LeastLength => "smallest length",
            Self::GreatestLength => "greatest length",
            Self::LeastOuter => "smallest outer diameter",
            Self::GreatestOuter => "greatest outer diameter",
            Self::LeastInner => "smallest inner diameter",
            Self::GreatestInner => "greatest inner diameter",
            Self::LeastWall => "thinnest wall",
            Self::BoreRatio => "smallest bore of the model",
        }
    }
}

/// How well the conditions of an optimum hold.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Proof {
    /// Greatest component of the gradient of mass plus multipliers times logarithms of utilisations, by the gradient of the mass.
    pub stationarity: f64,
    /// Greatest utilisation less one; negative or zero when every limit holds exactly.
    pub infeasibility: f64,
    /// Greatest product of a multiplier, over the pin's mass, and the slack of its limit.
    pub complementarity: f64,
    /// Smallest curvature of the mass along the limits, over mass and square of the diameter; absent in a corner, where no direction is
    /// left.
    pub curvature: Option<f64>,
}

impl Proof {
    /// Whether the conditions hold to `rounding`: first order, and curvature where directions are left.
    #[must_use]
    pub fn holds(&self, rounding: f64) -> bool {
        self.stationarity <= rounding
            && self.infeasibility <= rounding
            && self.complementarity <= rounding
            && self.curvature.is_none_or(|c| c >= -rounding)
    }
}

/// The lightest pin.
#[derive(Debug, Clone, PartialEq)]
pub struct Optimum {
    /// Dimensions \[m\].
    pub size: PinSize,
    /// Masses \[kg\].
    pub masses: Masses,
    /// Utilisation of each limit, in the worst corner of the tolerances.
    pub utilisation: [f64; PIN_QUANTITIES],
    /// Mass saved per relative rise of each limit \[kg\].
    pub multipliers: [f64; PIN_QUANTITIES],
    /// Mass saved per length by which a bound gives way \[kg/m\], in the order of [`Bound::ALL`].
    pub bounds: [f64; BOUNDS],
    /// Conditions of the optimum.
    pub proof: Proof,
    /// Quadratic programs solved.
    pub iterations: u32,
}

impl Optimum {
    /// The limits with a multiplier, strongest first.
    #[must_use]
    pub fn active(&self) -> Vec<PinQuantity> {
        let mut out: Vec<_> =
            PinQuantity::ALL.into_iter().filter(|q| self.multipliers[*q as usize] > 0.0).collect();
        out.sort_by(|a, b| self.multipliers[*b as usize].total_cmp(&self.multipliers[*a as usize]));
        out
    }
}

/// Why there is no optimum.
#[derive(Debug, Clone, PartialEq)]
pub enum NoOptimum {
    /// No pin of the ranges keeps the limits; the largest outer diameter is forbidden by these, by its wall when there are none.
    Infeasible(Vec<Forbids>),
    /// The conditions do not close; the best point found.
    Unproven(Box<Optimum>),
    /// The model refused.
    Model(EvalError),
}

/// Closure at rounding.
const CLOSED: f64 = 1e-13;
/// Closure that counts as proof.
pub const PROOF: f64 = 1e-9;
/// Part of the bore that one step leaves.
const SHRINK: f64 = 0.4;
/// Most quadratic programs.
const MOST_STEPS: u32 = 80;

/// Limits and bounds of a design as functions of its scaled dimensions.
struct Program<'a, 'b> {
    design: &'a Design<'b>,
    /// Length of one unit.
    unit: f64,
    /// Mass of one unit.
    mass: f64,
    fixed: [bool; 3],
}

/// One linearisation.
struct Local {
    f: Jet,
    /// Logarithms of the utilisations; only those of finite limits are used.
    limits: [Jet; PIN_QUANTITIES],
}

impl Program<'_, '_> {
    fn size(&self, x: &[f64; 3]) -> PinSize {
        PinSize { length: x[0] * self.unit, outer: x[1] * self.unit, inner: x[2] * self.unit }
    }

    fn mass_jet(&self, s: &PinSize) -> Jet {
        let [l, o, i] = [Jet::variable(s.length, 0), Jet::variable(s.outer, 1), Jet::variable(s.inner, 2)];
        let mut m = self.design.pin_mass(l, o, i);
        if let Some(r) = &self.design.relief {
            m = m - r.mass(l);
        }
        self.scaled(m) / self.mass
    }

    fn scaled(&self, mut j: Jet) -> Jet {
        for g in &mut j.g {
            *g *= self.unit;
        }
        for h in &mut j.h {
            *h *= self.unit * self.unit;
        }
        j
    }

    fn local(&self, x: &[f64; 3]) -> Result<Local, EvalError> {
        let d = self.design;
        let size = self.size(x);
        let (short, long) = corners(&size, &d.tolerance);
        let e = d.strength.expansion(&short, &d.load)?;
        let jet = |e: &gudgeon_core::kinds::PinExpansion, k: usize| Jet {
            v: e.value[k],
            g: e.gradient[k],
            h: e.hessian[k],
        };
        let mut q: [Jet; PIN_QUANTITIES] = std::array::from_fn(|k| jet(&e, k));
        if short != long {
            let w = d.strength.expansion(&long, &d.load)?;
            for k in PinQuantity::ALL.into_iter().filter(|q| grows_with_length(*q)).map(|q| q as usize) {
                q[k] = jet(&w, k);
            }
            let b = q[PinQuantity::BendingStress as usize];
            let o = q[PinQuantity::OvalisationStress as usize];
            q[PinQuantity::ResultantStress as usize] = (b.squared() + o.squared()).sqrt();
        }
        for (q, limit) in q.iter_mut().zip(d.limits) {
            if limit.is_finite() {
                *q = self.scaled((*q / limit).ln());
            }
        }
        Ok(Local { f: self.mass_jet(&size), limits: q })
    }

    /// The bounds as half spaces of the scaled dimensions, where they can bind.
    fn bounds(&self) -> [Option<HalfSpace>; BOUNDS] {
        let (d, u) = (self.design, self.unit);
        let face = |i: usize, sign: f64, at: f64| {
            let mut a = [0.0; 3];
            a[i] = sign;
            (!self.fixed[i] && at.is_finite()).then_some(HalfSpace { a, b: sign * at / u })
        };
        let ratio = d.strength.least_bore_ratio();
        let movable = !(self.fixed[1] && self.fixed[2]);
        [
            face(0, -1.0, d.length.low),
            face(0, 1.0, d.length.high),
            face(1, -1.0, d.outer.low),
            face(1, 1.0, d.outer.high),
            face(2, -1.0, d.inner.low),
            face(2, 1.0, d.inner.high),
            movable.then_some(HalfSpace { a: [0.0, -1.0, 1.0], b: -2.0 * d.least_wall / u }),
            (movable && ratio > 0.0).then_some(HalfSpace { a: [0.0, ratio, -1.0], b: 0.0 }),
        ]
    }

    /// Mass and sum of what the limits are exceeded by.
    fn merit(&self, x: &[f64; 3], weight: f64) -> Option<f64> {
        let size = self.size(x);
        let u = self.design.utilisation(&size).ok()?;
        let over: f64 = u.iter().map(|u| u.ln().max(0.0)).sum();
        let merit = self.design.masses(&size).differential() / self.mass + weight * over;
        merit.is_finite().then_some(merit)
    }
}

/// A pin that keeps every limit, near the lightest one, from some outer diameters with the length that the boss pressure wants.
fn start(d: &Design<'_>) -> Option<PinSize> {
    const TRIALS: usize = 6;
    let mut best: Option<(f64, PinSize)> = None;
    let mut consider = |length: f64, outer: f64, inner: f64| {
        let size = PinSize { length, outer, inner };
        let m = d.masses(&size).differential();
        if best.is_none_or(|(b, _)| m < b) {
            best = Some((m, size));
        }
    };
    for t in 0..TRIALS {
        let outer = d.outer.low + (d.outer.high - d.outer.low) * (t as f64 + 0.5) / TRIALS as f64;
        let inner = d.least_inner(outer);
        let at = PinSize { length: d.length.high, outer, inner };
        let Ok(u) = d.utilisation(&at) else { continue };
        // The pressure falls with the loaded length.
        let play = d.tolerance.length;
        let loaded = (d.length.high - play - d.boss_gap) * u[PinQuantity::BossPressure as usize];
        let short = (d.boss_gap + play + loaded).clamp(d.length.low, d.length.high);
        for stretch in [1.0 + 1e-9, 1.03, 1.1] {
            let length = (short * stretch).min(d.length.high);
            if let Some(inner) = d.bore_within(length, length, outer, 2e-3) {
                consider(length, outer, inner);
                break;
            }
        }
        if d.outer.is_fixed() {
            break;
        }
    }
    if let Some((_, size)) = best {
        return Some(size);
    }
    // The feasible diameters are few: from the smallest of them.
    let outer = d.least_outer()?;
    let outer = (outer + 1e-3 * (d.outer.high - outer)).min(d.outer.high);
    let inner = d.least_inner(outer);
    let middle = 0.5 * (d.length.low + d.length.high);
    Some(PinSize { length: middle, outer, inner })
}

/// The lightest pin of a design near `from`, or from a start of its own.
///
/// # Errors
/// [`NoOptimum`].
pub fn lightest(d: &Design<'_>, from: Option<PinSize>) -> Result<Optimum, NoOptimum> {
    if d.least_inner(d.outer.high) > d.greatest_inner(d.outer.high) {
        // No limit of strength: there is no room for a bore and its wall.
        return Err(NoOptimum::Infeasible(d.forbids(d.outer.high)));
    }
    let from = match from {
        Some(s) => s,
        None => start(d).ok_or_else(|| NoOptimum::Infeasible(d.forbids(d.outer.high)))?,
    };
    let mut found = descend(d, from);
    // A solid pin is stationary in its bore without being the lightest: the mass falls with the square of the bore. From there the search
    // starts again with the greatest bore.
    for _ in 0..2 {
        let Err(NoOptimum::Unproven(o)) = &found else { break };
        let PinSize { length, outer, .. } = o.size;
        // Beyond the rounding of the limits that hold the solid pin; without room even there, from a hollow one that is not admitted.
        let (longer, wider) = (length * (1.0 + 1e-9), outer * (1.0 + 1e-9));
        let inner = d.bore_within(length, longer, wider, 1e-3).map_or(0.3 * outer, |i| 0.98 * i);
        found = descend(d, PinSize { length, outer, inner });
    }
    found
}

fn descend(d: &Design<'_>, from: PinSize) -> Result<Optimum, NoOptimum> {
    let unit = d.outer.high;
    let p = Program {
        design: d,
        unit,
        mass: d.density * unit * unit * unit,
        fixed: [d.length.is_fixed(), d.outer.is_fixed(), d.inner.is_fixed()],
    };
    let clamp = |v: f64, r: crate::design::Range| v.clamp(r.low, r.high.max(r.low)) / unit;
    let mut x = [clamp(from.length, d.length), clamp(from.outer, d.outer), clamp(from.inner, d.inner)];
    let (limits, bounds) = (d.limits, p.bounds());
    // Constraints in one row: limits, then bounds.
    let mut mu = [0.0; PIN_QUANTITIES + BOUNDS];
    let mut at = p.local(&x).map_err(NoOptimum::Model)?;
    let mut iterations = 0;
    let mut settled = 0;
    while iterations < MOST_STEPS {
        iterations += 1;
        let mut rows = [HalfSpace::default(); MAX_CONSTRAINTS];
        let mut from = [0usize; MAX_CONSTRAINTS];
        let mut n = 0;
        for (k, c) in at.limits.iter().enumerate().filter(|(k, _)| limits[*k].is_finite()) {
            let a = std::array::from_fn(|i| if p.fixed[i] { 0.0 } else { c.g[i] });
            // A limit that no free dimension changes is a matter of feasibility, judged at the end.
            if a != [0.0; 3] {
                (rows[n], from[n]) = (HalfSpace { a, b: -c.v }, k);
                n += 1;
            }
        }
        for (k, b) in bounds.iter().enumerate() {
            if let Some(b) = b {
                let mut slack = b.b - (b.a[0] * x[0] + b.a[1] * x[1] + b.a[2] * x[2]);
                if Bound::ALL[k] == Bound::LeastInner {
                    // A bore shrinks by parts: at a solid pin the mass is stationary, and no step would leave it again.
                    slack = slack.min((1.0 - SHRINK) * x[2]);
                }
                let a = std::array::from_fn(|i| if p.fixed[i] { 0.0 } else { b.a[i] });
                (rows[n], from[n]) = (HalfSpace { a, b: slack }, PIN_QUANTITIES + k);
                n += 1;
            }
        }
        let w = hessian(&p, &at, &mu);
        let g: [f64; 3] = std::array::from_fn(|i| if p.fixed[i] { 0.0 } else { at.f.g[i] });
        let Some(m) = step(&w, &g, &mut rows[..n], &from[..n], &mu) else { break };
        mu = [0.0; PIN_QUANTITIES + BOUNDS];
        for k in 0..n {
            mu[from[k]] = m.multipliers[k];
        }
        // Line search on mass and violations.
        let weight = 2.0 * mu[..PIN_QUANTITIES].iter().fold(1.0, |a: f64, b| a.max(*b));
        let length = m.x.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        let before = p.merit(&x, weight);
        let mut scale = 1.0;
        let next = loop {
            let y: [f64; 3] = std::array::from_fn(|i| if p.fixed[i] { x[i] } else { x[i] + scale * m.x[i] });
            // Close by, rounding decides the merit; Newton's step is right without it.
            let fine = length < 1e-6
                || match (p.merit(&y, weight), before) {
                    (Some(a), Some(b)) => a < b,
                    (Some(_), None) => true,
                    (None, _) => false,
                };
            if fine && let Ok(l) = p.local(&y) {
                break Some((y, l));
            }
            scale *= 0.5;
            if scale * length < 1e-16 || scale < 1e-12 {
                break None;
            }
        };
        let Some((y, l)) = next else { break };
        (x, at) = (y, l);
        // Two steps at rounding: the second one's multipliers belong to this very point.
        settled = if length < 1e-13 { settled + 1 } else { 0 };
        if settled == 2 {
            break;
        }
    }
    finish(&p, &x, &at, &mu, iterations).map_err(NoOptimum::Model).and_then(|o| {
        if o.proof.holds(PROOF) {
            return Ok(o);
        }
        let forbids = if d.least_outer().is_none() { d.forbids(d.outer.high) } else { Vec::new() };
        Err(if forbids.is_empty() {
            NoOptimum::Unproven(Box::new(o))
        } else {
            NoOptimum::Infeasible(forbids)
        })
    })
}

/// Second derivatives of mass plus multipliers times limits; one where a dimension is fixed.
fn hessian(p: &Program<'_, '_>, at: &Local, mu: &[f64]) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            if p.fixed[i] || p.fixed[j] {
                return if i == j { 1.0 } else { 0.0 };
            }
            let mut w = at.f.second(i, j);
            for (k, c) in at.limits.iter().enumerate() {
                if mu[k] > 0.0 {
                    w += mu[k] * c.second(i, j);
                }
            }
            w
        })
    })
}

/// The step of the quadratic program. Its Hessian is made positive definite first along the normals of the limits that hold the point,
/// which leaves the step as it is, then in all directions; contradicting limits are approached by parts.
fn step(
    w: &[[f64; 3]; 3],
    g: &[f64; 3],
    rows: &mut [HalfSpace],
    from: &[usize],
    mu: &[f64],
) -> Option<qp::Minimum> {
    let size = w.iter().flatten().fold(1e-12, |a: f64, b| a.max(b.abs()));
    let with = |weight: f64, shift: f64, rows: &[HalfSpace]| {
        let mut h = *w;
        for (r, k) in rows.iter().zip(from) {
            let norm: f64 = r.a.iter().map(|a| a * a).sum();
            if mu[*k] > 0.0 && norm > 0.0 {
                for i in 0..3 {
                    for j in 0..3 {
                        h[i][j] += weight * r.a[i] * r.a[j] / norm;
                    }
                }
            }
        }
        for (i, row) in h.iter_mut().enumerate() {
            row[i] += shift;
        }
        h
    };
    let tries = [
        (0.0, 0.0),
        (2.0 * size, 0.0),
        (10.0 * size, 0.0),
        (10.0 * size, 0.1 * size),
        (10.0 * size, size),
        (0.0, 4.0 * size),
        (0.0, 40.0 * size),
    ];
    let h = tries.into_iter().map(|(a, b)| with(a, b, rows)).find(|h| qp::inverse(h).is_some())?;
    for part in [1.0, 0.5, 0.2, 0.05, 0.0] {
        if part < 1.0 {
            for r in rows.iter_mut().filter(|r| r.b < 0.0) {
                r.b *= part;
            }
        }
        match qp::minimise(&h, g, rows) {
            Ok(m) => return Some(m),
            Err(QpError::NotConvex) => return None,
            Err(QpError::Infeasible | QpError::Stalled) => {}
        }
    }
    None
}

/// Evaluates the conditions at the end.
fn finish(
    p: &Program<'_, '_>,
    x: &[f64; 3],
    at: &Local,
    mu: &[f64; PIN_QUANTITIES + BOUNDS],
    iterations: u32,
) -> Result<Optimum, EvalError> {
    let d = p.design;
    let size = p.size(x);
    let utilisation = d.utilisation(&size)?;
    let mut rest = at.f.g;
    let mut normals = [[0.0; 3]; 3];
    let mut held = 0;
    let mut proof = Proof::default();
    let masses = d.masses(&size);
    let mut hold = |a: [f64; 3], mu: f64, slack: f64, rest: &mut [f64; 3]| {
        for i in 0..3 {
            rest[i] += mu * a[i];
        }
        proof.complementarity = proof.complementarity.max((mu * slack * p.mass / masses.pin).abs());
        if mu > 0.0 && held < 3 {
            normals[held] = std::array::from_fn(|i| if p.fixed[i] { 0.0 } else { a[i] });
            held += 1;
        }
    };
    let mut over: f64 = f64::NEG_INFINITY;
    for k in 0..PIN_QUANTITIES {
        over = over.max(utilisation[k] - 1.0);
        if mu[k] > 0.0 {
            hold(at.limits[k].g, mu[k], at.limits[k].v, &mut rest);
        }
    }
    for (k, b) in p.bounds().iter().enumerate() {
        if let Some(b) = b {
            let slack = b.b - (b.a[0] * x[0] + b.a[1] * x[1] + b.a[2] * x[2]);
            over = over.max(-slack);
            if mu[PIN_QUANTITIES + k] > 0.0 {
                hold(b.a, mu[PIN_QUANTITIES + k], slack, &mut rest);
            }
        }
    }
    let scale = (0..3).filter(|i| !p.fixed[*i]).fold(1e-300, |a: f64, i| a.max(at.f.g[i].abs()));
    proof.stationarity = (0..3).filter(|i| !p.fixed[*i]).fold(0.0, |a: f64, i| a.max(rest[i].abs())) / scale;
    proof.infeasibility = over;
    let w = hessian(p, at, mu);
    proof.curvature = least_curvature(&w, &normals[..held], &p.fixed).map(|c| c * p.mass / masses.pin);
    let factor = p.mass;
    Ok(Optimum {
        size,
        masses,
        utilisation,
        multipliers: std::array::from_fn(|k| mu[k] * factor),
        bounds: std::array::from_fn(|k| mu[PIN_QUANTITIES + k] * factor / p.unit),
        proof,
        iterations,
    })
}

/// Smallest eigenvalue of `w` on the directions that are free and orthogonal to `normals`.
fn least_curvature(w: &[[f64; 3]; 3], normals: &[[f64; 3]], fixed: &[bool; 3]) -> Option<f64> {
    let dot = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let mut taken: [[f64; 3]; 6] = [[0.0; 3]; 6];
    let mut n = 0;
    let mut basis = [[0.0; 3]; 3];
    let mut free = 0;
    let unit = |i: usize| {
        let mut e = [0.0; 3];
        e[i] = 1.0;
        e
    };
    let units = (0..3).filter(|i| fixed[*i]).map(unit);
    let all = units.chain(normals.iter().copied()).map(|v| (v, true)).chain((0..3).map(|i| (unit(i), false)));
    for (mut v, normal) in all {
        let before = dot(&v, &v).sqrt();
        for t in &taken[..n] {
            let c = dot(&v, t);
            for i in 0..3 {
                v[i] -= c * t[i];
            }
        }
        let len = dot(&v, &v).sqrt();
        if len > 1e-9 * before && n < 3 {
            let v = v.map(|c| c / len);
            taken[n] = v;
            n += 1;
            if !normal {
                basis[free] = v;
                free += 1;
            }
        }
    }
    if free == 0 {
        return None;
    }
    // The small matrix by Jacobi rotations.
    let mut m = [[0.0; 3]; 3];
    for i in 0..free {
        for j in 0..free {
            let wb: [f64; 3] = std::array::from_fn(|k| dot(&w[k], &basis[j]));
            m[i][j] = dot(&basis[i], &wb);
        }
    }
    for _ in 0..12 {
        for i in 0..free {
            for j in i + 1..free {
                if m[i][j] == 0.0 {
                    continue;
                }
                let t = 0.5 * (2.0 * m[i][j]).atan2(m[i][i] - m[j][j]);
                let (s, c) = t.sin_cos();
                for k in 0..free {
                    let (a, b) = (m[i][k], m[j][k]);
                    (m[i][k], m[j][k]) = (c * a + s * b, c * b - s * a);
                }
                for row in m.iter_mut().take(free) {
                    let (a, b) = (row[i], row[j]);
                    (row[i], row[j]) = (c * a + s * b, c * b - s * a);
                }
            }
        }
    }
    (0..free).map(|i| m[i][i]).reduce(f64::min)
}

/// Whether an optimum is closed to rounding, 1e-13, as one expects away from degenerate corners.
#[must_use]
pub fn is_sharp(o: &Optimum) -> bool {
    o.proof.stationarity <= CLOSED && o.proof.infeasibility <= CLOSED && o.proof.complementarity <= CLOSED
}
