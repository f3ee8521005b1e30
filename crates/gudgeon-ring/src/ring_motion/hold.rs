//! Rings that the oil on a flank holds: their inertia is left out while it does not matter.
//!
//! Close to a flank the squeeze film answers a change of load within nanoseconds, and its law has a sharp corner where the ring
//! turns from sinking to rising. No step that is as long as the load deserves can look across that corner with a derivative
//! taken before it. A ring is therefore *held* while its velocity follows from the balance of forces alone,
//!
//! ```text
//! F_gas + F_inertia + F_gravity + F_film + F_damping(s, v) + F_flank(s, v) = 0,
//! ```
//!
//! which falls with `v` and has one root. It is let go where the balance asks for a speed away from the flank beyond the release
//! speed, and held again when its velocity has come as close to that of the balance as the tolerance asks. Both limits are
//! proportional to the tolerance: the tighter it is, the more of the motion is integrated with its inertia.

use gudgeon_core::geometry::{FlankOil, RingPlace};
use gudgeon_core::kinds::FlankLaw;
use gudgeon_numerics::roots;

use super::groove_flank::GrooveFlank;

/// What holds a ring.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Hold {
    /// Nothing: velocity is a state.
    #[default]
    Free,
    /// The lower flank.
    Lower,
    /// The upper flank.
    Upper,
}

impl Hold {
    /// Direction away from the flank.
    pub const fn away(self) -> f64 {
        match self {
            Self::Upper => -1.0,
            _ => 1.0,
        }
    }

    /// The flank that could hold a ring.
    pub fn nearest(place: &RingPlace) -> Self {
        if place.s < 0.5 * place.clearance { Self::Lower } else { Self::Upper }
    }

    /// As a number, for the memory of a model.
    pub const fn code(self) -> f64 {
        match self {
            Self::Free => 0.0,
            Self::Lower => 1.0,
            Self::Upper => 2.0,
        }
    }

    /// From such a number.
    pub fn from_code(code: f64) -> Self {
        match code as u8 {
            0 => Self::Free,
            1 => Self::Lower,
            _ => Self::Upper,
        }
    }
}

/// Release speed over the tolerance, in clearances per radian.
const RELEASE: f64 = 10.0;
/// Smallest rate \[1/rad\] at which the velocity of a ring must tend to that of the balance for the ring to be held: a time constant of
/// half a degree.
const MIN_RATE: f64 = 100.0;
/// The derivative of the balance is taken over this part of the velocity, or the smallest change \[m/s\].
const DIFFERENCE: (f64, f64) = (1e-6, 1e-11);

/// Accuracy of the velocity of a balance: a difference Jacobian sees changes of 1e-8 of it.
const RESOLUTION: f64 = 1e-13;
/// Rounding of a derivative, generously: how far the root of a linear law may lie beyond the first guess.
const START: f64 = 1e-3;

/// Axial balance of one ring against the velocity away from a flank.
pub struct Balance<'a> {
    /// Direction away from the flank.
    pub away: f64,
    /// Gas, inertia, weight and film \[N\].
    pub external: f64,
    /// Height \[m\].
    pub s: f64,
    /// Where the oil stands.
    pub oil: FlankOil,
    /// Clearance \[m\].
    pub clearance: f64,
    /// Area of a flank \[m²\].
    pub area: f64,
    /// Force of the oil in the groove.
    pub damping: &'a dyn FlankLaw,
    /// The flanks.
    pub flank: &'a GrooveFlank,
    /// Velocity towards a flank that nothing shields \[m/s\].
    pub fall: f64,
}

impl Balance<'_> {
    /// Force away from the flank \[N\] at velocity `w` \[m/s\] away from it.
    pub fn force(&self, w: f64) -> f64 {
        let v = self.away * w;
        self.away
            * (self.external
                + self.damping.force(&self.oil, self.s, v, self.clearance, self.area)
                + self.flank.reaction(self.s, v, self.clearance))
    }

    /// How fast the force falls with the velocity \[N s/m\] at `w`, on the side away from zero; `f` is the force there.
    pub fn stiffness(&self, w: f64, f: f64) -> f64 {
        let d = (DIFFERENCE.0 * w.abs()).max(DIFFERENCE.1).copysign(w);
        (f - self.force(w + d)) / d
    }

    /// The velocity away from the flank that balances the forces; beyond `release` along the tangent there, so that a step
    /// that went too far still sees a smooth motion.
    pub fn velocity(&self, release: f64) -> f64 {
        let still = self.force(0.0);
        if still == 0.0 {
            return 0.0;
        }
        let (mut lo, mut hi, start);
        if still > 0.0 {
            let over = self.force(release);
            if over >= 0.0 {
                let k = self.stiffness(release, over);
                return if k > 0.0 { release + over / k } else { release };
            }
            (lo, hi) = (0.0, release);
            start = still / self.stiffness(0.0, still);
        } else {
            // Squeeze films are linear in the approach: the first guess is the root, but for the rounding of its derivative, and the
            // chord to it leads there.
            let guess = still / self.stiffness(-0.0, still);
            if !(guess < 0.0 && guess.is_finite()) {
                // Nothing between ring and flank resists: it falls onto the flank, in next to no time.
                return -self.fall;
            }
            let f = self.force(guess);
            start = guess * still / (still - f);
            if f.abs() <= START * still.abs() && self.force(start).abs() <= RESOLUTION * still.abs() {
                return start;
            }
            (lo, hi) = (guess, 0.0);
            for _ in 0..200 {
                if !(lo.is_finite() && self.force(lo) < 0.0) {
                    break;
                }
                hi = lo;
                lo *= if hi == guess { 1.0 + START } else { 4.0 };
            }
        }
        let tolerance = RESOLUTION * lo.abs().max(hi);
        let residual = |w: f64| {
            let f = self.force(w);
            Ok::<_, ()>((f, -self.stiffness(w, f)))
        };
        roots::newton_bracketed(residual, lo, hi, start, tolerance).map_or(start, |r| r.x)
    }
}

/// What holds a ring, and the limits of holding it.
#[derive(Debug, Clone, Copy)]
pub struct Holding {
    /// What holds it.
    pub hold: Hold,
    /// Tolerance that the holding goes by; 0: the ring is never held.
    pub tolerance: f64,
    /// One clearance per radian \[m/s\].
    pub unit_speed: f64,
    mass: f64,
    omega: f64,
    /// Whether small changes from an instant are asked for.
    pub differences: bool,
    /// How fast the axial balance falls with the velocity \[N s/m\] at that instant.
    pub tangent: f64,
}

impl Holding {
    /// A free ring.
    pub const fn new(mass: f64, unit_speed: f64, omega: f64) -> Self {
        Self { hold: Hold::Free, tolerance: 0.0, unit_speed, mass, omega, differences: false, tangent: 0.0 }
    }

    fn release_speed(&self) -> f64 {
        RELEASE * self.tolerance * self.unit_speed
    }

    /// Velocity of a held ring \[m/s\]; after a small change of its forces or its place by one step of Newton from the velocity `before`.
    pub fn velocity(&self, b: &Balance<'_>, before: f64) -> f64 {
        if self.tangent > 0.0 {
            let w = b.away * before;
            return b.away * (w + b.force(w) / self.tangent);
        }
        b.away * b.velocity(self.release_speed())
    }

    /// Goes through zero from below where a held ring is let go.
    pub fn wants_to_leave(&self, b: &Balance<'_>) -> f64 {
        let scale = self.mass * self.unit_speed * self.omega;
        b.force(self.release_speed()) / scale
    }

    /// Positive when a free ring with the velocity `v` can be held: the film is stiff, the balance keeps the ring, and the velocity has settled,
    /// which it does within a fraction of a degree when a cycle `starts`.
    pub fn readiness(&self, b: &Balance<'_>, v: f64, starts: bool) -> f64 {
        if self.tolerance <= 0.0 {
            return -1.0;
        }
        let w = b.away * v;
        let rate = b.stiffness(w, b.force(w)) / (self.mass * self.omega);
        let stiff = rate / MIN_RATE - 1.0;
        if stiff.is_nan() || stiff <= 0.0 {
            return -1.0;
        }
        let release = self.release_speed();
        let balanced = b.velocity(release);
        // A ring just let go is not held again at once; one that was held when the last cycle ended still is.
        let kept = 1.0 - if starts { 1.0 } else { 2.0 } * balanced / release;
        let settled = 1.0 - (w - balanced).abs() / (self.tolerance * self.unit_speed);
        stiff.min(kept).min(if starts { 1.0 } else { settled }).max(-1.0)
    }

    /// Lets the ring go, or has it held by the flank `nearest`; its velocity then \[clearances per radian\].
    pub fn switch(&mut self, nearest: Hold) -> f64 {
        match self.hold {
            Hold::Free => {
                self.hold = nearest;
                0.0
            }
            hold => {
                self.hold = Hold::Free;
                hold.away() * RELEASE * self.tolerance
            }
        }
    }
}
