//! Throws on their own.

use std::f64::consts::PI;
use std::rc::Rc;

use gudgeon_core::kinds::LineThrow;
use gudgeon_core::result::{Figure, FigureKind, Series};
use gudgeon_torsion::forcing::{gas_period, gas_series};

use crate::assemble::Assembled;
use crate::case::{EndCase, Side};

use super::{DRAWN, MAX_DRAWN, Results, TURN, column, extremes};

/// Angle to either side of a jump of the pressure at which it is evaluated.
const BESIDE: f64 = 1e-9;

/// Gas pressures of a throw over its own angle: the same of all throws that are alike.
#[derive(Debug)]
pub(super) struct Pressures {
    period: f64,
    points: usize,
    /// By gas space and point \[Pa\].
    ends: Vec<Vec<f64>>,
}

impl Pressures {
    fn new(t: &LineThrow) -> Self {
        let period = gas_period(t);
        let points = (TURN as f64 * period / (2.0 * PI)) as usize;
        let mut own = Self { period, points, ends: Vec::new() };
        own.ends = t.ends.iter().map(|e| own.angles().map(|x| e.pressure.pressure(x)).collect()).collect();
        own
    }

    fn at(&self, i: usize) -> f64 {
        self.period * i as f64 / self.points as f64
    }

    fn angles(&self) -> impl Iterator<Item = f64> + '_ {
        (0..=self.points).map(|i| self.at(i))
    }
}

/// Gas torque of a throw over its own angle, and what follows from it: the same of all throws that are alike.
struct Course {
    pressures: Rc<Pressures>,
    torque: Vec<f64>,
    mean: f64,
    /// Maximum and minimum of the torque, either side of the angles where the pressure jumps included.
    torque_range: [f64; 2],
    /// Maximum and minimum pressure where there is one gas space.
    pressure_range: Option<[f64; 2]>,
}

impl Course {
    fn new(t: &LineThrow, pressures: Rc<Pressures>) -> Self {
        let torque_at = |(i, x): (usize, f64)| -> f64 {
            t.ends.iter().zip(&pressures.ends).map(|(e, p)| e.torque_of(p[i], x)).sum()
        };
        let torque: Vec<f64> = pressures.angles().enumerate().map(torque_at).collect();
        let kinks = t.ends.iter().flat_map(|e| e.pressure.kinks().iter().copied());
        let beside = kinks.flat_map(|x| [x - BESIDE, x + BESIDE]);
        let sides = beside.map(|x| t.ends.iter().map(|e| e.torque(x, x)).sum());
        let torque_range = extremes(torque.iter().copied().chain(sides));
        let pressure_range = match (&t.ends[..], &pressures.ends[..]) {
            ([end], [own]) => {
                let before_kinks = end.pressure.kinks().iter().map(|x| end.pressure.pressure(x - BESIDE));
                Some(extremes(before_kinks.chain(own.iter().copied())))
            }
            _ => None,
        };
        Self { torque, mean: gas_series(t, 1)[0].re, torque_range, pressure_range, pressures }
    }
}

/// Mean torque \[N m\], largest force of the gas to and from the crank \[kN\], highest pressure of head and crank ends \[bar\].
fn loads(t: &LineThrow, ends: &[EndCase], pressures: &Pressures) -> [Option<f64>; 5] {
    let force = |k: usize| -> f64 {
        let own = t.ends.iter().zip(ends).zip(&pressures.ends);
        own.map(|((g, e), p)| {
            let sign = if e.side == Side::Head { 1.0 } else { -1.0 };
            sign * (p[k] - g.back_pressure) * g.area
        })
        .sum()
    };
    let [most, least] = extremes((0..pressures.points).map(force));
    let highest = |side: Side| {
        let own = ends.iter().zip(&pressures.ends).filter(|(e, _)| e.side == side);
        own.flat_map(|(_, p)| p).map(|p| p / 1e5).reduce(f64::max)
    };
    [
        Some(gas_series(t, 1)[0].re),
        Some(most.max(0.0) / 1e3),
        Some((-least).max(0.0) / 1e3),
        highest(Side::Head),
        highest(Side::Crank),
    ]
}

impl Results<'_> {
    /// Pressures of a throw, worked out once for all that are alike.
    fn pressures(&mut self, t: &LineThrow) -> Rc<Pressures> {
        if let Some((_, known)) = self.pressures.iter().find(|(other, _)| t.is_like(other)) {
            return Rc::clone(known);
        }
        let own = Rc::new(Pressures::new(t));
        self.pressures.push((t.clone(), Rc::clone(&own)));
        own
    }

    /// Gas torque, work and inertia of the throws at constant speed.
    pub fn throws(&mut self, throws: &[LineThrow]) {
        let mut table = Series { axis: column("angle", "deg", Vec::new()), columns: Vec::new() };
        let mut curves = Vec::new();
        let mut known: Option<(&LineThrow, Course)> = None;
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
            let course = match known.take() {
                Some((other, course)) if t.is_like(other) => course,
                _ => Course::new(t, self.pressures(t)),
            };
            self.torque_of_throw(n, &course);
            if let Some(range) = course.pressure_range {
                self.pressure_of_throw(n, range);
            }
            if k < MAX_DRAWN {
                curves.push((format!("throw {n}"), add_columns(&mut table, n, &course)));
            }
            known = Some((t, course));
        }
        if !curves.is_empty() {
            self.draw_throws(table, curves);
        }
    }

    /// Gas torque, work and power of throw `n`.
    fn torque_of_throw(&mut self, n: usize, course: &Course) {
        let (mean, [top, bottom]) = (course.mean, course.torque_range);
        let of = format!("throw {n}");
        self.result(
            format!("throw{n}.mean_torque"),
            mean,
            "N m",
            format!("mean gas torque of {of}, in the direction of rotation"),
        );
        self.result(format!("throw{n}.torque_max"), top, "N m", format!("largest gas torque of {of}"));
        self.result(format!("throw{n}.torque_min"), bottom, "N m", format!("smallest gas torque of {of}"));
        self.result(
            format!("throw{n}.work"),
            mean * course.pressures.period,
            "J",
            format!("work of the gas on {of} per cycle"),
        );
        let power = mean * self.case.speed.si();
        self.result(format!("throw{n}.power"), power / 1e3, "kW", format!("mean power of the gas on {of}"));
    }

    /// Maximum and minimum pressure of the one gas space of throw `n`.
    fn pressure_of_throw(&mut self, n: usize, [highest, lowest]: [f64; 2]) {
        let of = format!("throw {n}");
        self.result(
            format!("throw{n}.p_min"),
            lowest / 1e5,
            "bar",
            format!("lowest pressure of {of}, of the same points"),
        );
        self.result(
            format!("throw{n}.p_max"),
            highest / 1e5,
            "bar",
            format!("highest pressure of {of}, of points a quarter of a degree apart and before its kinks"),
        );
    }

    /// Gas loads of each kind of throw in every load step.
    pub fn gas_loads(&mut self, lines: &[&Assembled]) {
        let sides: Vec<&[EndCase]> =
            self.case.throws.iter().flat_map(|t| t.at.iter().map(|_| t.ends.as_slice())).collect();
        let steps = crate::steps::all(self.case);
        let mut rows = Vec::new();
        for (n, ends) in sides.iter().enumerate() {
            let alike = |a: &Assembled| {
                let all = &a.line.throws;
                n > 0 && all.get(n).zip(all.get(n - 1)).is_some_and(|(t, before)| t.is_like(before))
            };
            if ends.is_empty() || lines.iter().all(|a| alike(a)) {
                continue;
            }
            for (a, (step, _)) in lines.iter().zip(&steps) {
                let Some(t) = a.line.throws.get(n).filter(|t| t.ends.len() == ends.len()) else { continue };
                let name = &a.line.nodes[t.node].name;
                let label = if lines.len() > 1 { format!("{name}, {step}") } else { name.clone() };
                let pressures = self.pressures(t);
                rows.push((label, loads(t, ends, &pressures).to_vec()));
            }
        }
        if rows.is_empty() {
            return;
        }
        let columns = [
            ("mean gas torque", "N m"),
            ("force to the crank", "kN"),
            ("force from the crank", "kN"),
            ("highest pressure, head", "bar"),
            ("highest pressure, crank", "bar"),
        ];
        self.out.figures.push(Figure {
            title: "Gas loads".into(),
            hint: "of one of each run of equal throws: largest force of the gas on the piston either way, at the mean speed; without the forces of the moving masses".into(),
            table: String::new(),
            kind: FigureKind::Table {
                rows_are: "throw".into(),
                columns: columns.map(|(n, u)| (n.to_owned(), u.to_owned())).to_vec(),
                rows,
                texts: Vec::new(),
                limit: None,
            },
        });
    }

    fn draw_throws(&mut self, table: Series, curves: Vec<(String, String)>) {
        let hint = "of each throw over its own angle, in the direction of rotation";
        self.lines("Gas torque", hint, "throws", "angle", merged(&table, curves), false);
        let pressures: Vec<(String, String)> = table
            .columns
            .iter()
            .filter(|c| c.unit == "bar")
            .enumerate()
            .map(|(j, c)| (format!("end {}", j + 1), c.name.clone()))
            .collect();
        if !pressures.is_empty() {
            self.lines("Gas pressure", "at the ends of throw 1", "throws", "angle", pressures, false);
        }
        self.out.tables.insert("throws".into(), table);
    }
}

/// Adds the torque of throw `n` to the table, and the pressures of the first one; the name of the column of torque.
fn add_columns(table: &mut Series, n: usize, course: &Course) -> String {
    let Pressures { points, ends, .. } = &*course.pressures;
    if table.axis.values.len() < points / DRAWN {
        let angles = (0..=*points).step_by(DRAWN).map(|i| course.pressures.at(i).to_degrees());
        table.axis.values = angles.collect();
    }
    let rows = table.axis.values.len();
    let name = format!("throw{n}.torque");
    let torque = (0..rows).map(|i| course.torque[i * DRAWN % points]).collect();
    table.columns.push(column(name.clone(), "N m", torque));
    if ends.len() <= 2 && n == 1 {
        for (j, own) in ends.iter().enumerate() {
            let pressure = own.iter().step_by(DRAWN).map(|p| p / 1e5);
            table.columns.push(column(format!("throw{n}.end{}.p", j + 1), "bar", pressure.collect()));
        }
    }
    name
}

/// Throws with the same curve are drawn once.
fn merged(table: &Series, curves: Vec<(String, String)>) -> Vec<(String, String)> {
    let mut drawn: Vec<(String, String)> = Vec::new();
    for (label, name) in curves {
        let same = drawn
            .iter()
            .position(|(_, d)| table.get(d).map(|c| &c.values) == table.get(&name).map(|c| &c.values));
        match same {
            Some(i) => drawn[i].0 = format!("{}, {}", drawn[i].0, label.trim_start_matches("throw ")),
            None => drawn.push((label, name)),
        }
    }
    drawn
}
