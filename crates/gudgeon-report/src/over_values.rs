//! Results of a comparison over the values of a swap that are numbers: a curve, or a map where two swaps are.

use gudgeon_core::result::{Column, Figure, FigureKind, Headline, Lines, Series};

use crate::number::capital;

/// A combination that ran: its choices by path, and its results by name with their units.
pub(crate) struct Point<'a> {
    /// Path and value of every choice.
    pub choices: Vec<(&'a str, &'a str)>,
    /// Value and unit of a result.
    pub result: &'a dyn Fn(&str) -> Option<(f64, &'a str)>,
}

/// Fewest values that make a curve.
const CURVE: usize = 3;
/// Most curves of a figure.
const CURVES: usize = 8;

/// A quantity as it stands in a case: `0.3 mm`, `1500 rpm`, `0.12`.
fn quantity(text: &str) -> Option<(f64, &str)> {
    let text = text.trim().trim_matches('"');
    let end = text
        .find(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | '-' | '+' | 'e' | 'E')))
        .unwrap_or(text.len());
    // `1e` of `1 eV` is no number.
    let number = text[..end].parse().ok()?;
    Some((number, text[end..].trim()))
}

/// The numbers of a swap in one unit, where it has only such.
fn numbers(values: &[String]) -> Option<(Vec<f64>, String)> {
    let all: Vec<(f64, &str)> = values.iter().map(|v| quantity(v)).collect::<Option<_>>()?;
    let unit = all.first()?.1;
    (all.len() >= CURVE && all.iter().all(|(_, u)| *u == unit))
        .then(|| (all.iter().map(|a| a.0).collect(), unit.to_owned()))
}

/// Figures of the headlines, with the tables that they read.
pub(crate) fn figures(
    swaps: &[(&str, &[String])],
    headlines: &[Headline],
    points: &[Point<'_>],
) -> Vec<(Figure, Series)> {
    let axes: Vec<(&str, Vec<f64>, String)> =
        swaps.iter().filter_map(|(path, values)| numbers(values).map(|(n, u)| (*path, n, u))).collect();
    match &axes[..] {
        [] => Vec::new(),
        [x, y] if swaps.len() == 2 => headlines.iter().filter_map(|h| map(x, y, h, points)).collect(),
        [x, ..] => headlines.iter().filter_map(|h| curves(x, h, points)).collect(),
    }
}

type Axis<'a> = (&'a str, Vec<f64>, String);

fn at(p: &Point<'_>, path: &str) -> Option<f64> {
    p.choices.iter().find(|c| c.0 == path).and_then(|c| quantity(c.1)).map(|q| q.0)
}

/// Values of a result at points of an axis, in the order of the axis; not a number where nothing ran.
fn curves((path, values, unit): &Axis<'_>, h: &Headline, points: &[Point<'_>]) -> Option<(Figure, Series)> {
    let mut sorted = values.clone();
    sorted.sort_by(f64::total_cmp);
    let others = |p: &Point<'_>| -> String {
        let rest: Vec<&str> = p.choices.iter().filter(|c| c.0 != *path).map(|c| c.1).collect();
        rest.join(", ")
    };
    let mut combinations: Vec<String> = Vec::new();
    for p in points {
        let own = others(p);
        if !combinations.contains(&own) {
            combinations.push(own);
        }
    }
    let results =
        if combinations.len() * h.results.len() > CURVES { &h.results[..1] } else { &h.results[..] };
    let (mut columns, mut lines) = (Vec::new(), Vec::new());
    for combination in combinations.iter().take(CURVES) {
        for (label, name) in results {
            let here = |x: &f64| {
                let p = points.iter().find(|p| others(p) == *combination && at(p, path) == Some(*x))?;
                (p.result)(name)
            };
            let told: Vec<Option<(f64, &str)>> = sorted.iter().map(here).collect();
            let own_unit = told.iter().flatten().next()?.1;
            let words: Vec<&str> =
                [combination.as_str(), label].into_iter().filter(|w| !w.is_empty()).collect();
            let label = if words.is_empty() { h.title.clone() } else { words.join(": ") };
            let values = told.iter().map(|v| v.map_or(f64::NAN, |v| v.0)).collect();
            columns.push(Column { name: label.clone(), unit: own_unit.to_owned(), values });
            lines.push((label.clone(), label));
        }
    }
    let table = format!("{path}: {}", h.title);
    let axis = Column { name: (*path).to_owned(), unit: unit.clone(), values: sorted };
    let figure = Figure {
        title: capital(&h.title),
        hint: format!("over {path}"),
        table,
        kind: FigureKind::Lines(Lines { x: (*path).to_owned(), lines, ..Lines::default() }),
    };
    Some((figure, Series { axis, columns }))
}

/// A result over two swaps, where every combination ran.
fn map(x: &Axis<'_>, y: &Axis<'_>, h: &Headline, points: &[Point<'_>]) -> Option<(Figure, Series)> {
    let sorted = |a: &Axis<'_>| {
        let mut v = a.1.clone();
        v.sort_by(f64::total_cmp);
        v
    };
    let (xs, ys) = (sorted(x), sorted(y));
    let name = &h.results.first()?.1;
    let (mut across, mut up, mut values, mut unit) = (Vec::new(), Vec::new(), Vec::new(), "");
    for b in &ys {
        for a in &xs {
            let p = points.iter().find(|p| at(p, x.0) == Some(*a) && at(p, y.0) == Some(*b))?;
            let (v, u) = (p.result)(name)?;
            unit = u;
            across.push(*a);
            up.push(*b);
            values.push(v);
        }
    }
    let column =
        |name: &str, unit: &str, values| Column { name: name.to_owned(), unit: unit.to_owned(), values };
    let title = if h.results.len() > 1 {
        format!("{}, {}", capital(&h.title), h.results[0].0)
    } else {
        capital(&h.title)
    };
    let figure = Figure {
        title,
        hint: format!("over {} and {}", x.0, y.0),
        table: format!("map of {name}"),
        kind: FigureKind::Map {
            x: x.0.to_owned(),
            y: y.0.to_owned(),
            value: name.clone(),
            marks: Vec::new(),
        },
    };
    Some((
        figure,
        Series {
            axis: column(x.0, &x.2, across),
            columns: vec![column(y.0, &y.2, up), column(name, unit, values)],
        },
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(all: &[&str]) -> Vec<String> {
        all.iter().map(|v| (*v).to_owned()).collect()
    }

    #[test]
    fn values_in_one_unit_make_an_axis() {
        assert_eq!(
            numbers(&values(&["0.3 mm", "0.4 mm", "0.5 mm"])),
            Some((vec![0.3, 0.4, 0.5], "mm".into()))
        );
        assert_eq!(numbers(&values(&["1", "2"])), None);
        assert_eq!(numbers(&values(&["0.3 mm", "400 um", "0.5 mm"])), None);
        assert_eq!(numbers(&values(&["off", "patir", "x"])), None);
        assert_eq!(quantity("\"1e3 rpm\""), Some((1000.0, "rpm")));
    }

    #[test]
    fn one_axis_makes_curves_and_two_make_a_map() {
        let (gaps, speeds) = (values(&["3 mm", "1 mm", "2 mm"]), values(&["10 rpm", "20 rpm", "30 rpm"]));
        let headline = [Headline::one("Blow-by", "blow_by")];
        let result = |v: f64| move |_: &str| Some((v, "l/min"));
        let three = [result(3.0), result(1.0), result(2.0)];
        let points: Vec<Point<'_>> =
            gaps.iter().zip(&three).map(|(g, r)| Point { choices: vec![("gap", g)], result: r }).collect();
        let drawn = figures(&[("gap", &gaps)], &headline, &points);
        assert_eq!(
            (drawn[0].1.axis.values.as_slice(), drawn[0].1.columns[0].values.as_slice()),
            (&[1.0, 2.0, 3.0][..], &[1.0, 2.0, 3.0][..])
        );
        let nine: Vec<_> = (0..9).map(|k| result(f64::from(k))).collect();
        let points: Vec<Point<'_>> = (0..9)
            .map(|k| Point {
                choices: vec![("gap", &gaps[k / 3]), ("speed", &speeds[k % 3])],
                result: &nine[k],
            })
            .collect();
        let drawn = figures(&[("gap", &gaps), ("speed", &speeds)], &headline, &points);
        assert!(matches!(drawn[0].0.kind, FigureKind::Map { .. }));
        assert_eq!(drawn[0].1.columns[1].values, [3.0, 6.0, 0.0, 4.0, 7.0, 1.0, 5.0, 8.0, 2.0]);
    }
}
