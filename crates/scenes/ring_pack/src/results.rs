//! Results and events from what was measured over a cycle.

use std::f64::consts::PI;

use gudgeon_core::kinds::GasWay;
use gudgeon_core::result::{Event, Note, Value};
use indexmap::IndexMap;

use super::film_strokes;
use super::gas_balance;
use super::measure::{Measures, Peak, RingMeasure, Seat};
use super::pack::Pack;
use super::plan::{Told, catalogue};
use super::record::{Totals, round_deg};

/// How a blow-by mass becomes litres per minute.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Meter {
    /// Gas density at the meter \[kg/m³\].
    pub density: f64,
    /// Cylinders of the engine.
    pub cylinders: f64,
    /// Pressure at the meter \[Pa\].
    pub pressure: f64,
}

/// A cycle that was solved.
#[derive(Debug, Clone)]
pub struct Cycle {
    /// What the solver integrated.
    pub totals: Totals,
    /// What was measured on its steps.
    pub measures: Measures,
}

/// More changes of seat than this are told as one flutter: they would bury everything else.
const FLUTTER: u32 = 24;
/// Part of the charge from which a loss changes the pressure of the cylinder by more than traces are good for.
const FELT: f64 = 0.05;

/// Swept volume of a cylinder \[m³\].
fn swept(pack: &Pack) -> f64 {
    PI * pack.geo.bore_radius.powi(2) * pack.kinematics.stroke()
}

impl Cycle {
    /// Every wanted result.
    #[must_use]
    pub fn results(&self, pack: &Pack, meter: Meter) -> IndexMap<String, Value> {
        catalogue(&pack.names, Told::ALL)
            .into_iter()
            .filter(|r| pack.plan.wanted.contains(&r.name))
            .map(|r| {
                let number = |prefix: &str| {
                    let (subject, what) = r.name.split_once('.')?;
                    Some((subject.strip_prefix(prefix)?.parse::<usize>().ok()?, what))
                };
                let v = match (number("ring"), number("land")) {
                    (Some((i, what)), _) => self.of_ring(pack, i - 1, what, meter),
                    (_, Some((k, "oil"))) => {
                        self.totals.on_land.get(k - 1).copied().unwrap_or(0.0) * around(pack)
                    }
                    (_, Some((k, what))) => of_land(self.measures.lands[k - 2], what),
                    _ => self.of_pack(pack, &r.name, meter),
                };
                // Adding zero turns -0 into 0.
                (r.name, Value { value: v + 0.0, unit: r.unit.into(), what: r.what })
            })
            .collect()
    }

    /// Length of a cycle \[s\].
    fn duration(pack: &Pack) -> f64 {
        pack.period() / pack.omega
    }

    /// Blow-by over the charge: the swept volume at the end of the first stroke, at the temperature of the meter.
    fn blow_by_share(&self, pack: &Pack, meter: Meter) -> f64 {
        self.totals.blow_by / (meter.density * pack.cylinder.pressure(PI) / meter.pressure * swept(pack))
    }

    /// What is said of a blow-by that a cylinder pressure would feel.
    #[must_use]
    pub fn lost_charge(&self, pack: &Pack, meter: Meter) -> Option<Note> {
        let share = self.blow_by_share(pack, meter);
        (share > FELT).then(|| {
            let text = format!(
                "the blow-by is {:.0} % of the charge of a cylinder: its pressure, an input, would be lower",
                100.0 * share
            );
            Note::caution("charge_lost", text).amount("share", share, "1")
        })
    }

    fn of_pack(&self, pack: &Pack, name: &str, meter: Meter) -> f64 {
        let (t, m) = (&self.totals, &self.measures);
        let swept = swept(pack);
        let work: f64 = t.friction_work.iter().sum();
        let around = around(pack);
        let up = t.oil.thrown + t.oil.evaporated;
        match name {
            "blow_by" => Self::metered(pack, t.blow_by, meter),
            "blow_by_per_cylinder" => Self::metered(pack, t.blow_by, Meter { cylinders: 1.0, ..meter }),
            "blow_by_share" => self.blow_by_share(pack, meter),
            "blow_by_mass_per_cycle" => t.blow_by,
            "blow_back_mass_per_cycle" => m.up[0],
            "blow_back" => Self::metered(pack, m.up[0], meter),
            "cylinder.p_max" => m.cylinder.value / 1e5,
            "cylinder.p_max_angle" => m.cylinder.theta.to_degrees(),
            "friction_power" => work / Self::duration(pack),
            "fmep" => work / swept / 1e5,
            "fmep_boundary" => t.boundary_work.iter().sum::<f64>() / swept / 1e5,
            "periodicity_error" => t.periodicity_error,
            "oil_taken" => t.oil.taken * around,
            "oil_drained" => t.oil.drained * around,
            "oil_thrown" => t.oil.thrown * around,
            "oil_evaporated" => t.oil.evaporated * around,
            "liner_dried" => t.dried * 1e3,
            "oil_up" => Self::grams_per_hour(pack, up, meter),
            "oil_up_thrown" => Self::grams_per_hour(pack, t.oil.thrown, meter),
            "oil_up_evaporated" => Self::grams_per_hour(pack, t.oil.evaporated, meter),
            "oil_up_specific" => match indicated_work(pack) {
                work if work > 0.0 => grams(pack, up) / (work / 3.6e6),
                _ => 0.0,
            },
            _ => 0.0,
        }
    }

    /// Litres a minute of the engine at the meter from a mass of gas \[kg\] in a cycle of one cylinder.
    fn metered(pack: &Pack, mass: f64, meter: Meter) -> f64 {
        mass / Self::duration(pack) / meter.density * 6e4 * meter.cylinders
    }

    /// Net gas \[kg\] through the first passage of ring `i` that `is_one`.
    fn net_past(&self, pack: &Pack, i: usize, is_one: fn(GasWay) -> bool) -> f64 {
        gas_balance::net_past(pack.gas.passages(), &self.totals.passages, i, is_one)
    }

    /// Grams an hour of the engine from a volume of oil per circumference \[m²\] in a cycle of one cylinder.
    fn grams_per_hour(pack: &Pack, volume: f64, meter: Meter) -> f64 {
        grams(pack, volume) * meter.cylinders * 3600.0 / Self::duration(pack)
    }

    fn of_ring(&self, pack: &Pack, i: usize, what: &str, meter: Meter) -> f64 {
        let (m, span) = (&self.measures.rings[i], self.measures.span);
        let passed = self.totals.passed.get(i).copied().unwrap_or_default();
        // Volumes [mm³] that the film would hold over each stroke: `π D ∫ h |v| dt` (tomanik1993, after Yoshida). The film that a ring
        // leaves is about half of its thickness; the source takes the thickness itself.
        let strokes = m.strokes.map(|s| s * 2.0 * PI * pack.geo.bore_radius * 1e9);
        let metered = |mass| Self::metered(pack, mass, meter);
        match what {
            "blow_by" => metered(self.totals.flow_in[i]),
            "blow_by_gap" => metered(self.net_past(pack, i, gas_balance::is_gap)),
            "blow_by_groove" => metered(self.net_past(pack, i, gas_balance::is_groove)),
            "h_min" => m.film_span().0 * 1e6,
            "h_max" => m.film_span().1 * 1e6,
            "h_mean" => m.film / span * 1e6,
            "friction_power" => {
                self.totals.friction_work.get(i).copied().unwrap_or(0.0) / Self::duration(pack)
            }
            "fmep" => mean_pressure(pack, &self.totals.friction_work, i),
            "fmep_boundary" => mean_pressure(pack, &self.totals.boundary_work, i),
            "reverse_pressure_ratio" => m.reverse,
            "lift_pressure_ratio" => m.lift.map_or(0.0, |c| c.ratio),
            "lift_angle" => m.lift.map_or(0.0, |c| c.theta.to_degrees()),
            "h_min_angle" | "h_mid" | "friction_coefficient_mid" | "friction_max" | "friction_max_angle" => {
                film_strokes::result(m, pack.period(), what)
            }
            "oil_face_combustion" => strokes[2] - strokes[1],
            "oil_face_gas_exchange" => strokes[0] - strokes[3],
            "oil_gap" => gap_oil(pack, i, m),
            "oil_groove" => groove_oil(pack, i, m),
            "flank_oil_lost" => flank_oil(pack, i, self.totals.flank.get(i).map_or(0.0, |f| f.lost)),
            "wear_load" => m.wear,
            "wetted_share" => m.wetted / span,
            "gap_oil_up" => passed.up * around(pack),
            "gap_oil_down" => passed.down * around(pack),
            "oil_scraped" => passed.scraped * around(pack),
            "seat_changes" => f64::from(m.arrivals),
            "lifted_share" => m.lifted / span,
            _ => 0.0,
        }
    }

    /// What happened when.
    #[must_use]
    pub fn events(&self) -> Vec<Event> {
        let mut events = Vec::new();
        let mut add = |theta: f64, subject: String, what: String| {
            events.push(Event { theta_deg: round_deg(theta.to_degrees()), subject, what });
        };
        let flank = |seat: Seat| if seat == Seat::Upper { "upper" } else { "lower" };
        for (i, m) in self.measures.rings.iter().enumerate() {
            let subject = format!("ring{}", i + 1);
            if m.arrivals > FLUTTER {
                let first = m.changes.first().map_or(0.0, |c| c.theta);
                add(first, subject, format!("flutters: arrives on a flank {} times", m.arrivals));
                continue;
            }
            for c in &m.changes {
                if c.from != Seat::Between {
                    let ratio = format!("pressure below {:.3} of that above", c.ratio);
                    add(c.theta, subject.clone(), format!("leaves the {} flank, {ratio}", flank(c.from)));
                }
                if c.to != Seat::Between {
                    add(c.theta, subject.clone(), format!("seats on the {} flank", flank(c.to)));
                }
            }
        }
        let highest = |p: Peak| format!("highest pressure, {:.2} bar", p.value / 1e5);
        let cylinder = self.measures.cylinder;
        add(cylinder.theta, "cylinder".into(), highest(cylinder));
        for (k, land) in self.measures.lands.iter().enumerate() {
            add(land.theta, format!("land{}", k + 2), highest(*land));
        }
        events.sort_by(|a, b| a.theta_deg.total_cmp(&b.theta_deg).then_with(|| a.subject.cmp(&b.subject)));
        events
    }
}

/// What turns volumes per circumference \[m²\] into mm³.
fn around(pack: &Pack) -> f64 {
    2.0 * PI * pack.geo.bore_radius * 1e9
}

/// Mass \[g\] of a volume of oil per circumference \[m²\].
fn grams(pack: &Pack, volume: f64) -> f64 {
    let density = pack.oil_pack.as_ref().map_or(0.0, |o| o.density());
    volume * around(pack) * 1e-9 * density * 1e3
}

/// Intervals of the work of the gas in a cycle: a tenth of a degree.
const WORK_INTERVALS: u32 = 7200;

/// Work of the gas on the piston in a cycle \[J\], `∮ p dV` by trapezoids.
fn indicated_work(pack: &Pack) -> f64 {
    let at = |k: u32| {
        let theta = pack.period() * f64::from(k) / f64::from(WORK_INTERVALS);
        (pack.cylinder.pressure(theta), pack.kinematics.motion(theta).y)
    };
    let falls = |k: u32| {
        let ((p0, y0), (p1, y1)) = (at(k), at(k + 1));
        0.5 * (p0 + p1) * (y0 - y1)
    };
    PI * pack.geo.bore_radius.powi(2) * (0..WORK_INTERVALS).map(falls).sum::<f64>()
}

fn of_land(peak: Peak, what: &str) -> f64 {
    match what {
        "p_max" => peak.value / 1e5,
        "p_max_angle" => peak.theta.to_degrees(),
        _ => 0.0,
    }
}

/// Oil \[mm³\] that flows up through the gap of ring `i` if it is full of oil: laminar flow in a round pipe of its area,
/// `∫ A² Δp/(8 π μ b) dt` (tomanik1993 eq. 24). An upper limit far above what a gap lets through.
fn gap_oil(pack: &Pack, i: usize, m: &RingMeasure) -> f64 {
    let g = &pack.geo.rings[i];
    let area = g.gap_area.unwrap_or(g.gap * (pack.geo.bore_radius - g.piston_radius_below).max(0.0));
    area * area * m.gap_drive / (8.0 * PI * g.height) * 1e9
}

/// A volume on the flanks of ring `i` from that per circumference \[m²\], in mm³.
fn flank_oil(pack: &Pack, i: usize, per_circumference: f64) -> f64 {
    2.0 * PI * (pack.geo.bore_radius - 0.5 * pack.geo.rings[i].width) * per_circumference * 1e9
}

/// Oil \[mm³\] that ring `i` moves up past its flanks in a groove full of oil:
/// `∫ (-∂H/∂t L/2 + Δp H³/(12 μ L)) π D dt`, `H` the smaller distance from a flank, `L` the width of the flank (tomanik1993
/// eq. 25). Zero for rings whose motion is not integrated.
fn groove_oil(pack: &Pack, i: usize, m: &RingMeasure) -> f64 {
    let g = &pack.geo.rings[i];
    if !pack.rings[i].is_integrated() || !g.has_clearance {
        return 0.0;
    }
    let mu = pack.oil.viscosity(g.back_temperature);
    let flow = m.groove_drive / (12.0 * mu * g.width);
    let squeeze = 0.5 * g.width * (m.nearest.0 - m.nearest.1);
    (flow + squeeze) * 2.0 * PI * g.piston_radius_below * 1e9
}

/// Work \[J\] of ring `i` in a cycle over the swept volume \[bar\].
fn mean_pressure(pack: &Pack, work: &[f64], i: usize) -> f64 {
    let swept = PI * pack.geo.bore_radius.powi(2) * pack.kinematics.stroke();
    work.get(i).copied().unwrap_or(0.0) / swept / 1e5
}
