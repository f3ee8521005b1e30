//! The oil of the skirt over a cycle: moved and booked in equal steps of crank angle, between which the motion is integrated.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::SkirtOil;
use gudgeon_skirt::{Filling, OilMoved};

use super::assembly::Assembly;

/// Oil that the skirt keeps, and its ledger.
pub struct OilKept {
    model: Box<dyn SkirtOil>,
    /// Steps of a cycle.
    steps: usize,
    /// The running cycle.
    cycle: OilCycle,
    /// Whether its steps are kept too.
    pub recording: bool,
    /// Oil that waits before the upper edge of each side \[m³\].
    pub waiting: [f64; 2],
    /// Coordinates that are foreseen \[m\].
    ahead: Vec<f64>,
}

/// Oil of the skirt over a cycle.
#[derive(Debug, Clone, Default)]
pub struct OilCycle {
    /// What happened in every step; empty when nobody asked for it.
    pub steps: Vec<OilStep>,
    /// Ledger.
    pub ledger: OilLedger,
}

/// A step of the oil.
#[derive(Debug, Clone)]
pub struct OilStep {
    /// What every node of both sides had during the step.
    pub filling: [Filling; 2],
    /// Oil that left over the upper edges, the lower edges and the flanks, less what came in \[m³/s\].
    pub flow: [f64; 3],
    /// Oil in the gaps at its end \[m³\].
    pub held: f64,
    /// Part of the gaps that it fills.
    pub filled: f64,
}

/// Oil of the skirt over a cycle \[m³\]. Upper edges, lower edges, flanks.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct OilLedger {
    /// What came in.
    pub entered: [f64; 3],
    /// What left.
    pub left: [f64; 3],
    /// Oil in the gaps at the start and at the end.
    pub held: [f64; 2],
}

impl OilLedger {
    /// What the films made of nothing.
    #[must_use]
    pub fn made(&self) -> f64 {
        let [before, after] = self.held;
        let flows: f64 = self.left.iter().zip(self.entered).map(|(l, e)| l - e).sum();
        flows + (after - before)
    }

    /// The same as a part of all that came in and of what was there.
    #[must_use]
    pub fn error(&self) -> f64 {
        let all = self.entered.iter().sum::<f64>() + self.held[0];
        if all > 0.0 { self.made().abs() / all } else { 0.0 }
    }
}

impl OilKept {
    /// Of a supply, in a cycle of `period` \[rad\].
    #[must_use]
    pub fn new(model: Box<dyn SkirtOil>, period: f64) -> Self {
        // A step that fits to rounding is not halved.
        let steps = (period / model.step() * (1.0 - 1e-12)).ceil().max(1.0) as usize;
        Self {
            model,
            steps,
            cycle: OilCycle::default(),
            recording: false,
            waiting: [0.0; 2],
            ahead: Vec::new(),
        }
    }

    fn book(&mut self, moved: &[OilMoved; 2], dt: f64, filling: [Filling; 2]) {
        let ledger = &mut self.cycle.ledger;
        for (k, q) in moved.iter().flat_map(|m| m.left.into_iter().enumerate()) {
            if q < 0.0 { ledger.entered[k] -= q } else { ledger.left[k] += q }
        }
        let sum = |of: fn(&OilMoved) -> f64| moved.iter().map(of).sum::<f64>();
        let (held, room) = (sum(|m| m.held), sum(|m| m.room));
        ledger.held[1] = held;
        if self.recording {
            let filled = if room > 0.0 { held / room } else { 0.0 };
            let flow = [0, 1, 2].map(|k| moved.iter().map(|m| m.left[k]).sum::<f64>() / dt);
            self.cycle.steps.push(OilStep { filling, flow, held, filled });
        }
    }

    /// Films \[m\] that the edges of both sides meet over a step of `dt` \[s\] to the crank angle `t` \[rad\], on a piston at `speed` \[m/s\] away from the head.
    fn arriving(&self, widths: [f64; 2], t: f64, speed: f64, dt: f64) -> [[f64; 2]; 2] {
        let [above, below] = self.model.arriving(t);
        let swept = |width: f64| width * (speed.abs() * dt).max(LEAST_WAY);
        [0, 1].map(|side: usize| [above + self.waiting[side] / swept(widths[side]), below])
    }

    /// What waits before the upper edges after a step over which `moved` happened: what left there, what the edge did not take of the film on the liner, less
    /// what it took beyond that film.
    fn wait(&mut self, moved: &[OilMoved; 2], widths: [f64; 2], t: f64, speed: f64, dt: f64) {
        let film = self.model.arriving(t)[0];
        for (side, moved) in moved.iter().enumerate() {
            let brought = widths[side] * film * (-speed * dt).max(0.0);
            let most = widths[side] * self.model.room_above();
            self.waiting[side] = (self.waiting[side] + brought + moved.left[0]).clamp(0.0, most);
        }
    }
}

/// Unit of the oil at a node, as the search of the periodic motion sees it \[m\].
const OIL_FILM: f64 = 1e-6;
/// Unit of the oil that waits over its arc \[m²\].
const OIL_WAITING: f64 = 1e-7;

/// Way of the liner over which waiting oil comes in at least \[m\]: at a dead centre none goes anywhere.
const LEAST_WAY: f64 = 1e-6;

impl Assembly {
    /// Steps in which a cycle is integrated: those of the oil, or one.
    #[must_use]
    pub fn oil_steps(&self) -> usize {
        self.oil.as_ref().map_or(1, |o| o.steps)
    }

    /// Crank angle \[rad\] at which step `k` of the oil begins.
    #[must_use]
    pub fn oil_angle(&self, k: usize) -> f64 {
        self.period * k as f64 / self.oil_steps() as f64
    }

    /// Crank angles \[rad\] at which something jumps or bends, and the end of the cycle: the gas, the sense of motion, and what is filled of the films.
    #[must_use]
    pub fn bends(&self) -> Vec<f64> {
        let steps = (1..=self.oil_steps()).map(|k| self.oil_angle(k));
        let mut all: Vec<f64> = self.breakpoints.iter().copied().chain(steps).collect();
        all.sort_by(f64::total_cmp);
        all
    }

    /// The cycle of the oil that was integrated last.
    pub fn take_oil_cycle(&mut self) -> Option<OilCycle> {
        self.oil.as_mut().map(|o| std::mem::take(&mut o.cycle))
    }

    /// Puts the film of the first cycle into the gaps at the states `y`.
    ///
    /// # Errors
    /// A gap that is none.
    pub fn first_oil(&mut self, y: &[f64], x: &mut [f64]) -> Result<(), EvalError> {
        let Some(film) = self.oil.as_ref().map(|o| o.model.initial()) else { return Ok(()) };
        self.coordinates(y, x);
        self.piston.begin_oil(&self.instant(0.0), x, Some(film))
    }

    /// Begins a cycle at the states `y`; `w` are the rates of the coordinates \[m/s\].
    ///
    /// # Errors
    /// A film that cannot be solved.
    pub fn begin_oil(&mut self, y: &[f64], w: &[f64]) -> Result<(), EvalError> {
        let held = self.piston.held();
        let Some(oil) = &mut self.oil else { return Ok(()) };
        oil.cycle = OilCycle::default();
        oil.cycle.ledger.held = [held; 2];
        let mut x = vec![0.0; w.len()];
        self.coordinates(y, &mut x);
        self.piston.begin_oil(&self.instant(0.0), &x, None)?;
        self.foresee_oil(0, y, w)
    }

    /// Foresees which nodes carry pressure during step `k`, which begins at the states `y`.
    fn foresee_oil(&mut self, k: usize, y: &[f64], w: &[f64]) -> Result<(), EvalError> {
        let Some(mut oil) = self.oil.take() else { return Ok(()) };
        let (t, dt) = (self.period * (k + 1) as f64 / oil.steps as f64, self.oil_time(oil.steps));
        oil.ahead.resize(w.len(), 0.0);
        self.coordinates(y, &mut oil.ahead);
        let v = self.motion.pose(&y[self.layout.motion.clone()]).v.unwrap_or([w[0], w[1]]);
        for (x, w) in oil.ahead.iter_mut().zip(v.iter().chain(&w[2..])) {
            *x += dt * w;
        }
        let then = self.instant(t);
        let arriving = oil.arriving(self.widths(), t, then.speed, dt);
        let outcome = self.piston.foresee_oil(&then, &oil.ahead, dt, arriving);
        self.oil = Some(oil);
        outcome
    }

    /// Lengths of the arcs of both sides \[m\].
    fn widths(&self) -> [f64; 2] {
        [0, 1].map(|side: usize| self.piston.sides[side].panel.width())
    }

    /// Number of values that say where the oil is, for the search of the periodic motion.
    #[must_use]
    pub fn oil_values(&self) -> usize {
        if self.oil.is_some() { self.piston.contents() + 2 } else { 0 }
    }

    /// What they are: films at all nodes and waiting oil over its arc, in units of `OIL_FILM` and `OIL_WAITING`.
    pub fn oil_state(&self, out: &mut [f64]) {
        let Some(oil) = &self.oil else { return };
        let (films, waiting) = out.split_at_mut(self.piston.contents());
        self.piston.content(films);
        films.iter_mut().for_each(|film| *film /= OIL_FILM);
        for ((out, volume), width) in waiting.iter_mut().zip(oil.waiting).zip(self.widths()) {
            *out = volume / width / OIL_WAITING;
        }
    }

    /// Takes them.
    pub fn set_oil_state(&mut self, state: &[f64]) {
        let widths = self.widths();
        let Some(oil) = &mut self.oil else { return };
        let (films, waiting) = state.split_at(self.piston.contents());
        for ((volume, state), width) in oil.waiting.iter_mut().zip(waiting).zip(widths) {
            *volume = (state * width * OIL_WAITING).clamp(0.0, width * oil.model.room_above());
        }
        let films: Vec<f64> = films.iter().map(|film| film * OIL_FILM).collect();
        self.piston.set_content(&films);
    }

    fn oil_time(&self, steps: usize) -> f64 {
        self.period / steps as f64 / self.omega()
    }

    /// Moves the oil over step `k`, at whose end the states are `y` and the rates of the coordinates `w` \[m/s\]; `x` takes the coordinates.
    ///
    /// # Errors
    /// A film that cannot be solved.
    pub fn move_oil(&mut self, k: usize, y: &[f64], w: &[f64], x: &mut [f64]) -> Result<(), EvalError> {
        let Some(oil) = &self.oil else { return Ok(()) };
        let (t, steps) = (self.oil_angle(k + 1), oil.steps);
        let (dt, widths, then) = (self.oil_time(steps), self.widths(), self.instant(t));
        let arriving = oil.arriving(widths, t, then.speed, dt);
        let filling = if oil.recording { self.piston.filling() } else { Default::default() };
        self.coordinates(y, x);
        let moved = self.piston.move_oil(&then, x, dt, arriving)?;
        if let Some(oil) = &mut self.oil {
            oil.book(&moved, dt, filling);
            oil.wait(&moved, widths, t, then.speed, dt);
        }
        if k + 1 < steps { self.foresee_oil(k + 1, y, w) } else { Ok(()) }
    }
}
