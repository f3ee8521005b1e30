//! Start and instants of a motion over time.

use gudgeon_core::BuildError;
use gudgeon_core::kinds::{TorsionAnswer, TorsionCtx, TorsionOut};

use super::assemble::Assembled;
use super::case::ShaftLineCase;

/// Most rows of a motion over time.
const ROWS: f64 = 4e5;
/// Most values of a motion over time: half a gigabyte.
const VALUES: f64 = 6e7;

/// Start and instants of a motion over time.
#[derive(Debug, Clone)]
pub struct Start {
    angles: Vec<f64>,
    speeds: Vec<f64>,
    times: Vec<f64>,
    /// How many of the instants are rows of the series; the rest are the window.
    pub rows: usize,
    /// What is wrong with them.
    pub errors: Vec<BuildError>,
}

impl Start {
    pub fn new(case: &ShaftLineCase, n: usize) -> Self {
        let mut s = Self {
            angles: vec![0.0; n],
            speeds: vec![case.speed.si(); n],
            times: Vec::new(),
            rows: 0,
            errors: Vec::new(),
        };
        for (v, i) in s.speeds.iter_mut().zip(&case.inertias) {
            *v *= i.ratio.si();
        }
        let Some(t) = &case.time else {
            if case.models.torsion.answers() == TorsionAnswer::Time {
                let what = "a motion over time needs a table `time` with `duration` and `interval`";
                s.errors.push(BuildError::at("models.torsion", what));
            }
            return s;
        };
        match t.start_speeds.as_slice() {
            [] => {}
            [one] => s.speeds.fill(one.si()),
            many if many.len() == n => s.speeds = many.iter().map(|v| v.si()).collect(),
            many => s.errors.push(BuildError::at(
                "time.start_speeds",
                format!("{} speeds for {n} inertias; give one for each, one for all, or none", many.len()),
            )),
        }
        let (end, step) = (t.duration.si(), t.interval.si());
        let window = t.window.map_or(0.1 * end, |w| w.si()).min(end);
        let fine = t.window_interval.map_or(step, |w| w.si());
        if end / step + window / fine > ROWS {
            let what = format!("{:.1e} rows are more than {ROWS:.0e}", end / step + window / fine);
            s.errors.push(BuildError::at("time.interval", what));
            return s;
        }
        // Angles, speeds and torques of each are kept.
        let values = (end / step + window / fine) * 3.0 * n as f64;
        if values > VALUES {
            let what = format!("{values:.1e} values over time are more than {VALUES:.0e}");
            s.errors.push(BuildError::at("time.interval", what));
            return s;
        }
        let grid = |from: f64, step: f64| {
            let n = ((end - from) / step + 1e-9).floor() as usize;
            (0..=n).map(move |k| from + step * k as f64)
        };
        // Rows and window in one ascending list; the window's own instants come on top of the rows there.
        let begin = end - window;
        s.times = grid(0.0, step).filter(|t| *t < begin - 1e-12 * end).collect();
        s.rows = s.times.len();
        s.times.extend(grid(begin, fine));
        s
    }

    /// Starts in a periodic motion.
    pub fn take_steady(&mut self, out: &TorsionOut) {
        self.angles.clone_from(&out.mean_angle);
        for o in out.orders.iter() {
            for (i, a) in o.angle.iter().enumerate() {
                self.angles[i] += a[0];
                self.speeds[i] -= o.order * out.speed * a[1];
            }
        }
    }

    /// What a torsion model is asked.
    pub fn context<'a>(&'a self, case: &ShaftLineCase, a: &'a Assembled) -> TorsionCtx<'a> {
        TorsionCtx {
            line: &a.line,
            speed: case.speed.si(),
            orders: case.range.orders.si(),
            period: a.period,
            balance: &a.balance,
            angles: &self.angles,
            speeds: &self.speeds,
            times: &self.times,
        }
    }
}
