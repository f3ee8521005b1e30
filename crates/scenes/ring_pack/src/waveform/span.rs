//! A ring in its groove, with the oil on its flanks, at steps of its own between two instants of the gas.
//!
//! The method is that of the pack ([`sdirk`]); the stages of the motion are solved by its model, the oil by secants.

use gudgeon_core::EvalError;
use gudgeon_core::geometry::RingPlace;
use gudgeon_core::kinds::{FlankIn, RingForces, RingPose, RingResponse};
use gudgeon_core::states::Stage;
use gudgeon_numerics::elementary;
use gudgeon_numerics::sdirk::{self, GAMMA};

use super::super::ring::Ring;
use super::acting::{Acting, Values, Variation};

/// Part of the error of a step that its stages may add.
const STAGES: f64 = 0.005;
/// Change of the oil over the accuracy of a stage that the motion need not know of.
const SETTLED: f64 = 20.0;
/// Most steps between two instants, rejected ones included.
const MOST: usize = 400;
/// Most passes over motion and oil, and most looks at the oil in one.
const PASSES: usize = 10;
const LOOKS: usize = 25;
/// Least slope of what the oil lacks: more of it never brings more.
const LEAST_SLOPE: f64 = 0.5;
/// Part of the step that the error estimate admits which is taken, and the largest growth.
const SAFETY: f64 = 0.85;
const GROWTH: f64 = 2.0;

/// Most states of a ring in its groove.
pub const MOST_STATES: usize = 6;

/// States of a ring in its groove, motion first, or something of each; zero beyond them.
pub type States = [f64; MOST_STATES];

/// A ring at an instant of the gas.
#[derive(Debug, Clone, Copy, Default)]
pub struct Node {
    pub acting: Acting,
    pub y: States,
    pub rates: States,
    /// Errors admitted from here on, and the step that they allow.
    pub atol: States,
    pub h: f64,
    /// Mean rates of what acts over the span that led here, and its length \[rad\]; zero where nothing is known of it.
    pub trend: (Values, f64),
}

/// A step.
#[derive(Debug, Clone, Copy, Default)]
struct Step {
    /// Start and length.
    t: f64,
    h: f64,
    /// States at both stages, the rates there, and the errors admitted.
    y: [States; 2],
    rates: [States; 2],
    atol: States,
}

/// From one instant of the gas to the next.
#[derive(Debug, Clone, Default)]
pub struct Span {
    steps: Vec<Step>,
    pub end: Node,
    /// Largest error of a step over the tolerance.
    pub error: f64,
    /// Oil that left the flanks \[m² rad/s\].
    pub lost: f64,
    /// What the motion answered, and where the ring stands.
    pub response: RingResponse,
    pub place: RingPlace,
}

impl Span {
    pub fn is_known(&self) -> bool {
        !self.steps.is_empty()
    }

    /// Ends of its steps.
    pub fn ends(&self) -> impl Iterator<Item = f64> {
        self.steps.iter().map(|s| s.t + s.h)
    }

    /// Where the ring stands at the start of step `k`, and the rates there.
    fn before(&self, from: &Node, k: usize) -> (States, States) {
        if k == 0 { (from.y, from.rates) } else { (self.steps[k - 1].y[1], self.steps[k - 1].rates[1]) }
    }

    /// States at an instant.
    fn at(&self, from: &Node, t: f64) -> States {
        let k = self.steps.partition_point(|s| s.t <= t).max(1) - 1;
        let Step { t: t0, h, y, rates, .. } = &self.steps[k];
        let (y0, k0) = self.before(from, k);
        std::array::from_fn(|j| sdirk::between([y0[j], y[1][j]], [k0[j], rates[1][j]], *h, (t - t0) / h))
    }
}

/// One ring over a step of the gas.
#[derive(Debug, Clone, Default)]
pub struct Steps {
    /// States of the motion, and all.
    pub motion: usize,
    pub n: usize,
    pub start: Node,
    /// To the first stage, and from there to the second.
    pub spans: [Span; 2],
    /// Errors admitted before they are eased, and those by magnitude.
    pub atol: States,
    pub relative: States,
    /// How what the oil lacks grows with it.
    slope: States,
}

impl Steps {
    pub fn new(motion: usize, flank: usize) -> Self {
        let atol = [1.0; MOST_STATES];
        Self { motion, n: motion + flank, atol, slope: [1.0; MOST_STATES], ..Self::default() }
    }

    /// Forgets what is kept from stage to stage.
    pub fn forget(&mut self) {
        self.spans.iter_mut().for_each(|w| w.steps.clear());
        self.slope = [1.0; MOST_STATES];
    }

    /// Integrates the span to stage `number`, at whose end `end` acts, the clearance and the pose of `place` apart: by steps that are chosen now, or by those
    /// chosen before.
    pub fn integrate(
        &mut self,
        ring: &mut Ring,
        number: usize,
        end: Acting,
        place: &RingPlace,
        chooses: bool,
    ) -> Result<(), EvalError> {
        let (first, rest) = self.spans.split_at_mut(1);
        let (from, span) = match number {
            1 => (&self.start, &mut first[0]),
            _ => (&first[0].end, &mut rest[0]),
        };
        let (variation, trend) = Variation::new(&from.acting, &end, &from.trend);
        (span.end.acting, span.end.trend) = (end, (trend, end.t - from.acting.t));
        (span.error, span.lost) = (0.0, 0.0);
        let sizes = (self.motion, self.n);
        let accuracy = (&self.atol, &self.relative);
        let mut run =
            Integration { ring, place, from, span, variation, sizes, accuracy, slope: &mut self.slope };
        if chooses {
            run.choose()?;
        } else {
            for k in 0..run.span.steps.len() {
                let error = run.step(k)?;
                run.span.error = run.span.error.max(error);
            }
        }
        if let Some(last) = span.steps.last() {
            (span.end.y, span.end.rates) = (last.y[1], last.rates[1]);
        }
        Ok(())
    }

    /// States at an instant of the step of the gas.
    pub fn at(&self, t: f64) -> States {
        let [first, second] = &self.spans;
        if t <= first.end.acting.t { first.at(&self.start, t) } else { second.at(&first.end, t) }
    }
}

/// Eases the errors admitted of a ring where it stands.
pub fn ease(ring: &Ring, (motion, n): (usize, usize), atol: &mut States) {
    let (own, oil) = atol[..n].split_at_mut(motion);
    ring.motion.ease(own);
    ring.flank.ease(oil);
}

/// The integration of a span.
struct Integration<'a> {
    ring: &'a mut Ring,
    place: &'a RingPlace,
    from: &'a Node,
    span: &'a mut Span,
    variation: Variation,
    /// States of the motion, and all.
    sizes: (usize, usize),
    /// Errors admitted before they are eased, and those by magnitude.
    accuracy: (&'a States, &'a States),
    slope: &'a mut States,
}

/// A stage of a step of a ring.
struct Staged {
    number: usize,
    step: f64,
    base: States,
    accuracy: States,
}

impl Integration<'_> {
    /// Integrates by steps that are chosen now.
    fn choose(&mut self) -> Result<(), EvalError> {
        let (mut t, mut h, mut most) = (self.from.acting.t, self.from.h, GROWTH);
        let end = self.span.end.acting.t;
        self.span.end.atol = self.from.atol;
        self.span.steps.clear();
        for _ in 0..MOST {
            let rest = end - t;
            let last = h >= rest * (1.0 - 1e-9);
            let tried = match h {
                _ if last => rest,
                // Two equal steps rather than a whole one and a crumb.
                h if 2.0 * h > rest => 0.5 * rest,
                h => h,
            };
            let lost = self.span.lost;
            let error = match self.try_step(t, tried) {
                Err(e) if e.is_recoverable() => f64::INFINITY,
                error => error?,
            };
            let factor = SAFETY / elementary::cbrt(error.max(1e-10));
            if error > 1.0 {
                self.span.steps.pop();
                self.span.lost = lost;
                (h, most) = (tried * factor.clamp(0.1, 0.9), 1.0);
                continue;
            }
            let next = tried * factor.clamp(0.2, most);
            (h, most) = (if tried < h { h.max(next) } else { next }, GROWTH);
            self.span.error = self.span.error.max(error);
            self.span.end.atol = *self.accuracy.0;
            ease(self.ring, self.sizes, &mut self.span.end.atol);
            if last {
                self.span.end.h = h;
                return Ok(());
            }
            t += tried;
        }
        Err(EvalError::recoverable("ring_pack", "a ring needs too many steps within one of the gas"))
    }

    /// Adds a step, its stages first as the rates before go on; its error over the tolerance.
    fn try_step(&mut self, t: f64, h: f64) -> Result<f64, EvalError> {
        let k = self.span.steps.len();
        let (y, rates) = self.span.before(self.from, k);
        let guess = [GAMMA, 1.0].map(|part| std::array::from_fn(|j| y[j] + part * h * rates[j]));
        let atol = self.span.end.atol;
        self.span.steps.push(Step { t, h, y: guess, rates: [rates; 2], atol });
        self.step(k)
    }

    /// Integrates step `k`; its error over the tolerance.
    fn step(&mut self, k: usize) -> Result<f64, EvalError> {
        let (y0, k0) = self.span.before(self.from, k);
        let Step { t, h, atol, .. } = self.span.steps[k];
        let relative = self.accuracy.1;
        let accuracy = std::array::from_fn(|j| STAGES * (atol[j] + relative[j] * y0[j].abs()));
        let span = self.span.end.acting.t - self.from.acting.t;
        let mut w = Staged { number: 1, step: GAMMA * h, base: y0, accuracy };
        for number in [1, 2] {
            if number == 2 {
                let first = &self.span.steps[k].rates[0];
                w.base = std::array::from_fn(|j| y0[j] + h * (1.0 - GAMMA) * first[j]);
            }
            w.number = number;
            let x = (t + h * sdirk::PLACES[number] - self.from.acting.t) / span;
            let at = self.variation.at(x, &self.span.end.acting);
            let mut y = self.span.steps[k].y[number - 1];
            let lost = self.stage(&w, &mut y, &at)?;
            self.span.lost += h * lost * [1.0 - GAMMA, GAMMA][number - 1];
            let step = &mut self.span.steps[k];
            step.y[number - 1] = y;
            step.rates[number - 1] = std::array::from_fn(|j| (y[j] - w.base[j]) / w.step);
        }
        let Step { y: [_, y], rates: [first, second], .. } = &self.span.steps[k];
        let error = |j: usize| {
            let scale = atol[j] + relative[j] * y0[j].abs().max(y[j].abs());
            (h * sdirk::error([k0[j], first[j], second[j]]) / scale).abs()
        };
        let each: States = std::array::from_fn(error);
        Ok(each.iter().fold(0.0, |a, b| if b.is_nan() { f64::INFINITY } else { b.max(a) }))
    }

    /// A stage where `at` acts; the oil that leaves the flanks \[m²/s\].
    fn stage(&mut self, w: &Staged, y: &mut States, at: &Acting) -> Result<f64, EvalError> {
        let (m, n) = self.sizes;
        let mut stands = *self.place;
        stands.clearance = at.clearance();
        let (motion, oil) = y[..n].split_at_mut(m);
        let mut lost = 0.0;
        for turn in 0.. {
            if m > 0 {
                let Staged { number, step, base, accuracy } = w;
                let part = Stage { number: *number, base: &base[..m], step: *step, accuracy: &accuracy[..m] };
                let forces = RingForces::new(stands, at.axial());
                let (flank, oil) = (&self.ring.flank, &*oil);
                let mut place = |pose: RingPose| {
                    (stands.s, stands.v, stands.lift_fraction) = (pose.s, pose.v, pose.lift_fraction);
                    stands.flank = flank.oil(oil, &stands);
                    stands
                };
                self.span.response = self.ring.motion.stage(&part, motion, &forces, &mut place)?;
            } else {
                stands.flank = self.ring.flank.oil(oil, &stands);
            }
            if oil.is_empty() {
                break;
            }
            let mut found = [0.0; MOST_STATES];
            found[m..n].copy_from_slice(oil);
            lost = self.find_oil(w, &mut found, &mut stands, at)?;
            let mut change = 0.0_f64;
            for (j, oil) in oil.iter_mut().enumerate() {
                change = change.max(((found[m + j] - *oil) / w.accuracy[m + j]).abs());
                *oil = found[m + j];
            }
            if m == 0 || change <= SETTLED {
                break;
            }
            if turn == PASSES {
                return Err(EvalError::recoverable(
                    "ring_pack",
                    "a ring and the oil on its flanks do not settle",
                ));
            }
        }
        self.span.place = stands;
        Ok(lost)
    }

    /// Finds the oil on the flanks of a ring that stands in `stands`, from a guess; what leaves the flanks \[m²/s\]. Each flank has its own: secants on
    /// both at once.
    fn find_oil(
        &mut self,
        w: &Staged,
        oil: &mut States,
        stands: &mut RingPlace,
        at: &Acting,
    ) -> Result<f64, EvalError> {
        let ([above, behind, below], (m, n)) = (at.pressures(), self.sizes);
        let (mut lacks, mut steps, mut dy) = ([0.0; MOST_STATES], [0.0; MOST_STATES], [0.0; MOST_STATES]);
        for look in 0..LOOKS {
            stands.flank = self.ring.flank.oil(&oil[m..n], stands);
            let inp = FlankIn::new(*stands, above, behind, below);
            let lost = self.ring.flank.rates(&oil[m..n], &inp, &mut dy[m..n])?.lost;
            let mut farthest = 0.0_f64;
            for j in m..n {
                let now = oil[j] - w.base[j] - w.step * dy[j];
                if look > 0 && steps[j] != 0.0 {
                    self.slope[j] = ((now - lacks[j]) / steps[j]).max(LEAST_SLOPE);
                }
                lacks[j] = now;
                steps[j] = -now / self.slope[j];
                oil[j] += steps[j];
                // A slope from before may be too steep.
                let far = if look == 0 { now } else { steps[j] };
                farthest = farthest.max((far / w.accuracy[j]).abs());
            }
            if farthest <= 1.0 {
                return Ok(lost);
            }
        }
        Err(EvalError::recoverable("ring_pack", "the oil on flanks does not settle"))
    }
}
