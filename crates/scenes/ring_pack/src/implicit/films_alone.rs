//! The way to the periodic state with oil on the liner: films alone, between cycles of the whole pack.
//!
//! What takes the cycles of a pack with oil is not its rings, which repeat after a few cycles even where they flutter, but the oil on the liner and before the edges of faces: what is
//! missing of that falls by as little as a hundredth a cycle. After a cycle of the whole pack, `Φ(y)`, films and oil can go through it by themselves, under its gas and its rings, in a tenth to a third of the time.
//! What they do otherwise than in the whole, `d = Φ(y) - Φf(y)`, is then known, and where films come to rest that are moved by it, `y = Φf(y) + d`, the next cycle of the whole begins
//! (defect correction, stetter1978).

use gudgeon_numerics::EvalError;
use gudgeon_numerics::ode::IntegrateError;
use gudgeon_numerics::orbit::{Change, CycleMap, Led, OrbitOptions};
use gudgeon_scene::RunError;

use super::approach::in_halves;
use super::{Cycle, Implicit, Method, Pack};
use crate::waveform::Waveform;

/// Cycles of the whole pack before films go on alone, in turns, where the search begins far from the orbit: rings have left an arbitrary start after three. Accuracy of these
/// cycles at least.
const TURNS: [usize; 3] = [3, 1, 1];
const ROUGH: f64 = 1e-3;
/// How near to their rest films come, over what is asked of the search, where halves agreed and where rings flutter: there cycles of films differ by more, and half as near leaves
/// the same errors. In turns at least over the change of the cycle that they saw.
pub(super) const AGREED: f64 = 0.2;
const FLUTTER: f64 = 0.5;
const PART: f64 = 0.1;
/// Most of their cycles.
const MOST: usize = 30;

/// Films of a pack that go through cycles of the whole by themselves.
pub(super) struct FilmsAlone {
    /// How halves were searched.
    pub spec: Implicit,
    pub options: OrbitOptions,
    /// These, whose grooves stand as they are in the whole.
    pub waveform: Box<Waveform>,
    /// What is known of the slope of the map of films.
    pub changes: Vec<Change>,
    /// How near to their rest they come, over what is asked of the search.
    pub near: f64,
}

impl FilmsAlone {
    /// Of a pack whose halves were searched as `spec` and `options` say, and did not agree.
    pub fn new(spec: Implicit, options: OrbitOptions, pack: &Pack) -> Self {
        Self { spec, options, waveform: Box::new(Waveform::new(pack)), changes: Vec::new(), near: FLUTTER }
    }
}

impl Cycle<'_> {
    /// Where films and oil come to rest under the gas and the rings of the last cycle of the whole pack, from `y` to `end`; `None` where no films go alone, or where they cannot.
    pub(super) fn led_by_films(
        &mut self,
        (y, end): (&[f64], &[f64]),
        tolerance: f64,
    ) -> Result<Option<Led>, EvalError> {
        let Some(mut films) = self.films.take() else { return Ok(None) };
        // Films know of no passages.
        self.pack.follow_passages(false);
        let told = self.progress_told();
        let mut progress = |_: f64| (self.progress)(told);
        let mut cycle = in_halves(&films.spec, self.pack, &self.wanted, &mut progress);
        cycle.method = Method::Waveform(films.waveform);
        let (mut alone, mut next) = (y.to_vec(), end.to_vec());
        let options = OrbitOptions { tolerance: films.near * tolerance, max_cycles: MOST, ..films.options };
        let found = cycle.map(y, &mut alone, options.accuracy).and_then(|_| {
            cycle.moved = end.iter().zip(&alone).map(|(end, alone)| end - alone).collect();
            cycle.near = (!films.changes.is_empty()).then_some(f64::INFINITY);
            cycle.known = films.changes;
            cycle.periodic(&mut next, &options)
        });
        let (done, failure, method) = (cycle.done as usize, cycle.failure.take(), cycle.method);
        self.films_cycles += done;
        self.pack.follow_passages(self.follows);
        match (found, method) {
            (Ok(report), Method::Waveform(waveform)) => {
                self.known.clone_from(&report.changes);
                (films.changes, films.waveform) = (report.changes, waveform);
                self.films = Some(films);
                Ok(Some(Led { y: next, settled: report.converged }))
            }
            (Err(e), _)
                if matches!(failure, Some(IntegrateError::Eval { source: EvalError::Stopped, .. })) =>
            {
                self.failure = failure;
                Err(e)
            }
            _ => Ok(None),
        }
    }

    /// Brings `y` near the periodic state by cycles of the whole pack and of its films alone, in turns, where halves did not; the cycles of the whole.
    pub(super) fn come_near(&mut self, y: &mut [f64], options: &OrbitOptions) -> Result<usize, RunError> {
        if self.near.is_some() || options.max_cycles <= 2 * TURNS.iter().sum::<usize>() {
            return Ok(0);
        }
        let begun = self.done;
        let way = self.turns(y, options).map_err(|source| self.failed(source))?;
        self.near = self.films.as_ref().map(|_| way);
        Ok((self.done - begun) as usize)
    }

    /// The same; how far films moved the start of the last cycle of the whole, in scaled units.
    fn turns(&mut self, y: &mut [f64], options: &OrbitOptions) -> Result<f64, EvalError> {
        let (mut start, mut end, mut scale) = (y.to_vec(), y.to_vec(), vec![1.0; y.len()]);
        let (mut led, mut way) = (false, f64::INFINITY);
        for cycles in TURNS {
            for _ in 0..cycles {
                if self.films.is_none() {
                    return Ok(way);
                }
                start.copy_from_slice(y);
                match self.map(&start, y, options.accuracy.max(ROUGH)) {
                    // Nowhere the machine could be: on from where it was.
                    Err(e) if led && e.is_recoverable() => {
                        y.copy_from_slice(&end);
                        self.films = None;
                    }
                    outcome => outcome.map(|_| end.copy_from_slice(y))?,
                }
            }
            self.scale(&end, &mut scale);
            let tolerance = options.tolerance.max(PART / FLUTTER * apart(&start, &end, &scale));
            if let Some(next) = self.led_by_films((&start, &end), tolerance)? {
                y.copy_from_slice(&next.y);
                led = true;
                way = if next.settled { apart(&start, y, &scale) } else { f64::INFINITY };
            }
        }
        Ok(way)
    }
}

/// Largest difference of two starts in scaled units.
fn apart(a: &[f64], b: &[f64], scale: &[f64]) -> f64 {
    a.iter().zip(b).zip(scale).map(|((a, b), s)| ((b - a) / s).abs()).fold(0.0, f64::max)
}
