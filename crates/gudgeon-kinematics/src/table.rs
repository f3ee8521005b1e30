use std::f64::consts::PI;

use gudgeon_core::kinds::{CylinderPressure, CylinderPressureCtx, CylinderPressureSpec};
use gudgeon_core::quantity::{Angle, Dimension, PosAngle, PosRatio, Pressure, dim, quantity};
use gudgeon_core::result::Note;
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

use crate::periodic_cubic::{PeriodicCubic, TooClose};
use crate::pulses::narrow_pulses;
use crate::smoothing::{self, Smoothed};
use crate::table_rows::{Column, Rows, equally_spaced};

/// A measured or computed trace of cylinder pressure.
///
/// The rows come from `file`, or from `pressure` with or without `theta_deg`:
///
/// * `file`: text with two columns, crank angle in degrees and pressure, or with one column of equally spaced pressures.
///   Columns are separated by semicolons, tabs, commas or blanks (with the first two a comma may stand for the decimal
///   point). Leading lines that are no numbers are a header; lines that begin with `#` are comments.
/// * `theta_deg` and `pressure`: two lists of the same length.
/// * `pressure` alone: equally spaced over the cycle from angle 0. When the number of values less one is a multiple of 90
///   (721 values over 720°) the last one belongs to the end of the cycle, otherwise (720 values) to one spacing before it.
///
/// Angles ascend and cover one cycle. A row at the end of the cycle repeats the one at its start; the two are averaged, and
/// must agree within 5 %. Between the rows runs a periodic monotone cubic, differentiable and without overshoot, or straight lines.
///
/// Noise on equally spaced rows is recognised and filtered (`smoothing`): every row would otherwise be a turning point that an integrator has
/// to follow. Noisy are rows whose median second difference grows by less than 2 over twice the spacing (4 for a smooth curve, 1 for white
/// noise) and whose noise has a standard deviation above 5e-5 of their range. The filter multiplies harmonic `k` of the cycle by `1/(1 +
/// (k/k_c)⁶)`: no shift of phase, the mean kept, the peak within some three standard deviations of the noise. A clean trace is left as it
/// is, to the bit; what was changed is told in a note.
///
/// The pressure used is `scale * p(theta - shift) + offset`.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// Text file with the rows, relative to the folder of the case.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Crank angles in degrees, ascending.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub theta_deg: Option<Vec<f64>>,
    /// Absolute pressures, in `unit`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pressure: Option<Vec<f64>>,
    /// Unit of the pressures.
    #[serde(default = "pascal")]
    pub unit: String,
    /// Curve between the rows.
    #[serde(default)]
    pub interpolation: Interpolation,
    /// Length of the cycle: 720 deg for four strokes, 360 deg for two. Whole turns, without which the piston does not come back to where it began.
    #[serde(default = "four_strokes")]
    pub cycle: PosAngle,
    /// Added to the angles of the rows: 360 deg for a trace whose angle 0 is the firing top dead centre.
    #[serde(default = "no_shift")]
    pub shift: Angle,
    /// Factor on the pressures.
    #[serde(default = "one")]
    pub scale: PosRatio,
    /// Added to the pressures after scaling: the reference pressure of a trace that is not absolute.
    #[serde(default = "no_offset")]
    pub offset: Pressure,
    /// Whether noise is filtered.
    #[serde(default)]
    pub smoothing: Smoothing,
    /// Wave length \[crank angle\] that the filter halves; with it, `auto` filters clean rows too. Left out: the longest for which the filter bends the
    /// trace by no more than half of the noise it leaves.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cutoff: Option<PosAngle>,
}

/// When a [`Table`] is filtered.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Smoothing {
    /// When its rows are noisy, or `cutoff` is given.
    #[default]
    Auto,
    /// Always; refused when the rows are not noisy and `cutoff` is not given.
    On,
    /// Never.
    Off,
}

/// Curve between the rows of a [`Table`].
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Interpolation {
    /// Monotone cubic.
    #[default]
    MonotoneCubic,
    /// Straight lines: an integrator stops at every row.
    Linear,
}

fn pascal() -> String {
    "Pa".into()
}
fn four_strokes() -> PosAngle {
    quantity(crate::periodic::FOUR_STROKE)
}
fn no_shift() -> Angle {
    quantity(0.0)
}
fn one() -> PosRatio {
    quantity(1.0)
}
fn no_offset() -> Pressure {
    quantity(0.0)
}

impl Default for Table {
    fn default() -> Self {
        Self {
            file: None,
            theta_deg: None,
            pressure: None,
            unit: pascal(),
            interpolation: Interpolation::default(),
            cycle: four_strokes(),
            shift: no_shift(),
            scale: one(),
            offset: no_offset(),
            smoothing: Smoothing::default(),
            cutoff: None,
        }
    }
}

#[register_model(
    name = "table",
    summary = "a measured trace, inline or from a file, by periodic monotone cubic or linear interpolation",
    equations = "p = scale * P(theta - shift) + offset;  P: monotone piecewise cubic Hermite (or straight lines) through the rows, periodic",
    validity = "As good as the trace; at least 4 rows per cycle, absolute pressures after scale and offset. Interpolation does not overshoot; it cuts an extremum that lies between rows.",
    references = ["fritsch1980"],
    example = "theta_deg = [0, 180, 300, 350, 370, 400, 450, 540]\npressure = [1, 1, 4, 30, 60, 25, 6, 1.5]\nunit = \"bar\"\n",
)]
impl CylinderPressureSpec for Table {
    fn build(&self, ctx: &CylinderPressureCtx<'_>) -> Result<Box<dyn CylinderPressure>, BuildError> {
        let turns = (self.cycle.si() / (2.0 * PI)).round();
        // `720 deg` may be one ulp from 4π; everything else in the program uses the exact double.
        let period = 2.0 * PI * turns;
        if turns < 1.0 || (period - self.cycle.si()).abs() > WHOLE * period {
            let what =
                format!("a cycle is a number of whole turns, not {} deg", self.cycle.si().to_degrees());
            return Err(BuildError::at("cycle", what).help("720 deg for four strokes, 360 deg for two"));
        }
        let factor = dim::Pressure::UNITS.iter().find(|u| u.name == self.unit).map(|u| u.factor);
        let Some(factor) = factor else {
            let known: Vec<_> = dim::Pressure::UNITS.iter().map(|u| format!("`{}`", u.name)).collect();
            return Err(BuildError::at("unit", format!("unit `{}` is not a pressure", self.unit))
                .help(format!("expected one of {}", known.join(", "))));
        };
        let mut rows = self.rows(ctx, period.to_degrees())?;
        rows.check(|p| p * factor * self.scale.si() + self.offset.si(), period.to_degrees())?;
        let smoothed = self.smooth(&mut rows, period)?;
        let angles: Vec<f64> = rows.theta_deg.iter().map(|t| t.to_radians() + self.shift.si()).collect();
        let linear = self.interpolation == Interpolation::Linear;
        let through = if linear { PeriodicCubic::straight } else { PeriodicCubic::new };
        let curve = through(&angles, &rows.pressure, period)
            .map_err(|TooClose(i)| rows.fault(i, Column::Theta, "is too close to the row before"))?;
        let within: Vec<f64> = angles.iter().map(|a| a.rem_euclid(period)).collect();
        let mut kinks = if linear { within.clone() } else { narrow_pulses(&within, &rows.pressure, period) };
        kinks.retain(|k| *k < period);
        kinks.sort_by(f64::total_cmp);
        // Between rows neither curve is above both of them.
        let top =
            (0..within.len()).max_by(|a, b| rows.pressure[*a].total_cmp(&rows.pressure[*b]).then(b.cmp(a)));
        let highest = top.map_or((0.0, 0.0), |k| (within[k], rows.pressure[k]));
        let notes = smoothed.into_iter().chain(self.doubt(highest, period)).collect();
        Ok(Box::new(Trace { curve, period, kinks, highest, notes }))
    }
}

/// Part of a cycle by which it may miss whole turns: 12.566 rad, four digits, count as two.
const WHOLE: f64 = 5e-5;
impl Table {
    /// Filters noisy rows, and says what that changed.
    fn smooth(&self, rows: &mut Rows, period: f64) -> Result<Option<Note>, BuildError> {
        let n = rows.pressure.len();
        let spacing = period.to_degrees() / n as f64;
        // Angles printed to two decimals.
        let off = |t: (usize, &f64)| (t.1 - rows.theta_deg[0] - t.0 as f64 * spacing).abs();
        let equal = rows.theta_deg.iter().enumerate().map(off).fold(0.0, f64::max) <= 0.01 * spacing;
        let noise = if equal { smoothing::noise(&rows.pressure) } else { None };
        let harmonic = match (self.smoothing, noise, self.cutoff) {
            (Smoothing::Auto, None, None) => return Ok(None),
            (Smoothing::Off, noise, _) => return Ok(noise.map(noisy)),
            (_, _, Some(_)) if !equal => {
                return Err(BuildError::at("cutoff", "the filter needs equally spaced rows"));
            }
            (_, _, Some(length)) => Some(period / length.si()),
            (Smoothing::On, None, None) => {
                return Err(BuildError::at(
                    "smoothing",
                    "the rows are smooth, or not equally spaced: there is no noise to go by",
                )
                .help("give `cutoff`, the wave length that the filter halves, or leave `smoothing` out"));
            }
            (_, Some(_), None) => None,
        };
        let done = smoothing::smooth(&mut rows.pressure, harmonic);
        if let Some(k) = rows.pressure.iter().position(|p| !(*p > 0.0 && p.is_finite())) {
            return Err(rows.fault(k, Column::Pressure, "is not above zero after the filter"));
        }
        Ok(Some(smoothed(done, period.to_degrees())))
    }

    fn rows(&self, ctx: &CylinderPressureCtx<'_>, period_deg: f64) -> Result<Rows, BuildError> {
        match (&self.file, &self.theta_deg, &self.pressure) {
            (Some(file), None, None) => {
                let text = ctx.files.text(file).map_err(|e| {
                    BuildError::at("file", format!("cannot read {}: {e}", ctx.files.path(file).display()))
                        .help("the name is relative to the folder of the case file")
                })?;
                Rows::parse(file, &text, period_deg)
            }
            (None, Some(theta), Some(pressure)) => {
                if theta.len() != pressure.len() {
                    let what =
                        format!("theta_deg has {} values and pressure {}", theta.len(), pressure.len());
                    return Err(BuildError::at("pressure", what));
                }
                Ok(Rows {
                    file: None,
                    lines: Vec::new(),
                    theta_deg: theta.clone(),
                    pressure: pressure.clone(),
                })
            }
            (None, None, Some(pressure)) => Ok(Rows {
                file: None,
                lines: Vec::new(),
                theta_deg: equally_spaced(pressure.len(), period_deg),
                pressure: pressure.clone(),
            }),
            (None, Some(_), None) => {
                Err(BuildError::at("pressure", "theta_deg stands there without pressure"))
            }
            (None, None, None) => Err(BuildError::new("a table needs rows")
                .help("give `file`, or `pressure` with or without `theta_deg`")),
            (Some(_), ..) => Err(BuildError::at("file", "the rows are given twice, in a file and inline")
                .help("keep either `file` or `theta_deg` and `pressure`")),
        }
    }
}

/// Highest pressure below which a cycle of four strokes is hardly one of an engine, fired or motored: a throttled one is compressed to some 6 bar \[Pa\].
const LOW: f64 = 4e5;
/// How far from the dead centre the highest pressure of a cycle of four strokes, and of two, stands at most \[rad\]: combustion at 60 deg behind it is over, and a
/// compressor delivers from some 70 deg before it.
const AWAY: (f64, f64) = (PI / 3.0, PI / 2.0);

impl Table {
    /// What is odd about a trace whose highest pressure \[Pa\] stands at this angle.
    fn doubt(&self, (at, top): (f64, f64), period: f64) -> Option<Note> {
        let four = period > 3.0 * PI;
        let bar = top / 1e5;
        if four && top < LOW {
            let text = format!(
                "the highest cylinder pressure is {bar:.4} bar, less than a motored engine has: are `unit`, here `{}`, and `scale` those of the trace?",
                self.unit
            );
            return Some(Note::caution("cylinder_pressure.low", text).amount("p_max", top, "Pa"));
        }
        let firing = if four { 2.0 * PI } else { 0.0 };
        let from = |dead: f64| (at - dead + 0.5 * period).rem_euclid(period) - 0.5 * period;
        let (away, most) = (from(firing), if four { AWAY.0 } else { AWAY.1 });
        (away.abs() > most).then(|| {
            let hint = match from(firing + 2.0 * PI).abs() <= most {
                true if four => " A trace that counts from the firing dead centre wants `shift = \"360 deg\"`",
                _ => "",
            };
            let text = format!(
                "the highest cylinder pressure, {bar:.1} bar, stands at {:.0} deg, far from the {} at {:.0} deg: is `shift`, here {:.0} deg, right?{hint}",
                at.to_degrees(),
                if four { "firing dead centre" } else { "upper dead centre" },
                firing.to_degrees(),
                self.shift.si().to_degrees()
            );
            Note::caution("cylinder_pressure.phase", text).amount("p_max_angle", at.to_degrees(), "deg")
        })
    }
}

fn noisy(noise: f64) -> Note {
    let text = format!(
        "the cylinder pressure has noise of {:.2} kPa (standard deviation), which was left as `smoothing = \"off\"` asks",
        noise / 1e3
    );
    Note::caution("cylinder_pressure.noise", text).amount("noise", noise, "Pa")
}

fn smoothed(s: Smoothed, period_deg: f64) -> Note {
    let cutoff = period_deg / s.harmonic;
    let text = format!(
        "the cylinder pressure was smoothed: noise of {:.2} kPa (standard deviation), waves shorter than {cutoff:.1} deg taken off; rows changed \
         by {:.2} kPa (root mean square), {:.2} kPa at most, the highest pressure by {:+.2} kPa; `smoothing = \"off\"` leaves them as they are",
        s.noise / 1e3,
        s.change.0 / 1e3,
        s.change.1 / 1e3,
        s.peak / 1e3
    );
    Note::caution("cylinder_pressure.smoothed", text)
        .amount("noise", s.noise, "Pa")
        .amount("cutoff", cutoff, "deg")
        .amount("rms_change", s.change.0, "Pa")
        .amount("largest_change", s.change.1, "Pa")
        .amount("peak_change", s.peak, "Pa")
}

#[derive(Debug, Clone)]
struct Trace {
    curve: PeriodicCubic,
    period: f64,
    kinks: Vec<f64>,
    highest: (f64, f64),
    notes: Vec<Note>,
}

impl CylinderPressure for Trace {
    fn pressure(&self, theta: f64) -> f64 {
        self.curve.value(theta)
    }
    fn kinks(&self) -> &[f64] {
        &self.kinks
    }
    fn period(&self) -> f64 {
        self.period
    }
    fn depends_on_speed(&self) -> bool {
        false
    }
    fn highest(&self) -> (f64, f64) {
        self.highest
    }
    fn notes(&self) -> Vec<Note> {
        self.notes.clone()
    }
}
