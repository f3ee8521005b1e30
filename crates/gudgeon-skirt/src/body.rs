//! Masses, crank drive and the forces on the piston that do not come from its skirt.
//!
//! Frame: `z` across the bore, towards the anti-thrust side positive; `y` along it, away from the head; moments about the pin, positive when they
//! push the upper edge towards the anti-thrust side: `M = z F_y - y F_z` with `(z, y)` from the pin.

use gudgeon_core::kinds::PistonMotion;
use gudgeon_numerics::elementary;

/// Connecting rod.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rod {
    /// Mass \[kg\].
    pub mass: f64,
    /// Distance of its centre of gravity from the gudgeon pin \[m\].
    pub centre: f64,
    /// Moment of inertia about its centre of gravity \[kg m²\].
    pub inertia: f64,
}

/// Crank drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crank {
    /// Crank radius \[m\].
    pub radius: f64,
    /// Rod length between centres \[m\].
    pub rod_length: f64,
    /// Speed \[rad/s\].
    pub omega: f64,
    /// Distance of the pin from the bore axis, towards the thrust side positive \[m\].
    pub pin_offset: f64,
    /// Distance of the crank axis from the bore axis, towards the thrust side positive \[m\].
    pub crank_offset: f64,
    /// Rod.
    pub rod: Rod,
}

/// Piston and pin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// Mass of the piston \[kg\].
    pub piston_mass: f64,
    /// Mass of the pin, which moves with the piston's bosses \[kg\].
    pub pin_mass: f64,
    /// Moment of inertia of the piston about its centre of gravity \[kg m²\].
    pub inertia: f64,
    /// Height of the skirt \[m\].
    pub length: f64,
    /// Depth of the pin below the upper edge of the skirt \[m\].
    pub pin: f64,
    /// Depth of the centre of gravity below the upper edge of the skirt \[m\].
    pub centre: f64,
    /// Distance of the centre of gravity from the pin, towards the thrust side positive \[m\].
    pub centre_offset: f64,
}

/// What acts on the piston at an instant, besides its skirt.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Instant {
    /// Velocity of the piston away from the head \[m/s\].
    pub speed: f64,
    /// Acceleration of the piston away from the head \[m/s²\].
    pub acceleration: f64,
    /// Tangent of the rod's angle to the bore; positive when the crank pin stands on the anti-thrust side.
    pub tangent: f64,
    /// Gas pressure above that of the crankcase \[Pa\].
    pub pressure: f64,
    /// Gas force on the piston \[N\].
    pub gas: f64,
    /// Lateral force of the rod's inertia on the pin \[N\].
    pub rod_inertia: f64,
    /// Angular velocity of the rod, in the sense of positive moments \[rad/s\].
    pub rod_rotation: f64,
    /// Viscosity \[Pa s\].
    pub mu: f64,
}

impl Crank {
    /// The instant at crank angle `theta` \[rad\] of a piston that moves as `motion` says, under the gas pressure `pressure` \[Pa\] above that of the
    /// crankcase on the area `area` \[m²\].
    #[must_use]
    pub fn instant(&self, theta: f64, motion: &PistonMotion, pressure: f64, area: f64, mu: f64) -> Instant {
        let (sin, cos) = elementary::sin_cos(theta);
        let (r, l, w) = (self.radius, self.rod_length, self.omega);
        // From the pin to the crank pin, across and along.
        let across = self.pin_offset - self.crank_offset + r * sin;
        let along = ((l - across) * (l + across)).sqrt();
        let turn = w * r * cos / along;
        let mut now = Instant {
            speed: -motion.v,
            acceleration: -motion.a,
            tangent: across / along,
            pressure,
            gas: pressure * area,
            rod_inertia: 0.0,
            rod_rotation: -turn,
            mu,
        };
        let rod = &self.rod;
        if rod.mass > 0.0 || rod.inertia > 0.0 {
            let turning = (turn * turn * across - w * w * r * sin) / along;
            let part = rod.centre / l;
            let (az, ay) =
                (-part * r * w * w * sin, (1.0 - part) * now.acceleration + part * r * w * w * cos);
            // Moments about the crank pin: what the pin has to do to turn and carry the rod.
            let moment = (1.0 - part) * rod.mass * (along * az - across * ay) - rod.inertia * turning;
            now.rod_inertia = -moment / along;
        }
        now
    }
}

impl Body {
    /// Mass that the rod moves along the bore \[kg\].
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.piston_mass + self.pin_mass
    }

    /// Mass matrix of the displacements of the upper and the lower edge \[kg\].
    #[must_use]
    pub fn matrix(&self) -> [[f64; 2]; 2] {
        let (a, b) = (self.pin / self.length, self.centre / self.length);
        let turn = self.inertia / (self.length * self.length);
        let (m, p) = (self.piston_mass, self.pin_mass);
        let off = m * (1.0 - b) * b + p * (1.0 - a) * a - turn;
        [
            [m * (1.0 - b) * (1.0 - b) + p * (1.0 - a) * (1.0 - a) + turn, off],
            [off, m * b * b + p * a * a + turn],
        ]
    }

    /// The lateral force `force` and the moment `moment` about the pin as forces on the displacements of both edges.
    #[must_use]
    pub fn on_edges(&self, force: f64, moment: f64) -> [f64; 2] {
        let bottom = (self.pin * force - moment) / self.length;
        [force - bottom, bottom]
    }

    /// Lateral force and moment about the pin of forces on the displacements of both edges.
    #[must_use]
    pub fn about_pin(&self, edges: [f64; 2]) -> [f64; 2] {
        let force = edges[0] + edges[1];
        [force, self.pin * force - self.length * edges[1]]
    }

    /// Axial force of the rod on the piston \[N\], away from the head, when the skirt is dragged away from the head by `friction`.
    #[must_use]
    pub fn rod_axial(&self, now: &Instant, friction: f64) -> f64 {
        self.mass() * now.acceleration - now.gas - friction
    }

    /// Lateral force of the rod \[N\], towards the anti-thrust side.
    #[must_use]
    pub fn rod_lateral(&self, now: &Instant, friction: f64) -> f64 {
        now.tangent * self.rod_axial(now, friction) + now.rod_inertia
    }

    /// Moment about the pin of the gas, which presses along the axis of the bore, and of the inertia of the piston along the bore \[N m\].
    #[must_use]
    pub fn drive_moment(&self, now: &Instant, pin_offset: f64) -> f64 {
        now.gas * pin_offset + self.piston_mass * now.acceleration * self.centre_offset
    }
}
