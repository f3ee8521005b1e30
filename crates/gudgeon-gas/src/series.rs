//! Two passages in series, with a space between them that stores nothing.

use crate::passage_law::{FlowPartials, GasState, PassageLaw};

/// Flow \[kg/s\] through two passages, one after the other, with its derivatives by the pressures of both ends, and the derivatives of
/// the pressure between them, to which `between` is set.
///
/// What comes in through the first falls with that pressure, what leaves through the second grows: one root between the pressures
/// of the ends, by Newton's method with halving where that leaves the bracket. The start does not depend on earlier calls.
pub(crate) fn in_series<L: PassageLaw>(
    law: &L,
    [first, second]: [L::Passage; 2],
    a: &GasState,
    between: &mut GasState,
    b: &GasState,
) -> (FlowPartials, [f64; 2]) {
    const NEWTON: u32 = 25;
    const HALVING: u32 = 60;
    let (pa, pb) = (a.pressure(), b.pressure());
    let (mut low, mut high) = (pa.min(pb), pa.max(pb));
    // As if each flow went with the root of its pressure drop.
    let [c1, c2] = [first, second].map(|passage| law.mass_flow(passage, a, b));
    let (w1, w2) = (c1 * c1, c2 * c2);
    let share = if w1 + w2 > 0.0 { w2 / (w1 + w2) } else { 0.5 };
    let mut p = (pa + share * (pb - pa)).clamp(low, high);
    let (mut inflow, mut outflow);
    let mut step = 0;
    loop {
        between.set_pressure(p);
        inflow = law.mass_flow_partials(first, a, between);
        outflow = law.mass_flow_partials(second, between, b);
        let surplus = inflow.flow - outflow.flow;
        step += 1;
        if surplus == 0.0 || step == NEWTON + HALVING {
            break;
        }
        if surplus > 0.0 {
            low = p;
        } else {
            high = p;
        }
        let next = p - surplus / (inflow.by_b - outflow.by_a);
        let next = if step < NEWTON && next > low && next < high { next } else { 0.5 * (low + high) };
        if (next - p).abs() <= 2.0 * f64::EPSILON * p {
            break;
        }
        p = next;
    }
    // Rounding of the pressure between has the smallest effect in the passage whose flow depends on it less.
    let flow = if inflow.by_b.abs() <= outflow.by_a { inflow.flow } else { outflow.flow };
    let stiffness = outflow.by_a - inflow.by_b;
    if stiffness > 0.0 {
        let by = [inflow.by_a / stiffness, -outflow.by_b / stiffness];
        (FlowPartials { flow, by_a: outflow.by_a * by[0], by_b: inflow.by_b * by[1] }, by)
    } else {
        // Both closed, or choked: nothing follows from the pressure between.
        (FlowPartials { flow, by_a: inflow.by_a, by_b: 0.0 }, [0.0; 2])
    }
}
