//! What an assembly cannot do.

use gudgeon_core::BuildError;

use super::assembly::Assembly;
use super::case::PistonSecondaryCase;

/// What cannot move, or not from where it begins.
pub fn impossible(case: &PistonSecondaryCase, a: &mut Assembly) -> Vec<BuildError> {
    let mut errors = Vec::new();
    let s = &case.solver;
    let now = a.instant(0.0);
    let inertial = a.motion.has_inertia();
    errors.extend(s.method.refuses(a));
    let mut y = vec![0.0; a.layout.n];
    a.initial(&mut y);
    errors.extend(nothing_between_full_films(a, &y));
    // A film that cannot be solved between centred surfaces tells so when it runs.
    if a.motion.moves() && matches!(a.piston.resists(&now, inertial), Ok(false)) {
        let nothing = "this film does not resist the motion across the bore";
        if !inertial {
            let help = "`quasi_static` finds the velocities at which films carry the load: use another film, or `full_inertia` for a dry skirt";
            errors.push(BuildError::at("models.film_2d", nothing).help(help));
        } else if s.cycles == 0 {
            let what = format!("{nothing}: without damping it does not become periodic");
            errors.push(
                BuildError::at("models.film_2d", what).help("look at the transient with `solver.cycles`"),
            );
        }
    }
    let mut x = vec![0.0; a.piston.coordinates()];
    a.coordinates(&y, &mut x);
    if let Err(e) = a.piston.gaps(&x, now.speed) {
        let edge = if x[0].abs() >= x[1].abs() { 0 } else { 1 };
        let place = match a.motion.start_keys() {
            Some(keys) => format!("models.secondary_motion.{}", keys[edge]),
            None => ["solver.start_top", "solver.start_bottom"][edge].into(),
        };
        errors.push(BuildError::at(place, e.to_string()));
    }
    errors
}

/// A motion whose velocities are those of a balance, in gaps that are not always full: across an empty one nothing but inertia holds the piston back. Even where every
/// edge is flooded a gap that opened faster than oil came in is empty, and a balance crosses it at once.
fn nothing_between_full_films(a: &Assembly, y: &[f64]) -> Option<BuildError> {
    let motion = &a.motion;
    let damped = motion.added(&y[a.layout.motion.clone()]).damping.iter().flatten().any(|d| *d != 0.0);
    if a.oil.is_none() || !motion.moves() || motion.has_inertia() || damped {
        return None;
    }
    let what = format!(
        "`{}` finds the velocities at which films carry the load, and a film that keeps its oil carries nothing where the gap is not full",
        a.motion_name
    );
    let help = "use `full_inertia`, or full films without a history: `skirt_oil` `off`";
    Some(BuildError::at("models.secondary_motion", what).help(help))
}
