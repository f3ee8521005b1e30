//! How far the work of a ring pack depends on what makes its equations stiff: speed, stiffness of the contact, mass of the rings.

use std::fmt::Write as _;

use crate::cases::{Case, FLOODED, given};
use crate::measure::{Counts, each};

/// The case whose values are changed.
const CASE: &str = "turbo-diesel-120";
/// Speeds \[rpm\].
const SPEEDS: [f64; 3] = [600.0, 1900.0, 6000.0];
/// Factors of the composite modulus of the contact, and of the mass of every ring.
const FACTORS: [f64; 3] = [1.0 / 3.0, 1.0, 3.0];

/// One run.
struct Point {
    speed: f64,
    modulus: f64,
    mass: f64,
}

/// All of the ladder.
fn points() -> Vec<Point> {
    let of = |speed| {
        FACTORS.into_iter().flat_map(move |modulus| FACTORS.map(|mass| Point { speed, modulus, mass }))
    };
    SPEEDS.into_iter().flat_map(of).collect()
}

/// The case at a point: paths of what is multiplied, and values with their units, come from the case as it is shipped.
fn case(p: &Point, resolved: &serde_json::Value) -> Result<Case, String> {
    let times = |path: &str, factor: f64| {
        let (value, unit) =
            given(resolved, path).ok_or_else(|| format!("{CASE} gives no number at {path}"))?;
        Ok::<_, String>(format!("{path}={} {unit}", factor * value))
    };
    let mut set = vec![FLOODED.to_owned(), format!("engine.speed={} rpm", p.speed)];
    set.push(times("models.contact.composite_modulus", p.modulus)?);
    let rings = resolved["rings"].as_array().map_or(0, Vec::len);
    for i in 0..rings {
        set.push(times(&format!("rings.{i}.mass"), p.mass)?);
    }
    Ok(Case { set, ..Case::shipped(CASE) })
}

/// Largest over median of some counts.
fn spread(mut all: Vec<f64>) -> Option<f64> {
    all.sort_by(f64::total_cmp);
    Some(all.last()? / all[all.len() / 2])
}

/// The ladder as a table, on `threads` threads: steps, rejected steps, right-hand sides and cycles of every run, and the largest over the median.
///
/// # Errors
/// A case that cannot be read. Runs that fail stand in the table with the reason.
pub fn table(threads: usize) -> Result<String, String> {
    let resolved = Case::shipped(CASE).check()?.case.resolved();
    let points = points();
    let cases = points.iter().map(|p| case(p, &resolved)).collect::<Result<Vec<Case>, String>>()?;
    let runs = each(&cases, threads);
    let mut text = format!(
        "{:>9} {:>9} {:>7} {:>7} {:>8} {:>9} {:>8} {:>12}\n",
        "speed rpm", "modulus x", "mass x", "cycles", "steps", "rejected", "rhs", "steps/cycle"
    );
    // Writing to a text cannot fail.
    for (p, run) in points.iter().zip(&runs) {
        let _ = write!(text, "{:>9} {:>9.2} {:>7.2} ", p.speed, p.modulus, p.mass);
        let _ = match run {
            Ok(counts) => {
                let n = |name: &str| counts.get(name).copied().unwrap_or(0);
                let (cycles, steps) = (n("cycles"), n("steps"));
                let (rejected, rhs, each) = (n("rejected"), n("rhs"), a_cycle(counts, "steps"));
                writeln!(text, "{cycles:>7} {steps:>8} {rejected:>9} {rhs:>8} {each:>12.0}")
            }
            Err(e) => writeln!(text, "{e}"),
        };
    }
    let done: Vec<&Counts> = runs.iter().flatten().collect();
    let _ =
        writeln!(text, "\n{} of {} runs have a periodic cycle; largest over median:", done.len(), runs.len());
    for name in ["steps", "rejected", "rhs", "film_evaluations"] {
        let told = spread(done.iter().map(|c| a_cycle(c, name)).collect());
        let _ = writeln!(text, "{:>24} {:.2}", format!("{name} a cycle"), told.unwrap_or(f64::NAN));
    }
    let cycles = spread(done.iter().map(|c| c.get("cycles").copied().unwrap_or(0) as f64).collect());
    let _ = writeln!(text, "{:>24} {:.2}", "cycles", cycles.unwrap_or(f64::NAN));
    Ok(text)
}

/// A count over the number of cycles.
fn a_cycle(counts: &Counts, name: &str) -> f64 {
    let n = |name: &str| counts.get(name).copied().unwrap_or(0) as f64;
    n(name) / n("cycles").max(1.0)
}
