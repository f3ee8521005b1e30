//! The course over the cycle, as it is drawn.

use std::f64::consts::PI;

use gudgeon_core::kinds::TorsionOut;
use gudgeon_core::result::Column;

use crate::assemble::Assembled;
use crate::results::{DRAWN, MAX_DRAWN, TURN, column};

/// Torques of the links and speeds of the inertias against the mean at equally spaced angles of the reference shaft.
pub(super) struct Cycle {
    turns: f64,
    points: usize,
    torque: Vec<Vec<f64>>,
    speed: Vec<Vec<f64>>,
}

impl Cycle {
    /// Sums the orders at every point.
    pub fn new(out: &TorsionOut, a: &Assembled) -> Self {
        let turns = a.period / (2.0 * PI);
        let points = (TURN as f64 * turns).round() as usize;
        let mut torque = vec![vec![0.0; points + 1]; a.line.links.len()];
        let mut speed = vec![vec![0.0; points + 1]; a.line.nodes.len()];
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
                for (w, p) in speed.iter_mut().zip(&o.angle) {
                    w[i] -= rate * (p[0] * sin + p[1] * cos);
                }
            }
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
        let rows = |f: f64| self.torque[l].iter().step_by(DRAWN).map(|t| t * f).collect::<Vec<f64>>();
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
            let rows = self.speed[i].iter().step_by(DRAWN).copied().collect();
            let name = format!("inertia{}.speed", i + 1);
            columns.push(column(name.clone(), "rad/s", rows));
            speeds.push((a.line.nodes[i].name.clone(), name));
        }
    }
}
