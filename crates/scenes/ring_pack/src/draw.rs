//! Figures of a ring pack besides those over the cycle: Stribeck curves, friction by source, regimes, p-V diagram, oil.

use gudgeon_core::result::{Bar, Column, Figure, FigureKind, Lines, RunResult, Series};

/// Angles between the points of the Stribeck and the p-V diagram \[deg\].
const STEP: f64 = 2.0;
/// Part of the largest speed below which a piston is at rest: what is left of a dead centre is rounding.
const REST: f64 = 1e-6;
/// Part of the radial load that solid contact carries at most where a film is called full, and at least where it is called boundary.
const REGIMES: [f64; 2] = [0.01, 0.5];

/// Adds what the series and the results of a run let draw, of rings with these names in a bore of this radius \[m\].
pub fn figures(out: &mut RunResult, rings: &[String], radius: f64) {
    let rows = rows(&out.series);
    let added = [friction(out, rings), regimes(out, rings), oil(out, rings)];
    out.figures.extend(added.into_iter().flatten());
    stribeck(out, rings, radius, &rows);
    p_v(out, radius, &rows);
}

/// Rows of the series that a diagram of single instants takes.
fn rows(series: &Series) -> Vec<usize> {
    let theta = &series.axis.values;
    let mut next = f64::NEG_INFINITY;
    let mut kept = Vec::new();
    for (i, t) in theta.iter().enumerate() {
        if *t >= next - 1e-9 {
            kept.push(i);
            next = t + STEP;
        }
    }
    kept
}

fn column(name: impl Into<String>, unit: &str, values: Vec<f64>) -> Column {
    Column { name: name.into(), unit: unit.into(), values }
}

fn values<'a>(series: &'a Series, name: &str) -> Option<&'a [f64]> {
    series.get(name).map(|c| c.values.as_slice())
}

/// Coefficient of friction over `eta |u| / w`, the Hersey number with the load `w` per length of circumference, a point an instant.
fn stribeck(out: &mut RunResult, rings: &[String], radius: f64, rows: &[usize]) {
    let series = &out.series;
    let Some(speed) = values(series, "piston.v") else { return };
    let fastest = speed.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let theta = rows.iter().map(|i| series.axis.values[*i]).collect();
    let mut table = Series { axis: column("theta", "deg", theta), columns: Vec::new() };
    let y_name = "coefficient of friction".into();
    let mut kind = Lines { y_name, log_x: true, log_y: true, scatter: true, ..Lines::default() };
    for (k, name) in rings.iter().enumerate() {
        let of = |what: &str| values(series, &format!("ring{}.{what}", k + 1));
        let (Some(eta), Some(load), Some(force)) = (of("viscosity"), of("radial_load"), of("friction_force"))
        else {
            continue;
        };
        let around = 2.0 * std::f64::consts::PI * radius;
        // Points at rest, and without a load, have no place in a logarithmic diagram.
        let moves = |i: usize| speed[i].abs() > REST * fastest;
        let point = |i: &usize| (load[*i] > 0.0 && moves(*i) && force[*i] != 0.0).then_some(*i);
        let at =
            |f: &dyn Fn(usize) -> f64| rows.iter().map(|i| point(i).map_or(0.0, f)).collect::<Vec<f64>>();
        let (x, y) = (format!("ring{}.hersey_number", k + 1), format!("ring{}.coefficient", k + 1));
        table.columns.push(column(x.clone(), "1", at(&|i| eta[i] * speed[i].abs() * around / load[i])));
        table.columns.push(column(y.clone(), "1", at(&|i| force[i].abs() / load[i])));
        kind.own_x.push(x);
        kind.lines.push((name.clone(), y));
    }
    if kind.lines.is_empty() {
        return;
    }
    kind.x.clone_from(&kind.own_x[0]);
    out.figures.push(Figure {
        title: "Stribeck diagram".into(),
        hint: "friction force over radial load, over viscosity times speed by load per length of circumference; a point every 2 degrees".into(),
        table: "stribeck".into(),
        kind: FigureKind::Lines(kind),
    });
    out.tables.insert("stribeck".into(), table);
}

/// Cylinder pressure over the volume that the piston has left free.
fn p_v(out: &mut RunResult, radius: f64, rows: &[usize]) {
    let series = &out.series;
    let (Some(y), Some(p)) = (values(series, "piston.y"), values(series, "cylinder.p")) else { return };
    let top = y.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let area = std::f64::consts::PI * radius * radius;
    let volume = rows.iter().map(|i| area * (top - y[*i])).collect();
    let pressure = rows.iter().map(|i| p[*i]).collect();
    out.tables.insert(
        "p_v".into(),
        Series {
            axis: column("displaced_volume", "m3", volume),
            columns: vec![column("cylinder.p", "Pa", pressure)],
        },
    );
    out.figures.push(Figure {
        title: "Indicator diagram (p-V)".into(),
        hint: "pressure in the cylinder over the volume displaced from the upper dead centre".into(),
        table: "p_v".into(),
        kind: FigureKind::Lines(Lines {
            x: "displaced_volume".into(),
            lines: vec![("cylinder".into(), "cylinder.p".into())],
            ..Lines::default()
        }),
    });
}

fn bars(title: &str, hint: &str, unit: &str, bars: Vec<Bar>) -> Option<Figure> {
    let kind = FigureKind::Bars { unit: unit.into(), bars };
    Some(Figure { title: title.into(), hint: hint.into(), table: String::new(), kind })
}

fn bar(label: String, value: f64) -> Bar {
    Bar { label, value, limit: None }
}

/// Friction mean effective pressure by ring, of the film and of solid contact.
fn friction(out: &RunResult, rings: &[String]) -> Option<Figure> {
    let mut all = Vec::new();
    for (k, name) in rings.iter().enumerate() {
        let of = |what: &str| out.results.get(&format!("ring{}.{what}", k + 1)).map(|v| v.value);
        let (whole, contact) = (of("fmep")?, of("fmep_boundary")?);
        all.push(bar(format!("{name}, film"), whole - contact));
        all.push(bar(format!("{name}, contact"), contact));
    }
    bars("Friction by ring and source", "friction mean effective pressure", "bar", all)
}

/// Parts of the cycle in which the film carries a ring alone, with contact, or hardly at all.
fn regimes(out: &RunResult, rings: &[String]) -> Option<Figure> {
    let [full, boundary] = REGIMES;
    let series = &out.series;
    let theta = &series.axis.values;
    let mut rows = Vec::new();
    for (k, name) in rings.iter().enumerate() {
        let of = |what: &str| values(series, &format!("ring{}.{what}", k + 1));
        let (load, contact) = (of("radial_load")?, of("contact_load")?);
        let mut parts = [0.0; 3];
        for i in 1..theta.len() {
            let share = if load[i] > 0.0 { contact[i] / load[i] } else { 0.0 };
            let k = usize::from(share > full) + usize::from(share > boundary);
            parts[k] += theta[i] - theta[i - 1];
        }
        let cycle: f64 = parts.iter().sum();
        rows.push((
            name.clone(),
            parts.iter().map(|p| (cycle > 0.0).then(|| (100.0 * p / cycle).round())).collect(),
        ));
    }
    let columns = ["full film", "mixed", "boundary"].map(|n| (n.to_owned(), "%".to_owned()));
    Some(Figure {
        title: "Regimes of lubrication".into(),
        hint: "part of the cycle in which solid contact carries less than 1 %, up to half, and more than half of the radial load; by the rows of series.csv, in whole per cent".into(),
        table: String::new(),
        kind: FigureKind::Table { rows_are: "ring".into(), columns: columns.to_vec(), rows, texts: Vec::new(), limit: None },
    })
}

/// Where the oil of a cycle goes.
fn oil(out: &RunResult, rings: &[String]) -> Option<Figure> {
    let of = |name: &str| out.results.get(name).map(|v| v.value);
    let mut all = Vec::new();
    for (k, name) in rings.iter().enumerate() {
        let n = k + 1;
        all.push(bar(format!("{name}, gap upwards"), of(&format!("ring{n}.gap_oil_up"))?));
        all.push(bar(format!("{name}, gap downwards"), of(&format!("ring{n}.gap_oil_down"))?));
        all.push(bar(format!("{name}, blown off its flanks"), of(&format!("ring{n}.flank_oil_lost"))?));
    }
    all.push(bar("thrown into the chamber".into(), of("oil_thrown")?));
    bars(
        "Oil that passes the rings",
        "per cycle; what the faces take from the liner and scrape off stands with the results",
        "mm3",
        all,
    )
}
