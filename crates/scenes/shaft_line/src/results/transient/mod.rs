//! Motion over time.

mod curves;
mod inertias;
mod links;
mod motion;
mod torques;

use gudgeon_core::kinds::TorsionOut;

use super::Results;
use crate::assemble::Assembled;
use crate::machine::Point;
use motion::Motion;

impl Results<'_> {
    /// Motion over time; what limits are held against is that of the window, peaks those of all rows.
    pub fn transient(&mut self, out: &TorsionOut, a: &Assembled, rows: usize) -> Point {
        for (name, n) in &out.counters {
            self.count(name, *n);
        }
        self.note(&out.notes);
        let m = Motion::new(out, a, rows);
        self.run_as_a_whole(&m);
        self.inertias_over_time(&m);
        let links = (0..a.line.links.len()).map(|l| self.link_over_time(&m, l)).collect();
        self.throws_over_time(&m);
        self.drives_over_time(&m);
        self.series_over_time(&m);
        self.window_over_time(&m);
        Point { links, speed_fluctuation: inertias::speed_fluctuations(&m), ..Point::default() }
    }

    /// Length, mean speed and turns.
    fn run_as_a_whole(&mut self, m: &Motion<'_>) {
        let (first, last) = (m.first(), m.last());
        self.result("time", m.out.times[last], "s", "length of the run");
        self.result(
            "mean_speed",
            m.mean_speed(last),
            "rad/s",
            "momentum by inertia at the end, at the reference shaft",
        );
        let (turned, length) = (m.turns(), m.length());
        self.result("window", length, "s", "length of the window at the end");
        self.result("turns", turned, "", "turns within the window, mean over the inertias");
        if turned > 0.0 {
            self.result("cycle_time", length / turned, "s", "time of a turn within the window");
        }
        if length > 0.0 {
            self.result(
                "acceleration",
                (m.mean_speed(last) - m.mean_speed(first)) / length,
                "rad/s2",
                "change of the mean speed over the window, by its length",
            );
        }
    }
}
