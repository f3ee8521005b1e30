//! Figures of a study: tornado plots, indices with their intervals, shares, curves and maps.

use gudgeon_core::result::{Bar, Column, Figure, FigureKind, Lines, Range, Series};
use indexmap::IndexMap;

use super::analysis::{Analysis, Dependence, Finding};
use super::folder::Study;
use super::input::Input;
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
                let words = in_words(&f.result);
                let title = if group.name.is_empty() { words } else { format!("{}: {words}", group.name) };
                for (figure, series) in self.over_the_grid(table, f) {
                    tables.insert(figure.table.clone(), series);
                    figures.push(figure);
                }
                figures.extend(of_finding(&analysis.inputs, &title, f));
            }
        }
        (figures, tables)
    }

    /// A result over the inputs of a grid: curves over the one that runs fastest where they are few, and a map where there are two inputs.
    fn over_the_grid(&self, table: &Table, f: &Finding) -> Vec<(Figure, Series)> {
        let Some(grid) = Grid::new(self, table, f) else { return Vec::new() };
        grid.curves(table, self.record.cases.len()).into_iter().chain(grid.map(table)).collect()
    }
}

/// A result on a full grid, the last input the fastest.
struct Grid<'a> {
    inputs: &'a [Input],
    f: &'a Finding,
    /// Values of the last input at all points.
    x: Vec<f64>,
    /// The result at all points.
    y: Vec<f64>,
    /// Values of the last input.
    n: usize,
}

impl<'a> Grid<'a> {
    fn new(study: &'a Study, table: &Table, f: &'a Finding) -> Option<Self> {
        let inputs = &study.record.study.inputs;
        let last = inputs.last().filter(|_| study.record.study.design.is_none())?;
        let n = last.grid().ok().map(|v| v.len()).filter(|n| *n >= 2)?;
        let (x, y) = (table.numbers(&last.axis.path)?, table.numbers(&f.result)?);
        Some(Self { inputs, f, x, y, n })
    }

    fn path(&self) -> &str {
        self.inputs.last().map_or("", |i| i.axis.path.as_str())
    }

    fn axis(table: &Table, name: &str, values: Vec<f64>) -> Column {
        let unit = table.columns.get(name).map_or_else(String::new, |c| c.unit.clone());
        Column { name: name.to_owned(), unit, values }
    }

    fn column(&self, name: String, values: Vec<f64>) -> Column {
        Column { name, unit: self.f.unit.clone(), values }
    }

    fn figure(&self, what: &str, over: &str, kind: FigureKind) -> Figure {
        Figure {
            title: in_words(&self.f.result),
            hint: format!("over {over}"),
            table: format!("{what} of {}", self.f.result),
            kind,
        }
    }

    fn curves(&self, table: &Table, cases: usize) -> Option<(Figure, Series)> {
        let (n, x) = (self.n, self.path());
        let others = self.y.len() / n;
        if others > FEW {
            return None;
        }
        let labels: Vec<String> =
            (0..others).map(|k| label(table, cases, self.inputs.len(), k * n, x)).collect();
        let columns = labels.iter().enumerate();
        let columns =
            columns.map(|(k, l)| self.column(l.clone(), self.y[k * n..(k + 1) * n].to_vec())).collect();
        let series = Series { axis: Self::axis(table, x, self.x[..n].to_vec()), columns };
        let lines = labels.iter().map(|l| (l.clone(), l.clone())).collect();
        let kind = FigureKind::Lines(Lines { x: x.to_owned(), lines, ..Lines::default() });
        Some((self.figure("grid", x, kind), series))
    }

    fn map(&self, table: &Table) -> Option<(Figure, Series)> {
        let [second, last] = self.inputs else { return None };
        let other = &second.axis.path;
        let count = second.grid().map_or(0, |v| v.len());
        let ys = table.numbers(other).filter(|_| count >= 2 && self.y.len() == count * self.n)?;
        let columns = vec![Self::axis(table, other, ys), self.column(self.f.result.clone(), self.y.clone())];
        let kind =
            FigureKind::Map { x: last.axis.path.clone(), y: other.clone(), value: self.f.result.clone() };
        let over = format!("{} and {other}", last.axis.path);
        Some((
            self.figure("map", &over, kind),
            Series { axis: Self::axis(table, &last.axis.path, self.x.clone()), columns },
        ))
    }
}

/// A name of a result for people: `land2.p_max` becomes `land2, p max`.
fn in_words(name: &str) -> String {
    name.replace('.', ", ").replace('_', " ")
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
