//! The ring as a mass that moves between the groove flanks.

use gudgeon_core::kinds::{AxialForces, Motion, RingMotion, RingMotionCtx, RingMotionSpec};
use gudgeon_core::quantity::{PosStiffness, PosVelocity, quantity};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
               the indentation stays small against the clearance.",
    references = ["hunt1975", "zottin1992"],
    example = "flank_stiffness = \"1e10 N/m\"\nrebound_velocity = \"0.01 m/s\"\n",
)]
impl RingMotionSpec for NewtonGroove {
    fn build(&self, ctx: &RingMotionCtx) -> Result<Box<dyn RingMotion>, BuildError> {
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
        Ok(Box::new(Runtime {
            stiffness: self.flank_stiffness.si(),
            per_rebound: self.rebound_velocity.si().recip(),
            gravity: self.gravity,
            film_force: self.film_force,
        }))
    }
}

struct Runtime {
    stiffness: f64,
    per_rebound: f64,
    gravity: bool,
    film_force: bool,
}

impl RingMotion for Runtime {
    fn motion(&self) -> Motion {
        Motion::Dynamic
    }

    fn uses_film_force(&self) -> bool {
        self.film_force
    }

    fn uses_gravity(&self) -> bool {
        self.gravity
    }

    fn flank_reaction(&self, s: f64, v: f64, clearance: f64) -> f64 {
        let push = |depth: f64, rate: f64| {
            self.stiffness * depth.max(0.0) * (1.0 + self.per_rebound * rate).max(0.0)
        };
        push(-s, -v) - push(s - clearance, v)
    }

    fn seat(&self, _: &AxialForces) -> f64 {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CTX: RingMotionCtx = RingMotionCtx { mass: 0.043, clearance: 1e-4, flank_area: 1.8e-3, ring: 0 };

    fn built(spec: &NewtonGroove) -> Box<dyn RingMotion> {
        spec.build(&CTX).expect("default builds")
    }

    #[test]
    fn flanks_only_push_and_meet_zero_continuously() {
        let m = built(&NewtonGroove::default());
        let c = CTX.clearance;
        for v in [-3.0, -1e-3, 0.0, 1e-3, 3.0] {
            assert_eq!(m.flank_reaction(0.5 * c, v, c), 0.0);
            assert_eq!(m.flank_reaction(0.0, v, c), 0.0);
            assert_eq!(m.flank_reaction(c, v, c), 0.0);
            for d in [1e-15, 1e-9, 1e-7, 1e-6] {
                let lower = m.flank_reaction(-d, v, c);
                let upper = m.flank_reaction(c + d, v, c);
                assert!(lower >= 0.0 && upper <= 0.0);
                // The factor of k d is at most 1 + 3/0.01.
                assert!(lower.max(-upper) <= 1.0001e10 * d * 301.0);
                // Up and down are mirrored; the depth at the upper flank carries the rounding of c + d, 1e-20 m.
                let mirrored = -m.flank_reaction(c + d, -v, c);
                assert!((lower - mirrored).abs() <= 1e10 * 2e-20 * 301.0, "{lower} {mirrored}");
            }
        }
        // 10 kN indents 1 µm.
        assert!((m.flank_reaction(-1e-6, 0.0, c) - 1e4).abs() < 1e-8);
    }

    /// Depth and velocity after one contact by a classical Runge-Kutta scheme with tiny steps, until the ring has left.
    fn rebound(m: &dyn RingMotion, mass: f64, v_in: f64, dt: f64) -> f64 {
        let c = CTX.clearance;
        let f = |y: [f64; 2]| [y[1], m.flank_reaction(y[0], y[1], c) / mass];
        let add = |y: [f64; 2], k: [f64; 2], h: f64| [y[0] + h * k[0], y[1] + h * k[1]];
        let mut y = [0.0, -v_in];
        for _ in 0..20_000_000 {
            let k1 = f(y);
            let k2 = f(add(y, k1, 0.5 * dt));
            let k3 = f(add(y, k2, 0.5 * dt));
            let k4 = f(add(y, k3, dt));
            for i in 0..2 {
                y[i] += dt / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
            }
            if y[0] >= 0.0 && y[1] > 0.0 {
                return y[1];
            }
        }
        panic!("no rebound");
    }

    /// Positive root of -x - ln(1 - x) = rhs by bisection in y = -ln(1 - x), which stays well scaled near x = 1.
    fn closed_form(v_in: f64, v_r: f64) -> f64 {
        let xi = v_in / v_r;
        let rhs = xi - xi.ln_1p();
        let g = |y: f64| (-y).exp_m1() + y;
        let (mut lo, mut hi) = (0.0, rhs + 2.0);
        for _ in 0..200 {
            let mid = 0.5 * (lo + hi);
            if g(mid) < rhs { lo = mid } else { hi = mid }
        }
        v_r * -(-lo).exp_m1()
    }

    #[test]
    fn rebound_follows_the_closed_form_and_loses_energy() {
        let v_r = 0.5;
        let spec = NewtonGroove { rebound_velocity: quantity(v_r), ..NewtonGroove::default() };
        let m = built(&spec);
        let mut last = 0.0;
        for v_in in [0.01, 0.1, 0.5, 2.0] {
            let v_out = rebound(m.as_ref(), CTX.mass, v_in, 1e-10);
            let exact = closed_form(v_in, v_r);
            // The contact ends inside one step of 1e-10 s, in which the force, at most k·v·dt, changes the velocity by less than
            // 1e10·0.5·1e-10/0.043·1e-10 ~ 1e-9 m/s; the scheme itself is far better than that.
            assert!((v_out - exact).abs() < 2e-9, "{v_in}: {v_out} {exact}");
            assert!(v_out < v_in, "energy must decrease");
            assert!(v_out < v_r, "no rebound is faster than v_r");
            assert!(v_out > last, "a harder impact rebounds faster");
            last = v_out;
        }
        // Gentle impacts: v_o/v_i = 1 - 2/3 v_i/v_r + O(v_i²/v_r²).
        let x = 1e-3;
        let ratio = closed_form(x * v_r, v_r) / (x * v_r);
        assert!((ratio - (1.0 - 2.0 / 3.0 * x)).abs() < 2.0 * x * x, "{ratio}");
    }

    #[test]
    fn refuses_what_cannot_move() {
        let spec = NewtonGroove::default();
        assert!(spec.build(&RingMotionCtx { clearance: 0.0, ..CTX }).is_err());
        assert!(spec.build(&RingMotionCtx { mass: 0.0, ..CTX }).is_err());
        assert!(spec.build(&RingMotionCtx { mass: f64::NAN, ..CTX }).is_err());
    }
}
