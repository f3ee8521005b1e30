//! What is shown of a cycle: rows in equal steps of crank angle, and maps of the films.

use gudgeon_core::EvalError;
use gudgeon_core::result::{Column, Series};
use gudgeon_skirt::Piston;

use super::assembly::Assembly;
use super::case::PistonSecondaryCase;
use super::places::{angles, places};
use super::plan::tidy;
use super::row::{COLUMNS, FILLED, INERTIA, Look, OIL, YIELD, index};
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
        for place in places(&grid, &mapped) {
            let row = look.row(place.theta, 0.0)?;
            if place.row {
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
        Ok(Self { grid, columns, shown, maps, peak })
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
