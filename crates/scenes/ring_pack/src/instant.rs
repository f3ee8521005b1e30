//! What is known of an instant, and of the work it took.

use gudgeon_core::geometry::RingPlace;
use gudgeon_core::kinds::{AxialForces, FaceForces, FlankFlow, GasOut, Limited, PistonMotion};

/// Work counters.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counters {
    /// Evaluations of the whole scene.
    pub instants: u64,
    /// Film solves and evaluations, one per face.
    pub film: u64,
    /// Calls of the gas model.
    pub gas: u64,
}

impl Counters {
    /// Adds other work.
    pub const fn add(&mut self, o: Self) {
        self.instants += o.instants;
        self.film += o.film;
        self.gas += o.gas;
    }
}

/// One ring at an instant.
#[derive(Debug, Clone, Copy, Default)]
pub struct RingInstant {
    /// Film thickness rate \[m/s\].
    pub hdot: f64,
    /// Viscosity \[Pa s\].
    pub mu: f64,
    /// Pressures above, below, behind \[Pa\].
    pub p_above: f64,
    /// Below.
    pub p_below: f64,
    /// Behind.
    pub p_back: f64,
    /// Pressure at which the film cavitates \[Pa\].
    pub p_cav: f64,
    /// Radial load on the face, above `p_cav`, per circumference \[N/m\] of one rail.
    pub load: f64,
    /// Part of it that solid contact carries \[N/m\].
    pub contact: f64,
    /// Circumference of all rails, which turns forces per length into forces \[m\], as of the last load.
    pub perimeter: f64,
    /// Part of the load \[N/m\] that gas on the dry parts of the face carries, and their force along the liner, from the bottom
    /// edge to the top edge positive.
    pub dry: (f64, f64),
    /// Film, summed over the lands.
    pub film: FaceForces,
    /// Flux at the lower end of each land's film \[m²/s\].
    pub flux: [f64; 2],
    /// Highest pressure of the film \[Pa\], as of the last [`Pack::film_peak`](crate::pack::Pack::film_peak).
    pub film_p_max: f64,
    /// Whether `film` belongs to `hdot`.
    pub film_known: bool,
    /// Friction that the convention counts \[N\], whole ring, along the liner's velocity.
    pub friction: f64,
    /// Friction power \[W\].
    pub power: f64,
    /// The part of it that solid contact takes.
    pub boundary_power: f64,
    /// Axial forces on the whole ring \[N\].
    pub axial: AxialForces,
    /// Reaction of the flanks \[N\].
    pub reaction: f64,
    /// Flows of oil to the flanks and from them, per circumference \[m²/s\].
    pub flank: FlankFlow,
    /// What limits did.
    pub limited: Limited,
}

/// Everything at an instant.
#[derive(Debug, Clone, Default)]
pub struct Instant {
    /// Crank angle \[rad\].
    pub theta: f64,
    /// Piston motion.
    pub piston: PistonMotion,
    /// Pressures and flows.
    pub gas: GasOut,
    /// Rates of the states of the gas by time, masses in kg/s.
    pub dm: Vec<f64>,
    /// Places of the rings.
    pub places: Vec<RingPlace>,
    /// The rings.
    pub rings: Vec<RingInstant>,
}

/// Decisions on the seat of one ring.
#[derive(Debug, Clone, Default)]
pub struct SeatLog {
    /// What held before the last decision, when that changed it.
    left: Vec<f64>,
    /// Changes of seat.
    pub changes: u32,
    /// Changes that the very next decision took back.
    pub reversals: u32,
    before: Vec<f64>,
}

impl SeatLog {
    /// Remembers what holds before a decision.
    pub fn decide(&mut self, before: &[f64]) {
        self.before.clear();
        self.before.extend_from_slice(before);
    }

    /// Counts the decision.
    pub fn decided(&mut self, after: &[f64]) {
        let changed = self.before != after;
        self.changes += u32::from(changed);
        self.reversals += u32::from(changed && self.left == after);
        self.left.clear();
        if changed {
            self.left.extend_from_slice(&self.before);
        }
    }

    /// Begins to count anew.
    pub fn clear(&mut self) {
        (self.changes, self.reversals) = (0, 0);
        self.left.clear();
    }
}
