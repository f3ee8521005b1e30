//! A cycle surveyed: extremes, integrals and crossings from the motion itself, whatever rows of it are shown.

use gudgeon_core::EvalError;

use super::row::{Look, Row};
use super::spectrum::Piece;
use super::trajectory::Between;

/// An instant that was looked at.
struct Node {
    /// Crank angle \[rad\].
    t: f64,
    row: Row,
    /// Contact gap of each side, less the range of contact \[m\].
    contact_gap: [f64; 2],
    /// Whether something jumps or bends between the node before and this one, which stand at the same angle.
    bent: bool,
}

/// A cycle, looked at where its steps end and halfway between.
pub struct Survey {
    nodes: Vec<Node>,
    /// The node at the start of every step, and how many more belong to it.
    steps: Vec<usize>,
    more: usize,
    omega: f64,
}

/// Crank angle \[rad\] and value.
type Place = (f64, f64);

/// Which extreme.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Which {
    /// The largest value.
    Max,
    /// The smallest value.
    Min,
}

/// Parabolas that are followed to a peak.
const FOLLOWED: usize = 3;
/// Places that are looked at on the way to one.
const LOOKS: usize = 5;
/// Gain of a look, as part of the value, below which a peak is found.
const FOUND: f64 = 1e-9;
/// Part of the way between the neighbours of a peak within which two looks see the same.
const SAME: f64 = 1e-4;
/// Rise of a function, as part of its largest value, that is none.
const ROUNDING: f64 = 1e-9;
/// Part of the way from a neighbour to a peak at the end of a smooth stretch at which it is looked for inside.
const PROBE: f64 = 0.75;
/// Halvings of the way between two nodes in the search of a crossing: to 1e-10 of a step.
const HALVINGS: usize = 33;

/// Place and height of the peak of the parabola through three points; none when it opens upwards or its peak lies outside.
fn peak(p: &[(f64, f64)]) -> Option<(f64, f64)> {
    let &[(a, fa), (b, fb), (c, fc)] = p else { return None };
    let (left, right) = ((fb - fa) / (b - a), (fc - fb) / (c - b));
    let curve = (right - left) / (c - a);
    // A difference of rounded values is no curvature.
    if curve.is_nan() || curve * (c - a).powi(2) >= -1e-14 * (fa.abs() + fb.abs() + fc.abs()) {
        return None;
    }
    let slope = left + curve * (b - a);
    let t = b - 0.5 * slope / curve;
    (t > a && t < c).then_some((t, fb + slope * (t - b) + curve * (t - b) * (t - b)))
}

impl Survey {
    /// Looks at the cycle: at the ends of its steps, on both sides of `bends` (sorted), and halfway between.
    ///
    /// # Errors
    /// A film that cannot be solved, no balance.
    pub fn new(look: &mut Look<'_>, bends: &[f64]) -> Result<Self, EvalError> {
        let ends = look.trajectory.ends().to_vec();
        let dense = look.trajectory.between == Between::Dense;
        let bent = |t: f64| dense && bends.iter().any(|b| (b - t).abs() < 1e-9);
        let mut found = Self {
            nodes: Vec::with_capacity(3 * ends.len()),
            steps: Vec::with_capacity(ends.len()),
            more: if dense { 2 } else { 1 },
            omega: look.a.omega(),
        };
        let last = ends.len() - 1;
        for (k, &t) in ends.iter().enumerate() {
            let here = bent(t) || (dense && (k == 0 || k == last));
            if k > 0 {
                if dense {
                    found.add(look, 0.5 * (ends[k - 1] + t), 0.0, false)?;
                }
                found.add(look, t, if here { -1.0 } else { 0.0 }, false)?;
            }
            if k < last {
                if k == 0 || here {
                    found.add(look, t, if here { 1.0 } else { 0.0 }, k > 0)?;
                }
                found.steps.push(found.nodes.len() - 1);
            }
        }
        Ok(found)
    }

    fn add(&mut self, look: &mut Look<'_>, t: f64, side: f64, bent: bool) -> Result<(), EvalError> {
        let row = look.row(t, side)?;
        let contact_gap = look.contact_gaps(t);
        self.nodes.push(Node { t, row, contact_gap, bent });
        Ok(())
    }

    /// Integral over the cycle in time: Simpson's rule on every step, the trapezoidal one where nothing is known between their ends.
    #[must_use]
    pub fn integral(&self, f: impl Fn(&Row) -> f64) -> f64 {
        let mut sum = 0.0;
        for &k in &self.steps {
            let own = &self.nodes[k..=k + self.more];
            let (a, b) = (f(&own[0].row), f(&own[self.more].row));
            let h = own[self.more].t - own[0].t;
            sum += h * if self.more == 2 { (a + 4.0 * f(&own[1].row) + b) / 6.0 } else { 0.5 * (a + b) };
        }
        sum / self.omega
    }

    /// The course of `f` over every step: crank angles \[rad\] at its ends, and the values at its start, halfway and at its end. Where nothing is
    /// known between the ends it is straight.
    #[must_use]
    pub fn pieces(&self, f: impl Fn(&Row) -> f64) -> Vec<Piece> {
        let piece = |k: &usize| {
            let own = &self.nodes[*k..=*k + self.more];
            let (from, to) = (f(&own[0].row), f(&own[self.more].row));
            let middle = if self.more == 2 { f(&own[1].row) } else { 0.5 * (from + to) };
            Piece { ends: [own[0].t, own[self.more].t], values: [from, middle, to] }
        };
        self.steps.iter().map(piece).collect()
    }

    /// The extreme of `f` over `window` \[rad\] and its crank angle \[rad\].
    ///
    /// # Errors
    /// A film that cannot be solved.
    pub fn extreme(
        &self,
        look: &mut Look<'_>,
        which: Which,
        window: (f64, f64),
        f: &dyn Fn(&Row) -> f64,
    ) -> Result<(f64, f64), EvalError> {
        let values: Vec<f64> = self.nodes.iter().map(|n| f(&n.row)).collect();
        self.extreme_of(look, which, window, &values, &mut |look, t| Ok(f(&look.row(t, 0.0)?)))
    }

    /// The same of a function whose values at the nodes are known and which `at` tells elsewhere.
    ///
    /// # Errors
    /// What `at` says.
    pub fn extreme_of(
        &self,
        look: &mut Look<'_>,
        which: Which,
        window: (f64, f64),
        values: &[f64],
        at: &mut dyn FnMut(&mut Look<'_>, f64) -> Result<f64, EvalError>,
    ) -> Result<(f64, f64), EvalError> {
        let sign = if which == Which::Max { 1.0 } else { -1.0 };
        let mut best = (0.0, f64::NEG_INFINITY);
        let mut keep = |t: f64, v: f64| {
            if v > best.1 {
                best = (t, v);
            }
        };
        for (n, v) in self.nodes.iter().zip(values) {
            if n.t >= window.0 && n.t <= window.1 {
                keep(n.t, sign * v);
            }
        }
        for t in [window.0, window.1] {
            let known = t <= self.nodes[0].t || t >= self.nodes[self.nodes.len() - 1].t;
            if self.more == 2 && !known && self.nodes.iter().all(|n| (n.t - t).abs() > 1e-9) {
                keep(t, sign * at(look, t)?);
            }
        }
        let mut ways: Vec<(Vec<Place>, Place)> = Vec::new();
        for k in 1..self.nodes.len().saturating_sub(1) {
            let own = &self.nodes[k - 1..=k + 1];
            if own[1].bent || own[2].bent || own[0].t < window.0 || own[2].t > window.1 {
                continue;
            }
            let three: Vec<(f64, f64)> =
                (k - 1..=k + 1).map(|k| (self.nodes[k].t, sign * values[k])).collect();
            if let Some(p) = peak(&three).filter(|p| p.1 > best.1) {
                ways.push((three, p));
            }
        }
        ways.sort_by(|a, b| b.1.1.total_cmp(&a.1.1).then(a.1.0.total_cmp(&b.1.0)));
        for (points, top) in ways.into_iter().take(FOLLOWED) {
            if self.more < 2 {
                // Nothing is known between the nodes but what they say.
                if top.1 > best.1 {
                    best = top;
                }
            } else {
                climb(look, points, top, sign, at, &mut best)?;
            }
        }
        if self.more == 2 {
            self.probe(look, window, sign, values, at, &mut best)?;
        }
        Ok((sign * best.1, best.0))
    }

    /// Looks beside a peak that stands where a smooth stretch ends, as `best` does: three nodes may hide one that lies close to the last of them.
    fn probe(
        &self,
        look: &mut Look<'_>,
        window: (f64, f64),
        sign: f64,
        values: &[f64],
        at: &mut dyn FnMut(&mut Look<'_>, f64) -> Result<f64, EvalError>,
        best: &mut (f64, f64),
    ) -> Result<(), EvalError> {
        let ends: Vec<usize> = (0..self.nodes.len()).filter(|k| self.nodes[*k].t == best.0).collect();
        for k in ends {
            let smooth = |a: usize, b: usize| b < self.nodes.len() && !self.nodes[a.max(b)].bent;
            let (before, after) = (k.wrapping_sub(1), k + 1);
            for (own, other) in [(before, after), (after, before)] {
                let inside = own < self.nodes.len() && smooth(k, own);
                // Where the stretch goes on, parabolas have seen it.
                if !inside || (other < self.nodes.len() && smooth(k, other)) {
                    continue;
                }
                let (a, b) = (&self.nodes[own], &self.nodes[k]);
                let t = a.t + PROBE * (b.t - a.t);
                if t < window.0 || t > window.1 {
                    continue;
                }
                let value = sign * at(look, t)?;
                let mut points = vec![(a.t, sign * values[own]), (t, value), (b.t, sign * values[k])];
                points.sort_by(|a, b| a.0.total_cmp(&b.0));
                if value > best.1 {
                    *best = (t, value);
                }
                if let Some(top) = peak(&points) {
                    climb(look, points, top, sign, at, best)?;
                }
            }
        }
        Ok(())
    }

    /// Crank angles \[rad\] at which `at` changes its sign, and whether it is positive after it. `values` are those at the nodes.
    ///
    /// # Errors
    /// What `at` says.
    pub fn crossings(
        &self,
        look: &mut Look<'_>,
        values: &[f64],
        at: &mut dyn FnMut(&mut Look<'_>, f64) -> Result<f64, EvalError>,
    ) -> Result<Vec<(f64, bool)>, EvalError> {
        let mut known: Vec<(f64, f64)> = Vec::with_capacity(values.len());
        for (k, n) in self.nodes.iter().enumerate() {
            // A dip between nodes of one sign.
            if k > 1 && self.more == 2 && !n.bent && !self.nodes[k - 1].bent {
                let sign = -values[k].signum();
                let three: Vec<(f64, f64)> =
                    (k - 2..=k).map(|k| (self.nodes[k].t, sign * values[k])).collect();
                if three.iter().all(|p| p.1 < 0.0)
                    && let Some(top) = peak(&three).filter(|p| p.1 > 0.0)
                {
                    let v = at(look, top.0)?;
                    let place = known.partition_point(|p| p.0 < top.0);
                    known.insert(place, (top.0, v));
                }
            }
            known.push((n.t, values[k]));
        }
        let mut found = Vec::new();
        for pair in known.windows(2) {
            let [(mut a, va), (mut b, vb)] = [pair[0], pair[1]];
            if (va > 0.0) == (vb > 0.0) || a == b {
                continue;
            }
            if self.more < 2 {
                found.push((a + (b - a) * va / (va - vb), vb > 0.0));
                continue;
            }
            for _ in 0..HALVINGS {
                let middle = 0.5 * (a + b);
                if (at(look, middle)? > 0.0) == (vb > 0.0) { b = middle } else { a = middle }
            }
            found.push((b, vb > 0.0));
        }
        Ok(found)
    }

    /// Stretches \[rad\] in which the function of [`Survey::crossings`] is not positive.
    ///
    /// # Errors
    /// What `at` says.
    pub fn stretches(
        &self,
        look: &mut Look<'_>,
        values: &[f64],
        at: &mut dyn FnMut(&mut Look<'_>, f64) -> Result<f64, EvalError>,
    ) -> Result<Vec<(f64, f64)>, EvalError> {
        let (first, last) = (self.nodes[0].t, self.nodes[self.nodes.len() - 1].t);
        let mut begin = (values[0] <= 0.0).then_some(first);
        let mut found = Vec::new();
        for (t, positive) in self.crossings(look, values, at)? {
            if !positive {
                begin = Some(t);
            } else if let Some(from) = begin.take() {
                found.push((from, t));
            }
        }
        found.extend(begin.map(|from| (from, last)));
        Ok(found)
    }

    /// Values of `f` at the nodes.
    #[must_use]
    pub fn values(&self, f: impl Fn(&Row) -> f64) -> Vec<f64> {
        self.nodes.iter().map(|n| f(&n.row)).collect()
    }

    /// Contact gaps of a side at the nodes, less the range of contact \[m\].
    #[must_use]
    pub fn contact_gaps(&self, side: usize) -> Vec<f64> {
        self.nodes.iter().map(|n| n.contact_gap[side]).collect()
    }

    /// Crank angles of the nodes \[rad\].
    #[must_use]
    pub fn angles(&self) -> Vec<f64> {
        self.nodes.iter().map(|n| n.t).collect()
    }

    /// Stretches of nodes over which `values` fall: the first and the last one of each.
    #[must_use]
    pub fn falls(values: &[f64]) -> Vec<(usize, usize)> {
        let mut found = Vec::new();
        // Two looks at one place, on both sides of a bend, differ by rounding.
        let rise = ROUNDING * values.iter().fold(0.0_f64, |a, v| a.max(v.abs()));
        let (mut top, mut low, mut falling) = (0, 0, false);
        for k in 1..values.len() {
            if falling && values[k] > values[low] + rise {
                found.push((top, low));
                (top, falling) = (k, false);
            } else if falling {
                low = if values[k] <= values[low] { k } else { low };
            } else if values[k] >= values[top] {
                top = k;
            } else if values[k] < values[top] - rise {
                (low, falling) = (k, true);
            }
        }
        if falling {
            found.push((top, low));
        }
        found
    }

    /// Lateral force that the piston's inertia takes, from the change of its rates over every step: crank angle \[rad\] in the middle of the step and
    /// force \[N\], `force` being that of the accelerations of both edges.
    #[must_use]
    pub fn inertia(&self, force: impl Fn([f64; 2]) -> f64, rates: [usize; 2]) -> Vec<(f64, f64)> {
        let of = |k: &usize| {
            let (a, b) = (&self.nodes[*k], &self.nodes[*k + self.more]);
            let time = (b.t - a.t) / self.omega;
            let acceleration = rates.map(|r| (b.row[r] - a.row[r]) / time);
            (0.5 * (a.t + b.t), force(acceleration))
        };
        self.steps.iter().map(of).collect()
    }
}

/// Follows a peak, `sign` times the function `at`, from three points and the place where their parabola has it.
fn climb(
    look: &mut Look<'_>,
    mut points: Vec<(f64, f64)>,
    mut top: (f64, f64),
    sign: f64,
    at: &mut dyn FnMut(&mut Look<'_>, f64) -> Result<f64, EvalError>,
    best: &mut (f64, f64),
) -> Result<(), EvalError> {
    for _ in 0..LOOKS {
        let width = points[points.len() - 1].0 - points[0].0;
        let gain = top.1 - best.1;
        let seen = points.iter().any(|p| (p.0 - top.0).abs() < SAME * width);
        if seen || gain <= FOUND * best.1.abs() {
            return Ok(());
        }
        let value = sign * at(look, top.0)?;
        if value > best.1 {
            *best = (top.0, value);
        }
        let place = points.partition_point(|p| p.0 < top.0);
        points.insert(place, (top.0, value));
        let highest = (0..points.len()).max_by(|a, b| points[*a].1.total_cmp(&points[*b].1)).unwrap_or(0);
        if highest == 0 || highest + 1 == points.len() {
            return Ok(());
        }
        let near: Vec<(f64, f64)> = points[highest - 1..=highest + 1].to_vec();
        match peak(&near) {
            Some(p) => top = p,
            None => return Ok(()),
        }
        points = near;
    }
    Ok(())
}
