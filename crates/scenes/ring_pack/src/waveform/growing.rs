//! A wave of one half that the other reads while it grows, perhaps in another thread.
//!
//! Films need gas and grooves up to their own instant only. So both halves of a cycle can be integrated at once: gas and grooves send their steps in bundles, and films
//! wait where they come to an instant that is not known yet. What they read is what they would have read afterwards, to the bit.

use std::cell::{Cell, Ref, RefCell};
use std::sync::mpsc::{Receiver, Sender};

use gudgeon_core::EvalError;
use gudgeon_scene::receive;

use super::track::Track;

/// Steps in a bundle, of some 200 in a cycle: with 4, 8 and 16 a cycle takes 2 to 5 % more.
const BUNDLE: usize = 12;

/// Steps that follow those before, and whether they are the last of the cycle.
pub struct Bundle {
    steps: Track,
    last: bool,
}

/// Where the steps of a half are kept as they are taken, and sent on where another thread waits for them.
pub struct Growth<'a> {
    /// Those of the cycle, or those that were not sent yet.
    pub steps: &'a mut Track,
    to: Option<Sender<Bundle>>,
}

impl<'a> Growth<'a> {
    /// Of a cycle that begins.
    pub fn begin(steps: &'a mut Track, width: usize, to: Option<Sender<Bundle>>) -> Self {
        steps.begin(0.0, width);
        Self { steps, to }
    }

    /// Steps were added.
    pub fn added(&mut self) {
        if self.to.is_some() && self.steps.ends().len() > BUNDLE {
            self.send(false);
        }
    }

    /// The cycle is complete.
    pub fn end(mut self) {
        self.send(true);
    }

    fn send(&mut self, last: bool) {
        let Some(to) = &self.to else { return };
        // Nobody waits any more where the other half failed, which it tells itself.
        let _ = to.send(Bundle { steps: self.steps.clone(), last });
        let (end, width) = (self.steps.ends().last().copied().unwrap_or(0.0), self.steps.width());
        self.steps.begin(end, width);
    }
}

/// A wave that may still grow.
pub struct Growing {
    wave: RefCell<Track>,
    more: Option<Receiver<Bundle>>,
    /// Instants before this one are known.
    until: Cell<f64>,
}

impl Growing {
    /// A wave that is complete.
    pub const fn whole(wave: Track) -> Self {
        Self { wave: RefCell::new(wave), more: None, until: Cell::new(f64::INFINITY) }
    }

    /// One that begins, with `width` values, and grows by what is sent.
    pub fn begin(mut wave: Track, width: usize, more: Receiver<Bundle>) -> Self {
        wave.begin(0.0, width);
        Self { wave: RefCell::new(wave), more: Some(more), until: Cell::new(0.0) }
    }

    pub fn into_wave(self) -> Track {
        self.wave.into_inner()
    }

    /// The wave as far as it is known.
    pub fn known(&self) -> Ref<'_, Track> {
        self.wave.borrow()
    }

    /// Values at `t` from the first on, as many as `out` holds.
    ///
    /// # Errors
    /// The other half ended before it came there.
    pub fn eval(&self, t: f64, out: &mut [f64]) -> Result<(), EvalError> {
        // The end of a step belongs to the next one.
        while t >= self.until.get() {
            self.wait()?;
        }
        self.wave.borrow().eval(t, 0, out);
        Ok(())
    }

    fn wait(&self) -> Result<(), EvalError> {
        let broken = || EvalError::fatal("ring_pack", "the other half of the cycle broke off");
        let more = self.more.as_ref().ok_or_else(broken)?;
        let bundle = receive(more).map_err(|_| broken())?;
        self.wave.borrow_mut().append(&bundle.steps);
        let end = bundle.steps.ends().last().copied().unwrap_or(0.0);
        self.until.set(if bundle.last { f64::INFINITY } else { end });
        Ok(())
    }
}
