//! A stage of a step of one ring in its groove: its motion is solved by its model, the oil on its flanks by secants, in turns.

use gudgeon_core::EvalError;
use gudgeon_core::geometry::RingPlace;
use gudgeon_core::kinds::{AxialForces, FlankIn, RingForces, RingResponse, RingTrials};
use gudgeon_core::states::Stage;
use gudgeon_numerics::sdirk::{GAMMA, PLACES};

use super::super::ring::Ring;
use super::acting::Acting;
use super::span::{MOST_STATES, States};

/// Part of the error of a step that its stages may add.
const STAGES: f64 = 0.005;
/// Change of the oil over the accuracy of a stage that the motion need not know of.
const SETTLED: f64 = 100.0;
/// Most passes over motion and oil, and most looks at the oil in one.
const PASSES: usize = 10;
const LOOKS: usize = 25;
/// Least slope of what the oil lacks: more of it never brings more.
const LEAST_SLOPE: f64 = 0.5;

/// A step, and what its stages led to.
#[derive(Debug, Clone, Copy, Default)]
pub struct Step {
    /// Start and length.
    pub t: f64,
    pub h: f64,
    /// States at both stages, and the rates there.
    pub y: [States; 2],
    pub rates: [States; 2],
    /// Errors admitted.
    pub atol: States,
}

impl Step {
    /// A step from the states `y` with the rates `rates`, its stages first as these go on.
    pub fn new(t: f64, h: f64, y: &States, rates: &States, atol: States) -> Self {
        let guess = [GAMMA, 1.0].map(|part| std::array::from_fn(|j| y[j] + part * h * rates[j]));
        Self { t, h, y: guess, rates: [*rates; 2], atol }
    }

    /// Guesses the second stage at the rates of the first.
    pub fn go_on(&mut self, y0: &States) {
        self.y[1] = std::array::from_fn(|j| y0[j] + self.h * self.rates[0][j]);
    }

    /// Instant of a stage.
    pub fn instant(&self, number: usize) -> f64 {
        self.t + self.h * PLACES[number]
    }

    /// Accuracy of its stages.
    pub fn accuracy(&self, y0: &States, relative: &States) -> States {
        std::array::from_fn(|j| STAGES * (self.atol[j] + relative[j] * y0[j].abs()))
    }

    /// What stage `number` starts from.
    fn base(&self, number: usize, y0: &States) -> States {
        let part = if number == 1 { 0.0 } else { self.h * (1.0 - GAMMA) };
        std::array::from_fn(|j| y0[j] + part * self.rates[0][j])
    }
}

/// A ring whose stages are solved.
pub struct RingStage<'a> {
    ring: &'a mut Ring,
    /// States of the motion, and all.
    sizes: (usize, usize),
    /// How what the oil lacks grows with it.
    slope: &'a mut States,
    /// What acts on the ring, with the place where it stands after a stage, and what the motion answered.
    forces: RingForces,
    pub response: RingResponse,
}

impl<'a> RingStage<'a> {
    /// For a ring at a place of which its stages change pose and clearance.
    pub fn new(ring: &'a mut Ring, sizes: (usize, usize), slope: &'a mut States, place: &RingPlace) -> Self {
        let forces = RingForces::new(*place, AxialForces::default());
        Self { ring, sizes, slope, forces, response: RingResponse::default() }
    }

    /// Where the ring stands after a stage.
    pub const fn place(&self) -> &RingPlace {
        &self.forces.place
    }

    /// Eases the errors admitted of a ring where it stands.
    pub fn ease(&self, atol: &mut States) {
        ease(self.ring, self.sizes, atol);
    }

    /// Solves stage `number` of a step from `y0`, where `at` acts; the oil that leaves the flanks \[m²/s\].
    pub fn solve(
        &mut self,
        step: &mut Step,
        (number, y0): (usize, &States),
        accuracy: &States,
        at: &Acting,
    ) -> Result<f64, EvalError> {
        let base = step.base(number, y0);
        let stage = Stage { number, base: &base, step: GAMMA * step.h, accuracy };
        let y = &mut step.y[number - 1];
        let lost = self.both(&stage, y, at)?;
        let per = 1.0 / stage.step;
        step.rates[number - 1] = std::array::from_fn(|j| (y[j] - base[j]) * per);
        Ok(lost)
    }

    /// Motion and oil in turns.
    fn both(&mut self, stage: &Stage<'_>, y: &mut States, at: &Acting) -> Result<f64, EvalError> {
        let (m, n) = self.sizes;
        self.forces.place.clearance = at.clearance();
        for _ in 0..=PASSES {
            if m > 0 {
                self.motion(stage, &mut y[..n], at)?;
            }
            if m == n {
                return Ok(0.0);
            }
            let before = *y;
            let lost = self.oil(stage, y, at)?;
            let settled = |j: usize| (y[j] - before[j]).abs() <= SETTLED * stage.accuracy[j];
            if m == 0 || (m..n).all(settled) {
                return Ok(lost);
            }
        }
        Err(EvalError::recoverable("ring_pack", "a ring and the oil on its flanks do not settle"))
    }

    /// The motion, with the oil as it is.
    fn motion(&mut self, stage: &Stage<'_>, y: &mut [f64], at: &Acting) -> Result<(), EvalError> {
        let m = self.sizes.0;
        let part = Stage { base: &stage.base[..m], accuracy: &stage.accuracy[..m], ..*stage };
        self.forces.axial = at.axial();
        let (motion, oil) = y.split_at_mut(m);
        let flank = &self.ring.flank;
        let mut reach = |place: &RingPlace| flank.oil(oil, place);
        let mut trials = RingTrials::new(&mut self.forces, &mut reach);
        self.response = self.ring.motion.stage(&part, motion, &mut trials)?;
        Ok(())
    }

    /// Finds the oil on the flanks where the ring stands; what leaves the flanks \[m²/s\]. Each flank has its own: secants on both at once.
    fn oil(&mut self, stage: &Stage<'_>, y: &mut States, at: &Acting) -> Result<f64, EvalError> {
        let ([above, behind, below], (m, n)) = (at.pressures(), self.sizes);
        let place = &mut self.forces.place;
        let (mut lacks, mut steps, mut dy) = ([0.0; MOST_STATES], [0.0; MOST_STATES], [0.0; MOST_STATES]);
        for look in 0..LOOKS {
            // The last look at the motion was at this oil.
            if look > 0 || m == 0 {
                place.flank = self.ring.flank.oil(&y[m..n], place);
            }
            let at = FlankIn::new(place, above, behind, below);
            let lost = self.ring.flank.rates(&y[m..n], &at, &mut dy[m..n])?.lost;
            let mut settled = true;
            for j in m..n {
                let now = y[j] - stage.base[j] - stage.step * dy[j];
                if look > 0 && steps[j] != 0.0 {
                    self.slope[j] = ((now - lacks[j]) / steps[j]).max(LEAST_SLOPE);
                }
                lacks[j] = now;
                steps[j] = -now / self.slope[j];
                y[j] += steps[j];
                // A slope from before may be too steep.
                let far = if look == 0 { now } else { steps[j] };
                settled &= far.abs() <= stage.accuracy[j];
            }
            if settled {
                return Ok(lost);
            }
        }
        Err(EvalError::recoverable("ring_pack", "the oil on flanks does not settle"))
    }
}

/// Eases the errors admitted of a ring where it stands.
pub fn ease(ring: &Ring, (motion, n): (usize, usize), atol: &mut States) {
    let (own, oil) = atol[..n].split_at_mut(motion);
    ring.motion.ease(own);
    ring.flank.ease(oil);
}
