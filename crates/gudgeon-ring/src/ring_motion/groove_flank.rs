//! A groove flank as a stiff, nearly plastic wall.

/// Both flanks of a groove.
#[derive(Debug, Clone, Copy)]
pub struct GrooveFlank {
    /// Stiffness \[N/m\].
    pub stiffness: f64,
    /// One over the velocity that no rebound exceeds \[s/m\].
    pub per_rebound: f64,
}

impl GrooveFlank {
    /// Reaction \[N\] of both on a ring at height `s` \[m\] with velocity `v` \[m/s\] and a clearance \[m\], towards the head positive.
    pub fn reaction(&self, s: f64, v: f64, clearance: f64) -> f64 {
        let push = |depth: f64, rate: f64| {
            self.stiffness * depth.max(0.0) * (1.0 + self.per_rebound * rate).max(0.0)
        };
        push(-s, -v) - push(s - clearance, v)
    }

    /// How fast the reaction falls with the velocity \[N s/m\].
    pub fn damping(&self, s: f64, v: f64, clearance: f64) -> f64 {
        let one = |depth: f64, rate: f64| {
            if 1.0 + self.per_rebound * rate > 0.0 { depth.max(0.0) } else { 0.0 }
        };
        self.stiffness * self.per_rebound * (one(-s, -v) + one(s - clearance, v))
    }
}
