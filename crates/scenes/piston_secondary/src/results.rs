//! Results of a cycle, and what happened when in it.

use gudgeon_core::EvalError;
use gudgeon_core::result::{Event, Value};
use indexmap::IndexMap;

use super::case::PistonSecondaryCase;
use super::oil::{OilCycle, OilStep};
use super::plan::{AT, EXTREMES, ResultInfo, tidy};
use super::row::{INERTIA, Look, OIL, Row, index};
use super::spectrum::Spectrum;
use super::survey::{Survey, Which};

/// Results and events of a cycle.
pub struct Told {
    /// Wanted results.
    pub results: IndexMap<String, Value>,
    /// What happened when.
    pub events: Vec<Event>,
    /// Crank angles \[rad\] of the highest film pressure of each side that has any.
    pub peaks: [Option<f64>; 2],
    /// The lateral forces in harmonics.
    pub spectrum: Spectrum,
}

/// Names of the sides: in columns, in words.
const SIDES: [(&str, &str); 2] = [("thrust", "thrust side"), ("anti_thrust", "anti-thrust side")];

/// Surveys the cycle.
struct Teller<'s, 'l, 'a> {
    survey: &'s Survey,
    look: &'l mut Look<'a>,
    known: IndexMap<String, f64>,
    events: Vec<Event>,
    whole: (f64, f64),
}

/// Tells what is `wanted` of a cycle.
///
/// # Errors
/// A film that cannot be solved, no balance.
pub fn tell(
    survey: &Survey,
    look: &mut Look<'_>,
    case: &PistonSecondaryCase,
    wanted: &[ResultInfo],
    periodicity_error: f64,
) -> Result<Told, EvalError> {
    let want = |name: &str| wanted.iter().any(|r| r.name.starts_with(name));
    let whole = (0.0, look.a.period);
    let mut t = Teller { survey, look, known: IndexMap::new(), events: Vec::new(), whole };
    t.extremes(&want)?;
    if t.look.a.period.to_degrees() > 540.0 && (want("friction_expansion") || want("side_force_intake")) {
        t.strokes()?;
    }
    t.positions()?;
    t.integrals(case);
    if want("slap_energy") {
        t.slap()?;
    }
    let spectrum = Spectrum::new(survey, t.look.a.period, t.look.a.omega());
    for (name, force) in ["slap_force_thrust", "slap_force_anti_thrust"].into_iter().zip(spectrum.slap()) {
        t.put(name, force);
    }
    t.contact(&want)?;
    let peaks = t.pressures()?;
    if want("inertia_share") {
        let force = index("skirt.side_force");
        let side = t.largest(&|r| r[force].abs())?;
        let inertia = t.largest(&|r| r[INERTIA].abs())?;
        t.put("inertia_share", if side > 0.0 { inertia / side } else { 0.0 });
    }
    t.put("periodicity_error", 1e6 * periodicity_error);
    for angle in &case.outputs.at {
        t.at(angle.si())?;
    }
    let results = wanted
        .iter()
        .map(|r| {
            let value = t.known.get(&r.name).copied().unwrap_or(0.0) + 0.0;
            (r.name.clone(), Value { value, unit: r.unit.into(), what: r.what.clone() })
        })
        .collect();
    t.events.sort_by(|a, b| a.theta_deg.total_cmp(&b.theta_deg));
    Ok(Told { results, events: t.events, peaks, spectrum })
}

impl Teller<'_, '_, '_> {
    fn put(&mut self, name: &str, value: f64) {
        self.known.insert(name.into(), value);
    }

    fn event(&mut self, theta: f64, subject: &str, what: String) {
        self.events.push(Event { theta_deg: tidy(theta.to_degrees()), subject: subject.into(), what });
    }

    /// Largest value of `f` over the cycle.
    fn largest(&mut self, f: &dyn Fn(&Row) -> f64) -> Result<f64, EvalError> {
        Ok(self.survey.extreme(self.look, Which::Max, self.whole, f)?.0)
    }

    /// Extremes of columns. Positions are followed without films.
    fn extremes(&mut self, want: &dyn Fn(&str) -> bool) -> Result<(), EvalError> {
        for (name, _, column, factor, _) in EXTREMES {
            if !want(name) {
                continue;
            }
            let column = index(column);
            let edge = [index("skirt.e_top"), index("skirt.e_bottom")].iter().position(|c| *c == column);
            for (end, which) in [("max", Which::Max), ("min", Which::Min)] {
                let (value, t) = if let Some(k) = edge {
                    let values = self.survey.values(|r| r[column]);
                    let mut at = |look: &mut Look<'_>, t: f64| Ok(look.edges(t)[k]);
                    self.survey.extreme_of(self.look, which, self.whole, &values, &mut at)?
                } else {
                    self.survey.extreme(self.look, which, self.whole, &|r| r[column])?
                };
                self.put(&format!("{name}_{end}"), factor * value);
                self.put(&format!("{name}_{end}_angle"), t.to_degrees());
            }
        }
        Ok(())
    }

    /// What belongs to one stroke of a four-stroke cycle.
    fn strokes(&mut self) -> Result<(), EvalError> {
        let deg = |a: f64, b: f64| (a.to_radians(), b.to_radians());
        let (friction, force) = (index("skirt.friction_force"), index("skirt.side_force"));
        let low = self.survey.extreme(self.look, Which::Min, deg(360.0, 540.0), &|r| r[friction])?;
        let high = self.survey.extreme(self.look, Which::Max, deg(360.0, 540.0), &|r| r[friction])?;
        let (value, t) = if low.0.abs() >= high.0.abs() { low } else { high };
        self.put("friction_expansion", value);
        self.put("friction_expansion_angle", t.to_degrees());
        let (value, _) = self.survey.extreme(self.look, Which::Max, deg(0.0, 180.0), &|r| r[force].abs())?;
        self.put("side_force_intake", value);
        Ok(())
    }

    /// Means and extremes that the coordinates alone tell.
    fn positions(&mut self) -> Result<(), EvalError> {
        for (name, mean) in ["e_top_mean", "e_bottom_mean"].into_iter().zip(self.look.mean_edges()) {
            self.put(name, 1e6 * mean);
        }
        let [top, bottom] = [index("skirt.e_top"), index("skirt.e_bottom")];
        let values = self.survey.values(|r| (r[top] - r[bottom]).abs());
        let mut at = |look: &mut Look<'_>, t: f64| {
            let [top, bottom] = look.edges(t);
            Ok((top - bottom).abs())
        };
        let (tilt, _) = self.survey.extreme_of(self.look, Which::Max, self.whole, &values, &mut at)?;
        self.put("tilt_max", 1e6 * tilt);
        let gaps = SIDES.map(|(side, _)| index(&format!("{side}.h_min")));
        let values = self.survey.values(|r| r[gaps[0]].min(r[gaps[1]]));
        let mut at = |look: &mut Look<'_>, t: f64| look.gaps(t).map(|[a, b]| a.min(b));
        let (h, t) = self.survey.extreme_of(self.look, Which::Min, self.whole, &values, &mut at)?;
        self.put("h_min", 1e6 * h);
        self.put("h_min_angle", t.to_degrees());
        // The piston changes sides where the displacement of its middle does.
        let values = self.survey.values(|r| r[top] + r[bottom]);
        let mut at = |look: &mut Look<'_>, t: f64| Ok(look.edges(t).iter().sum());
        for (t, positive) in self.survey.crossings(self.look, &values, &mut at)? {
            let side = if positive { "anti-thrust" } else { "thrust" };
            self.event(t, "piston", format!("crosses to the {side} side"));
        }
        Ok(())
    }

    fn integrals(&mut self, case: &PistonSecondaryCase) {
        let (survey, a) = (self.survey, &*self.look.a);
        let power = index("skirt.friction_power");
        let work = survey.integral(|r| r[power]);
        let mean = work / (a.period / a.omega());
        let swept = a.area * a.kinematics.stroke();
        let [rub, other] = SIDES.map(|(side, _)| index(&format!("{side}.rubbing_force")));
        let speed = index("piston.v");
        let contact = survey.integral(|r| -(r[rub] + r[other]) * r[speed]);
        // What is booked needs no integral.
        let kept = self.look.trajectory.oil.as_ref();
        let booked = |k: usize| kept.map(|o| o.ledger.left[k] - o.ledger.entered[k]);
        let oil: Vec<f64> =
            OIL.enumerate().map(|(k, c)| booked(k).unwrap_or_else(|| survey.integral(|r| r[c]))).collect();
        self.put("friction_work", work);
        self.put("friction_power", mean);
        self.put("fmep", 1e-5 * work / swept);
        self.put("fmep_boundary", 1e-5 * contact / swept);
        self.put("engine_friction_power", mean * f64::from(case.engine.cylinders));
        self.put("contact_work", contact);
        let made = oil.iter().sum::<f64>();
        for (name, q) in ["oil_up", "oil_down", "oil_aside"].into_iter().zip(oil) {
            self.put(name, 1e9 * q);
        }
        self.put("oil_made", 1e9 * kept.map_or(made, |o| o.ledger.made()));
        if let Some(oil) = kept {
            self.oil(oil);
        }
    }

    /// The ledger of the oil that the films keep.
    fn oil(&mut self, oil: &OilCycle) {
        let ledger = &oil.ledger;
        let mean = |of: fn(&OilStep) -> f64| oil.steps.iter().map(of).sum::<f64>() / oil.steps.len() as f64;
        for (name, value) in [
            ("oil_in_up", 1e9 * ledger.entered[0]),
            ("oil_in_down", 1e9 * ledger.entered[1]),
            ("oil_out_up", 1e9 * ledger.left[0]),
            ("oil_out_down", 1e9 * ledger.left[1]),
            ("oil_out_aside", 1e9 * ledger.left[2]),
            ("oil_held", 1e9 * mean(|s| s.held)),
            ("oil_filled", mean(|s| s.filled)),
            ("oil_change", 1e9 * (ledger.held[1] - ledger.held[0])),
            ("oil_ledger", ledger.error()),
        ] {
            self.put(name, value);
        }
    }

    /// The approach that loses most kinetic energy across the bore.
    fn slap(&mut self) -> Result<(), EvalError> {
        let column = index("skirt.lateral_energy");
        let (values, angles) = (self.survey.values(|r| r[column]), self.survey.angles());
        let fall = |f: &(usize, usize)| values[f.0] - values[f.1];
        let falls = Survey::falls(&values);
        let Some(&(top, low)) = falls.iter().max_by(|a, b| fall(a).total_cmp(&fall(b)).then(b.0.cmp(&a.0)))
        else {
            return Ok(());
        };
        // The extremes lie between the neighbours, at another angle, of the nodes that have them.
        let around = |k: usize| {
            let t = angles[k];
            let before = angles[..k].iter().rev().find(|a| **a < t).copied().unwrap_or(t);
            (before, angles[k..].iter().find(|a| **a > t).copied().unwrap_or(t))
        };
        let high = self.survey.extreme(self.look, Which::Max, around(top), &|r| r[column])?;
        let deep = self.survey.extreme(self.look, Which::Min, around(low), &|r| r[column])?;
        self.put("slap_energy", 1e3 * (high.0 - deep.0));
        self.put("slap_energy_angle", high.1.to_degrees());
        Ok(())
    }

    /// Force, work and stretches of solid contact.
    fn contact(&mut self, want: &dyn Fn(&str) -> bool) -> Result<(), EvalError> {
        if want("contact_force_max") {
            let [a, b] = SIDES.map(|(side, _)| index(&format!("{side}.contact_force")));
            let force = self.largest(&move |r| r[a].abs().max(r[b].abs()))?;
            self.put("contact_force_max", force);
        }
        let mut all: Vec<(f64, f64)> = Vec::new();
        for (k, (_, name)) in SIDES.into_iter().enumerate() {
            let gaps = self.survey.contact_gaps(k);
            let mut at = |look: &mut Look<'_>, t: f64| Ok(look.contact_gaps(t)[k]);
            let touching = self.survey.stretches(self.look, &gaps, &mut at)?;
            for &(from, to) in &touching {
                if from > self.whole.0 {
                    self.event(from, name, "solid contact begins".into());
                }
                if to < self.whole.1 {
                    self.event(to, name, "solid contact ends".into());
                }
            }
            all.extend(touching);
        }
        let joined = joined(all);
        let time: f64 = joined.iter().map(|(a, b)| b - a).sum();
        self.put("contact_share", time / self.look.a.period);
        let longest = joined.iter().copied().fold(
            (0.0, 0.0),
            |m: (f64, f64), s| {
                if s.1 - s.0 > m.1 - m.0 { s } else { m }
            },
        );
        self.put("contact_begin", longest.0.to_degrees());
        self.put("contact_end", longest.1.to_degrees());
        Ok(())
    }

    /// Highest film pressures.
    fn pressures(&mut self) -> Result<[Option<f64>; 2], EvalError> {
        let mut peaks = [None; 2];
        let mut most = (0.0, 0.0);
        for (k, (side, name)) in SIDES.into_iter().enumerate() {
            let column = index(&format!("{side}.p_max"));
            let (p, t) = self.survey.extreme(self.look, Which::Max, self.whole, &|r| r[column])?;
            if p > most.0 {
                most = (p, t);
            }
            if p > 0.0 {
                peaks[k] = Some(t);
                self.event(t, name, format!("highest film pressure, {:.1} bar", 1e-5 * p));
            }
        }
        self.put("p_max", 1e-5 * most.0);
        self.put("p_max_angle", most.1.to_degrees());
        Ok(peaks)
    }

    /// What is told of a crank angle.
    fn at(&mut self, angle: f64) -> Result<(), EvalError> {
        let deg = tidy(angle.to_degrees());
        let row = self.look.row(angle.clamp(self.whole.0, self.whole.1), 0.0)?;
        for (name, _, column, factor, _) in AT {
            self.put(&format!("{name}@{deg}"), factor * row[index(column)]);
        }
        Ok(())
    }
}

/// Stretches that overlap, as one.
fn joined(mut all: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut out: Vec<(f64, f64)> = Vec::new();
    for s in all {
        match out.last_mut() {
            Some(last) if s.0 <= last.1 => last.1 = last.1.max(s.1),
            _ => out.push(s),
        }
    }
    out
}
