//! The orifice law made ready for a gas: flow through a sharp opening.

use crate::directed::{directed, directed_partials};
use crate::flow_function::{FlowFunction, MIN_DROP};
use crate::passage_law::{FlowPartials, GasState};
use gudgeon_core::elementary;

/// Pressure ratio below which [`OrificeFormula::IsentropicTruncated`](crate::OrificeFormula::IsentropicTruncated) is choked, as printed.
pub const TRUNCATED_RATIO: f64 = 0.53;
/// Its choking factor, as printed.
const TRUNCATED_FACTOR: f64 = 0.259;

/// An orifice law made ready for a gas, see [`Orifice::build`](crate::Orifice::build).
///
/// ```text
/// ṁ = C_d A p_u / sqrt(R T_u) ψ_ε(p_d / p_u)        C_d = C_d(0) (1 - κ (p_d/p_u)²)
/// ```
///
/// `u` is the side of the higher pressure, `d` the other one. The flow from `a` to `b` is positive for `p_a > p_b`, changes its
/// sign when pressures and temperatures are exchanged, and is continuous through `p_a = p_b`.
///
/// An orifice alone:
///
/// ```
/// use gudgeon_gas::{GasState, Orifice};
///
/// # fn main() -> Result<(), gudgeon_core::BuildError> {
/// let gas_constant = 287.0; // J/(kg K)
/// let law = Orifice::default().build(1.4, gas_constant)?;
/// let state = |bar: f64, kelvin: f64| GasState::new(bar * 1e5, gas_constant * kelvin);
///
/// // The end gap of a ring, 0.1 mm², from 20 bar at 500 K to 1 bar: choked.
/// let flow = law.flow(1e-7, &state(20.0, 500.0), &state(1.0, 450.0)); // kg/s
/// let choked = 0.86 * 1e-7 * 20e5 / (gas_constant * 500.0f64).sqrt() * 0.68473;
/// assert!((flow / choked - 1.0).abs() < 1e-3); // the laminar branch takes off ε/2
///
/// // Choked flow does not depend on the pressure downstream.
/// let partials = law.flow_partials(1e-7, &state(20.0, 500.0), &state(1.0, 450.0));
/// assert!(partials.by_a > 0.0 && partials.by_b.abs() < 1e-3 * partials.by_a);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct OrificeLaw {
    flow_function: FlowFunction,
    /// `C_d` into a vacuum.
    discharge: f64,
    /// `κ`: the share of it that is lost at equal pressures.
    fall: f64,
    /// `ε` of the laminar branch.
    laminar: f64,
    /// Whether the truncated form stands in for the isentropic one.
    truncated: bool,
}

impl OrificeLaw {
    /// The discharge coefficient at the pressure ratio `r` is `discharge (1 - fall r²)`; `laminar` is `ε`.
    pub(crate) const fn new(
        flow_function: FlowFunction,
        discharge: f64,
        fall: f64,
        laminar: f64,
        truncated: bool,
    ) -> Self {
        Self { flow_function, discharge, fall, laminar, truncated }
    }

    /// The same, with a parabola in place of the root below the relative pressure drop `least`, [`MIN_DROP`] or more: some ten times what an integration cannot tell from nothing.
    #[must_use]
    pub const fn with_least_drop(mut self, least: f64) -> Self {
        self.flow_function = self.flow_function.with_least_drop(least);
        self
    }

    /// Flow \[kg/s\] from `a` to `b` through the geometric area \[m²\]. Pressures must not be negative.
    #[inline]
    #[must_use]
    pub fn flow(&self, area: f64, a: &GasState, b: &GasState) -> f64 {
        self.directed(area, a, b, |law, u| law.psi_laminar(u, self.laminar))
    }

    /// The same without the laminar branch: what an opening in series with a laminar resistance needs.
    #[inline]
    #[must_use]
    pub fn flow_bare(&self, area: f64, a: &GasState, b: &GasState) -> f64 {
        self.directed(area, a, b, FlowFunction::psi)
    }

    /// The same as [`flow`](Self::flow), by logarithms and exponentials.
    #[must_use]
    pub fn flow_exact(&self, area: f64, a: &GasState, b: &GasState) -> f64 {
        self.directed(area, a, b, |law, u| law.psi_exact(u) * law.branch(u, self.laminar))
    }

    /// [`flow`](Self::flow) with its partial derivatives by both pressures, one-sided where the law has a kink (at equal pressures
    /// between sides of different temperature).
    ///
    /// Without a laminar branch the truncated form has an infinite derivative at equal pressures: that at `u` = [`MIN_DROP`] stands for it.
    #[inline]
    #[must_use]
    pub fn flow_partials(&self, area: f64, a: &GasState, b: &GasState) -> FlowPartials {
        self.directed_partials(area, a, b, |law, u| law.psi_laminar_derivative(u, self.laminar))
    }

    /// [`flow_bare`](Self::flow_bare) with its partial derivatives, as [`flow_partials`](Self::flow_partials).
    #[inline]
    #[must_use]
    pub fn flow_bare_partials(&self, area: f64, a: &GasState, b: &GasState) -> FlowPartials {
        self.directed_partials(area, a, b, FlowFunction::psi_derivative)
    }

    /// `C_d(0) p / sqrt(R T)`: what stands before `ψ`, per area, for gas of this state upstream \[kg/(s m²)\].
    #[inline]
    pub(crate) fn strength(&self, up: &GasState) -> f64 {
        self.discharge * up.pressure() * up.inv_sqrt_rt()
    }

    /// `ψ_ε C_d/C_d(0)` of the isentropic form at relative pressure drops of either sign, for several openings at once.
    #[inline]
    pub(crate) fn psi_lanes<const N: usize>(&self, u: [f64; N]) -> [f64; N] {
        u.map(|u| self.flow_function.psi_laminar(u.abs(), self.laminar) * self.share(u.abs()))
    }

    /// `ψ_ε C_d/C_d(0)` of the isentropic form at the relative pressure drop `u`, and the derivatives of `p_u` times that by the pressures upstream
    /// and downstream.
    #[inline]
    pub(crate) fn psi_partials(&self, u: f64) -> (f64, f64, f64) {
        let (psi, derivative) =
            self.with_share(u, self.flow_function.psi_laminar_derivative(u, self.laminar));
        (psi, psi + (1.0 - u) * derivative, -derivative)
    }

    /// Whether the truncated form stands in for the isentropic one.
    pub(crate) const fn is_truncated(&self) -> bool {
        self.truncated
    }

    #[inline]
    fn directed(
        &self,
        area: f64,
        a: &GasState,
        b: &GasState,
        psi: impl Fn(&FlowFunction, f64) -> f64,
    ) -> f64 {
        directed(self.discharge * area, a, b, |u, r| {
            let psi = if self.truncated { self.truncated(r) } else { psi(&self.flow_function, u) };
            psi * self.share(u)
        })
    }

    #[inline]
    fn directed_partials(
        &self,
        area: f64,
        a: &GasState,
        b: &GasState,
        psi: impl Fn(&FlowFunction, f64) -> (f64, f64),
    ) -> FlowPartials {
        directed_partials(self.discharge * area, a, b, |u, r| {
            let psi = if self.truncated { self.truncated_derivative(r) } else { psi(&self.flow_function, u) };
            self.with_share(u, psi)
        })
    }

    /// What is left of the discharge coefficient into a vacuum: `C_d(r)/C_d(0) = 1 - κ r²`, `r = 1 - u`.
    #[inline]
    fn share(&self, u: f64) -> f64 {
        let r = 1.0 - u;
        1.0 - self.fall * r * r
    }

    /// The flow function with that share, and its derivative by `u`.
    #[inline]
    fn with_share(&self, u: f64, (psi, derivative): (f64, f64)) -> (f64, f64) {
        let share = self.share(u);
        (psi * share, derivative * share + psi * (2.0 * self.fall * (1.0 - u)))
    }

    /// `ψ` of the printed form, `sqrt(2) sqrt(γ/(γ-1) [r^(2/γ) - r^((γ+1)/γ)])`, choked `0.259` in place of the root of the bracket.
    fn truncated(&self, r: f64) -> f64 {
        let g = self.gamma();
        let root = if r >= TRUNCATED_RATIO {
            // Rounding can make the bracket negative at r = 1.
            (elementary::powf(r, 2.0 / g) - elementary::powf(r, (g + 1.0) / g)).max(0.0).sqrt()
        } else {
            TRUNCATED_FACTOR
        };
        (2.0 * g / (g - 1.0)).sqrt() * root
    }

    /// The same and its derivative by `u = 1 - r`, limited to that at `u` = [`MIN_DROP`].
    fn truncated_derivative(&self, r: f64) -> (f64, f64) {
        let g = self.gamma();
        let psi = self.truncated(r);
        if r < TRUNCATED_RATIO {
            return (psi, 0.0);
        }
        // ψ² = k [r^a - r^b], and k (b - a) u near r = 1.
        let (a, b, k) = (2.0 / g, (g + 1.0) / g, 2.0 * g / (g - 1.0));
        let rise = k * (b * elementary::powf(r, b - 1.0) - a * elementary::powf(r, a - 1.0));
        (psi, 0.5 * rise / psi.max((k * (b - a) * MIN_DROP).sqrt()))
    }

    /// `C_d` into a vacuum.
    pub(crate) const fn discharge_coefficient(&self) -> f64 {
        self.discharge
    }

    /// Ratio of specific heats.
    #[must_use]
    pub const fn gamma(&self) -> f64 {
        self.flow_function.gamma()
    }

    /// The flow function.
    #[must_use]
    pub const fn flow_function(&self) -> &FlowFunction {
        &self.flow_function
    }
}
