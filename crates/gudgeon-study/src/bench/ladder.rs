//! The numerical settings that a case declares, from coarse to fine: grids and orders together, every tolerance by itself.

use gudgeon_case::{Level, Refinement};
use gudgeon_scene::{Asked, Checked, MethodSetting};

/// What is said of a case without numerical settings.
const AS_IT_STANDS: &str = "as it stands";

/// Settings of a case along what it declares, each as the changes of the case; one setting where it declares nothing.
pub fn ladder(case: &Checked, label: &str, idle: &[&str]) -> Vec<MethodSetting> {
    let all = case.case.refinements().into_iter().filter(|g| !idle.contains(&g.what.as_str()));
    let (tolerances, grids): (Vec<_>, Vec<_>) = all.partition(|g| g.own.asked.is_some());
    let mut groups: Vec<Vec<Refinement>> = tolerances.into_iter().map(|t| vec![t]).collect();
    if !grids.is_empty() {
        groups.insert(0, grids);
    }
    if groups.is_empty() {
        let method = if label.is_empty() { AS_IT_STANDS } else { label };
        return vec![MethodSetting {
            method: method.into(),
            setting: AS_IT_STANDS.into(),
            is_default: true,
            ..MethodSetting::default()
        }];
    }
    let several = groups.len() > 1;
    groups.iter().flat_map(|g| rungs(case, g, label, several)).collect()
}

/// One ladder: the groups of settings that are refined together.
fn rungs(case: &Checked, groups: &[Refinement], label: &str, several: bool) -> Vec<MethodSetting> {
    let what: Vec<&str> = groups.iter().map(|g| g.what.as_str()).collect();
    let what = what.join(" and ");
    let method = match (label.is_empty(), several) {
        (true, _) => what,
        (false, true) => format!("{label}, {what}"),
        (false, false) => label.to_owned(),
    };
    let coarsest = groups.iter().map(|g| g.coarser.len()).max().unwrap_or(0) as i32;
    // The finest level is that of references.
    let finest = (finest_level(case, groups) - 1).max(0);
    let tight = if several { finer(case, groups).0 } else { Vec::new() };
    (-coarsest..=finest)
        .map(|k| {
            let (set, words) = at(groups, k);
            let asked = groups.iter().filter_map(|g| level(g, k).asked).reduce(f64::max);
            MethodSetting {
                method: method.clone(),
                setting: words,
                is_default: k == 0,
                set,
                asked: asked.map(|tolerance| Asked { tolerance, against: tight.clone(), told_by: None }),
            }
        })
        // A case may refuse what is too coarse for it.
        .filter(|s| s.is_default || case.with(&s.set).is_ok())
        .collect()
}

/// A group at a level, at its last one where it has no more.
fn level(group: &Refinement, k: i32) -> &Level {
    let nth = |levels: &[Level]| levels.len().min(k.unsigned_abs() as usize).checked_sub(1);
    let found = if k < 0 { nth(&group.coarser).map(|i| &group.coarser[i]) } else { None };
    let found = if k > 0 { nth(&group.levels).map(|i| &group.levels[i]) } else { found };
    found.unwrap_or(&group.own)
}

/// All groups at a level: their changes, and in words.
fn at(groups: &[Refinement], k: i32) -> (Vec<String>, String) {
    let levels: Vec<&Level> = groups.iter().map(|g| level(g, k)).collect();
    let words: Vec<&str> = levels.iter().map(|l| l.words.as_str()).collect();
    (levels.iter().flat_map(|l| l.set.clone()).collect(), words.join(", "))
}

/// The finest settings that a case admits, with their words.
pub fn finer(case: &Checked, groups: &[Refinement]) -> (Vec<String>, String) {
    at(groups, finest_level(case, groups))
}

/// The settings one level below the finest.
pub fn less_fine(case: &Checked, groups: &[Refinement]) -> (Vec<String>, String) {
    at(groups, (finest_level(case, groups) - 1).max(0))
}

/// The finest level that a case admits.
fn finest_level(case: &Checked, groups: &[Refinement]) -> i32 {
    let most = groups.iter().map(|g| g.levels.len()).max().unwrap_or(0) as i32;
    (0..=most).rev().find(|k| case.with(&at(groups, *k).0).is_ok()).unwrap_or(0)
}
