//! What is wrong with a case that could be read.

use gudgeon_core::BuildError;
use gudgeon_core::kinds::Line;

use super::case::ShaftLineCase;

/// Most torque amplitudes kept for the diagrams over the speed: 160 MB.
const MAX_KEPT: f64 = 2e7;
/// Most load steps: each is a machine of its own.
const MAX_STEPS: usize = 200;

/// Speed ratios of an inertia, and of one that carries throws: the gas torques of a throw that turns slowly are as many orders of the reference.
const RATIOS: [(f64, f64); 2] = [(1e-3, 1e3), (0.1, 10.0)];
/// Highest speed of the diagrams over that of the case.
const FASTEST: f64 = 30.0;

/// Speed ratios that no gear of one machine has.
fn ratios(case: &ShaftLineCase) -> Vec<BuildError> {
    let carries = |name: &str| case.throws.iter().any(|t| t.at.iter().any(|at| at == name));
    let wrong = case.inertias.iter().enumerate().filter_map(|(k, i)| {
        let (ratio, throws) = (i.ratio.si().abs(), carries(&i.name));
        let (low, high) = RATIOS[usize::from(throws)];
        // Zero is told where the line is built.
        (ratio != 0.0 && !(low..=high).contains(&ratio)).then(|| {
            let of = if throws { "an inertia with throws" } else { "an inertia" };
            let what =
                format!("the speed of {of} is between {low} and {high} of that of the reference shaft");
            BuildError::at(format!("inertias.{k}.ratio"), format!("{what}, not {ratio:e}"))
        })
    });
    wrong.collect()
}

/// Values that contradict each other.
pub fn legal_values(case: &ShaftLineCase) -> Vec<BuildError> {
    let mut errors = ratios(case);
    let r = &case.range;
    if let Some(to) = r.to.filter(|to| to.si() > FASTEST * case.speed.si()) {
        let what = format!(
            "{:.6} rpm are more than {FASTEST} times `speed`, {:.6} rpm",
            super::rpm(to.si()),
            super::rpm(case.speed.si())
        );
        errors.push(BuildError::at("range.to", what));
    }
    if r.orders.si() > 2000.0 {
        errors.push(BuildError::at("range.orders", "at most 2000 orders"));
    }
    if r.interference_orders.si() > 100.0 {
        errors.push(BuildError::at("range.interference_orders", "at most 100 orders"));
    }
    match (r.from, r.to) {
        (Some(a), Some(b)) if a.si() >= b.si() => {
            errors.push(BuildError::at("range.to", "must be above `from`"));
        }
        (Some(_), None) => errors.push(BuildError::at("range.to", "is missing beside `from`")),
        (None, Some(_)) => errors.push(BuildError::at("range.from", "is missing beside `to`")),
        _ => {}
    }
    if !(2..=20_000).contains(&r.points) {
        errors.push(BuildError::at("range.points", "between 2 and 20000 speeds"));
    }
    let links = (case.shafts.len() + case.dampers.len()).max(1);
    // Half orders occur.
    let kept = 2.0 * r.orders.si() * r.points as f64 * links as f64;
    if kept > MAX_KEPT && r.from.is_some() {
        let what = format!(
            "{} speeds of {} orders in {links} shafts are {kept:.1e} values, at most {MAX_KEPT:.0e}",
            r.points,
            r.orders.si()
        );
        errors.push(BuildError::at("range.points", what).help("fewer points, or fewer `range.orders`"));
    }
    if let Some(o) = case.operating.as_ref().filter(|o| o.from.si() > o.to.si()) {
        let what = format!("{:.6} rpm is below `from`", super::rpm(o.to.si()));
        errors.push(BuildError::at("operating.to", what));
    }
    if case.load_steps.len() > MAX_STEPS {
        errors.push(BuildError::at("load_steps", format!("at most {MAX_STEPS} load steps")));
    }
    for (k, l) in case.limits.separation.iter().enumerate() {
        if l.orders.is_empty() && l.frequencies.is_empty() {
            let what = "names neither orders nor frequencies";
            errors.push(BuildError::at(format!("limits.separation.{k}"), what));
        }
        if l.orders.iter().any(|o| !(o.is_finite() && *o > 0.0)) {
            errors.push(BuildError::at(
                format!("limits.separation.{k}.orders"),
                "orders are greater than zero",
            ));
        }
    }
    errors.extend(legal_load_steps(case));
    for (k, l) in case.limits.torque.iter().enumerate() {
        if l.amplitude.is_none() && l.peak.is_none() {
            let what = "gives neither `amplitude` nor `peak`";
            errors.push(BuildError::at(format!("limits.torque.{k}"), what));
        }
    }
    errors
}

/// Load steps of limits that the case does not have.
fn legal_load_steps(case: &ShaftLineCase) -> Vec<BuildError> {
    let names: Vec<&str> = super::steps::all(case).into_iter().map(|(name, _)| name).collect();
    let l = &case.limits;
    let all = [
        ("separation", l.separation.iter().map(|l| &l.load_steps).collect::<Vec<_>>()),
        ("stress", l.stress.iter().map(|l| &l.load_steps).collect()),
        ("torque", l.torque.iter().map(|l| &l.load_steps).collect()),
        ("heat", l.heat.iter().map(|l| &l.load_steps).collect()),
        ("irregularity", l.irregularity.iter().map(|l| &l.load_steps).collect()),
    ];
    let mut errors = Vec::new();
    for (kind, limits) in all {
        for (k, steps) in limits.into_iter().enumerate() {
            for (j, name) in steps.iter().enumerate().filter(|(_, n)| !names.contains(&n.as_str())) {
                let what = format!("there is no load step `{name}`; {}", gudgeon_case::advice(name, &names));
                errors.push(BuildError::at(format!("limits.{kind}.{k}.load_steps.{j}"), what));
            }
        }
    }
    errors
}

/// Names of limits that the line does not have.
pub fn legal_names(case: &ShaftLineCase, line: &Line) -> Vec<BuildError> {
    let names: Vec<&str> = line.links.iter().map(|l| l.name.as_str()).collect();
    let l = &case.limits;
    let stress =
        l.stress.iter().enumerate().map(|(k, s)| (format!("limits.stress.{k}.shaft"), s.shaft.as_str()));
    let torque =
        l.torque.iter().enumerate().map(|(k, s)| (format!("limits.torque.{k}.shaft"), s.shaft.as_str()));
    let heat = l.heat.iter().enumerate().map(|(k, s)| (format!("limits.heat.{k}.shaft"), s.shaft.as_str()));
    let inertias: Vec<&str> = line.nodes.iter().map(|n| n.name.as_str()).collect();
    let unknown = l.irregularity.iter().enumerate().filter(|(_, s)| !inertias.contains(&s.inertia.as_str()));
    let unknown = unknown.map(|(k, s)| {
        let what =
            format!("there is no inertia `{}`; {}", s.inertia, gudgeon_case::advice(&s.inertia, &inertias));
        BuildError::at(format!("limits.irregularity.{k}.inertia"), what)
    });
    stress
        .filter(|(_, n)| !n.is_empty())
        .chain(torque)
        .chain(heat)
        .filter(|(_, n)| !names.contains(n))
        .map(|(place, n)| {
            let what = format!("there is no shaft `{n}`; {}", gudgeon_case::advice(n, &names));
            BuildError::at(place, what)
        })
        .chain(unknown)
        .collect()
}
