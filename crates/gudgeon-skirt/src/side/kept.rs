//! Oil that one side keeps from instant to instant: what every node holds, and which nodes are filled.

use gudgeon_core::kinds::{Film2dGrid, Film2dIn, Film2dOut, FlowFactors, History, RoughFlow, Superposition};
use gudgeon_core::{BuildError, EvalError};

use super::Side;
use super::gap::film_input;

/// Oil per area \[m\] that every node of a side has during a step; infinite where it is full throughout.
pub type Filling = Vec<f64>;

/// Oil of a side.
pub(super) struct Kept {
    /// Oil per area at every node \[m\].
    content: Vec<f64>,
    /// Areas of the control volumes that hold it, both halves counted \[m²\].
    areas: Vec<f64>,
    /// Whether a node is full.
    full: Vec<bool>,
    filling: Filling,
}

/// Part of the gap below a full one over which a node comes to carry pressure: it would strike the piston otherwise.
const SOFT: f64 = 0.1;
/// Filling from which a node is full where it was.
const FULL: f64 = 0.999;

/// How much of a full film's pressure a node takes at a filling `fill`, which may be above 1: a cubic between `1 - SOFT` and 1.
fn engaged(fill: f64) -> f64 {
    let s = ((fill - 1.0) / SOFT + 1.0).clamp(0.0, 1.0);
    s * s * (3.0 - 2.0 * s)
}

/// A step of the oil of a side.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OilMoved {
    /// Oil that left over the upper edge, over the lower edge and over the flanks, less what came in \[m³\].
    pub left: [f64; 3],
    /// Oil in the gap at the end \[m³\].
    pub held: f64,
    /// Oil that the gap would hold if it were full \[m³\].
    pub room: f64,
}

/// Where a step of the oil goes to.
#[derive(Debug, Clone, Copy)]
pub struct OilWay<'a> {
    /// Displacements of both edges \[m\] and elastic amplitudes of the side \[m\] at its end.
    pub e: [f64; 2],
    /// Elastic amplitudes of the side \[m\] there.
    pub q: &'a [f64],
    /// Velocity of the piston away from the head \[m/s\] there.
    pub speed: f64,
    /// Viscosity \[Pa s\].
    pub mu: f64,
    /// Time \[s\].
    pub dt: f64,
    /// Films on the liner that the upper and the lower edge meet \[m\].
    pub arriving: [f64; 2],
}

impl Kept {
    fn new(grid: &Film2dGrid, is_half: bool) -> Self {
        let halves = |line: &[f64]| -> Vec<f64> {
            let last = line.len() - 1;
            (0..=last).map(|i| 0.5 * (line[(i + 1).min(last)] - line[i.saturating_sub(1)])).collect()
        };
        let both = if is_half { 2.0 } else { 1.0 };
        let (wx, wy) = (halves(&grid.x), halves(&grid.y));
        let areas: Vec<f64> = wy.iter().flat_map(|wy| wx.iter().map(move |wx| both * wx * wy)).collect();
        let n = areas.len();
        Self { content: vec![0.0; n], areas, full: vec![true; n], filling: vec![f64::INFINITY; n] }
    }

    /// How far the nodes of a gap are filled that would hold `room`, and how much of a full film's pressure they take.
    pub(super) fn fill(&self, room: &[f64], fill: &mut [f64], taken: &mut [f64]) {
        for (k, room) in room.iter().enumerate() {
            let part = if *room > 0.0 { self.filling[k] / room } else { 1.0 };
            (fill[k], taken[k]) = (part.min(1.0), engaged(part));
        }
    }

    fn held(&self) -> f64 {
        gudgeon_numerics::linalg::dot(&self.areas, &self.content)
    }
}

impl Side {
    /// From now on the films keep the oil they have.
    ///
    /// # Errors
    /// A film that does not know how full it is, or one whose cavities stand at another pressure than its edges.
    pub fn keep_oil(&mut self) -> Result<(), BuildError> {
        if !self.film.keeps_fill() {
            let what = "this film does not know how full it is, and can keep no oil";
            return Err(BuildError::at("models.film_2d", what)
                .help("use `direct` with `cavitation = \"mass_conserving\"`, or `skirt_oil` `off`"));
        }
        if self.p_cav != 0.0 {
            let what = "a gap that is not full is open to the crankcase and stands at its pressure";
            return Err(BuildError::at("gas.cavitation_pressure", what)
                .help("leave it out, or use `skirt_oil` `off`"));
        }
        // Between steps of the oil the film is full where it is filled, and cut off where it tears.
        self.superposition = Superposition::CutOff;
        self.kept = Some(Kept::new(self.film.grid(), self.is_half));
        Ok(())
    }

    /// Oil per area at the nodes that are solved \[m\]; none when no oil is kept.
    #[must_use]
    pub fn content(&self) -> &[f64] {
        self.kept.as_ref().map_or(&[], |k| &k.content)
    }

    /// Oil in the gap \[m³\].
    #[must_use]
    pub fn held(&self) -> f64 {
        self.kept.as_ref().map_or(0.0, Kept::held)
    }

    /// Takes the oil per area at the nodes \[m\].
    pub fn set_content(&mut self, content: &[f64]) {
        if let Some(kept) = &mut self.kept {
            // What a search extrapolates may be less than none.
            kept.content.iter_mut().zip(content).for_each(|(own, c)| *own = c.max(0.0));
        }
    }

    /// Begins to follow the oil at a place: nodes that hold what there is room for are full. `first` is the film \[m\] with which the very first cycle begins, or
    /// what there is room for.
    ///
    /// # Errors
    /// A gap that is none.
    pub fn begin_oil(
        &mut self,
        e: [f64; 2],
        q: &[f64],
        speed: f64,
        first: Option<f64>,
    ) -> Result<(), EvalError> {
        self.shape_gap(true, e, q, speed)?;
        let room = room_of(&self.trial.flow, self.trial.is_rough);
        let Some(kept) = &mut self.kept else { return Ok(()) };
        for (k, room) in room.iter().enumerate() {
            if let Some(film) = first {
                kept.content[k] = film.min(*room);
            }
            kept.full[k] = kept.content[k] >= FULL * room;
        }
        Ok(())
    }

    /// What every node has during a step.
    #[must_use]
    pub fn filling(&self) -> Filling {
        self.kept.as_ref().map_or_else(Vec::new, |k| k.filling.clone())
    }

    /// Takes what every node has during a step.
    pub fn set_filling(&mut self, filling: &[f64]) {
        if let Some(kept) = &mut self.kept {
            kept.filling.copy_from_slice(filling);
            self.placed.clear();
        }
    }

    /// Foresees what every node will hold at the end of a step: that it has during the step, and carries pressure as soon as that fills the gap.
    ///
    /// # Errors
    /// A gap that is none at the present place either.
    pub fn foresee(&mut self, way: &OilWay<'_>) -> Result<(), EvalError> {
        let found = self.oil_step(way);
        let Some(kept) = &mut self.kept else { return Ok(()) };
        match found {
            Ok(_) => {
                let room = room_of(&self.trial.flow, self.trial.is_rough);
                let (p, fill) = (self.film.pressure(), self.film.fill());
                for k in 0..room.len() {
                    let then = room[k] * fill[k];
                    kept.filling[k] = match (p[k] > 0.0, kept.full[k]) {
                        (true, true) => f64::INFINITY,
                        (true, false) => then.max(kept.content[k]),
                        (false, _) => then,
                    };
                }
            }
            // No film is found there, as of surfaces that would pass through one another: what is there now counts.
            Err(e) if e.is_recoverable() => {
                for (filling, (full, content)) in
                    kept.filling.iter_mut().zip(kept.full.iter().zip(&kept.content))
                {
                    *filling = if *full { f64::INFINITY } else { *content };
                }
            }
            Err(e) => return Err(e),
        }
        self.placed.clear();
        Ok(())
    }

    /// Moves the oil over a step that was taken.
    ///
    /// # Errors
    /// A film that cannot be solved.
    pub fn move_oil(&mut self, way: &OilWay<'_>) -> Result<OilMoved, EvalError> {
        let out = self.oil_step(way)?;
        let room = room_of(&self.trial.flow, self.trial.is_rough);
        let Some(kept) = &mut self.kept else { return Ok(OilMoved::default()) };
        for (k, (room, fill)) in room.iter().zip(self.film.fill()).enumerate() {
            kept.content[k] = room * fill;
            kept.full[k] = *fill >= FULL;
        }
        let [up, down, left, right] = out.outflow;
        let (both, flanks) = if self.is_half { (2.0, 2.0 * left) } else { (1.0, left + right) };
        Ok(OilMoved {
            left: [both * up, both * down, flanks].map(|q| way.dt * q),
            held: kept.held(),
            room: gudgeon_numerics::linalg::dot(&kept.areas, room),
        })
    }

    /// The film at the end of a step from the oil of now, by the solver alone.
    fn oil_step(&mut self, way: &OilWay<'_>) -> Result<Film2dOut, EvalError> {
        self.shape_gap(true, way.e, way.q, way.speed)?;
        let Some(kept) = &self.kept else { return Ok(Film2dOut::default()) };
        let gap = &self.trial;
        let plain = film_input(gap, kept.content.len());
        let [scaled, _, _] = &mut self.work;
        let content: &[f64] = if gap.is_rough { &gap.flow.content } else { &[] };
        let found = self.film.solve(&Film2dIn {
            u: -way.speed,
            mu: gap.viscosity(way.mu, scaled),
            history: Some(History { dt: way.dt, content: &kept.content }),
            arriving: Some(way.arriving),
            unfilled: None,
            factors: FlowFactors { content, ..plain.factors },
            ..plain
        })?;
        self.evaluations += 1;
        // The matrix is no longer that of the present place.
        self.placed.clear();
        Ok(found)
    }
}

/// Oil per area that a full gap holds.
pub(super) fn room_of(flow: &RoughFlow, is_rough: bool) -> &[f64] {
    if is_rough { &flow.content } else { &flow.film }
}
