//! Forces on the piston at an instant, as a person looks at them.

/// Forces on the piston at an instant, as a person looks at them. Thrust side first.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Summary {
    /// Lateral force of the film of each side \[N\], towards the anti-thrust side.
    pub film: [f64; 2],
    /// Moment of the film pressure of each side about the pin \[N m\].
    pub film_moment: [f64; 2],
    /// Viscous force on each side along the bore, away from the head \[N\].
    pub film_friction: [f64; 2],
    /// Moment of the viscous force of each side about the pin \[N m\].
    pub film_friction_moment: [f64; 2],
    /// Lateral force of solid contact of each side \[N\].
    pub contact: [f64; 2],
    /// Moment of solid contact of each side about the pin \[N m\].
    pub contact_moment: [f64; 2],
    /// Friction of solid contact along the bore, away from the head \[N\].
    pub contact_friction: [f64; 2],
    /// Lateral force of the rod \[N\], towards the anti-thrust side.
    pub rod: f64,
    /// Moment of the pin's friction \[N m\].
    pub pin_moment: f64,
    /// Lateral force of the rings \[N\].
    pub groove: f64,
    /// Sum of lateral forces \[N\] and of moments about the pin \[N m\]: what accelerates the piston.
    pub net: [f64; 2],
    /// Highest film pressure above that of the crankcase on each side \[Pa\].
    pub p_max: [f64; 2],
    /// Smallest gap on each side \[m\].
    pub gap: [f64; 2],
}

impl Summary {
    /// Friction of film and contact of both sides along the bore, away from the head \[N\].
    #[must_use]
    pub fn friction(&self) -> f64 {
        self.film_friction[0] + self.film_friction[1] + self.contact_friction[0] + self.contact_friction[1]
    }
    /// Lateral force of film and contact of both sides \[N\].
    #[must_use]
    pub fn side_force(&self) -> f64 {
        self.film[0] + self.film[1] + self.contact[0] + self.contact[1]
    }
}
