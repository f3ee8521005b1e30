//! What can be known before anything runs: whether every value of every sweep makes a case that can be, and whether every result that a
//! case names is one that it has.

use std::collections::HashSet;

use gudgeon_core::BuildError;

use crate::scene::Scene;
use crate::sweep_input::{self, Axis, Sweep};
use gudgeon_case::advice;

/// Most cases of the sweeps that are read and built before a run. Beyond it, every listed value still stands in one of them, with a value of
/// the other sweep in turn, and of a range of numbers this many, both ends among them.
const MAX_TRIED: usize = 1000;

/// What is wrong with the values of sweeps. Values that can be read and make a machine that cannot be are no mistake unless all are: a run leaves
/// their points out and tells why.
pub(crate) fn sweeps(scene: &dyn Scene, sweeps: &[Sweep]) -> Vec<BuildError> {
    let lists: Option<Vec<Vec<String>>> = sweeps.iter().map(|s| sweep_input::values(&s.axis).ok()).collect();
    let Some(lists) = lists.filter(|l| l.iter().all(|v| !v.is_empty())) else { return Vec::new() };
    let tried = combinations(&lists.iter().map(Vec::len).collect::<Vec<_>>());
    let (mut failed, mut possible, mut unreadable) = (Vec::new(), false, false);
    for places in &tried {
        let set: Vec<String> = sweeps
            .iter()
            .zip(&lists)
            .zip(places)
            .map(|((s, l), i)| format!("{}={}", s.axis.path, l[*i]))
            .collect();
        match impossible(scene, &set) {
            None => possible = true,
            Some((why, read)) => {
                // What cannot be read is the first to be told.
                if !read && !unreadable {
                    unreadable = true;
                    failed.clear();
                }
                if read != unreadable {
                    failed.push((places.clone(), set.join(", "), why));
                }
            }
        }
    }
    if possible && !unreadable {
        return Vec::new();
    }
    let Some((places, set, why)) = failed.first() else { return Vec::new() };
    // One sweep alone is to blame when its value fails with every value of the other.
    let blamed = (0..sweeps.len())
        .find(|k| {
            let with = |list: &[Vec<usize>]| list.iter().filter(|p| p[*k] == places[*k]).count();
            let bad: Vec<Vec<usize>> = failed.iter().map(|(p, ..)| p.clone()).collect();
            sweeps.len() == 1 || with(&bad) == with(&tried)
        })
        .unwrap_or(0);
    let listed = !sweeps[blamed].axis.values.is_empty();
    let place = match listed {
        true => format!("sweeps.{blamed}.values.{}", places[blamed]),
        false => format!("sweeps.{blamed}"),
    };
    let what = format!("{} of {} points cannot be run; the first, `{set}`: {why}", failed.len(), tried.len());
    vec![BuildError::at(place, what)]
}

/// Sweeps of a value that the scene does not use: all their points would be one.
pub(crate) fn idle(scene: &dyn Scene, sweeps: &[Sweep]) -> Vec<BuildError> {
    let is_idle = |s: &Axis| {
        let first = sweep_input::values(s).ok()?.into_iter().next()?;
        let changed = scene.changed(&[format!("{}={first}", s.path)]).ok()?;
        changed.unused().contains(&s.path).then_some(())
    };
    let refused = |(k, s): (usize, &Sweep)| {
        let what = format!("this scene does not use `{}`: a sweep of it changes nothing", s.axis.path);
        is_idle(&s.axis).map(|()| BuildError::at(format!("sweeps.{k}.path"), what))
    };
    sweeps.iter().enumerate().filter_map(refused).collect()
}

/// Why the case cannot be run with some values changed, and whether these could be read.
fn impossible(scene: &dyn Scene, set: &[String]) -> Option<(String, bool)> {
    match scene.changed(set) {
        Err(report) => {
            let told: Vec<String> = report.diagnostics.iter().map(|d| d.headline()).collect();
            Some((told.join("; "), false))
        }
        Ok(s) => {
            let errors = s.legal();
            let told: Vec<String> = errors
                .iter()
                .map(|e| if e.field.is_empty() { e.message.clone() } else { format!("{}: {e}", e.field) })
                .collect();
            (!errors.is_empty()).then(|| (told.join("; "), true))
        }
    }
}

/// Places in lists of these lengths that are tried: all combinations when they are few.
fn combinations(lengths: &[usize]) -> Vec<Vec<usize>> {
    let all = lengths.iter().try_fold(1usize, |n, l| n.checked_mul(*l)).filter(|n| *n <= MAX_TRIED);
    if let Some(all) = all.filter(|_| !lengths.is_empty()) {
        let place = |mut k: usize| {
            let mut digit = |l: &usize| {
                let d = k % l;
                k /= l;
                d
            };
            lengths.iter().map(&mut digit).collect()
        };
        return (0..all).map(place).collect();
    }
    let most = lengths.iter().copied().max().unwrap_or(0);
    let tried = most.min(MAX_TRIED);
    let spread = |k: usize, l: usize| {
        if l > MAX_TRIED { (k * (l - 1)).div_ceil(tried.max(2) - 1).min(l - 1) } else { k % l }
    };
    (0..tried).map(|k| lengths.iter().map(|l| spread(k, *l)).collect()).collect()
}

/// Results that sweeps name and that the case does not have.
pub(crate) fn drawn(scene: &dyn Scene, sweeps: &[Sweep]) -> Vec<BuildError> {
    let asks = sweeps.iter().any(|s| !s.results.is_empty());
    let Some(own) = asks.then(|| scene.result_names()).flatten() else { return Vec::new() };
    let wrong = |(k, s): (usize, &Sweep)| {
        let place = move |(j, e): (usize, BuildError)| e.within(&format!("sweeps.{k}.results.{j}"));
        unknown(&s.results, &own).map(place).collect::<Vec<_>>()
    };
    sweeps.iter().enumerate().flat_map(wrong).collect()
}

/// The names that are not known, with their places in the list.
pub fn unknown<'a>(
    names: &'a [String],
    known: &'a [String],
) -> impl Iterator<Item = (usize, BuildError)> + 'a {
    let set: HashSet<&str> = known.iter().map(String::as_str).collect();
    names.iter().enumerate().filter(move |(_, n)| !set.contains(n.as_str())).map(|(j, n)| {
        let known: Vec<&str> = known.iter().map(String::as_str).collect();
        (j, BuildError::new(format!("there is no result `{n}`")).help(advice(n, &known)))
    })
}

/// Whether all names are known.
///
/// # Errors
/// The first that is not, with the nearest one.
pub fn all_known(names: &[String], known: &[String]) -> Result<(), String> {
    match unknown(names, known).next() {
        None => Ok(()),
        Some((_, e)) => Err(format!("{}; {}", e.message, e.help.unwrap_or_default())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_is_tried_as_long_as_there_are_few() {
        assert_eq!(combinations(&[2, 3]).len(), 6);
        assert_eq!(combinations(&[]).len(), 0);
        let many = combinations(&[700, 3]);
        assert_eq!(many.len(), 700);
        assert!((0..700).all(|k| many.iter().any(|p| p[0] == k)));
        assert!((0..3).all(|k| many.iter().any(|p| p[1] == k)));
        let range = combinations(&[100_000]);
        assert_eq!((range.len(), range[0][0], range[MAX_TRIED - 1][0]), (MAX_TRIED, 0, 99_999));
        assert!(range.windows(2).all(|w| w[0] < w[1]));
    }
}
