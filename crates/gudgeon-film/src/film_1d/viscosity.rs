use gudgeon_core::EvalError;
use gudgeon_core::kinds::{Film1d, Film1dIn, Film1dOut};
use gudgeon_numerics::elementary;

/// Differences of earlier rounds that the acceleration uses.
const DEPTH: usize = 6;
/// Largest change of the logarithm of a viscosity in a round.
const LEAP: f64 = 1.5;

/// A film along a line whose oil thickens with pressure or thins with shear, around any model of kind `film_1d`.
///
/// Each round solves the film with a viscosity for each panel and then asks the law for the viscosity that belongs to what was
/// found: the one with which the panel has the right resistance,
///
/// `1/μ_i = 1/(p_b - p_a) ∫_{p_a}^{p_b} dp/μ(p, γ̇_i)`,  `γ̇_i = |u| (ln h_b - ln h_a)/(h_b - h_a)`,
///
/// by Gauss's rule of three points. For a viscosity that depends on pressure alone the nodal pressures are then those of the
/// Reynolds equation with viscosity varying along the film, whatever the number of panels. The rounds are accelerated
/// (Anderson) in `ln μ` and end when no viscosity changes by more than the tolerance.
#[derive(Debug, Clone)]
pub struct ViscosityLoop {
    /// Largest relative change of any viscosity in the last round.
    pub tolerance: f64,
    /// Maximum number of rounds.
    pub rounds: usize,
    mu: Vec<f64>,
    y: Vec<f64>,
    f: Vec<f64>,
    y_last: Vec<f64>,
    f_last: Vec<f64>,
    /// Differences of residuals, made orthogonal, and what `y` changed by with each.
    df: Vec<Vec<f64>>,
    dy: Vec<Vec<f64>>,
    used: usize,
    ready: bool,
}

impl ViscosityLoop {
    /// For lines of `panels` panels; a tolerance of 1e-10 and 100 rounds.
    #[must_use]
    pub fn new(panels: usize) -> Self {
        let v = || vec![0.0; panels];
        Self {
            tolerance: 1e-10,
            rounds: 100,
            mu: v(),
            y: v(),
            f: v(),
            y_last: v(),
            f_last: v(),
            df: vec![v(); DEPTH],
            dy: vec![v(); DEPTH],
            used: 0,
            ready: false,
        }
    }

    /// Viscosity \[Pa s\] in each panel of the film that was found last.
    #[must_use]
    pub fn viscosity(&self) -> &[f64] {
        &self.mu
    }

    /// Solves for the film in which `law(p, γ̇)` \[Pa s\] holds in every panel, `p` the absolute pressure \[Pa\] and `γ̇` the shear
    /// rate of sliding \[1/s\]. The viscosities of `inp` are the start of the first solution and of the next one that follows a
    /// failure; else the last film is. Returns the film and the rounds.
    ///
    /// # Errors
    /// Those of the model; viscosities that are not positive numbers, and no convergence (Recoverable). Oil that thickens
    /// exponentially carries no more than some pressure of the film without thickening, beyond which there is no solution.
    pub fn solve(
        &mut self,
        film: &mut dyn Film1d,
        inp: &Film1dIn<'_>,
        mut law: impl FnMut(f64, f64) -> f64,
    ) -> Result<(Film1dOut, usize), EvalError> {
        const MODEL: &str = "viscosity of a film";
        let n = self.mu.len();
        if inp.mu.len() != n || inp.h_a.len() != n || inp.h_b.len() != n {
            return Err(EvalError::fatal(MODEL, format!("the line must have {n} panels")));
        }
        if !std::mem::take(&mut self.ready) {
            self.mu.copy_from_slice(inp.mu);
        }
        self.used = 0;
        for (y, mu) in self.y.iter_mut().zip(&self.mu) {
            *y = elementary::ln(*mu);
        }
        let mut smallest = f64::INFINITY;
        for round in 1..=self.rounds {
            for (mu, y) in self.mu.iter_mut().zip(&self.y) {
                *mu = elementary::exp(*y);
            }
            let out = film.solve(&Film1dIn { mu: &self.mu, ..*inp })?;
            let p = film.field().p;
            let mut largest: f64 = 0.0;
            for i in 0..n {
                let rate = inp.u.abs() / log_mean(inp.h_a[i], inp.h_b[i]);
                let mut fluidity = 0.0;
                for (at, weight) in GAUSS {
                    fluidity += weight / law(p[i] + at * (p[i + 1] - p[i]), rate);
                }
                let f = -elementary::ln(fluidity) - self.y[i];
                if !f.is_finite() {
                    return Err(EvalError::recoverable(
                        MODEL,
                        format!("no viscosity at {:e} Pa and {rate:e} 1/s", p[i].max(p[i + 1])),
                    ));
                }
                largest = largest.max(f.abs());
                self.f[i] = f;
            }
            if largest <= self.tolerance {
                self.ready = true;
                return Ok((out, round));
            }
            // Far worse than before: what was learned elsewhere misleads.
            if largest > 10.0 * smallest {
                self.used = 0;
            } else if round > 1 {
                self.learn();
            }
            smallest = smallest.min(largest);
            self.advance();
        }
        Err(EvalError::recoverable(MODEL, format!("no convergence in {} rounds", self.rounds)))
    }

    /// Keeps what the last step changed, orthogonal to what is kept already.
    fn learn(&mut self) {
        if self.used == DEPTH {
            self.used = 0;
        }
        let k = self.used;
        let (before, now) = self.df.split_at_mut(k);
        let (dy_before, dy_now) = self.dy.split_at_mut(k);
        let (df, dy) = (&mut now[0], &mut dy_now[0]);
        for i in 0..df.len() {
            df[i] = self.f[i] - self.f_last[i];
            dy[i] = self.y[i] - self.y_last[i];
        }
        let whole = dot(df, df);
        for (a, b) in before.iter().zip(dy_before.iter()) {
            let c = dot(a, df);
            for i in 0..df.len() {
                df[i] -= c * a[i];
                dy[i] -= c * b[i];
            }
        }
        let size = dot(df, df);
        // A direction that is all rounding adds nothing.
        if size > 1e-16 * whole {
            let scale = 1.0 / size.sqrt();
            df.iter_mut().chain(dy.iter_mut()).for_each(|x| *x *= scale);
            self.used += 1;
        }
    }

    /// The next viscosities: without the part of the residual that is known to vanish, then by what is left of it.
    fn advance(&mut self) {
        self.y_last.copy_from_slice(&self.y);
        self.f_last.copy_from_slice(&self.f);
        for k in 0..self.used {
            let c = dot(&self.df[k], &self.f);
            for i in 0..self.f.len() {
                self.y[i] -= c * self.dy[k][i];
                self.f[i] -= c * self.df[k][i];
            }
        }
        for i in 0..self.f.len() {
            let step = (self.y[i] + self.f[i] - self.y_last[i]).clamp(-LEAP, LEAP);
            self.y[i] = self.y_last[i] + step;
        }
    }
}

/// Places and weights of Gauss's rule of three points between 0 and 1.
const GAUSS: [(f64, f64); 3] =
    [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 4.0 / 9.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// `(b - a)/ln(b/a)`
fn log_mean(a: f64, b: f64) -> f64 {
    let x = (b - a) / (b + a);
    // x/artanh x is 1 to the last digit.
    if x.abs() < 1e-8 { 0.5 * (a + b) } else { 0.5 * (a + b) * (x / elementary::atanh(x)) }
}
