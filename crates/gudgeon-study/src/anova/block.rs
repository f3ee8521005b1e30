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

impl Kept {
    /// Levels that are not kept, `factor=level`. `factors` are the names of the factors, each with those of its levels.
    #[must_use]
    pub fn levels_left_out(&self, factors: &[(String, Vec<String>)]) -> Vec<String> {
        let of = |((name, levels), kept): (&(String, Vec<String>), &Vec<usize>)| {
            let gone = (0..levels.len()).filter(|l| !kept.contains(l));
            gone.map(|l| format!("{name}={}", levels[l])).collect::<Vec<_>>()
        };
        factors.iter().zip(&self.levels).flat_map(of).collect()
    }
}

/// Largest full blocks of one table, for many results: most of them miss the same combinations.
#[derive(Debug, Clone)]
pub struct Blocks {
    levels: Vec<usize>,
    known: Vec<(Vec<bool>, Kept)>,
}

impl Blocks {
    /// A table of factors with these numbers of levels.
    #[must_use]
    pub const fn new(levels: Vec<usize>) -> Self {
        Self { levels, known: Vec::new() }
    }

    /// As [`largest_full_block`].
    pub fn largest(&mut self, there: Vec<bool>) -> Kept {
        if let Some((_, kept)) = self.known.iter().find(|(known, _)| *known == there) {
            return kept.clone();
        }
        let kept = largest_full_block(&self.levels, &there);
        self.known.push((there, kept.clone()));
        kept
    }
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
    let mut missing: Vec<usize> = (0..there.len()).filter(|c| !there[*c]).collect();
    while !missing.is_empty() {
        let size: usize = kept.iter().map(Vec::len).product();
        // Part that is missing, factor, place of the level, stride of the factor.
        let mut worst = (0.0, 0, 0, 1);
        let mut stride = levels.iter().product::<usize>();
        for (f, n) in levels.iter().enumerate() {
            stride /= n;
            let mut of_level = vec![0_usize; *n];
            missing.iter().for_each(|c| of_level[c / stride % n] += 1);
            for (place, level) in kept[f].iter().enumerate().filter(|_| kept[f].len() > 1) {
                let part = of_level[*level] as f64 / (size / kept[f].len()) as f64;
                if part >= worst.0 {
                    worst = (part, f, place, stride);
                }
            }
        }
        let (_, f, place, stride) = worst;
        let gone = kept[f].remove(place);
        missing.retain(|c| c / stride % levels[f] != gone);
    }
    kept
}
