//! What a study says: how results depend on its inputs, by what its design was made for.

use serde::Serialize;

use super::folder::Study;
use super::linear::{Linear, is_auxiliary, of_row};
use super::table::{Table, Values};
use crate::anova::{Anova, Blocks, anova};
use crate::sampling::{Design, Morris, OneAtATime, Saltelli};
use crate::sensitivity::{
    Band, Bootstrap, ElementaryEffects, MainEffect, SobolIndices, Tornado, band, elementary_effects,
    main_effects, sobol_indices, tornado,
};

/// What a study says of its results. Points that failed or are marked take no part.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Analysis {
    /// What is varied, in the order in which effects number it.
    pub inputs: Vec<String>,
    /// What the results of each group of points say. A design is repeated for every case and every row of a list: each is a group of its own. A
    /// grid is one group, in which cases and rows are factors.
    pub groups: Vec<Group>,
}

/// The points of one case and one row of the list, or of a whole grid.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Group {
    /// The case, and the row of the list where there is one; empty where there is one group alone.
    pub name: String,
    /// By result.
    pub results: Vec<Finding>,
}

/// What is known of one result.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Finding {
    /// Its name.
    pub result: String,
    /// Its unit.
    pub unit: String,
    /// What it depends on.
    pub dependence: Dependence,
}

/// On what a result depends.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Dependence {
    /// How far each input alone moves it.
    Tornado(Tornado),
    /// Elementary effects of each input, over its whole range.
    Morris(Vec<ElementaryEffects>),
    /// First-order and total Sobol indices.
    Sobol(SobolIndices),
    /// How the result spreads, and how its mean follows each input.
    Sample {
        /// Its spread.
        band: Band,
        /// By input.
        effects: Vec<MainEffect>,
    },
    /// Spread and shares to first order.
    Linear(Linear),
    /// Shares of the variance over a grid.
    Shares(GridShares),
    /// Why it is not known.
    Unknown(String),
}

/// Shares of the variance over a grid, or over the largest full grid among the points that have the result.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GridShares {
    /// The shares.
    #[serde(flatten)]
    pub anova: Anova,
    /// Points that they are calculated from.
    pub points: usize,
    /// Levels that are left out, `engine.speed=2800 rpm`, because not all points with them have the result.
    pub left_out: Vec<String>,
}

impl GridShares {
    /// What they do not rest on, in words; nothing where every point has the result.
    #[must_use]
    pub fn without(&self) -> Option<String> {
        let levels = self.left_out.join(", ");
        (!levels.is_empty()).then(|| format!("without {levels}: not all points with it have a result to use"))
    }
}

/// Resamples of the bootstrap of Sobol indices.
const RESAMPLES: usize = 1000;

impl Study {
    /// What the rows of this study say. All rows must be there.
    #[must_use]
    pub fn analyse(&self, table: &Table) -> Analysis {
        let own = self.record.study.inputs.len();
        let rows = self.record.list.as_ref().map_or(1, |l| l.rows.len());
        let inputs: Vec<String> = self.plan.varied.iter().map(|v| v.path.clone()).collect();
        let names = result_columns(table);
        let Some(design) = &self.record.study.design else {
            let factors = self.factors(&inputs);
            let mut blocks = Blocks::new(factors.iter().map(|(_, levels)| levels.len()).collect());
            let of = |n: &String| finding(table, n, 0..table.rows(), |y| over_grid(&factors, &mut blocks, y));
            let results = names.iter().map(of).collect();
            let inputs = factors.into_iter().map(|(name, _)| name).collect();
            return Analysis { inputs, groups: vec![Group { name: String::new(), results }] };
        };
        let inner = table.rows() / (rows * self.record.cases.len()).max(1);
        let groups = (0..rows * self.record.cases.len())
            .map(|g| {
                let case = &self.record.cases[g / rows].name;
                let name = match (self.record.cases.len(), rows) {
                    (1, 1) => String::new(),
                    (_, 1) => case.clone(),
                    _ => format!("{case}, row {}", g % rows + 1),
                };
                let paths = &inputs[inputs.len() - own..];
                let of = |n: &String| {
                    finding(table, n, g * inner..(g + 1) * inner, |y| match design {
                        Design::Linear {} if y.iter().any(|v| !v.is_finite()) => {
                            Err("the point failed or is marked".into())
                        }
                        Design::Linear {} => of_row(table, g, n, paths).map(Dependence::Linear),
                        _ => depends(design, own, y),
                    })
                };
                Group { name, results: names.iter().map(of).collect() }
            })
            .collect();
        Analysis { inputs: inputs[inputs.len() - own..].to_vec(), groups }
    }

    /// The factors of a grid with the names of their levels: cases, rows of the list, inputs.
    fn factors(&self, inputs: &[String]) -> Vec<Factor> {
        let own = &self.record.study.inputs;
        let cases = self.record.cases.iter().map(|c| c.name.clone()).collect();
        let rows =
            self.record.list.as_ref().map(|l| (1..=l.rows.len()).map(|k| format!("row {k}")).collect());
        let mut factors = vec![("case".to_owned(), cases)];
        factors.extend(rows.map(|rows| ("list".to_owned(), rows)));
        // They were legal when the study was made.
        let levels = own.iter().map(|i| i.grid().unwrap_or_default());
        factors.extend(inputs[inputs.len() - own.len()..].iter().cloned().zip(levels));
        factors
    }
}

/// A factor of a grid and the names of its levels.
type Factor = (String, Vec<String>);

/// The shares of a result over a grid; where points have no result, over the largest full grid among the others.
fn over_grid(factors: &[Factor], blocks: &mut Blocks, y: &[f64]) -> Result<Dependence, String> {
    let kept = blocks.largest(y.iter().map(|v| v.is_finite()).collect());
    let own: Vec<f64> = kept.combinations.iter().map(|k| y[*k]).collect();
    if own.is_empty() {
        return Err("no point has this result".into());
    }
    if own.len() == 1 && y.len() > 1 {
        return Err("too few points have this result to tell any input apart".into());
    }
    let levels: Vec<usize> = kept.levels.iter().map(Vec::len).collect();
    let anova = anova(&levels, &own, &vec![0.0; own.len()]).map_err(|e| e.to_string())?;
    let left_out = kept.levels_left_out(factors);
    Ok(Dependence::Shares(GridShares { anova, points: own.len(), left_out }))
}

/// Columns of results: the numbers behind the notes.
fn result_columns(table: &Table) -> Vec<String> {
    let after = table.columns.get_index_of("notes").map_or(0, |k| k + 1);
    let numbers = table.columns.iter().skip(after).filter(|(_, c)| matches!(c.values, Values::Numbers(_)));
    let numbers = numbers.filter(|(name, _)| !is_auxiliary(name));
    numbers.map(|(name, _)| name.clone()).collect()
}

/// Results of the points that went well: one that is marked, because its cycle is not periodic for example, is no result to draw conclusions from.
fn sound(table: &Table, mut results: Vec<f64>) -> Vec<f64> {
    if let Some(Values::Texts(codes)) = table.columns.get("code").map(|c| &c.values) {
        let marked = codes.iter().map(|c| c.as_deref().is_some_and(|c| !c.is_empty()));
        for (value, _) in results.iter_mut().zip(marked).filter(|(_, marked)| *marked) {
            *value = f64::NAN;
        }
    }
    results
}

fn finding(
    table: &Table,
    name: &str,
    rows: std::ops::Range<usize>,
    f: impl FnOnce(&[f64]) -> Result<Dependence, String>,
) -> Finding {
    let all = sound(table, table.numbers(name).unwrap_or_default());
    let dependence = f(&all[rows]).unwrap_or_else(Dependence::Unknown);
    let unit = table.columns.get(name).map_or_else(String::new, |c| c.unit.clone());
    Finding { result: name.to_owned(), unit, dependence }
}

/// What the results of the points of a design of `d` inputs say.
fn depends(design: &Design, d: usize, y: &[f64]) -> Result<Dependence, String> {
    let told = |e: crate::sensitivity::NoFigure| e.to_string();
    let illegal = |e: gudgeon_core::BuildError| e.message;
    match *design {
        Design::OneAtATime { low, high } => {
            let design = OneAtATime::new(d, low, high).map_err(illegal)?;
            tornado(&design, y).map(Dependence::Tornado).map_err(told)
        }
        Design::Morris { trajectories, levels, seed } => {
            let design = Morris::new(trajectories, d, levels, seed).map_err(illegal)?;
            elementary_effects(&design, y).map(Dependence::Morris).map_err(told)
        }
        Design::Saltelli { base, seed } => {
            let design = Saltelli::new(base, d, seed).map_err(illegal)?;
            sobol_indices(&design, y, Bootstrap { resamples: RESAMPLES, seed })
                .map(Dependence::Sobol)
                .map_err(told)
        }
        Design::Linear {} => Err("derivatives stand in the row of a point".into()),
        Design::LatinHypercube { .. } | Design::Sobol { .. } => {
            let points = design.points(d).map_err(illegal)?;
            let all: Vec<Vec<f64>> = (0..points.len()).map(|k| points.point(k)).collect();
            let effects = main_effects(&all, y).map_err(told)?;
            Ok(Dependence::Sample { band: band(y).map_err(told)?, effects })
        }
    }
}
