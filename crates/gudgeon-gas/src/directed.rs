//! A law of the pressure ratio, for flow in either direction.

use crate::passage_law::{FlowPartials, GasState};

/// Flow \[kg/s\] `area p_u / sqrt(R T_u) ψ(u)` from `a` to `b`, `u = 1 - p_d/p_u`, with the side `u` of the higher pressure. 0 without pressure.
#[inline]
pub(crate) fn directed(area: f64, a: &GasState, b: &GasState, psi: impl FnOnce(f64, f64) -> f64) -> f64 {
    let forward = a.pressure() >= b.pressure();
    let (up, down) = if forward { (a, b) } else { (b, a) };
    let (p, back) = (up.pressure(), down.pressure());
    if p <= 0.0 {
        return 0.0;
    }
    let magnitude = area * p * up.inv_sqrt_rt() * psi((p - back) / p, back / p);
    if forward { magnitude } else { -magnitude }
}

/// The same with its partial derivatives by both pressures; `psi` gives `ψ` and `dψ/du` of `u` and `p_d/p_u`. With `C = area / sqrt(R T_u)`:
///
/// ```text
/// ∂ṁ/∂p_u = C [ ψ + (1 - u) dψ/du ]        ∂ṁ/∂p_d = -C dψ/du
/// ```
#[inline]
pub(crate) fn directed_partials(
    area: f64,
    a: &GasState,
    b: &GasState,
    psi: impl FnOnce(f64, f64) -> (f64, f64),
) -> FlowPartials {
    let forward = a.pressure() >= b.pressure();
    let (up, down) = if forward { (a, b) } else { (b, a) };
    let (p, back) = (up.pressure(), down.pressure());
    if p <= 0.0 {
        return FlowPartials::default();
    }
    let u = (p - back) / p;
    let (psi, derivative) = psi(u, back / p);
    let flow = area * p * up.inv_sqrt_rt() * psi;
    let front = area * up.inv_sqrt_rt();
    let (by_up, by_down) = (front * (psi + (1.0 - u) * derivative), -front * derivative);
    if forward {
        FlowPartials { flow, by_a: by_up, by_b: by_down }
    } else {
        FlowPartials { flow: -flow, by_a: -by_down, by_b: -by_up }
    }
}
