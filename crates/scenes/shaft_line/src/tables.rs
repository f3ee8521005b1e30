//! Tables of the report: modes, critical speeds, shafts, load steps by limits, the data of the line.

use gudgeon_core::kinds::Line;
use gudgeon_core::result::{Figure, FigureKind, RunResult};

use crate::case::{ShaftCase, ShaftLineCase, ThrowCase};
use crate::draw::CAMPBELL;

/// Rows of the table of critical speeds.
const CRITICAL: usize = 24;

/// Adds the tables that the results of a run fill, each beside the figures that it belongs to.
pub fn figures(case: &ShaftLineCase, line: &Line, out: &mut RunResult) {
    insert(out, Some("Load steps"), load_steps(case, out));
    insert(out, Some(CAMPBELL), modes(out));
    insert(out, None, shafts(line, out));
    insert(out, None, critical_speeds(out));
    insert(out, None, inertias(line));
    insert(out, None, stiffnesses(case, line, out));
    insert(out, None, throws(case));
}

/// Behind the figure with this title, or behind all.
fn insert(out: &mut RunResult, title: Option<&str>, figure: Option<Figure>) {
    let Some(figure) = figure else { return };
    let place = title.and_then(|t| out.figures.iter().position(|f| f.title == t));
    out.figures.insert(place.map_or(out.figures.len(), |k| k + 1), figure);
}

/// Label and numbers of a row.
type TableRow = (String, Vec<Option<f64>>);
/// Name, unit and result behind a column of a table.
type Told = (&'static str, &'static str, &'static str);

fn table(
    title: &str,
    hint: &str,
    rows_are: &str,
    columns: Vec<(String, String)>,
    rows: Vec<TableRow>,
    limit: Option<f64>,
) -> Option<Figure> {
    (!rows.is_empty() && !columns.is_empty()).then(|| Figure {
        title: title.into(),
        hint: hint.into(),
        table: String::new(),
        kind: FigureKind::Table { rows_are: rows_are.into(), columns, rows, texts: Vec::new(), limit },
    })
}

/// Results of the members `labels` under the columns that any of them has. `name` makes the name of a result from a number and what it is.
fn of_results(
    out: &RunResult,
    columns: &[Told],
    labels: &[String],
    name: impl Fn(usize, &str) -> String,
) -> (Vec<(String, String)>, Vec<TableRow>) {
    let value = |k: usize, what: &str| out.results.get(&name(k + 1, what)).map(|v| v.value);
    let shown: Vec<&Told> =
        columns.iter().filter(|c| (0..labels.len()).any(|k| value(k, c.2).is_some())).collect();
    let head = shown.iter().map(|c| (c.0.to_owned(), c.1.to_owned())).collect();
    let rows =
        labels.iter().enumerate().map(|(k, l)| (l.clone(), shown.iter().map(|c| value(k, c.2)).collect()));
    (head, rows.filter(|(_, v): &TableRow| v.iter().any(Option::is_some)).collect())
}

fn modes(out: &RunResult) -> Option<Figure> {
    let count = (1..).take_while(|n| out.results.contains_key(&format!("mode.{n}.frequency"))).count();
    let labels: Vec<String> = (1..=count).map(|n| format!("mode {n}")).collect();
    let columns = [
        ("frequency", "Hz", "frequency"),
        ("with damping", "Hz", "damped_frequency"),
        ("damping ratio", "", "damping_ratio"),
        ("decay rate", "1/s", "decay"),
        ("places at rest", "", "nodes"),
    ];
    let (head, rows) = of_results(out, &columns, &labels, |n, what| format!("mode.{n}.{what}"));
    let hint = "about the mean torque at the mean speed; a loss factor stiffens a shaft a little, so that the frequency with damping can be the higher one";
    table("Modes", hint, "mode", head, rows, None)
}

fn critical_speeds(out: &RunResult) -> Option<Figure> {
    let found = out.tables.get("critical_speeds")?;
    let of = |name: &str| found.get(name).map(|c| c.values.as_slice());
    let (mode, order, frequency) = (of("mode")?, of("order")?, of("frequency")?);
    let torque = of("torque_amplitude");
    let mut all: Vec<usize> = (0..mode.len()).collect();
    if let Some(t) = torque {
        all.sort_by(|a, b| t[*b].total_cmp(&t[*a]));
    }
    let told = all.len();
    all.truncate(CRITICAL);
    all.sort_unstable();
    let mut head = vec![("speed".to_owned(), "rpm".to_owned()), ("frequency".into(), "Hz".into())];
    if torque.is_some() {
        head.push(("torque of that order".into(), "N m".into()));
    }
    let row = |k: &usize| {
        let mut v = vec![Some(found.axis.values[*k]), Some(frequency[*k])];
        v.extend(torque.map(|t| Some(t[*k])));
        (format!("mode {}, order {}", mode[*k], order[*k]), v)
    };
    let of_torque = torque.map_or(
        "",
        |_| "with the largest torque of that order alone in any shaft, in the load step that the diagrams over the speed show, at the speeds drawn there; the whole vibration of all load steps is the envelope",
    );
    let hint = if told > CRITICAL {
        format!(
            "{CRITICAL} of {told}, the strongest where that is known; table `critical_speeds` has all; {of_torque}"
        )
    } else {
        of_torque.to_owned()
    };
    table("Critical speeds", &hint, "resonance", head, all.iter().map(row).collect(), None)
}

fn shafts(line: &Line, out: &RunResult) -> Option<Figure> {
    let labels: Vec<String> = line.links.iter().map(|l| l.name.clone()).collect();
    let columns = [
        ("mean torque", "N m", "mean_torque"),
        ("vibratory torque", "N m", "torque_amplitude"),
        ("strongest order", "", "strongest_order"),
        ("vibratory stress", "MPa", "stress_amplitude"),
        ("largest stress", "MPa", "stress_max"),
        ("heat", "W", "heat"),
        ("vibratory torque over the range", "N m", "envelope.torque_amplitude"),
        ("vibratory stress over the range", "MPa", "envelope.stress_amplitude"),
        ("heat over the range", "W", "envelope.heat"),
        ("at speed", "rpm", "envelope.speed"),
        ("order there", "", "envelope.order"),
    ];
    let name = |n: usize, what: &str| match what.strip_prefix("envelope.") {
        Some(what) => format!("envelope.shaft{n}.{what}"),
        None => format!("shaft{n}.{what}"),
    };
    let (head, rows) = of_results(out, &columns, &labels, name);
    table(
        "Shafts and couplings",
        "at the mean speed; over the operating range and all load steps where the case has them",
        "shaft",
        head,
        rows,
        None,
    )
}

/// Load steps by limits: part of each limit that is used.
fn load_steps(case: &ShaftLineCase, out: &RunResult) -> Option<Figure> {
    let steps = out.tables.get("load_steps")?;
    let head = crate::steps::all(case).iter().map(|(name, _)| ((*name).to_owned(), String::new())).collect();
    let rows = steps
        .columns
        .iter()
        .map(|c| (c.name.clone(), c.values.iter().map(|v| (*v > 0.0).then_some(*v)).collect()))
        .collect();
    table(
        "Load steps by limits",
        "part of each limit that a load step uses; beyond 1 it is not kept",
        "limit",
        head,
        rows,
        Some(1.0),
    )
}

fn inertias(line: &Line) -> Option<Figure> {
    let rows = line
        .nodes
        .iter()
        .enumerate()
        .map(|(i, n)| (n.name.clone(), vec![Some(line.mean_inertia(i)), Some(n.ratio)]))
        .collect();
    let columns = [("mean inertia", "kg m2"), ("speed ratio", "")].map(|(n, u)| (n.to_owned(), u.to_owned()));
    table(
        "Mass-elastic data: inertias",
        "as the case gives them, with the mean inertia of the crank drives",
        "inertia",
        columns.to_vec(),
        rows,
        None,
    )
}

fn stiffnesses(case: &ShaftLineCase, line: &Line, out: &RunResult) -> Option<Figure> {
    let labels: Vec<String> = line
        .links
        .iter()
        .map(|l| format!("{}: {} to {}", l.name, line.nodes[l.nodes[0]].name, line.nodes[l.nodes[1]].name))
        .collect();
    let columns = [("stiffness", "N m/rad", "stiffness"), ("damping", "N m s/rad", "damping")];
    let (mut head, mut rows) = of_results(out, &columns, &labels, |n, what| format!("shaft{n}.{what}"));
    // What the stresses rest on, of shafts that the case names.
    let given = |label: &str| {
        case.shafts.iter().find(|s| label.strip_prefix(&s.name).is_some_and(|r| r.starts_with(": ")))
    };
    if rows.iter().any(|(label, _)| given(label).is_some_and(|s| shaft_data(s).iter().any(Option::is_some))) {
        let more = [("diameter", "mm"), ("bore", "mm"), ("stress concentration", ""), ("loss factor", "")];
        head.extend(more.map(|(n, u)| (n.to_owned(), u.to_owned())));
        for (label, values) in &mut rows {
            values.extend(given(label).map_or([None; 4], shaft_data));
        }
    }
    table("Mass-elastic data: shafts and couplings", "at the mean torque", "shaft", head, rows, None)
}

/// Diameter and bore where the stress is told \[mm\], stress concentration, loss factor.
fn shaft_data(s: &ShaftCase) -> [Option<f64>; 4] {
    let at = s.diameter.map(|d| (d.si(), s.bore.si()));
    let strength = |d: f64, b: f64| (d.powi(4) - b.powi(4)) / d;
    let weakest = s.pieces.iter().map(|p| (p.diameter.si(), p.bore.si()));
    let at = at.or_else(|| weakest.min_by(|x, y| strength(x.0, x.1).total_cmp(&strength(y.0, y.1))));
    let loss = Some(s.loss_factor.si()).filter(|l| *l > 0.0);
    [at.map(|a| 1e3 * a.0), at.map(|a| 1e3 * a.1), at.map(|_| s.stress_concentration.si()), loss]
}

/// Crank drives as the case gives them, with the place of the outer dead centres.
fn throws(case: &ShaftLineCase) -> Option<Figure> {
    let all = case.throws.iter().flat_map(|t| t.at.iter().enumerate().map(move |(i, name)| (t, i, name)));
    let row = |(t, i, name): (&ThrowCase, usize, &String)| {
        let phase = t.phases.get(i).map_or(0.0, |p| p.si()).to_degrees();
        let dead = (-phase).rem_euclid(360.0);
        // 360 to rounding is 0.
        let dead = if 360.0 - dead < 1e-9 { 0.0 } else { (1e9 * dead).round() / 1e9 };
        let values = [
            phase,
            dead,
            2e3 * t.crank_radius.si(),
            1e3 * t.rod_length.si(),
            t.rod_mass.si(),
            t.reciprocating_mass.si(),
            t.crank_inertia.si(),
        ];
        (name.clone(), values.map(Some).to_vec())
    };
    let columns = [
        ("phase", "deg"),
        ("outer dead centre at", "deg"),
        ("stroke", "mm"),
        ("rod length", "mm"),
        ("rod mass", "kg"),
        ("reciprocating mass", "kg"),
        ("crank inertia", "kg m2"),
    ];
    table(
        "Throws",
        "with the angle of the shaft at which the piston is at its outer dead centre: the two throws of a balanced-opposed pair have the same",
        "throw",
        columns.map(|(n, u)| (n.to_owned(), u.to_owned())).to_vec(),
        all.map(row).collect(),
        None,
    )
}
