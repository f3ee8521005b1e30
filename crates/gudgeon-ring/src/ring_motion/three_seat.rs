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

#[cfg(test)]
mod tests {
    use super::*;
    use gudgeon_core::kinds::{FlankDampingCtx, FlankDampingSpec};

    fn built(spec: &ThreeSeat) -> Box<dyn RingMotion> {
        let oil = FlankDampingCtx { ring: 0, rings: 1, oil_fill: 0.6, width: 5e-3, mu: 0.01 };
        let damping = crate::DampingOff {}.build(&oil).expect("builds");
        spec.build(RingMotionCtx::new(0, 7e-3, 3e-5, 200.0, damping)).expect("builds")
    }

    /// Where the ring sits after a decision with these forces.
    fn seat(m: &mut dyn RingMotion, forces: &AxialForces) -> f64 {
        let before = m.decided()[0];
        assert_eq!(m.decide(forces), m.decided()[0] != before);
        let pose = m.pose(&[], 3e-5);
        assert_eq!((pose.lift_fraction, pose.s), (m.decided()[0], m.decided()[0] * 3e-5));
        pose.lift_fraction
    }

    #[test]
    fn the_three_seats() {
        let mut m = built(&ThreeSeat::default());
        let mut at =
            |gas, inertia, film| seat(&mut *m, &AxialForces { gas, inertia, film, ..AxialForces::default() });
        assert_eq!(at(-100.0, 50.0, 0.0), 0.0);
        assert_eq!(at(-100.0, 150.0, 0.0), 1.0);
        assert_eq!(at(-100.0, 95.0, 0.0), 0.5);
        assert_eq!(at(-100.0, 105.0, 0.0), 0.5);
        assert_eq!(at(-100.0, 95.0, -20.0), 0.0);
        assert_eq!(at(-100.0, 90.0, 0.0), 0.5, "the edge of the band belongs to it");
        assert_eq!(at(0.0, 0.0, 0.0), 0.5, "no force at all");
        assert_eq!(m.decision_interval(), Some(std::f64::consts::PI / 180.0));
    }

    #[test]
    fn counts_only_what_it_is_told_to() {
        let spec = ThreeSeat { gravity: false, film_force: false, ..ThreeSeat::default() };
        let mut m = built(&spec);
        let f = AxialForces { gas: -10.0, film: 1e3, gravity: 1e3, damping: 1e3, ..AxialForces::default() };
        assert_eq!(seat(&mut *m, &f), 0.0);
        assert!(!m.uses_film_force() && !m.uses_gravity());
    }
}
