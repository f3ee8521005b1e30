//! Motion over time.

use std::f64::consts::PI;

use gudgeon_core::kinds::TorsionOut;
use gudgeon_core::result::Series;

use super::{MOST, Results, column, extremes};
use crate::assemble::Assembled;
use crate::machine::{LinkPoint, Point};

impl Results<'_> {
    /// Motion over time; what limits are held against is that of the window, peaks those of all rows.
    pub fn transient(&mut self, out: &TorsionOut, a: &Assembled, rows: usize) -> Point {
        let mut point = Point::default();
        for (name, n) in &out.counters {
            self.count(name, *n);
        }
        self.note(&out.notes);
        let (links, nodes, n) = (a.line.links.len(), a.line.nodes.len(), out.times.len());
        let inertia: Vec<f64> = (0..nodes).map(|i| a.line.mean_inertia(i)).collect();
        let ratio: Vec<f64> = a.line.nodes.iter().map(|n| n.ratio).collect();
        let total: f64 = inertia.iter().zip(&ratio).map(|(j, r)| j * r * r).sum();
        let mean_speed = |r: usize| -> f64 {
            (0..nodes).map(|i| inertia[i] * ratio[i] * out.speeds[r][i]).sum::<f64>() / total
        };
        // Twist of a link and its rate.
        let twist = |l: usize, r: usize| -> [f64; 2] {
            let [x, y] = a.line.links[l].nodes;
            let gear = ratio[x] / ratio[y];
            [&out.angles, &out.speeds].map(|v| v[r][x] - gear * v[r][y])
        };
        // A model that does not say leaves it to the law.
        let torque = |l: usize, r: usize| {
            let said = out.torque.get(r).and_then(|t| t.get(l)).copied();
            said.unwrap_or_else(|| {
                let [twist, rate] = twist(l, r);
                a.line.links[l].coupling.torque(twist, rate).torque
            })
        };
        let window = rows.min(n - 1)..n;
        let last = n - 1;
        self.result("time", out.times[last], "s", "length of the run");
        self.result(
            "mean_speed",
            mean_speed(last),
            "rad/s",
            "momentum by inertia at the end, at the reference shaft",
        );
        let first = window.start;
        // Momentum's angle: what the inertias turn in the mean.
        let turned = (0..nodes)
            .map(|i| inertia[i] * ratio[i] * (out.angles[last][i] - out.angles[first][i]))
            .sum::<f64>()
            / total
            / (2.0 * PI);
        self.result("window", out.times[last] - out.times[first], "s", "length of the window at the end");
        self.result("turns", turned, "", "turns within the window, mean over the inertias");
        let length = out.times[last] - out.times[first];
        if turned > 0.0 {
            self.result("cycle_time", length / turned, "s", "time of a turn within the window");
        }
        if length > 0.0 {
            self.result(
                "acceleration",
                (mean_speed(last) - mean_speed(first)) / length,
                "rad/s2",
                "change of the mean speed over the window, by its length",
            );
        }
        let end = mean_speed(last);
        let swing = |i: usize| {
            let [top, bottom] = extremes(window.clone().map(|r| out.speeds[r][i]));
            (top - bottom) / ratio[i].abs()
        };
        if let Some(most) = (0..nodes).max_by(|a, b| swing(*a).total_cmp(&swing(*b))) {
            self.result(
                "most_swing",
                (most + 1) as f64,
                "",
                format!(
                    "inertia whose speed swings most within the window, at the reference shaft: {}",
                    a.line.nodes[most].name
                ),
            );
        }
        for i in 0..nodes {
            let name = &a.line.nodes[i].name;
            let k = i + 1;
            let [top, bottom] = extremes(window.clone().map(|r| out.speeds[r][i]));
            self.result(
                format!("inertia{k}.speed_swing"),
                top - bottom,
                "rad/s",
                format!("peak to peak speed of {name} within the window"),
            );
            self.result(
                format!("inertia{k}.speed_end"),
                out.speeds[last][i],
                "rad/s",
                format!("speed of {name} at the end"),
            );
            self.result(
                format!("inertia{k}.angle_end"),
                out.angles[last][i],
                "rad",
                format!("angle of {name} at the end"),
            );
            // Settled from the row on after which the speed stays within a band about the mean speed at the end.
            for percent in [5, 1] {
                let band = 0.01 * f64::from(percent) * end.abs();
                let outside = (0..n).rev().find(|r| (out.speeds[*r][i] / ratio[i] - end).abs() > band);
                if let Some(at) = outside.map_or(Some(0), |r| (r < last).then_some(r + 1)) {
                    self.result(
                        format!("inertia{k}.settled_{percent}"),
                        out.times[at],
                        "s",
                        format!(
                            "time from which {name} stays within {percent} % of the mean speed at the end"
                        ),
                    );
                }
            }
            let [top, bottom] = extremes((0..n).map(|r| out.speeds[r][i]));
            self.result(
                format!("inertia{k}.speed_max"),
                top,
                "rad/s",
                format!("largest speed of {name} of all rows"),
            );
            self.result(
                format!("inertia{k}.speed_min"),
                bottom,
                "rad/s",
                format!("smallest speed of {name} of all rows"),
            );
        }
        for l in 0..links {
            let name = &a.line.links[l].name;
            let k = l + 1;
            let [top_of_window, bottom_of_window] = extremes(window.clone().map(|r| torque(l, r)));
            let [all, least] = extremes((0..n).map(|r| torque(l, r)));
            self.result(
                format!("shaft{k}.torque_amplitude"),
                0.5 * (top_of_window - bottom_of_window),
                "N m",
                format!("half of peak to peak torque of {name} within the window"),
            );
            self.result(
                format!("shaft{k}.torque_peak"),
                all.abs().max(least.abs()),
                "N m",
                format!("largest torque of {name} of all rows, either way"),
            );
            let mean = window.clone().map(|r| torque(l, r)).sum::<f64>() / window.len() as f64;
            self.law(l, mean, a, "at its mean torque within the window");
            let [more, less] = extremes((0..n).map(|r| twist(l, r)[0]));
            self.result(
                format!("shaft{k}.twist_peak"),
                more.abs().max(less.abs()).to_degrees(),
                "deg",
                format!("largest twist of {name} of all rows, either way"),
            );
            if let Some(s) = a.stress[l] {
                self.result(
                    format!("shaft{k}.stress_peak"),
                    s * all.abs().max(least.abs()) / 1e6,
                    "MPa",
                    format!("largest shear stress of {name} of all rows"),
                );
            }
            // Heat: the loss of the dampers, mean over the window.
            let loss = window.clone().map(|r| {
                let [twist, rate] = twist(l, r);
                a.line.links[l].coupling.torque(twist, rate).damping * rate * rate
            });
            let heat = loss.sum::<f64>() / window.len() as f64;
            point.links.push(LinkPoint {
                amplitude: 0.5 * (top_of_window - bottom_of_window),
                peak: all.abs().max(least.abs()),
                heat,
                order: 0.0,
            });
            self.result(
                format!("shaft{k}.heat"),
                heat,
                "W",
                format!("mean power lost in {name} within the window"),
            );
        }
        if let Some(g) = out.gas.get(last) {
            for k in (0..g.len()).filter(|k| !a.line.throws[*k].ends.is_empty()) {
                let [top, bottom] = extremes(window.clone().map(|r| out.gas[r][k]));
                let lag = |r: usize| {
                    let turned = |k: usize| {
                        let i = a.line.throws[k].node;
                        out.angles[r][i] / ratio[i]
                    };
                    turned(0) - turned(k)
                };
                let mean = window.clone().map(lag).sum::<f64>() / window.len() as f64;
                self.result(
                    format!("throw{}.lag", k + 1),
                    mean.to_degrees(),
                    "deg",
                    format!(
                        "angle of the shaft that throw {} lags behind throw 1 by twist, mean over the window",
                        k + 1
                    ),
                );
                self.result(
                    format!("throw{}.gas_max", k + 1),
                    top,
                    "N m",
                    format!("largest gas torque of throw {} within the window", k + 1),
                );
                self.result(
                    format!("throw{}.gas_min", k + 1),
                    bottom,
                    "N m",
                    format!("smallest gas torque of throw {} within the window", k + 1),
                );
            }
        }
        if let Some(d) = out.drive.get(last) {
            for k in 0..d.len() {
                let mean = window.clone().map(|r| out.drive[r][k]).sum::<f64>() / window.len() as f64;
                self.result(
                    format!("drive{}.torque", k + 1),
                    mean,
                    "N m",
                    format!("mean torque of drive {} within the window", k + 1),
                );
                self.result(
                    format!("drive{}.torque_end", k + 1),
                    out.drive[last][k],
                    "N m",
                    format!("torque of drive {} at the end", k + 1),
                );
            }
        }
        let steps = (n / 4000).max(1);
        let kept: Vec<usize> = (0..n).step_by(steps).collect();
        let of = |f: &dyn Fn(usize) -> f64| kept.iter().map(|r| f(*r)).collect::<Vec<f64>>();
        let mut series = Series { axis: column("t", "s", of(&|r| out.times[r])), columns: Vec::new() };
        let mut figure = Vec::new();
        for i in 0..nodes.min(MOST) {
            let name = format!("inertia{}.speed", i + 1);
            series.columns.push(column(name.clone(), "rad/s", of(&|r| out.speeds[r][i])));
            figure.push((a.line.nodes[i].name.clone(), name));
        }
        self.lines("Speed", "of the inertias over time", "series", "t", figure, false);
        let mut figure = Vec::new();
        for l in 0..links.min(MOST) {
            let name = format!("shaft{}.torque", l + 1);
            series.columns.push(column(name.clone(), "N m", of(&|r| torque(l, r))));
            figure.push((a.line.links[l].name.clone(), name));
        }
        self.lines("Torque in the shafts", "over time", "series", "t", figure, false);
        let mut figure = Vec::new();
        for k in 0..out.drive.first().map_or(0, Vec::len).min(MOST) {
            let name = format!("drive{}.torque", k + 1);
            series.columns.push(column(name.clone(), "N m", of(&|r| out.drive[r][k])));
            figure.push((format!("drive {}", k + 1), name));
        }
        if !figure.is_empty() {
            self.lines("Torque of drives", "over time", "series", "t", figure, false);
        }
        self.out.series = series;
        // The window as it is.
        let stride = (window.len() / 3000).max(1);
        let kept: Vec<usize> = window.clone().step_by(stride).collect();
        let of = |f: &dyn Fn(usize) -> f64| kept.iter().map(|r| f(*r)).collect::<Vec<f64>>();
        let mut table = Series { axis: column("t", "s", of(&|r| out.times[r])), columns: Vec::new() };
        let mut figure = Vec::new();
        for i in 0..nodes.min(MOST) {
            let name = format!("inertia{}.speed", i + 1);
            table.columns.push(column(name.clone(), "rad/s", of(&|r| out.speeds[r][i])));
            figure.push((a.line.nodes[i].name.clone(), name));
        }
        self.lines("Speed in the window", "at the end of the run", "window", "t", figure, false);
        let mut figure = Vec::new();
        for k in (0..a.line.throws.len().min(MOST)).filter(|k| !a.line.throws[*k].ends.is_empty()) {
            let name = format!("throw{}.gas", k + 1);
            table.columns.push(column(name.clone(), "N m", of(&|r| out.gas[r][k])));
            figure.push((format!("throw {}", k + 1), name));
        }
        if !figure.is_empty() {
            self.lines("Gas torque in the window", "as the method used it", "window", "t", figure, false);
        }
        self.out.tables.insert("window".into(), table);
        let swings = (0..nodes).map(|i| {
            let [top, bottom] = extremes(window.clone().map(|r| out.speeds[r][i] / ratio[i]));
            if end == 0.0 { 0.0 } else { (top - bottom) / end.abs() }
        });
        point.irregularity = swings.collect();
        point
    }
}
