//! Periodic orbits: fixed points of the map from the start of a cycle to its end.
//!
//! Plain repetition converges with the largest multiplier λ of the map, which for a coupled ring pack can be 0.9 and more.
//! Anderson's acceleration (walker2011) needs no derivative and finds a few slow modes in as many cycles. The change over one
//! cycle, `r = Φ(y) - y`, underestimates the distance to the orbit by 1/(1 - λ); what is reported is that distance, with λ
//! taken from the differences of the iterates. A fixed point with |λ| > 1 is not what the machine does: when the multiplier
//! comes near, plain repetition decides, and a cycle that repeats only every second or third time is reported as such.

use gudgeon_core::EvalError;
use nalgebra::{DMatrix, DVector, Schur};

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
}

/// What is wanted of an orbit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrbitOptions {
    /// Estimated true error, in the scaled maximum norm, at which the search ends.
    pub tolerance: f64,
    /// Accuracy of the map.
    pub accuracy: f64,
    /// Most cycles.
    pub max_cycles: usize,
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
}

/// Differences of earlier iterates that the acceleration keeps.
const DEPTH: usize = 4;
/// Longest repetition that is looked for.
const MAX_PERIOD: usize = 4;
/// Multiplier beyond which plain repetition must confirm a fixed point.
const SUSPECT: f64 = 0.97;

fn norm(a: &[f64], b: &[f64], s: &[f64]) -> f64 {
    a.iter().zip(b).zip(s).map(|((a, b), s)| ((a - b) / s).abs()).fold(0.0, |m, v| if v.is_nan() { f64::INFINITY } else { m.max(v) })
}

/// Searches the orbit, starting from `y`; on return `y` is on it as nearly as `error_estimate` says.
///
/// # Errors
/// When a cycle cannot be computed.
pub fn periodic_orbit(map: &mut dyn CycleMap, y: &mut [f64], options: &OrbitOptions) -> Result<OrbitReport, EvalError> {
    let mut search = Search::new(map.dim());
    if options.accelerate {
        search.accelerated(map, y, options)?;
        if search.report.multiplier < SUSPECT || !search.report.converged {
            return Ok(search.finish());
        }
        // Near or beyond the edge of stability: what does the machine itself do? A nudge starts it off the fixed point.
        let mut s = vec![1.0; y.len()];
        map.scale(y, &mut s);
        let nudge = 30.0 * options.tolerance;
        let mut start: Vec<f64> = y.iter().zip(&s).enumerate().map(|(i, (y, s))| y + s * nudge * if i % 2 == 0 { 1.0 } else { -0.7 }).collect();
        let fixed = y.to_vec();
        let before = search.report.clone();
        search.plain(map, &mut start, options)?;
        if search.report.period > 1 && search.report.converged {
            y.copy_from_slice(&start);
        } else if norm(&start, &fixed, &s) <= 2.0 * nudge {
            // It came back, or stayed: the fixed point stands, with its own estimate.
            let (cycles, cost, history) = (search.report.cycles, search.cost, search.report.history.clone());
            search.report = before;
            (search.report.cycles, search.cost, search.report.history) = (cycles, cost, history);
        } else {
            y.copy_from_slice(&start);
        }
        return Ok(search.finish());
    }
    search.plain(map, y, options)?;
    Ok(search.finish())
}

struct Search {
    report: OrbitReport,
    cost: f64,
    last_cost: f64,
}

impl Search {
    fn new(_dim: usize) -> Self {
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
            },
            cost: 0.0,
            last_cost: 1.0,
        }
    }

    fn finish(mut self) -> OrbitReport {
        self.report.cycle_equivalents = if self.last_cost > 0.0 { self.cost / self.last_cost } else { self.report.cycles as f64 };
        self.report
    }

    fn apply(&mut self, map: &mut dyn CycleMap, y: &[f64], g: &mut [f64], accuracy: f64) -> Result<(), EvalError> {
        let cost = map.map(y, g, accuracy)?;
        self.cost += cost;
        self.last_cost = cost;
        self.report.cycles += 1;
        Ok(())
    }

    fn accelerated(&mut self, map: &mut dyn CycleMap, y: &mut [f64], options: &OrbitOptions) -> Result<(), EvalError> {
        let n = y.len();
        let mut g = vec![0.0; n];
        let mut s = vec![1.0; n];
        // Scaled differences of successive iterates and of their residuals, newest last.
        let (mut dy, mut dr): (Vec<DVector<f64>>, Vec<DVector<f64>>) = (Vec::new(), Vec::new());
        let mut previous: Option<(DVector<f64>, DVector<f64>)> = None;
        let mut best = f64::INFINITY;
        for k in 0..options.max_cycles {
            // Far from the orbit a rough map does: the first cycle only has to leave the arbitrary start.
            let accuracy = if k == 0 { options.accuracy.max(1e-3) } else { options.accuracy };
            self.apply(map, y, &mut g, accuracy)?;
            map.scale(&g, &mut s);
            let ys = DVector::from_iterator(n, y.iter().zip(&s).map(|(y, s)| y / s));
            let rs = DVector::from_iterator(n, g.iter().zip(y.iter()).zip(&s).map(|((g, y), s)| (g - y) / s));
            let residual = rs.amax();
            self.report.residual = residual;
            self.report.history.push(residual);
            if let Some((y0, r0)) = &previous {
                dy.push(&ys - y0);
                dr.push(&rs - r0);
                if dy.len() > DEPTH {
                    dy.remove(0);
                    dr.remove(0);
                }
            }
            let lambda = multiplier(&dy, &dr, options.accuracy);
            self.report.multiplier = lambda;
            // The distance of y from the orbit; g, which is returned, is nearer by λ.
            let estimate = residual / (1.0 - lambda.min(0.999)) * lambda.max(0.1);
            self.report.error_estimate = estimate;
            // One residual says nothing about λ: a second cycle is needed before anything is believed.
            if k > 0 && estimate <= options.tolerance {
                self.report.converged = true;
                y.copy_from_slice(&g);
                return Ok(());
            }
            previous = Some((ys.clone(), rs.clone()));
            if residual > 4.0 * best {
                // The secants mislead: forget them and repeat plainly once.
                dy.clear();
                dr.clear();
            }
            best = best.min(residual);
            let mut next = &ys + &rs;
            // The first step away from the arbitrary start tells nothing about the neighbourhood of the orbit.
            if k >= 2 && !dr.is_empty() {
                let usable = dr.len().min(k - 1);
                let (a, b) = (&dy[dy.len() - usable..], &dr[dr.len() - usable..]);
                if let Some(gamma) = least_squares(b, &rs) {
                    let mut correction = DVector::zeros(n);
                    for (c, (dy, dr)) in gamma.iter().zip(a.iter().zip(b)) {
                        correction += (dy + dr) * *c;
                    }
                    // A correction far larger than the residual is extrapolation from noise.
                    if correction.amax() <= 50.0 * residual.max(options.tolerance) {
                        next -= correction;
                    }
                }
            }
            for ((y, n), s) in y.iter_mut().zip(next.iter()).zip(&s) {
                *y = n * s;
            }
        }
        Ok(())
    }

    fn plain(&mut self, map: &mut dyn CycleMap, y: &mut [f64], options: &OrbitOptions) -> Result<(), EvalError> {
        let n = y.len();
        let mut s = vec![1.0; n];
        let mut seen: Vec<Vec<f64>> = vec![y.to_vec()];
        let mut g = vec![0.0; n];
        let first = self.report.cycles;
        while self.report.cycles - first < options.max_cycles {
            self.apply(map, y, &mut g, options.accuracy)?;
            map.scale(&g, &mut s);
            let residual = norm(&g, y, &s);
            let before = self.report.history.last().copied().filter(|_| self.report.cycles - first > 1);
            self.report.history.push(residual);
            self.report.residual = residual;
            let lambda = before.map_or(0.0, |b| if b > 0.0 { (residual / b).min(0.999) } else { 0.0 });
            self.report.multiplier = self.report.multiplier.max(lambda);
            y.copy_from_slice(&g);
            // The shortest repetition first; its residual over its own multiplier is the error.
            for p in 1..=MAX_PERIOD.min(seen.len()) {
                let change = norm(&g, &seen[seen.len() - p], &s);
                let estimate = if p == 1 { change / (1.0 - lambda) } else { change * 2.0 };
                if p == 1 {
                    self.report.error_estimate = estimate;
                }
                // A repetition must have been seen twice before it is believed.
                let again = seen.len() < 2 * p || {
                    let (a, b) = (&seen[seen.len() - p], &seen[seen.len() - 2 * p]);
                    norm(a, b, &s) <= 30.0 * options.tolerance
                };
                if estimate <= options.tolerance && seen.len() >= 2 * p.max(1) && again {
                    self.report.converged = true;
                    self.report.period = p as u32;
                    self.report.error_estimate = estimate;
                    return Ok(());
                }
            }
            seen.push(g.clone());
        }
        self.report.converged = false;
        Ok(())
    }
}

/// Largest multiplier of the map restricted to the span of the iterates' differences: eigenvalues of the least-squares
/// solution of `dg = M dy`, `dg = dy + dr`. Differences below the noise of the map are left out.
fn multiplier(dy: &[DVector<f64>], dr: &[DVector<f64>], noise: f64) -> f64 {
    let floor = 3.0 * noise;
    let pairs: Vec<usize> = (0..dy.len()).filter(|k| dy[*k].amax() > floor).collect();
    if pairs.is_empty() {
        // Nothing but noise between the iterates: a contraction too strong to see.
        return if dy.is_empty() { 0.9 } else { 0.0 };
    }
    // Fewer, better conditioned directions first: the newest pair alone, then all.
    let rayleigh = |k: usize| {
        let g = &dy[k] + &dr[k];
        (g.dot(&dy[k]) / dy[k].norm_squared()).abs()
    };
    let newest = pairs.last().map_or(0.0, |k| rayleigh(*k));
    let m = pairs.len();
    if m == 1 {
        return newest;
    }
    let y = DMatrix::from_columns(&pairs.iter().map(|k| dy[*k].normalize()).collect::<Vec<_>>());
    let g = DMatrix::from_columns(&pairs.iter().map(|k| (&dy[*k] + &dr[*k]) / dy[*k].norm()).collect::<Vec<_>>());
    let gram = y.transpose() * &y;
    let spectral = gram.clone().try_inverse().filter(|_| gram.determinant().abs() > 1e-6).and_then(|inv| {
        let projected = inv * y.transpose() * g;
        Schur::try_new(projected, 1e-12, 200).map(|s| s.complex_eigenvalues().iter().map(|l| l.norm()).fold(0.0, f64::max))
    });
    spectral.map_or(newest, |s| s.max(newest))
}

/// Coefficients of the combination of `columns` nearest to `target`; `None` when the columns are not independent enough.
fn least_squares(columns: &[DVector<f64>], target: &DVector<f64>) -> Option<Vec<f64>> {
    for drop in 0..columns.len() {
        let used = &columns[drop..];
        let a = DMatrix::from_columns(used);
        let svd = a.svd(true, true);
        let largest = svd.singular_values.max();
        if svd.singular_values.min() > 1e-6 * largest {
            let x = svd.solve(target, 0.0).ok()?;
            let mut gamma = vec![0.0; drop];
            gamma.extend(x.iter());
            return Some(gamma);
        }
    }
    None
}
