//! Speeds and angles of the inertias over time.

use super::motion::Motion;
use crate::results::Results;

/// Coefficients of speed fluctuation by inertia: peak to peak speed within the window by the mean speed at the end.
pub(super) fn speed_fluctuations(m: &Motion<'_>) -> Vec<f64> {
    let end = m.mean_speed(m.last());
    let fluctuation = |i: usize| {
        let [top, bottom] = m.window_extremes(|r| m.out.speeds[r][i] / m.ratio[i]);
        if end == 0.0 { 0.0 } else { (top - bottom) / end.abs() }
    };
    (0..m.ratio.len()).map(fluctuation).collect()
}

impl Results<'_> {
    /// The inertia whose speed swings by the maximum, and each of them.
    pub(super) fn inertias_over_time(&mut self, m: &Motion<'_>) {
        let nodes = m.ratio.len();
        let swing = |i: usize| {
            let [top, bottom] = m.window_extremes(|r| m.out.speeds[r][i]);
            (top - bottom) / m.ratio[i].abs()
        };
        if let Some(maximum) = (0..nodes).max_by(|a, b| swing(*a).total_cmp(&swing(*b))) {
            let name = &m.a.line.nodes[maximum].name;
            self.result(
                "most_swing",
                (maximum + 1) as f64,
                "",
                format!("inertia whose speed swings most within the window, at the reference shaft: {name}"),
            );
        }
        for i in 0..nodes {
            self.inertia_over_time(m, i);
        }
    }

    fn inertia_over_time(&mut self, m: &Motion<'_>, i: usize) {
        let (name, k, last) = (&m.a.line.nodes[i].name, i + 1, m.last());
        let speed = |r: usize| m.out.speeds[r][i];
        let [top, bottom] = m.window_extremes(speed);
        self.result(
            format!("inertia{k}.speed_swing"),
            top - bottom,
            "rad/s",
            format!("peak to peak speed of {name} within the window"),
        );
        self.result(
            format!("inertia{k}.speed_end"),
            speed(last),
            "rad/s",
            format!("speed of {name} at the end"),
        );
        self.result(
            format!("inertia{k}.angle_end"),
            m.out.angles[last][i],
            "rad",
            format!("angle of {name} at the end"),
        );
        for percent in [5, 1] {
            self.settled(m, i, percent);
        }
        let [top, bottom] = m.all_extremes(speed);
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

    /// Settled from the row on after which the speed stays within a band about the mean speed at the end.
    fn settled(&mut self, m: &Motion<'_>, i: usize, percent: i32) {
        let (name, last) = (&m.a.line.nodes[i].name, m.last());
        let end = m.mean_speed(last);
        let band = 0.01 * f64::from(percent) * end.abs();
        let outside = (0..m.rows()).rev().find(|r| (m.out.speeds[*r][i] / m.ratio[i] - end).abs() > band);
        if let Some(at) = outside.map_or(Some(0), |r| (r < last).then_some(r + 1)) {
            self.result(
                format!("inertia{}.settled_{percent}", i + 1),
                m.out.times[at],
                "s",
                format!("time from which {name} stays within {percent} % of the mean speed at the end"),
            );
        }
    }
}
