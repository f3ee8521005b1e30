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
//!
//! A flank that comes down on a ring faster than it pushes back, as that of a keystone groove may when the ring returns to the liner, is *entered*. It then pushes the ring out at
//! the speed that no rebound exceeds, against forces that hardly matter, by a law whose corner is where its force ends: the ring stands on it all the way out. It is held
//! meanwhile, as far as that speed is the balance's.

use gudgeon_core::geometry::RingPlace;
use gudgeon_core::kinds::{FlankLaw, FlankResistance};

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
/// Depth in a flank, in clearances, from which a ring is pushed out of it: the default stiffness lets 10 kN press it in by a hundredth of a usual one.
const ENTERED: f64 = 0.02;
/// What that adds to the number of a hold.
const PUSHED_CODE: f64 = 4.0;
/// Release speed of a ring that is pushed out, over the one that no rebound exceeds.
const PUSHED: f64 = 4.0;
/// Smallest rate \[1/rad\] at which the velocity of a ring must tend to that of the balance for the ring to be held: a time constant of
/// half a degree.
const MIN_RATE: f64 = 100.0;
/// Distance of a velocity from that of the balance, over the latter, with which a ring is held where a cycle starts: it tends there within a fraction of a degree.
const NEAR: f64 = 0.3;
/// The derivative of a balance of which only the force is known is taken over this part of the velocity, or the smallest change \[m/s\].
const DIFFERENCE: (f64, f64) = (1e-6, 1e-11);

/// Accuracy of the velocity of a balance: a difference Jacobian sees changes of 1e-8 of it.
const RESOLUTION: f64 = 1e-13;
/// Last step of Halley's method: it leaves at most a quarter of the cube of its relative size, less than a rounding.
const SETTLED: f64 = 1e-5;
/// Steps of a search: three as a rule; a law that nothing is known of may take one for every digit of a bisection.
const MAX_STEPS: usize = 200;

/// What resists a ring in its groove.
#[derive(Clone, Copy)]
pub struct Groove<'a> {
    /// Force of the oil in the groove.
    pub damping: &'a dyn FlankLaw,
    /// The flanks.
    pub flank: &'a GrooveFlank,
    /// Velocity towards a flank that nothing shields \[m/s\].
    pub fall: f64,
}

/// Axial balance of one ring against the velocity away from a flank.
pub struct Balance<'a> {
    /// Direction away from the flank.
    away: f64,
    /// Gas, inertia, weight and film \[N\].
    external: f64,
    place: &'a RingPlace,
    groove: Groove<'a>,
    /// The films on the flanks, where their law tells them.
    films: Option<FlankResistance>,
}

impl<'a> Balance<'a> {
    /// The balance away from a flank in the direction `away` (1 or -1), under an external force \[N\] towards the head, of a ring at a place.
    pub fn new(away: f64, external: f64, place: &'a RingPlace, groove: Groove<'a>) -> Self {
        let films = groove.damping.resistance(&place.flank, place.s, place.clearance, place.flank_area());
        Self { away, external, place, groove, films }
    }

    /// Force of the oil \[N\] towards the head at velocity `v` \[m/s\] towards it.
    pub fn damping(&self, v: f64) -> f64 {
        let p = self.place;
        match &self.films {
            Some(films) => films.force(v),
            None => self.groove.damping.force(&p.flank, p.s, v, p.clearance, p.flank_area()),
        }
    }

    /// Force of the flanks \[N\] towards the head.
    pub fn reaction(&self, v: f64) -> f64 {
        self.groove.flank.reaction(self.place.s, v, self.place.clearance)
    }

    /// Force away from the flank \[N\] at velocity `w` \[m/s\] away from it.
    pub fn force(&self, w: f64) -> f64 {
        let v = self.away * w;
        self.away * (self.external + self.damping(v) + self.reaction(v))
    }

    /// How fast the force falls with the velocity \[N s/m\] at `w`, on the side away from zero.
    pub fn stiffness(&self, w: f64) -> f64 {
        -self.surplus(1.0_f64.copysign(w), w.abs())[1]
    }

    /// How fast the reaction of the flanks falls with the velocity \[N s/m\] at `w`.
    fn wall(&self, w: f64) -> f64 {
        self.groove.flank.damping(self.place.s, self.away * w, self.place.clearance)
    }

    /// Force \[N\] that drives on at the speed `u` \[m/s\] away from the flank (`side` 1) or towards it (-1), with its first two derivatives by the speed; the second
    /// is left out where only forces are known.
    fn surplus(&self, side: f64, u: f64) -> [f64; 3] {
        let w = side * u;
        let Some(films) = &self.films else {
            let d = (DIFFERENCE.0 * u).max(DIFFERENCE.1);
            let f = self.force(w);
            return [side * f, side * (self.force(side * (u + d)) - f) / d, 0.0];
        };
        let v = self.away * w;
        let [resistance, slope, bend] = films.at(v);
        let drive = side * self.away * (self.external + self.reaction(v));
        [drive - resistance, -(slope + self.wall(w)), -bend]
    }

    /// The velocity away from the flank that balances the forces; beyond `release` along the tangent there, so that a step
    /// that went too far still sees a smooth motion.
    pub fn velocity(&self, release: f64) -> f64 {
        let still = self.force(0.0);
        if still == 0.0 {
            return 0.0;
        }
        if still > 0.0 {
            let [over, slope, _] = self.surplus(1.0, release);
            if over >= 0.0 {
                return if slope < 0.0 { release - over / slope } else { release };
            }
            return self.speed(1.0, release).unwrap_or(release);
        }
        // Where nothing between ring and flank resists, it falls onto the flank, in next to no time.
        self.speed(-1.0, f64::INFINITY).map_or(-self.groove.fall, |u| -u)
    }

    /// The speed below `hi` at which nothing drives on any more, where a ring at rest is driven.
    ///
    /// The surplus `f(u)` falls and bends up: the films ahead are linear, those that are drawn apart saturate, and a wall that is left lets go at a hinge. Newton's
    /// method would come from `u = 0` without ever going too far. Halley's is exact for one saturating film alone. With the derivatives `f_n`, what its step `e` leaves is,
    /// for any of them, `e³ [(f_2/2f_1)² - f_3/6f_1]`: the bracket is minus the variance of `1/(u + t_i/d_i)` over the films with their shares in `f_1` as weights, at
    /// most `1/(4 u²)`. Between hinges a step of [`SETTLED`] is therefore the last.
    fn speed(&self, side: f64, mut hi: f64) -> Option<f64> {
        let (mut lo, mut u, mut before) = (0.0, 0.0, f64::INFINITY);
        for _ in 0..MAX_STEPS {
            let [f, slope, bend] = self.surplus(side, u);
            if f > 0.0 {
                lo = u;
            } else {
                hi = u;
            }
            let next = u - 2.0 * f * slope / (2.0 * slope * slope - f * bend);
            let step = (next - u).abs();
            let last = step <= SETTLED * next && self.is_smooth(side * u, side * next);
            if last || step <= RESOLUTION * next {
                return Some(next);
            }
            // Across a hinge a step may lead to and fro.
            let closes = f.abs() <= 0.5 * before;
            before = f.abs();
            let candidates = if closes { [next, u - f / slope] } else { [f64::NAN; 2] };
            let Some(next) = within(lo, hi, candidates) else { break };
            u = next;
        }
        hi.is_finite().then_some(u)
    }

    /// Whether all derivatives are known and none jumps between two velocities.
    fn is_smooth(&self, w: f64, other: f64) -> bool {
        self.films.is_some() && self.wall(w) == self.wall(other)
    }
}

/// The first of the candidates that lies between `lo` and `hi`; else their middle, or far beyond `lo` if there is no end. Nowhere, if nothing is between.
fn within(lo: f64, hi: f64, candidates: [f64; 2]) -> Option<f64> {
    let other = if hi.is_finite() { 0.5 * (lo + hi) } else { 4.0 * lo };
    let [first, second] = candidates;
    [first, second, other].into_iter().find(|u| *u > lo && *u < hi)
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
    /// Whether it was held within a flank, which pushes it out.
    pushed: bool,
}

/// Depth in a flank \[m\].
fn depth(place: &RingPlace) -> f64 {
    (-place.s).max(place.s - place.clearance)
}

impl Holding {
    /// A free ring.
    pub const fn new(mass: f64, unit_speed: f64, omega: f64) -> Self {
        Self {
            hold: Hold::Free,
            tolerance: 0.0,
            unit_speed,
            mass,
            omega,
            differences: false,
            tangent: 0.0,
            pushed: false,
        }
    }

    fn release_speed(&self, b: &Balance<'_>) -> f64 {
        let own = RELEASE * self.tolerance * self.unit_speed;
        if self.pushed && depth(b.place) > 0.0 { own.max(PUSHED / b.groove.flank.per_rebound) } else { own }
    }

    /// Whether a ring is within a flank.
    fn has_entered(&self, place: &RingPlace) -> bool {
        depth(place) > ENTERED * self.unit_speed / self.omega
    }

    /// Has nothing hold the ring.
    pub const fn free(&mut self) {
        (self.hold, self.pushed) = (Hold::Free, false);
    }

    /// As a number, for the memory of a model.
    pub const fn code(&self) -> f64 {
        self.hold.code() + if self.pushed { PUSHED_CODE } else { 0.0 }
    }

    /// From such a number.
    pub fn restore(&mut self, code: f64) {
        self.pushed = code >= PUSHED_CODE;
        self.hold = Hold::from_code(code % PUSHED_CODE);
    }

    /// Velocity of a held ring \[m/s\]; after a small change of its forces or its place by one step of Newton from the velocity `before`.
    pub fn velocity(&self, b: &Balance<'_>, before: f64) -> f64 {
        if self.tangent > 0.0 {
            let w = b.away * before;
            return b.away * (w + b.force(w) / self.tangent);
        }
        b.away * b.velocity(self.release_speed(b))
    }

    /// Goes through zero from below where a held ring is let go.
    pub fn wants_to_leave(&self, b: &Balance<'_>) -> f64 {
        let scale = self.mass * self.unit_speed * self.omega;
        b.force(self.release_speed(b)) / scale
    }

    /// How fast the velocity `v` of a free ring tends to that of the balance, over the least rate for which a ring is held, less one.
    pub fn stiff(&self, b: &Balance<'_>, v: f64) -> f64 {
        let rate = b.stiffness(b.away * v) / (self.mass * self.omega);
        rate / MIN_RATE - 1.0
    }

    /// Positive when a free ring with the velocity `v` can be held: the film is stiff, the balance keeps the ring, and the velocity has settled, to the accuracy or, where a
    /// cycle `starts`, nearly.
    pub fn readiness(&self, b: &Balance<'_>, v: f64, starts: bool) -> f64 {
        if self.tolerance <= 0.0 {
            return -1.0;
        }
        if self.has_entered(b.place) {
            let release = PUSHED / b.groove.flank.per_rebound;
            return (1.0 - b.velocity(release) / release).max(-1.0);
        }
        let (w, stiff) = (b.away * v, self.stiff(b, v));
        if stiff.is_nan() || stiff <= 0.0 {
            return -1.0;
        }
        let release = self.release_speed(b);
        let balanced = b.velocity(release);
        let (off, admitted) = ((w - balanced).abs(), self.tolerance * self.unit_speed);
        // A ring just let go is not held again at once; one that was held when the last cycle ended, at rest as its state says, still is.
        let (kept, settled) = if starts {
            (1.0 - balanced / release, 1.0 - off.min(w.abs()) / (admitted + NEAR * balanced.abs()))
        } else {
            (1.0 - 2.0 * balanced / release, 1.0 - off / admitted)
        };
        stiff.min(kept).min(settled).max(-1.0)
    }

    /// Lets the ring go, or has it held by the nearest flank at a place; its velocity then \[clearances per radian\].
    pub fn switch(&mut self, place: &RingPlace) -> f64 {
        match self.hold {
            Hold::Free => {
                (self.hold, self.pushed) = (Hold::nearest(place), self.has_entered(place));
                0.0
            }
            hold => {
                self.free();
                hold.away() * RELEASE * self.tolerance
            }
        }
    }
}
