//! The flow function of the isentropic nozzle in a fast form.

use gudgeon_core::BuildError;
use gudgeon_core::elementary;

/// Relative pressure drop below which a root of it is none any more, where nothing else is said ([`FlowFunction::with_least_drop`]).
pub const MIN_DROP: f64 = 1e-8;

/// The relative pressure drop `δ` below which a law that goes with the root of the drop goes over to a parabola.
///
/// ```text
/// u / sqrt(w)  ->  u / sqrt(δ) (3 - w/δ) / 2        w = u + ε < δ
/// ```
///
/// Value and derivative meet at `w = δ`. A root has an infinite derivative at equal pressures: beside these there are states where an implicit step ends where it began, the other flank of
/// the root included, and steps as short as the first of them go on for ever.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LeastDrop {
    least: f64,
    /// `1/(2 δ)`.
    half: f64,
}

impl LeastDrop {
    /// For the drop `δ`, not below [`MIN_DROP`].
    pub const fn new(least: f64) -> Self {
        let least = least.max(MIN_DROP);
        Self { least, half: 0.5 / least }
    }

    /// What stands for `w` under the root, and the factor that makes it the parabola; 1 above `δ`.
    #[inline]
    pub fn root(self, w: f64) -> (f64, f64) {
        (w.max(self.least), (1.5 - self.half * w).max(1.0))
    }
}

/// Number of coefficients of the polynomial in [`FlowFunction`].
const COEFFICIENTS: usize = 10;

/// The flow function `ψ` of the isentropic nozzle and its fast form.
///
/// ```text
/// ψ(r) = sqrt( 2γ/(γ-1) [ r^(2/γ) - r^((γ+1)/γ) ] )   r > r_c,     ψ(r) = ψ(r_c)   r <= r_c
/// r_c  = (2/(γ+1))^(γ/(γ-1))
/// ```
///
/// With `u = min(1 - r, 1 - r_c)` the fast form is `ψ = sqrt(u) Q(u)`: the root carries the infinite slope at `r = 1` and `Q` is
/// an analytic function, here a polynomial of degree 9 that interpolates it in Chebyshev nodes when the law is built. The
/// relative error is below 2e-9 for every `γ` from 1.01 to 5/3.
#[derive(Debug, Clone, PartialEq)]
pub struct FlowFunction {
    gamma: f64,
    u_crit: f64,
    /// `2 / u_crit`, which maps `u` to the interval -1 to 1 of the polynomial.
    scale: f64,
    q: [f64; COEFFICIENTS],
    /// Coefficients of `dQ/du`.
    dq: [f64; COEFFICIENTS],
    near: LeastDrop,
}

impl FlowFunction {
    /// Prepares the polynomial for one ratio of specific heats.
    ///
    /// # Errors
    /// `gamma` not between 1 (excluded) and 2.
    pub fn new(gamma: f64) -> Result<Self, BuildError> {
        if !(gamma > 1.0 && gamma <= 2.0) {
            return Err(BuildError::new(format!(
                "the ratio of specific heats {gamma} is not between 1 (excluded) and 2"
            ))
            .help("1.4 for air, 1.25 to 1.35 for burnt gas"));
        }
        let u_crit = 1.0 - critical_ratio(gamma);
        let nodes: [f64; COEFFICIENTS] = std::array::from_fn(|j| {
            elementary::cos(std::f64::consts::PI * (j as f64 + 0.5) / COEFFICIENTS as f64)
        });
        let values = nodes.map(|x| {
            let u = 0.5 * u_crit * (x + 1.0);
            nozzle(gamma, u) / u.sqrt()
        });
        let scale = 2.0 / u_crit;
        let q = chebyshev_to_powers(&nodes, &values);
        let dq = std::array::from_fn(|i| q.get(i + 1).map_or(0.0, |c| (i + 1) as f64 * c * scale));
        Ok(Self { gamma, u_crit, scale, q, dq, near: LeastDrop::new(MIN_DROP) })
    }

    /// The same, with the laminar branch a parabola below the relative pressure drop `least`, [`MIN_DROP`] or more.
    #[must_use]
    pub const fn with_least_drop(mut self, least: f64) -> Self {
        self.near = LeastDrop::new(least);
        self
    }

    /// Ratio of specific heats `γ`.
    #[must_use]
    pub const fn gamma(&self) -> f64 {
        self.gamma
    }

    /// `1 - r_c`: the relative pressure drop from which on the flow is choked.
    #[must_use]
    pub const fn choking_drop(&self) -> f64 {
        self.u_crit
    }

    /// `Q(u)` for `u` already limited to the choking drop.
    #[inline]
    fn q(&self, u: f64) -> f64 {
        estrin(&self.q, self.scale * u - 1.0)
    }

    /// `dQ/du`.
    #[inline]
    fn dq(&self, u: f64) -> f64 {
        estrin(&self.dq, self.scale * u - 1.0)
    }

    /// `ψ` at the relative pressure drop `u = 1 - r`, `0 <= u <= 1`, by the fast form.
    #[inline]
    #[must_use]
    pub fn psi(&self, u: f64) -> f64 {
        let uc = u.min(self.u_crit);
        uc.sqrt() * self.q(uc)
    }

    /// `ψ` and `dψ/du`; the derivative of the root is limited to that at `u` = [`MIN_DROP`].
    #[inline]
    #[must_use]
    pub fn psi_derivative(&self, u: f64) -> (f64, f64) {
        let uc = u.min(self.u_crit);
        let (root, q) = (uc.sqrt(), self.q(uc));
        let slope =
            if u < self.u_crit { 0.5 * q / root.max(MIN_DROP.sqrt()) + root * self.dq(u) } else { 0.0 };
        (root * q, slope)
    }

    /// `ψ_ε = ψ sqrt(u / (u + ε))`: proportional to `u` where `u << ε`, and a parabola where `u + ε` is below [`MIN_DROP`] or what
    /// [`with_least_drop`](Self::with_least_drop) says. `ε >= 0`.
    #[inline]
    #[must_use]
    pub fn psi_laminar(&self, u: f64, eps: f64) -> f64 {
        let uc = u.min(self.u_crit);
        let (w, parabola) = self.near.root(u + eps);
        (uc * (u / w)).sqrt() * self.q(uc) * parabola
    }

    /// `ψ_ε` and `dψ_ε/du`.
    ///
    /// ```text
    /// ψ_ε = u Q / sqrt(u + ε)            dψ_ε/du = [ Q + u Q' - u Q / (2 (u + ε)) ] / sqrt(u + ε)       subsonic
    /// ψ_ε = ψ_c sqrt(u / (u + ε))        dψ_ε/du = ψ_ε ε / (2 u (u + ε))                                choked
    /// ```
    #[inline]
    #[must_use]
    pub fn psi_laminar_derivative(&self, u: f64, eps: f64) -> (f64, f64) {
        let uc = u.min(self.u_crit);
        let q = self.q(uc);
        let (w, parabola) = self.near.root(u + eps);
        let psi = (uc * (u / w)).sqrt() * q * parabola;
        let slope = if u < self.u_crit {
            let (dq, inverse) = (self.dq(u), 1.0 / w);
            inverse.sqrt() * (q + u * (dq - 0.5 * q * inverse) + (parabola - 1.0) * (q + u * dq))
        } else {
            0.5 * psi * eps / (u * w)
        };
        (psi, slope)
    }

    /// What the laminar branch makes of `ψ`, as a factor: `sqrt(u / (u + ε))`.
    pub(crate) fn branch(&self, u: f64, eps: f64) -> f64 {
        let (w, parabola) = self.near.root(u + eps);
        (u / w).sqrt() * parabola
    }

    /// `ψ` by logarithms and exponentials: slow, exact to a few units in the last place.
    #[must_use]
    pub fn psi_exact(&self, u: f64) -> f64 {
        nozzle(self.gamma, u.min(self.u_crit))
    }
}

/// Polynomial by Estrin's scheme: four independent products instead of a chain of nine.
#[inline]
fn estrin(c: &[f64; COEFFICIENTS], x: f64) -> f64 {
    let x2 = x * x;
    let x4 = x2 * x2;
    let lo = (c[0] + c[1] * x) + (c[2] + c[3] * x) * x2;
    let mid = (c[4] + c[5] * x) + (c[6] + c[7] * x) * x2;
    let hi = c[8] + c[9] * x;
    lo + mid * x4 + hi * (x4 * x4)
}

/// Critical pressure ratio `(2/(γ+1))^(γ/(γ-1))`.
#[must_use]
pub fn critical_ratio(gamma: f64) -> f64 {
    elementary::exp(-gamma / (gamma - 1.0) * elementary::ln_1p(0.5 * (gamma - 1.0)))
}

/// `ψ` of the subsonic branch at `r = 1 - u`, written so that nothing cancels for `u -> 0` or `γ -> 1`.
fn nozzle(gamma: f64, u: f64) -> f64 {
    let ln_r = elementary::ln_1p(-u);
    let k = (gamma - 1.0) / gamma;
    (2.0 / k * elementary::exp(2.0 / gamma * ln_r) * -elementary::exp_m1(k * ln_r)).sqrt()
}

/// Power coefficients of the polynomial through `values` in the Chebyshev nodes of the first kind.
fn chebyshev_to_powers(nodes: &[f64; COEFFICIENTS], values: &[f64; COEFFICIENTS]) -> [f64; COEFFICIENTS] {
    const N: usize = COEFFICIENTS;
    let t = |k: usize, x: f64| elementary::cos(k as f64 * elementary::acos(x));
    let mut powers = [0.0; N];
    // T_{k-1} and T_k in powers of x.
    let (mut previous, mut current) = ([0.0; N], [0.0; N]);
    current[0] = 1.0;
    for k in 0..N {
        let sum: f64 = nodes.iter().zip(values).map(|(&x, &v)| v * t(k, x)).sum();
        let c = sum * if k == 0 { 1.0 } else { 2.0 } / N as f64;
        for (p, t) in powers.iter_mut().zip(&current) {
            *p += c * t;
        }
        let factor = if k == 0 { 1.0 } else { 2.0 };
        let mut next = [0.0; N];
        for i in 0..N {
            next[i] = if i > 0 { factor * current[i - 1] } else { 0.0 } - previous[i];
        }
        previous = current;
        current = next;
    }
    powers
}
