//! Search in stretches, for maps that are strongly bent: some cycles are repeated plainly, and what they say of the slopes is used for one step; then
//! again from there (vector extrapolation in cycles, sidi2017). Far from the orbit secants older than a stretch are dropped: they belong to other slopes. Near it all
//! stretches are taken together (`points`).
//!
//! Slow modes of a map with stores that hardly see each other (oil before the edges of rings) are single states. A secant in the noise does not show them,
//! but three residuals of the state that fall by the same factor do (Aitken's process, state by state).
//!
//! Where no secant leads to the orbit, cycles are repeated plainly to the end. Only stores that creep are still sent on: to where the secant over their last
//! step says that their rate ends.

use nalgebra::DVector;

use super::points::{Blend, Points};
use super::{
    Bend, CycleMap, NEARER, OrbitOptions, ROUGHEST, SETTLED, Search, Secant, changes, explain, known, norm,
    sinks, spectrum,
};
use crate::EvalError;
use crate::elementary;

/// Most cycles in which a search that begins near the orbit is led on.
const LED: usize = 4;
/// Distance from the orbit to which a like map leads, over the way there, and that moved by less it is nearer than that: the way gets shorter by a third to a half each time, as
/// fluttering packs show.
const LED_TO: f64 = 2.0;
/// Secants of a stretch, whose cycles are one more.
const GATHERED: usize = 2;
/// Part of the residual that cycles taken together may leave over to be stepped with before the stretch is complete, and of a step by which it may miss.
const EXPLAINED: f64 = 0.3;
const MISSED: f64 = 0.1;
/// Part of the largest residual from which on a state is extrapolated alone, and of its own residual that the secants must have left over.
const LARGE: f64 = 0.1;
const LEFT: f64 = 0.3;
/// Multipliers between which it is; and how much they may differ from one cycle to the next, over the distance to one (0.1 at least).
const MULTIPLIERS: (f64, f64) = (0.5, 0.98);
const STEADY: f64 = 0.3;
/// Factor within which the last three residuals of a state lie that drifts at a rate blurred by noise.
const BLURRED: f64 = 2.0;
/// How much farther a secant over the last step may lead it than its residuals say: their noise hides multipliers beyond the largest.
const FARTHER: f64 = 10.0;
/// Parts of itself that a state loses and gains at most where its residuals alone lead it on, and how many times the last of them it may gain in any case: a store neither runs empty nor fills
/// up at the rate at which it began to. Without these limits a store of a diesel with fluttering rings was emptied by one step, and took thirty cycles to fill again.
const EMPTIED: f64 = 0.7;
const FILLED: f64 = 3.0;
const AT_LEAST: f64 = 9.0;
/// Stretches at the noise of the map after which nothing more is expected.
const IDLE: usize = 3;
/// Cosine between residuals of a machine that goes to and fro, the part of a residual that two such cycles leave, its least size over the accuracy, and the
/// cycles in a row that must be so: secants bring a mode with a negative multiplier to rest in a stretch, unless the period has doubled.
const TURNING: f64 = -0.9;
const KEPT: f64 = 0.9;
const SEEN: f64 = 30.0;
const DOUBLED: usize = 8;
/// Part of all cycles after which secants are not trusted any more (corners can make each of them wrong), and least number of them.
const TRUSTED: usize = 3;
const TRIED: usize = 40;
/// Plain cycles after which it shows that they come no nearer.
const STUCK: usize = 20;

/// What is known since the last step, and near the orbit from before it.
struct Stretch {
    bend: Bend,
    /// Scales of the states in the last cycle.
    s: Vec<f64>,
    /// The cycles that came to rest.
    points: Points,
    /// Residuals of this stretch, oldest first.
    residuals: Vec<DVector<f64>>,
    /// Start of the last cycle.
    at: Option<DVector<f64>>,
    /// Cycles that are still skipped.
    skipped: usize,
    /// Largest factor by which a residual understated an error before the step.
    held: f64,
    /// Least such factor.
    least: f64,
    /// Longest step: less where the machine could not follow.
    reach: f64,
    /// Smallest residual.
    best: f64,
    /// Cycles since the residual came down to the noise of the map and stays there.
    idle: usize,
    /// Cycles in a row that went to and fro.
    turned: usize,
    /// Whether secants are stepped with no more.
    plain: bool,
    /// Where the states were that went on by themselves.
    drifts: Vec<Option<Drift>>,
    /// How far states have to go that drift.
    ahead: f64,
    /// Cycles in which a search that began near the orbit may still be led on.
    near: usize,
    /// How far from the orbit the cycle begins, as far as that by which it was led there says; infinite where it says nothing.
    led: f64,
}

impl Stretch {
    /// For `n` states, of whose map the secants `known` are known: then the start is near.
    fn new(n: usize, bend: Bend, known: Vec<Secant>) -> Self {
        Self {
            bend,
            s: vec![1.0; n],
            residuals: Vec::new(),
            at: None,
            skipped: if known.is_empty() { bend.settles.0 } else { bend.settles.1 },
            held: 1.0,
            least: if known.is_empty() { bend.slow } else { 1.0 },
            points: Points::with(known),
            reach: bend.reach,
            best: f64::INFINITY,
            idle: 0,
            turned: 0,
            plain: false,
            drifts: vec![None; n],
            ahead: 0.0,
            near: 0,
            led: f64::INFINITY,
        }
    }

    /// Its cycles, those among them that are not looked at.
    const fn cycles(&self) -> usize {
        self.bend.settles.1 + GATHERED
    }

    /// Begins anew after a step.
    fn restart(&mut self) {
        self.points.stepped();
        self.residuals.clear();
        self.at = None;
        self.skipped = self.bend.settles.1;
    }

    /// Where a search that began near the orbit goes on after the cycle from `y` to `g`: where a like map leads, or by what all cycles say if that explains where they are, or
    /// from the end of the cycle. After some cycles it is a search like any other.
    fn goes_on_near(
        &mut self,
        map: &mut dyn CycleMap,
        (y, g): (&[f64], &[f64]),
        tolerance: f64,
    ) -> Result<Option<Vec<f64>>, EvalError> {
        self.near -= 1;
        self.at = None;
        if self.near == 0 {
            self.points.forget();
            self.residuals.clear();
            self.skipped = self.bend.settles.1;
            return Ok(None);
        }
        let explains = |b: &Blend| b.rest.amax() <= EXPLAINED * self.last_residual();
        let next = match (map.lead(y, g, tolerance)?, self.blend().filter(explains)) {
            (Some(led), _) => {
                if led.settled {
                    self.led = LED_TO * norm(&led.y, y, &self.s);
                }
                led.y
            }
            (None, Some(blend)) => self.on_by(map, g, &blend.step),
            (None, None) => g.to_vec(),
        };
        self.residuals.clear();
        map.expect_last();
        Ok(Some(next))
    }

    /// Largest part of the last residual.
    fn last_residual(&self) -> f64 {
        self.residuals.last().map_or(0.0, |r| r.amax())
    }

    /// What tells how slow the map is: where the search began near the orbit, and cycles differ by little more than noise, only what was known before.
    fn slopes(&self) -> Vec<Secant> {
        if self.near > 0 { self.points.known().to_vec() } else { self.points.secants() }
    }

    /// Takes the cycle from `y` to `g`, as accurate as `accuracy`.
    fn take(&mut self, map: &dyn CycleMap, y: &[f64], g: &[f64], accuracy: f64) {
        let before = self.s.clone();
        map.scale(g, &mut self.s);
        let n = y.len();
        let rescale = DVector::from_iterator(n, before.iter().zip(&self.s).map(|(b, s)| b / s));
        self.points.rescale(&rescale);
        for v in self.residuals.iter_mut().chain(&mut self.at) {
            v.component_mul_assign(&rescale);
        }
        let at = DVector::from_iterator(n, y.iter().zip(&self.s).map(|(y, s)| y / s));
        let r = DVector::from_iterator(n, g.iter().zip(y).zip(&self.s).map(|((g, y), s)| (g - y) / s));
        if self.skipped > 0 {
            self.skipped -= 1;
        } else {
            self.points.push(&at, &r, self.bend.noise * map.noise() * accuracy);
        }
        self.at = Some(at);
        self.residuals.push(r);
    }

    /// Whether it is time for a step: the stretch is complete, or what is known from before explains where it is.
    fn ready(&self) -> bool {
        let secants = if self.plain { 2 * GATHERED } else { GATHERED };
        self.points.own() > secants || self.points.has_earlier() && self.explains()
    }

    /// Whether the cycles together explain the last one. Only a whole stretch shows whether a machine that goes to and fro comes to rest, and where states drift
    /// that would be sent back.
    fn explains(&self) -> bool {
        let ([.., before, r], Some(blend)) = (&self.residuals[..], self.blend()) else { return false };
        let large = LARGE * r.amax();
        before.dot(r) > 0.0
            && blend.rest.amax() <= EXPLAINED * r.amax()
            && r.iter().zip(blend.step.iter()).all(|(r, step)| r.abs() < large || r * step >= 0.0)
    }

    /// The cycles taken together, where that is of use.
    fn blend(&self) -> Option<Blend> {
        self.points.blend().filter(|_| !self.plain)
    }

    /// What the cycles say of a step from the end of the last, whose residual is `r`, and what they leave over of that.
    fn known(&self, r: &DVector<f64>) -> (DVector<f64>, DVector<f64>) {
        if self.plain {
            return (DVector::zeros(r.len()), r.clone());
        }
        if let Some(blend) = self.blend() {
            return (blend.step, blend.rest);
        }
        let (correction, rest) = explain(&self.points.own_secants(), r, self.bend.fresh);
        (-correction, rest)
    }

    /// Moves the end `g` of the last cycle to where the cycles together are.
    fn settle(&self, map: &dyn CycleMap, g: &mut [f64]) {
        if let Some(blend) = self.blend() {
            let next = self.on_by(map, g, &blend.step);
            g.copy_from_slice(&next);
        }
    }

    /// The states `g` moved by a scaled step, as far as the machine can follow.
    fn on_by(&self, map: &dyn CycleMap, g: &[f64], step: &DVector<f64>) -> Vec<f64> {
        let mut next: Vec<f64> =
            g.iter().zip(step.iter()).zip(&self.s).map(|((g, d), s)| g + d * s).collect();
        map.admit(g, &mut next);
        next
    }

    /// Whether plain cycles come no nearer, although none drifts.
    fn stuck(&self, accuracy: f64) -> bool {
        let Some(k) = self.residuals.len().checked_sub(STUCK) else { return false };
        let last = &self.residuals[self.residuals.len() - 1];
        last.norm() > 0.5 * self.residuals[k].norm() && last.amax() > SEEN * accuracy
    }

    /// Whether the last three residuals go to and fro and do not decay, as about an orbit of two cycles.
    fn turns(&self, accuracy: f64) -> bool {
        let [.., a, b, c] = &self.residuals[..] else { return false };
        let opposite = |a: &DVector<f64>, b: &DVector<f64>| a.dot(b) < TURNING * a.norm() * b.norm();
        opposite(a, b) && opposite(b, c) && c.norm() > KEPT * a.norm() && c.amax() > SEEN * accuracy
    }

    /// Whether it did so for long enough; asked after every cycle.
    fn goes_to_and_fro(&mut self, accuracy: f64) -> bool {
        if self.ready() {
            let cycles = if self.plain { 1 } else { self.cycles() };
            self.turned = if self.turns(accuracy) { self.turned + cycles } else { 0 };
        }
        self.turned >= DOUBLED
    }

    /// Decay of the residual a cycle, over the last four of the stretch where there are as many: two alone show the noise of the map. Modes that turn do not let
    /// a residual understate an error.
    fn ratio(&self, accuracy: f64) -> f64 {
        let (before, now, cycles) = match &self.residuals[..] {
            [.., a, b, c, d] => (a + b, c + d, 2.0),
            [.., a, b] => (a.clone(), b.clone(), 1.0),
            _ => return 0.0,
        };
        if now.dot(&before) > 0.0 {
            elementary::powf(now.norm() / before.norm().max(accuracy), 1.0 / cycles)
        } else {
            0.0
        }
    }

    /// Looks, after as many cycles, how far the states have to go that drift faster than a cycle is accurate.
    fn look_ahead(&mut self, accuracy: f64) {
        let ([.., r0, r1, r2, r], true) = (&self.residuals[..], self.plain) else { return };
        let drifting = (0..r.len()).filter(|&i| r[i].abs() > accuracy && drifts(&self.residuals, i));
        let to_go = drifting.filter_map(|i| further([r0[i], r1[i], r2[i], r[i]], true));
        self.ahead = to_go.fold(0.0, |far, d| far.max(d.abs()));
    }

    /// The step from the end of the last cycle: what the cycles explain, and what single states go on by. No state is sent back that only went forth: where it
    /// drifts at a constant rate the cycles know nothing but noise of it.
    fn step(&mut self) -> DVector<f64> {
        let (Some(r), Some(at)) = (self.residuals.last(), &self.at) else {
            return DVector::zeros(self.s.len());
        };
        let (mut step, rest) = self.known(r);
        let residual = r.amax();
        let longest = (self.bend.stride * residual).min(self.reach);
        step *= (longest / step.amax().max(f64::MIN_POSITIVE)).min(1.0);
        let [.., r0, r1, r2, _] = &self.residuals[..] else { return step };
        for i in 0..step.len() {
            let drifts = drifts(&self.residuals, i);
            let mut left = rest[i];
            if step[i] * r[i] < 0.0 && drifts {
                step[i] = 0.0;
                left = r[i];
            }
            let goes_on = (drifts || !self.plain) && left.abs() >= (LARGE * residual).max(LEFT * r[i].abs());
            if let Some(further) = goes_on.then(|| further([r0[i], r1[i], r2[i], r[i]], drifts)).flatten() {
                let further = within_reach(further, at[i] + r[i], r[i]);
                let here = Drift { y: at[i] * self.s[i], rate: r[i] * self.s[i] };
                let known = self.drifts[i].replace(here).and_then(|before| here.root(before));
                let root = known
                    .filter(|_| self.plain)
                    .map_or(0.0, |d| (d / self.s[i]).abs().min(FARTHER * further.abs()));
                step[i] = further.signum() * root.max(further.abs()).min(self.reach);
            }
        }
        step
    }
}

/// Whether a state moved to the same side in the last four cycles.
fn drifts(residuals: &[DVector<f64>], i: usize) -> bool {
    let n = residuals.len();
    let last = |k: usize| residuals[n - 1 - k][i];
    n >= 4 && (1..4).all(|k| last(k) * last(0) > 0.0)
}

/// Where a state that goes on by itself was, and its change in a cycle, unscaled.
#[derive(Clone, Copy)]
struct Drift {
    y: f64,
    rate: f64,
}

impl Drift {
    /// How far it is to where the rate ends, on the secant from `before`: on past a step in the same direction, at a smaller rate.
    fn root(self, before: Drift) -> Option<f64> {
        let (moved, slower) = (self.y - before.y, before.rate - self.rate);
        let on = moved * self.rate > 0.0 && slower * self.rate > 0.0 && before.rate * self.rate > 0.0;
        on.then(|| self.rate * moved / slower)
    }
}

/// The part of the way `further` that a state may take from `y`, whose last residual is `r`.
fn within_reach(further: f64, y: f64, r: f64) -> f64 {
    let most = if further * y < 0.0 { EMPTIED * y.abs() } else { (FILLED * y.abs()).max(AT_LEAST * r.abs()) };
    further.clamp(-most, most)
}

/// How far a state goes on whose last residuals fall by the same factor, or that drifts at a rate of which noise leaves no more to be said than its mean decay.
fn further([r0, r1, r2, r]: [f64; 4], drifts: bool) -> Option<f64> {
    if r1 * r2 <= 0.0 || r2 * r <= 0.0 {
        return None;
    }
    let (before, now) = (r2 / r1, r / r2);
    let steady = (before - now).abs() <= STEADY * (1.0 - now.min(1.0)).max(0.1);
    let (all, least) = (before.max(now).max(before * now), before.min(now).min(before * now));
    let blurred = drifts && all <= BLURRED && least >= 1.0 / BLURRED;
    let multiplier = if steady { now } else { ((r2 + r) / (r0 + r1)).sqrt() };
    let goes_on = multiplier.min(MULTIPLIERS.1);
    ((steady || blurred) && multiplier >= MULTIPLIERS.0).then(|| r * goes_on / (1.0 - goes_on))
}

impl Search {
    /// Search of an orbit that repeats after `times` cycles, in stretches.
    pub(super) fn in_stretches(
        &mut self,
        map: &mut dyn CycleMap,
        y: &mut [f64],
        options: &OrbitOptions,
        (times, limit): (usize, usize),
        bend: Bend,
    ) -> Result<(), EvalError> {
        let known = if times == 1 { known(map) } else { Vec::new() };
        let rough = self.report.cycles == 0 && known.is_empty();
        let mut state = Stretch::new(y.len(), bend, known);
        if self.noisy {
            // What noise said of slow modes is forgotten, but a stretch must show that there are none.
            state.held = super::MAX_GAIN;
        }
        let (mut g, mut end) = (y.to_vec(), y.to_vec());
        let (mut stepped, mut passed, mut last) = (false, 0.0, 0.0);
        if let (0, Some(from)) = (self.report.cycles, map.begins_near()) {
            (state.skipped, state.near, state.led) = (0, LED, LED_TO * from);
        }
        let mut accuracy = if rough { options.accuracy.max(1e-3) } else { options.accuracy };
        self.report.converged = false;
        self.noisy = false;
        while self.report.cycles + times <= limit && !map.gives_up() {
            if let Err(e) = self.apply(map, y, &mut end, accuracy, times) {
                if !std::mem::take(&mut stepped) || !e.is_recoverable() {
                    return Err(e);
                }
                // Nowhere the machine could be: on from where it was.
                self.report.cycles += 1;
                y.copy_from_slice(&g);
                state.reach *= NEARER;
                state.restart();
                continue;
            }
            g.copy_from_slice(&end);
            state.take(map, y, &g, accuracy);
            let accurate = accuracy <= options.accuracy;
            let estimate = self.judge_stretch(&mut state, options, (last, map.noise()));
            let residual = self.report.residual;
            last = residual;
            // Two cycles must agree that nothing is slow, but after a step where that is allowed for.
            let once = stepped && (state.near > 0 || state.least > 1.0);
            let settled = (passed > 0.0 || once) && residual <= SETTLED * options.accuracy;
            if accurate && (settled && estimate <= options.tolerance || sinks(estimate, passed, options)) {
                self.report.converged = true;
                state.settle(map, &mut g);
                break;
            }
            if state.idle > IDLE * state.cycles() && (state.plain || state.blend().is_some()) {
                self.noisy = true;
                state.settle(map, &mut g);
                break;
            }
            passed = if estimate <= options.tolerance { estimate } else { 0.0 };
            if passed > 0.0 && map.begins_near().is_some() {
                map.expect_last();
            }
            if state.near > 0
                && passed == 0.0
                && let Some(next) = state.goes_on_near(map, (y, &g), options.tolerance)?
            {
                y.copy_from_slice(&next);
                stepped = true;
                continue;
            }
            y.copy_from_slice(&g);
            state.plain = self.report.cycles >= (options.max_cycles / TRUSTED).max(TRIED);
            let rough = if state.plain { 0.0 } else { bend.rough * residual };
            accuracy = rough.min(ROUGHEST).max(options.accuracy);
            self.stuck = state.plain && state.stuck(options.accuracy);
            self.doubled = times == 1 && state.goes_to_and_fro(options.accuracy);
            if self.stuck || self.doubled {
                break;
            }
            // What passes is looked at once more from where it is.
            if state.ready() && passed == 0.0 {
                let step = state.step();
                if state.plain && step.amax() == 0.0 {
                    continue;
                }
                y.copy_from_slice(&state.on_by(map, &g, &step));
                stepped = true;
                state.restart();
            }
        }
        y.copy_from_slice(&g);
        self.report.changes = changes(&state.points.secants(), &state.s);
        Ok(())
    }

    /// The estimated error after a cycle of a stretch; `last` is the residual before, `noise` that of the cycle over what is usual.
    fn judge_stretch(
        &mut self,
        state: &mut Stretch,
        options: &OrbitOptions,
        (last, noise): (f64, f64),
    ) -> f64 {
        state.look_ahead(options.accuracy);
        let Some(r) = state.residuals.last() else { return f64::INFINITY };
        let residual = r.amax();
        self.report.residual = residual;
        self.report.history.push(residual);
        let blend = state.blend();
        let (rest, weight, missed) =
            blend.as_ref().map_or((r, 1.0, 0.0), |b| (&b.rest, b.weight, MISSED * b.step.amax()));
        let (largest, slow, suspect) = spectrum(&state.slopes(), state.bend.fresh);
        let ratio = state.ratio(options.accuracy);
        // Between residuals that are noise a decay says nothing, where secants do.
        let own_noise = state.bend.noise * noise * options.accuracy;
        let ratio = if slow > 1.0 && residual <= SETTLED * own_noise { 0.0 } else { ratio };
        let seen = slow.max(1.0 / (1.0 - ratio.clamp(0.0, 1.0 - 1.0 / super::MAX_GAIN)));
        // Fast modes that a step stirred up hide a slow one: what was slow before it is taken to be slow still.
        let gain = seen.max(state.held).max(state.least);
        if state.ready() {
            state.held = seen;
            // What was known before is of a like map, whose search has asked.
            self.suspect = suspect && !state.plain && state.near == 0;
            self.report.multiplier = largest.max(ratio.min(1.0));
        }
        let falls = residual > SETTLED * options.accuracy || residual < 0.5 * state.best;
        state.idle = if falls { 0 } else { state.idle + 1 };
        state.best = state.best.min(residual);
        let noise = residual.max(last).min(own_noise);
        let estimate = (gain * (rest.amax() + noise * weight) + missed).max(state.ahead);
        // All that is slow went the way of which the length is known, noise that it multiplied with it.
        let estimate = estimate.min(std::mem::replace(&mut state.led, f64::INFINITY).max(residual));
        self.report.error_estimate = estimate;
        estimate
    }
}
