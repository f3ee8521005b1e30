//! Tables of the report: modes, critical speeds, shafts, load steps by limits, the data of the line.

use gudgeon_core::kinds::Line;
use gudgeon_core::result::{Figure, FigureKind, RunResult};

use crate::draw::CAMPBELL;

/// Rows of the table of critical speeds.
const CRITICAL: usize = 24;

/// Adds the tables that the results of a run fill, each beside the figures that it belongs to.
pub fn figures(line: &Line, out: &mut RunResult) {
    insert(out, Some("Load steps"), load_steps(out));
    insert(out, Some(CAMPBELL), modes(out));
    insert(out, None, shafts(line, out));
    insert(out, None, critical_speeds(out));
    insert(out, None, inertias(line));
    insert(out, None, stiffnesses(line, out));
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
        kind: FigureKind::Table { rows_are: rows_are.into(), columns, rows, limit },
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
    table("Modes", "about the mean torque at the mean speed", "mode", head, rows, None)
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
        |_| "with the largest torque of that order in any shaft at the speeds of the diagram beside it",
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
fn load_steps(out: &RunResult) -> Option<Figure> {
    let steps = out.tables.get("load_steps")?;
    let head = steps.axis.values.iter().map(|k| (format!("step {k}"), String::new())).collect();
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

fn stiffnesses(line: &Line, out: &RunResult) -> Option<Figure> {
    let labels: Vec<String> = line
        .links
        .iter()
        .map(|l| format!("{}: {} to {}", l.name, line.nodes[l.nodes[0]].name, line.nodes[l.nodes[1]].name))
        .collect();
    let columns = [("stiffness", "N m/rad", "stiffness"), ("damping", "N m s/rad", "damping")];
    let (head, rows) = of_results(out, &columns, &labels, |n, what| format!("shaft{n}.{what}"));
    table("Mass-elastic data: shafts and couplings", "at the mean torque", "shaft", head, rows, None)
}
