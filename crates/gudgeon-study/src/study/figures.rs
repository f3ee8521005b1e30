//! Figures of a study: tornado plots, indices with their intervals, shares, curves and maps.

use gudgeon_core::result::{Bar, Column, Figure, FigureKind, Lines, Mark, Range, Series};
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
        let inputs: Vec<String> = analysis.inputs.iter().map(|i| input_in_words(i)).collect();
        for group in &analysis.groups {
            for f in &group.results {
                let words = result_in_words(table, &f.result);
                let title = if group.name.is_empty() { words } else { format!("{}: {words}", group.name) };
                for (figure, series) in self.over_the_grid(table, f) {
                    tables.insert(figure.table.clone(), series);
                    figures.push(figure);
                }
                figures.extend(of_finding(&inputs, &title, f));
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

    /// The values of an input, named in words.
    fn axis(table: &Table, path: &str, values: Vec<f64>) -> Column {
        let unit = table.columns.get(path).map_or_else(String::new, |c| c.unit.clone());
        Column { name: input_in_words(path), unit, values }
    }

    fn column(&self, name: String, values: Vec<f64>) -> Column {
        Column { name, unit: self.f.unit.clone(), values }
    }

    fn figure(&self, table: &Table, what: &str, over: &str, kind: FigureKind) -> Figure {
        Figure {
            title: result_in_words(table, &self.f.result),
            hint: format!("{} over {over}", self.f.result),
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
        let over = input_in_words(x);
        let kind = FigureKind::Lines(Lines { x: over.clone(), lines, ..Lines::default() });
        Some((self.figure(table, "grid", &over, kind), series))
    }

    fn map(&self, table: &Table) -> Option<(Figure, Series)> {
        let [second, last] = self.inputs else { return None };
        let other = &second.axis.path;
        let count = second.grid().map_or(0, |v| v.len());
        let ys = table.numbers(other).filter(|_| count >= 2 && self.y.len() == count * self.n)?;
        let (along, across) = (input_in_words(&last.axis.path), input_in_words(other));
        let marks = marks(table, &self.x, &ys);
        let columns = vec![Self::axis(table, other, ys), self.column(self.f.result.clone(), self.y.clone())];
        let over = format!("{along} and {across}");
        let kind = FigureKind::Map { x: along, y: across, value: self.f.result.clone(), marks };
        Some((
            self.figure(table, "map", &over, kind),
            Series { axis: Self::axis(table, &last.axis.path, self.x.clone()), columns },
        ))
    }
}

/// Most reservations that are marked in a map.
const MARKED: usize = 4;

/// Points without a result, and those with a reservation that others do not have.
fn marks(table: &Table, x: &[f64], y: &[f64]) -> Vec<Mark> {
    let said = table.said();
    let ran = x.len() - said.iter().filter(|s| s.is_missing()).map(|s| s.rows.len()).sum::<usize>();
    let (missing, reserved): (Vec<_>, Vec<_>) = said.iter().partition(|s| s.is_missing());
    let some = reserved.into_iter().filter(|s| s.rows.len() < ran).take(MARKED);
    let point = |s: &super::notes::Said, row: usize| Mark::Point {
        x: x[row],
        y: y[row],
        weight: 0.0,
        beyond: s.is_missing(),
        label: match s.topic.as_str() {
            gudgeon_core::result::IMPOSSIBLE => "left out: cannot be".to_owned(),
            topic => in_words(topic),
        },
    };
    missing.into_iter().chain(some).flat_map(|s| s.rows.iter().map(move |row| point(s, *row))).collect()
}

/// What a result is, and its name where nothing says it.
fn result_in_words(table: &Table, name: &str) -> String {
    match table.columns.get(name).map(|c| c.what.as_str()) {
        None | Some("") => in_words(name),
        Some(what) => what.replace('`', ""),
    }
}

/// The path of an input for people: `rings.0.cold_gap` becomes `ring 1: cold gap`, `models.gas_flow.model` becomes `gas flow`.
fn input_in_words(path: &str) -> String {
    let mut words: Vec<String> = Vec::new();
    for step in path.split('.').filter(|s| *s != "models") {
        match (step.parse::<usize>(), words.last_mut()) {
            (Ok(k), Some(list)) => {
                let one = list.strip_suffix('s').unwrap_or(list).to_owned();
                *list = format!("{one} {}", k + 1);
            }
            _ => words.push(step.replace('_', " ")),
        }
    }
    if words.len() > 1 && words.last().is_some_and(|w| w == "model") {
        words.pop();
    }
    match words.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, before)) => format!("{}: {last}", before.join(", ")),
        None => path.to_owned(),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_are_named_in_words() {
        let named =
            ["rings.0.cold_gap", "engine.speed", "models.gas_flow.model", "rings.2.face.drop", "case"];
        let words = ["ring 1: cold gap", "engine: speed", "gas flow", "ring 3, face: drop", "case"];
        assert_eq!(named.map(input_in_words), words);
    }
}
