//! Why a ring pack has no periodic cycle.

/// What stopped the run of a ring pack.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RingPackError {
    /// The integrator needs too many steps.
    #[error(
        "at {theta_deg:.3} deg crank angle a cycle has taken {max} steps, the most that `solver.limits.max_steps` lets it take"
    )]
    Steps {
        /// Where \[deg\].
        theta_deg: f64,
        /// The limit.
        max: u64,
    },
    /// A ring rests on next to nothing.
    #[error(
        "at {theta_deg:.1} deg crank angle {load:.4} N press ring {ring} on a film of {film_nm:.2} nm, which neither oil nor contact carries. \
         Give the ring a `contact` that can carry it, such as `greenwood_tripp`"
    )]
    NothingCarries {
        /// Ring, from 1.
        ring: usize,
        /// Where \[deg\].
        theta_deg: f64,
        /// Load that is left \[N\].
        load: f64,
        /// Film thickness \[nm\].
        film_nm: f64,
    },
}
