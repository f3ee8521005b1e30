//! The series of a motion, its window as a table, and what is drawn of both.

use gudgeon_core::result::{Column, Series};

use super::motion::Motion;
use crate::results::{MAX_DRAWN, Results, column};

/// Rows of the series and of the window that are kept, about.
const SERIES_ROWS: usize = 4000;
const WINDOW_ROWS: usize = 3000;

/// Labels and columns of a figure.
type Curves = Vec<(String, String)>;

/// Columns `{what}{k}.{of}` of the first places for which there is a label, with the curves that they are.
fn columns(
    kept: &[usize],
    labels: impl Iterator<Item = (usize, String)>,
    (what, of, unit): (&str, &str, &str),
    value: impl Fn(usize, usize) -> f64,
    into: &mut Vec<Column>,
) -> Curves {
    let mut curves = Vec::new();
    for (k, label) in labels {
        let name = format!("{what}{}.{of}", k + 1);
        into.push(column(name.clone(), unit, kept.iter().map(|r| value(k, *r)).collect()));
        curves.push((label, name));
    }
    curves
}

/// Names of the inertias that are drawn.
fn inertias<'a>(m: &'a Motion<'_>) -> impl Iterator<Item = (usize, String)> + 'a {
    m.a.line.nodes.iter().take(MAX_DRAWN).map(|n| n.name.clone()).enumerate()
}

impl Results<'_> {
    /// Speeds of the inertias, torques in the shafts and of the drives over the whole run.
    pub(super) fn series_over_time(&mut self, m: &Motion<'_>) {
        let stride = (m.rows() / SERIES_ROWS).max(1);
        let kept: Vec<usize> = (0..m.rows()).step_by(stride).collect();
        let times = kept.iter().map(|r| m.out.times[*r]).collect();
        let mut series = Series { axis: column("t", "s", times), columns: Vec::new() };
        let own = ("inertia", "speed", "rad/s");
        let speeds = columns(&kept, inertias(m), own, |i, r| m.out.speeds[r][i], &mut series.columns);
        self.lines("Speed", "of the inertias over time", "series", "t", speeds, false);
        let shafts = m.a.line.links.iter().take(MAX_DRAWN).map(|l| l.name.clone()).enumerate();
        let own = ("shaft", "torque", "N m");
        let torques = columns(&kept, shafts, own, |l, r| m.torque(l, r), &mut series.columns);
        self.lines("Torque in the shafts", "over time", "series", "t", torques, false);
        let drives = m.out.drive.first().map_or(0, Vec::len).min(MAX_DRAWN);
        let drives = (0..drives).map(|k| (k, format!("drive {}", k + 1)));
        let own = ("drive", "torque", "N m");
        let torques = columns(&kept, drives, own, |k, r| m.out.drive[r][k], &mut series.columns);
        if !torques.is_empty() {
            self.lines("Torque of drives", "over time", "series", "t", torques, false);
        }
        self.out.series = series;
    }

    /// The window as it is: speeds of the inertias and gas torques.
    pub(super) fn window_over_time(&mut self, m: &Motion<'_>) {
        let stride = (m.window.len() / WINDOW_ROWS).max(1);
        let kept: Vec<usize> = m.window.clone().step_by(stride).collect();
        let times = kept.iter().map(|r| m.out.times[*r]).collect();
        let mut table = Series { axis: column("t", "s", times), columns: Vec::new() };
        let own = ("inertia", "speed", "rad/s");
        let speeds = columns(&kept, inertias(m), own, |i, r| m.out.speeds[r][i], &mut table.columns);
        self.lines("Speed in the window", "at the end of the run", "window", "t", speeds, false);
        let with_gas = m.a.line.throws.iter().take(MAX_DRAWN).enumerate().filter(|(_, t)| !t.ends.is_empty());
        let throws = with_gas.map(|(k, _)| (k, format!("throw {}", k + 1)));
        let own = ("throw", "gas", "N m");
        let gas = columns(&kept, throws, own, |k, r| m.out.gas[r][k], &mut table.columns);
        if !gas.is_empty() {
            self.lines("Gas torque in the window", "as the method used it", "window", "t", gas, false);
        }
        self.out.tables.insert("window".into(), table);
    }
}
