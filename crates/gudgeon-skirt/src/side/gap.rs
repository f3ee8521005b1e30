//! A gap and the film in it.

use gudgeon_core::kinds::{Film2dIn, FlowFactors, RoughFlow, Unfilled, Viscosity};

/// A film and what it depends on besides the rates.
#[derive(Default)]
pub(super) struct Gap {
    pub(super) h: Vec<f64>,
    pub(super) flow: RoughFlow,
    pub(super) face_x: Vec<f64>,
    pub(super) face_y: Vec<f64>,
    /// Shear stress on the liner per viscosity and speed, without the filling.
    pub(super) drag: Vec<f64>,
    /// The same summed over full nodes, by itself and times `R cos φ`.
    pub(super) full_drag: [f64; 2],
    /// Axial force per pressure of a node, and the same times `R cos φ`.
    pub(super) lever: Vec<f64>,
    pub(super) moment: Vec<f64>,
    /// Relative viscosity, when it varies.
    pub(super) thinning: Vec<f64>,
    pub(super) smallest: f64,
    pub(super) is_rough: bool,
    /// Filling of the nodes, and how much of a full film's pressure they take; empty when no oil is kept.
    pub(super) fill: Vec<f64>,
    pub(super) engaged: Vec<f64>,
}

impl Gap {
    pub(super) fn new(n: usize, is_rough: bool) -> Self {
        let v = || vec![0.0; n];
        Self {
            h: v(),
            flow: RoughFlow::new(n),
            face_x: v(),
            face_y: v(),
            drag: v(),
            full_drag: [0.0; 2],
            lever: v(),
            moment: v(),
            thinning: Vec::new(),
            smallest: f64::INFINITY,
            is_rough,
            fill: Vec::new(),
            engaged: Vec::new(),
        }
    }

    /// Viscosity of the film when that of slow shear is `mu`; `work` takes that of the nodes, when it varies.
    pub(super) fn viscosity<'a>(&self, mu: f64, work: &'a mut [f64]) -> Viscosity<'a> {
        if self.thinning.is_empty() {
            return Viscosity::Uniform(mu);
        }
        work.iter_mut().zip(&self.thinning).for_each(|(w, t)| *w = mu * t);
        Viscosity::Nodes(work)
    }
}

/// A gap held above `floor`: itself from twice the floor on, with continuous slope, and the floor where surfaces touch.
pub(super) fn held_above(h: f64, floor: f64) -> f64 {
    if h >= 2.0 * floor {
        h
    } else if h <= 0.0 {
        floor
    } else {
        floor + 0.25 * h * h / floor
    }
}

/// A film of unit viscosity without causes, filled as the oil that is kept says.
pub(super) fn film_input<'a>(gap: &'a Gap, n: usize) -> Film2dIn<'a> {
    let flow = &gap.flow;
    let factor = |f: &'a [f64]| if gap.is_rough { f } else { &[] };
    Film2dIn {
        h_face_x: &gap.face_x,
        h_face_y: &gap.face_y,
        mu: if gap.thinning.len() == n { Viscosity::Nodes(&gap.thinning) } else { Viscosity::Uniform(1.0) },
        p_cav: 0.0,
        factors: FlowFactors {
            pressure_x: factor(&flow.phi_x),
            pressure_y: factor(&flow.phi_y),
            transport: factor(&flow.transport),
            content: &[],
        },
        unfilled: (gap.fill.len() == n).then(|| Unfilled { engaged: &gap.engaged, fill: &gap.fill }),
        ..Film2dIn::new(&flow.film, 0.0, 1.0)
    }
}
