//! Loops over the sides between control volumes: what they let through, and what flows through them.

use gudgeon_core::kinds::{Film2dIn, Viscosity};
use gudgeon_numerics::vectors::Vectorised;

/// Sides between `count` nodes from `from` on and as many from `to` on.
#[derive(Clone, Copy)]
pub(super) struct Sides {
    pub from: usize,
    pub to: usize,
    pub count: usize,
}

impl Sides {
    /// The values at either end.
    #[inline(always)]
    fn of<'a>(&self, x: &'a [f64]) -> impl Iterator<Item = (&'a f64, &'a f64)> {
        x[self.from..self.from + self.count].iter().zip(&x[self.to..self.to + self.count])
    }
}

/// Mean of the conductivities `φ h³/(12 μ)` of the nodes on either side.
pub(super) fn mean_of_nodes(inp: &Film2dIn<'_>, sides: Sides, phi: &[f64], out: &mut [f64]) {
    let mu = |k: usize| match inp.mu {
        Viscosity::Uniform(mu) => mu,
        Viscosity::Nodes(m) => m[k],
    };
    let factor = |k: usize| if phi.is_empty() { 1.0 } else { phi[k] };
    let one = |k: usize| factor(k) * inp.h[k].powi(3) / mu(k);
    for (i, g) in out.iter_mut().enumerate() {
        *g = (one(sides.from + i) + one(sides.to + i)) / 24.0;
    }
}

/// `φ h³/(12 μ)` of the means of either side, or of the film thickness that is `given` there.
pub(super) struct OfFaces<'a, 'b> {
    pub inp: &'a Film2dIn<'b>,
    pub sides: Sides,
    pub phi: &'a [f64],
    pub given: &'a [f64],
    pub out: &'a mut [f64],
}

impl Vectorised for OfFaces<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { inp, sides, phi, given, out } = self;
        if given.is_empty() {
            for (g, (a, b)) in out.iter_mut().zip(sides.of(inp.h)) {
                *g = 0.5 * (a + b);
            }
        } else {
            out.copy_from_slice(&given[sides.from..sides.from + sides.count]);
        }
        if phi.is_empty() {
            for g in &mut *out {
                *g = *g * *g * *g;
            }
        } else {
            for (g, (a, b)) in out.iter_mut().zip(sides.of(phi)) {
                *g = 0.5 * (a + b) * *g * *g * *g;
            }
        }
        match inp.mu {
            Viscosity::Uniform(mu) => {
                let fluidity = 1.0 / (12.0 * mu);
                for g in out {
                    *g *= fluidity;
                }
            }
            Viscosity::Nodes(m) => {
                for (g, (a, b)) in out.iter_mut().zip(sides.of(m)) {
                    *g /= 6.0 * (a + b);
                }
            }
        }
    }
}

/// Flow that a sliding surface carries through the sides along `x` between nodes that follow one another \[m³/s\].
pub(super) struct Slide<'a> {
    /// Half the speed.
    pub half: f64,
    pub h: &'a [f64],
    pub film: &'a [f64],
    /// Film thickness at the sides, when it is given.
    pub given: &'a [f64],
    /// The node whose film is carried, when it is one of both: itself (0) or the next (1).
    pub carried: Option<usize>,
    /// Width of the sides; none at the end of a line.
    pub width: &'a [f64],
    pub out: &'a mut [f64],
}

impl Vectorised for Slide<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { half, h, film, given, carried, width, out } = self;
        let n = out.len();
        let (film, next, width) = (&film[..n], &film[1..=n], &width[..n]);
        if let Some(carried) = carried {
            let film = if carried == 0 { film } else { next };
            for k in 0..n {
                out[k] = half * film[k] * width[k];
            }
        } else if given.is_empty() {
            for k in 0..n {
                out[k] = half * (0.5 * (film[k] + next[k])) * width[k];
            }
        } else {
            let (given, h, h_next) = (&given[..n], &h[..n], &h[1..=n]);
            for k in 0..n {
                // What rough surfaces add varies little: its mean, on top of the film between the nodes.
                let more = 0.5 * ((film[k] - h[k]) + (next[k] - h_next[k]));
                out[k] = half * (given[k] + more) * width[k];
            }
        }
    }
}

/// Adds to the nodes what flows through their sides, and what conductances `g` let through between pressures.
pub(super) struct Exchange<'a> {
    /// From a node to the one so many further on.
    pub step: usize,
    /// Conductances, and pressures that drive flow through them, if any.
    pub driven: Option<(&'a [f64], &'a [f64])>,
    /// Flow through every side; takes all of it.
    pub flows: &'a mut [f64],
    pub out: &'a mut [f64],
}

impl Vectorised for Exchange<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { step, driven, flows, out } = self;
        let n = flows.len();
        if let Some((g, p)) = driven {
            let (g, own, other) = (&g[..n], &p[..n], &p[step..step + n]);
            for k in 0..n {
                flows[k] += g[k] * (own[k] - other[k]);
            }
        }
        for (out, flow) in out[..n].iter_mut().zip(&*flows) {
            *out -= flow;
        }
        for (out, flow) in out[step..step + n].iter_mut().zip(&*flows) {
            *out += flow;
        }
    }
}

/// What a gap whose content changes at `rates` takes up at every node, with its sign changed.
pub(super) struct Squeezed<'a> {
    pub rates: &'a [f64],
    pub areas: &'a [f64],
    pub out: &'a mut [f64],
}

impl Vectorised for Squeezed<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        for ((out, rate), area) in self.out.iter_mut().zip(self.rates).zip(self.areas) {
            *out = -(rate * area);
        }
    }
}
