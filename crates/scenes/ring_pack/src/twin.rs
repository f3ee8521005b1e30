//! The same pack again, for a second thread.

use gudgeon_scene::SecondThread;

use super::pack::Pack;

/// A pack beside another that is the same, and the thread that works with it.
pub struct Twin {
    /// It has the settings and quadratures of the other; what it was evaluated for is its own.
    pub pack: Box<Pack>,
    /// Where it is evaluated.
    pub thread: SecondThread,
}

impl Twin {
    /// The pack that `build` makes, where a core is free for it.
    pub fn new(build: impl FnOnce() -> Option<Pack>) -> Option<Self> {
        let thread = SecondThread::spare()?;
        Some(Self { pack: Box::new(build()?), thread })
    }
}
