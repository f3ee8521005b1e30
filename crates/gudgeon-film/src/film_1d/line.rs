//! What every model of a film along a line needs: the panels of the line, turned so that the surface moves along `+x`, and the
//! film found on them.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{Film1dCtx, FilmField, FilmFront, PanelFactors};

use super::panel::Stretch;

/// How the oil stored along the line changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Change {
    Steady,
    /// At a given rate at each node.
    Rates,
    /// In a step of this length, from a given content.
    Step(f64),
}

/// A line with its panels and the film found on it, in the direction of sliding: `u ≥ 0`, coordinate `±x`.
#[derive(Debug)]
pub struct Line {
    pub model: &'static str,
    pub nodes: Vec<f64>,
    /// Number of panels.
    pub n: usize,
    /// Sliding is along `-x`.
    pub turned: bool,
    pub smooth: bool,
    pub u: f64,
    pub p_cav: f64,
    /// Nodes in the direction of sliding.
    pub x: Vec<f64>,
    pub dx: Vec<f64>,
    pub ha: Vec<f64>,
    pub hb: Vec<f64>,
    pub mu: Vec<f64>,
    /// `1/dx`, and `μ/φ_p`.
    pub per_dx: Vec<f64>,
    pub thick: Vec<f64>,
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
    pub field_p: Vec<f64>,
    pub field_fill: Vec<f64>,
    pub field_content: Vec<f64>,
    pub field_flux: Vec<f64>,
    pub fronts: Vec<FilmFront>,
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
pub fn volumes(dx: &[f64], ha: &[f64], hb: &[f64], volume: &mut [f64]) {
    volume.fill(0.0);
    for i in 0..dx.len() {
        volume[i] += 0.125 * dx[i] * (3.0 * ha[i] + hb[i]);
        volume[i + 1] += 0.125 * dx[i] * (ha[i] + 3.0 * hb[i]);
    }
}
