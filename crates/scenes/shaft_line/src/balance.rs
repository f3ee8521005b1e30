//! Where the torque acts that holds the mean speed.
//!
//! A line at constant mean speed is in balance. What is missing comes, whatever the order in which things are listed,
//!
//! 1. on the inertia that `balance_at` names;
//! 2. from the drives whose torque does not go with the angle, in proportion to their power at the mean speed;
//! 3. without one, where a line has loads and its cylinders drive it, from these in proportion to their mean gas power: an engine
//!    gives what its loads ask for;
//! 4. otherwise from all inertias in proportion to their size at the reference shaft: nothing holds the speed, and the line speeds up or
//!    slows down as a whole.

use gudgeon_core::BuildError;
use gudgeon_core::kinds::Line;
use gudgeon_core::result::Note;
use gudgeon_torsion::forcing::gas_series;

use super::case::ShaftLineCase;

/// Shares of the inertias, with what a person should know of them.
///
/// # Errors
/// A name that no inertia has.
pub fn balance(case: &ShaftLineCase, line: &Line) -> Result<(Vec<f64>, Option<Note>), BuildError> {
    let n = line.nodes.len();
    let ratio = |i: usize| line.nodes[i].ratio;
    let mut shares = vec![0.0; n];
    if let Some(name) = &case.balance_at {
        let names: Vec<&str> = line.nodes.iter().map(|n| n.name.as_str()).collect();
        return match names.iter().position(|n| n == name) {
            Some(i) => {
                shares[i] = 1.0;
                Ok((shares, None))
            }
            None => {
                let what = format!("there is no inertia `{name}`; {}", gudgeon_case::advice(name, &names));
                Err(BuildError::at("balance_at", what))
            }
        };
    }
    let drives: Vec<_> =
        line.drives.iter().filter(|d| d.factor > 0.0 && d.drive.orders().is_empty()).collect();
    if !drives.is_empty() {
        let speed = case.speed.si();
        for d in &drives {
            shares[d.node] += (d.drive.torque(d.phase, speed * ratio(d.node)).torque * ratio(d.node)).abs();
        }
        if shares.iter().sum::<f64>() <= 0.0 {
            drives.iter().for_each(|d| shares[d.node] += 1.0);
        }
        return Ok((scaled(shares), None));
    }
    let held = line.nodes.iter().any(|n| n.ground != 0.0);
    let loaded = line.drives.iter().any(|d| d.factor < 0.0);
    let gas: Vec<(usize, f64)> =
        line.throws.iter().map(|t| (t.node, gas_series(t, 1)[0].re * ratio(t.node))).collect();
    if loaded && gas.iter().map(|g| g.1).sum::<f64>() > 0.0 {
        gas.iter().for_each(|(i, torque)| shares[*i] += torque.max(0.0));
        let text = "the line has no motor: what its loads ask beyond the mean gas torque, or leave of it, its cylinders give in proportion to that torque (`balance_at` names another place)";
        return Ok((scaled(shares), (!held).then(|| Note::info("balance", text))));
    }
    for (i, s) in shares.iter_mut().enumerate() {
        *s = line.mean_inertia(i) * ratio(i) * ratio(i);
    }
    let text = "nothing holds the mean speed: its inertias balance the mean torque in proportion to their size, as in a line that speeds up or slows down (a drive, or `balance_at`, says where it is held)";
    // Without a mean torque there is nothing to balance.
    let drag = line.nodes.iter().any(|n| n.damping != 0.0);
    let asked = drag || !line.drives.is_empty() || gas.iter().any(|g| g.1 != 0.0);
    Ok((scaled(shares), (asked && !held).then(|| Note::info("balance", text))))
}

/// With a sum of 1.
fn scaled(mut shares: Vec<f64>) -> Vec<f64> {
    let sum: f64 = shares.iter().sum();
    if sum > 0.0 && sum.is_finite() {
        shares.iter_mut().for_each(|s| *s /= sum);
    } else if let Some(first) = shares.first_mut() {
        // Inertias of zero alone: the line is refused elsewhere.
        *first = 1.0;
    }
    shares
}
