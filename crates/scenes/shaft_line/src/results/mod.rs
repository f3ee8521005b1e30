//! What a line answers, as results, tables and figures.

mod envelope;
mod modes;
mod periodic;
mod range;
mod throws;
mod transient;
mod verdict;
mod waterfall;

use std::rc::Rc;

use gudgeon_core::kinds::LineThrow;
use gudgeon_core::result::{Column, Figure, FigureKind, Lines, Note, RunResult, Value};

use super::assemble::Assembled;
use super::case::ShaftLineCase;
use super::machine::Machine;
use throws::Pressures;

/// Points over a turn of which curves are drawn.
const TURN: usize = 1440;
/// Every how many of these points stands in the tables.
const DRAWN: usize = 4;
/// Maximum number of modes, shafts and throws that are drawn.
const MAX_DRAWN: usize = 12;

/// Writer of results.
pub struct Results<'a> {
    case: &'a ShaftLineCase,
    out: &'a mut RunResult,
    /// Of throws that were looked at.
    pressures: Vec<(LineThrow, Rc<Pressures>)>,
}

fn column(name: impl Into<String>, unit: &str, values: Vec<f64>) -> Column {
    Column { name: name.into(), unit: unit.into(), values }
}

/// Maximum and minimum of some values.
fn extremes(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::NEG_INFINITY, f64::INFINITY], |[a, b], v| [a.max(v), b.min(v)])
}

impl<'a> Results<'a> {
    pub fn new(case: &'a ShaftLineCase, out: &'a mut RunResult) -> Self {
        Self { case, out, pressures: Vec::new() }
    }

    fn result(&mut self, name: impl Into<String>, value: f64, unit: &str, what: impl Into<String>) {
        self.out.results.insert(name.into(), Value { value, unit: unit.into(), what: what.into() });
    }

    pub fn count(&mut self, name: &str, n: u64) {
        *self.out.solver.counters.entry(name.into()).or_insert(0) += n;
    }

    /// Adds what a machine took over the speed.
    pub fn work(&mut self, machine: &Machine<'_>) {
        self.count("linear_solutions", machine.solutions);
        self.count("pivot_counts", machine.steady.pivot_counts);
    }

    pub fn note(&mut self, notes: &[Note]) {
        self.out.solver.notes.extend_from_slice(notes);
    }

    fn lines(
        &mut self,
        title: &str,
        hint: &str,
        table: &str,
        x: &str,
        lines: Vec<(String, String)>,
        log_y: bool,
    ) {
        self.out.figures.push(Figure {
            title: title.into(),
            hint: hint.into(),
            table: table.into(),
            kind: FigureKind::Lines(Lines { x: x.into(), lines, log_y, ..Lines::default() }),
        });
    }

    /// Stiffness and damping of a link at a mean torque; a rigid one has neither.
    fn law(&mut self, l: usize, mean_torque: f64, a: &Assembled, about: &str) {
        let (n, name) = (l + 1, &a.line.links[l].name);
        let law = a.line.links[l].coupling.linear(0.0, mean_torque);
        if law.stiffness.is_finite() {
            self.result(
                format!("shaft{n}.stiffness"),
                law.stiffness,
                "N m/rad",
                format!("stiffness of {name} {about}"),
            );
            self.result(
                format!("shaft{n}.damping"),
                law.damping,
                "N m s/rad",
                format!("viscous damping of {name}"),
            );
        }
    }

    fn torque_limit(&self, name: &str) -> Option<f64> {
        self.case.limits.torque.iter().find(|t| t.shaft == name).and_then(|t| t.amplitude).map(|t| t.si())
    }
}
