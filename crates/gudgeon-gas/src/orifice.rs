//! Flow of a gas through a sharp opening: the one orifice law that every model of this crate uses.

use crate::heat_capacity::Gamma;
use gudgeon_core::BuildError;
use gudgeon_core::quantity::{Bound as _, Fraction, NonNegative, PosRatio, Ratio, quantity};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which formula gives the flow through an opening.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum OrificeFormula {
    /// Isentropic flow of a perfect gas, choked below the critical pressure ratio of its `gamma`, with a laminar branch
    /// near zero pressure difference.
    #[default]
    Isentropic,
    /// The same formula as printed by Zottin (1992): choking at the pressure ratio 0.53 whatever `gamma`, with the rounded
    /// factor 0.259, and no laminar branch. The two pieces do not quite meet (a jump of 0.08 % for `gamma` = 1.4).
    IsentropicTruncated,
}

/// The orifice law.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Orifice {
    /// Discharge coefficient `C_d`: effective over geometric area. 0.86 was measured for piston-ring gaps (0.8 to 0.9).
    #[serde(default = "default_discharge")]
    pub discharge: PosRatio,
    /// Formula.
    #[serde(default)]
    pub law: OrificeFormula,
    /// `ε` of the laminar branch: below a relative pressure difference of about `ε` the flow is proportional to the pressure
    /// difference instead of its square root. 0 gives the bare law, whose slope is infinite at zero pressure difference and
    /// which suits only explicit schemes with fixed steps. Not used by `isentropic_truncated`.
    #[serde(default = "default_laminar")]
    pub laminar: Ratio<NonNegative>,
    /// Ratio of specific heats in the law: the machine's constant one, or that of a gas at the temperature it comes with.
    #[serde(default)]
    pub gamma: Gamma,
}

fn default_discharge() -> PosRatio {
    quantity(0.86)
}
fn default_laminar() -> Ratio<NonNegative> {
    quantity(1e-3)
}

impl Default for Orifice {
    fn default() -> Self {
        Self {
            discharge: default_discharge(),
            law: OrificeFormula::default(),
            laminar: default_laminar(),
            gamma: Gamma::default(),
        }
    }
}

impl Orifice {
    /// Prepares the law for a gas.
    ///
    /// # Errors
    /// `gamma` not between 1 and 2, `gas_constant` not positive, `discharge` above 1.
    pub fn build(&self, gamma: f64, gas_constant: f64) -> Result<OrificeLaw, BuildError> {
        if !Fraction::admits(self.discharge.si()) {
            return Err(BuildError::at(
                "discharge",
                format!("the discharge coefficient {} is greater than 1", self.discharge.si()),
            )
            .help("measured values for ring gaps lie between 0.6 and 0.9"));
        }
        if !(gas_constant > 0.0 && gas_constant.is_finite()) {
            return Err(BuildError::new(format!("the gas constant {gas_constant} J/(kg K) is not positive")));
        }
        Ok(OrificeLaw {
            flow_function: FlowFunction::new(gamma)?,
            discharge: self.discharge.si(),
            // Zero over zero must not arise where the pressures are equal; beside any other pressure difference this vanishes.
            laminar: self.laminar.si().max(f64::MIN_POSITIVE),
            truncated: self.law == OrificeFormula::IsentropicTruncated,
        })
    }
}

impl Orifice {
    /// One law per temperature \[K\], for gas that comes with it; none when the ratio of specific heats is constant.
    ///
    /// # Errors
    /// As [`build`](Self::build).
    pub fn laws(
        &self,
        temperatures: &[f64],
        gamma: f64,
        gas_constant: f64,
    ) -> Result<Vec<OrificeLaw>, BuildError> {
        if self.gamma == Gamma::Constant {
            return Ok(Vec::new());
        }
        temperatures.iter().map(|&t| self.build(self.gamma.at(t, gamma), gas_constant)).collect()
    }
}

/// Relative pressure drop up to which the slope of the root follows the law: below it a Jacobian gets the slope there, 1e4,
/// for the infinite one of the bare law at equal pressures.
const STEEPEST: f64 = 1e-8;

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
        let nodes: [f64; COEFFICIENTS] =
            std::array::from_fn(|j| (std::f64::consts::PI * (j as f64 + 0.5) / COEFFICIENTS as f64).cos());
        let values = nodes.map(|x| {
            let u = 0.5 * u_crit * (x + 1.0);
            nozzle(gamma, u) / u.sqrt()
        });
        let scale = 2.0 / u_crit;
        let q = chebyshev_to_powers(&nodes, &values);
        let dq = std::array::from_fn(|i| q.get(i + 1).map_or(0.0, |c| (i + 1) as f64 * c * scale));
        Ok(Self { gamma, u_crit, scale, q, dq })
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

    /// `ψ` and `dψ/du`; the slope of the root is limited to that at `u` = 1e-8.
    #[inline]
    #[must_use]
    pub fn psi_slope(&self, u: f64) -> (f64, f64) {
        let uc = u.min(self.u_crit);
        let (root, q) = (uc.sqrt(), self.q(uc));
        let slope =
            if u < self.u_crit { 0.5 * q / root.max(STEEPEST.sqrt()) + root * self.dq(u) } else { 0.0 };
        (root * q, slope)
    }

    /// `ψ_ε = ψ sqrt(u / (u + ε))`: proportional to `u` where `u << ε`. `ε > 0`.
    #[inline]
    #[must_use]
    pub fn psi_laminar(&self, u: f64, eps: f64) -> f64 {
        let uc = u.min(self.u_crit);
        (uc * (u / (u + eps))).sqrt() * self.q(uc)
    }

    /// `ψ_ε` and `dψ_ε/du`; for an `ε` below 1e-8 the slope is limited to that at `u` = 1e-8.
    ///
    /// ```text
    /// ψ_ε = u Q / sqrt(u + ε)            dψ_ε/du = [ Q + u Q' - u Q / (2 (u + ε)) ] / sqrt(u + ε)       subsonic
    /// ψ_ε = ψ_c sqrt(u / (u + ε))        dψ_ε/du = ψ_ε ε / (2 u (u + ε))                                choked
    /// ```
    #[inline]
    #[must_use]
    pub fn psi_laminar_slope(&self, u: f64, eps: f64) -> (f64, f64) {
        let uc = u.min(self.u_crit);
        let q = self.q(uc);
        let psi = (uc * (u / (u + eps))).sqrt() * q;
        let slope = if u < self.u_crit {
            let inverse = 1.0 / (u + eps).max(STEEPEST);
            inverse.sqrt() * (q + u * (self.dq(u) - 0.5 * q * inverse))
        } else {
            0.5 * psi * eps / (u * (u + eps))
        };
        (psi, slope)
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
    (-gamma / (gamma - 1.0) * (0.5 * (gamma - 1.0)).ln_1p()).exp()
}

/// `ψ` of the subsonic branch at `r = 1 - u`, written so that nothing cancels for `u -> 0` or `γ -> 1`.
fn nozzle(gamma: f64, u: f64) -> f64 {
    let ln_r = (-u).ln_1p();
    let k = (gamma - 1.0) / gamma;
    (2.0 / k * (2.0 / gamma * ln_r).exp() * -(k * ln_r).exp_m1()).sqrt()
}

/// Power coefficients of the polynomial through `values` in the Chebyshev nodes of the first kind.
fn chebyshev_to_powers(nodes: &[f64; COEFFICIENTS], values: &[f64; COEFFICIENTS]) -> [f64; COEFFICIENTS] {
    const N: usize = COEFFICIENTS;
    let t = |k: usize, x: f64| (k as f64 * x.acos()).cos();
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

/// Pressure ratio below which [`OrificeFormula::IsentropicTruncated`] is choked, as printed.
const TRUNCATED_RATIO: f64 = 0.53;
/// Its choking factor, as printed.
const TRUNCATED_FACTOR: f64 = 0.259;

/// An orifice law made ready for a gas.
///
/// ```text
/// ṁ = C_d A p_u / sqrt(R T_u) ψ_ε(p_d / p_u)
/// ```
///
/// `u` is the side of the higher pressure, `d` the other one. The flow from `a` to `b` is positive for `p_a > p_b`, changes its
/// sign when pressures and temperatures are exchanged, and is continuous through `p_a = p_b`.
#[derive(Debug, Clone, PartialEq)]
pub struct OrificeLaw {
    flow_function: FlowFunction,
    discharge: f64,
    laminar: f64,
    truncated: bool,
}

/// Thermal state of one side of an opening.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Side {
    /// Pressure \[Pa\].
    pub p: f64,
    /// `1 / sqrt(R T)` \[s/m\].
    pub inv_sqrt_rt: f64,
}

/// A flow and its derivatives by the pressures on both sides.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FlowSlopes {
    /// Flow \[kg/s\] from `a` to `b`.
    pub flow: f64,
    /// Its derivative by the pressure of `a` \[kg/(s Pa)\].
    pub by_a: f64,
    /// Its derivative by the pressure of `b` \[kg/(s Pa)\].
    pub by_b: f64,
}

impl OrificeLaw {
    /// Flow \[kg/s\] from `a` to `b` through the geometric area \[m²\]. Pressures must not be negative.
    #[inline]
    #[must_use]
    pub fn flow(&self, area: f64, a: Side, b: Side) -> f64 {
        self.directed(area, a, b, |law, u| law.psi_laminar(u, self.laminar))
    }

    /// The same without the laminar branch: what an opening in series with a laminar resistance needs.
    #[inline]
    #[must_use]
    pub fn flow_bare(&self, area: f64, a: Side, b: Side) -> f64 {
        self.directed(area, a, b, FlowFunction::psi)
    }

    /// The same as [`flow`](Self::flow), by logarithms and exponentials.
    #[must_use]
    pub fn flow_exact(&self, area: f64, a: Side, b: Side) -> f64 {
        self.directed(area, a, b, |law, u| law.psi_exact(u) * (u / (u + self.laminar)).sqrt())
    }

    /// [`flow`](Self::flow) with its derivatives by both pressures, one-sided where the law has a kink (at equal pressures between
    /// sides of different temperature). With `C = C_d A / sqrt(R T_u)`:
    ///
    /// ```text
    /// ∂ṁ/∂p_u = C [ ψ + (1 - u) dψ/du ]        ∂ṁ/∂p_d = -C dψ/du
    /// ```
    ///
    /// Where the slope of the law is infinite, at equal pressures without a laminar branch, that at `u` = 1e-8 stands for it.
    #[inline]
    #[must_use]
    pub fn flow_slopes(&self, area: f64, a: Side, b: Side) -> FlowSlopes {
        self.directed_slopes(area, a, b, |law, u| law.psi_laminar_slope(u, self.laminar))
    }

    /// [`flow_bare`](Self::flow_bare) with its derivatives, as [`flow_slopes`](Self::flow_slopes).
    #[inline]
    #[must_use]
    pub fn flow_bare_slopes(&self, area: f64, a: Side, b: Side) -> FlowSlopes {
        self.directed_slopes(area, a, b, FlowFunction::psi_slope)
    }

    /// `ψ_ε` of the isentropic form at relative pressure drops of either sign, for several openings at once.
    #[inline]
    pub(crate) fn psi_lanes<const N: usize>(&self, u: [f64; N]) -> [f64; N] {
        std::array::from_fn(|i| self.flow_function.psi_laminar(u[i].abs(), self.laminar))
    }

    /// `ψ_ε` of the isentropic form at the relative pressure drop `u`, and the derivatives of `p_u ψ_ε` by the pressures upstream
    /// and downstream.
    #[inline]
    pub(crate) fn psi_slopes(&self, u: f64) -> (f64, f64, f64) {
        let (psi, slope) = self.flow_function.psi_laminar_slope(u, self.laminar);
        (psi, psi + (1.0 - u) * slope, -slope)
    }

    /// Discharge coefficient.
    pub(crate) const fn discharge(&self) -> f64 {
        self.discharge
    }

    /// Whether the truncated form stands in for the isentropic one.
    pub(crate) const fn is_truncated(&self) -> bool {
        self.truncated
    }

    #[inline]
    fn directed(&self, area: f64, a: Side, b: Side, psi: impl Fn(&FlowFunction, f64) -> f64) -> f64 {
        let forward = a.p >= b.p;
        let (up, down) = if forward { (a, b) } else { (b, a) };
        if up.p <= 0.0 {
            return 0.0;
        }
        let psi = if self.truncated {
            self.truncated(down.p / up.p)
        } else {
            psi(&self.flow_function, (up.p - down.p) / up.p)
        };
        let magnitude = self.discharge * area * up.p * up.inv_sqrt_rt * psi;
        if forward { magnitude } else { -magnitude }
    }

    #[inline]
    fn directed_slopes(
        &self,
        area: f64,
        a: Side,
        b: Side,
        psi: impl Fn(&FlowFunction, f64) -> (f64, f64),
    ) -> FlowSlopes {
        let forward = a.p >= b.p;
        let (up, down) = if forward { (a, b) } else { (b, a) };
        if up.p <= 0.0 {
            return FlowSlopes::default();
        }
        let u = (up.p - down.p) / up.p;
        let (psi, slope) =
            if self.truncated { self.truncated_slope(down.p / up.p) } else { psi(&self.flow_function, u) };
        let flow = self.discharge * area * up.p * up.inv_sqrt_rt * psi;
        let front = self.discharge * area * up.inv_sqrt_rt;
        let (by_up, by_down) = (front * (psi + (1.0 - u) * slope), -front * slope);
        if forward {
            FlowSlopes { flow, by_a: by_up, by_b: by_down }
        } else {
            FlowSlopes { flow: -flow, by_a: -by_down, by_b: -by_up }
        }
    }

    /// `ψ` of the printed form, `sqrt(2) sqrt(γ/(γ-1) [r^(2/γ) - r^((γ+1)/γ)])`, choked `0.259` in place of the root of the bracket.
    fn truncated(&self, r: f64) -> f64 {
        let g = self.flow_function.gamma;
        let root = if r >= TRUNCATED_RATIO {
            // Rounding can make the bracket negative at r = 1.
            (r.powf(2.0 / g) - r.powf((g + 1.0) / g)).max(0.0).sqrt()
        } else {
            TRUNCATED_FACTOR
        };
        (2.0 * g / (g - 1.0)).sqrt() * root
    }

    /// The same and its derivative by `u = 1 - r`, limited to that at `u` = 1e-8.
    fn truncated_slope(&self, r: f64) -> (f64, f64) {
        let g = self.flow_function.gamma;
        let psi = self.truncated(r);
        if r < TRUNCATED_RATIO {
            return (psi, 0.0);
        }
        // ψ² = k [r^a - r^b], and k (b - a) u near r = 1.
        let (a, b, k) = (2.0 / g, (g + 1.0) / g, 2.0 * g / (g - 1.0));
        let rise = k * (b * r.powf(b - 1.0) - a * r.powf(a - 1.0));
        (psi, 0.5 * rise / psi.max((k * (b - a) * STEEPEST).sqrt()))
    }

    /// Ratio of specific heats.
    #[must_use]
    pub const fn gamma(&self) -> f64 {
        self.flow_function.gamma
    }

    /// The flow function.
    #[must_use]
    pub const fn flow_function(&self) -> &FlowFunction {
        &self.flow_function
    }
}

#[cfg(test)]
#[allow(clippy::excessive_precision)] // Reference values stand as they were computed.
mod tests {
    use super::*;

    /// Deterministic numbers in 0…1 (Knuth's MMIX generator, upper bits).
    struct Lcg(u64);
    impl Lcg {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    fn side(p: f64, t: f64) -> Side {
        Side { p, inv_sqrt_rt: 1.0 / (287.0 * t).sqrt() }
    }

    fn law(orifice: Orifice) -> OrificeLaw {
        orifice.build(1.4, 287.0).expect("builds")
    }

    fn bare(law: OrificeFormula) -> Orifice {
        Orifice { laminar: quantity(0.0), law, ..Orifice::default() }
    }

    // Computed with 50 digits from the closed form.
    const CRITICAL: [(f64, f64, f64); 5] = [
        (1.4, 0.528281787717174106343528, 0.6847314563772703752971445),
        (1.35, 0.5368512183915568941465116, 0.6761448751411428996746332),
        (1.3, 0.545727733814064765935317, 0.6672623512408615719146144),
        (1.25, 0.5549289573066436349472472, 0.6580647917517493138173789),
        (5.0 / 3.0, 0.4871392896287467388045943, 0.7261843774138906659711123),
    ];
    const PSI: [(f64, f64, f64); 20] = [
        (1.3, 0.0, 0.6672623512408615719146144),
        (1.3, 0.3, 0.6672623512408615719146144),
        (1.3, 0.5, 0.6672623512408615719146144),
        (1.3, 0.6, 0.6627125593389742694186967),
        (1.3, 0.75, 0.5979936170815713352817154),
        (1.3, 0.9, 0.4207473268571404999237088),
        (1.3, 0.95, 0.3069910379845298634070404),
        (1.3, 0.99, 0.1406034495108536560026962),
        (1.3, 0.999, 0.04469555242273978439012564),
        (1.3, 0.9999, 0.01414131971124154406748229),
        (1.4, 0.0, 0.6847314563772703752971445),
        (1.4, 0.3, 0.6847314563772703752971445),
        (1.4, 0.5, 0.6847314563772703752971445),
        (1.4, 0.6, 0.6769152528627222433809425),
        (1.4, 0.75, 0.6051546440529365430427052),
        (1.4, 0.9, 0.4225808638186363735445288),
        (1.4, 0.95, 0.307641100392039075574277),
        (1.4, 0.99, 0.1406617026042444210249625),
        (1.4, 0.999, 0.04469739525840761879079185),
        (1.4, 0.9999, 0.01414137798902830912687109),
    ];

    #[test]
    fn high_precision_table() {
        for (gamma, r_c, psi_c) in CRITICAL {
            let f = FlowFunction::new(gamma).expect("gamma");
            assert!((critical_ratio(gamma) / r_c - 1.0).abs() < 1e-15);
            assert!((1.0 - f.choking_drop() - r_c).abs() < 2e-16);
            // A few roundings.
            assert!((f.psi_exact(1.0) / psi_c - 1.0).abs() < 1e-15);
        }
        for (gamma, r, psi) in PSI {
            let f = FlowFunction::new(gamma).expect("gamma");
            // 1 - r carries an absolute rounding of 1e-16, half of it relative in the root of u >= 1e-4.
            assert!((f.psi_exact(1.0 - r) / psi - 1.0).abs() < 1e-12, "{gamma} {r}");
            assert!((f.psi(1.0 - r) / psi - 1.0).abs() < 2e-9, "{gamma} {r}");
        }
    }

    #[test]
    fn fast_form_for_any_gamma() {
        let mut worst = 0.0f64;
        for k in 0..=66 {
            let gamma = (1.01 + 0.01 * f64::from(k)).min(5.0 / 3.0);
            let f = FlowFunction::new(gamma).expect("gamma");
            for i in 1..=2000 {
                // Denser towards zero.
                let u = (f64::from(i) / 2000.0).powi(2);
                worst = worst.max((f.psi(u) / f.psi_exact(u) - 1.0).abs());
            }
        }
        assert!(worst < 2e-9, "{worst:e}");
        for gamma in [1.0 + 1e-12, 1.0001, 2.0] {
            let f = FlowFunction::new(gamma).expect("gamma");
            for u in [1e-12, 1e-3, 0.3, 0.5, 1.0] {
                assert!((f.psi(u) / f.psi_exact(u) - 1.0).abs() < 2e-8, "{gamma} {u}");
            }
        }
        // The isothermal limit: ψ = r sqrt(-2 ln r), critical ratio 1/sqrt(e).
        let f = FlowFunction::new(1.0 + 1e-12).expect("gamma");
        assert!((f.choking_drop() - (1.0 - (-0.5f64).exp())).abs() < 1e-12);
        assert!((f.psi_exact(0.1) - 0.9 * (-2.0 * 0.9f64.ln()).sqrt()).abs() < 1e-12);
        for gamma in [1.0, 0.9, 2.5, f64::NAN, f64::INFINITY] {
            assert!(FlowFunction::new(gamma).is_err());
        }
    }

    #[test]
    fn continuous_with_zero_slope_at_choking() {
        for eps in [f64::MIN_POSITIVE, 1e-3] {
            for (gamma, ..) in CRITICAL {
                let f = FlowFunction::new(gamma).expect("gamma");
                let (uc, d) = (f.choking_drop(), 1e-6);
                let psi = |u: f64| f.psi_laminar(u, eps);
                let (below, at, above) = (psi(uc - d), psi(uc), psi(uc + d));
                // The curvature of ψ is about -3, so the parabola falls by 2e-12 over d; the laminar factor has the slope ε/2u²;
                // the interpolation error 1e-9 of ψ has a slope of at most 9² 1e-9/u_c by Markov's inequality.
                let slope = eps / (2.0 * uc * uc) + 81.0 * 1e-9 / uc * 2.0;
                assert!((at - below).abs() < 1e-11 + slope * d && (above - at).abs() < 1e-11 + slope * d);
                // One-sided derivatives agree: C1.
                let jump = ((above - at) - (at - below)).abs() / d;
                assert!(jump < 5e-6 + 81.0 * 2e-9 / uc, "{gamma} {jump:e}");
            }
        }
    }

    #[test]
    fn published_values_of_the_truncated_form() {
        let law = law(bare(OrificeFormula::IsentropicTruncated));
        let (a, b) = (500.0, 400.0);
        for (p_a, p_b, flow) in [
            (1e6, 7e5, 1.449135749e-4),
            (1e6, 5.3e5, 1.554497283e-4),
            (1e6, 1e5, 1.555683641e-4),
            (7e5, 1e6, -1.620183022e-4),
        ] {
            let f = law.flow(1e-7, side(p_a, a), side(p_b, b));
            // Ten digits are known.
            assert!((f / flow - 1.0).abs() < 5e-10, "{f:e} {flow:e}");
        }
        // The two pieces do not meet: 0.076 %.
        let jump = law.flow(1e-7, side(1e6, a), side(0.53e6 - 1.0, b))
            / law.flow(1e-7, side(1e6, a), side(0.53e6, b))
            - 1.0;
        assert!((jump - 7.6e-4).abs() < 0.1e-4, "{jump}");
        assert_eq!(law.flow(1e-7, side(1e6, a), side(1e6, b)), 0.0);
    }

    #[test]
    fn published_values_of_the_isentropic_form() {
        let law = law(bare(OrificeFormula::Isentropic));
        let t = 473.15;
        for (p, flow) in [(4e5, 1.45418e-4), (8e5, 1.19069e-4), (9.9e5, 2.98728e-5)] {
            let f = law.flow(9.1e-8, side(1e6, t), side(p, t));
            // Six digits are known.
            assert!((f / flow - 1.0).abs() < 4e-6, "{f:e}");
        }
    }

    #[test]
    fn antisymmetric_monotone_and_finite() {
        let mut rng = Lcg(1);
        for formula in [OrificeFormula::Isentropic, OrificeFormula::IsentropicTruncated] {
            for eps in [0.0, 1e-3, 0.1] {
                let law = law(Orifice { law: formula, laminar: quantity(eps), ..Orifice::default() });
                for _ in 0..2000 {
                    let p_a = 10f64.powf(2.0 + 6.0 * rng.next());
                    let p_b = p_a * 10f64.powf(-6.0 * rng.next().powi(3));
                    let (a, b) =
                        (side(p_a, 300.0 + 500.0 * rng.next()), side(p_b, 300.0 + 500.0 * rng.next()));
                    let f = law.flow(1e-7, a, b);
                    assert!(f.is_finite() && f >= 0.0);
                    assert_eq!(law.flow(1e-7, b, a), if f == 0.0 { law.flow(1e-7, b, a) } else { -f });
                    // More back pressure, not more flow. The polynomial's ripple at the flat top is 2e-9; the truncated form jumps
                    // the other way.
                    let less = law.flow(1e-7, a, Side { p: p_b + 0.01 * (p_a - p_b), ..b });
                    assert!(less <= f * (1.0 + 4e-9));
                    let exact = law.flow_exact(1e-7, a, b);
                    if formula == OrificeFormula::Isentropic {
                        assert!((f - exact).abs() <= 2e-9 * exact, "{f} {exact}");
                    } else {
                        assert_eq!(f, exact);
                    }
                }
                assert_eq!(law.flow(1e-7, side(1e5, 300.0), side(1e5, 400.0)), 0.0);
                assert_eq!(law.flow(1e-7, side(0.0, 300.0), side(0.0, 400.0)), 0.0);
                assert!(law.flow(1e-7, side(1e5, 300.0), side(0.0, 400.0)).is_finite());
                assert_eq!(law.flow(0.0, side(2e5, 300.0), side(1e5, 400.0)), 0.0);
            }
        }
    }

    /// Derivative by central differences of fourth order, and what it cannot resolve.
    fn central(f: impl Fn(f64) -> f64, x: f64, d: f64) -> (f64, f64) {
        let (near, far) = (f(x + d) - f(x - d), f(x + 2.0 * d) - f(x - 2.0 * d));
        let slope = (8.0 * near - far) / (12.0 * d);
        // Eight roundings of the values, divided by d.
        (slope, 8.0 * f64::EPSILON * f(x).abs() / d)
    }

    #[test]
    fn slopes_agree_with_differences() {
        let mut rng = Lcg(3);
        let (mut choked, mut laminar, mut reversed) = (0, 0, 0);
        for formula in [OrificeFormula::Isentropic, OrificeFormula::IsentropicTruncated] {
            for eps in [0.0, 1e-3, 0.1] {
                let law = law(Orifice { law: formula, laminar: quantity(eps), ..Orifice::default() });
                for k in 0..3000 {
                    let p = 10f64.powf(4.0 + 3.0 * rng.next());
                    // Drops from 1e-6 to nearly everything, evenly in their logarithm, in both directions.
                    let u = 10f64.powf(-6.0 * rng.next());
                    let (mut a, mut b) = (
                        side(p, 300.0 + 500.0 * rng.next()),
                        side(p * (1.0 - u), 300.0 + 500.0 * rng.next()),
                    );
                    if k % 2 == 1 {
                        (a, b) = (b, a);
                        reversed += 1;
                    }
                    let critical = match formula {
                        OrificeFormula::Isentropic => law.flow_function.u_crit,
                        OrificeFormula::IsentropicTruncated => 1.0 - TRUNCATED_RATIO,
                    };
                    choked += i32::from(u > critical);
                    laminar += i32::from(u < eps);
                    // A step of 2e-3 of the distance to the nearest singularity (equal pressures, the linear branch at ε, choking):
                    // the error of fourth order is below 4e-12 times a derivative of fifth order scaled with that distance.
                    let d = 1e-3 * p * u.min(1.0 - u).min((u - critical).abs());
                    if d < 1e-9 * p {
                        continue;
                    }
                    for bare in [false, true] {
                        let flow = |a: Side, b: Side| {
                            if bare { law.flow_bare(1e-7, a, b) } else { law.flow(1e-7, a, b) }
                        };
                        let slopes =
                            if bare { law.flow_bare_slopes(1e-7, a, b) } else { law.flow_slopes(1e-7, a, b) };
                        assert_eq!(slopes.flow, flow(a, b));
                        let (by_a, noise_a) = central(|p| flow(Side { p, ..a }, b), a.p, d);
                        let (by_b, noise_b) = central(|p| flow(a, Side { p, ..b }), b.p, d);
                        // The drop itself is rounded to 1e-16 of p: 1e-16 p ∂²ṁ/∂p² at most, which is below slope 1e-16/u,
                        // and in each difference below slope 1e-16 p / d.
                        let size = slopes.by_a.abs().max(slopes.by_b.abs());
                        let rounding = 8.0 * f64::EPSILON * p / d * size;
                        for (is, by, noise) in [(slopes.by_a, by_a, noise_a), (slopes.by_b, by_b, noise_b)] {
                            assert!(
                                (is - by).abs() <= 1e-9 * size + noise + rounding,
                                "{formula:?} {eps} {bare} u {u:e}: {is:e} {by:e}"
                            );
                        }
                        // More pressure on its own side, more flow, always.
                        assert!(slopes.by_a >= 0.0);
                    }
                }
            }
        }
        assert!(choked > 500 && laminar > 1000 && reversed > 1000, "{choked} {laminar} {reversed}");
    }

    #[test]
    fn slopes_at_equal_pressures() {
        let (p, t) = (2e5, 400.0f64);
        let c = 0.86 * 1e-7 / (287.0 * t).sqrt();
        for eps in [1e-3f64, 0.1] {
            let law = law(Orifice { laminar: quantity(eps), ..Orifice::default() });
            let s = law.flow_slopes(1e-7, side(p, t), side(p, t));
            // ψ_ε -> u sqrt(2/ε); the fast form of ψ is right within 2e-9.
            let slope = c * (2.0 / eps).sqrt();
            assert_eq!(s.flow, 0.0);
            assert!((s.by_a / slope - 1.0).abs() < 2e-9 && s.by_b == -s.by_a);
        }
        // The bare laws: infinite, given as at u = 1e-8, where ψ = sqrt(2u); the next term of ψ is of the order u.
        for law in [law(bare(OrificeFormula::Isentropic)), law(bare(OrificeFormula::IsentropicTruncated))] {
            for s in [
                law.flow_slopes(1e-7, side(p, t), side(p, t)),
                law.flow_bare_slopes(1e-7, side(p, t), side(p, t)),
            ] {
                let steepest = c * (0.5 / STEEPEST).sqrt();
                // The laminar form has no more than twice that slope at 0: it is linear below its ε.
                let ratio = s.by_a / steepest;
                assert!((0.99..2.01).contains(&ratio) && s.by_b == -s.by_a && s.flow == 0.0, "{s:?} {ratio}");
            }
        }
        let law = law(Orifice::default());
        assert_eq!(law.flow_slopes(1e-7, side(0.0, t), side(0.0, t)), FlowSlopes::default());
    }

    #[test]
    fn laminar_branch_is_linear() {
        let eps = 1e-3f64;
        let law = law(Orifice { laminar: quantity(eps), ..Orifice::default() });
        let (p, t) = (1e6, 450.0f64);
        // ψ_ε -> u sqrt(2/ε) for u << ε.
        let slope = 0.86 * 1e-7 * p / (287.0 * t).sqrt() * (2.0 / eps).sqrt();
        for u in [1e-12, 1e-9, 1e-7] {
            let f = law.flow(1e-7, side(p, t), side(p * (1.0 - u), t));
            // 1 - u is rounded to 1e-16; the next term is u/2ε.
            assert!((f / (slope * u) - 1.0).abs() < 2e-9 + 1.2e-16 / u + u / eps, "{u}");
        }
    }

    #[test]
    fn refuses_impossible_constants() {
        let o = Orifice { discharge: quantity(1.5), ..Orifice::default() };
        assert_eq!(o.build(1.4, 287.0).expect_err("above 1").field, "discharge");
        assert!(Orifice::default().build(1.4, 0.0).is_err());
    }
}
