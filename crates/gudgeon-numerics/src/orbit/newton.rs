//! Newton's method for maps of few states, where secants of the way have led nowhere: the slope is taken by differences, a cycle a state, and goes on by Broyden's updates.
//!
//! ```text
//! (σ I - A) d = r        A = ∂r/∂y        r = Φ(y) - y
//! ```
//!
//! With a shift `σ` above every eigenvalue of `A` a step goes where the machine itself goes, only farther (pseudo-transient continuation, kelley1998): past a place where two orbits have just
//! vanished, and not to an orbit that repels. Without one it is Newton's. The shift is the least that keeps the step within what the last ones have shown to be nearly straight.

use nalgebra::{DMatrix, DVector, Schur};

use super::{CycleMap, IDLE, MAX_GAIN, NEARER, OrbitOptions, SETTLED, Search, Secant, changes, sinks};
use crate::EvalError;

/// Most states.
const FEW: usize = 4;
/// Cycles of the acceleration before.
pub const BEFORE: usize = 12;
/// First longest step, and the longest.
const REACH: f64 = 0.1;
const FARTHEST: f64 = 1.0;
/// Part of the longest step by which the slope is taken, and limits of that; at least so many times the noise. Kinks of a map look like noise to a shorter one.
const INCREMENT: f64 = 0.1;
const INCREMENTS: (f64, f64) = (1e-3, 0.02);
const OVER_NOISE: f64 = 30.0;
/// Step over the noise from which on it says something of the slope.
const LEARNT: f64 = 10.0;
/// How much a residual may differ from what was foreseen, over the larger of it and the one before, so that much longer steps are tried, longer ones, and that the step is taken.
const STRAIGHTER: f64 = 0.1;
const STRAIGHT: f64 = 0.25;
const BENT: f64 = 1.0;
/// How many times as large a residual must be as the one before for a step to be taken back.
const WORSE: f64 = 2.0;
/// How far the shift is above the largest eigenvalue, over that; the smallest that is tried after none, and the largest.
const ABOVE: f64 = 0.2;
const SMALLEST: f64 = 1e-3;
const LARGEST: f64 = 1e6;
/// How many times as noisy a map is taken to be as before where steps go astray that are hardly longer than its noise.
const DOUBTED: f64 = 3.0;
/// Cycles at the noise of the map before a more accurate one is asked for: many are smoother than they say.
const SMOOTHER: usize = 1;
/// Multiplier from which on the machine itself is asked whether it stays. Slopes are not closer than that.
const REPELS: f64 = 1.01;
/// Steps of one slope, updates included.
const KEPT: usize = 6;

/// Whether a map has so few states that its slope costs little.
pub fn is_small(map: &dyn CycleMap) -> bool {
    (1..=FEW).contains(&map.dim()) && map.bend().is_none()
}

/// Whether the method has its turn after some cycles.
pub fn serves(map: &dyn CycleMap, cycles: usize, options: &OrbitOptions) -> bool {
    is_small(map) && !map.gives_up() && cycles + map.dim() + 1 < options.max_cycles
}

/// A cycle.
struct Looked {
    y: Vec<f64>,
    g: Vec<f64>,
    /// Scales, and the residual in them.
    s: Vec<f64>,
    r: DVector<f64>,
}

/// The slope of the residual in scaled states, and the steps since it was taken.
struct Slope {
    a: DMatrix<f64>,
    age: usize,
}

impl Slope {
    /// Broyden's update: the residual changed by `dr` over `d`.
    fn learn(&mut self, d: &DVector<f64>, dr: &DVector<f64>) {
        let size = d.norm_squared();
        if size > 0.0 {
            self.a += (dr - &self.a * d) * (d.transpose() / size);
        }
    }

    /// The largest real part of the eigenvalues, the largest magnitude of those of the map, and the largest factor by which a residual understates an error.
    fn spectrum(&self) -> (f64, f64, f64) {
        let all = Schur::try_new(self.a.clone(), 1e-12, 200).map(|s| s.complex_eigenvalues());
        let all: Vec<_> = all.iter().flat_map(|e| e.iter().copied()).collect();
        let real = all.iter().map(|l| l.re).fold(f64::NEG_INFINITY, f64::max);
        let multiplier = all.iter().map(|l| (l + 1.0).norm()).fold(0.0, f64::max);
        let least = all.iter().map(|l| l.norm()).fold(f64::INFINITY, f64::min);
        (real, multiplier, 1.0 / least.max(1.0 / MAX_GAIN))
    }

    /// The step from the residual `r`, not longer than `reach`; as far as a plain cycle goes where no shift makes it that short.
    fn step(&self, r: &DVector<f64>, reach: f64) -> DVector<f64> {
        let n = r.len();
        let edge = self.spectrum().0.max(0.0);
        let mut shift = (1.0 + ABOVE) * edge;
        while shift < LARGEST {
            let d = (DMatrix::identity(n, n) * shift - &self.a).lu().solve(r);
            if let Some(d) = d.filter(|d| d.amax() <= reach) {
                return d;
            }
            shift = 2.0 * shift.max(SMALLEST + edge);
        }
        r.clone()
    }
}

impl Search {
    /// Searches from `y`, until there were `options.max_cycles` cycles; the accuracy that was asked for at last.
    pub(super) fn by_newton(
        &mut self,
        map: &mut dyn CycleMap,
        y: &mut [f64],
        options: &OrbitOptions,
    ) -> Result<f64, EvalError> {
        let mut options = *options;
        let (mut reach, mut slope, mut passed, mut last) = (REACH, None::<Slope>, 0.0, f64::INFINITY);
        let (mut idle, mut doubt) = (0, 1.0);
        let mut here = self.looked(map, y, &options)?;
        while !map.gives_up() {
            let known = match slope.take().filter(|s| s.age < KEPT) {
                Some(known) => known,
                None if self.report.cycles + map.dim() >= options.max_cycles => break,
                None => self.slope(map, &here, (reach, &options))?,
            };
            let known = slope.insert(known);
            let (estimate, blurred) =
                self.judge_by(known, &here, last, doubt * map.noise() * options.accuracy);
            y.copy_from_slice(&here.g);
            if estimate.max(blurred) <= options.tolerance && sinks(estimate, passed, &options) {
                self.report.converged = true;
                break;
            }
            if self.report.cycles >= options.max_cycles {
                break;
            }
            passed = if estimate.max(blurred) <= options.tolerance { estimate } else { 0.0 };
            last = here.r.amax();
            // What passes is looked at once more before more accuracy is asked for.
            idle = if passed == 0.0 && last <= SETTLED * options.accuracy { idle + 1 } else { 0 };
            if idle > if options.refinements > 0 { SMOOTHER } else { IDLE } {
                if options.refinements == 0 {
                    break;
                }
                options.refinements -= 1;
                options.accuracy *= 0.1;
                (idle, last, doubt) = (0, f64::INFINITY, 1.0);
                reach = reach.max(NEARER * REACH);
                here = self.looked(map, &here.y, &options)?;
                continue;
            }
            here = self.stepped(map, here, known, (&mut reach, &mut doubt, &options))?;
        }
        if let Some(slope) = &slope {
            self.report.changes = changes(&secants(slope, options.accuracy), &here.s);
        }
        Ok(options.accuracy)
    }

    /// A cycle from `y`.
    fn looked(
        &mut self,
        map: &mut dyn CycleMap,
        y: &[f64],
        options: &OrbitOptions,
    ) -> Result<Looked, EvalError> {
        let (mut g, mut s) = (vec![0.0; y.len()], vec![1.0; y.len()]);
        self.apply(map, y, &mut g, options.accuracy, 1)?;
        map.scale(&g, &mut s);
        let r = DVector::from_iterator(y.len(), g.iter().zip(y).zip(&s).map(|((g, y), s)| (g - y) / s));
        Ok(Looked { y: y.to_vec(), g, s, r })
    }

    /// The same, or nothing where the machine could not be.
    fn tried(
        &mut self,
        map: &mut dyn CycleMap,
        y: &[f64],
        options: &OrbitOptions,
    ) -> Result<Option<Looked>, EvalError> {
        match self.looked(map, y, options) {
            Err(e) if e.is_recoverable() => {
                self.report.cycles += 1;
                Ok(None)
            }
            looked => looked.map(Some),
        }
    }

    /// The slope at a cycle, by one cycle a state.
    fn slope(
        &mut self,
        map: &mut dyn CycleMap,
        here: &Looked,
        (reach, options): (f64, &OrbitOptions),
    ) -> Result<Slope, EvalError> {
        let n = here.y.len();
        let mut slope = Slope { a: -DMatrix::identity(n, n), age: 0 };
        let h = (INCREMENT * reach).clamp(INCREMENTS.0, INCREMENTS.1).max(OVER_NOISE * options.accuracy);
        for j in 0..n {
            let mut y = here.y.clone();
            y[j] += h * here.s[j].copysign(here.r[j]);
            map.admit(&here.g, &mut y);
            if let Some(beside) = self.tried(map, &y, options)? {
                slope.learn(&apart(&y, here), &(in_scales(&beside, here) - &here.r));
            }
        }
        Ok(slope)
    }

    /// The estimated error after a cycle, and what noise alone may leave.
    fn judge_by(&mut self, slope: &Slope, here: &Looked, last: f64, noise: f64) -> (f64, f64) {
        let residual = here.r.amax();
        let (_, multiplier, gain) = slope.spectrum();
        (self.report.multiplier, self.suspect) = (multiplier, multiplier > REPELS);
        let left = slope.a.clone().lu().solve(&here.r).map_or(f64::INFINITY, |d| d.amax());
        let (estimate, blurred) = (left.max(residual), gain * residual.max(last).min(noise));
        self.report.residual = residual;
        self.report.error_estimate = estimate.max(blurred);
        self.report.history.push(residual);
        (estimate, blurred)
    }

    /// The cycle after a step, or the same again where the step led elsewhere than was foreseen.
    fn stepped(
        &mut self,
        map: &mut dyn CycleMap,
        here: Looked,
        slope: &mut Slope,
        (reach, doubt, options): (&mut f64, &mut f64, &OrbitOptions),
    ) -> Result<Looked, EvalError> {
        let d = slope.step(&here.r, *reach);
        let mut y: Vec<f64> = here.y.iter().zip(&d).zip(&here.s).map(|((y, d), s)| y + d * s).collect();
        map.admit(&here.g, &mut y);
        slope.age += 1;
        let noise = *doubt * map.noise() * options.accuracy;
        let Some(there) = self.tried(map, &y, options)? else {
            *reach = NEARER * d.amax();
            return Ok(here);
        };
        let (d, r) = (apart(&y, &here), in_scales(&there, &here));
        let (foreseen, before) = (&here.r + &slope.a * &d, here.r.amax());
        let miss = ((&r - &foreseen).amax() - noise) / before.max(foreseen.amax());
        if d.amax() > LEARNT * noise {
            slope.learn(&d, &(&r - &here.r));
        }
        if miss > BENT && r.amax() > WORSE * before + noise && d.amax() > OVER_NOISE * noise {
            if d.amax() <= 2.0 * OVER_NOISE * noise {
                // So near the map cannot be that bent: it is noisier than it says.
                *doubt *= DOUBTED;
            }
            *reach = (NEARER * d.amax()).max(OVER_NOISE * noise).min(FARTHEST);
            slope.age += KEPT / 2;
            return Ok(here);
        }
        if miss < STRAIGHT {
            let farther = if miss < STRAIGHTER { 4.0 } else { 2.0 };
            *reach = (farther * d.amax()).clamp(*reach, FARTHEST);
        }
        Ok(there)
    }
}

/// How far `y` is from the start of a cycle, in its scales.
fn apart(y: &[f64], from: &Looked) -> DVector<f64> {
    DVector::from_iterator(y.len(), y.iter().zip(&from.y).zip(&from.s).map(|((a, b), s)| (a - b) / s))
}

/// The residual of a cycle in the scales of another.
fn in_scales(of: &Looked, other: &Looked) -> DVector<f64> {
    DVector::from_iterator(of.r.len(), of.r.iter().zip(&of.s).zip(&other.s).map(|((r, s), t)| r * s / t))
}

/// A slope as secants along the states.
fn secants(slope: &Slope, noise: f64) -> Vec<Secant> {
    let n = slope.a.nrows();
    let along = |j: usize| {
        let dy = DVector::from_fn(n, |i, _| if i == j { INCREMENTS.1 } else { 0.0 });
        Secant { dr: &slope.a * &dy, dy, noise }
    };
    (0..n).map(along).collect()
}
