//! Search in stretches, for maps that are strongly bent: some cycles are repeated plainly, and what they say of the slopes is used for one step; then
//! again from there (vector extrapolation in cycles, sidi2017). Secants older than a stretch are dropped: they belong to other slopes.
//!
//! Slow modes of a map with stores that hardly see each other (oil before the edges of rings) are single states. A secant in the noise does not show them,
//! but three residuals of the state that fall by the same factor do (Aitken's process, state by state).

use nalgebra::DVector;

use super::{Bend, CycleMap, NEARER, OrbitOptions, ROUGHEST, Search, Secant, explain, sinks, spectrum};
use crate::EvalError;

/// Cycles that are not looked at: at the start, and after a step, which stirs up fast modes.
const FIRST: usize = 5;
const SKIPPED: usize = 2;
/// Secants of a stretch.
const GATHERED: usize = 2;
/// Part of the largest residual from which on a state is extrapolated alone, and of its own residual that the secants must have left over.
const LARGE: f64 = 0.1;
const LEFT: f64 = 0.3;
/// Multipliers between which it is; and how much they may differ from one cycle to the next, over the distance to one (0.1 at least).
const MULTIPLIERS: (f64, f64) = (0.5, 0.98);
const STEADY: f64 = 0.3;
/// Cycles at the noise of the map after which nothing more is expected: those of three stretches.
const IDLE: usize = 3 * (SKIPPED + GATHERED);

/// What is known since the last step.
struct Stretch {
    bend: Bend,
    /// Scales of the states in the last cycle.
    s: Vec<f64>,
    secants: Vec<Secant>,
    /// Residuals, oldest first.
    residuals: Vec<DVector<f64>>,
    /// Start of the last cycle.
    at: Option<DVector<f64>>,
    /// Cycles that are still skipped.
    skipped: usize,
    /// Largest factor by which a residual understated an error before the step.
    held: f64,
    /// Longest step: less where the machine could not follow.
    reach: f64,
    /// Smallest residual.
    best: f64,
    /// Cycles since the residual came down to the noise of the map and stays there.
    idle: usize,
}

impl Stretch {
    fn new(n: usize, bend: Bend) -> Self {
        Self {
            bend,
            s: vec![1.0; n],
            secants: Vec::new(),
            residuals: Vec::new(),
            at: None,
            skipped: FIRST,
            held: 1.0,
            reach: bend.reach,
            best: f64::INFINITY,
            idle: 0,
        }
    }

    /// Begins anew after a step.
    fn restart(&mut self) {
        self.secants.clear();
        self.residuals.clear();
        self.at = None;
        self.skipped = SKIPPED;
    }

    /// Takes the cycle from `y` to `g`, as accurate as `accuracy`.
    fn take(&mut self, map: &dyn CycleMap, y: &[f64], g: &[f64], accuracy: f64) {
        let before = self.s.clone();
        map.scale(g, &mut self.s);
        let n = y.len();
        let rescale = DVector::from_iterator(n, before.iter().zip(&self.s).map(|(b, s)| b / s));
        for secant in &mut self.secants {
            secant.dy.component_mul_assign(&rescale);
            secant.dr.component_mul_assign(&rescale);
        }
        for v in self.residuals.iter_mut().chain(&mut self.at) {
            v.component_mul_assign(&rescale);
        }
        let at = DVector::from_iterator(n, y.iter().zip(&self.s).map(|(y, s)| y / s));
        let r = DVector::from_iterator(n, g.iter().zip(y).zip(&self.s).map(|((g, y), s)| (g - y) / s));
        if self.skipped > 0 {
            self.skipped -= 1;
        } else if let (Some(from), Some(last)) = (&self.at, self.residuals.last()) {
            let noise = self.bend.noise * accuracy;
            self.secants.push(Secant { dy: &at - from, dr: &r - last, noise });
        }
        self.at = Some(at);
        self.residuals.push(r);
    }

    fn ready(&self) -> bool {
        self.secants.len() >= GATHERED
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
            (now.norm() / before.norm().max(accuracy)).powf(1.0 / cycles)
        } else {
            0.0
        }
    }

    /// Whether a state moved to the same side in the last four cycles.
    fn drifts(&self, i: usize) -> bool {
        let n = self.residuals.len();
        let last = |k: usize| self.residuals[n - 1 - k][i];
        n >= 4 && (1..4).all(|k| last(k) * last(0) > 0.0)
    }

    /// The step from the end of the last cycle: what the secants explain, and what single states go on by. No state is sent back that only went forth: where it
    /// drifts at a constant rate the secants know nothing but noise of it.
    fn step(&self) -> DVector<f64> {
        let [.., r0, r1, r] = &self.residuals[..] else { return DVector::zeros(self.s.len()) };
        let (correction, rest) = explain(&self.secants, r, self.bend.fresh);
        let residual = r.amax();
        let longest = (self.bend.stride * residual).min(self.reach);
        let mut step = -&correction * (longest / correction.amax().max(f64::MIN_POSITIVE)).min(1.0);
        for i in 0..step.len() {
            if step[i] * r[i] < 0.0 && self.drifts(i) {
                step[i] = 0.0;
            }
            let left = rest[i].abs() >= (LARGE * residual).max(LEFT * r[i].abs());
            if let Some(further) = left.then(|| further([r0[i], r1[i], r[i]])).flatten() {
                step[i] = further.clamp(-self.reach, self.reach);
            }
        }
        step
    }
}

/// How far a state goes on whose residuals fall by the same factor.
fn further(r: [f64; 3]) -> Option<f64> {
    if r[0] * r[1] <= 0.0 || r[1] * r[2] <= 0.0 {
        return None;
    }
    let (before, now) = (r[1] / r[0], r[2] / r[1]);
    let steady = (before - now).abs() <= STEADY * (1.0 - now.min(1.0)).max(0.1);
    let multiplier = now.min(MULTIPLIERS.1);
    (steady && now >= MULTIPLIERS.0).then(|| r[2] * multiplier / (1.0 - multiplier))
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
        let mut state = Stretch::new(y.len(), bend);
        let (mut g, mut end) = (y.to_vec(), y.to_vec());
        let (mut stepped, mut passed, mut last) = (false, 0.0, 0.0);
        let mut accuracy =
            if self.report.cycles == 0 { options.accuracy.max(1e-3) } else { options.accuracy };
        self.report.converged = false;
        self.noisy = false;
        while self.report.cycles + times <= limit {
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
            let estimate = self.judge_stretch(&mut state, options, last);
            let residual = self.report.residual;
            last = residual;
            let settled = passed > 0.0 && residual <= 3.0 * options.accuracy;
            if accurate && (settled && estimate <= options.tolerance || sinks(estimate, passed, options)) {
                self.report.converged = true;
                break;
            }
            if state.idle > IDLE {
                self.noisy = true;
                self.gain = self.gain.max(state.held);
                break;
            }
            passed = if estimate <= options.tolerance { estimate } else { 0.0 };
            accuracy = (bend.rough * residual).min(ROUGHEST).max(options.accuracy);
            y.copy_from_slice(&g);
            if state.ready() {
                let step = state.step();
                for ((y, d), s) in y.iter_mut().zip(step.iter()).zip(&state.s) {
                    *y += d * s;
                }
                map.admit(&g, y);
                stepped = true;
                state.restart();
            }
        }
        y.copy_from_slice(&g);
        Ok(())
    }

    /// The estimated error after a cycle of a stretch.
    fn judge_stretch(&mut self, state: &mut Stretch, options: &OrbitOptions, last: f64) -> f64 {
        let Some(r) = state.residuals.last() else { return f64::INFINITY };
        let residual = r.amax();
        self.report.residual = residual;
        self.report.history.push(residual);
        let (explained, rest) = explain(&state.secants, r, state.bend.fresh);
        let (largest, slow, suspect) = spectrum(&state.secants, state.bend.fresh);
        let ratio = state.ratio(options.accuracy);
        let seen = slow.max(1.0 / (1.0 - ratio.clamp(0.0, 1.0 - 1.0 / super::MAX_GAIN)));
        // Fast modes that a step stirred up hide a slow one: what was slow before it is taken to be slow still.
        let gain = seen.max(state.held);
        if state.ready() {
            state.held = seen;
            self.suspect = suspect;
            self.report.multiplier = largest.max(ratio.min(1.0));
        }
        let falls = residual > 3.0 * options.accuracy || residual < 0.5 * state.best;
        state.idle = if falls { 0 } else { state.idle + 1 };
        state.best = state.best.min(residual);
        let gain = gain.max(self.gain);
        let noise = residual.max(last).min(options.accuracy);
        let estimate = (explained.amax() + rest.amax() * gain).max(residual).max(noise * gain);
        self.report.error_estimate = estimate;
        estimate
    }
}
