//! Periodic orbits: fixed points of the map from the start of a cycle to its end.
//!
//! Plain repetition converges with the largest multiplier λ of the map, which for a coupled ring pack can be 0.9 and more.
//! Anderson's acceleration (walker2011) needs no derivative and finds a few slow modes in as many cycles.
//!
//! # What is reported
//! The change over one cycle, `r = Φ(y) - y`, underestimates the distance to the orbit by up to 1/(1 - λ). With `r = Σ γ_j Δr_j + ρ`,
//! where `Δr_j` belong to the steps `Δy_j` between earlier iterates, a linear map obeys
//!
//! ```text
//! y - y* = Σ γ_j Δy_j + (M - I)⁻¹ ρ,    and the next iterate y - Σ γ_j Δy_j + ρ has the residual M ρ.
//! ```
//!
//! So the ratio `|r_{k+1}| / |ρ_k|` measures what the map does to the part that no earlier step explains. The estimate is
//! `λ |ρ| / (1 - λ)` with the largest of the last three such ratios (at least 0.9), plus a tenth of `|Σ γ_j Δy_j|` for the curvature of the map. Before two
//! ratios were measured nothing is known about a slow mode behind the fast ones: `1 / (1 - λ)` is then taken as 300.
//! A mode whose share of all residuals so far was negligible cannot be seen by any method.
//!
//! # Stability
//! A fixed point with |λ| > 1 is not what the machine does, but the acceleration finds it as easily. When the multiplier in the span of
//! the iterates comes near 1, a displaced state decides: if it does not come back, the orbit that repeats after two cycles is sought,
//! then any that plain repetition finds.

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
/// Multiplier beyond which a displaced state must confirm a fixed point.
const SUSPECT: f64 = 0.97;
/// 1/(1 - λ) for the part of the residual about which nothing was measured yet.
const UNKNOWN: f64 = 300.0;
/// Multiplier that is always thought possible for the unexplained part: a mode that hides behind faster ones.
const HIDDEN: f64 = 0.9;
/// Displacement of the stability test, in scaled units, and the cycles it may take.
const DISPLACEMENT: f64 = 0.03;
const TEST_CYCLES: usize = 8;

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
    search.accelerated(map, y, options, 1)?;
    if search.report.converged && search.report.multiplier < SUSPECT {
        return Ok(search.finish());
    }
    if search.report.converged {
        // Near or beyond the edge of stability: what does the machine itself do?
        let fixed = y.to_vec();
        let mut s = vec![1.0; y.len()];
        map.scale(y, &mut s);
        let mut z: Vec<f64> = y
            .iter()
            .zip(&s)
            .enumerate()
            .map(|(i, (y, s))| y + s * DISPLACEMENT * if i % 2 == 0 { 1.0 } else { -0.7 })
            .collect();
        let mut g = z.clone();
        let mut away = [DISPLACEMENT; TEST_CYCLES + 1];
        for distance in &mut away[1..] {
            search.apply(map, &z, &mut g, options.accuracy, 1)?;
            z.copy_from_slice(&g);
            *distance = norm(&z, &fixed, &s);
        }
        // The first half of the cycles lets the fast modes die out; a state that went far and came nearer by chance (chaos) has
        // not come back.
        let half = away[TEST_CYCLES / 2];
        if (half <= 2.0 * DISPLACEMENT && away[TEST_CYCLES] <= half)
            || away[TEST_CYCLES] <= 2.0 * options.tolerance
        {
            return Ok(search.finish());
        }
        search.report.converged = false;
        y.copy_from_slice(&z);
    }
    // An orbit that repeats after two cycles, and does not after one.
    let fallback = y.to_vec();
    search.accelerated(map, y, options, 2)?;
    if search.report.converged && search.report.multiplier < 1.0 {
        let mut g = y.to_vec();
        let mut s = vec![1.0; y.len()];
        search.apply(map, y, &mut g, options.accuracy, 1)?;
        map.scale(&g, &mut s);
        if norm(&g, y, &s) > 10.0 * search.report.error_estimate.max(options.tolerance) {
            search.report.period = 2;
            return Ok(search.finish());
        }
    }
    search.report.converged = false;
    y.copy_from_slice(&fallback);
    search.plain(map, y, options)?;
    Ok(search.finish())
}

struct Search {
    report: OrbitReport,
    cost: f64,
    last_cost: f64,
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
            },
            cost: 0.0,
            last_cost: 1.0,
        }
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

    fn accelerated(
        &mut self,
        map: &mut dyn CycleMap,
        y: &mut [f64],
        options: &OrbitOptions,
        times: usize,
    ) -> Result<(), EvalError> {
        let n = y.len();
        let mut g = vec![0.0; n];
        let mut s = vec![1.0; n];
        // Differences of successive iterates and of their residuals, newest last, unscaled.
        let (mut dy, mut dr): (Vec<DVector<f64>>, Vec<DVector<f64>>) = (Vec::new(), Vec::new());
        let mut previous: Option<(DVector<f64>, DVector<f64>)> = None;
        // The image of the last iterate: where to go on when an extrapolated state cannot be computed.
        let mut image: Option<Vec<f64>> = None;
        // Size of the unexplained part, and the ratios it led to.
        let mut unexplained = f64::INFINITY;
        let mut gains: Vec<f64> = Vec::new();
        let mut best = f64::INFINITY;
        // Half of the cycles: what does not settle accelerated must have some left to be watched plainly.
        let limit = (options.max_cycles / 2).div_ceil(times).max(3);
        for k in 0..limit {
            // Far from the orbit a rough map does: the first cycle only has to leave the arbitrary start.
            let accuracy = if k == 0 && times == 1 { options.accuracy.max(1e-3) } else { options.accuracy };
            if let Err(e) = self.apply(map, y, &mut g, accuracy, times) {
                let Some(safe) = image.take() else { return Err(e) };
                y.copy_from_slice(&safe);
                dy.clear();
                dr.clear();
                previous = None;
                self.apply(map, y, &mut g, accuracy, times)?;
            }
            map.scale(&g, &mut s);
            let ys = DVector::from_column_slice(y);
            let rs = DVector::from_iterator(n, g.iter().zip(y.iter()).map(|(g, y)| g - y));
            let size = |v: &DVector<f64>| v.iter().zip(&s).map(|(v, s)| (v / s).abs()).fold(0.0, f64::max);
            let residual = size(&rs);
            self.report.residual = residual;
            self.report.history.push(residual);
            if unexplained.is_finite() {
                gains.push(if unexplained > 0.0 { residual / unexplained } else { 0.0 });
            }
            if let Some((y0, r0)) = &previous {
                dy.push(&ys - y0);
                dr.push(&rs - r0);
                if dy.len() > DEPTH {
                    dy.remove(0);
                    dr.remove(0);
                }
            }
            if residual > 4.0 * best {
                // The secants mislead: keep the newest only.
                let keep = dy.len().saturating_sub(1);
                dy.drain(..keep);
                dr.drain(..keep);
            }
            best = best.min(residual);
            // The step away from the arbitrary start tells nothing about the neighbourhood of the orbit, and was rough.
            let (known_y, known_r): (&[_], &[_]) = if k >= 2 {
                let skip = if k <= DEPTH { usize::from(dy.len() == k) } else { 0 };
                (&dy[skip..], &dr[skip..])
            } else {
                (&[], &[])
            };
            let mut rest = rs.clone();
            let mut shift = DVector::zeros(n);
            if let Some(gamma) = least_squares(known_r, &rs, &s) {
                for (c, (dy, dr)) in gamma.iter().zip(known_y.iter().zip(known_r)) {
                    shift += dy * *c;
                    rest -= dr * *c;
                }
            }
            let (moved, left) = (size(&shift), size(&rest));
            if moved.is_nan() || moved > 1e4 * residual.max(options.tolerance) {
                // Extrapolation from noise.
                shift.fill(0.0);
                rest.copy_from(&rs);
            }
            let (moved, left) = if shift.amax() == 0.0 { (0.0, residual) } else { (moved, left) };
            unexplained = left;
            self.report.multiplier =
                multiplier(known_y, known_r, &s).unwrap_or_else(|| gains.last().copied().unwrap_or(1.0));
            let lambda = gains.iter().rev().take(3).copied().fold(HIDDEN, f64::max).min(0.999);
            let remainder = if gains.len() < 2 { UNKNOWN * left } else { left * lambda / (1.0 - lambda) };
            let estimate = remainder + 0.1 * moved;
            self.report.error_estimate = estimate;
            let next = &ys - &shift + &rest;
            image = Some(g.clone());
            y.copy_from_slice(next.as_slice());
            if k > 0 && estimate <= options.tolerance {
                self.report.converged = true;
                return Ok(());
            }
            previous = Some((ys, rs));
        }
        // Not converged: the last computed image is a state the map has reached.
        y.copy_from_slice(&g);
        Ok(())
    }

    fn plain(
        &mut self,
        map: &mut dyn CycleMap,
        y: &mut [f64],
        options: &OrbitOptions,
    ) -> Result<(), EvalError> {
        let n = y.len();
        let mut s = vec![1.0; n];
        let mut seen: Vec<Vec<f64>> = vec![y.to_vec()];
        let mut g = vec![0.0; n];
        let first = self.report.cycles;
        while self.report.cycles < options.max_cycles.max(first + 2 * MAX_PERIOD) {
            self.apply(map, y, &mut g, options.accuracy, 1)?;
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

/// Indices of the columns, newest first, that are independent of the newer ones to within `tolerance` of their length, with an
/// orthonormal basis of their span (scaled by 1/s).
fn independent(columns: &[DVector<f64>], s: &[f64], tolerance: f64) -> (Vec<usize>, Vec<DVector<f64>>) {
    let (mut used, mut basis): (Vec<usize>, Vec<DVector<f64>>) = (Vec::new(), Vec::new());
    for (i, c) in columns.iter().enumerate().rev() {
        let mut v = scaled(c, s);
        let length = v.norm();
        // Twice: one pass of Gram–Schmidt loses orthogonality of nearly dependent columns.
        for _ in 0..2 {
            for b in &basis {
                v.axpy(-b.dot(&v), b, 1.0);
            }
        }
        let left = v.norm();
        if left > tolerance * length && left > f64::MIN_POSITIVE {
            basis.push(v / left);
            used.push(i);
        }
    }
    (used, basis)
}

fn scaled(v: &DVector<f64>, s: &[f64]) -> DVector<f64> {
    DVector::from_iterator(v.len(), v.iter().zip(s).map(|(v, s)| v / s))
}

/// Largest multiplier of the map restricted to the span of the iterates' differences: spectral radius of `Qᵀ M Q`, with the
/// orthonormal basis `Q` of the steps and `M Δy = Δy + Δr`. `None` without steps.
fn multiplier(dy: &[DVector<f64>], dr: &[DVector<f64>], s: &[f64]) -> Option<f64> {
    let (used, basis) = independent(dy, s, 1e-4);
    if used.is_empty() {
        return None;
    }
    let y = DMatrix::from_columns(&used.iter().map(|&i| scaled(&dy[i], s)).collect::<Vec<_>>());
    let g = DMatrix::from_columns(&used.iter().map(|&i| scaled(&(&dy[i] + &dr[i]), s)).collect::<Vec<_>>());
    let q = DMatrix::from_columns(&basis);
    // Qᵀ M Q = (Qᵀ G)(Qᵀ Y)⁻¹.
    let inverse = (q.transpose() * y).try_inverse()?;
    let projected = q.transpose() * g * inverse;
    Schur::try_new(projected, 1e-12, 200)
        .map(|s| s.complex_eigenvalues().iter().map(|l| l.norm()).fold(0.0, f64::max))
}

/// Coefficients of the combination of `columns` nearest to `target` in the scaled 2-norm; columns that depend on newer ones get
/// zero. `None` without columns.
fn least_squares(columns: &[DVector<f64>], target: &DVector<f64>, s: &[f64]) -> Option<Vec<f64>> {
    let (used, basis) = independent(columns, s, 1e-7);
    if used.is_empty() {
        return None;
    }
    let m = used.len();
    let t = scaled(target, s);
    // R γ = Qᵀ t with R = Qᵀ A upper triangular in the order of `used`.
    let a: Vec<DVector<f64>> = used.iter().map(|&i| scaled(&columns[i], s)).collect();
    let mut x: Vec<f64> = basis.iter().map(|b| b.dot(&t)).collect();
    for i in (0..m).rev() {
        for j in i + 1..m {
            x[i] -= basis[i].dot(&a[j]) * x[j];
        }
        x[i] /= basis[i].dot(&a[i]);
    }
    let mut gamma = vec![0.0; columns.len()];
    for (i, x) in used.into_iter().zip(x) {
        gamma[i] = x;
    }
    Some(gamma)
}

/// Whether two solutions differ by more than `tolerance` in the scaled maximum norm; a NaN differs from everything.
#[must_use]
pub fn distinct(a: &[f64], b: &[f64], scale: &[f64], tolerance: f64) -> bool {
    a.len() != b.len() || !a.iter().zip(b).zip(scale).all(|((a, b), s)| (a - b).abs() <= tolerance * s)
}
