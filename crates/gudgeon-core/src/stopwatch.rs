//! Wall time that has passed, on every target.

/// Counts seconds from its start. Where the target has no clock (`wasm32-unknown-unknown`, whose `std::time::Instant` panics) it stays at zero:
/// a run tells its times, and nothing that it computes depends on them.
#[derive(Debug, Clone, Copy)]
pub struct Stopwatch(Option<std::time::Instant>);

impl Stopwatch {
    /// Starts one.
    #[must_use]
    pub fn start() -> Self {
        Self((!cfg!(all(target_family = "wasm", target_os = "unknown"))).then(std::time::Instant::now))
    }

    /// Seconds since the start.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.0.map_or(0.0, |begin| begin.elapsed().as_secs_f64())
    }
}
