//! Shares of the swaps, the cases and their interactions in the variance of every result of a comparison.
//!
//! A result of a case is taken relative to that case: `100 (y - m) / s` with the mean `m` and the mean magnitude `s` over the combinations of
//! the case, in per cent. Angles are shifts from the mean in degrees. The shares of one case do not depend on that; of several cases together,
//! each counts by how much its results change in proportion, whatever their size, and `case` alone explains nothing. How much of the variance
//! of the values themselves it explains is told apart.

use gudgeon_core::result::{
    CASE, Comparison, NoteLevel, RunResult, Share, ShareRow, ShareTable, Variant, short_value,
};
use indexmap::IndexMap;

use super::{findings, short};
use crate::anova::{Anova, Blocks, anova};

/// Numerical uncertainty that is assumed where nobody asked for it, as a part of the mean magnitude: what the default settings of the shipped
/// cases keep (`gudgeon bench`).
const ASSUMED: f64 = 1e-3;

/// The same for an angle \[deg\]. A smooth extreme whose value is known to a part `e` is found to about `√e` radians.
const ASSUMED_ANGLE: f64 = 1.8;

/// One engine cycle \[deg\]: angles are compared around it.
const CYCLE: f64 = 720.0;

/// Shares of all cases together, and of each; none where there is no more than one choice. `headlines` are the results that a reader looks at
/// first; none stands for those of the whole scene, whose names have no point.
///
/// A run whose results are not what was asked for (a cycle that is not periodic) is left out like one that failed. Where combinations are
/// missing, the largest full factorial among the others is taken, for each result anew, and the levels that it leaves out are named.
#[must_use]
pub fn shares(c: &Comparison, headlines: &[String]) -> Vec<ShareTable> {
    let counts: Vec<usize> = c.swaps.iter().map(|(_, values)| values.len()).collect();
    let choices = counts.iter().filter(|n| **n > 1).count();
    if choices + usize::from(c.cases.len() > 1) < 2 || choices == 0 {
        return Vec::new();
    }
    let scope = |case: Option<usize>| {
        let variants = c.variants.iter().filter(|v| case.is_none_or(|k| v.case == k)).collect();
        Scope { comparison: c, case, variants }.table(headlines)
    };
    let own = || (0..c.cases.len()).map(Some).filter(|_| choices > 1);
    match c.cases.len() {
        1 => own().map(scope).collect(),
        _ => std::iter::once(None).chain(own()).map(scope).collect(),
    }
}

/// The variants of one case, or of all.
struct Scope<'a> {
    comparison: &'a Comparison,
    case: Option<usize>,
    variants: Vec<&'a Variant>,
}

/// A result of a variant that is what was asked for.
fn good(v: &Variant) -> Option<&RunResult> {
    let failed = |r: &&RunResult| !r.solver.notes.iter().any(|n| n.level == NoteLevel::Failure);
    v.outcome.as_ref().ok().filter(failed)
}

impl Scope<'_> {
    /// Names of the factors and of their levels.
    fn factors(&self) -> Vec<Factor> {
        let cases = || self.comparison.cases.iter().map(|c| c.name.clone()).collect();
        let swaps = self.comparison.swaps.iter().map(|(p, v)| {
            let values = v.iter().map(|v| short_value(v)).collect();
            (short(p).to_owned(), values)
        });
        self.case.is_none().then(|| (CASE.to_owned(), cases())).into_iter().chain(swaps).collect()
    }

    fn table(&self, headlines: &[String]) -> ShareTable {
        let mut grid = Grid::new(self.factors());
        // Each value is taken relative to its case: alone it explains nothing.
        grid.effects.retain(|e| self.case.is_some() || *e != [0]);
        let mut names: IndexMap<&str, (&str, &str)> = IndexMap::new();
        for (name, v) in self.variants.iter().filter_map(|v| good(v)).flat_map(|r| &r.results) {
            names.entry(name).or_insert((&v.unit, &v.what));
        }
        let no_headlines = !names.keys().any(|n| is_headline(n));
        let mut rows: Vec<ShareRow> = Vec::new();
        for (name, (unit, what)) in names {
            let Some(mut row) = self.row(name, unit, &mut grid) else { continue };
            what.clone_into(&mut row.what);
            row.headline = match headlines {
                [] => no_headlines || is_headline(name),
                chosen => chosen.iter().any(|c| c == name),
            };
            row.same_as =
                rows.iter().find(|r| row.headline && r.headline && same(r, &row)).map(|r| r.result.clone());
            rows.push(row);
        }
        let mut table = ShareTable {
            case: self.case.map(|k| self.comparison.cases[k].name.clone()),
            factors: grid.factors.into_iter().map(|(name, _)| name).collect(),
            effects: grid.effects,
            verified: self.variants.iter().filter_map(|v| good(v)).all(|r| r.verification.is_some()),
            rows,
            findings: Vec::new(),
        };
        table.findings = findings::findings(&table);
        table
    }

    fn row(&self, name: &str, unit: &str, grid: &mut Grid) -> Option<ShareRow> {
        let of = |v: &&Variant| {
            let run = good(v)?;
            let value = run.results.get(name).filter(|r| r.unit == unit && r.value.is_finite())?.value;
            let known = run.verification.as_ref().and_then(|w| w.uncertainty.get(name)).copied();
            Some(Number { value, known, case: v.case })
        };
        let numbers: Vec<Option<Number>> = self.variants.iter().map(of).collect();
        let there: Vec<bool> = numbers.iter().map(Option::is_some).collect();
        let kept = grid.blocks.largest(there);
        let numbers: Vec<Number> = kept.combinations.iter().filter_map(|k| numbers[*k]).collect();
        if numbers.is_empty() {
            return None;
        }
        let own: Vec<usize> = kept.levels.iter().map(Vec::len).collect();
        let sample = Sample::new(numbers, unit == "deg");
        let relative = anova(&own, &sample.relative, &sample.uncertainty).ok()?;
        let absolute = || anova(&own, &sample.values, &vec![0.0; sample.values.len()]).ok();
        Some(ShareRow {
            result: name.to_owned(),
            unit: unit.to_owned(),
            mean: self.case.is_some().then(|| mean(&sample.values)),
            spread: relative.variance.sqrt(),
            spread_unit: if unit == "deg" { "deg" } else { "%" }.to_owned(),
            shares: grid.effects.iter().map(|e| share(&relative, e)).collect(),
            between_cases: self
                .case
                .is_none()
                .then(absolute)
                .flatten()
                .and_then(|a| Some(share(&a, &[0])?.share)),
            combinations: kept.combinations.len(),
            left_out: kept.levels_left_out(&grid.factors),
            ..ShareRow::default()
        })
    }
}

/// A choice and the names of its levels.
type Factor = (String, Vec<String>);

/// The choices, and what has been found out about them.
struct Grid {
    factors: Vec<Factor>,
    effects: Vec<Vec<usize>>,
    blocks: Blocks,
}

impl Grid {
    fn new(factors: Vec<Factor>) -> Self {
        let levels: Vec<usize> = factors.iter().map(|(_, levels)| levels.len()).collect();
        let flat = vec![0.0; levels.iter().product()];
        let all = anova(&levels, &flat, &flat).map(|a| a.effects).unwrap_or_default();
        let effects = all.into_iter().map(|e| e.factors).collect();
        Self { factors, effects, blocks: Blocks::new(levels) }
    }
}

/// Whether a result is one of the whole scene, not of a part of it, and not a measure of the numerics.
fn is_headline(name: &str) -> bool {
    !name.contains('.') && !name.ends_with("_error")
}

/// A result of one combination.
#[derive(Debug, Clone, Copy)]
struct Number {
    value: f64,
    /// Its numerical uncertainty, where it was found.
    known: Option<f64>,
    case: usize,
}

/// The results of a full block of combinations.
struct Sample {
    /// As they are; angles without jumps.
    values: Vec<f64>,
    /// Relative to their cases.
    relative: Vec<f64>,
    /// Uncertainties of `relative`.
    uncertainty: Vec<f64>,
}

impl Sample {
    fn new(numbers: Vec<Number>, angle: bool) -> Self {
        let first = numbers[0].value;
        let straight = |v: f64| {
            if angle { first + (v - first + 0.5 * CYCLE).rem_euclid(CYCLE) - 0.5 * CYCLE } else { v }
        };
        let values: Vec<f64> = numbers.iter().map(|n| straight(n.value)).collect();
        let (mut relative, mut uncertainty) = (Vec::new(), Vec::new());
        for (k, n) in numbers.iter().enumerate() {
            let own: Vec<f64> =
                (0..values.len()).filter(|j| numbers[*j].case == n.case).map(|j| values[j]).collect();
            let magnitude = own.iter().map(|v| v.abs()).sum::<f64>() / own.len() as f64;
            // Per cent of nothing is nothing.
            let scale = match angle {
                true => 1.0,
                false if magnitude > 0.0 => 100.0 / magnitude,
                false => 0.0,
            };
            relative.push((values[k] - mean(&own)) * scale);
            uncertainty.push(match n.known {
                Some(u) => u * scale,
                None if angle => ASSUMED_ANGLE,
                None => ASSUMED * magnitude * scale,
            });
        }
        Self { values, relative, uncertainty }
    }
}

fn mean(y: &[f64]) -> f64 {
    y.iter().sum::<f64>() / y.len().max(1) as f64
}

fn share(a: &Anova, effect: &[usize]) -> Option<Share> {
    let e = a.effects.iter().find(|e| e.factors == effect)?;
    Some(Share { share: e.share, largest: e.largest, within_numerics: e.within_numerics })
}

/// Whether two results are one up to a factor.
fn same(a: &ShareRow, b: &ShareRow) -> bool {
    // Rounding of products, far below anything that is printed.
    let close = |x: f64, y: f64| (x - y).abs() <= 1e-9 * x.abs().max(y.abs()).max(1e-3);
    let shares = |(x, y): (&Option<Share>, &Option<Share>)| match (x, y) {
        (Some(x), Some(y)) => close(x.share, y.share),
        (x, y) => x.is_none() && y.is_none(),
    };
    a.spread > 0.0 && close(a.spread, b.spread) && a.shares.iter().zip(&b.shares).all(shares)
}
