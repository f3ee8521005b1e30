//! One recorded cycle: the series, and the results that follow from it.

use gudgeon_core::EvalError;
use gudgeon_core::result::{Column, Event, Series, Value};
use gudgeon_skirt::{Instant, Piston};
use indexmap::IndexMap;

use super::assemble::Assembly;
use super::case::PistonSecondaryCase;
use super::plan::{AT, EXTREMES, ResultInfo, tidy};

/// Columns of the series: name and unit.
const COLUMNS: [(&str, &str); 33] = [
    ("piston.v", "m/s"),
    ("piston.a", "m/s2"),
    ("cylinder.p", "Pa"),
    ("skirt.e_top", "m"),
    ("skirt.e_bottom", "m"),
    ("skirt.e_top_rate", "m/s"),
    ("skirt.e_bottom_rate", "m/s"),
    ("skirt.tilt", "rad"),
    ("skirt.side_force", "N"),
    ("skirt.side_moment", "N m"),
    ("skirt.friction_force", "N"),
    ("skirt.friction_power", "W"),
    ("skirt.lateral_energy", "J"),
    ("rod.side_force", "N"),
    ("pin.moment", "N m"),
    ("rings.side_force", "N"),
    ("inertia.force", "N"),
    ("thrust.film_force", "N"),
    ("thrust.contact_force", "N"),
    ("thrust.viscous_force", "N"),
    ("thrust.rubbing_force", "N"),
    ("thrust.h_min", "m"),
    ("thrust.p_max", "Pa"),
    ("anti_thrust.film_force", "N"),
    ("anti_thrust.contact_force", "N"),
    ("anti_thrust.viscous_force", "N"),
    ("anti_thrust.rubbing_force", "N"),
    ("anti_thrust.h_min", "m"),
    ("anti_thrust.p_max", "Pa"),
    ("skirt.oil_up", "m3/s"),
    ("skirt.oil_down", "m3/s"),
    ("skirt.oil_aside", "m3/s"),
    ("skirt.yield", "m"),
];
/// Of these, the ones of oil flow and of yielding, which are not always there.
const OIL: std::ops::Range<usize> = 29..32;
const YIELD: usize = 32;

/// Pressures over one side at a crank angle.
#[derive(Debug, Clone, Default)]
pub struct Map {
    /// Crank angle \[deg\].
    pub theta_deg: f64,
    /// Pressure above that of the crankcase \[Pa\] at the nodes of the whole side.
    pub p: Vec<f64>,
}

/// What is recorded of a cycle.
pub enum Rows {
    /// All that the case asks for; `flows`: with the oil that crosses the edges.
    All {
        /// With the oil that crosses the edges.
        flows: bool,
    },
    /// How far this piston, the same with shapes, would yield to the pressures.
    Yielding(Box<Piston>),
    /// Nothing: the start is looked for.
    None,
}

/// Step of the crank angle at which yielding is judged \[rad\]: 3 deg, a tenth of the pulse that loads a skirt.
const YIELD_STEP: f64 = std::f64::consts::PI / 60.0;

/// A recorded cycle.
pub struct Record {
    grid: Vec<f64>,
    /// Rows pushed.
    count: usize,
    columns: Vec<Column>,
    flows: bool,
    elastic: bool,
    every: usize,
    /// Maps of both sides in equal steps of crank angle.
    pub maps: [Vec<Map>; 2],
    /// The map with the highest pressure of each side.
    pub peak: [Map; 2],
    highest: [f64; 2],
    soft: Option<Box<Piston>>,
    /// Largest part of the gap by which the other skirt would yield.
    pub yielding: f64,
    /// Amplitudes of its shapes at the start of the cycle \[m\].
    pub yields_first: Vec<f64>,
    omega: f64,
}

impl Record {
    /// For a cycle of `a`, as `rows` says.
    #[must_use]
    pub fn new(a: &Assembly, case: &PistonSecondaryCase, rows: Rows) -> Self {
        let step = if let Rows::Yielding(_) = rows { YIELD_STEP } else { case.outputs.series_step.si() };
        let count = (a.period / step).round().max(1.0) as usize;
        let step = a.period / count as f64;
        let (flows, soft) = match rows {
            Rows::All { flows } => (flows, None),
            Rows::Yielding(soft) => (false, Some(soft)),
            Rows::None => (false, None),
        };
        Self {
            grid: (0..=count).map(|k| a.period * k as f64 / count as f64).collect(),
            count: 0,
            columns: COLUMNS
                .iter()
                .map(|(name, unit)| Column { name: (*name).into(), unit: (*unit).into(), values: Vec::new() })
                .collect(),
            flows,
            elastic: a.elastic,
            every: case.outputs.map_step.map_or(0, |m| (m.si() / step).round().max(1.0) as usize),
            maps: Default::default(),
            peak: Default::default(),
            highest: [0.0; 2],
            soft,
            yielding: 0.0,
            yields_first: Vec::new(),
            omega: a.omega(),
        }
    }

    /// Crank angles of all rows \[rad\].
    #[must_use]
    pub fn rows(&self) -> &[f64] {
        &self.grid
    }

    /// Crank angle of the next row \[rad\].
    #[must_use]
    pub fn next(&self) -> Option<f64> {
        self.grid.get(self.count).copied()
    }

    /// Adds a row: the coordinates `x` and the rates `w` at the instant.
    ///
    /// # Errors
    /// A film that cannot be solved.
    pub fn push(&mut self, a: &mut Assembly, now: &Instant, x: &[f64], w: &[f64]) -> Result<(), EvalError> {
        let s = a.piston.summary(now, x, w)?;
        let deg = tidy(self.grid[self.count.min(self.grid.len() - 1)].to_degrees());
        let friction = s.friction();
        let moment: f64 = s.film_moment.iter().chain(&s.contact_moment).sum();
        let mut oil = [0.0; 3];
        let mut yields = 0.0_f64;
        let first = 2 + a.piston.sides[0].elastic();
        for (k, side) in a.piston.sides.iter_mut().enumerate() {
            let own = if k == 0 { &x[2..first] } else { &x[first..] };
            let mut rates = vec![w[0], w[1]];
            rates.extend_from_slice(if k == 0 { &w[2..first] } else { &w[first..] });
            if self.flows {
                let flow = side.oil_flow(now.speed, now.mu, &rates)?;
                oil.iter_mut().zip(flow).for_each(|(o, f)| *o += f);
            }
            yields = own.iter().fold(yields, |y, q| y.max(q.abs()));
            if self.every > 0 && self.count.is_multiple_of(self.every) {
                self.maps[k].push(Map { theta_deg: deg, p: side.pressure() });
            }
            if s.p_max[k] > self.highest[k] {
                self.highest[k] = s.p_max[k];
                if self.every > 0 {
                    self.peak[k] = Map { theta_deg: deg, p: side.pressure() };
                }
            }
        }
        if let Some(soft) = &self.soft {
            for (hard, own) in a.piston.sides.iter().zip(&soft.sides) {
                let q = own.yields_to(hard);
                self.yielding = self.yielding.max(own.part_of_gap(&q, hard));
                if self.count == 0 {
                    self.yields_first.extend(q);
                }
            }
        }
        let values = [
            now.speed,
            now.acceleration,
            now.pressure + a.p_crankcase,
            x[0],
            x[1],
            w[0],
            w[1],
            (x[0] - x[1]) / a.piston.body.length,
            s.side_force(),
            moment,
            friction,
            -friction * now.speed,
            a.piston.lateral_energy([w[0], w[1]]),
            s.rod,
            s.pin_moment,
            s.groove,
            s.net[0],
            s.film[0],
            s.contact[0],
            s.film_friction[0],
            s.contact_friction[0],
            s.gap[0],
            s.p_max[0],
            s.film[1],
            s.contact[1],
            s.film_friction[1],
            s.contact_friction[1],
            s.gap[1],
            s.p_max[1],
            oil[0],
            oil[1],
            oil[2],
            yields,
        ];
        for (c, v) in self.columns.iter_mut().zip(values) {
            // Adding zero turns -0 into 0.
            c.values.push(v + 0.0);
        }
        self.count += 1;
        Ok(())
    }

    /// One column.
    #[must_use]
    pub fn column(&self, name: &str) -> &[f64] {
        self.columns.iter().find(|c| c.name == name).map_or(&[], |c| &c.values)
    }

    /// The series.
    #[must_use]
    pub fn series(&self) -> Series {
        let theta = self.grid[..self.count].iter().map(|t| tidy(t.to_degrees())).collect();
        let shown = |k: &usize| (self.flows || !OIL.contains(k)) && (self.elastic || *k != YIELD);
        let columns = (0..self.columns.len()).filter(shown).map(|k| self.columns[k].clone()).collect();
        Series::over_cycle(theta, columns)
    }

    /// Largest value (smallest for `sign = -1`) among `rows` of a column, refined by the parabola through it and its neighbours, and its crank angle
    /// \[deg\].
    fn extreme(&self, v: &[f64], sign: f64, rows: std::ops::Range<usize>) -> (f64, f64) {
        let Some(k) = rows.max_by(|a, b| (sign * v[*a]).total_cmp(&(sign * v[*b])).then(b.cmp(a))) else {
            return (0.0, 0.0);
        };
        let deg = self.grid[k].to_degrees();
        if k == 0 || k + 1 >= v.len() {
            return (v[k], deg);
        }
        let (a, b, c) = (v[k - 1], v[k], v[k + 1]);
        let curve = sign * (a - 2.0 * b + c);
        let t = if curve < 0.0 { (0.5 * sign * (a - c) / curve).clamp(-0.5, 0.5) } else { 0.0 };
        (b - 0.25 * (a - c) * t, deg + t * (self.grid[k + 1] - self.grid[k]).to_degrees())
    }

    /// Integral over the cycle in time, by the trapezoidal rule.
    fn integral(&self, f: impl Fn(usize) -> f64) -> f64 {
        (1..self.count).map(|k| 0.5 * (f(k) + f(k - 1)) * (self.grid[k] - self.grid[k - 1])).sum::<f64>()
            / self.omega
    }

    /// Force of solid contact on the harder pressed side, row by row.
    fn contact(&self) -> Vec<f64> {
        let (a, b) = (self.column("thrust.contact_force"), self.column("anti_thrust.contact_force"));
        a.iter().zip(b).map(|(a, b)| a.abs().max(b.abs())).collect()
    }

    /// First and last row of the longest stretch with contact.
    fn longest_contact(&self, contact: &[f64]) -> Option<(usize, usize)> {
        let mut best: Option<(usize, usize)> = None;
        let mut begin = None;
        for k in 0..=contact.len() {
            if contact.get(k).is_some_and(|c| *c > 0.0) {
                begin.get_or_insert(k);
            } else if let Some(b) = begin.take()
                && best.is_none_or(|(x, y)| k - 1 - b > y - x)
            {
                best = Some((b, k - 1));
            }
        }
        best
    }

    /// Approaches that lose kinetic energy across the bore: crank angle \[deg\] of the highest energy before, and what is lost \[J\].
    fn slaps(&self) -> Vec<(f64, f64)> {
        let e = self.column("skirt.lateral_energy");
        let mut found = Vec::new();
        let mut top: Option<usize> = None;
        for k in 1..e.len() {
            if e[k] < e[k - 1] {
                top.get_or_insert(k - 1);
            } else if let Some(t) = top.take() {
                found.push((self.grid[t].to_degrees(), e[t] - e[k - 1]));
            }
        }
        if let (Some(t), Some(last)) = (top, e.last()) {
            found.push((self.grid[t].to_degrees(), e[t] - last));
        }
        found
    }

    /// Wanted results.
    #[must_use]
    pub fn results(
        &self,
        a: &Assembly,
        case: &PistonSecondaryCase,
        wanted: &[ResultInfo],
        periodicity_error: f64,
    ) -> IndexMap<String, Value> {
        let all = 0..self.count;
        let mut known: IndexMap<String, f64> = IndexMap::new();
        for (name, _, column, factor, _) in EXTREMES {
            for (end, sign) in [("max", 1.0), ("min", -1.0)] {
                let (value, deg) = self.extreme(self.column(column), sign, all.clone());
                known.insert(format!("{name}_{end}"), factor * value);
                known.insert(format!("{name}_{end}_angle"), deg);
            }
        }
        let friction = self.column("skirt.friction_force");
        let row_at = |deg: f64| {
            let t = deg.to_radians() / a.period * (self.grid.len() - 1) as f64;
            (t.round().max(0.0) as usize).min(self.count.saturating_sub(1))
        };
        if a.period.to_degrees() > 540.0 {
            let stroke = row_at(360.0)..row_at(540.0) + 1;
            let (low, high) =
                (self.extreme(friction, -1.0, stroke.clone()), self.extreme(friction, 1.0, stroke));
            let (value, deg) = if low.0.abs() >= high.0.abs() { low } else { high };
            known.insert("friction_expansion".into(), value);
            known.insert("friction_expansion_angle".into(), deg);
            let force = self.column("skirt.side_force");
            let intake = &force[..row_at(180.0)];
            known.insert("side_force_intake".into(), intake.iter().fold(0.0, |a, f| a.max(f.abs())));
        }
        let lowest = |names: [&str; 2], sign: f64| {
            let v: Vec<f64> = self
                .column(names[0])
                .iter()
                .zip(self.column(names[1]))
                .map(|(a, b)| if sign < 0.0 { a.min(*b) } else { a.max(*b) })
                .collect();
            self.extreme(&v, sign, 0..self.count)
        };
        let (h, h_angle) = lowest(["thrust.h_min", "anti_thrust.h_min"], -1.0);
        let (p, p_angle) = lowest(["thrust.p_max", "anti_thrust.p_max"], 1.0);
        let (top, bottom) = (self.column("skirt.e_top"), self.column("skirt.e_bottom"));
        let tilt = top.iter().zip(bottom).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let power = self.column("skirt.friction_power");
        let duration = a.period / self.omega;
        let work = self.integral(|k| power[k]);
        let speed = self.column("piston.v");
        let (ra, rb) = (self.column("thrust.rubbing_force"), self.column("anti_thrust.rubbing_force"));
        let contact = self.contact();
        let touching = self.longest_contact(&contact);
        let at = |k: Option<usize>| k.map_or(0.0, |k| self.grid[k].to_degrees());
        let swept = a.area * a.kinematics.stroke();
        let share = self.integral(|k| f64::from(u8::from(contact[k] > 0.0))) / duration;
        let slap = self.slaps().into_iter().fold((0.0, 0.0), |b, s| if s.1 > b.1 { s } else { b });
        let largest = |name: &str| self.column(name).iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let side = largest("skirt.side_force");
        for (name, value) in [
            ("tilt_max", 1e6 * tilt),
            ("h_min", 1e6 * h),
            ("h_min_angle", h_angle),
            ("p_max", 1e-5 * p),
            ("p_max_angle", p_angle),
            ("friction_work", work),
            ("friction_power", work / duration),
            ("fmep", 1e-3 * work / swept),
            ("engine_friction_power", work / duration * f64::from(case.engine.cylinders)),
            ("contact_work", self.integral(|k| -(ra[k] + rb[k]) * speed[k])),
            ("contact_force_max", contact.iter().fold(0.0, |a, b| a.max(*b))),
            ("contact_share", share),
            ("contact_begin", at(touching.map(|t| t.0))),
            ("contact_end", at(touching.map(|t| t.1))),
            ("slap_energy", 1e3 * slap.1),
            ("slap_energy_angle", slap.0),
            ("inertia_share", if side > 0.0 { largest("inertia.force") / side } else { 0.0 }),
            ("periodicity_error", 1e6 * periodicity_error),
        ] {
            known.insert(name.into(), value);
        }
        for name in ["oil_up", "oil_down", "oil_aside"] {
            let q = self.column(&format!("skirt.{name}"));
            known.insert(name.into(), 1e9 * self.integral(|k| q[k]));
        }
        for angle in &case.outputs.at {
            let deg = tidy(angle.si().to_degrees());
            for (name, _, column, factor) in AT {
                let v = self.column(column);
                known.insert(format!("{name}@{deg}"), factor * v.get(row_at(deg)).copied().unwrap_or(0.0));
            }
        }
        wanted
            .iter()
            .map(|r| {
                let value = known.get(&r.name).copied().unwrap_or(0.0) + 0.0;
                (r.name.clone(), Value { value, unit: r.unit.into(), what: r.what.clone() })
            })
            .collect()
    }

    /// What happened when.
    #[must_use]
    pub fn events(&self) -> Vec<Event> {
        let mut events = Vec::new();
        let mut add = |theta_deg: f64, subject: &str, what: String| {
            events.push(Event { theta_deg, subject: subject.into(), what });
        };
        for (side, name) in [("thrust", "thrust side"), ("anti_thrust", "anti-thrust side")] {
            let c = self.column(&format!("{side}.contact_force"));
            for k in 1..c.len() {
                if (c[k] != 0.0) != (c[k - 1] != 0.0) {
                    let what = if c[k] != 0.0 { "solid contact begins" } else { "solid contact ends" };
                    add(tidy(self.grid[k].to_degrees()), name, what.into());
                }
            }
            let (p, deg) = self.extreme(self.column(&format!("{side}.p_max")), 1.0, 0..self.count);
            if p > 0.0 {
                add(deg, name, format!("highest film pressure, {:.1} bar", 1e-5 * p));
            }
        }
        // The piston changes sides where the displacement of its middle does.
        let (top, bottom) = (self.column("skirt.e_top"), self.column("skirt.e_bottom"));
        for k in 1..top.len() {
            let (before, after) = (top[k - 1] + bottom[k - 1], top[k] + bottom[k]);
            if (before > 0.0) != (after > 0.0) {
                let side = if after > 0.0 { "anti-thrust" } else { "thrust" };
                add(tidy(self.grid[k].to_degrees()), "piston", format!("crosses to the {side} side"));
            }
        }
        events.sort_by(|a, b| a.theta_deg.total_cmp(&b.theta_deg));
        events
    }
}
