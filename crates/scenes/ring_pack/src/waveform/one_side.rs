//! One side of a pack as an initial-value problem.

use gudgeon_core::EvalError;
use gudgeon_core::states::Stage;
use gudgeon_numerics::ode::{LinearInvariant, OdeSystem, StepView};
use gudgeon_numerics::sdirk;

use super::super::films_between::FilmsBetween;
use super::super::pack::Pack;
use super::super::staged::Staging;
use super::growing::Growing;
use super::guess::Guess;
use super::half::Side;
use super::joint::Part;
use super::repeat::Repeat;
use super::rings::RingSteps;
use super::track::Track;

/// The side that stands beside the one that is integrated.
pub enum Other<'a> {
    /// Films as they were in the last cycle, with their forces on the rings.
    Was { wave: &'a Track, forces: &'a Track },
    /// Gas and grooves as they are in this one.
    Is(&'a Growing),
}

/// One side as an initial-value problem beside the other.
pub struct OneSide<'a> {
    pub side: Side,
    pub pack: &'a mut Pack,
    pub staging: &'a mut Staging,
    pub part: &'a Part,
    invariants: &'a [LinearInvariant],
    other: (&'a Part, Other<'a>),
    /// All states at an instant.
    pub y: Vec<f64>,
    /// What the other side is then.
    beside: Vec<f64>,
    /// Forces of the films: those given, or those found at the start and at the stages of the step, one instant after the other.
    pub axial: Vec<f64>,
    /// Base, and accuracy, of a stage for all states.
    base: Vec<f64>,
    accuracy: Vec<f64>,
    quads: Vec<f64>,
    /// States whose errors the steps of the rings judge, by their rows.
    pub judged: Vec<usize>,
    guess: Guess,
    /// The same stages of the cycle before, where they are known.
    pub repeat: Option<&'a mut Repeat>,
}

impl<'a> OneSide<'a> {
    pub fn new(
        side: Side,
        (pack, staging): (&'a mut Pack, &'a mut Staging),
        (part, invariants): (&'a Part, &'a [LinearInvariant]),
        other: (&'a Part, Other<'a>),
    ) -> Self {
        let n = pack.layout.n;
        let instants = if side == Side::Films { sdirk::PLACES.len() } else { 1 };
        let rings = staging.rings.iter().filter(|_| side == Side::Grooves);
        let judged = rings.flat_map(RingSteps::judged).filter_map(|k| part.row(k, n)).collect();
        Self {
            side,
            staging,
            part,
            invariants,
            y: vec![0.0; n],
            beside: vec![0.0; other.0.states.len()],
            other,
            axial: vec![0.0; instants * pack.n_rings()],
            base: vec![0.0; n],
            accuracy: vec![1.0; n],
            quads: vec![0.0; pack.layout.quads()],
            judged,
            guess: Guess::default(),
            repeat: None,
            pack,
        }
    }

    /// All states for those of this side.
    fn fill(&mut self, t: f64, y: &[f64]) -> Result<(), EvalError> {
        self.part.put(y, &mut self.y);
        let (part, other) = &self.other;
        match other {
            Other::Was { wave, forces } => {
                wave.eval(t, 0, &mut self.beside);
                forces.eval(t, 0, &mut self.axial);
            }
            Other::Is(wave) => wave.eval(t, &mut self.beside)?,
        }
        part.put(&self.beside, &mut self.y);
        Ok(())
    }

    fn evaluate(&mut self, t: f64, y: &[f64]) -> Result<(), EvalError> {
        self.fill(t, y)?;
        self.pack.evaluate_of(self.side, t, &self.y, &self.axial)?;
        self.keep_forces(0)
    }

    /// Keeps the forces of the films at an instant of the step.
    fn keep_forces(&mut self, instant: usize) -> Result<(), EvalError> {
        if self.side != Side::Films {
            return Ok(());
        }
        let n = self.pack.n_rings();
        let kept = self.axial[instant * n..].iter_mut();
        kept.zip(&self.pack.at.rings).for_each(|(f, r)| *f = r.axial.film);
        if self.pack.between.is_some() {
            (0..n).try_for_each(|i| self.pack.film_peak(i))?;
        }
        let Pack { at, between, .. } = &mut *self.pack;
        between.iter_mut().for_each(|films| films.keep(instant, &at.rings));
        Ok(())
    }

    /// The end of the step is the start of the next.
    pub fn next(&mut self) {
        let n = self.pack.n_rings();
        let last = self.axial.len() - n;
        self.axial.copy_within(last.., 0);
        self.pack.between.iter_mut().for_each(FilmsBetween::go_on);
    }

    /// Books the oil of an accepted step of the films.
    pub fn book(&mut self, v: &dyn StepView) {
        self.part.put(v.y0(), &mut self.base);
        self.part.put(v.y1(), &mut self.y);
        self.pack.book_oil((v.t0(), &self.base), (v.t1(), &self.y));
    }

    /// The rows of the states that are guessed, and what drives them where the pressure in the cylinder is `p` \[Pa\]: gas and the oil under faces, for
    /// rings and films are found by brackets.
    fn guessed(&self, p: f64) -> (std::ops::Range<usize>, Option<f64>) {
        let layout = &self.pack.layout;
        if self.side == Side::Grooves {
            return (0..layout.gas.len(), Some(p));
        }
        let films = self.pack.films();
        // Without oil films are found by brackets.
        let first = if layout.oil.is_empty() { films } else { 0 };
        (first..films + layout.oil.len(), None)
    }

    fn quadratures(&mut self, q: &mut [f64]) {
        if q.is_empty() {
            return;
        }
        self.pack.quadratures(&mut self.quads);
        q.iter_mut().zip(&self.part.quads).for_each(|(q, &k)| *q = self.quads[k]);
    }
}

impl OdeSystem for OneSide<'_> {
    fn dim(&self) -> usize {
        self.part.states.len()
    }
    fn quad_dim(&self) -> usize {
        self.part.quads.len()
    }
    fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        self.evaluate(t, y)?;
        if let (Side::Grooves, Some(rings)) = (self.side, &mut self.staging.rings) {
            rings.begin(self.pack);
        }
        let n = self.part.states.len();
        for (f, &k) in f.iter_mut().zip(&self.part.states) {
            *f = self.pack.rate(k);
        }
        self.quadratures(&mut f[n..]);
        Ok(())
    }
    /// Stages come in their order, the second after the first.
    fn stage(&mut self, t: f64, stage: &Stage<'_>, y: &mut [f64], g: &mut [f64]) -> Result<(), EvalError> {
        let p = self.pack.cylinder.pressure(t);
        let (guessed, drive) = self.guessed(p);
        let part = Stage { base: &stage.base[guessed.clone()], ..*stage };
        self.guess.apply(t, &part, drive, &mut y[guessed.clone()]);
        if let Some(repeat) = &mut self.repeat {
            repeat.apply(t, stage, y);
        }
        self.fill(t, y)?;
        self.part.put(stage.base, &mut self.base);
        self.part.put(stage.accuracy, &mut self.accuracy);
        let whole = Stage { base: &self.base, accuracy: &self.accuracy, ..*stage };
        self.pack.stage_of(self.side, (t, p), &whole, &mut self.y, &self.axial, self.staging)?;
        self.part.take(&self.y, y);
        self.guess.learn(t, &part, &y[guessed]);
        if let Some(repeat) = &mut self.repeat {
            repeat.learn(t, stage, y);
        }
        self.keep_forces(stage.number)?;
        self.quadratures(g);
        Ok(())
    }
    fn invariants(&self) -> &[LinearInvariant] {
        self.invariants
    }
    fn tolerances(&mut self, t: f64, y: &[f64], atol: &mut [f64]) {
        let known =
            self.pack.at.theta == t && self.part.states.iter().zip(y).all(|(&k, v)| self.pack.state[k] == *v);
        if !known && self.evaluate(t, y).is_err() {
            return;
        }
        if self.side == Side::Grooves {
            // Gas comes first, and the steps of the rings judge the rest.
            self.pack.gas.ease(&mut atol[..self.pack.layout.gas.len()]);
            self.judged.iter().for_each(|&row| atol[row] = f64::INFINITY);
            return;
        }
        self.part.put(atol, &mut self.base);
        self.pack.ease_films(&mut self.base);
        self.part.take(&self.base, atol);
    }
}
