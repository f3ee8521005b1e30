use gudgeon_core::kinds::{
    EdgeLaw, LateralLoads, LateralPartials, LateralPose, MotionPart, SecondaryMotion, SecondaryMotionCtx,
    SecondaryMotionSpec,
};
use gudgeon_core::states::{Signals, StateInfo, Stateful};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

/// Newton's law for the lateral motion and the tilt.
///
/// `M (ë_t, ë_b) = (forces on both edges)`: four states. The films answer to a change of velocity within nanoseconds, which an implicit
/// integrator passes over.
///
/// States: the displacements in clearances, then the velocities in clearances per radian. A cycle is closed by the displacements alone and begins with the
/// velocities of a balance of forces, to which the films bring every other start at once.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FullInertia {}

#[register_model(
    name = "full_inertia",
    summary = "piston and pin with their inertia across the bore",
    equations = "M d2(e_t, e_b)/dt2 = film + contact + rod + gas and inertia about the pin + friction;  \
                M = sum m grad(e) grad(e) + I/L^2 (1, -1)(1, -1)",
    validity = "Rigid piston whose pin is fixed in it; small angles; constant crank speed.",
    references = ["zhu1992", "loureiro2009"],
    example = "",
)]
impl SecondaryMotionSpec for FullInertia {
    fn build(&self, ctx: &SecondaryMotionCtx) -> Result<Box<dyn SecondaryMotion>, BuildError> {
        let displacement = |name: &str| StateInfo::new(name).absolute(1.0).changes(Signals::FILM_THICKNESS);
        let velocity = |name: &str| StateInfo::new(name).relative(VELOCITY_SCALE);
        Ok(Box::new(Inertial {
            states: [
                displacement("e_top"),
                displacement("e_bottom"),
                velocity("e_top_rate"),
                velocity("e_bottom_rate"),
            ],
            clearance: ctx.clearance,
            omega: ctx.omega,
            speed: ctx.clearance * ctx.omega,
            mass: ctx.mass,
            start: ctx.start,
        }))
    }
}

/// Velocity that counts as one in the error norm, in clearances per radian.
const VELOCITY_SCALE: f64 = 1.0;

#[derive(Debug)]
struct Inertial {
    states: [StateInfo; 4],
    clearance: f64,
    omega: f64,
    /// A clearance per radian \[m/s\].
    speed: f64,
    mass: [[f64; 2]; 2],
    start: [f64; 2],
}

impl Inertial {
    /// Accelerations of both edges \[m/s²\] under forces on them \[N\].
    fn accelerate(&self, f: [f64; 2]) -> [f64; 2] {
        let [[a, b], [_, d]] = self.mass;
        let det = a * d - b * b;
        [(d * f[0] - b * f[1]) / det, (a * f[1] - b * f[0]) / det]
    }
}

impl Stateful for Inertial {
    fn states(&self) -> &[StateInfo] {
        &self.states
    }

    fn initial(&mut self, y: &mut [f64]) {
        self.states_at(self.start, [0.0; 2], y);
    }
}

impl SecondaryMotion for Inertial {
    fn pose(&self, y: &[f64]) -> LateralPose {
        let (c, speed) = (self.clearance, self.speed);
        LateralPose::new([c * y[0], c * y[1]]).moving([y[2] * speed, y[3] * speed])
    }

    fn rates(&mut self, y: &[f64], piston: &mut dyn LateralLoads, dy: &mut [f64]) -> Result<(), EvalError> {
        let v = [y[2] * self.speed, y[3] * self.speed];
        let a = self.accelerate(piston.forces(v)?);
        for k in 0..2 {
            dy[k] = v[k] / self.speed;
            dy[2 + k] = a[k] / (self.speed * self.omega);
        }
        Ok(())
    }

    fn partials(&mut self, _: &[f64], piston: &LateralPartials<'_>, jac: &mut [f64]) -> bool {
        let (width, omega) = (4 + piston.by_shape.len(), self.omega);
        jac.fill(0.0);
        let mut column = |at: usize, force: [f64; 2], per: f64| {
            let a = self.accelerate(force);
            (jac[2 * width + at], jac[3 * width + at]) = (a[0] / per, a[1] / per);
        };
        for k in 0..2 {
            column(k, piston.by_e[k], omega * omega);
            column(2 + k, piston.by_v[k], omega);
        }
        for (k, force) in piston.by_shape.iter().enumerate() {
            column(4 + k, *force, omega * omega);
        }
        (jac[2], jac[width + 3]) = (1.0, 1.0);
        true
    }

    fn time_partials(&mut self, by_time: [f64; 2], dfdt: &mut [f64]) -> bool {
        let a = self.accelerate(by_time);
        dfdt[..2].fill(0.0);
        for k in 0..2 {
            dfdt[2 + k] = a[k] / (self.speed * self.omega);
        }
        true
    }

    fn n_periodic(&self) -> usize {
        2
    }

    /// The velocities are those of a balance of forces, which the films come to within nanoseconds; where nothing balances them, the piston starts at
    /// rest.
    fn begin(&mut self, y: &mut [f64], piston: &mut dyn LateralLoads) {
        let v = piston.balance().unwrap_or_default();
        (y[2], y[3]) = (v[0] / self.speed, v[1] / self.speed);
    }

    /// The films would see the error of a velocity, also of one at the end of a step; that of an acceleration they do not.
    fn velocities(
        &mut self,
        y: &[f64],
        slope: &dyn Fn(usize) -> f64,
        piston: &mut dyn LateralLoads,
    ) -> Result<[f64; 2], EvalError> {
        let a = [2, 3].map(|k| self.speed * self.omega * slope(k));
        let inertia = self.mass.map(|m| m[0] * a[0] + m[1] * a[1]);
        match piston.balance_against(inertia) {
            Err(e) if e.is_recoverable() => {
                let v = [y[2] * self.speed, y[3] * self.speed];
                piston.forces(v)?;
                Ok(v)
            }
            found => found,
        }
    }

    fn has_inertia(&self) -> bool {
        true
    }

    fn edge_law(&self) -> Option<&dyn EdgeLaw> {
        Some(self)
    }

    fn parts(&self) -> Vec<MotionPart> {
        vec![MotionPart::runs("inertia across the bore", "`full_inertia`")]
    }
}

impl EdgeLaw for Inertial {
    fn mass(&self) -> Option<[[f64; 2]; 2]> {
        Some(self.mass)
    }

    fn states_at(&self, e: [f64; 2], v: [f64; 2], y: &mut [f64]) {
        for k in 0..2 {
            (y[k], y[2 + k]) = (e[k] / self.clearance, v[k] / self.speed);
        }
    }
}
