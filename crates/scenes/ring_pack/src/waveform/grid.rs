//! Steps of a cycle that the next one takes again.
//!
//! Near the periodic state a cycle is much like the one before. With the same steps the two differ by less than their errors, no step is tried that proves too long, and
//! every stage begins with the rates that it had ([`Repeat`]).

use super::super::pack::Pack;
use super::Side;
use super::joint::Part;
use super::repeat::Repeat;
use super::track::Track;

/// When the steps of a cycle serve another.
#[derive(Debug, Clone, Copy)]
pub struct Rule {
    /// Largest change of the states since the steps were chosen, over what counts as one between cycles, and mean change of the films with oil on the liner.
    near: f64,
    /// Error of a step over the accuracy up to which it is taken again.
    pub slack: f64,
}

/// A step that is not accurate any more is tried again in parts.
const ACCURATE: Rule = Rule { near: 0.05, slack: 1.0 };
/// With oil on the liner every cycle of the films would differ from the others by the errors of its steps: they are kept for longer, while the state is searched.
const OIL: Rule = Rule { near: 0.3, slack: 10.0 };

impl Rule {
    /// For one side of a pack in a cycle that is recorded or not: with oil on the liner a recorded one chooses its steps anew.
    pub fn of(side: Side, pack: &Pack, recorded: bool) -> Option<Self> {
        match (side, pack.oil_pack.is_some()) {
            (_, true) if recorded => None,
            (Side::Films, true) => Some(OIL),
            _ => Some(ACCURATE),
        }
    }
}

/// The steps of one side over a cycle, and what it was when they were chosen.
#[derive(Debug, Clone, Default)]
pub struct Grid {
    /// Ends of the steps of the last cycle.
    pub ends: Vec<f64>,
    start: Vec<f64>,
    /// Films over the cycle; with oil on the liner.
    films: Option<Track>,
    /// Accuracy; zero where no steps were chosen yet.
    rtol: f64,
    /// Stages of the last cycle.
    pub repeat: Repeat,
}

impl Grid {
    /// Keeps what the steps were chosen for, at the accuracy `rtol`.
    pub fn choose(&mut self, start: Vec<f64>, films: Option<Track>, rtol: f64) {
        (self.start, self.films, self.rtol) = (start, films, rtol);
    }

    /// Whether the steps serve a cycle of accuracy `rtol` that begins at `y`, after one with the films `films`.
    pub fn serves(
        &self,
        rule: Rule,
        pack: &Pack,
        part: &Part,
        (y, films): (&[f64], &Track),
        rtol: f64,
    ) -> bool {
        let apart = |then: &Track| films.mean_change(then, pack.period(), pack.films()).change;
        self.rtol > 0.0
            && self.rtol <= rtol
            && moved(pack, part.states.iter().copied(), &self.start, y) <= rule.near
            && self.films.as_ref().is_none_or(|then| apart(then) <= rule.near)
    }
}

/// How far some of the states are from where they began a cycle, `start`: the largest change over what counts as one between cycles.
pub fn moved(pack: &Pack, states: impl Iterator<Item = usize>, start: &[f64], y: &[f64]) -> f64 {
    let change = |(k, v): (usize, &f64)| {
        let info = &pack.layout.states[k];
        let scale = if info.cycle_relative { v.abs().max(info.cycle_scale) } else { info.cycle_scale };
        (y[k] - v).abs() / scale
    };
    states.zip(start).map(change).fold(0.0, f64::max)
}
