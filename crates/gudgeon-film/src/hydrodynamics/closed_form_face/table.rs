//! A face of straight lines between nodes.

use super::moments::{Moments, PressureMoments, SERIES, core};
use super::shape::Shape;
use gudgeon_numerics::elementary;

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
pub struct Table {
    len: f64,
    nodes: Vec<f64>,
    drops: Vec<f64>,
    lines: Vec<Line>,
    x_ref: f64,
    lowest: f64,
    convex: bool,
    h: f64,
    parts: Vec<Moments>,
    heads: Vec<PressureMoments>,
    tails: Vec<PressureMoments>,
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
            heads: vec![PressureMoments::default(); n + 1],
            tails: vec![PressureMoments::default(); n + 1],
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

    /// The same face seen from its other edge.
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

    fn stretch(&self, i: usize, xa: f64, xb: f64) -> PressureMoments {
        let (l, dn, df, c, side) = self.sides(i, xa, xb);
        let (hn, hf) = (self.h + dn, self.h + df);
        let ip = 1.0 / (hn * hf);
        let i3 = l * 0.5 * (hn + hf) * ip * ip;
        PressureMoments {
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
            let tau = elementary::ln(hf * hf * ip) * per;
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
    type Head = PressureMoments;

    #[inline]
    fn length(&self) -> f64 {
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
        self.heads.resize(pieces + 1, PressureMoments::default());
        self.tails.resize(pieces + 1, PressureMoments::default());
        self.tails[pieces] = PressureMoments::default();
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
    fn head(&self, i: usize, x: f64) -> PressureMoments {
        self.heads[i].plus(self.stretch(i, self.nodes[i], x))
    }
    #[inline]
    fn three(head: &PressureMoments) -> PressureMoments {
        *head
    }
    #[inline]
    fn complete(&self, i: usize, x: f64, _: &PressureMoments) -> Moments {
        self.span(0, 0.0, i, x)
    }
    #[inline]
    fn tail(&self, i: usize, x: f64) -> PressureMoments {
        self.tails[i + 1].plus(self.stretch(i, x, self.nodes[i + 1]))
    }
    #[inline]
    fn pressure_minimum(&self, i: usize, u: f64, v: f64, q: f64) -> Option<f64> {
        let (n0, n1) = self.slope_term(i, u, v, q);
        (n0 < 0.0 && n1 >= 0.0)
            .then(|| self.nodes[i] + (self.nodes[i + 1] - self.nodes[i]) * (n0 / (n0 - n1)))
            .filter(|x| *x < self.len)
    }
    #[inline]
    fn pressure_maximum(&self, i: usize, u: f64, v: f64, q: f64) -> Option<f64> {
        let (n0, n1) = self.slope_term(i, u, v, q);
        (n0 > 0.0 && n1 <= 0.0)
            .then(|| self.nodes[i] + (self.nodes[i + 1] - self.nodes[i]) * (n0 / (n0 - n1)))
    }
}
