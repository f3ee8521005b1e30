//! Three seats: lower flank, upper flank, unstable in between.

use gudgeon_core::kinds::{
    AxialForces, RingForces, RingMotion, RingMotionCtx, RingMotionSpec, RingPose, RingResponse,
};
use gudgeon_core::quantity::{Fraction, PosAngle, Ratio, quantity};
use gudgeon_core::states::{Signals, Stateful};
use gudgeon_core::{BuildError, EvalError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The ring sits on the lower flank, on the upper flank, or is unstable, as the axial forces say at fixed crank angles.
///
/// ```text
/// R = F_gas - m a_piston + F_film + F_gravity       (towards the head positive)
/// e = ½   for |R| <= band |F_gas|
/// e = 1   for R > 0,   e = 0   for R < 0
/// ```
///
/// Unstable means that a change of the gas force by the fraction `band` would change the seat. The way from seat to seat is not
/// computed; the seat is held until the next decision.
///
/// Source: tomanik1993, ruddy1981.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ThreeSeat {
    /// Crank angle between decisions.
    #[serde(default = "default_interval")]
    pub interval: PosAngle,
    /// Fraction of the gas force within which the ring is unstable.
    #[serde(default = "default_band")]
    pub band: Ratio<Fraction>,
    /// Whether the weight of the ring counts.
    #[serde(default)]
    pub gravity: bool,
    /// Whether the axial force of the film on the running face counts. Without it the motion does not need the film.
    #[serde(default = "yes")]
    pub film_force: bool,
}

fn default_interval() -> PosAngle {
    quantity(std::f64::consts::PI / 180.0)
}
fn default_band() -> Ratio<Fraction> {
    quantity(0.1)
}
const fn yes() -> bool {
    true
}

impl Default for ThreeSeat {
    fn default() -> Self {
        Self { interval: default_interval(), band: default_band(), gravity: false, film_force: true }
    }
}

#[register_model(
    name = "three_seat",
    summary = "on the lower flank, on the upper flank, or unstable, decided at fixed crank angles",
    equations = "R = F_gas - m a_piston + F_film;  e = 1/2 for |R| <= band |F_gas|, else 1 for R > 0, 0 for R < 0",
    validity = "Seat changes that are short against the interval. Gives no trajectory and no impact; groove oil has no influence. Near the \
               speed where rings start to float there are two periodic solutions, and cycles of more than one period.",
    references = ["tomanik1993", "ruddy1981"],
    example = "interval = \"1 deg\"\nband = 0.1\n",
)]
impl RingMotionSpec for ThreeSeat {
    fn build(&self, _: RingMotionCtx) -> Result<Box<dyn RingMotion>, BuildError> {
        let interval = self.interval.si();
        if interval > std::f64::consts::PI {
            return Err(BuildError::at(
                "interval",
                format!("{:.3} deg between decisions is more than half a revolution", interval.to_degrees()),
            )
            .help("1 deg is usual"));
        }
        Ok(Box::new(Runtime {
            interval,
            band: self.band.si(),
            gravity: self.gravity,
            film_force: self.film_force,
            seat: [0.0],
        }))
    }
}

struct Runtime {
    interval: f64,
    band: f64,
    gravity: bool,
    film_force: bool,
    /// The seat that was decided last.
    seat: [f64; 1],
}

impl Runtime {
    /// The seat for these forces: only what this model counts, whatever else the caller has filled in. A seated ring has no damping force.
    fn seat(&self, f: &AxialForces) -> f64 {
        let resultant = f.gas
            + f.inertia
            + f.expander
            + if self.gravity { f.gravity } else { 0.0 }
            + if self.film_force { f.film } else { 0.0 };
        if resultant.abs() <= self.band * f.gas.abs() {
            0.5
        } else if resultant > 0.0 {
            1.0
        } else {
            0.0
        }
    }
}

impl Stateful for Runtime {
    fn initial(&mut self, _: &mut [f64]) {
        self.seat = [0.0];
    }
    fn reads(&self) -> Signals {
        if self.film_force { Signals::PRESSURE | Signals::FILM_FORCE } else { Signals::PRESSURE }
    }
    fn decision_interval(&self) -> Option<f64> {
        Some(self.interval)
    }
    fn decided(&self) -> &[f64] {
        &self.seat
    }
    fn save(&self, out: &mut Vec<f64>) {
        out.push(self.seat[0]);
    }
    fn restore(&mut self, saved: &[f64]) -> usize {
        self.seat[0] = saved[0];
        1
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
    fn pose(&self, _: &[f64], clearance: f64) -> RingPose {
        RingPose::seated(self.seat[0], clearance)
    }
    fn rates(&mut self, _: &[f64], _: &RingForces, _: &mut [f64]) -> Result<RingResponse, EvalError> {
        Ok(RingResponse::default())
    }
    fn decide(&mut self, forces: &AxialForces) -> bool {
        let before = self.seat[0];
        self.seat[0] = self.seat(forces);
        self.seat[0] != before
    }
}
