//! What is shown of a cycle: rows in equal steps of crank angle, and maps of the films.

use gudgeon_core::EvalError;
use gudgeon_core::result::{Column, Series};
use gudgeon_skirt::Piston;

use super::assembly::Assembly;
use super::case::PistonSecondaryCase;
use super::places::{angles, places};
use super::plan::tidy;
use super::row::{COLUMNS, FILLED, INERTIA, Look, OIL, Row, YIELD, index};
use super::trajectory::Trajectory;
use gudgeon_scene::RunError;

/// Pressures over one side at a crank angle.
#[derive(Debug, Clone, Default)]
pub struct Map {
    /// Crank angle \[deg\].
    pub theta_deg: f64,
    /// Pressure above that of the crankcase \[Pa\] at the nodes of the whole side.
    pub p: Vec<f64>,
}

/// Columns of the forces of both sides.
const FILM: [&str; 2] = ["thrust.film_force", "anti_thrust.film_force"];
const CONTACT: [&str; 2] = ["thrust.contact_force", "anti_thrust.contact_force"];

/// Where one side stands when it carries most.
#[derive(Debug, Clone, Default)]
pub struct Loaded {
    /// Crank angle \[deg\].
    pub theta_deg: f64,
    /// Force of film and contact on it \[N\].
    pub force: f64,
    /// Displacements of the upper and the lower edge towards the anti-thrust side \[m\].
    pub edges: [f64; 2],
    /// Gap \[m\] at the nodes of the whole side; empty when the side carries nothing.
    pub gap: Vec<f64>,
}

impl Loaded {
    /// Takes the row at `theta` \[rad\] if the side `k` carries more than so far.
    fn raise(&mut self, k: usize, theta: f64, row: &Row, look: &Look<'_>) {
        let force = look.a.piston.sides[k].sign * (row[index(FILM[k])] + row[index(CONTACT[k])]);
        if force > self.force {
            let edges = [index("skirt.e_top"), index("skirt.e_bottom")].map(|c| row[c]);
            let theta_deg = tidy(theta.to_degrees());
            *self = Self { theta_deg, force, edges, gap: look.a.piston.sides[k].gap() };
        }
    }
}

/// Load of solid contact times the way that it slides, by place on the skirt: the integral of normal pressure times speed over the cycle, by the
/// trapezoidal rule over the rows.
#[derive(Debug, Clone, Default)]
pub struct Wear {
    /// Depth below the upper edge of the rows of contact \[m\].
    pub depths: [Vec<f64>; 2],
    /// What Archard's law multiplies with a coefficient of wear there \[J/m²\], mean over the arc.
    pub sides: [Vec<f64>; 2],
    /// Crank angle \[rad\] and power of the row before \[W/m²\]; empty without contact.
    before: Option<(f64, [Vec<f64>; 2])>,
}

impl Wear {
    fn new(look: &Look<'_>) -> Self {
        let depths = [0, 1].map(|k: usize| look.a.piston.sides[k].contact_depths());
        let sides = depths.each_ref().map(|d| vec![0.0; d.len()]);
        Self { depths, sides, before: None }
    }

    /// Adds the way from the row before to this one, at `theta` \[rad\].
    fn add(&mut self, theta: f64, row: &Row, look: &mut Look<'_>) {
        let touches = CONTACT.map(|force| row[index(force)] != 0.0);
        let speed = row[index("piston.v")].abs();
        let mut power: [Vec<f64>; 2] = Default::default();
        if touches.contains(&true) {
            power = look.contact_pressures();
            power.iter_mut().flatten().for_each(|p| *p *= speed);
        }
        if let Some((from, other)) = &self.before {
            let half = 0.5 * (theta - from) / look.a.omega();
            for (sum, parts) in self.sides.iter_mut().zip(power.iter().zip(other)) {
                for part in [parts.0, parts.1] {
                    sum.iter_mut().zip(part).for_each(|(s, p)| *s += half * p);
                }
            }
        }
        self.before = Some((theta, power));
    }
}

/// Step of the crank angle at which yielding is judged \[rad\]: 3 deg, a tenth of the pulse that loads a skirt.
const YIELD_STEP: f64 = std::f64::consts::PI / 60.0;

/// A recorded cycle.
pub struct Record {
    grid: Vec<f64>,
    columns: Vec<Column>,
    shown: Vec<bool>,
    /// Maps of both sides in equal steps of crank angle.
    pub maps: [Vec<Map>; 2],
    /// The map with the highest pressure of each side.
    pub peak: [Map; 2],
    /// Each side when it carries most, among the rows.
    pub loaded: [Loaded; 2],
    /// Where the skirt rubs.
    pub wear: Wear,
}

impl Record {
    /// Looks at the cycle row by row; `peaks` are the crank angles \[rad\] of the highest pressure of each side, `flows`: with the oil that crosses the
    /// edges.
    ///
    /// # Errors
    /// A film that cannot be solved, no balance.
    pub fn new(
        look: &mut Look<'_>,
        case: &PistonSecondaryCase,
        peaks: [Option<f64>; 2],
        flows: bool,
    ) -> Result<Self, EvalError> {
        let grid = angles(look.a.period, case.outputs.series_step.si());
        let mapped = case.outputs.map_step.map_or_else(Vec::new, |m| angles(look.a.period, m.si()));
        let mut columns: Vec<Column> = COLUMNS
            .iter()
            .map(|(name, unit)| Column { name: (*name).into(), unit: (*unit).into(), values: Vec::new() })
            .collect();
        let mut maps: [Vec<Map>; 2] = Default::default();
        let (mut loaded, mut wear): ([Loaded; 2], Wear) = (Default::default(), Wear::new(look));
        for place in places(&grid, &mapped) {
            let row = look.row(place.theta, 0.0)?;
            if place.row {
                loaded.iter_mut().enumerate().for_each(|(k, l)| l.raise(k, place.theta, &row, look));
                wear.add(place.theta, &row, look);
                columns.iter_mut().zip(row).for_each(|(c, v)| c.values.push(v));
            }
            if place.map {
                let theta_deg = tidy(place.theta.to_degrees());
                for (maps, side) in maps.iter_mut().zip(&look.a.piston.sides) {
                    maps.push(Map { theta_deg, p: side.pressure() });
                }
            }
        }
        let mut peak: [Map; 2] = Default::default();
        for (k, t) in peaks.into_iter().enumerate() {
            if let Some(t) = t.filter(|_| !mapped.is_empty()) {
                let [thrust, anti_thrust] = look.pressures(t)?;
                let p = if k == 0 { thrust } else { anti_thrust };
                peak[k] = Map { theta_deg: tidy(t.to_degrees()), p };
            }
        }
        let shown = (0..COLUMNS.len())
            .map(|k| {
                (flows || !OIL.contains(&k))
                    && (look.a.elastic || k != YIELD)
                    && (look.a.motion.has_inertia() || k != INERTIA)
                    && (look.trajectory.oil.is_some() || k != FILLED)
            })
            .collect();
        Ok(Self { grid, columns, shown, maps, peak, loaded, wear })
    }

    /// Crank angles of all rows \[rad\].
    #[must_use]
    pub fn rows(&self) -> &[f64] {
        &self.grid
    }

    /// One column.
    #[must_use]
    pub fn column(&self, name: &str) -> &[f64] {
        &self.columns[index(name)].values
    }

    /// The series.
    #[must_use]
    pub fn series(&self) -> Series {
        let theta = self.grid.iter().map(|t| tidy(t.to_degrees())).collect();
        let shown = self.columns.iter().zip(&self.shown).filter(|(_, shown)| **shown);
        Series::over_cycle(theta, shown.map(|(c, _)| c.clone()).collect())
    }
}

/// How a skirt that is as `a` but for shapes in which it yields would yield to the pressures of a cycle: the largest part of the gap by which it
/// would, and the amplitudes of its shapes at the start of the cycle \[m\].
///
/// # Errors
/// A film that cannot be solved, no balance.
pub fn yielding(
    a: &mut Assembly,
    trajectory: &Trajectory,
    soft: &Piston,
) -> Result<(f64, Vec<f64>), RunError> {
    let (mut part, mut first) = (0.0_f64, Vec::new());
    let rows = angles(a.period, YIELD_STEP);
    let mut look = Look::new(a, trajectory, false);
    for (k, t) in rows.into_iter().enumerate() {
        look.row(t, 0.0).map_err(|e| look.stopped(e))?;
        for (hard, own) in look.a.piston.sides.iter().zip(&soft.sides) {
            let q = own.yields_to(hard);
            part = part.max(own.part_of_gap(&q, hard));
            if k == 0 {
                first.extend(q);
            }
        }
    }
    Ok((part, first))
}
