//! What a line answers, as results, tables and figures.

use std::f64::consts::PI;

use gudgeon_core::kinds::{Line, LineThrow, Mode, TorsionOut};
use gudgeon_core::result::{Bar, Column, Figure, FigureKind, Note, RunResult, Series, Value};
use gudgeon_numerics::linalg::Complex;
use gudgeon_torsion::forcing::{gas_period, gas_series};
use gudgeon_torsion::speed_range::SpeedRange;

use super::assemble::Assembled;
use super::case::ShaftLineCase;
use super::{draw, rpm};

/// Points over a turn at which extremes are looked for and curves are drawn.
const TURN: usize = 1440;
/// Every how many of these points stands in the tables.
const DRAWN: usize = 4;
/// Modes, shafts and throws drawn at most.
const MOST: usize = 12;

/// Writer of results.
pub struct Results<'a> {
    case: &'a ShaftLineCase,
    out: &'a mut RunResult,
    /// Vibratory and largest torque of each link, from whatever response there was.
    torque: Vec<[f64; 2]>,
    heat: Vec<f64>,
}

fn column(name: impl Into<String>, unit: &str, values: Vec<f64>) -> Column {
    Column { name: name.into(), unit: unit.into(), values }
}

/// Largest and smallest of some values.
fn extremes(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::NEG_INFINITY, f64::INFINITY], |[a, b], v| [a.max(v), b.min(v)])
}

impl<'a> Results<'a> {
    pub fn new(case: &'a ShaftLineCase, out: &'a mut RunResult) -> Self {
        Self { case, out, torque: Vec::new(), heat: Vec::new() }
    }

    fn result(&mut self, name: impl Into<String>, value: f64, unit: &str, what: impl Into<String>) {
        self.out.results.insert(name.into(), Value { value, unit: unit.into(), what: what.into() });
    }

    pub fn count(&mut self, name: &str, n: u64) {
        *self.out.solver.counters.entry(name.into()).or_insert(0) += n;
    }

    pub fn note(&mut self, notes: &[Note]) {
        self.out.solver.notes.extend_from_slice(notes);
    }

    fn lines(
        &mut self,
        title: &str,
        hint: &str,
        table: &str,
        x: &str,
        lines: Vec<(String, String)>,
        log_y: bool,
    ) {
        self.out.figures.push(Figure {
            title: title.into(),
            hint: hint.into(),
            table: table.into(),
            kind: FigureKind::Lines { x: x.into(), lines, log_x: false, log_y },
        });
    }

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
                    decay / decay.hypot(omega),
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
            self.out.figures.push(draw::modes(line, &elastic[..elastic.len().min(MOST)]));
        }
    }

    /// Interference table and diagram.
    pub fn critical_speeds(&mut self, modes: &[Mode], a: &Assembled) {
        let r = &self.case.range;
        let speed = self.case.speed.si();
        let (from, to) = (r.from.map_or(0.0, |v| v.si()), r.to.map_or(2.0 * speed, |v| v.si()));
        let step = 2.0 * PI / a.period;
        let most = (r.interference_orders.si() / step + 1e-9).floor() as usize;
        let orders: Vec<f64> = (1..=most).map(|k| k as f64 * step).collect();
        let elastic: Vec<&Mode> = modes.iter().filter(|m| m.omega > 0.0).collect();
        let mut rows: Vec<[f64; 4]> = Vec::new();
        let mut nearest: Option<[f64; 4]> = None;
        for (k, m) in elastic.iter().enumerate() {
            for o in &orders {
                let at = m.omega / o;
                let row = [rpm(at), (k + 1) as f64, *o, m.omega / (2.0 * PI)];
                let better = |n: &[f64; 4]| (rpm(speed) - row[0]).abs() < (rpm(speed) - n[0]).abs();
                if nearest.as_ref().is_none_or(better) {
                    nearest = Some(row);
                }
                if at >= from && at <= to {
                    rows.push(row);
                }
            }
        }
        rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
        self.result(
            "critical_speeds",
            rows.len() as f64,
            "",
            "number of critical speeds within the range, table `critical_speeds`",
        );
        for r in &rows {
            let name = format!("critical_speed.mode{}.order{}", r[1], r[2]);
            self.result(name, r[0], "rpm", format!("speed at which order {} excites mode {}", r[2], r[1]));
        }
        if let Some(n) = nearest {
            self.result(
                "nearest_critical_speed",
                n[0],
                "rpm",
                format!("critical speed next to the running one: order {} and mode {}", n[2], n[1]),
            );
            let distance = (rpm(speed) - n[0]) / n[0];
            self.result("distance_to_critical", 100.0 * distance, "%", "of the running speed from that one");
        }
        let of = |k: usize| rows.iter().map(|r| r[k]).collect::<Vec<f64>>();
        let table = Series {
            axis: column("speed", "rpm", of(0)),
            columns: vec![
                column("mode", "", of(1)),
                column("order", "", of(2)),
                column("frequency", "Hz", of(3)),
            ],
        };
        self.out.tables.insert("critical_speeds".into(), table);
        // The diagram: orders as rays, modes as levels.
        let n = 60;
        let at: Vec<f64> = (0..=n).map(|i| rpm(from + (to - from) * f64::from(i) / f64::from(n))).collect();
        let mut table = Series { axis: column("speed", "rpm", at.clone()), columns: Vec::new() };
        for (k, m) in elastic.iter().enumerate() {
            table.columns.push(column(format!("mode{}", k + 1), "Hz", vec![m.omega / (2.0 * PI); at.len()]));
        }
        for o in &orders {
            table.columns.push(column(format!("order{o}"), "Hz", at.iter().map(|s| o * s / 60.0).collect()));
        }
        if !elastic.is_empty() {
            self.out.figures.push(draw::interference(&elastic, &orders, speed, (rpm(from), rpm(to))));
            self.out.tables.insert("interference".into(), table);
        }
    }

    /// Vibration at constant mean speed.
    pub fn periodic(&mut self, out: &TorsionOut, a: &Assembled) {
        for (name, n) in &out.counters {
            self.count(name, *n);
        }
        self.note(&out.notes);
        let (links, nodes) = (a.line.links.len(), a.line.nodes.len());
        let turns = a.period / (2.0 * PI);
        let points = (TURN as f64 * turns).round() as usize;
        let mut torque = vec![vec![0.0; points + 1]; links];
        let mut swing = vec![vec![0.0; points + 1]; nodes];
        for i in 0..=points {
            let at = a.period * i as f64 / points as f64;
            for (l, t) in torque.iter_mut().enumerate() {
                t[i] = out.mean_torque[l];
            }
            for o in &out.orders {
                let (sin, cos) = (o.order * at).sin_cos();
                for (t, p) in torque.iter_mut().zip(&o.torque) {
                    t[i] += p[0] * cos - p[1] * sin;
                }
                let rate = o.order * out.speed;
                for (w, p) in swing.iter_mut().zip(&o.angle) {
                    w[i] -= rate * (p[0] * sin + p[1] * cos);
                }
            }
        }
        self.result("balance_torque", out.balance_torque, "N m", "mean torque that holds the mean speed");
        let mut series = Series {
            axis: column(
                "angle",
                "deg",
                (0..=points).step_by(DRAWN).map(|i| 360.0 * turns * i as f64 / points as f64).collect(),
            ),
            columns: Vec::new(),
        };
        let (mut torques, mut stresses, mut speeds) = (Vec::new(), Vec::new(), Vec::new());
        for l in 0..links {
            let name = &a.line.links[l].name;
            let n = l + 1;
            let [top, bottom] = extremes(torque[l].iter().copied());
            let vibratory = 0.5 * (top - bottom);
            self.torque.push([vibratory, top.abs().max(bottom.abs())]);
            self.result(
                format!("shaft{n}.mean_torque"),
                out.mean_torque[l],
                "N m",
                format!("mean torque of {name}"),
            );
            self.result(format!("shaft{n}.torque_max"), top, "N m", format!("largest torque of {name}"));
            self.result(format!("shaft{n}.torque_min"), bottom, "N m", format!("smallest torque of {name}"));
            self.result(
                format!("shaft{n}.torque_amplitude"),
                vibratory,
                "N m",
                format!("half of peak to peak torque of {name}"),
            );
            let strongest = out.orders.iter().max_by(|x, y| {
                x.torque[l][0].hypot(x.torque[l][1]).total_cmp(&y.torque[l][0].hypot(y.torque[l][1]))
            });
            if let Some(o) = strongest {
                self.result(
                    format!("shaft{n}.strongest_order"),
                    o.order,
                    "",
                    format!("order of the largest torque in {name}"),
                );
            }
            self.law(l, out.mean_torque[l], a, "at its mean torque");
            let heat: f64 = out.orders.iter().map(|o| o.heat[l]).sum();
            self.heat.push(heat);
            self.result(format!("shaft{n}.heat"), heat, "W", format!("mean power lost in {name}"));
            if let Some(s) = a.stress[l] {
                self.result(
                    format!("shaft{n}.stress_amplitude"),
                    s * vibratory / 1e6,
                    "MPa",
                    format!("half of peak to peak shear stress of {name}"),
                );
                self.result(
                    format!("shaft{n}.stress_max"),
                    s * top.abs().max(bottom.abs()) / 1e6,
                    "MPa",
                    format!("largest shear stress of {name}"),
                );
            }
            if l < MOST {
                let rows = |f: f64| torque[l].iter().step_by(DRAWN).map(|t| t * f).collect::<Vec<f64>>();
                series.columns.push(column(format!("shaft{n}.torque"), "N m", rows(1.0)));
                torques.push((name.clone(), format!("shaft{n}.torque")));
                if let Some(s) = a.stress[l] {
                    series.columns.push(column(format!("shaft{n}.stress"), "MPa", rows(s / 1e6)));
                    stresses.push((name.clone(), format!("shaft{n}.stress")));
                }
            }
        }
        for i in 0..nodes {
            let name = &a.line.nodes[i].name;
            let n = i + 1;
            let [top, bottom] = extremes(swing[i].iter().copied());
            let mean = out.speed * a.line.nodes[i].ratio.abs();
            self.result(
                format!("inertia{n}.speed_swing"),
                top - bottom,
                "rad/s",
                format!("peak to peak speed of {name}"),
            );
            self.result(
                format!("inertia{n}.irregularity"),
                (top - bottom) / mean,
                "",
                format!("degree of irregularity of {name}: speed swing by mean speed"),
            );
            let amplitude = out.orders.iter().map(|o| o.angle[i][0].hypot(o.angle[i][1])).fold(0.0, f64::max);
            self.result(
                format!("inertia{n}.angle_amplitude"),
                amplitude.to_degrees(),
                "deg",
                format!("largest amplitude of a single order of {name}"),
            );
            if i < MOST {
                let rows = swing[i].iter().step_by(DRAWN).copied().collect();
                series.columns.push(column(format!("inertia{n}.speed"), "rad/s", rows));
                speeds.push((name.clone(), format!("inertia{n}.speed")));
            }
        }
        let over = if turns > 1.5 { "over two turns" } else { "over a turn" };
        self.out.series = series;
        self.lines("Torque in the shafts", over, "series", "angle", torques, false);
        if !stresses.is_empty() {
            self.lines(
                "Shear stress",
                &format!("{over}, concentration factors included"),
                "series",
                "angle",
                stresses,
                false,
            );
        }
        self.lines(
            "Speed fluctuation",
            &format!("{over}, against the mean speed"),
            "series",
            "angle",
            speeds,
            false,
        );
        // Spectra.
        let mut table = Series {
            axis: column("order", "", out.orders.iter().map(|o| o.order).collect()),
            columns: Vec::new(),
        };
        for l in 0..links {
            let rows = out.orders.iter().map(|o| o.torque[l][0].hypot(o.torque[l][1])).collect();
            table.columns.push(column(format!("shaft{}.torque", l + 1), "N m", rows));
            if let Some(s) = a.stress[l] {
                let rows =
                    out.orders.iter().map(|o| s / 1e6 * o.torque[l][0].hypot(o.torque[l][1])).collect();
                table.columns.push(column(format!("shaft{}.stress", l + 1), "MPa", rows));
            }
        }
        for i in 0..nodes {
            let rows = out.orders.iter().map(|o| o.angle[i][0].hypot(o.angle[i][1])).collect();
            table.columns.push(column(format!("inertia{}.angle", i + 1), "rad", rows));
        }
        for o in out.orders.iter().take(12) {
            for l in 0..links {
                let size = o.torque[l][0].hypot(o.torque[l][1]);
                let name = format!("shaft{}.order{}", l + 1, o.order);
                self.result(
                    name,
                    size,
                    "N m",
                    format!("torque of order {} in {}", o.order, a.line.links[l].name),
                );
            }
        }
        self.out.tables.insert("orders".into(), table);
        let worst = (0..links).max_by(|x, y| self.torque[*x][0].total_cmp(&self.torque[*y][0]));
        if let Some(l) = worst {
            let bars = out
                .orders
                .iter()
                .take(24)
                .map(|o| Bar {
                    label: format!("order {}", o.order),
                    value: o.torque[l][0].hypot(o.torque[l][1]),
                    limit: None,
                })
                .collect();
            self.out.figures.push(Figure {
                title: format!("Order spectrum of {}", a.line.links[l].name),
                hint: "torque amplitude per order, in the shaft that vibrates most; table `orders` has all"
                    .into(),
                table: String::new(),
                kind: FigureKind::Bars { unit: "N m".into(), bars },
            });
        }
        if links > 0 {
            let bars = (0..links.min(24))
                .map(|l| Bar {
                    label: a.line.links[l].name.clone(),
                    value: self.torque[l][0],
                    limit: self.torque_limit(&a.line.links[l].name),
                })
                .collect();
            self.out.figures.push(Figure {
                title: "Vibratory torque".into(),
                hint: "half of peak to peak, with the limits that the case names".into(),
                table: String::new(),
                kind: FigureKind::Bars { unit: "N m".into(), bars },
            });
        }
    }

    /// Stiffness and damping of a link at a mean torque; a rigid one has neither.
    fn law(&mut self, l: usize, mean_torque: f64, a: &Assembled, about: &str) {
        let (n, name) = (l + 1, &a.line.links[l].name);
        let law = a.line.links[l].coupling.linear(0.0, mean_torque);
        if law.stiffness.is_finite() {
            self.result(
                format!("shaft{n}.stiffness"),
                law.stiffness,
                "N m/rad",
                format!("stiffness of {name} {about}"),
            );
            self.result(
                format!("shaft{n}.damping"),
                law.damping,
                "N m s/rad",
                format!("viscous damping of {name}"),
            );
        }
    }

    fn torque_limit(&self, name: &str) -> Option<f64> {
        self.case.limits.torque.iter().find(|t| t.shaft == name).and_then(|t| t.amplitude).map(|t| t.si())
    }

    /// Largest step of the fixed-step Runge-Kutta method that damps every mode: `|1 + x + x²/2 + x³/6 + x⁴/24| ≤ 1`, `x = h z`.
    pub fn stable_step(&mut self, modes: &[Mode]) {
        let grows = |re: f64, im: f64| {
            let x = Complex::new(re, im);
            let real = |v: f64| Complex::new(v, 0.0);
            let r =
                real(1.0) + x * (real(1.0) + x * (real(0.5) + x * (real(1.0 / 6.0) + x * real(1.0 / 24.0))));
            r.abs() > 1.0 + 1e-12
        };
        let limit = |m: &Mode| {
            let (decay, w) = m.damped.unwrap_or((0.0, m.omega));
            let (mut low, mut high) = (0.0, 4.0 / decay.hypot(w));
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
                "largest step of the Runge-Kutta method at which no mode grows by the method",
            );
        }
    }

    /// Motion over time.
    pub fn transient(&mut self, out: &TorsionOut, a: &Assembled, rows: usize) {
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
            let [top, bottom] = extremes(window.clone().map(|r| torque(l, r)));
            let [all, least] = extremes((0..n).map(|r| torque(l, r)));
            self.torque.push([0.5 * (top - bottom), all.abs().max(least.abs())]);
            self.result(
                format!("shaft{k}.torque_amplitude"),
                0.5 * (top - bottom),
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
            self.heat.push(heat);
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
    }

    /// Vibratory torque over the speed.
    pub fn range(&mut self, range: &SpeedRange, speeds: &[f64], a: &Assembled) {
        self.count("linear_solutions", range.solutions);
        let links = a.line.links.len();
        let mut table = Series {
            axis: column("speed", "rpm", speeds.iter().map(|w| rpm(*w)).collect()),
            columns: Vec::new(),
        };
        // Half of peak to peak over the cycle; 240 points a turn find it to a few thousandths of the highest orders that matter.
        let points = (240.0 * a.period / (2.0 * PI)).round() as usize;
        let turns: Vec<Vec<(f64, f64)>> = range
            .orders
            .iter()
            .map(|o| (0..points).map(|i| (o * a.period * i as f64 / points as f64).sin_cos()).collect())
            .collect();
        let mut curves = Vec::new();
        let mut strongest: Vec<(f64, usize)> = (0..range.orders.len()).map(|k| (0.0, k)).collect();
        let mut top = (0.0, 0, 0);
        for l in 0..links {
            let mut rows = Vec::with_capacity(speeds.len());
            for (s, by_order) in range.torque.iter().enumerate() {
                let mut wave = vec![0.0; points];
                for (k, t) in by_order.iter().enumerate() {
                    let [re, im] = t[l];
                    strongest[k].0 = strongest[k].0.max(re.hypot(im));
                    for (w, (sin, cos)) in wave.iter_mut().zip(&turns[k]) {
                        *w += re * cos - im * sin;
                    }
                }
                let [high, low] = extremes(wave.into_iter());
                let v = if high >= low { 0.5 * (high - low) } else { 0.0 };
                if v > top.0 {
                    top = (v, l, s);
                }
                rows.push(v);
            }
            let name = format!("shaft{}.torque_amplitude", l + 1);
            let [most, _] = extremes(rows.iter().copied());
            self.result(
                format!("range.shaft{}.torque_amplitude", l + 1),
                most,
                "N m",
                format!("largest vibratory torque of {} over the speed range", a.line.links[l].name),
            );
            table.columns.push(column(name.clone(), "N m", rows));
            if l < MOST {
                curves.push((a.line.links[l].name.clone(), name));
            }
        }
        self.result(
            "range.worst_speed",
            rpm(speeds[top.2]),
            "rpm",
            "speed of the largest vibratory torque of any shaft",
        );
        self.lines(
            "Vibratory torque over the speed",
            "half of peak to peak",
            "speed_range",
            "speed",
            curves,
            false,
        );
        // The strongest orders of the shaft that has the largest torque.
        strongest.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut curves = Vec::new();
        for (_, k) in strongest.iter().take(6) {
            let name = format!("shaft{}.order{}", top.1 + 1, range.orders[*k]);
            let rows = range.torque.iter().map(|r| r[*k][top.1][0].hypot(r[*k][top.1][1])).collect();
            table.columns.push(column(name.clone(), "N m", rows));
            curves.push((format!("order {}", range.orders[*k]), name));
        }
        if let Some(l) = a.line.links.get(top.1) {
            self.lines(
                &format!("Orders of {} over the speed", l.name),
                "torque amplitude of the strongest orders",
                "speed_range",
                "speed",
                curves,
                false,
            );
        }
        self.out.tables.insert("speed_range".into(), table);
    }

    /// Holds results against the limits of the case.
    pub fn verdict(&mut self, modes: &[Mode], response: Option<&TorsionOut>, a: &Assembled) {
        let limits = self.case.limits.clone();
        let speed = self.case.speed.si();
        let mut verdicts: Vec<(String, f64, String, String)> = Vec::new();
        for l in &limits.separation {
            let lines = l
                .orders
                .iter()
                .map(|o| (format!("order {o}"), o * speed / (2.0 * PI)))
                .chain(l.frequencies.iter().map(|f| (format!("{} Hz", f.si()), f.si())));
            for (what, f) in lines {
                let nearest = modes
                    .iter()
                    .filter(|m| m.omega > 0.0)
                    .map(|m| (m.omega / (2.0 * PI) - f).abs() / f)
                    .fold(f64::INFINITY, f64::min);
                if nearest.is_finite() {
                    let used = l.margin.si() / nearest.max(1e-12);
                    let text = format!(
                        "the nearest natural frequency is {:.1} % away, {:.1} % are wanted",
                        100.0 * nearest,
                        100.0 * l.margin.si()
                    );
                    verdicts.push((format!("separation from {what}"), used, text, l.source.clone()));
                }
            }
        }
        if response.is_some() {
            let at = |name: &str| a.line.links.iter().position(|l| l.name == name);
            for l in &limits.torque {
                let Some(k) = at(&l.shaft) else { continue };
                for (what, value, limit) in [
                    ("torque in", self.torque[k][0], l.amplitude),
                    ("peak torque in", self.torque[k][1], l.peak),
                ] {
                    if let Some(limit) = limit {
                        let text = format!("{value:.4e} N m of {:.4e} N m", limit.si());
                        verdicts.push((
                            format!("{what} {}", l.shaft),
                            value / limit.si(),
                            text,
                            l.source.clone(),
                        ));
                    }
                }
            }
            for l in &limits.stress {
                for k in 0..a.line.links.len() {
                    let name = &a.line.links[k].name;
                    let Some(s) = a.stress[k].filter(|_| l.shaft.is_empty() || l.shaft == *name) else {
                        continue;
                    };
                    let value = s * self.torque[k][0];
                    let text = format!("{:.4} MPa of {:.4} MPa", value / 1e6, l.amplitude.si() / 1e6);
                    verdicts.push((
                        format!("stress in {name}"),
                        value / l.amplitude.si(),
                        text,
                        l.source.clone(),
                    ));
                }
            }
            for l in &limits.heat {
                let Some(k) = at(&l.shaft) else { continue };
                let text = format!("{:.4e} W of {:.4e} W", self.heat[k], l.power.si());
                verdicts.push((
                    format!("heat of {}", l.shaft),
                    self.heat[k] / l.power.si(),
                    text,
                    l.source.clone(),
                ));
            }
        }
        if verdicts.is_empty() {
            return;
        }
        let over: Vec<&(String, f64, String, String)> = verdicts.iter().filter(|v| v.1 > 1.0).collect();
        let mut notes: Vec<Note> = over
            .iter()
            .map(|(what, _, text, source)| {
                Note::caution("beyond_limit", format!("beyond the limit: {what}: {text} ({source})"))
            })
            .collect();
        notes.insert(
            0,
            match over.len() {
                0 => Note::info("verdict", format!("verdict: all {} limits are kept", verdicts.len())),
                n => Note::caution(
                    "verdict",
                    format!("verdict: {n} of {} limits are not kept", verdicts.len()),
                ),
            },
        );
        let broken = over.len() as f64;
        self.note(&notes);
        self.result("limits_broken", broken, "", "number of limits that are not kept");
        let worst = verdicts.iter().map(|v| v.1).fold(0.0, f64::max);
        self.result(
            "worst_utilisation",
            worst,
            "",
            "largest share of a limit that is used; above 1 it is broken",
        );
        let bars = verdicts
            .into_iter()
            .map(|(label, value, ..)| Bar { label, value: value.min(100.0), limit: Some(1.0) })
            .collect();
        self.out.figures.insert(
            0,
            Figure {
                title: "Verdict".into(),
                hint: "share of each limit that is used; beyond 1 it is broken".into(),
                table: String::new(),
                kind: FigureKind::Bars { unit: String::new(), bars },
            },
        );
    }
}
