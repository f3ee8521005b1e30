//! Optima of dampers on an undamped inertia that is held by a spring (Den Hartog 1956).
//!
//! μ is the inertia of the damper by that of the main system, frequencies are by that of the main system alone, amplitudes by the static
//! angle. Damping ratios are c by `2 J_d ω`, ω the frequency of the damper on its spring, or that of the main system for a damper without
//! one. All of it holds for μ > 0.

/// A damper at its optimum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Optimum {
    /// Natural frequency of the damper (held main system) by that of the main system alone; zero without a spring.
    pub tuning: f64,
    /// Damping ratio (see the module).
    pub damping_ratio: f64,
    /// Amplitude of the fixed points, by the static angle.
    pub amplitude: f64,
}

/// Viscous damper without a spring: `ζ = 1/√(2 (1+μ)(2+μ))`, maximum amplitude `1 + 2/μ` at `ω/ω_main = √(2/(2+μ))`.
#[must_use]
pub fn viscous(mu: f64) -> Optimum {
    Optimum {
        tuning: 0.0,
        damping_ratio: 1.0 / (2.0 * (1.0 + mu) * (2.0 + mu)).sqrt(),
        amplitude: 1.0 + 2.0 / mu,
    }
}

/// Tuned damper: `f = 1/(1+μ)`, `ζ = √(3μ/(8 (1+μ)))`, fixed points at `√(1 + 2/μ)`.
#[must_use]
pub fn tuned(mu: f64) -> Optimum {
    Optimum {
        tuning: 1.0 / (1.0 + mu),
        damping_ratio: (3.0 * mu / (8.0 * (1.0 + mu))).sqrt(),
        amplitude: (1.0 + 2.0 / mu).sqrt(),
    }
}
