//! The ring as a mass that moves between the groove flanks.

use gudgeon_core::geometry::{FlankOil, RingPlace};
use gudgeon_core::kinds::{
    FlankLaw, RingForces, RingMotion, RingMotionCtx, RingMotionSpec, RingPose, RingResponse, RingTrials,
    SecondOrder,
};
use gudgeon_core::quantity::{PosStiffness, PosVelocity, quantity};
use gudgeon_core::states::{Signals, Stage, StateInfo, Stateful};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_numerics::roots::{Known, RootError, first_root};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::groove_flank::GrooveFlank;
use super::hold::{Balance, Groove, Hold, Holding};

/// Newton's law for the ring in its groove, `m dv/dt = ΣF`, with stiff flanks.
///
/// A flank pushes once the ring has sunk into it by the depth `d > 0` at the rate `d'`:
///
/// ```text
/// F = k d max(0, 1 + d'/v_r)
/// ```
///
/// The law is continuous in depth and rate, never pulls, and takes energy out of every contact: over one contact the flank returns
/// at most the `½ k d²` it stored. A ring that meets the flank with the velocity `v_i` leaves it with `v_o` given by
///
/// ```text
/// G(v_o / v_r) = G(-v_i / v_r)      G(x) = -x - ln(1 - x)
/// ```
///
/// so `v_o < v_r` however hard the impact, and `v_o = v_i (1 - 2/3 v_i/v_r + …)` for a gentle one. With a rebound velocity of
/// 1 cm/s impacts in a groove are plastic for all that matters, and the scene stays smooth enough for an implicit integrator:
/// no event has to be found when a ring lands.
///
/// Source: hunt1975 (contact law), zottin1992 (balance of forces).
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NewtonGroove {
    /// Stiffness `k` of a flank. The default lets 10 kN sink in by 1 µm, about 1 % of a usual clearance.
    #[serde(default = "default_stiffness")]
    pub flank_stiffness: PosStiffness,
    /// Velocity `v_r` that no rebound exceeds. Small values damp impacts more.
    #[serde(default = "default_rebound")]
    pub rebound_velocity: PosVelocity,
    /// Whether the weight of the ring counts.
    #[serde(default = "yes")]
    pub gravity: bool,
    /// Whether the axial force of the film on the running face counts. Without it the motion does not need the film.
    #[serde(default = "yes")]
    pub film_force: bool,
}

fn default_stiffness() -> PosStiffness {
    quantity(1e10)
}
fn default_rebound() -> PosVelocity {
    quantity(0.01)
}
const fn yes() -> bool {
    true
}

impl Default for NewtonGroove {
    fn default() -> Self {
        Self {
            flank_stiffness: default_stiffness(),
            rebound_velocity: default_rebound(),
            gravity: true,
            film_force: true,
        }
    }
}

#[register_model(
    name = "newton_groove",
    summary = "the ring as a free mass between stiff, nearly plastic groove flanks",
    equations = "ds/dt = v;  m dv/dt = F_gas - m a_piston - m g + F_film + F_damping + F_flank;  \
                F_flank = k d max(0, 1 + d'/v_r) for the depth d > 0 beyond the flank",
    validity = "Ring untwisted and rigid axially, flanks parallel to it. The stiffness is numerical: results do not depend on it as long as \
               the indentation stays small against the clearance. The speed with which a keystone groove closes or opens as the ring moves along the radius \
               is left out of contact and films at its upper flank: a ring that returns to the liner from afar may be caught by that.",
    references = ["hunt1975", "zottin1992"],
    example = "flank_stiffness = \"1e10 N/m\"\nrebound_velocity = \"0.01 m/s\"\n",
)]
impl RingMotionSpec for NewtonGroove {
    fn build(&self, ctx: RingMotionCtx) -> Result<Box<dyn RingMotion>, BuildError> {
        if !(ctx.mass > 0.0 && ctx.mass.is_finite()) {
            return Err(BuildError::new(format!(
                "ring {} has the mass {:e} kg, which must be greater than zero to move",
                ctx.ring + 1,
                ctx.mass
            )));
        }
        if ctx.clearance <= 0.0 || !ctx.clearance.is_finite() {
            return Err(BuildError::new(format!(
                "ring {} has the axial clearance {:e} m: it cannot move in its groove",
                ctx.ring + 1,
                ctx.clearance
            ))
            .help("give it a clearance, or the ring motion `seated`"));
        }
        let ring = ctx.ring + 1;
        let unit_speed = ctx.clearance * ctx.omega;
        Ok(Box::new(Runtime {
            states: [
                StateInfo::new(format!("lift of ring{ring}"))
                    .absolute(HEIGHT_SCALE)
                    .within(0.0, 1.0)
                    .changes(Signals::LIFT),
                StateInfo::new(format!("axial velocity of ring{ring}"))
                    .relative(VELOCITY_SCALE)
                    .over_cycle(VELOCITY_SCALE, false)
                    .changes(Signals::AXIAL_VELOCITY),
            ],
            flank: GrooveFlank {
                stiffness: self.flank_stiffness.si(),
                per_rebound: self.rebound_velocity.si().recip(),
            },
            gravity: self.gravity,
            film_force: self.film_force,
            damping: ctx.damping,
            per_inertia: (ctx.mass * unit_speed * ctx.omega).recip(),
            clearance: ctx.clearance,
            holding: Holding::new(ctx.mass, unit_speed, ctx.omega),
            forces: RingForces::default(),
            v: 0.0,
            gap: 0.0,
            stiffness: None,
            settles: false,
        }))
    }
}

/// Velocity that counts as one in the error norm, in clearances per radian: what matters of a velocity is the distance it covers.
const VELOCITY_SCALE: f64 = 100.0;
/// Height that counts as one in the error norm, in clearances: the films on the flanks are a hundredth of a clearance thick, and
/// their force goes with the cube.
const HEIGHT_SCALE: f64 = 0.01;

/// Longest way of a trial of a stage, in clearances.
const FARTHEST: f64 = 0.02;

/// States: height over the nominal clearance, and its derivative by crank angle.
struct Runtime {
    states: [StateInfo; 2],
    flank: GrooveFlank,
    gravity: bool,
    film_force: bool,
    damping: Box<dyn FlankLaw>,
    /// One over the force \[N\] that changes the velocity state by one a radian.
    per_inertia: f64,
    clearance: f64,
    holding: Holding,
    /// Forces of the last instant whose rates were asked for, where the ring may be held.
    forces: RingForces,
    /// Velocity \[m/s\] of the last instant, and the distance from the nearer flank \[m\].
    v: f64,
    gap: f64,
    /// Derivative of the balance of the last stage by the velocity state beyond that of inertia and damping, over the square of the length of the stage: that by the height.
    stiffness: Option<f64>,
    /// Whether the velocity with which the last cycle starts tends to that of the balance at once.
    settles: bool,
}

/// Distance from the nearer flank \[m\].
fn gap(place: &RingPlace) -> f64 {
    place.s.min(place.clearance - place.s)
}

impl Runtime {
    fn balance<'a>(&'a self, forces: &'a RingForces, hold: Hold) -> Balance<'a> {
        let a = &forces.axial;
        let external = a.gas + a.inertia + a.gravity + a.film + a.expander;
        let groove = Groove { damping: &*self.damping, flank: &self.flank, fall: self.holding.unit_speed };
        Balance::new(hold.away(), external, &forces.place, groove)
    }
}

impl RingMotion for Runtime {
    fn moves(&self) -> bool {
        true
    }
    fn uses_film_force(&self) -> bool {
        self.film_force
    }
    fn uses_gravity(&self) -> bool {
        self.gravity
    }
    fn uses_damping(&self) -> bool {
        true
    }

    fn pose(&self, y: &[f64], clearance: f64) -> RingPose {
        RingPose::at_height(y[0] * self.clearance, y[1] * self.holding.unit_speed, clearance)
    }

    fn rates(&mut self, y: &[f64], forces: &RingForces, dy: &mut [f64]) -> Result<RingResponse, EvalError> {
        let hold = self.holding.hold;
        let (v, damping, reaction) = if hold == Hold::Free {
            let p = &forces.place;
            let damping = self.damping.force(&p.flank, p.s, p.v, p.clearance, p.flank_area());
            (p.v, damping, self.flank.reaction(p.s, p.v, p.clearance))
        } else {
            let balance = self.balance(forces, hold);
            let v = self.holding.velocity(&balance, self.v);
            (v, balance.damping(v), balance.reaction(v))
        };
        if hold == Hold::Free {
            let mut axial = forces.axial;
            axial.damping = damping;
            dy.copy_from_slice(&[y[1], (axial.sum() + reaction) * self.per_inertia]);
        } else {
            dy.copy_from_slice(&[v / self.holding.unit_speed, 0.0]);
        }
        if !self.holding.differences {
            (self.v, self.gap) = (v, gap(&forces.place));
            if self.n_events() > 0 {
                self.forces = *forces;
            }
        }
        Ok(RingResponse::new(v, damping, reaction))
    }

    fn solves_stages(&self) -> bool {
        true
    }

    /// `y_0 = base_0 + step y_1` turns both equations into one, `y_1 = base_1 + step ΣF(y_0, y_1)/(m c ω²)`. Where several velocities close it (a film that gives
    /// way within the step) the one that the ring meets first on its way from rest counts.
    fn stage(
        &mut self,
        stage: &Stage<'_>,
        y: &mut [f64],
        trials: &mut RingTrials<'_>,
    ) -> Result<RingResponse, EvalError> {
        let RingTrials { forces, oil, .. } = trials;
        let (c0, unit_speed, a) = (self.clearance, self.holding.unit_speed, &forces.axial);
        let external = a.gas + a.inertia + a.gravity + a.film + a.expander;
        let (per, per_step) = (stage.step * self.per_inertia, 1.0 / stage.step);
        let mut response = RingResponse::default();
        let place = &mut forces.place;
        let (clearance, area) = (place.clearance, place.flank_area());
        let balance = |u: f64| -> Result<(f64, f64), EvalError> {
            let height = stage.base[0] + stage.step * u;
            let (s, v) = (height * c0, u * unit_speed);
            RingPose::at_height(s, v, clearance).put(place);
            place.flank = oil(place);
            let (damping, falls) = self.damping.force_and_damping(&place.flank, s, v, clearance, area);
            response = RingResponse::new(v, damping, self.flank.reaction(s, v, clearance));
            let falls = falls + self.flank.damping(s, v, clearance);
            let lacks = u - stage.base[1] - per * (external + damping + response.reaction);
            Ok((lacks, 1.0 + per * unit_speed * falls))
        };
        let tol = stage.accuracy[0] * per_step;
        let rest = self.stiffness.map(|s| s * stage.step * stage.step);
        let known = Known { from: 0.0, guess: y[1], rest, reach: FARTHEST * per_step, tol };
        let found = first_root(balance, known).map_err(|e| match e {
            RootError::Function(e) => e,
            e => EvalError::recoverable("ring_motion", e.to_string()),
        })?;
        (y[0], y[1]) = (stage.base[0] + stage.step * found.x, found.x);
        (self.stiffness, self.v) = (found.rest.map(|r| r * per_step * per_step), response.v);
        self.gap = gap(&forces.place);
        Ok(response)
    }

    fn begin_differences(&mut self) {
        let hold = self.holding.hold;
        let stiffness = match hold {
            Hold::Free => 0.0,
            _ => self.balance(&self.forces, hold).stiffness(hold.away() * self.v),
        };
        (self.holding.differences, self.holding.tangent) = (true, stiffness);
    }

    fn end_differences(&mut self) {
        (self.holding.differences, self.holding.tangent) = (false, 0.0);
    }

    fn second_order(&self) -> Option<&dyn SecondOrder> {
        Some(self)
    }
}

impl SecondOrder for Runtime {
    fn damping(&self, oil: &FlankOil, s: f64, v: f64, clearance: f64, area: f64) -> f64 {
        self.damping.force(oil, s, v, clearance, area)
    }
}

impl Stateful for Runtime {
    fn states(&self) -> &[StateInfo] {
        &self.states
    }

    fn reads(&self) -> Signals {
        let own = Signals::LIFT
            | Signals::AXIAL_VELOCITY
            | Signals::FILM_THICKNESS
            | Signals::PRESSURE
            | Signals::FLANK_OIL;
        if self.film_force { own | Signals::FILM_FORCE } else { own }
    }

    fn set_accuracy(&mut self, tolerance: f64) {
        self.holding.tolerance = tolerance;
    }

    /// The position is judged by the distance from the flank.
    fn ease(&self, atol: &mut [f64]) {
        atol[0] *= (self.gap / self.clearance / HEIGHT_SCALE).max(1.0);
    }

    fn is_integrated(&self, k: usize) -> bool {
        k == 0 || self.holding.hold == Hold::Free
    }

    fn follows_at_once(&self, k: usize) -> bool {
        k == 1 && self.settles
    }

    fn n_events(&self) -> usize {
        usize::from(self.holding.tolerance > 0.0)
    }

    fn event(&self, _: usize) -> f64 {
        match self.holding.hold {
            Hold::Free => {
                let b = self.balance(&self.forces, Hold::nearest(&self.forces.place));
                self.holding.readiness(&b, self.v, false)
            }
            hold => self.holding.wants_to_leave(&self.balance(&self.forces, hold)),
        }
    }

    fn event_is_located(&self, _: usize) -> bool {
        // A ring may be held any time after it is ready, but has to be let go in time.
        self.holding.hold != Hold::Free
    }

    fn switch(&mut self, _: usize, y: &mut [f64]) {
        y[1] = self.holding.switch(&self.forces.place);
    }

    fn free(&mut self) {
        self.holding.free();
        self.settles = false;
    }

    fn start(&mut self, y: &mut [f64]) {
        let balance = self.balance(&self.forces, Hold::nearest(&self.forces.place));
        let is_held = self.holding.readiness(&balance, self.v, true) > 0.0;
        self.settles = is_held || self.holding.stiff(&balance, self.v) > 0.0;
        if is_held {
            y[1] = self.holding.switch(&self.forces.place);
        }
    }

    fn save(&self, out: &mut Vec<f64>) {
        out.push(self.holding.code());
    }

    fn restore(&mut self, saved: &[f64]) -> usize {
        self.holding.restore(saved[0]);
        1
    }
}
