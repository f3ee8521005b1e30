//! Natural frequencies, shapes, critical speeds.

use std::f64::consts::PI;

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{Line, Mode};
use gudgeon_core::result::{FigureKind, Note, Series};
use gudgeon_numerics::elementary;
use gudgeon_torsion::critical::CriticalSpeed;
use gudgeon_torsion::steady::Steady;

use super::verdict::SAME;
use super::{Results, column, extremes};
use crate::assemble::Assembled;
use crate::verdict::{MODES, Operating, Step, separation};
use crate::{draw, rpm};

/// Maximum number of mode shapes that are drawn.
const MAX_SHAPES: usize = 6;
/// Intervals of the diagram, and of the search for critical speeds where they move with the speed.
const GRID: usize = 60;

impl Results<'_> {
    /// The frequencies of a model that is wrong on purpose.
    pub fn published(&mut self, modes: &[Mode], line: &Line) {
        let name = self.case.models.natural_frequencies.typetag_name();
        for (k, m) in modes.iter().enumerate() {
            let of = &line.nodes[k.min(line.nodes.len() - 1)].name;
            let what = format!("`{name}` of {of}: not a natural frequency of the line");
            self.result(format!("published.{}.frequency", k + 1), m.omega / (2.0 * PI), "Hz", what.clone());
            self.result(format!("published.{}.omega", k + 1), m.omega, "rad/s", what);
        }
        let text = format!(
            "`natural_frequencies/{name}` does not give natural frequencies; they stand beside it as `mode.N.frequency`, and everything else uses those"
        );
        self.note(&[Note::caution("published_frequencies", text)]);
    }

    /// Natural frequencies and shapes.
    pub fn modes(&mut self, modes: &[Mode], line: &Line) {
        let elastic: Vec<&Mode> = modes.iter().filter(|m| m.omega > 0.0).collect();
        self.result(
            "rigid_modes",
            (modes.len() - elastic.len()) as f64,
            "",
            "number of modes at frequency zero",
        );
        let mut table = Series {
            axis: column("inertia", "", (1..=line.nodes.len()).map(|i| i as f64).collect()),
            columns: Vec::new(),
        };
        for (k, m) in elastic.iter().enumerate() {
            let n = k + 1;
            self.result(
                format!("mode.{n}.frequency"),
                m.omega / (2.0 * PI),
                "Hz",
                format!("natural frequency of mode {n}, undamped"),
            );
            self.result(
                format!("mode.{n}.omega"),
                m.omega,
                "rad/s",
                format!("the same as angular frequency, mode {n}"),
            );
            if let Some((decay, omega)) = m.damped {
                self.result(
                    format!("mode.{n}.damping_ratio"),
                    decay / elementary::hypot(decay, omega),
                    "",
                    format!("damping ratio of mode {n}"),
                );
                self.result(format!("mode.{n}.decay"), decay, "1/s", format!("decay rate of mode {n}"));
                self.result(
                    format!("mode.{n}.damped_frequency"),
                    omega / (2.0 * PI),
                    "Hz",
                    format!("frequency of mode {n} with damping"),
                );
            }
            self.result(
                format!("mode.{n}.nodes"),
                draw::nodes(line, &m.shape).len() as f64,
                "",
                format!("places at rest in mode {n}"),
            );
            table.columns.push(column(format!("mode{n}"), "", m.shape.clone()));
        }
        let worst = modes.iter().map(|m| m.residual).fold(0.0, f64::max);
        self.result(
            "holzer_residual",
            worst,
            "",
            "torque left over at the end of the line, by the largest, worst mode",
        );
        self.out.tables.insert("modes".into(), table);
        if !elastic.is_empty() {
            self.out.figures.push(draw::modes(line, &elastic[..elastic.len().min(MAX_SHAPES)]));
        }
    }

    /// Interference table and diagram: natural frequencies about the mean torque of each speed, with the stiffness that links have at
    /// that frequency.
    ///
    /// # Errors
    /// No convergence.
    pub fn critical_speeds(
        &mut self,
        modes: &[Mode],
        steady: &mut Steady,
        a: &Assembled,
    ) -> Result<(), EvalError> {
        let r = &self.case.range;
        let speed = self.case.speed.si();
        let to = r.to.map_or(2.0 * speed, |v| v.si());
        // Nothing is critical at rest.
        let from = r.from.map_or(0.0, |v| v.si());
        let elastic = modes.iter().filter(|m| m.omega > 0.0).count();
        let step = 2.0 * PI / a.period;
        let count = (r.interference_orders.si() / step + 1e-9).floor() as usize;
        let orders: Vec<f64> = (1..=count).map(|k| k as f64 * step).collect();
        let mut found = steady.critical_speeds(&orders, from.max(1e-6 * to), to, GRID)?;
        found.retain(|c| c.mode <= elastic);
        self.critical_speed_results(&found);
        if steady.hangs_on_damping() {
            let links = a.line.links.iter();
            let loose: Vec<&str> = links
                .filter(|l| {
                    let law = l.coupling.linear(0.0, 0.0);
                    law.stiffness == 0.0 && law.damping > 0.0
                })
                .map(|l| l.name.as_str())
                .collect();
            let text = format!(
                "{} damps without stiffness: critical speeds, Campbell diagram and separation follow the frequencies with damping, between ring free and ring locked; `mode.N.frequency` and the shapes are undamped, with the ring free",
                loose.join(", ")
            );
            self.note(&[Note::info("with_damping", text)]);
        }
        let here: Vec<f64> = steady.frequencies(MODES)?;
        self.nearest_critical_speed(&here, &orders, speed);
        self.out.tables.insert("critical_speeds".into(), critical_speed_table(&found));
        self.interference(steady, [from, to], (&here, &orders), &found)
    }

    fn critical_speed_results(&mut self, found: &[CriticalSpeed]) {
        self.result(
            "critical_speeds",
            found.len() as f64,
            "",
            "number of critical speeds within the range, table `critical_speeds`",
        );
        for c in found {
            let name = format!("critical_speed.mode{}.order{}", c.mode, c.order);
            let what = format!("speed at which order {} excites mode {}", c.order, c.mode);
            self.result(name, rpm(c.speed), "rpm", what);
        }
    }

    /// The critical speed next to the mean speed; `frequencies` are those at the mean speed.
    fn nearest_critical_speed(&mut self, frequencies: &[f64], orders: &[f64], speed: f64) {
        let all =
            frequencies.iter().enumerate().flat_map(|(m, w)| orders.iter().map(move |o| (m + 1, *o, *w)));
        let nearest = all.map(|(m, o, w)| (separation(w, o * speed), m, o, w)).fold(
            None,
            |best: Option<(f64, usize, f64, f64)>, c| match best {
                Some((d, ..)) if f64::abs(d) <= c.0.abs() => best,
                _ => Some(c),
            },
        );
        let Some((distance, mode, order, omega)) = nearest else { return };
        self.result(
            "nearest_critical_speed",
            rpm(omega / order),
            "rpm",
            format!("critical speed next to the mean speed: order {order} and mode {mode}"),
        );
        self.result(
            "distance_to_critical",
            100.0 * distance,
            "%",
            "of that critical speed from the mean speed, by the mean speed: what `limits.separation` goes by",
        );
    }

    /// The diagram and its table: orders as rays, modes as levels. `frequencies` are those at the mean speed.
    fn interference(
        &mut self,
        steady: &mut Steady,
        [from, to]: [f64; 2],
        (frequencies, orders): (&[f64], &[f64]),
        found: &[CriticalSpeed],
    ) -> Result<(), EvalError> {
        let speed = self.case.speed.si();
        let at: Vec<f64> = (0..=GRID).map(|i| from + (to - from) * i as f64 / GRID as f64).collect();
        let levels = levels(steady, &at, frequencies)?;
        steady.set_speed(speed);
        if levels.is_empty() {
            return Ok(());
        }
        let rows: Vec<f64> = at.iter().map(|w| rpm(*w)).collect();
        let range = Operating::new(self.case);
        // A distance from a fixed frequency is none of the speed.
        let orders_kept = self.case.limits.separation.iter().filter(|l| !l.orders.is_empty());
        let margins = orders_kept.map(|l| l.margin.si());
        let marked = draw::Marked {
            running: rpm(speed),
            operating: [rpm(range.from), rpm(range.to)],
            margin: margins.fold(0.0, f64::max),
        };
        self.out.figures.push(draw::campbell(&rows, &levels, orders, found, &marked));
        let mut table = Series { axis: column("speed", "rpm", rows.clone()), columns: Vec::new() };
        for (k, level) in levels.into_iter().enumerate() {
            table.columns.push(column(format!("mode{}", k + 1), "Hz", level));
        }
        for o in orders {
            let ray = rows.iter().map(|s| o * s / 60.0).collect();
            table.columns.push(column(format!("order{o}"), "Hz", ray));
        }
        self.out.tables.insert("interference".into(), table);
        Ok(())
    }

    /// Lowest and highest natural frequencies of the load steps in the Campbell diagram, of modes that a coupling moves with its mean torque.
    ///
    /// # Errors
    /// No convergence.
    pub fn campbell_by_step(&mut self, steps: &mut [Step<'_, '_>]) -> Result<(), EvalError> {
        let Some(table) = self.out.tables.get_mut("interference").filter(|_| steps.len() > 1) else {
            return Ok(());
        };
        let speeds: Vec<f64> = table.axis.values.iter().map(|s| s * PI / 30.0).collect();
        let mut all = Vec::new();
        for s in steps.iter_mut() {
            let steady = &mut s.machine.steady;
            let speed = steady.speed;
            let here = steady.frequencies(MODES)?;
            all.push(levels(steady, &speeds, &here)?);
            steady.set_speed(speed);
        }
        let mut lines = Vec::new();
        for k in 0..all.iter().map(Vec::len).min().unwrap_or(0) {
            let ends = |i: usize| extremes(all.iter().map(|levels| levels[k][i]));
            if table.get(&format!("mode{}", k + 1)).is_none()
                || (0..speeds.len()).all(|i| ends(i)[0] - ends(i)[1] <= SAME * ends(i)[0])
            {
                continue;
            }
            for (end, what) in [(1, "lowest"), (0, "highest")] {
                let name = format!("mode{}.{what}", k + 1);
                let values = (0..speeds.len()).map(|i| ends(i)[end]).collect();
                table.columns.push(column(name.clone(), "Hz", values));
                lines.push((format!("mode {}, {what} of the load steps", k + 1), name));
            }
        }
        let diagram = self.out.figures.iter_mut().find(|f| f.title == draw::CAMPBELL);
        if let Some(FigureKind::Lines(own)) = diagram.map(|f| &mut f.kind) {
            own.lines.extend(lines);
        }
        Ok(())
    }

    /// Largest step of a method with fixed steps that lets no mode grow that the line damps.
    pub fn stable_step(&mut self, modes: &[Mode]) {
        let torsion = &self.case.models.torsion;
        let grows = |re: f64, im: f64| torsion.grows([re, im]).unwrap_or(false);
        if torsion.grows([0.0, 0.0]).is_none() {
            return;
        }
        let limit = |m: &Mode| {
            let (decay, w) = m.damped.unwrap_or((0.0, m.omega));
            let (mut low, mut high) = (0.0, 4.0 / elementary::hypot(decay, w));
            for k in 1..=400 {
                let h = high * f64::from(k) / 400.0;
                if grows(-decay * h, w * h) {
                    (low, high) = (high * f64::from(k - 1) / 400.0, h);
                    break;
                }
            }
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if grows(-decay * middle, w * middle) {
                    high = middle;
                } else {
                    low = middle;
                }
            }
            low
        };
        let least = modes
            .iter()
            .filter(|m| m.omega > 0.0 && m.damped.is_some())
            .map(limit)
            .fold(f64::INFINITY, f64::min);
        if least.is_finite() {
            self.result(
                "stable_step",
                least,
                "s",
                "largest step of the method at which no mode grows by the method",
            );
        }
    }
}

/// Table of critical speeds.
fn critical_speed_table(found: &[CriticalSpeed]) -> Series {
    let of = |f: &dyn Fn(&CriticalSpeed) -> f64| found.iter().map(f).collect::<Vec<f64>>();
    Series {
        axis: column("speed", "rpm", of(&|c| rpm(c.speed))),
        columns: vec![
            column("mode", "", of(&|c| c.mode as f64)),
            column("order", "", of(&|c| c.order)),
            column("frequency", "Hz", of(&|c| c.omega / (2.0 * PI))),
            column("damping_ratio", "", of(&|c| c.damping_ratio)),
        ],
    }
}

/// Natural frequencies \[Hz\] over speeds, of the modes that are there at every one.
fn levels(steady: &mut Steady, speeds: &[f64], at_mean_speed: &[f64]) -> Result<Vec<Vec<f64>>, EvalError> {
    let mut levels: Vec<Vec<f64>> = vec![Vec::with_capacity(speeds.len()); at_mean_speed.len()];
    for w in speeds {
        let omega = if steady.depends_on_speed() {
            steady.set_speed(*w);
            steady.frequencies(MODES)?
        } else {
            at_mean_speed.to_vec()
        };
        for (level, w) in levels.iter_mut().zip(omega) {
            level.push(w / (2.0 * PI));
        }
    }
    levels.retain(|l| l.len() == speeds.len());
    Ok(levels)
}
