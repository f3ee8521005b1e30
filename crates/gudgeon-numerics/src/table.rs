//! Interpolation of tabulated functions of one variable: monotone cubic and periodic cubic spline.
//!
//! Both are piecewise cubics given by values and derivatives at the nodes and return value and derivative. Look-up is a
//! multiplication on a uniform grid, otherwise a search that starts from a hint (the interval found last).

/// A table that cannot be interpolated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TableError {
    /// Fewer rows than the method needs.
    #[error("the table has {rows} rows and needs at least {needed}")]
    TooShort {
        /// Rows given.
        rows: usize,
        /// Rows needed.
        needed: usize,
    },
    /// The two columns differ in length.
    #[error("the table has {x} abscissae and {y} values")]
    Lengths {
        /// Abscissae.
        x: usize,
        /// Values.
        y: usize,
    },
    /// A number that is not finite.
    #[error("row {row} of the table is not a finite number")]
    NotFinite {
        /// Which row, counted from 1.
        row: usize,
    },
    /// Abscissae that repeat or go back.
    #[error("row {row} of the table: {x} does not lie above {before}")]
    NotIncreasing {
        /// Which row, counted from 1.
        row: usize,
        /// Its abscissa.
        x: f64,
        /// The abscissa before.
        before: f64,
    },
    /// The period does not exceed the range of the abscissae.
    #[error("the period {period} does not exceed the range of the table, {range}")]
    Period {
        /// The period.
        period: f64,
        /// Last minus first abscissa.
        range: f64,
    },
}

/// A piecewise cubic through `(x, y)` with derivatives `d`.
#[derive(Debug, Clone, PartialEq)]
struct Hermite {
    x: Vec<f64>,
    y: Vec<f64>,
    d: Vec<f64>,
    /// 1 / spacing when the grid is uniform to rounding.
    inv_dx: Option<f64>,
    /// Period, when the table wraps; then the first node is repeated at the end.
    period: Option<f64>,
}

fn check(x: &[f64], y: &[f64], needed: usize, period: Option<f64>) -> Result<(), TableError> {
    if x.len() != y.len() {
        return Err(TableError::Lengths { x: x.len(), y: y.len() });
    }
    if x.len() < needed {
        return Err(TableError::TooShort { rows: x.len(), needed });
    }
    if let Some(row) = x.iter().zip(y).position(|(x, y)| !(x.is_finite() && y.is_finite())) {
        return Err(TableError::NotFinite { row: row + 1 });
    }
    if let Some(i) = x.windows(2).position(|w| w[1] <= w[0]) {
        return Err(TableError::NotIncreasing { row: i + 2, x: x[i + 1], before: x[i] });
    }
    if let Some(period) = period {
        let range = x[x.len() - 1] - x[0];
        // Written so that a NaN period fails.
        if !(period > range && period.is_finite()) {
            return Err(TableError::Period { period, range });
        }
    }
    Ok(())
}

impl Hermite {
    fn new(x: Vec<f64>, y: Vec<f64>, d: Vec<f64>, period: Option<f64>) -> Self {
        let n = x.len();
        let dx = (x[n - 1] - x[0]) / (n - 1) as f64;
        // A node may sit off its uniform place by the rounding of the abscissae; `locate` corrects by one interval.
        let tolerance = 1e-9 * dx;
        let uniform = x.iter().enumerate().all(|(i, v)| (v - (x[0] + i as f64 * dx)).abs() <= tolerance);
        Self { x, y, d, inv_dx: uniform.then_some(1.0 / dx), period }
    }

    /// Argument brought into the range of the nodes.
    fn wrap(&self, x: f64) -> f64 {
        match self.period {
            // rem_euclid is exact, and may round up to the period itself, which is the last node.
            Some(p) => self.x[0] + (x - self.x[0]).rem_euclid(p),
            None => x,
        }
    }

    /// The interval of `x`, which lies within the nodes.
    fn locate(&self, x: f64, hint: usize) -> usize {
        let last = self.x.len() - 2;
        if let Some(inv) = self.inv_dx {
            let i = (((x - self.x[0]) * inv) as usize).min(last);
            // The quotient may round across a node.
            return if x < self.x[i] && i > 0 {
                i - 1
            } else if x >= self.x[i + 1] && i < last {
                i + 1
            } else {
                i
            };
        }
        let hint = hint.min(last);
        if x >= self.x[hint] {
            if x < self.x[hint + 1] {
                return hint;
            }
            if hint < last && x < self.x[hint + 2] {
                return hint + 1;
            }
        }
        self.x.partition_point(|v| *v <= x).saturating_sub(1).min(last)
    }

    fn eval(&self, x: f64, hint: &mut usize) -> (f64, f64) {
        let x = self.wrap(x);
        let n = self.x.len();
        if self.period.is_none() {
            if x <= self.x[0] {
                return (self.y[0], if x < self.x[0] { 0.0 } else { self.d[0] });
            }
            if x >= self.x[n - 1] {
                return (self.y[n - 1], if x > self.x[n - 1] { 0.0 } else { self.d[n - 1] });
            }
        }
        let i = self.locate(x, *hint);
        *hint = i;
        let h = self.x[i + 1] - self.x[i];
        let t = (x - self.x[i]) / h;
        let secant = (self.y[i + 1] - self.y[i]) / h;
        let (d0, d1) = (self.d[i], self.d[i + 1]);
        // Newton form around the left node: y = y0 + h t (d0 + t (c + t b)).
        let c = 3.0 * secant - 2.0 * d0 - d1;
        let b = d0 + d1 - 2.0 * secant;
        let value = self.y[i] + h * t * (d0 + t * (c + t * b));
        (value, d0 + t * (2.0 * c + 3.0 * t * b))
    }

    fn contains(&self, x: f64) -> bool {
        self.period.map_or(x >= self.x[0] && x <= self.x[self.x.len() - 1], |_| x.is_finite())
    }
}

/// Monotone piecewise cubic: no overshoot, continuous first derivative (`fritsch1980`; derivatives at the nodes by the weighted harmonic mean).
///
/// Between two nodes the interpolant never leaves the range of their values. Second order at extrema of the data, third to fourth
/// order elsewhere. Outside the table the end value is held, with derivative 0; see [`Pchip::contains`]. A NaN
/// argument gives NaN.
#[derive(Debug, Clone, PartialEq)]
pub struct Pchip(Hermite);

impl Pchip {
    /// Interpolant of `(x, y)`, `x` strictly increasing, at least two rows.
    ///
    /// # Errors
    /// [`TableError`].
    pub fn new(x: Vec<f64>, y: Vec<f64>) -> Result<Self, TableError> {
        check(&x, &y, 2, None)?;
        let n = x.len();
        let h = |i: usize| x[i + 1] - x[i];
        let s = |i: usize| (y[i + 1] - y[i]) / h(i);
        let mut d = vec![0.0; n];
        if n == 2 {
            d.fill(s(0));
        } else {
            for (i, d) in d.iter_mut().enumerate().take(n - 1).skip(1) {
                *d = harmonic(h(i - 1), h(i), s(i - 1), s(i));
            }
            d[0] = one_sided(h(0), h(1), s(0), s(1));
            d[n - 1] = one_sided(h(n - 2), h(n - 3), s(n - 2), s(n - 3));
        }
        Ok(Self(Hermite::new(x, y, d, None)))
    }

    /// Interpolant that repeats with `period`; the rows cover one period without its end.
    ///
    /// # Errors
    /// [`TableError`].
    pub fn periodic(mut x: Vec<f64>, mut y: Vec<f64>, period: f64) -> Result<Self, TableError> {
        check(&x, &y, 2, Some(period))?;
        let n = x.len();
        x.push(x[0] + period);
        y.push(y[0]);
        let h = |i: usize| x[i + 1] - x[i];
        let s = |i: usize| (y[i + 1] - y[i]) / h(i);
        let mut d: Vec<f64> = (0..n)
            .map(|i| {
                let before = (i + n - 1) % n;
                harmonic(h(before), h(i), s(before), s(i))
            })
            .collect();
        d.push(d[0]);
        Ok(Self(Hermite::new(x, y, d, Some(period))))
    }

    /// Value at `x`.
    #[must_use]
    pub fn value(&self, x: f64) -> f64 {
        self.eval(x).0
    }

    /// Value and derivative at `x`.
    #[must_use]
    pub fn eval(&self, x: f64) -> (f64, f64) {
        self.0.eval(x, &mut 0)
    }

    /// [`Pchip::eval`] that remembers the interval: constant time when successive arguments are near each other.
    #[must_use]
    pub fn eval_near(&self, x: f64, hint: &mut usize) -> (f64, f64) {
        self.0.eval(x, hint)
    }

    /// Whether `x` lies inside the table (always, when it is periodic).
    #[must_use]
    pub fn contains(&self, x: f64) -> bool {
        self.0.contains(x)
    }
}

/// Derivative at an inner node: zero at an extremum, else the harmonic mean of the secants, weighted for unequal intervals.
fn harmonic(h0: f64, h1: f64, s0: f64, s1: f64) -> f64 {
    if s0 * s1 <= 0.0 {
        return 0.0;
    }
    let (w0, w1) = (2.0 * h1 + h0, h1 + 2.0 * h0);
    (w0 + w1) / (w0 / s0 + w1 / s1)
}

/// Derivative at an end: the three-point formula, limited so that the first interval stays monotone.
fn one_sided(h0: f64, h1: f64, s0: f64, s1: f64) -> f64 {
    let d = ((2.0 * h0 + h1) * s0 - h0 * s1) / (h0 + h1);
    if d * s0 <= 0.0 {
        0.0
    } else if s0 * s1 <= 0.0 && d.abs() > 3.0 * s0.abs() {
        3.0 * s0
    } else {
        d
    }
}

/// Periodic cubic spline: continuous second derivative, fourth order for smooth data; may overshoot at jumps (use [`Pchip`]).
#[derive(Debug, Clone, PartialEq)]
pub struct PeriodicCubic(Hermite);

impl PeriodicCubic {
    /// Spline through `(x, y)` that repeats with `period`; the rows cover one period without its end, at least two of them.
    ///
    /// # Errors
    /// [`TableError`].
    pub fn new(mut x: Vec<f64>, mut y: Vec<f64>, period: f64) -> Result<Self, TableError> {
        check(&x, &y, 2, Some(period))?;
        let n = x.len();
        x.push(x[0] + period);
        y.push(y[0]);
        // Continuity of the second derivative at node i, h = interval lengths, s = secants:
        // d_{i-1}/h_{i-1} + 2 (1/h_{i-1} + 1/h_i) d_i + d_{i+1}/h_i = 3 (s_{i-1}/h_{i-1} + s_i/h_i), cyclic.
        let inv = |i: usize| 1.0 / (x[i + 1] - x[i]);
        let s = |i: usize| (y[i + 1] - y[i]) * inv(i);
        let before = |i: usize| (i + n - 1) % n;
        let lower: Vec<f64> = (0..n).map(|i| inv(before(i))).collect();
        let upper: Vec<f64> = (0..n).map(inv).collect();
        let mut diagonal: Vec<f64> = (0..n).map(|i| 2.0 * (lower[i] + upper[i])).collect();
        let mut d: Vec<f64> = (0..n).map(|i| 3.0 * (s(before(i)) * lower[i] + s(i) * upper[i])).collect();
        if n == 2 {
            // Both neighbours of a node are the other one.
            let c = lower[0] + upper[0];
            let det = diagonal[0] * diagonal[1] - c * c;
            d = vec![(diagonal[1] * d[0] - c * d[1]) / det, (diagonal[0] * d[1] - c * d[0]) / det];
        } else {
            // Sherman & Morrison: the corners as a rank-one change of a tridiagonal matrix that stays diagonally dominant.
            let gamma = -diagonal[0];
            let (top, bottom) = (lower[0], upper[n - 1]);
            diagonal[0] -= gamma;
            diagonal[n - 1] -= top * bottom / gamma;
            let mut z = vec![0.0; n];
            z[0] = gamma;
            z[n - 1] = bottom;
            let mut work = vec![0.0; n];
            let solved = crate::linalg::solve_tridiagonal(&lower, &diagonal, &upper, &mut d, &mut work)
                .and_then(|()| {
                    crate::linalg::solve_tridiagonal(&lower, &diagonal, &upper, &mut z, &mut work)
                });
            let f = (d[0] + top * d[n - 1] / gamma) / (1.0 + z[0] + top * z[n - 1] / gamma);
            for (d, z) in d.iter_mut().zip(&z) {
                *d -= f * z;
            }
            // Only overflow of 1/h or of the secants can spoil a diagonally dominant system.
            if solved.is_err() || !d.iter().all(|v| v.is_finite()) {
                let row = d.iter().position(|v| !v.is_finite()).unwrap_or(0) + 1;
                return Err(TableError::NotFinite { row });
            }
        }
        d.push(d[0]);
        Ok(Self(Hermite::new(x, y, d, Some(period))))
    }

    /// Value at `x`.
    #[must_use]
    pub fn value(&self, x: f64) -> f64 {
        self.eval(x).0
    }

    /// Value and derivative at `x`.
    #[must_use]
    pub fn eval(&self, x: f64) -> (f64, f64) {
        self.0.eval(x, &mut 0)
    }

    /// [`PeriodicCubic::eval`] that remembers the interval.
    #[must_use]
    pub fn eval_near(&self, x: f64, hint: &mut usize) -> (f64, f64) {
        self.0.eval(x, hint)
    }
}
