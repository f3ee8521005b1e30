//! Sums over the film of one side, and the fields that are summed.

use gudgeon_numerics::vectors::{Vectorised, dots};

use super::gap::Gap;
use super::nodes::Nodes;

/// What sums over a film need besides its levers.
pub(super) struct Over {
    /// Shapes of the gap's rates times the areas of the nodes.
    pub(super) tests: Vec<f64>,
    /// `R cos φ` of every node.
    pub(super) arms: Vec<f64>,
    /// A quarter of the width of the side to the next node along `x`; none at the end of a line.
    pub(super) across: Vec<f64>,
    /// Areas of the nodes, and the same times `R cos φ`.
    areas: [Vec<f64>; 2],
}

impl Over {
    /// Over the nodes of a side of that radius, whose gap changes in the `shapes`.
    pub(super) fn new(nodes: &Nodes, shapes: &[f64], radius: f64) -> Self {
        let (n, nx) = (nodes.len(), nodes.nx);
        let arms: Vec<f64> = (0..n).map(|k| radius * nodes.cos[k / nx]).collect();
        let across = |k: usize| if k % nx + 1 < nx { 0.25 * nodes.line_weight[k / nx] } else { 0.0 };
        let levers = nodes.weight.iter().zip(&arms).map(|(w, arm)| w * arm).collect();
        Self {
            tests: shapes.iter().enumerate().map(|(k, v)| v * nodes.weight[k % n]).collect(),
            arms,
            across: (0..n).map(across).collect(),
            areas: [nodes.weight.clone(), levers],
        }
    }

    /// Sums of a drag per viscosity and speed, and of the same times `R cos φ`.
    pub(super) fn drag(&self, drag: &[f64]) -> [f64; 2] {
        let [areas, levers] = &self.areas;
        dots(drag, [areas, levers])
    }

    /// `out`: forces of a pressure on both edges, along the bore, along the bore times `R cos φ`, and on the elastic shapes.
    pub(super) fn sums(&self, p: &[f64], gap: &Gap, out: &mut [f64]) {
        let n = p.len();
        let (edges, shapes) = self.tests.split_at(2 * n);
        let (top, bottom) = edges.split_at(n);
        let (head, elastic) = out.split_at_mut(4);
        head.copy_from_slice(&dots(p, [top, bottom, &gap.lever, &gap.moment]));
        for (out, test) in elastic.iter_mut().zip(shapes.chunks_exact(n)) {
            [*out] = dots(p, [test]);
        }
    }
}

/// Pressure per viscosity of causes at their rates: sliding at `speed`, then the gap's `rates`.
pub(super) struct Superposed<'a> {
    pub(super) speed: f64,
    pub(super) rates: &'a [f64],
    /// Pressure of one metre a second of every cause.
    pub(super) fields: &'a [f64],
    pub(super) out: &'a mut [f64],
}

impl Vectorised for Superposed<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { speed, rates, fields, out } = self;
        let n = out.len();
        let (u, v, w) = (speed, rates[0], rates[1]);
        let (sliding, top, bottom) = (&fields[..n], &fields[n..2 * n], &fields[2 * n..3 * n]);
        for k in 0..n {
            out[k] = u * sliding[k] + v * top[k] + w * bottom[k];
        }
        for (rate, field) in rates[2..].iter().zip(fields[3 * n..].chunks_exact(n)) {
            for (p, f) in out.iter_mut().zip(field) {
                *p += rate * f;
            }
        }
    }
}

/// A pressure per viscosity as pressure that is cut off, and where it takes part in changes (1, or 0 where it is cut).
pub(super) struct CutOff<'a> {
    pub(super) mu: f64,
    pub(super) cut: f64,
    pub(super) raw: &'a [f64],
    pub(super) p: &'a mut [f64],
    pub(super) open: &'a mut [f64],
}

impl Vectorised for CutOff<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { mu, cut, raw, p, open } = self;
        for ((p, open), raw) in p.iter_mut().zip(open).zip(raw) {
            let full = mu * raw;
            // A film without pressure, as that of a centred skirt at rest, answers like a full one.
            let is_open = full >= cut;
            *open = if is_open { 1.0 } else { 0.0 };
            *p = if is_open { full } else { cut };
        }
    }
}

/// A field times a factor, and times another field where there is one.
pub(super) struct Taken<'a> {
    pub(super) factor: f64,
    pub(super) open: Option<&'a [f64]>,
    pub(super) field: &'a [f64],
    pub(super) out: &'a mut [f64],
}

impl Vectorised for Taken<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        if let Some(open) = self.open {
            for ((out, open), field) in self.out.iter_mut().zip(open).zip(self.field) {
                *out = self.factor * open * field;
            }
        } else {
            for (out, field) in self.out.iter_mut().zip(self.field) {
                *out = self.factor * field;
            }
        }
    }
}

/// Rates of the gap's content: shapes at their `rates`, times the slope of the content over the gap.
pub(super) struct ContentRates<'a> {
    pub(super) rates: &'a [f64],
    pub(super) shapes: &'a [f64],
    pub(super) slope: &'a [f64],
    pub(super) out: &'a mut [f64],
}

impl Vectorised for ContentRates<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { rates, shapes, slope, out } = self;
        let n = out.len();
        let (top, bottom) = (&shapes[..n], &shapes[n..2 * n]);
        for k in 0..n {
            out[k] = rates[0] * top[k] + rates[1] * bottom[k];
        }
        for (rate, shape) in rates[2..].iter().zip(shapes[2 * n..].chunks_exact(n)) {
            for (r, s) in out.iter_mut().zip(shape) {
                *r += rate * s;
            }
        }
        for (r, s) in out.iter_mut().zip(slope) {
            *r *= s;
        }
    }
}

/// The same of every shape at one metre a second, shape after shape.
pub(super) struct ContentShapes<'a> {
    pub(super) shapes: &'a [f64],
    pub(super) slope: &'a [f64],
    pub(super) out: &'a mut [f64],
}

impl Vectorised for ContentShapes<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { shapes, slope, out } = self;
        let n = slope.len();
        for (rates, shape) in out.chunks_exact_mut(n).zip(shapes.chunks_exact(n)) {
            for ((r, s), slope) in rates.iter_mut().zip(shape).zip(slope) {
                *r = s * slope;
            }
        }
    }
}
