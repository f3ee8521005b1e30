//! A ring motion with four states: the ring lifts and its section twists.

use gudgeon_core::kinds::{
    FlankLaw, RingForces, RingMotion, RingMotionCtx, RingMotionSpec, RingPose, RingResponse,
};
use gudgeon_core::quantity::{Angle, PosPressure, PosStiffness, quantity};
use gudgeon_core::states::{ColumnInfo, Signals, StateInfo, Stateful};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_numerics::elementary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A rigid section that lifts and turns about its middle:
///
/// ```text
/// m s'' = F_gas + F_inertia + F_gravity + F_film + Σ F_oil + Σ F_flank
/// J α'' = M_gas + M_film + Σ (± w/4) F_oil + Σ (± w/2) F_flank - K (α - α_0)
/// J = m (b² + w²)/12,    K = 2π E b³ ln(r_o/r_i)/12
/// ```
///
/// Flanks push at the inner and the outer edge of the ring, the oil between them at the middles of the inner and the outer half, each with the
/// half of the area. `K` is the stiffness of a closed ring that is turned inside out (Timoshenko), `α_0` the twist that the free section
/// takes on in the bore.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LiftAndTwist {
    /// Young's modulus of the ring.
    pub modulus: PosPressure,
    /// Twist of the ring in the bore without gas, outer edge upwards positive.
    pub static_twist: Angle,
    /// Stiffness of a flank.
    pub flank_stiffness: PosStiffness,
}

impl Default for LiftAndTwist {
    fn default() -> Self {
        Self { modulus: quantity(1.1e11), static_twist: quantity(0.0), flank_stiffness: quantity(1e9) }
    }
}

#[register_model(
    name = "lift_and_twist",
    summary = "the ring as a rigid section that lifts and twists between stiff flanks",
    equations = "m s'' = sum F;  J a'' = sum M - K (a - a_0);  K = 2 pi E b^3 ln(r_o/r_i)/12",
    validity = "Small angles, a section that keeps its shape, the same twist all around. Flanks push at the edges of the ring.",
    references = ["tian1998"],
    example = "modulus = \"110 GPa\"\nstatic_twist = \"0.1 deg\"\nflank_stiffness = \"1e9 N/m\"\n",
)]
impl RingMotionSpec for LiftAndTwist {
    fn build(&self, ctx: RingMotionCtx) -> Result<Box<dyn RingMotion>, BuildError> {
        let (r_i, r_o) = (ctx.radius - 0.5 * ctx.width, ctx.radius + 0.5 * ctx.width);
        if !(ctx.mass > 0.0 && ctx.clearance > 0.0 && ctx.height > 0.0 && r_i > 0.0 && ctx.width > 0.0) {
            let what =
                format!("ring {} has no mass, no section or no clearance: it cannot twist", ctx.ring + 1);
            return Err(BuildError::new(what).help("give it one, or the ring motion `seated`"));
        }
        let (b, w) = (ctx.height, ctx.width);
        let ring = ctx.ring + 1;
        let (lift, twist) = (Signals::LIFT, Signals::TWIST);
        let state = |what: &str| StateInfo::new(format!("{what} of ring{ring}"));
        Ok(Box::new(Section {
            states: [
                state("lift").absolute(0.01).changes(lift),
                state("axial velocity")
                    .relative(100.0)
                    .over_cycle(100.0, false)
                    .changes(Signals::AXIAL_VELOCITY),
                state("twist").absolute(0.01).changes(twist),
                state("twist rate").relative(100.0).over_cycle(100.0, false).changes(Signals::AXIAL_VELOCITY),
            ],
            mass: ctx.mass,
            inertia: ctx.mass * (b * b + w * w) / 12.0,
            stiffness: std::f64::consts::TAU * self.modulus.si() * b.powi(3) * elementary::ln(r_o / r_i)
                / 12.0,
            rest: self.static_twist.si(),
            flank: 0.5 * self.flank_stiffness.si(),
            width: w,
            clearance: ctx.clearance,
            omega: ctx.omega,
            damping: ctx.damping,
            response: RingResponse::default(),
        }))
    }
}

/// Velocity that a flank gives back at most \[m/s\].
const REBOUND: f64 = 0.01;

/// States: height over the clearance `c0` and its derivative by crank angle, twist over `c0/w` and its derivative.
struct Section {
    states: [StateInfo; 4],
    mass: f64,
    inertia: f64,
    stiffness: f64,
    rest: f64,
    /// Stiffness of a flank at one edge \[N/m\].
    flank: f64,
    width: f64,
    clearance: f64,
    omega: f64,
    damping: Box<dyn FlankLaw>,
    response: RingResponse,
}

impl Section {
    /// Reaction of both flanks on a point at height `s` \[m\] with velocity `v` \[m/s\].
    fn push(&self, s: f64, v: f64, clearance: f64) -> f64 {
        let one = |depth: f64, rate: f64| self.flank * depth.max(0.0) * (1.0 + rate / REBOUND).max(0.0);
        one(-s, -v) - one(s - clearance, v)
    }
}

impl RingMotion for Section {
    fn moves(&self) -> bool {
        true
    }
    fn uses_film_force(&self) -> bool {
        true
    }
    fn uses_gravity(&self) -> bool {
        true
    }
    fn uses_damping(&self) -> bool {
        true
    }

    fn pose(&self, y: &[f64], clearance: f64) -> RingPose {
        let angle = self.clearance / self.width;
        RingPose::at_height(y[0] * self.clearance, y[1] * self.clearance * self.omega, clearance)
            .twisted(y[2] * angle, y[3] * angle * self.omega)
    }

    fn rates(&mut self, y: &[f64], forces: &RingForces, dy: &mut [f64]) -> Result<RingResponse, EvalError> {
        let p = &forces.place;
        let half = 0.5 * p.flank_area();
        let (mut oil, mut reaction, mut moment) = (0.0, 0.0, forces.twist.gas + forces.twist.film);
        for side in [-1.0, 1.0] {
            // Oil at the middle of each half, flanks at its edge.
            let (r, edge) = (side * 0.25 * self.width, side * 0.5 * self.width);
            let f =
                self.damping.force(&p.flank, p.s + r * p.twist, p.v + r * p.twist_rate, p.clearance, half);
            let n = self.push(p.s + edge * p.twist, p.v + edge * p.twist_rate, p.clearance);
            (oil, reaction, moment) = (oil + f, reaction + n, moment + r * f + edge * n);
        }
        moment -= self.stiffness * (p.twist - self.rest);
        let mut axial = forces.axial;
        axial.damping = oil;
        let per = self.omega * self.omega;
        dy[0] = y[1];
        dy[1] = (axial.sum() + reaction) / (self.mass * self.clearance * per);
        dy[2] = y[3];
        dy[3] = moment * self.width / (self.inertia * self.clearance * per);
        self.response = RingResponse::new(p.v, oil, reaction);
        Ok(self.response)
    }
}

impl Stateful for Section {
    fn states(&self) -> &[StateInfo] {
        &self.states
    }
    fn reads(&self) -> Signals {
        Signals::LIFT
            | Signals::AXIAL_VELOCITY
            | Signals::TWIST
            | Signals::FILM_THICKNESS
            | Signals::PRESSURE
            | Signals::FILM_FORCE
    }
    fn initial(&mut self, y: &mut [f64]) {
        y.copy_from_slice(&[0.5, 0.0, self.rest * self.width / self.clearance, 0.0]);
    }
    fn columns(&self) -> Vec<ColumnInfo> {
        vec![ColumnInfo::new("twist", "rad")]
    }
    fn record(&self, y: &[f64], row: &mut Vec<f64>) {
        row.push(y[2] * self.clearance / self.width);
    }
}
