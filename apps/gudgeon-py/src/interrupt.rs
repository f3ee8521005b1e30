//! What a caller in Python hears of a computation, and how it ends one.

use std::time::{Duration, Instant};

use gudgeon_scene::{Progress, Stopped};
use pyo3::prelude::*;

/// How often Python is asked: often enough for a person who presses Ctrl-C, and too rarely to cost anything.
const EVERY: Duration = Duration::from_millis(50);

/// Asks Python now and then whether to go on.
pub struct Watch {
    callback: Option<Py<PyAny>>,
    asked: Instant,
    raised: Option<PyErr>,
}

impl Watch {
    /// `callback(phase, fraction)` ends the computation when it answers `False` or raises.
    pub fn new(callback: Option<Py<PyAny>>) -> Self {
        Self { callback, asked: Instant::now(), raised: None }
    }

    /// Passes on how far the computation is.
    ///
    /// # Errors
    /// It is to end: Ctrl-C, or the callback.
    pub fn tell(&mut self, p: Progress) -> Result<(), Stopped> {
        if self.raised.is_some() {
            return Err(Stopped);
        }
        if self.asked.elapsed() < EVERY {
            return Ok(());
        }
        self.asked = Instant::now();
        match Python::attach(|py| self.ask(py, p)) {
            Ok(true) => Ok(()),
            Ok(false) => Err(Stopped),
            Err(e) => {
                self.raised = Some(e);
                Err(Stopped)
            }
        }
    }

    /// Whether to go on.
    fn ask(&self, py: Python<'_>, p: Progress) -> PyResult<bool> {
        py.check_signals()?;
        let Some(callback) = &self.callback else { return Ok(true) };
        let answer = callback.call1(py, (p.phase, p.fraction))?;
        Ok(answer.is_none(py) || answer.is_truthy(py)?)
    }

    /// What Python raised meanwhile, a `KeyboardInterrupt` for example.
    ///
    /// # Errors
    /// That.
    pub fn end(self) -> PyResult<()> {
        self.raised.map_or(Ok(()), Err)
    }
}
