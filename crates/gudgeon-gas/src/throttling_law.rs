//! Martin's law of one throttling of a labyrinth.

use crate::directed::{directed, directed_partials};
use crate::flow_function::{LeastDrop, MIN_DROP};
use crate::passage_law::{Area, FlowPartials, GasState, PassageLaw};
use gudgeon_core::elementary;

/// Pressure ratio at which one throttling lets through most: the root of `1 - r² = 2 r² (1 - ln r)`.
pub const THROTTLING_RATIO: f64 = 0.471_130_219_857_598_4;

/// Isothermal flow through one throttling, whose jet loses all of its velocity in the space behind it:
///
/// ```text
/// ṁ = C_d A p_u / sqrt(R T_u) φ(r)        φ = sqrt( (1 - r²) / (1 - ln r) )        r = p_d/p_u, not below r_c = 0.4711
/// ```
///
/// `n` equal throttlings in series at one temperature pass, when nothing is stored between them, what Martin's formula says of a labyrinth:
/// `r_1 r_2 … r_n = r`, and the sum of `p_k² - p_(k+1)² = (ṁ/(C_d A))² R T (1 - ln r_k)` over all is
///
/// ```text
/// ṁ = C_d A p_0 sqrt( (1 - r²) / (R T (n - ln r)) )        r = p_n/p_0
/// ```
///
/// Below `r_c` the flow of a throttling would fall again; it is choked there, `φ` = 0.6663. Near equal pressures `φ` is multiplied with
/// `sqrt(u/(u + ε))`, `u = 1 - r`, which makes it proportional to the pressure difference; where `u + ε` is below [`MIN_DROP`](crate::MIN_DROP) it is a parabola.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThrottlingLaw {
    discharge: f64,
    /// `ε`.
    laminar: f64,
}

const NEAR: LeastDrop = LeastDrop::new(MIN_DROP);

impl ThrottlingLaw {
    /// With the discharge coefficient `C_d`, and `ε` of the laminar branch, 0 for none.
    #[must_use]
    pub const fn new(discharge: f64, laminar: f64) -> Self {
        Self { discharge, laminar }
    }

    /// `φ²/u` at the drop `u`, which is smooth through 0, and its derivative by `u`.
    #[inline]
    fn quotient(u: f64) -> (f64, f64) {
        let root = 1.0 / (1.0 - elementary::ln_1p(-u));
        let q = (2.0 - u) * root;
        (q, -root - q * root / (1.0 - u))
    }

    /// `φ` with the laminar branch.
    #[inline]
    fn phi(&self, u: f64) -> f64 {
        let within = u.min(1.0 - THROTTLING_RATIO);
        let (w, parabola) = NEAR.root(u + self.laminar);
        (Self::quotient(within).0 * within * (u / w)).sqrt() * parabola
    }

    /// The same and its derivative by `u`.
    #[inline]
    fn phi_derivative(&self, u: f64) -> (f64, f64) {
        let phi = self.phi(u);
        let (w, parabola) = NEAR.root(u + self.laminar);
        if u >= 1.0 - THROTTLING_RATIO {
            return (phi, 0.5 * phi * self.laminar / (u * w));
        }
        let (q, by_u) = Self::quotient(u);
        let (inverse, by_q) = (1.0 / w, 0.5 * u * by_u / q);
        let root = 1.0 + by_q - 0.5 * u * inverse;
        (phi, (q * inverse).sqrt() * (root + (parabola - 1.0) * (1.0 + by_q)))
    }
}

impl PassageLaw for ThrottlingLaw {
    type Passage = Area;

    fn discharge(&self) -> f64 {
        self.discharge
    }

    #[inline]
    fn mass_flow(&self, Area(area): Area, a: &GasState, b: &GasState) -> f64 {
        directed(self.discharge * area, a, b, |u, _| self.phi(u))
    }

    fn mass_flow_partials(&self, Area(area): Area, a: &GasState, b: &GasState) -> FlowPartials {
        directed_partials(self.discharge * area, a, b, |u, _| self.phi_derivative(u))
    }
}
