//! Figures of a study: tornado plots, indices with their intervals, shares, curves and maps.

use gudgeon_core::result::{Bar, Column, Figure, FigureKind, Lines, Range, Series};
use indexmap::IndexMap;

use super::analysis::{Analysis, Dependence, Finding};
use super::folder::Study;
use super::table::{Table, Values};

/// Most curves of one figure; with more combinations a grid of two inputs is a map.
const FEW: usize = 8;

impl Study {
    /// Figures of what the results depend on, and the tables that they read.
    #[must_use]
    pub fn figures(&self, table: &Table, analysis: &Analysis) -> (Vec<Figure>, IndexMap<String, Series>) {
        let mut figures = Vec::new();
        let mut tables = IndexMap::new();
        for group in &analysis.groups {
            for f in &group.results {
                let title = if group.name.is_empty() {
                    f.result.clone()
                } else {
                    format!("{}: {}", group.name, f.result)
                };
                if let Some((figure, series)) = self.over_the_grid(table, f) {
                    tables.insert(figure.table.clone(), series);
                    figures.push(figure);
                }
                figures.extend(of_finding(&analysis.inputs, &title, f));
            }
        }
        (figures, tables)
    }

    /// A result over the inputs of a grid: curves over the one that runs fastest, or a map over two.
    fn over_the_grid(&self, table: &Table, f: &Finding) -> Option<(Figure, Series)> {
        let inputs = &self.record.study.inputs;
        let last = inputs.last().filter(|_| self.record.study.design.is_none())?;
        let (n, x) = (last.grid().ok()?.len(), &last.axis.path);
        let (xs, y) = (table.numbers(x)?, table.numbers(&f.result)?);
        let others = y.len() / n;
        if n < 2 {
            return None;
        }
        let axis = |name: &str, values: Vec<f64>| {
            let unit = table.columns.get(name).map_or_else(String::new, |c| c.unit.clone());
            Column { name: name.to_owned(), unit, values }
        };
        let column = |name: String, values: Vec<f64>| Column { name, unit: f.unit.clone(), values };
        let figure = |kind| Figure {
            title: f.result.clone(),
            hint: format!("over {x}"),
            table: format!("grid of {}", f.result),
            kind,
        };
        if others <= FEW {
            let labels: Vec<String> =
                (0..others).map(|k| label(table, self.record.cases.len(), inputs.len(), k * n, x)).collect();
            let columns =
                labels.iter().enumerate().map(|(k, l)| column(l.clone(), y[k * n..(k + 1) * n].to_vec()));
            let series = Series { axis: axis(x, xs[..n].to_vec()), columns: columns.collect() };
            let lines = labels.iter().map(|l| (l.clone(), l.clone())).collect();
            let kind = FigureKind::Lines(Lines { x: x.clone(), lines, ..Lines::default() });
            return Some((figure(kind), series));
        }
        let [second, _] = &inputs[..] else { return None };
        let ys =
            table.numbers(&second.axis.path).filter(|_| others == second.grid().map_or(0, |v| v.len()))?;
        let columns = vec![axis(&second.axis.path, ys), column(f.result.clone(), y)];
        let kind = FigureKind::Map { x: x.clone(), y: second.axis.path.clone(), value: f.result.clone() };
        Some((figure(kind), Series { axis: axis(x, xs), columns }))
    }
}

/// What tells the points of a curve from those of others: the case where there are several, and inputs but the one along it.
fn label(table: &Table, cases: usize, inputs: usize, row: usize, along: &str) -> String {
    let first = if cases > 1 { 1 } else { 2 };
    let outer = table.columns.iter().take(inputs + 2).skip(first).filter(|(name, _)| *name != along);
    let text = |(name, c): (&String, &super::table::Column)| match &c.values {
        Values::Texts(_) => c.values.text(row),
        _ => format!("{} {} {}", name.rsplit('.').next().unwrap_or(name), c.values.text(row), c.unit),
    };
    outer.map(text).collect::<Vec<_>>().join(", ").trim().to_owned()
}

/// The figure of a finding.
fn of_finding(inputs: &[String], title: &str, f: &Finding) -> Option<Figure> {
    let name = |k: usize| inputs[k].clone();
    let figure = |hint: &str, kind| {
        Some(Figure { title: title.to_owned(), hint: hint.into(), table: String::new(), kind })
    };
    let bars = |all: Vec<(String, f64)>| FigureKind::Bars {
        unit: String::new(),
        bars: all.into_iter().map(|(label, value)| Bar { label, value, limit: None }).collect(),
    };
    match &f.dependence {
        Dependence::Tornado(t) => {
            let range = |s: &crate::sensitivity::Swing| Range {
                label: name(s.input),
                low: s.low,
                high: s.high,
                value: None,
            };
            let ranges = t.swings.iter().map(range).collect();
            figure(
                "each input alone at its low (green) and its high quantile (blue), the others at their medians",
                FigureKind::Ranges { unit: f.unit.clone(), middle: t.middle, ranges },
            )
        }
        Dependence::Morris(effects) => figure(
            "mean magnitude of the elementary effects, mu*, over the whole range of each input",
            FigureKind::Bars {
                unit: f.unit.clone(),
                bars: effects
                    .iter()
                    .enumerate()
                    .map(|(k, e)| Bar { label: name(k), value: e.mu_star, limit: None })
                    .collect(),
            },
        ),
        Dependence::Sobol(s) => {
            let range = |(k, i): (usize, &crate::sensitivity::SobolIndex)| Range {
                label: name(k),
                low: Some(i.total.low),
                high: Some(i.total.high),
                value: Some(i.total.value),
            };
            let ranges = s.inputs.iter().enumerate().map(range).collect();
            figure(
                "total Sobol indices with their intervals",
                FigureKind::Ranges { unit: String::new(), middle: None, ranges },
            )
        }
        Dependence::Sample { effects, .. } => {
            let all = effects.iter().enumerate().map(|(k, e)| (name(k), e.share)).collect();
            figure("share of the variance that the mean over each input explains", bars(all))
        }
        Dependence::Linear(l) => {
            let range = |(k, p): (usize, &super::linear::Part)| {
                let end = |sign: f64| Some(l.value + sign * p.effect).filter(|v| v.is_finite());
                Range { label: name(k), low: end(-1.0), high: end(1.0), value: None }
            };
            let ranges = l.inputs.iter().enumerate().map(range).collect();
            figure(
                "to first order: each input a standard deviation lower (green) and higher (blue)",
                FigureKind::Ranges { unit: f.unit.clone(), middle: Some(l.value), ranges },
            )
        }
        Dependence::Shares(s) => {
            let factors =
                |e: &crate::anova::Effect| e.factors.iter().map(|k| name(*k)).collect::<Vec<_>>().join(" × ");
            let without = s.without().map_or_else(String::new, |w| format!("; {w}"));
            figure(
                &format!("share of the variance over the grid{without}"),
                bars(s.anova.effects.iter().map(|e| (factors(e), e.share)).collect()),
            )
        }
        Dependence::Unknown(_) => None,
    }
}
