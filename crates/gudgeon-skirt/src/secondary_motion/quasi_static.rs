use gudgeon_core::kinds::{
    EdgeLaw, LateralLoads, LateralPartials, LateralPose, MotionPart, SecondaryMotion, SecondaryMotionCtx,
    SecondaryMotionSpec,
};
use gudgeon_core::states::{Signals, StateInfo, Stateful};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

/// Balance of forces at every instant, without the inertia of the motion across the bore.
///
/// `0 = (forces on both edges)`: the velocities are those at which the films carry the load, and the positions are the only states. The
/// inertia left out is a ten-thousandth of the side force in an engine; what is lost is the answer of the film within nanoseconds, and the
/// flight of a piston through a clearance without oil.
///
/// States: the displacements in clearances.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct QuasiStatic {}

#[register_model(
    name = "quasi_static",
    summary = "films, contact and rod in balance at every instant; the inertia across the bore is left out",
    equations = "0 = film + contact + rod + gas and inertia about the pin + friction, solved for (de_t/dt, de_b/dt)",
    validity = "Full films on both sides, so none that keep their oil; the forces of lateral inertia (m e/dt^2) small against the side force.",
    references = ["loureiro2009"],
    example = "",
)]
impl SecondaryMotionSpec for QuasiStatic {
    fn build(&self, ctx: &SecondaryMotionCtx) -> Result<Box<dyn SecondaryMotion>, BuildError> {
        let displacement = |name: &str| StateInfo::new(name).absolute(1.0).changes(Signals::FILM_THICKNESS);
        Ok(Box::new(Balanced {
            states: [displacement("e_top"), displacement("e_bottom")],
            clearance: ctx.clearance,
            omega: ctx.omega,
            speed: ctx.clearance * ctx.omega,
            start: ctx.start,
        }))
    }
}

#[derive(Debug)]
struct Balanced {
    states: [StateInfo; 2],
    clearance: f64,
    omega: f64,
    /// A clearance per radian \[m/s\].
    speed: f64,
    start: [f64; 2],
}

impl Stateful for Balanced {
    fn states(&self) -> &[StateInfo] {
        &self.states
    }

    fn initial(&mut self, y: &mut [f64]) {
        self.states_at(self.start, [0.0; 2], y);
    }
}

impl SecondaryMotion for Balanced {
    fn pose(&self, y: &[f64]) -> LateralPose {
        LateralPose::new([self.clearance * y[0], self.clearance * y[1]])
    }

    fn rates(&mut self, _: &[f64], piston: &mut dyn LateralLoads, dy: &mut [f64]) -> Result<(), EvalError> {
        let v = piston.balance()?;
        (dy[0], dy[1]) = (v[0] / self.speed, v[1] / self.speed);
        Ok(())
    }

    fn partials(&mut self, _: &[f64], piston: &LateralPartials<'_>, jac: &mut [f64]) -> bool {
        let width = 2 + piston.by_shape.len();
        for (k, v) in piston.by_e.iter().chain(piston.by_shape).enumerate() {
            (jac[k], jac[width + k]) = (v[0] / self.omega, v[1] / self.omega);
        }
        true
    }

    fn time_partials(&mut self, by_time: [f64; 2], dfdt: &mut [f64]) -> bool {
        (dfdt[0], dfdt[1]) = (by_time[0] / self.speed, by_time[1] / self.speed);
        true
    }

    fn edge_law(&self) -> Option<&dyn EdgeLaw> {
        Some(self)
    }

    fn parts(&self) -> Vec<MotionPart> {
        let why = "`quasi_static`: films and rod are in balance at every instant";
        vec![MotionPart::left_out("inertia across the bore", why)]
    }
}

impl EdgeLaw for Balanced {
    fn mass(&self) -> Option<[[f64; 2]; 2]> {
        None
    }

    fn states_at(&self, e: [f64; 2], _: [f64; 2], y: &mut [f64]) {
        (y[0], y[1]) = (e[0] / self.clearance, e[1] / self.clearance);
    }
}
