//! One recorded cycle: the series, and the results that follow from it.

use std::f64::consts::PI;

use gudgeon_core::kinds::Motion;
use gudgeon_core::result::{Balance, Column, Event, Series, Value};
use indexmap::IndexMap;

use super::assemble::has_back_volume;
use super::oil::Ledger;
use super::pack::Pack;
use super::plan::catalogue;

/// A ring counts as seated within this fraction of its clearance from a flank.
const SEATED: f64 = 0.02;

/// Totals of a cycle, integrated by the solver itself.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Totals {
    /// Gas that entered each ring from above \[kg\].
    pub flow_in: Vec<f64>,
    /// Gas that left the last ring to the crankcase \[kg\].
    pub blow_by: f64,
    /// Friction work of each ring \[J\].
    pub friction_work: Vec<f64>,
    /// Closures.
    pub balance: Balance,
    /// True error estimate of the periodic state.
    pub periodicity_error: f64,
    /// Oil that came and went, per circumference \[m²\].
    pub oil: Ledger,
    /// Length of the cycle that the totals cover \[s\], when it is not that of the record.
    pub duration: Option<f64>,
}

/// A recorded cycle.
pub struct Record {
    /// Crank angles \[rad\].
    pub theta: Vec<f64>,
    columns: Vec<Column>,
}

impl Record {
    /// Columns that this pack computes.
    #[must_use]
    pub fn new(pack: &Pack) -> Self {
        let mut columns = Vec::new();
        let mut add =
            |name: String, unit: &str| columns.push(Column { name, unit: unit.into(), values: Vec::new() });
        let n = pack.n_rings();
        for (name, unit) in
            [("piston.y", "m"), ("piston.v", "m/s"), ("piston.a", "m/s2"), ("cylinder.p", "Pa")]
        {
            add(name.into(), unit);
        }
        for i in 1..=n {
            if has_back_volume(pack.geo.rings[i - 1].back) {
                add(format!("ring{i}.back.p"), "Pa");
            }
            add(format!("land{}.p", i + 1), "Pa");
        }
        for i in 1..=n {
            add(format!("ring{i}.flow"), "kg/s");
            add(format!("ring{i}.cumulative_mass"), "kg");
        }
        add("blow_by.rate".into(), "kg/s");
        add("blow_by.cumulative".into(), "kg");
        for i in 1..=n {
            let ring = &pack.rings[i - 1];
            if pack.geo.rings[i - 1].has_clearance {
                add(format!("ring{i}.position"), "-");
                add(format!("ring{i}.lift"), "m");
                if ring.kind == Motion::Dynamic {
                    add(format!("ring{i}.axial_velocity"), "m/s");
                }
            }
            if pack.plan.axial && !matches!(ring.kind, Motion::Fixed { .. }) {
                for f in ["gas", "inertia", "film"] {
                    add(format!("ring{i}.force_{f}"), "N");
                }
                if ring.kind == Motion::Dynamic {
                    add(format!("ring{i}.force_damping"), "N");
                    add(format!("ring{i}.force_flank"), "N");
                }
            }
            if pack.plan.film {
                for (name, unit) in [
                    ("h_min", "m"),
                    ("h_rate", "m/s"),
                    ("radial_load", "N"),
                    ("contact_load", "N"),
                    ("friction_force", "N"),
                    ("friction_power", "W"),
                    ("film_p_max", "Pa"),
                    ("viscosity", "Pa s"),
                ] {
                    add(format!("ring{i}.{name}"), unit);
                }
                if pack.oil_pack.is_some() {
                    for (name, unit) in [("wetted", "1"), ("oil_held", "m3"), ("oil_left", "m")] {
                        add(format!("ring{i}.{name}"), unit);
                    }
                }
            }
        }
        Self { theta: Vec::new(), columns }
    }

    /// Adds the instant that `pack` holds, as crank angle `theta` \[rad\].
    pub fn push(&mut self, theta: f64, pack: &Pack) {
        self.theta.push(theta);
        let at = &pack.at;
        let mut columns = self.columns.iter_mut();
        let mut put = |v: f64| {
            if let Some(c) = columns.next() {
                c.values.push(v);
            }
        };
        let n = pack.n_rings();
        put(at.piston.y);
        put(at.piston.v);
        put(at.piston.a);
        put(at.gas.p_land[0]);
        for i in 0..n {
            if has_back_volume(pack.geo.rings[i].back) {
                put(at.gas.p_back[i]);
            }
            put(at.gas.p_land[i + 1]);
        }
        for i in 0..n {
            put(at.gas.flow_in[i]);
            put(0.0);
        }
        put(at.gas.flow_out[n - 1]);
        put(0.0);
        for i in 0..n {
            let (ring, place, r) = (&pack.rings[i], &at.places[i], &at.rings[i]);
            if pack.geo.rings[i].has_clearance {
                put(place.e);
                put(place.s.clamp(0.0, place.clearance));
                if ring.kind == Motion::Dynamic {
                    put(place.v);
                }
            }
            if pack.plan.axial && !matches!(ring.kind, Motion::Fixed { .. }) {
                put(r.axial.gas);
                put(r.axial.inertia);
                put(r.axial.film);
                if ring.kind == Motion::Dynamic {
                    put(r.axial.damping);
                    put(r.reaction);
                }
            }
            if pack.plan.film {
                let circumference = 2.0 * PI * place.r_outer * pack.geo.rings[i].rails as f64;
                put(place.h);
                put(r.hdot);
                put(r.load * circumference);
                put(r.contact * circumference);
                put(r.friction);
                put(r.power);
                put(r.film_p_max);
                put(r.mu);
                if let Some(oil) = &pack.oil_pack {
                    let o = oil.ring(i, at.piston.v);
                    put(o.wetted);
                    put(o.held * circumference);
                    put(o.left);
                }
            }
        }
    }

    fn column(&self, name: &str) -> &[f64] {
        self.columns.iter().find(|c| c.name == name).map_or(&[], |c| &c.values)
    }

    /// Integral of a column over the record by the trapezoidal rule, with a map applied to each value.
    fn integral(&self, name: &str, omega: f64, map: impl Fn(f64) -> f64) -> f64 {
        let v = self.column(name);
        self.theta
            .windows(2)
            .zip(v.windows(2))
            .map(|(t, v)| 0.5 * (map(v[0]) + map(v[1])) * (t[1] - t[0]))
            .sum::<f64>()
            / omega
    }

    /// Largest value of a column and where, refined by the parabola through it and its neighbours. The angle in radians.
    fn peak(&self, name: &str) -> (f64, f64) {
        let v = self.column(name);
        let Some(k) = (0..v.len()).max_by(|a, b| v[*a].total_cmp(&v[*b]).then(b.cmp(a))) else {
            return (0.0, 0.0);
        };
        if k == 0 || k + 1 == v.len() {
            return (v[k], self.theta[k]);
        }
        let (a, b, c) = (v[k - 1], v[k], v[k + 1]);
        let curve = a - 2.0 * b + c;
        let t = if curve < 0.0 { (0.5 * (a - c) / curve).clamp(-0.5, 0.5) } else { 0.0 };
        (b - 0.25 * (a - c) * t, self.theta[k] + t * (self.theta[k + 1] - self.theta[k]))
    }

    /// Fills the cumulative columns: trapezoidal sums of the flows, corrected so that they end at the solver's integral.
    fn accumulate(&mut self, totals: &Totals, omega: f64) {
        let n = totals.flow_in.len();
        let mut jobs: Vec<(String, String, f64)> = (1..=n)
            .map(|i| (format!("ring{i}.flow"), format!("ring{i}.cumulative_mass"), totals.flow_in[i - 1]))
            .collect();
        jobs.push(("blow_by.rate".into(), "blow_by.cumulative".into(), totals.blow_by));
        for (rate, sum, total) in jobs {
            let v = self.column(&rate).to_vec();
            let mut acc = vec![0.0; v.len()];
            for k in 1..v.len() {
                acc[k] = acc[k - 1] + 0.5 * (v[k] + v[k - 1]) * (self.theta[k] - self.theta[k - 1]) / omega;
            }
            if let (Some(end), true) = (acc.last().copied(), acc.len() > 1) {
                let m = (acc.len() - 1) as f64;
                for (k, a) in acc.iter_mut().enumerate() {
                    *a += (total - end) * k as f64 / m;
                }
            }
            if let Some(c) = self.columns.iter_mut().find(|c| c.name == sum) {
                c.values = acc;
            }
        }
    }

    /// The series with its cumulative columns.
    #[must_use]
    pub fn series(mut self, pack: &Pack, totals: &Totals) -> Series {
        self.accumulate(totals, pack.omega);
        let theta_deg = self.theta.iter().map(|t| round_deg(t.to_degrees())).collect();
        Series::over_cycle(theta_deg, self.columns)
    }

    /// Every wanted result.
    #[must_use]
    pub fn results(&self, pack: &Pack, totals: &Totals, meter: Meter) -> IndexMap<String, Value> {
        let n = pack.n_rings();
        let duration = totals.duration.unwrap_or(pack.period() / pack.omega);
        let litres_per_minute = totals.blow_by / duration / meter.density * 6e4;
        let swept = PI * pack.geo.bore_radius.powi(2) * pack.kinematics.stroke();
        let work: f64 = totals.friction_work.iter().sum();
        let value = |name: &str| -> f64 {
            let ring = |name: &str| {
                name.strip_prefix("ring").and_then(|r| r[..1].parse::<usize>().ok()).unwrap_or(1)
            };
            match name {
                "blow_by" => litres_per_minute * meter.cylinders,
                "blow_by_per_cylinder" => litres_per_minute,
                "blow_by_mass_per_cycle" => totals.blow_by,
                "blow_back_mass_per_cycle" => self.integral("ring1.flow", pack.omega, |v| (-v).max(0.0)),
                "cylinder.p_max" => self.peak("cylinder.p").0 / 1e5,
                "friction_power" => work / duration,
                "fmep" => work / swept / 1e5,
                "periodicity_error" => totals.periodicity_error,
                "oil_taken" => totals.oil.taken * 2.0 * PI * pack.geo.bore_radius * 1e9,
                "oil_drained" => totals.oil.drained * 2.0 * PI * pack.geo.bore_radius * 1e9,
                "oil_thrown" => totals.oil.thrown * 2.0 * PI * pack.geo.bore_radius * 1e9,
                _ if name.ends_with(".p_max") => self.peak(&name.replace(".p_max", ".p")).0 / 1e5,
                _ if name.ends_with(".p_max_angle") => {
                    self.peak(&name.replace(".p_max_angle", ".p")).1.to_degrees()
                }
                _ => {
                    let i = ring(name);
                    let (_, what) = name.split_once('.').unwrap_or(("", ""));
                    let h = self.column(&format!("ring{i}.h_min"));
                    match what {
                        "h_min" => h.iter().copied().fold(f64::INFINITY, f64::min) * 1e6,
                        "h_max" => h.iter().copied().fold(0.0, f64::max) * 1e6,
                        "h_mean" => {
                            self.integral(&format!("ring{i}.h_min"), pack.omega, |v| v) / self.span(pack)
                                * 1e6
                        }
                        "friction_power" => {
                            totals.friction_work.get(i - 1).copied().unwrap_or(0.0) / duration
                        }
                        "oil_face_combustion" => {
                            let strokes = self.strokes(pack, i);
                            strokes[2] - strokes[1]
                        }
                        "oil_face_gas_exchange" => {
                            let strokes = self.strokes(pack, i);
                            strokes[0] - strokes[3]
                        }
                        "oil_gap" => self.gap_oil(pack, i),
                        "oil_groove" => self.groove_oil(pack, i),
                        "wetted_share" => {
                            self.integral(&format!("ring{i}.wetted"), pack.omega, |v| v) / self.span(pack)
                        }
                        "seat_changes" => self.arrivals(i).len() as f64,
                        "lifted_share" => {
                            self.integral(&format!("ring{i}.position"), pack.omega, |e| {
                                f64::from(u8::from(e > SEATED))
                            }) / self.span(pack)
                        }
                        _ => 0.0,
                    }
                }
            }
        };
        catalogue(n, pack.oil_pack.is_some())
            .into_iter()
            .filter(|r| pack.plan.wanted.contains(&r.name))
            .map(|r| {
                // Adding zero turns -0 into 0.
                let v = value(&r.name) + 0.0;
                (r.name, Value { value: v, unit: r.unit.into(), what: r.what })
            })
            .collect()
    }

    /// Volumes \[mm³\] that the film of ring `i` (from 1) would hold over each stroke, intake first: `π D ∫ h |v| dt` (tomanik1993, after
    /// Yoshida). The film that a ring leaves is about half of its thickness; the source takes the thickness itself.
    fn strokes(&self, pack: &Pack, i: usize) -> [f64; 4] {
        let (h, v) = (self.column(&format!("ring{i}.h_min")), self.column("piston.v"));
        let mut sums = [0.0; 4];
        for k in 1..h.len().min(v.len()) {
            let stroke = (0.5 * (self.theta[k] + self.theta[k - 1]) / PI).floor() as usize % 4;
            let mean = 0.5 * (h[k] * v[k].abs() + h[k - 1] * v[k - 1].abs());
            sums[stroke] += mean * (self.theta[k] - self.theta[k - 1]) / pack.omega;
        }
        sums.map(|s| s * 2.0 * PI * pack.geo.bore_radius * 1e9)
    }

    /// Pressure below ring `i` (from 1) less that above, at every row \[Pa\].
    fn pressure_below(&self, i: usize) -> Vec<f64> {
        let above = if i == 1 { "cylinder.p".to_owned() } else { format!("land{i}.p") };
        let (above, below) = (self.column(&above), self.column(&format!("land{}.p", i + 1)));
        below.iter().zip(above).map(|(b, a)| b - a).collect()
    }

    /// Integral of `f(row)` over the record by the trapezoidal rule \[s times its unit\].
    fn over_rows(&self, pack: &Pack, f: impl Fn(usize) -> f64) -> f64 {
        (1..self.theta.len())
            .map(|k| 0.5 * (f(k) + f(k - 1)) * (self.theta[k] - self.theta[k - 1]) / pack.omega)
            .sum()
    }

    /// Oil \[mm³\] that flows up through the gap of ring `i` (from 1) if it is full of oil: laminar flow in a round pipe of its
    /// area, `∫ A² Δp/(8 π μ b) dt` (tomanik1993 eq. 24). An upper limit far above what a gap lets through.
    fn gap_oil(&self, pack: &Pack, i: usize) -> f64 {
        let g = &pack.geo.rings[i - 1];
        let area = g.gap_area.unwrap_or(g.gap * (pack.geo.bore_radius - g.piston_radius_below).max(0.0));
        let (dp, mu) = (self.pressure_below(i), self.column(&format!("ring{i}.viscosity")));
        let volume = self.over_rows(pack, |k| {
            area * area * dp[k] / (8.0 * PI * mu.get(k).copied().unwrap_or(f64::INFINITY) * g.height)
        });
        volume * 1e9
    }

    /// Oil \[mm³\] that ring `i` (from 1) moves up past its flanks in a groove full of oil:
    /// `∫ (-∂H/∂t L/2 + Δp H³/(12 μ L)) π D dt`, `H` the smaller distance from a flank, `L` the width of the flank (tomanik1993
    /// eq. 25). Zero for rings whose motion is not integrated.
    fn groove_oil(&self, pack: &Pack, i: usize) -> f64 {
        let (g, r) = (&pack.geo.rings[i - 1], &pack.rings[i - 1]);
        let (s, e) = (self.column(&format!("ring{i}.lift")), self.column(&format!("ring{i}.position")));
        if r.kind != Motion::Dynamic || s.is_empty() {
            return 0.0;
        }
        let mu = pack.oil.viscosity(g.back_temperature);
        let dp = self.pressure_below(i);
        let gap = |k: usize| if e[k] <= 0.5 { s[k] } else { s[k] * (1.0 - e[k]) / e[k] };
        let flow = self.over_rows(pack, |k| dp[k] * gap(k).powi(3) / (12.0 * mu * g.width));
        let squeeze = match s.len() {
            0 => 0.0,
            n => 0.5 * g.width * (gap(0) - gap(n - 1)),
        };
        (flow + squeeze) * 2.0 * PI * g.piston_radius_below * 1e9
    }

    fn span(&self, pack: &Pack) -> f64 {
        match (self.theta.first(), self.theta.last()) {
            (Some(a), Some(b)) if b > a => (b - a) / pack.omega,
            _ => 1.0,
        }
    }

    /// Rows at which ring `i` (from 1) arrives on a flank, with the flank (true: upper).
    fn arrivals(&self, i: usize) -> Vec<(usize, bool)> {
        let e = self.column(&format!("ring{i}.position"));
        let seated = |e: f64| e <= SEATED || e >= 1.0 - SEATED;
        let mut out = Vec::new();
        for k in 1..e.len() {
            if seated(e[k]) && (!seated(e[k - 1]) || (e[k] > 0.5) != (e[k - 1] > 0.5)) {
                out.push((k, e[k] > 0.5));
            }
        }
        out
    }

    /// What happened when.
    #[must_use]
    pub fn events(&self, pack: &Pack) -> Vec<Event> {
        let mut events = Vec::new();
        let mut add = |theta: f64, subject: String, what: String| {
            events.push(Event { theta_deg: round_deg(theta.to_degrees()), subject, what });
        };
        for i in 1..=pack.n_rings() {
            if !pack.geo.rings[i - 1].has_clearance {
                continue;
            }
            let e = self.column(&format!("ring{i}.position"));
            let arrivals = self.arrivals(i);
            // A ring that flutters would bury everything else.
            if arrivals.len() <= 24 {
                for (k, upper) in arrivals {
                    let flank = if upper { "upper" } else { "lower" };
                    add(self.theta[k], format!("ring{i}"), format!("seats on the {flank} flank"));
                }
                for k in 1..e.len() {
                    if e[k - 1] <= SEATED && e[k] > SEATED {
                        add(self.theta[k - 1], format!("ring{i}"), "leaves the lower flank".into());
                    } else if e[k - 1] >= 1.0 - SEATED && e[k] < 1.0 - SEATED {
                        add(self.theta[k - 1], format!("ring{i}"), "leaves the upper flank".into());
                    }
                }
            } else {
                let (k, _) = arrivals[0];
                add(
                    self.theta[k],
                    format!("ring{i}"),
                    format!("flutters: arrives on a flank {} times", arrivals.len()),
                );
            }
        }
        let (p, theta) = self.peak("cylinder.p");
        add(theta, "cylinder".into(), format!("highest pressure, {:.2} bar", p / 1e5));
        for k in 2..=pack.n_rings() {
            let (p, theta) = self.peak(&format!("land{k}.p"));
            add(theta, format!("land{k}"), format!("highest pressure, {:.2} bar", p / 1e5));
        }
        events.sort_by(|a, b| a.theta_deg.total_cmp(&b.theta_deg).then_with(|| a.subject.cmp(&b.subject)));
        events
    }
}

/// Angles in degrees come from radians; what is a whole number of thousandths of a degree is written as such.
fn round_deg(deg: f64) -> f64 {
    let r = (deg * 1e3).round() / 1e3;
    if (r - deg).abs() < 1e-9 { r } else { deg }
}

/// How a blow-by mass becomes litres per minute.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Meter {
    /// Gas density at the meter \[kg/m³\].
    pub density: f64,
    /// Cylinders of the engine.
    pub cylinders: f64,
}
