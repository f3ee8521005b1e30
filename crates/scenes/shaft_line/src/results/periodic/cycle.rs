//! The course over the cycle, as it is drawn.

use std::f64::consts::PI;

use gudgeon_core::kinds::TorsionOut;
use gudgeon_core::result::Column;
use gudgeon_numerics::elementary;
use gudgeon_numerics::vectors::{Vectorised, widest};

use crate::assemble::Assembled;
use crate::results::{DRAWN, MAX_DRAWN, TURN, column};

/// Torques of the links and speeds of the inertias against the mean at the drawn angles of the reference shaft.
pub(super) struct Cycle {
    turns: f64,
    points: usize,
    torque: Vec<Vec<f64>>,
    speed: Vec<Vec<f64>>,
}

/// Adds an order to the drawn points of a row.
struct Add<'w> {
    row: &'w mut [f64],
    phasor: [f64; 2],
    /// Its sines and cosines.
    wave: [&'w [f64]; 2],
}

impl Vectorised for Add<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { row, phasor: [re, im], wave: [sin, cos] } = self;
        for ((r, sin), cos) in row.iter_mut().zip(sin).zip(cos) {
            *r += re * cos - im * sin;
        }
    }
}

impl Cycle {
    /// Sums the orders at every drawn point.
    pub fn new(out: &TorsionOut, a: &Assembled) -> Self {
        let turns = a.period / (2.0 * PI);
        let points = (TURN as f64 * turns).round() as usize;
        let drawn: Vec<f64> =
            (0..=points).step_by(DRAWN).map(|i| a.period * i as f64 / points as f64).collect();
        let mut torque = vec![vec![0.0; drawn.len()]; a.line.links.len()];
        let mut speed = vec![vec![0.0; drawn.len()]; a.line.nodes.len()];
        torque.iter_mut().zip(&out.mean_torque).for_each(|(t, mean)| t.fill(*mean));
        // An order that repeats with the period takes its sines from those of the first one, where the points are drawn evenly.
        let rows = points / DRAWN;
        let first: Vec<(f64, f64)> =
            drawn.iter().take(rows).map(|at| elementary::sin_cos(at * 2.0 * PI / a.period)).collect();
        let [mut sin, mut cos] = [vec![0.0; drawn.len()], vec![0.0; drawn.len()]];
        for o in out.orders.iter() {
            let multiple = o.order * turns;
            let in_table = multiple == multiple.round() && rows > 0 && points.is_multiple_of(DRAWN);
            for (i, at) in drawn.iter().enumerate() {
                (sin[i], cos[i]) = match in_table {
                    true => first[multiple as usize * i % rows],
                    false => elementary::sin_cos(o.order * at),
                };
            }
            let wave = [&sin[..], &cos];
            torque.iter_mut().zip(&o.torque).for_each(|(row, p)| widest(Add { row, phasor: *p, wave }));
            let rate = o.order * out.speed;
            let speeds = o.angle.iter().map(|p| [-rate * p[1], rate * p[0]]);
            speed.iter_mut().zip(speeds).for_each(|(row, phasor)| widest(Add { row, phasor, wave }));
        }
        Self { turns, points, torque, speed }
    }

    /// Angles of the drawn points \[deg\].
    pub fn angles(&self) -> Vec<f64> {
        let at = |i: usize| 360.0 * self.turns * i as f64 / self.points as f64;
        (0..=self.points).step_by(DRAWN).map(at).collect()
    }

    /// Columns and curves of torque and stress of a link, when it is drawn.
    pub fn draw_link(
        &self,
        a: &Assembled,
        l: usize,
        columns: &mut Vec<Column>,
        [torques, stresses]: [&mut Vec<(String, String)>; 2],
    ) {
        if l >= MAX_DRAWN {
            return;
        }
        let (name, n) = (&a.line.links[l].name, l + 1);
        let rows = |f: f64| self.torque[l].iter().map(|t| t * f).collect::<Vec<f64>>();
        columns.push(column(format!("shaft{n}.torque"), "N m", rows(1.0)));
        torques.push((name.clone(), format!("shaft{n}.torque")));
        if let Some(s) = a.stress[l] {
            columns.push(column(format!("shaft{n}.stress"), "MPa", rows(s / 1e6)));
            stresses.push((name.clone(), format!("shaft{n}.stress")));
        }
    }

    /// Column and curve of the speed of an inertia, when it is drawn.
    pub fn draw_inertia(
        &self,
        a: &Assembled,
        i: usize,
        columns: &mut Vec<Column>,
        speeds: &mut Vec<(String, String)>,
    ) {
        if i < MAX_DRAWN {
            let rows = self.speed[i].clone();
            let name = format!("inertia{}.speed", i + 1);
            columns.push(column(name.clone(), "rad/s", rows));
            speeds.push((a.line.nodes[i].name.clone(), name));
        }
    }
}
