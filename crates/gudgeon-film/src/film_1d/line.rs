//! What every model of a film along a line needs: the panels of the line, turned so that the surface moves along `+x`, and the
//! integrals over a film that has been found.
//!
//! In a panel the gap is linear, `h = h_m (1 + t w)`, `-1 ≤ w ≤ 1`, and the flux `q` constant, so that
//!
//! ```text
//! p' = 12 μ/φ_p (u φ_s h/2 - q)/h³
//! q  = c θ_a + g (p_a - p_b),   1/g = 12 μ/φ_p ∫dx/h³,   c = u φ_s/2 ∫dx/h² / ∫dx/h³
//! ```
//!
//! exactly, with `θ_a` the filled fraction at the upstream node. All integrals of pressure and shear follow from `t²` and
//! `A1 = (artanh t/t - 1)/t²` without cancellation.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{
    Film1dCtx, Film1dIn, Film1dOut, FilmEnd, FilmField, FilmFront, FilmTime, PanelFactors,
};
use serde::{Deserialize, Serialize};

use crate::Cavitation;

/// Friction of the part of a line that is not under full film.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LineCavityShear {
    /// `full` for the Sommerfeld conditions, as programs that use them count it; `streamers` otherwise.
    #[default]
    Auto,
    /// Streamers of oil over the filled fraction of the width: `θ μ u/h`.
    Streamers,
    /// As if the gap were full: `μ u/h`.
    Full,
    /// None.
    None,
}

/// [`LineCavityShear`] when it is decided.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shear {
    Streamers,
    Full,
    None,
}

impl LineCavityShear {
    /// What is left to decide when the condition of cavitation is known.
    pub(super) const fn decided(self, cavitation: Cavitation) -> Shear {
        match (self, cavitation) {
            (Self::None, _) => Shear::None,
            (Self::Full, _) | (Self::Auto, Cavitation::HalfSommerfeld | Cavitation::FullSommerfeld) => {
                Shear::Full
            }
            _ => Shear::Streamers,
        }
    }
}

/// `(artanh t/t - 1)/t²` of `z = t²`, `0 ≤ z < 1`.
#[inline]
fn a1(z: f64) -> f64 {
    if z < 1e-3 {
        // 1e-18 of the series is left out.
        return 1.0 / 3.0 + z * (0.2 + z * (1.0 / 7.0 + z * (1.0 / 9.0 + z * (1.0 / 11.0 + z / 13.0))));
    }
    if z < 0.06 {
        let mut sum = 0.0;
        // 0.06^14/31 = 3e-19.
        for k in (0..14).rev() {
            sum = sum * z + 1.0 / (2 * k + 3) as f64;
        }
        return sum;
    }
    let t = z.sqrt();
    (t.atanh() / t - 1.0) / z
}

/// How the oil stored along the line changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Change {
    Steady,
    /// At a given rate at each node.
    Rates,
    /// In a step of this length, from a given content.
    Step(f64),
}

/// A line with its panels and the film found on it, in the direction of sliding: `u ≥ 0`, coordinate `±x`.
#[derive(Debug)]
pub(super) struct Line {
    model: &'static str,
    nodes: Vec<f64>,
    /// Number of panels.
    pub n: usize,
    /// Sliding is along `-x`.
    turned: bool,
    smooth: bool,
    pub u: f64,
    p_cav: f64,
    /// Nodes in the direction of sliding.
    pub x: Vec<f64>,
    pub dx: Vec<f64>,
    pub ha: Vec<f64>,
    pub hb: Vec<f64>,
    pub mu: Vec<f64>,
    /// `1/dx`, and `μ/φ_p`.
    per_dx: Vec<f64>,
    thick: Vec<f64>,
    pub rough: Vec<PanelFactors>,
    /// Flux through a panel for a pressure difference of 1, and its inverse.
    pub g: Vec<f64>,
    pub d: Vec<f64>,
    /// Flux that sliding drives through a full panel.
    pub c: Vec<f64>,
    /// Pressures above `p_cav` at the ends.
    pub p_in: f64,
    pub p_out: f64,
    /// Flux that arrives, when the inlet is no bath.
    pub supply: Option<f64>,
    pub change: Change,
    /// Volume of the gap at the nodes.
    pub volume: Vec<f64>,
    /// Rate at which a node stores oil.
    pub rate: Vec<f64>,
    /// Oil at the nodes at the start of a step.
    pub before: Vec<f64>,
    /// The solution: pressure above `p_cav` and filled fraction of the nodes, whether there is a film, flux of the panels.
    pub p: Vec<f64>,
    pub fill: Vec<f64>,
    pub film: Vec<bool>,
    pub q: Vec<f64>,
    /// Nodes before this one lie before the film of a starved inlet, under the gas.
    pub lead: usize,
    pub starved: bool,
    /// The answers, in the direction of `x`.
    field_p: Vec<f64>,
    field_fill: Vec<f64>,
    field_content: Vec<f64>,
    field_flux: Vec<f64>,
    pub fronts: Vec<FilmFront>,
}

/// Integrals over a panel of full film, of what lies above the straight line between the pressures of its nodes.
struct Bulge {
    load: f64,
    /// About the middle of the panel, the straight line included.
    moment: f64,
    /// `½ ∫ h p' dx`
    gradient: f64,
    /// `∫ dx/h`
    i1: f64,
}

/// A stretch of a panel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stretch {
    /// From where.
    pub x: f64,
    pub dx: f64,
    pub ha: f64,
    pub hb: f64,
    pub mu: f64,
    /// `μ/φ_p`
    pub thick: f64,
    /// Slope of the gap.
    pub slope: f64,
    pub rough: PanelFactors,
}

impl Stretch {
    /// Integrals over the stretch under full film with the flux `q` and the sliding velocity `u`.
    #[inline]
    fn bulge(&self, u: f64, q: f64, rise: f64) -> Bulge {
        let (dx, f) = (self.dx, &self.rough);
        let r = 2.0 / (self.ha + self.hb);
        let t = 0.5 * (self.hb - self.ha) * r;
        let z = t * t;
        let y = 1.0 / (1.0 - z);
        let a = a1(z);
        let i1 = dx * r * (1.0 + z * a);
        let i2 = dx * r * r * y;
        let uf = u * f.sliding_flow;
        let k = 3.0 * self.thick * dx * dx;
        Bulge {
            load: k * t * r * r * (uf * (y - a) - 2.0 * q * r * y * y),
            moment: 0.125 * dx * dx * rise
                - 0.5 * k * dx * r * r * (0.5 * uf * (y - 2.0 * a) - q * r * (a + z * y * y)),
            gradient: 3.0 * self.thick * (uf * i1 - 2.0 * q * i2) * f.pressure_shear,
            i1,
        }
    }
}

impl Stretch {
    /// The part from `x` to the end (`after`), or from the beginning to `x`, where the film is `h`.
    pub fn cut(&self, x: f64, h: f64, after: bool) -> Self {
        if after {
            Self { x, dx: (self.x + self.dx - x).max(0.0), ha: h, ..*self }
        } else {
            Self { dx: (x - self.x).max(0.0), hb: h, ..*self }
        }
    }

    /// Gap that the flux fills without a gradient of pressure; more than any without sliding.
    pub fn filled(&self, u: f64, q: f64) -> f64 {
        let uf = u * self.rough.sliding_flow;
        if uf > 0.0 { 2.0 * q / uf } else { f64::INFINITY }
    }

    /// `∫ θ dx/h` without full film; `layer`: before the film of a starved inlet, where the oil touches one surface alone.
    pub fn wet(&self, u: f64, q: f64, shear: Shear, layer: bool) -> f64 {
        match shear {
            Shear::None => 0.0,
            Shear::Full => self.i1(),
            Shear::Streamers if layer || u == 0.0 => 0.0,
            Shear::Streamers => {
                self.filled(u, q).max(0.0).min(self.ha.max(self.hb)) * self.dx / (self.ha * self.hb)
            }
        }
    }

    /// `∫ dx/h`
    fn i1(&self) -> f64 {
        let r = 2.0 / (self.ha + self.hb);
        let t = 0.5 * (self.hb - self.ha) * r;
        self.dx * r * (1.0 + t * t * a1(t * t))
    }

    /// Rise of pressure over it under full film.
    pub fn rise(&self, u: f64, q: f64) -> f64 {
        let r = 1.0 / (self.ha * self.hb);
        let k = 6.0 * self.thick * self.dx * r;
        k * (u * self.rough.sliding_flow - q * (self.ha + self.hb) * r)
    }

    /// Fall of pressure over it for a flux of 1.
    pub fn resistance(&self) -> f64 {
        let r = 1.0 / (self.ha * self.hb);
        6.0 * self.thick * self.dx * (self.ha + self.hb) * r * r
    }

    /// Where the gap is `h`, when that is inside.
    pub fn place(&self, h: f64) -> Option<f64> {
        let inside = (self.ha < h && h < self.hb) || (self.hb < h && h < self.ha);
        inside.then(|| self.x + self.dx * ((h - self.ha) / (self.hb - self.ha)))
    }

    /// Where the pressure, `p` at the end, has come down to nothing, not before `lo`; and the gap there.
    pub fn front(&self, u: f64, q: f64, p: f64, mut lo: f64) -> (f64, f64) {
        let end = self.x + self.dx;
        let gap = |x: f64| self.hb - self.slope * (end - x);
        let k = 12.0 * self.thick;
        let uf = u * self.rough.sliding_flow;
        let (mut hi, mut x) = (end, end);
        for _ in 0..200 {
            let h = gap(x);
            let here = p - self.cut(x, h, true).rise(u, q);
            if here > 0.0 {
                hi = x;
            } else {
                lo = x;
            }
            let step = -here * (h * h * h) / (k * (0.5 * uf * h - q));
            let next = x + step;
            let next = if next > lo && next < hi { next } else { 0.5 * (lo + hi) };
            if next == x || here == 0.0 || hi - lo <= f64::EPSILON * self.dx {
                break;
            }
            x = next;
        }
        (x, gap(x))
    }
}

/// Integrals over the line, in the direction of sliding.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sums {
    load: f64,
    moment: f64,
    slope: f64,
    couette: f64,
    gradient: f64,
    /// Shear of sliding that the moving surface has more, and the other less.
    difference: f64,
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

impl Line {
    pub fn new(model: &'static str, ctx: &Film1dCtx<'_>) -> Self {
        let n = ctx.x.len() - 1;
        let panels = || vec![0.0; n];
        let nodes = || vec![0.0; n + 1];
        Self {
            model,
            nodes: ctx.x.to_vec(),
            n,
            turned: false,
            smooth: true,
            u: 0.0,
            p_cav: 0.0,
            x: ctx.x.to_vec(),
            dx: ctx.x.windows(2).map(|w| w[1] - w[0]).collect(),
            ha: panels(),
            hb: panels(),
            mu: panels(),
            per_dx: ctx.x.windows(2).map(|w| 1.0 / (w[1] - w[0])).collect(),
            thick: panels(),
            rough: vec![PanelFactors::SMOOTH; n],
            g: panels(),
            d: panels(),
            c: panels(),
            p_in: 0.0,
            p_out: 0.0,
            supply: None,
            change: Change::Steady,
            volume: nodes(),
            rate: nodes(),
            before: nodes(),
            p: nodes(),
            fill: nodes(),
            film: vec![false; n + 1],
            q: panels(),
            lead: 0,
            starved: false,
            field_p: nodes(),
            field_fill: nodes(),
            field_content: nodes(),
            field_flux: panels(),
            // Two in a panel at most.
            fronts: Vec::with_capacity(2 * n),
        }
    }

    pub const fn turned(&self) -> bool {
        self.turned
    }

    pub fn fatal(&self, what: impl Into<std::borrow::Cow<'static, str>>) -> EvalError {
        EvalError::fatal(self.model, what)
    }

    pub fn recoverable(&self, what: impl Into<std::borrow::Cow<'static, str>>) -> EvalError {
        EvalError::recoverable(self.model, what)
    }

    /// Takes the inputs, turned into the direction of sliding, and computes the coefficients of the panels. With `clip` an end
    /// pressure below `p_cav` counts as `p_cav`.
    pub fn enter(&mut self, inp: &Film1dIn<'_>, clip: bool) -> Result<(), EvalError> {
        let n = self.n;
        let fits = inp.h_a.len() == n
            && inp.h_b.len() == n
            && inp.mu.len() == n
            && inp.factors.is_none_or(|f| f.len() == n);
        if !fits {
            return Err(
                self.fatal(format!("film, viscosity and roughness must be given for each of {n} panels"))
            );
        }
        let [first, last] = inp.ends.map(FilmEnd::pressure);
        if !(first + last + inp.p_cav + inp.u).is_finite() {
            return Err(self.fatal(format!(
                "these are no film: sliding {} m/s, ends {first} and {last} Pa, cavitation {} Pa",
                inp.u, inp.p_cav
            )));
        }
        let turned = inp.u < 0.0;
        if turned != self.turned {
            self.turned = turned;
            if turned {
                self.x.iter_mut().zip(self.nodes.iter().rev()).for_each(|(x, n)| *x = -n);
            } else {
                self.x.copy_from_slice(&self.nodes);
            }
            self.dx.iter_mut().zip(self.x.windows(2)).for_each(|(d, w)| *d = w[1] - w[0]);
            self.per_dx.iter_mut().zip(&self.dx).for_each(|(r, d)| *r = 1.0 / d);
        }
        self.u = inp.u.abs();
        self.p_cav = inp.p_cav;
        if turned {
            copy_back(&mut self.ha, inp.h_b);
            copy_back(&mut self.hb, inp.h_a);
            copy_back(&mut self.mu, inp.mu);
        } else {
            self.ha.copy_from_slice(inp.h_a);
            self.hb.copy_from_slice(inp.h_b);
            self.mu.copy_from_slice(inp.mu);
        }
        // A comparison with what is not a number is false, and a sum with it is not finite.
        let positive = |v: &[f64]| v.iter().fold(true, |ok, x| ok & (*x > 0.0));
        let sum = |v: &[f64]| v.iter().sum::<f64>();
        if !(sum(&self.ha) + sum(&self.hb) + sum(&self.mu)).is_finite() || !positive(&self.mu) {
            return Err(self.fatal("film thickness and viscosity must be finite, viscosity positive"));
        }
        if !positive(&self.ha) || !positive(&self.hb) {
            let least = self.ha.iter().chain(&self.hb).copied().fold(f64::INFINITY, f64::min);
            return Err(self.recoverable(format!("a film of {least} m leaves no gap")));
        }
        match inp.factors {
            Some(f) => {
                let bad = |f: &PanelFactors| {
                    let shear = f.sliding_shear + f.pressure_shear + f.shear_difference;
                    let all = f.pressure_flow + f.sliding_flow + shear;
                    !all.is_finite() || f.pressure_flow <= 0.0 || f.sliding_flow < 0.0
                };
                if f.iter().any(bad) {
                    return Err(
                        self.fatal("roughness factors must be finite, that of the pressure flow positive")
                    );
                }
                self.smooth = false;
                if turned {
                    copy_back(&mut self.rough, f);
                } else {
                    self.rough.copy_from_slice(f);
                }
            }
            None if !self.smooth => {
                self.rough.fill(PanelFactors::SMOOTH);
                self.smooth = true;
            }
            None => {}
        }
        self.coefficients();
        let least = if clip { 0.0 } else { f64::NEG_INFINITY };
        let (p0, p1) = ((first - inp.p_cav).max(least), (last - inp.p_cav).max(least));
        (self.p_in, self.p_out) = if turned { (p1, p0) } else { (p0, p1) };
        self.supply = match inp.ends[usize::from(turned)] {
            FilmEnd::Flooded { .. } => None,
            FilmEnd::Starved { h_oil, .. } if h_oil.is_finite() && h_oil >= 0.0 => Some(self.u * h_oil),
            FilmEnd::Starved { h_oil, .. } => {
                return Err(self.fatal(format!("no layer of oil is {h_oil} m thick")));
            }
        };
        self.lead = 0;
        self.starved = false;
        self.enter_time(&inp.time)
    }

    fn enter_time(&mut self, time: &FilmTime<'_>) -> Result<(), EvalError> {
        let n = self.n;
        self.change = match time {
            FilmTime::Steady => Change::Steady,
            FilmTime::Squeeze(v) => {
                if v.len() != n || !v.iter().sum::<f64>().is_finite() {
                    return Err(
                        self.fatal(format!("a finite squeeze velocity is needed for each of {n} panels"))
                    );
                }
                self.rate.fill(0.0);
                for i in 0..n {
                    let half = 0.5 * self.dx[i] * if self.turned { v[n - 1 - i] } else { v[i] };
                    self.rate[i] += half;
                    self.rate[i + 1] += half;
                }
                if self.rate.iter().all(|r| *r == 0.0) { Change::Steady } else { Change::Rates }
            }
            FilmTime::Step { dt, content } => {
                if !(dt.is_finite() && *dt > 0.0) {
                    return Err(self.fatal(format!("a step of {dt} s is none")));
                }
                let sum: f64 = content.iter().sum();
                if content.len() != n + 1 || !sum.is_finite() || content.iter().any(|c| *c < 0.0) {
                    return Err(
                        self.fatal(format!("the oil at each of {} nodes must be zero or more", n + 1))
                    );
                }
                if self.turned {
                    copy_back(&mut self.before, content);
                } else {
                    self.before.copy_from_slice(content);
                }
                volumes(&self.dx, &self.ha, &self.hb, &mut self.volume);
                Change::Step(*dt)
            }
        };
        Ok(())
    }

    /// Conductance and sliding flux of the panels.
    fn coefficients(&mut self) {
        let n = self.n;
        let (ha, hb, dx, mu) = (&self.ha[..n], &self.hb[..n], &self.dx[..n], &self.mu[..n]);
        let (g, d, c) = (&mut self.g[..n], &mut self.d[..n], &mut self.c[..n]);
        for i in 0..n {
            let (product, sum) = (ha[i] * hb[i], ha[i] + hb[i]);
            let resistance = 6.0 * mu[i] * dx[i] * sum;
            let square = product * product;
            g[i] = square / resistance;
            d[i] = resistance / square;
            c[i] = self.u * product / sum;
        }
        self.thick.copy_from_slice(mu);
        if !self.smooth {
            for i in 0..n {
                let f = &self.rough[i];
                self.thick[i] /= f.pressure_flow;
                g[i] *= f.pressure_flow;
                d[i] /= f.pressure_flow;
                c[i] *= f.sliding_flow;
            }
        }
    }

    /// Oil that the bath or the layer at either end must give or take beside the flux of the first or last panel.
    fn ends_store(&self) -> (f64, f64) {
        match self.change {
            Change::Steady => (0.0, 0.0),
            _ => (self.rate[0], self.rate[self.n]),
        }
    }

    /// Fill of the last node: a bath, the end of a film, or what the cavity carries out of the line.
    pub fn outlet(&mut self) {
        let n = self.n;
        let open = !self.film[n - 1] && self.p[n] <= 0.0;
        let full = 0.5 * self.u * self.rough[n - 1].sliding_flow * self.hb[n - 1];
        self.film[n] = !open;
        self.fill[n] = if open && full > 0.0 { (self.q[n - 1] / full).clamp(0.0, 1.0) } else { 1.0 };
    }

    /// Sets [`Line::rate`] from the oil stored in the film that was found.
    pub fn store(&mut self) {
        if let Change::Step(dt) = self.change {
            for i in 0..=self.n {
                self.rate[i] = (self.volume[i] * self.fill[i] - self.before[i]) / dt;
            }
        }
    }

    /// Panel `i`.
    #[inline]
    pub fn stretch(&self, i: usize) -> Stretch {
        Stretch {
            x: self.x[i],
            dx: self.dx[i],
            ha: self.ha[i],
            hb: self.hb[i],
            mu: self.mu[i],
            thick: self.thick[i],
            slope: (self.hb[i] - self.ha[i]) * self.per_dx[i],
            rough: self.rough[i],
        }
    }

    /// Load, shear and the rest of the film that was found, and the answers in the direction of `x`. `clip`: pressure is below
    /// zero where nothing has been done about it yet, and is cut off.
    pub fn finish(&mut self, shear: Shear, clip: bool, iterations: usize) -> Result<Film1dOut, EvalError> {
        let n = self.n;
        self.fronts.clear();
        let mut sums = Sums::default();
        let squeezed = self.change != Change::Steady;
        for i in 0..n {
            let (pa, pb) = (self.p[i], self.p[i + 1]);
            let s = self.stretch(i);
            // A bath at `p_cav` before a gap that widens makes no film.
            let full = if clip {
                pa >= 0.0 && pb >= 0.0
            } else {
                self.film[i] && (self.film[i + 1] || pa != 0.0 || pb != 0.0)
            };
            if full {
                // The flux of a changing gap is not constant: a parabola of pressure more.
                let more = if squeezed { self.squeeze_bulge(i) } else { 0.0 };
                sums.film(&s, self.u, self.q[i], (pa, pb), more);
            } else if clip {
                self.clipped(&mut sums, &s, i, shear);
            } else {
                self.partial(&mut sums, &s, i, shear);
            }
            if i > 0 {
                sums.step(if clip { pa.max(0.0) } else { pa }, s.ha - self.hb[i - 1]);
            }
        }
        if clip {
            self.p.iter_mut().for_each(|p| *p = p.max(0.0));
            for i in 0..n {
                self.q[i] = self.c[i] + self.g[i] * (self.p[i] - self.p[i + 1]);
            }
        } else {
            self.ruptures();
        }
        let highest = self.highest();
        let flux_error = self.flux_error();
        self.report(&sums, highest, flux_error, iterations)
    }

    /// Load of the parabola of pressure that storing oil adds in panel `i`.
    fn squeeze_bulge(&self, i: usize) -> f64 {
        let width = |i: usize| {
            0.5 * (if i > 0 { self.dx[i - 1] } else { 0.0 } + if i < self.n { self.dx[i] } else { 0.0 })
        };
        let v = 0.5 * (self.rate[i] / width(i) + self.rate[i + 1] / width(i + 1));
        let slender = 2.0 * self.dx[i] / (self.ha[i] + self.hb[i]);
        -self.thick[i] * v * slender * slender * slender
    }

    /// Adds panel `i`, which has no film or one behind a front.
    fn partial(&mut self, sums: &mut Sums, s: &Stretch, i: usize, shear: Shear) {
        let (q, floor, pb) = (self.q[i], self.p[i], self.p[i + 1]);
        let mut empty = *s;
        if pb > floor {
            let above = pb - floor;
            // To rounding the film may fill the panel.
            if above >= s.rise(self.u, q) * (1.0 - 1e-15) {
                sums.film(s, self.u, q, (floor, pb), 0.0);
                self.fronts.push(FilmFront { x: s.x, film_before: false });
                return;
            }
            let (x, h) = s.front(self.u, q, above, s.x);
            sums.film(&s.cut(x, h, true), self.u, q, (floor, pb), 0.0);
            self.fronts.push(FilmFront { x, film_before: false });
            empty = s.cut(x, h, false);
        }
        if empty.dx > 0.0 {
            sums.void(&empty, self.u, floor, empty.wet(self.u, q, shear, i < self.lead));
        }
    }

    /// Adds panel `i`, whose pressure is cut off at zero.
    fn clipped(&mut self, sums: &mut Sums, s: &Stretch, i: usize, shear: Shear) {
        let (pa, pb) = (self.p[i], self.p[i + 1]);
        let (high, low) = (pa.max(pb), pa.min(pb));
        let (mut top, mut part) = (0.0, 0.0);
        if high > 0.0 {
            (top, part) = (high, high / (high - low));
        }
        // A straight line of pressure between the nodes.
        let length = part * s.dx;
        let load = 0.5 * top * length;
        let at_b = pb > pa;
        let (x, inwards, edge) = if at_b { (s.x + s.dx, -1.0, s.hb * top) } else { (s.x, 1.0, -s.ha * top) };
        if part > 0.0 {
            self.fronts.push(FilmFront { x: x + inwards * length, film_before: !at_b });
        }
        let i1 = s.i1();
        let wet = match shear {
            Shear::Full => i1,
            // The flux of a film that is cut off says nothing of what is left of it.
            Shear::None | Shear::Streamers => part * i1,
        };
        sums.void(s, self.u, 0.0, wet);
        let slope = s.slope;
        sums.load += load;
        sums.moment += load * (x + inwards * length / 3.0);
        sums.slope -= load * slope;
        sums.gradient += 0.5 * (edge - slope * load) * s.rough.pressure_shear;
    }

    /// The result of the sums, and the answers in the direction of `x`.
    pub fn report(
        &mut self,
        s: &Sums,
        (p_max, x_max): (f64, f64),
        flux_error: f64,
        iterations: usize,
    ) -> Result<Film1dOut, EvalError> {
        let (store_in, store_out) = self.ends_store();
        let (enters, leaves) = (self.q[0] + store_in, self.q[self.n - 1] - store_out);
        let shear = s.couette + s.gradient + s.difference;
        let sum = s.load + s.moment + shear + s.slope + enters + leaves + p_max + flux_error;
        if !sum.is_finite() {
            return Err(self.recoverable("film out of range"));
        }
        let sign = if self.turned { -1.0 } else { 1.0 };
        self.tell();
        Ok(Film1dOut {
            load: s.load,
            moment: sign * s.moment,
            moving_shear: sign * shear,
            fixed_shear: sign * (s.couette - s.gradient - s.difference),
            slope_force: sign * s.slope,
            flux_in: if self.turned { -leaves } else { enters },
            flux_out: if self.turned { -enters } else { leaves },
            p_max: self.p_cav + p_max,
            x_p_max: sign * x_max,
            starved: self.starved,
            flux_error,
            iterations,
        })
    }

    /// Adds the fronts where a film ends downstream: between the last node under pressure and the first without film, moved to
    /// where the flux fills the gap without a gradient.
    fn ruptures(&mut self) {
        for k in 0..self.n {
            if !self.film[k] || self.film[k + 1] {
                continue;
            }
            let filled = 2.0 * self.q[k];
            let mut x = self.x[k + 1];
            for i in k..(k + 2).min(self.n) {
                let (ha, hb) = (self.ha[i], self.hb[i]);
                let (fa, fb) = {
                    let uf = self.u * self.rough[i].sliding_flow;
                    (uf * ha - filled, uf * hb - filled)
                };
                if fa <= 0.0 && fb > 0.0 {
                    x = self.x[i] + self.dx[i] * (fa / (fa - fb));
                }
            }
            // A cavity of one node may be as narrow as nothing; its film does not end behind the place where it begins again.
            let again = self.fronts.iter().filter(|f| !f.film_before && f.x >= self.x[k]);
            let x = again.map(|f| f.x).fold(x, f64::min);
            self.fronts.push(FilmFront { x, film_before: true });
        }
        self.fronts.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(b.film_before.cmp(&a.film_before)));
    }

    /// Highest pressure above `p_cav` and where it is: at a node, or at the crest in a panel beside it.
    fn highest(&self) -> (f64, f64) {
        let mut k = 0;
        for (i, p) in self.p.iter().enumerate() {
            if *p > self.p[k] {
                k = i;
            }
        }
        let (mut high, mut x) = (self.p[k], self.x[k]);
        for i in k.saturating_sub(1)..(k + 1).min(self.n) {
            let (ha, hb, f) = (self.ha[i], self.hb[i], &self.rough[i]);
            let uf = self.u * f.sliding_flow;
            let h = 2.0 * self.q[i] / uf;
            if self.film[i] && h < ha && h > hb {
                let l = self.dx[i] * (ha - h) / (ha - hb);
                let k = 6.0 * self.mu[i] * l / f.pressure_flow;
                let p = self.p[i] + k * (uf - self.q[i] * (ha + h) / (ha * h)) / (ha * h);
                if p > high {
                    (high, x) = (p, self.x[i] + l);
                }
            }
        }
        (high, x)
    }

    /// See [`Film1dOut::flux_error`]: from the pressures and fills of the nodes alone.
    fn flux_error(&self) -> f64 {
        let n = self.n;
        let flux = |i: usize| self.c[i] * self.fill[i] + self.g[i] * (self.p[i] - self.p[i + 1]);
        let scale = |i: usize| self.c[i].max(self.g[i] * self.p[i].abs().max(self.p[i + 1].abs()));
        let stored = |i: usize| if self.change == Change::Steady { 0.0 } else { self.rate[i] };
        let (mut before, mut size) = (flux(0), scale(0));
        let mut worst: f64 = 0.0;
        for i in 1..n {
            let (now, here) = (flux(i), scale(i));
            let off = (before - now - stored(i)).abs();
            if off > 0.0 {
                let kept = match self.change {
                    Change::Steady => 0.0,
                    Change::Rates => self.rate[i].abs(),
                    Change::Step(dt) => self.volume[i] / dt,
                };
                let most = size.max(here).max(kept);
                // A division only where it counts.
                if off > worst * most {
                    worst = off / most;
                }
            }
            (before, size) = (now, here);
        }
        worst
    }

    /// Writes the answers in the direction of `x`.
    fn tell(&mut self) {
        let cav = self.p_cav;
        if self.change == Change::Steady || self.change == Change::Rates {
            volumes(&self.dx, &self.ha, &self.hb, &mut self.volume);
        }
        let n = self.n;
        if self.turned {
            for i in 0..=n {
                let j = n - i;
                self.field_p[i] = cav + self.p[j];
                self.field_fill[i] = self.fill[j];
                self.field_content[i] = self.fill[j] * self.volume[j];
            }
            self.field_flux.iter_mut().zip(self.q.iter().rev()).for_each(|(f, q)| *f = -q);
            self.fronts.reverse();
            for f in &mut self.fronts {
                *f = FilmFront { x: -f.x, film_before: !f.film_before };
            }
        } else {
            for i in 0..=n {
                self.field_p[i] = cav + self.p[i];
                self.field_fill[i] = self.fill[i];
                self.field_content[i] = self.fill[i] * self.volume[i];
            }
            self.field_flux.copy_from_slice(&self.q);
        }
    }

    /// A line without oil, of the inputs taken last.
    pub fn nothing(&mut self) -> Film1dOut {
        self.fronts.clear();
        for v in [&mut self.p, &mut self.fill, &mut self.q] {
            v.fill(0.0);
        }
        self.tell();
        Film1dOut { p_max: self.p_cav, x_p_max: self.nodes[0], ..Film1dOut::default() }
    }

    pub fn field(&self) -> FilmField<'_> {
        FilmField {
            p: &self.field_p,
            fill: &self.field_fill,
            content: &self.field_content,
            flux: &self.field_flux,
            fronts: &self.fronts,
        }
    }

    pub fn full_content(&self, h_a: &[f64], h_b: &[f64], content: &mut [f64]) {
        content.fill(0.0);
        for (i, w) in self.nodes.windows(2).enumerate() {
            if let (Some(a), Some(b)) = (h_a.get(i), h_b.get(i))
                && i + 1 < content.len()
            {
                let dx = w[1] - w[0];
                content[i] += 0.125 * dx * (3.0 * a + b);
                content[i + 1] += 0.125 * dx * (a + 3.0 * b);
            }
        }
    }
}

/// Volume of the halves of the panels beside each node.
fn volumes(dx: &[f64], ha: &[f64], hb: &[f64], volume: &mut [f64]) {
    volume.fill(0.0);
    for i in 0..dx.len() {
        volume[i] += 0.125 * dx[i] * (3.0 * ha[i] + hb[i]);
        volume[i + 1] += 0.125 * dx[i] * (ha[i] + 3.0 * hb[i]);
    }
}

fn copy_back<T: Copy>(to: &mut [T], from: &[T]) {
    to.iter_mut().zip(from.iter().rev()).for_each(|(t, f)| *t = *f);
}
