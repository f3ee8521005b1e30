//! Throws on their own.

use std::f64::consts::PI;

use gudgeon_core::kinds::LineThrow;
use gudgeon_core::result::Series;
use gudgeon_torsion::forcing::{gas_period, gas_series};

use super::{DRAWN, MOST, Results, TURN, column, extremes};

impl Results<'_> {
    /// Gas torque, work and inertia of the throws at constant speed.
    pub fn throws(&mut self, throws: &[LineThrow]) {
        let speed = self.case.speed.si();
        let mut table = Series { axis: column("angle", "deg", Vec::new()), columns: Vec::new() };
        let mut curves = Vec::new();
        for (k, t) in throws.iter().enumerate() {
            let n = k + 1;
            self.result(
                format!("throw{n}.mean_inertia"),
                t.inertia.mean(),
                "kg m2",
                format!("mean inertia of throw {n}"),
            );
            if t.ends.is_empty() {
                continue;
            }
            let period = gas_period(t);
            let mean = gas_series(t, 1)[0].re;
            let points = (TURN as f64 * period / (2.0 * PI)) as usize;
            let at = |i: usize| period * i as f64 / points as f64;
            let values: Vec<f64> =
                (0..=points).map(|i| t.gas_torque(at(i) - t.phase, at(i) - t.phase)).collect();
            // Either side of the angles where the pressure jumps.
            let kinks = t.ends.iter().flat_map(|e| e.pressure.kinks().iter().copied());
            let sides =
                kinks.flat_map(|x| [x - 1e-9, x + 1e-9]).map(|x| t.gas_torque(x - t.phase, x - t.phase));
            let [top, bottom] = extremes(values.iter().copied().chain(sides));
            let of = format!("throw {n}");
            self.result(
                format!("throw{n}.mean_torque"),
                mean,
                "N m",
                format!("mean gas torque of {of}, in the direction of rotation"),
            );
            self.result(format!("throw{n}.torque_max"), top, "N m", format!("largest gas torque of {of}"));
            self.result(
                format!("throw{n}.torque_min"),
                bottom,
                "N m",
                format!("smallest gas torque of {of}"),
            );
            self.result(
                format!("throw{n}.work"),
                mean * period,
                "J",
                format!("work of the gas on {of} per cycle"),
            );
            let power = mean * speed;
            self.result(
                format!("throw{n}.power"),
                power / 1e3,
                "kW",
                format!("mean power of the gas on {of}"),
            );
            if t.ends.len() == 1 {
                for e in &t.ends {
                    let [p, least] = extremes(
                        e.pressure
                            .kinks()
                            .iter()
                            .map(|x| x - 1e-9)
                            .chain((0..=points).map(at))
                            .map(|x| e.pressure.pressure(x)),
                    );
                    self.result(
                        format!("throw{n}.p_min"),
                        least / 1e5,
                        "bar",
                        format!("lowest pressure of {of}, of the same points"),
                    );
                    self.result(format!("throw{n}.p_max"), p / 1e5, "bar", format!("highest pressure of {of}, of points a quarter of a degree apart and before its kinks"));
                }
            }
            if k < MOST {
                if table.axis.values.len() < points / DRAWN {
                    table.axis.values = (0..=points).step_by(DRAWN).map(|i| at(i).to_degrees()).collect();
                }
                let name = format!("throw{n}.torque");
                let rows = (0..table.axis.values.len()).map(|i| values[i * DRAWN % points]).collect();
                table.columns.push(column(name.clone(), "N m", rows));
                curves.push((of, name));
                if t.ends.len() <= 2 && k == 0 {
                    for (j, e) in t.ends.iter().enumerate() {
                        let rows =
                            (0..table.axis.values.len()).map(|i| e.pressure.pressure(at(i * DRAWN)) / 1e5);
                        table.columns.push(column(format!("throw{n}.end{}.p", j + 1), "bar", rows.collect()));
                    }
                }
            }
        }
        if !curves.is_empty() {
            // Throws with the same curve are drawn once.
            let mut drawn: Vec<(String, String)> = Vec::new();
            for (label, name) in curves {
                let same = drawn.iter().position(|(_, d)| {
                    table.get(d).map(|c| &c.values) == table.get(&name).map(|c| &c.values)
                });
                match same {
                    Some(i) => drawn[i].0 = format!("{}, {}", drawn[i].0, label.trim_start_matches("throw ")),
                    None => drawn.push((label, name)),
                }
            }
            self.lines(
                "Gas torque",
                "of each throw over its own angle, in the direction of rotation",
                "throws",
                "angle",
                drawn,
                false,
            );
            let p: Vec<(String, String)> = table
                .columns
                .iter()
                .filter(|c| c.unit == "bar")
                .enumerate()
                .map(|(j, c)| (format!("end {}", j + 1), c.name.clone()))
                .collect();
            if !p.is_empty() {
                self.lines("Gas pressure", "at the ends of throw 1", "throws", "angle", p, false);
            }
            self.out.tables.insert("throws".into(), table);
        }
    }
}
