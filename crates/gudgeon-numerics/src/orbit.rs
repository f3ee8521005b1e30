//! Periodic orbits: fixed points of the map from the start of a cycle to its end.
//!
//! Plain repetition converges with the largest multiplier λ of the map, which for a coupled ring pack can be 0.9 and more.
//! Anderson's acceleration (walker2011) needs no derivative and finds a few slow modes in as many cycles. The change over one
//! cycle, `r = Φ(y) - y`, underestimates the distance to the orbit by 1/(1 - λ); what is reported is that distance, with λ
//! taken from the differences of the iterates. A fixed point with |λ| > 1 is not what the machine does: when the multiplier
//! comes near, plain repetition decides, and a cycle that repeats only every second or third time is reported as such.
//!
//! A map of few states on which that does not get on is searched by its slope (`newton`). One that is strongly bent, or has corners, is searched in stretches of plain cycles instead (`stretches`).

use crate::EvalError;
use crate::elementary;
use nalgebra::{DMatrix, DVector, SVD, Schur};

mod newton;
mod points;
mod stretches;

/// The map of a cycle.
pub trait CycleMap {
    /// Number of states.
    fn dim(&self) -> usize;
    /// State at the end of the cycle that starts with `y0`; `accuracy` is the relative accuracy wanted (looser is cheaper).
    /// Returns the cost in any unit.
    ///
    /// # Errors
    /// The cycle cannot be computed.
    fn map(&mut self, y0: &[f64], y1: &mut [f64], accuracy: f64) -> Result<f64, EvalError>;
    /// Magnitudes that make the states comparable.
    fn scale(&self, y: &[f64], s: &mut [f64]);
    /// Keeps an extrapolated start within what the machine admits; `reached` is the end of the cycle before, which it does.
    fn admit(&self, _reached: &[f64], _y: &mut [f64]) {}
    /// Part of its accuracy by which the last cycle differs from another from the same start; where [`Bend::noise`] says what is usual, over that.
    fn noise(&self) -> f64 {
        1.0
    }
    /// The next cycle will probably be the last of the search: what is to be gathered from that can be gathered in it.
    fn expect_last(&mut self) {}
    /// Whether no further cycle is of use: the search ends with what it has.
    fn gives_up(&self) -> bool {
        false
    }
    /// What is known of the slope of the map before the first cycle, as from the search of one that is like it.
    fn known(&self) -> &[Change] {
        &[]
    }
    /// How far from the orbit the search begins, in scaled units, where it begins near: at the orbit of a map that is like this one. Infinite where nobody knows.
    fn begins_near(&self) -> Option<f64> {
        None
    }
    /// Where the orbit of that map is if it is moved by what it lacks of this one in the cycle from `y` to `end` (defect correction, stetter1978), within `tolerance`;
    /// `None` where there is no such map any more, or it has no such orbit.
    ///
    /// # Errors
    /// Its cycles cannot be computed, and the search is not to go on.
    fn lead(&mut self, _y: &[f64], _end: &[f64], _tolerance: f64) -> Result<Option<Led>, EvalError> {
        Ok(None)
    }
    /// Whether the machine never leaves a fixed point, however slow it is about it: a search that ends at one then does not try.
    fn stays(&self) -> bool {
        false
    }
    /// How the map is searched if it is strongly bent; `None` for one that is nearly linear between the iterates.
    fn bend(&self) -> Option<Bend> {
        None
    }
}

/// Where a like map leads.
#[derive(Debug, Clone, PartialEq)]
pub struct Led {
    /// State at the start of a cycle.
    pub y: Vec<f64>,
    /// Whether its search came to an end there, within the tolerance: then the way there tells how far off the start of the last cycle was.
    pub settled: bool,
}

/// A difference of two starts, and of the changes over the cycles from them.
#[derive(Debug, Clone, PartialEq)]
pub struct Change {
    /// Of the starts.
    pub start: Vec<f64>,
    /// Of the ends less the starts.
    pub change: Vec<f64>,
    /// Noise of the latter, in scaled units.
    pub noise: f64,
}

/// How a map is searched that is strongly bent, or has corners: secants of far iterates say more of its curvature than of its slopes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bend {
    /// Least part of a secant that is new beside the newer ones; one with less is left out.
    pub fresh: f64,
    /// Longest step over the residual.
    pub stride: f64,
    /// Longest step in scaled units.
    pub reach: f64,
    /// Accuracy of a cycle over the residual of the one before: far from the orbit cheaper cycles do.
    pub rough: f64,
    /// Cycles that are not looked at: at the start, and after a step, which stirs up fast modes. With fewer a search takes fewer cycles, and knows less of slow modes where it ends.
    pub settles: (usize, usize),
    /// Part of its accuracy by which a cycle usually differs from cycle to cycle.
    pub noise: f64,
    /// Least factor by which a residual understates an error, where nothing was known of the map: few cycles do not show all that is slow.
    pub slow: f64,
}

/// The roughest cycle.
const ROUGHEST: f64 = 1e-2;

/// What is wanted of an orbit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrbitOptions {
    /// Estimated true error, in the scaled maximum norm, at which the search ends.
    pub tolerance: f64,
    /// Accuracy of the map.
    pub accuracy: f64,
    /// Maximum number of cycles, those of all phases of the search together (a probe of stability, once begun, runs to its end).
    pub max_cycles: usize,
    /// How many times the map may be asked for a tenth of its error where its noise is all that keeps the search from its end. 0 for maps
    /// that have one accuracy.
    pub refinements: usize,
    /// Whether to accelerate. Maps with discrete decisions are not smooth and are repeated plainly.
    pub accelerate: bool,
}

/// What was found.
#[derive(Debug, Clone, PartialEq)]
pub struct OrbitReport {
    /// Whether the estimate fell below the tolerance.
    pub converged: bool,
    /// 1, or the number of cycles after which the state repeats.
    pub period: u32,
    /// Estimated distance of the returned state from the orbit, scaled maximum norm.
    pub error_estimate: f64,
    /// Change over the last cycle, scaled maximum norm.
    pub residual: f64,
    /// Largest multiplier seen (its magnitude).
    pub multiplier: f64,
    /// Cycles mapped.
    pub cycles: usize,
    /// Cost in units of the last cycle.
    pub cycle_equivalents: f64,
    /// Residual of every cycle.
    pub history: Vec<f64>,
    /// What was learnt of the slope of the map, where the search was accelerated: for [`CycleMap::known`] of one that is like it.
    pub changes: Vec<Change>,
}

impl OrbitReport {
    /// Distance from the orbit at which the last cycle began, scaled maximum norm: that of its end, and the change over it.
    #[must_use]
    pub fn began_at(&self) -> f64 {
        self.error_estimate + self.residual
    }
}

/// Least part of a secant that is new beside the newer ones; one with less is left out.
const FRESH: f64 = 1e-9;
/// Differences of earlier iterates that the acceleration keeps.
const DEPTH: usize = 8;
/// Times that a start is cut off to the last one before plain repetition takes over, and the part of the residual within which it is that one: secants of a search that gets on step by about
/// the residual.
const STANDS: (usize, f64) = (3, 0.05);
/// Longest repetition that is looked for.
const MAX_PERIOD: usize = 4;
/// Multiplier beyond which the errors of the steps of many cycles add up.
const SLOW: f64 = 0.9;
/// Multiplier beyond which plain repetition must confirm a fixed point.
const SUSPECT: f64 = 0.97;
/// The same for multipliers that are negative or complex: curvature, as in the doubling of a period, makes these differ most between
/// the secants and the fixed point itself.
const SUSPECT_TURNING: f64 = 0.85;
/// Cycles in which it shows whether a machine leaves a fixed point.
const PROBE: usize = 8;
/// Displacement from it, in scaled units.
const NUDGE: f64 = 0.03;
/// Cycles in the noise of the map after which nothing more is expected of another.
const IDLE: usize = 5;
/// Residual over the accuracy of a cycle that is as little as its noise.
const SETTLED: f64 = 3.0;
/// Part of the tolerance below which an estimate must be foreseen for the next cycle to be taken for the last.
const PROMISED: f64 = 0.5;
/// Steps of the acceleration from which on the fall of a residual says what the next will be: the first leaves an arbitrary start, but not one near the orbit.
const SETTLES: [usize; 2] = [2, 0];
/// Fall of the residual after the first cycle from a start near the orbit, of which nothing is seen yet: about the median of 25 ring packs without oil, the largest of which is 2e-2. To measure a
/// cycle in vain costs half of one more, and not to measure the last one a whole one.
const FALLS: f64 = 5e-3;
/// Turns of a residual that is not halved any more, after which one below this many times the accuracy is taken for noise of the map too: steps that fall
/// differently can make it noisier than it was asked to be.
const STALL: (usize, f64) = (6, 30.0);
/// Cycles that acceleration has before plain repetition may take its place.
const PATIENCE: usize = 60;
/// Cycles over which plain repetition shows that it has come to rest in a band, and the width of a band over the noise of the map below which it is one.
const BAND: (usize, f64) = (24, 30.0);
/// States that move along or come nearer lie at least twice as far apart as the narrower half of them; noise, hardly farther.
const APART: f64 = 1.9;
/// Part of the longest step that is left when one was taken back.
const NEARER: f64 = 0.25;
/// Largest factor by which a residual is taken to understate an error.
const MAX_GAIN: f64 = 3000.0;

fn norm(a: &[f64], b: &[f64], s: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .zip(s)
        .map(|((a, b), s)| ((a - b) / s).abs())
        .fold(0.0, |m, v| if v.is_nan() { f64::INFINITY } else { m.max(v) })
}

/// Searches the orbit, starting from `y`; on return `y` is on it as nearly as `error_estimate` says.
///
/// # Errors
/// When a cycle cannot be computed.
pub fn periodic_orbit(
    map: &mut dyn CycleMap,
    y: &mut [f64],
    options: &OrbitOptions,
) -> Result<OrbitReport, EvalError> {
    if y.len() != map.dim() {
        return Err(EvalError::fatal("periodic_orbit", "the start has the wrong number of states"));
    }
    let mut search = Search::new();
    if !options.accelerate {
        search.plain(map, y, options)?;
        return Ok(search.finish());
    }
    let mut options = *options;
    let asked = options.accuracy;
    search.extrapolated(map, y, &options, 1)?;
    while options.refinements > 0 && !search.report.converged && search.noisy {
        options.refinements -= 1;
        options.accuracy *= 0.1;
        search.extrapolated(map, y, &options, 1)?;
    }
    if !search.doubled && !search.report.converged && newton::serves(map, search.report.cycles, &options) {
        options.accuracy = search.by_newton(map, y, &options)?;
    }
    if search.gathers(map, &options) && options.accuracy == asked {
        options.refinements -= 1;
        options.accuracy *= 0.1;
        options.accuracy = search.by_newton(map, y, &options)?;
    }
    let options = &options;
    if !search.doubled
        && !search.report.converged
        && (search.stuck || search.report.cycles >= patience(options))
    {
        // Extrapolation has had its time: what the secants of a strongly bent map say can lead astray for ever.
        search.plain(map, y, options)?;
        return Ok(search.finish());
    }
    let mut other = y.to_vec();
    if !search.doubled {
        if !search.suspect || !search.report.converged || map.stays() {
            return Ok(search.finish());
        }
        // Near or beyond the edge of stability: what does the machine itself do?
        if !search.leaves(map, &mut other, options)? {
            return Ok(search.finish());
        }
    }
    search.beyond(map, y, other, options)?;
    Ok(search.finish())
}

/// Cycles after which acceleration makes room for plain repetition: half of all, and as many as it usually needs several times over.
fn patience(options: &OrbitOptions) -> usize {
    (options.max_cycles / 2).max(PATIENCE)
}

struct Search {
    report: OrbitReport,
    cost: f64,
    last_cost: f64,
    /// Whether the multipliers leave it open if the fixed point is stable.
    suspect: bool,
    /// Whether the last phase ended in the noise of the map.
    noisy: bool,
    /// Whether it ended where the machine goes to and fro between two states.
    doubled: bool,
    /// Whether it ended where plain cycles come no nearer.
    stuck: bool,
    /// Largest factor by which a residual was seen to understate an error in a phase that ended in noise.
    gain: f64,
}

impl Search {
    fn new() -> Self {
        Self {
            report: OrbitReport {
                converged: false,
                period: 1,
                error_estimate: f64::INFINITY,
                residual: f64::INFINITY,
                multiplier: 0.0,
                cycles: 0,
                cycle_equivalents: 0.0,
                history: Vec::new(),
                changes: Vec::new(),
            },
            cost: 0.0,
            last_cost: 1.0,
            suspect: false,
            noisy: false,
            doubled: false,
            stuck: false,
            gain: 1.0,
        }
    }

    /// Whether a slow mode gathers what every cycle lacks, and a more accurate one tells how much that is.
    fn gathers(&self, map: &dyn CycleMap, options: &OrbitOptions) -> bool {
        let report = &self.report;
        report.converged && report.multiplier > SLOW && options.refinements > 0 && newton::is_small(map)
    }

    fn finish(mut self) -> OrbitReport {
        self.report.cycle_equivalents =
            if self.last_cost > 0.0 { self.cost / self.last_cost } else { self.report.cycles as f64 };
        self.report
    }

    /// `times` cycles from `y` to `g`.
    fn apply(
        &mut self,
        map: &mut dyn CycleMap,
        y: &[f64],
        g: &mut [f64],
        accuracy: f64,
        times: usize,
    ) -> Result<(), EvalError> {
        let mut start = y.to_vec();
        for _ in 0..times {
            let cost = map.map(&start, g, accuracy)?;
            self.cost += cost;
            self.last_cost = cost;
            self.report.cycles += 1;
            if !g.iter().all(|v| v.is_finite()) {
                return Err(EvalError::recoverable(
                    "periodic_orbit",
                    "the cycle ends in a state that is not finite",
                ));
            }
            start.copy_from_slice(g);
        }
        Ok(())
    }

    /// Search of an orbit that repeats after `times` cycles.
    fn extrapolated(
        &mut self,
        map: &mut dyn CycleMap,
        y: &mut [f64],
        options: &OrbitOptions,
        times: usize,
    ) -> Result<(), EvalError> {
        match map.bend() {
            // Stretches are plain cycles for the most part, and need no others after them.
            Some(bend) => self.in_stretches(map, y, options, (times, options.max_cycles), bend),
            None => {
                let most = if newton::is_small(map) { newton::BEFORE } else { patience(options) };
                let limit = if times == 1 { options.max_cycles.min(most) } else { options.max_cycles };
                self.accelerated(map, y, options, (times, limit))
            }
        }
    }

    /// The same by Anderson's acceleration, a step after every cycle.
    fn accelerated(
        &mut self,
        map: &mut dyn CycleMap,
        y: &mut [f64],
        options: &OrbitOptions,
        (times, limit): (usize, usize),
    ) -> Result<(), EvalError> {
        // The end of the last cycle that could be computed.
        let mut g = vec![0.0; y.len()];
        let (mut end, mut extrapolated) = (g.clone(), false);
        let known = if times == 1 { known(map) } else { Vec::new() };
        let mut state = Anderson::new(y.len(), known);
        self.report.converged = false;
        self.noisy = false;
        // Far from the orbit a rough map does: the first cycle only has to leave the arbitrary start.
        let first = self.report.cycles == 0;
        let near = first && map.begins_near().is_some();
        let rough = if first && !near { options.accuracy.max(1e-3) } else { options.accuracy };
        let mut accuracy = if times == 1 { rough } else { options.accuracy };
        let mut before = accuracy;
        for k in 0.. {
            if self.report.cycles + times > limit || map.gives_up() {
                break;
            }
            if let Err(e) = self.apply(map, y, &mut end, accuracy, times) {
                if !std::mem::take(&mut extrapolated) || !e.is_recoverable() {
                    return Err(e);
                }
                // Nowhere the machine could be: on from where it was.
                self.report.cycles += 1;
                y.copy_from_slice(&g);
                state.trusted = state.secants.len();
                state.reach *= NEARER;
                state.previous = None;
                continue;
            }
            g.copy_from_slice(&end);
            let (at, r) = state.scaled(map, y, &g);
            let residual = r.amax();
            self.report.residual = residual;
            self.report.history.push(residual);
            let ratio = state.learn(&at, &r, before.max(accuracy), options);
            let (correction, rest) = explain(&state.secants[state.trusted..], &r, FRESH);
            let noise = map.noise() * options.accuracy;
            // Of a residual that turned no mode tells the decay: it fell by as much as it is smaller, if it is.
            let fall = if near && k == 0 {
                FALLS
            } else if ratio > 0.0 {
                ratio
            } else {
                residual / state.last
            };
            let explained = (correction.amax(), rest.amax());
            let estimate = self.judge(&mut state, residual, explained, ratio, noise);
            // A slow mode can hide behind faster ones for a cycle: what passes must pass twice, and go on falling as if it would
            // end below the tolerance, unless nothing but the noise of the map is left, which a further cycle would not lessen.
            let accurate = k == 0 || accuracy <= options.accuracy;
            let settled = k > 0 && residual <= SETTLED * options.accuracy;
            if accurate
                && (settled && estimate <= options.tolerance || sinks(estimate, state.passed, options))
            {
                self.report.converged = true;
                break;
            }
            if state.idle > IDLE || state.stalled > STALL.0 && options.refinements > 0 {
                // Too near the edge of stability for the noise of the map.
                self.noisy = true;
                self.gain = self.gain.max(state.slowest);
                break;
            }
            state.passed = if k > 0 && estimate <= options.tolerance { estimate } else { 0.0 };
            before = accuracy;
            accuracy = options.accuracy;
            // Not further than the states are large.
            let damping = (state.reach / correction.amax().max(1e-300)).min(1.0);
            let next = &at + &r - correction * damping;
            for ((y, n), s) in y.iter_mut().zip(next.iter()).zip(&state.s) {
                *y = n * s;
            }
            let wanted = y.to_vec();
            map.admit(&g, y);
            extrapolated = true;
            self.stuck = state.stands(&at, y, &wanted, residual);
            if self.stuck {
                break;
            }
            if state.passed > 0.0
                || k >= SETTLES[usize::from(near)] && promises((estimate, residual), fall, options)
            {
                map.expect_last();
            }
            state.previous = Some(Tried { at, r, rest, damping });
        }
        y.copy_from_slice(&g);
        self.report.changes = changes(&state.secants, &state.s);
        Ok(())
    }

    /// The estimated error after a cycle, from the parts of its residual that the secants explain and leave over, and the noise of the cycle.
    fn judge(
        &mut self,
        state: &mut Anderson,
        residual: f64,
        (explained, rest): (f64, f64),
        ratio: f64,
        noise: f64,
    ) -> f64 {
        let (largest, gain, suspect) = spectrum(&state.secants, FRESH);
        self.report.multiplier = largest;
        self.suspect = suspect;
        // What was seen of slow modes before the map became more accurate still holds near the orbit.
        state.slowest = state.slowest.max(gain);
        let gain = gain.max(self.gain).max(1.0 / (1.0 - ratio.clamp(0.0, 1.0 - 1.0 / MAX_GAIN)));
        // y + r - correction would be on the orbit, but for what the secants leave unexplained, and for the noise that
        // may be all that they explain.
        let noise = residual.max(state.last).min(noise);
        state.last = residual;
        let estimate = (explained + rest * gain).max(residual).max(noise * gain);
        self.report.error_estimate = estimate;
        estimate
    }

    /// Whether plain repetition leaves the neighbourhood of the fixed point `y`; `y` is then where it went.
    fn leaves(
        &mut self,
        map: &mut dyn CycleMap,
        y: &mut [f64],
        options: &OrbitOptions,
    ) -> Result<bool, EvalError> {
        let fixed = y.to_vec();
        let mut s = vec![1.0; y.len()];
        let mut g = vec![0.0; y.len()];
        map.scale(y, &mut s);
        let nudge = self.nudged(map, &fixed, &s, &mut g, options)?;
        // A cycle can gather what lies beside the fixed point in many states in one of them, which says nothing of what the next will do.
        let reached = norm(&g, &fixed, &s);
        let mut halfway = reached;
        for k in 1..PROBE {
            y.copy_from_slice(&g);
            self.apply(map, y, &mut g, options.accuracy, 1)?;
            if 2 * k < PROBE {
                halfway = norm(&g, &fixed, &s);
            }
        }
        y.copy_from_slice(&g);
        // The first half lets decaying modes go; what then still grows is unstable. A state that went far has not come back,
        // though chance may bring it nearer.
        Ok(halfway > 5.0 * nudge.max(reached) || norm(y, &fixed, &s) > 1.02 * halfway.max(options.tolerance))
    }

    /// The end `g` of the cycle from a start a little beside `fixed`, and how far beside it: nearer where the machine could not start from there.
    fn nudged(
        &mut self,
        map: &mut dyn CycleMap,
        fixed: &[f64],
        s: &[f64],
        g: &mut [f64],
        options: &OrbitOptions,
    ) -> Result<f64, EvalError> {
        let mut nudge = NUDGE;
        loop {
            let beside = |(i, (y, s)): (usize, (&f64, &f64))| {
                y + s * nudge * if i.is_multiple_of(2) { 1.0 } else { -0.7 }
            };
            let mut y: Vec<f64> = fixed.iter().zip(s).enumerate().map(beside).collect();
            map.admit(fixed, &mut y);
            match self.apply(map, &y, g, options.accuracy, 1) {
                Err(e) if e.is_recoverable() && nudge * NEARER > options.tolerance => nudge *= NEARER,
                outcome => return outcome.map(|()| nudge),
            }
            self.report.cycles += 1;
        }
    }

    /// Search where no cycle repeats the one before it: of an orbit of two cycles, then by plain repetition from `other`.
    fn beyond(
        &mut self,
        map: &mut dyn CycleMap,
        y: &mut [f64],
        mut other: Vec<f64>,
        options: &OrbitOptions,
    ) -> Result<(), EvalError> {
        let mut s = vec![1.0; y.len()];
        let mut g = other.clone();
        let mut twice = other.clone();
        self.extrapolated(map, &mut twice, options, 2)?;
        if self.report.converged && !self.suspect {
            self.apply(map, &twice, &mut g, options.accuracy, 1)?;
            map.scale(&g, &mut s);
            if norm(&g, &twice, &s) > 10.0 * options.tolerance {
                self.report.period = 2;
                y.copy_from_slice(&twice);
                return Ok(());
            }
        }
        self.plain(map, &mut other, options)?;
        y.copy_from_slice(&other);
        Ok(())
    }

    fn plain(
        &mut self,
        map: &mut dyn CycleMap,
        y: &mut [f64],
        options: &OrbitOptions,
    ) -> Result<(), EvalError> {
        let mut s = vec![1.0; y.len()];
        // States at the ends of the last cycles, newest last; and for every period the changes over it, oldest first.
        let mut seen: Vec<Vec<f64>> = vec![y.to_vec()];
        let mut changes: [Vec<f64>; MAX_PERIOD] = Default::default();
        // The estimates of the last cycle where they were good enough, else 0.
        let mut passed = [0.0; MAX_PERIOD];
        let mut g = vec![0.0; y.len()];
        self.report.converged = false;
        self.report.period = 1;
        while self.report.cycles < options.max_cycles && !map.gives_up() {
            self.apply(map, y, &mut g, options.accuracy, 1)?;
            map.scale(&g, &mut s);
            y.copy_from_slice(&g);
            let mut estimates = [f64::INFINITY; MAX_PERIOD];
            let mut blurred = [f64::INFINITY; MAX_PERIOD];
            for p in 1..=MAX_PERIOD.min(seen.len()) {
                changes[p - 1].push(norm(&g, &seen[seen.len() - p], &s));
                let (per_cycle, change) = decay(&changes[p - 1], options.accuracy);
                let lambda = per_cycle.powi(p as i32).min(1.0 - 1.0 / MAX_GAIN);
                // The second term: noise of the last cycle alone.
                estimates[p - 1] = change * lambda.max(0.5) / (1.0 - lambda) + change.min(options.accuracy);
                // What noise could have hidden.
                blurred[p - 1] = estimates[p - 1] + 2.0 * options.accuracy / (1.0 - lambda);
                if p == 1 {
                    self.report.multiplier = per_cycle;
                    self.report.residual = change;
                    self.report.error_estimate = estimates[0];
                    self.report.history.push(change);
                }
            }
            for p in 1..=MAX_PERIOD {
                let estimate = estimates[p - 1];
                // A longer repetition counts when what it says of its own error excludes every shorter one.
                let excluded =
                    changes[..p - 1].iter().all(|c| c.last().is_some_and(|c| *c > 4.0 * blurred[p - 1]));
                // It must be seen twice before it is believed, and go on falling: a slow mode can hide behind faster ones.
                let settled = passed[p - 1] > 0.0
                    && changes[p - 1].last().is_some_and(|c| *c <= SETTLED * options.accuracy);
                if excluded
                    && (settled && estimate <= options.tolerance || sinks(estimate, passed[p - 1], options))
                {
                    self.report.converged = true;
                    self.report.period = p as u32;
                    self.report.error_estimate = estimate;
                    return Ok(());
                }
                passed[p - 1] = if excluded && estimate <= options.tolerance {
                    estimate.max(f64::MIN_POSITIVE)
                } else {
                    0.0
                };
            }
            seen.push(g.clone());
            if seen.len() > BAND.0 {
                seen.remove(0);
            }
        }
        // Decay says nothing of states that have come to rest in the noise of the map; the band in which they stay does.
        if let Some(width) = band(&seen, &s, options).filter(|w| *w < self.report.error_estimate) {
            self.report.error_estimate = width;
            self.report.converged = width <= options.tolerance;
        }
        Ok(())
    }
}

/// The width of the band in which the last states lie, once they come no nearer to each other: a map less smooth than its accuracy says moves on for ever
/// about its orbit, which lies among them. `None` while they still move along, or too far for noise.
fn band(seen: &[Vec<f64>], s: &[f64], options: &OrbitOptions) -> Option<f64> {
    let half = BAND.0 / 2;
    if seen.len() < BAND.0 {
        return None;
    }
    let width = |states: &[Vec<f64>]| {
        let pairs =
            states.iter().enumerate().flat_map(|(k, a)| states[..k].iter().map(move |b| norm(a, b, s)));
        pairs.fold(0.0, f64::max)
    };
    let (all, before, after) = (width(seen), width(&seen[..half]), width(&seen[half..]));
    // States that move along are farther apart than either half is wide; states that come nearer leave a narrower half.
    (all <= BAND.1 * options.accuracy && all <= APART * before.min(after)).then_some(all)
}

/// Whether an estimate, falling from cycle to cycle as it does now, stands for an error below the tolerance.
fn sinks(estimate: f64, before: f64, options: &OrbitOptions) -> bool {
    let fall = (estimate / before).min(1.0 - 1.0 / MAX_GAIN);
    estimate * (fall / (1.0 - fall)).max(1.0) <= options.tolerance
}

/// Whether the next cycle ends the search with something to spare if estimate and residual go on falling by `fall`.
fn promises((estimate, residual): (f64, f64), fall: f64, options: &OrbitOptions) -> bool {
    fall * estimate <= PROMISED * options.tolerance && fall * residual <= options.accuracy
}

/// A difference of two iterates, of their residuals, and the noise in the latter.
#[derive(Clone)]
struct Secant {
    dy: DVector<f64>,
    dr: DVector<f64>,
    noise: f64,
}

impl Secant {
    /// Brings it to other scales.
    fn rescale(&mut self, by: &DVector<f64>) {
        self.dy.component_mul_assign(by);
        self.dr.component_mul_assign(by);
    }
}

/// What is known of the slope of a map, without scales.
fn known(map: &dyn CycleMap) -> Vec<Secant> {
    let (n, known) = (map.dim(), map.known());
    let of_these = known.iter().filter(|c| c.start.len() == n && c.change.len() == n);
    let secant = |c: &Change| Secant {
        dy: DVector::from_column_slice(&c.start),
        dr: DVector::from_column_slice(&c.change),
        noise: c.noise,
    };
    of_these.map(secant).collect()
}

/// What secants in the scales `s` say, without scales.
fn changes(secants: &[Secant], s: &[f64]) -> Vec<Change> {
    let unscaled = |v: &DVector<f64>| v.iter().zip(s).map(|(v, s)| v * s).collect();
    let of = |c: &Secant| Change { start: unscaled(&c.dy), change: unscaled(&c.dr), noise: c.noise };
    secants.iter().map(of).collect()
}

/// A cycle, and the step from it.
struct Tried {
    at: DVector<f64>,
    r: DVector<f64>,
    /// What the secants left over of the residual.
    rest: DVector<f64>,
    /// Part of the correction that was stepped.
    damping: f64,
}

impl Tried {
    /// What is left of the unexplained part, for the residual `r` that followed: a linear map answers a step of a part `d` of the correction by
    /// `(1 - d) r0 + d M rest`.
    fn left(&self, r: &DVector<f64>) -> DVector<f64> {
        (r - &self.r * (1.0 - self.damping)) / self.damping.max(1e-3)
    }
}

/// What the acceleration keeps from cycle to cycle, in scaled states.
struct Anderson {
    /// Scales of the states in the last cycle.
    s: Vec<f64>,
    secants: Vec<Secant>,
    /// The first secant that is stepped with.
    trusted: usize,
    /// Cycles since the residual came down to the noise of the map and stays there.
    idle: usize,
    /// Cycles since the residual was last halved that turned its direction, while it is within [`STALL`].
    stalled: usize,
    /// The cycle before.
    previous: Option<Tried>,
    /// Times that the start was cut off to the last one.
    standing: usize,
    /// Longest step: the states are no larger, and less where the machine could not follow.
    reach: f64,
    /// Smallest residual.
    best: f64,
    /// The estimate of the last cycle if it was good enough, else 0.
    passed: f64,
    /// The last residual.
    last: f64,
    /// Largest factor by which a residual was seen to understate an error.
    slowest: f64,
}

impl Anderson {
    /// For `n` states, of whose map the secants `known` are known.
    fn new(n: usize, known: Vec<Secant>) -> Self {
        Self {
            s: vec![1.0; n],
            secants: known,
            trusted: 0,
            idle: 0,
            stalled: 0,
            previous: None,
            standing: 0,
            reach: 1.0,
            best: f64::INFINITY,
            passed: 0.0,
            last: 0.0,
            slowest: 1.0,
        }
    }

    /// Start and residual of the cycle from `y` to `g` in its scales; what was kept is brought to the same scales.
    fn scaled(&mut self, map: &dyn CycleMap, y: &[f64], g: &[f64]) -> (DVector<f64>, DVector<f64>) {
        let n = y.len();
        let before = self.s.clone();
        map.scale(g, &mut self.s);
        let rescale = DVector::from_iterator(n, before.iter().zip(&self.s).map(|(before, s)| before / s));
        for secant in &mut self.secants {
            secant.rescale(&rescale);
        }
        if let Some(tried) = &mut self.previous {
            for v in [&mut tried.at, &mut tried.r, &mut tried.rest] {
                v.component_mul_assign(&rescale);
            }
        }
        let at = DVector::from_iterator(n, y.iter().zip(&self.s).map(|(y, s)| y / s));
        let r = DVector::from_iterator(n, g.iter().zip(y).zip(&self.s).map(|((g, y), s)| (g - y) / s));
        (at, r)
    }

    /// Whether the next start `y`, cut off from the `wanted` one, has been the last one, `at`, several times beside the residual of the cycle from there: the secants lead out of what the
    /// machine admits, as to a fixed point that repels, and would lead there for ever.
    fn stands(&mut self, at: &DVector<f64>, y: &[f64], wanted: &[f64], residual: f64) -> bool {
        let moved = at.iter().zip(y).zip(&self.s).map(|((at, y), s)| (y / s - at).abs());
        let stands = y != wanted && moved.fold(0.0, f64::max) <= STANDS.1 * residual;
        self.standing = if stands { self.standing + 1 } else { 0 };
        self.standing >= STANDS.0
    }

    /// Takes the secant to the cycle before, whose map was as accurate as `noise`. Returns how slowly decays what the secants did not
    /// explain.
    fn learn(&mut self, at: &DVector<f64>, r: &DVector<f64>, noise: f64, options: &OrbitOptions) -> f64 {
        let residual = r.amax();
        if residual > 4.0 * self.best {
            // The secants mislead: step with newer ones only. What they say of the multipliers is still of use.
            self.trusted = self.secants.len();
        }
        let falls = residual > SETTLED * options.accuracy || residual < 0.5 * self.best;
        self.idle = if falls { 0 } else { self.idle + 1 };
        let (near, halved) = (residual <= STALL.1 * options.accuracy, residual < 0.5 * self.best);
        // A slow mode goes on the way it went; noise does not.
        let turns = self.previous.as_ref().is_some_and(|b| r.dot(&b.r) < 0.5 * r.norm() * b.r.norm());
        self.stalled = if halved { 0 } else { self.stalled + usize::from(near && turns) };
        self.best = self.best.min(residual);
        let Some(before) = &self.previous else { return 0.0 };
        let secant = Secant { dy: at - &before.at, dr: r - &before.r, noise };
        // In the noise the older ones know more.
        if self.idle == 0 && secant.dy.amax() > 10.0 * noise {
            self.secants.push(secant);
        }
        if self.secants.len() > DEPTH {
            self.secants.remove(0);
            self.trusted = self.trusted.saturating_sub(1);
        }
        // For a linear map r = M rest. Modes that change their sign do not let a residual understate an error.
        let floor = (0.1 * before.r.norm()).max(options.accuracy);
        let left = before.left(r);
        if left.dot(&before.rest) > 0.0 { left.norm() / before.rest.norm().max(floor) } else { 0.0 }
    }
}

/// Decay per cycle of a sequence of changes, and the last change. The shortest stretch that shows a decay beyond the noise
/// decides, noise counted against it: then a slow mode shows as soon as the fast ones have left, and a sequence that has
/// come down to its noise is judged by how it came there.
fn decay(changes: &[f64], noise: f64) -> (f64, f64) {
    let Some((&last, earlier)) = changes.split_last() else { return (1.0, f64::INFINITY) };
    for (w, &c) in earlier.iter().rev().enumerate() {
        if c > last + 4.0 * noise || (noise == 0.0 && c > last) {
            return (elementary::powf((last + noise) / (c - noise), 1.0 / (w + 1) as f64).min(1.0), last);
        }
    }
    (1.0, last)
}

/// The part of `r` that the secants explain, as the change of the end state it stands for, and the rest. Newer secants come first;
/// one that says nothing new beyond its noise is left out.
fn explain(secants: &[Secant], r: &DVector<f64>, fresh: f64) -> (DVector<f64>, DVector<f64>) {
    let mut rest = r.clone();
    let mut correction = DVector::zeros(r.len());
    // Orthonormal directions of residuals, with the end states they belong to.
    let mut basis: Vec<(DVector<f64>, DVector<f64>)> = Vec::new();
    for secant in secants.iter().rev() {
        let (mut q, mut g) = (secant.dr.clone(), &secant.dy + &secant.dr);
        // Twice is enough for orthogonality to rounding.
        for _ in 0..2 {
            for (b, h) in &basis {
                let c = b.dot(&q);
                q -= b * c;
                g -= h * c;
            }
        }
        let size = q.norm();
        if size.is_finite() && size > secant.noise.max(fresh * secant.dr.norm()) {
            (q, g) = (q / size, g / size);
            let c = q.dot(&rest);
            rest -= &q * c;
            correction += &g * c;
            basis.push((q, g));
        }
    }
    (correction, rest)
}

/// By how much the eigenvalue `l` of `m` is in doubt where the columns of `m` are by `blur`: `|E v|` for its eigenvector `v`.
fn blur_of(m: &DMatrix<f64>, l: f64, blur: &[f64]) -> f64 {
    let n = m.nrows();
    // Singular values fall: the last direction is that of the eigenvector.
    let kernel = SVD::try_new(m - DMatrix::identity(n, n) * l, false, true, 1e-12, 200);
    let Some(v) = kernel.and_then(|k| k.v_t).filter(|v| v.nrows() > 0) else { return 0.0 };
    v.row(n - 1).iter().zip(blur).map(|(v, b)| (v * b).powi(2)).sum::<f64>().sqrt()
}

/// Largest multiplier (its magnitude) of the map on the span of the iterates' differences, and the largest factor `1/|1 - λ|` by
/// which a residual there understates an error, at most what the noise of the differences can tell; and whether an unstable fixed point must be thought possible. Differences that
/// are not well apart, or near the noise, are left out.
fn spectrum(secants: &[Secant], fresh: f64) -> (f64, f64, bool) {
    let mut basis: Vec<(DVector<f64>, DVector<f64>)> = Vec::new();
    let mut blur = Vec::new();
    for secant in secants.iter().rev() {
        let (mut q, mut g) = (secant.dy.clone(), &secant.dy + &secant.dr);
        for _ in 0..2 {
            for (b, h) in &basis {
                let c = b.dot(&q);
                q -= b * c;
                g -= h * c;
            }
        }
        let size = q.norm();
        if size.is_finite() && size > (30.0 * secant.noise).max(fresh.max(0.01) * secant.dy.norm()) {
            basis.push((q / size, g / size));
            blur.push(secant.noise / size);
        }
    }
    if basis.is_empty() {
        return (0.0, 1.0, false);
    }
    let m = DMatrix::from_fn(basis.len(), basis.len(), |i, j| basis[i].0.dot(&basis[j].1));
    let eigenvalues = Schur::try_new(m.clone(), 1e-12, 200).map(|s| s.complex_eigenvalues());
    let (mut largest, mut gain, mut suspect) = (0.0_f64, 1.0_f64, false);
    for l in eigenvalues.iter().flat_map(|e| e.iter()) {
        largest = largest.max(l.norm());
        suspect |= l.norm() > if l.re < 0.9 * l.norm() { SUSPECT_TURNING } else { SUSPECT };
        let blurred = if l.im == 0.0 { blur_of(&m, l.re, &blur) } else { 0.0 };
        gain = gain.max(1.0 / (l - 1.0).norm().max(blurred).max(1.0 / MAX_GAIN));
    }
    (largest, gain, suspect)
}
