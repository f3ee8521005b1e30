//! Vibration at constant mean speed.

mod cycle;
mod inertias;
mod links;
mod spectra;

use std::f64::consts::PI;

use gudgeon_core::kinds::{Line, TorsionOut};
use gudgeon_core::result::{Note, Series};

use super::{Results, column};
use crate::machine::Machine;
use cycle::Cycle;

/// Vibratory twist \[rad\] and speed fluctuation beyond which small vibration about a uniform rotation is no longer what is computed.
pub const LINEAR: f64 = 1.0;

/// Part of the mean torque that drives may leave to be balanced without a word.
const UNBALANCED: f64 = 0.05;

/// Labels and columns of a figure.
type Curves = Vec<(String, String)>;

impl Results<'_> {
    /// Vibration at constant mean speed.
    pub fn periodic(&mut self, out: &TorsionOut, machine: &mut Machine<'_>) {
        let a = machine.a;
        for (name, n) in &out.counters {
            self.count(name, *n);
        }
        self.note(&out.notes);
        let cycle = Cycle::new(out, a);
        self.result(
            "balance_torque",
            out.balance_torque,
            "N m",
            "mean torque that holds the mean speed, at the reference shaft",
        );
        let mut series = Series { axis: column("angle", "deg", cycle.angles()), columns: Vec::new() };
        let (mut torques, mut stresses, mut speeds) = (Vec::new(), Vec::new(), Vec::new());
        let mut vibratory = Vec::new();
        for l in 0..a.line.links.len() {
            vibratory.push(self.periodic_link(out, machine, l));
            cycle.draw_link(a, l, &mut series.columns, [&mut torques, &mut stresses]);
        }
        for i in 0..a.line.nodes.len() {
            self.periodic_inertia(out, machine, i);
            cycle.draw_inertia(a, i, &mut series.columns, &mut speeds);
        }
        self.out.series = series;
        let over = if a.period / (2.0 * PI) > 1.5 { "over two turns" } else { "over a turn" };
        self.draw_cycle(over, torques, stresses, speeds);
        self.order_results(out, a);
        self.order_table(out, a);
        self.order_bars(out, a, &vibratory);
        self.torque_bars(a, &vibratory);
    }

    /// Says how much of the mean torque the drives of the case leave to be balanced.
    pub fn balanced(&mut self, line: &Line, out: &TorsionOut) {
        let given: f64 = line
            .drives
            .iter()
            .filter(|d| d.factor > 0.0)
            .map(|d| {
                let ratio = line.nodes[d.node].ratio;
                d.factor * d.drive.torque(d.phase, out.speed * ratio).torque * ratio
            })
            .sum();
        let asked = given + out.balance_torque;
        if given > 0.0 && out.balance_torque.abs() > UNBALANCED * asked.abs() {
            let text = format!(
                "the drives give {given:.0} N m at the mean speed where gas work, loads and drag ask for {asked:.0} N m: the difference is added where the drives act, so that the speed is held"
            );
            self.note(&[Note::info("balance_torque", text).amount("difference", out.balance_torque, "N m")]);
        }
    }

    fn draw_cycle(&mut self, over: &str, torques: Curves, stresses: Curves, speeds: Curves) {
        self.lines("Torque in the shafts", over, "series", "angle", torques, false);
        if !stresses.is_empty() {
            let hint = format!("{over}, concentration factors included");
            self.lines("Shear stress", &hint, "series", "angle", stresses, false);
        }
        let hint = format!("{over}, against the mean speed");
        self.lines("Speed fluctuation", &hint, "series", "angle", speeds, false);
    }
}
