//! The cycle of forces and its greatest one.

use gudgeon_core::BuildError;
use gudgeon_core::kinds::{EngineCycle, PinForces, PinInstant, PinLoadCase};

/// Instants of a four-stroke cycle: half a degree apart.
const INSTANTS: usize = 1440;

/// Ratio of the golden section.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

fn instant(e: &EngineCycle, area: f64, mass: f64, theta: f64) -> PinInstant {
    let pressure = e.pressure.pressure(theta);
    PinInstant {
        theta,
        pressure,
        // The pin pushes the piston up with F_gas + m a: a is positive towards the head.
        forces: PinForces {
            gas: (pressure - e.crankcase_pressure) * area,
            inertia: mass * e.kinematics.motion(theta).a,
        },
    }
}

/// Forces over the cycle, and the instant of the greatest one: the rows first, then a golden section between the
/// neighbours of the best, kinks of the pressure included.
pub fn over_cycle(e: &EngineCycle, pi: f64, mass: f64) -> Result<PinLoadCase, BuildError> {
    let area = pi * e.bore * e.bore / 4.0;
    let period = e.pressure.period();
    let at = |theta: f64| instant(e, area, mass, theta);
    let step = period / INSTANTS as f64;
    let cycle: Vec<PinInstant> = (0..INSTANTS).map(|i| at(step * i as f64)).collect();
    if let Some(bad) = cycle.iter().find(|i| !i.forces.total().is_finite()) {
        let what = format!("at {:.1} deg the force on the pin is no number", bad.theta.to_degrees());
        return Err(BuildError::new(what));
    }
    let size = |i: &PinInstant| i.forces.total().abs();
    let greater = |a: PinInstant, b: PinInstant| if size(&b) > size(&a) { b } else { a };
    let mut best = cycle.iter().copied().fold(PinInstant::default(), greater);
    best = e.pressure.kinks().iter().map(|&k| at(k)).fold(best, greater);
    let (mut lo, mut hi) = (best.theta - step, best.theta + step);
    let (mut a, mut b) = (at(hi - GOLDEN * (hi - lo)), at(lo + GOLDEN * (hi - lo)));
    // 60 sections shrink a degree to rounding.
    for _ in 0..60 {
        if size(&a) > size(&b) {
            hi = b.theta;
            (b, a) = (a, at(hi - GOLDEN * (hi - lo)));
        } else {
            lo = a.theta;
            (a, b) = (b, at(lo + GOLDEN * (hi - lo)));
        }
    }
    best = greater(best, greater(a, b));
    if size(&best) == 0.0 {
        return Err(BuildError::new("nothing loads the pin over the whole cycle"));
    }
    let k = &e.kinematics;
    let radius = 0.5 * k.stroke();
    // The height of the pin at the top is rod and radius when nothing is offset.
    let rod = k.y_tdc() - radius;
    Ok(PinLoadCase {
        design: best,
        omega: Some(k.omega()),
        crank_ratio: (rod > 0.0).then(|| radius / rod),
        cycle,
        notes: e.pressure.notes(),
    })
}
