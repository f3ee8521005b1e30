//! Where combinations are missing: the largest part of the table that is full.

use serde::Serialize;

/// Levels that are kept.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct Kept {
    /// Of every factor, the levels that are kept, ascending.
    pub levels: Vec<Vec<usize>>,
    /// Numbers of the combinations of these levels, ascending.
    pub combinations: Vec<usize>,
    /// Combinations that have a result and are left out with their levels.
    pub left_out: usize,
}

/// Most choices of levels that are tried; beyond, levels are dropped one after the other.
const MAX_TRIED: usize = 100_000;

/// The largest full factorial within a table of which some combinations are missing: levels are dropped from factors until every
/// combination of the others is there.
///
/// It keeps as many factors with more than one level as possible, then as many combinations, then the levels of the first factors, then the
/// first levels. Where the levels can be chosen in more than 100 000 ways, the level that misses most is dropped, again and again.
///
/// `levels` and the order of `there` are those of [`anova`](super::anova).
#[must_use]
pub fn largest_full_block(levels: &[usize], there: &[bool]) -> Kept {
    let present = there.iter().filter(|t| **t).count();
    let all: Vec<Vec<usize>> = levels.iter().map(|n| (0..*n).collect()).collect();
    let kept = if present == there.len() {
        all
    } else if present == 0 {
        vec![Vec::new(); levels.len()]
    } else if choices(levels) <= MAX_TRIED {
        best_choice(levels, there)
    } else {
        dropped(levels, there, all)
    };
    let combinations = combinations(levels, &kept);
    Kept { left_out: present.saturating_sub(combinations.len()), levels: kept, combinations }
}

/// Number of ways to keep at least one level of every factor.
fn choices(levels: &[usize]) -> usize {
    levels.iter().fold(1, |n: usize, l| {
        let own = 1_usize.checked_shl(*l as u32).map_or(usize::MAX, |k| k - 1);
        n.saturating_mul(own)
    })
}

/// Numbers of the combinations of some levels.
fn combinations(levels: &[usize], kept: &[Vec<usize>]) -> Vec<usize> {
    levels
        .iter()
        .zip(kept)
        .fold(vec![0], |all, (n, own)| all.iter().flat_map(|c| own.iter().map(move |l| c * n + l)).collect())
}

/// Tries every choice.
fn best_choice(levels: &[usize], there: &[bool]) -> Vec<Vec<usize>> {
    let mut best = (0, 0, Vec::new());
    let mut choice: Vec<usize> = levels.iter().map(|n| (1 << n) - 1).collect();
    loop {
        let kept: Vec<Vec<usize>> = choice
            .iter()
            .zip(levels)
            .map(|(bits, n)| (0..*n).filter(|l| bits >> (n - 1 - l) & 1 == 1).collect())
            .collect();
        let free = kept.iter().filter(|k| k.len() > 1).count();
        let size = kept.iter().map(Vec::len).product();
        // The first levels have the highest bits, and bits count down: of equal choices the one that keeps them comes first.
        if (free, size) > (best.0, best.1) && combinations(levels, &kept).iter().all(|c| there[*c]) {
            best = (free, size, kept);
        }
        let Some(next) = (0..choice.len()).rev().find(|f| choice[*f] > 1) else { return best.2 };
        choice[next] -= 1;
        for f in next + 1..choice.len() {
            choice[f] = (1 << levels[f]) - 1;
        }
    }
}

/// Drops the level that misses the largest part of its combinations until none is missing.
fn dropped(levels: &[usize], there: &[bool], mut kept: Vec<Vec<usize>>) -> Vec<Vec<usize>> {
    loop {
        let all = combinations(levels, &kept);
        let missing: Vec<usize> = all.iter().copied().filter(|c| !there[*c]).collect();
        if missing.is_empty() {
            return kept;
        }
        let mut worst = (0.0, 0, 0);
        let mut stride = levels.iter().product::<usize>();
        for (f, n) in levels.iter().enumerate() {
            stride /= n;
            for (place, level) in kept[f].iter().enumerate().filter(|_| kept[f].len() > 1) {
                let own = missing.iter().filter(|c| *c / stride % n == *level).count();
                let part = own as f64 / (all.len() / kept[f].len()) as f64;
                if part >= worst.0 {
                    worst = (part, f, place);
                }
            }
        }
        kept[worst.1].remove(worst.2);
    }
}
