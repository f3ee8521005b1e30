//! Fatigue criteria: lines and curves of equal life between an alternating and a mean stress.

pub mod gerber;
pub mod goodman;
pub mod off;
pub mod soderberg;

use gudgeon_core::{BuildError, EvalError};

/// Mean, not below zero, and amplitude; or what is wrong with them.
fn tension(model: &'static str, mean: f64, amplitude: f64) -> Result<(f64, f64), EvalError> {
    if !(mean.is_finite() && amplitude.is_finite() && amplitude >= 0.0) {
        let what = format!("a mean of {mean} Pa with an amplitude of {amplitude} Pa is no stress");
        return Err(EvalError::recoverable(model, what));
    }
    if mean <= 0.0 && amplitude == 0.0 {
        return Err(EvalError::fatal(model, "nothing alternates and nothing pulls: there is no fatigue"));
    }
    Ok((mean.max(0.0), amplitude))
}

/// Refuses an endurance limit above the static strength.
fn ordered(endurance: f64, strength: f64, name: &str) -> Result<(), BuildError> {
    if endurance <= strength {
        return Ok(());
    }
    let what = format!("the endurance limit, {:.0} MPa, exceeds the {name}", 1e-6 * endurance);
    Err(BuildError::at("endurance_limit", what))
}
