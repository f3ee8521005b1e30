use gudgeon_core::kinds::CylinderPressure;

/// Crank angles of a cycle: prime, so that none is special but 0.
const ANGLES: u32 = 1439;

/// Complaints about a running model of the cylinder pressure, over a cycle:
///
/// - a pressure that is not positive and finite, changes when it is asked again, or does not repeat after the period;
/// - kinks that are not ascending in `[0, period)`;
/// - a pressure above that of [`CylinderPressure::highest`], or one there that is another.
#[must_use]
pub fn cylinder_pressure(model: &dyn CylinderPressure) -> Vec<String> {
    let period = model.period();
    if !(period > 0.0 && period.is_finite()) {
        return vec![format!("the period is {period} rad")];
    }
    let kinks = model.kinks();
    let mut wrong = Vec::new();
    if !kinks.windows(2).all(|k| k[0] < k[1]) || !kinks.iter().all(|k| (0.0..period).contains(k)) {
        wrong.push(format!("the kinks do not ascend within the cycle: {kinks:?}"));
    }
    let (at, top) = model.highest();
    // A place where the pressure jumps belongs to either side.
    let jumps = kinks.iter().any(|k| (k - at).abs() < 1e-9 * period);
    if !(0.0..=period).contains(&at) || !jumps && model.pressure(at) != top {
        wrong.push(format!(
            "the highest pressure is {top} Pa at {at} rad, where it is {} Pa",
            model.pressure(at)
        ));
    }
    // Half a step off every multiple of a degree: kinks stand on these, and either side of a jump would do.
    for k in 0..ANGLES {
        let theta = period * (f64::from(k) + 0.5) / f64::from(ANGLES);
        let p = model.pressure(theta);
        if !(p > 0.0 && p.is_finite()) {
            wrong.push(format!("the pressure at {theta} rad is {p} Pa"));
        }
        if model.pressure(theta).to_bits() != p.to_bits() {
            wrong.push(format!("the pressure at {theta} rad changes"));
        }
        // The angle is rounded, by some 1e-15 of a cycle, and pulses rise by their own height within a thousandth of one.
        let later = model.pressure(theta + period);
        if (later - p).abs() > 1e-9 * top {
            wrong.push(format!("the pressure a cycle after {theta} rad is {later} Pa, not {p} Pa"));
        }
        if p > top * (1.0 + 1e-9) {
            wrong.push(format!("the pressure at {theta} rad is {p} Pa, above the highest, {top} Pa"));
        }
    }
    wrong
}
