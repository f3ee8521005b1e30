use gudgeon_core::kinds::{PinForces, PinInstant, PinLoadCase, PinLoadCtx, PinLoadSpec};
use gudgeon_core::quantity::{
    Fraction, Mass, NonNegative, PosAngularSpeed, PosLength, PosPressure, PosRatio, Ratio, quantity,
};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// Peak pressure from the compression ratio, with the inertia of the piston at the dead centre (`reimer1984`).
///
/// The peak is taken to act at the dead centre, at the speed of greatest torque, where inertia relieves the pin least.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PeakPressureRule {
    /// Coefficient K of the fuel: 7.9 for alcohol; for others 1.1 times the measured peak pressure in atmospheres over the compression ratio.
    #[serde(default = "alcohol")]
    pub fuel_coefficient: PosRatio,
    /// Compression ratio.
    pub compression_ratio: PosRatio,
    /// Peak pressure for a coefficient and a compression ratio of one: an atmosphere over 1.1, as the source rounds it.
    #[serde(default = "unit_pressure")]
    pub unit_pressure: PosPressure,
    /// Crankshaft speed, usually that of greatest torque.
    pub speed: PosAngularSpeed,
    /// Twice the crank radius.
    pub stroke: PosLength,
    /// Connecting-rod length between centres.
    pub rod_length: PosLength,
    /// Mass of the piston.
    pub piston_mass: Mass<NonNegative>,
    /// Part of the piston's mass whose inertia relieves the pin.
    #[serde(default = "part")]
    pub inertia_factor: Ratio<Fraction>,
    /// Acceleration of gravity \[m/s²\] by which a program that counts forces in kgf divides weights.
    #[serde(default = "gravity")]
    pub gravity: PosRatio,
}

fn alcohol() -> PosRatio {
    quantity(7.9)
}
fn unit_pressure() -> PosPressure {
    quantity(9.391e-3 * KGF_PER_MM2)
}
fn part() -> Ratio<Fraction> {
    quantity(0.7)
}
fn gravity() -> PosRatio {
    quantity(STANDARD_GRAVITY)
}

/// \[Pa\].
const KGF_PER_MM2: f64 = 9_806_650.0;
/// \[m/s²\].
const STANDARD_GRAVITY: f64 = 9.80665;

#[register_model(
    name = "peak_pressure_rule",
    summary = "peak pressure from the compression ratio, inertia at the dead centre",
    equations = "p_max = K r_c p_1, p_1 = 9.391e-3 kgf/mm2;  F_gas = p_max pi D^2/4;  F_in = -k m omega^2 (S/2) (1 + lambda) 9.80665/g, lambda = S/(2 l)",
    validity = "A first estimate: K is known for alcohol engines only (7.9). Pressure over that of the crankcase.",
    references = ["reimer1984"],
    example = "compression_ratio = 12\nspeed = \"2700 rpm\"\nstroke = \"79.3 mm\"\nrod_length = \"138.5 mm\"\npiston_mass = \"335 g\"\n",
)]
impl PinLoadSpec for PeakPressureRule {
    fn build(&self, ctx: &PinLoadCtx<'_>) -> Result<PinLoadCase, BuildError> {
        if self.compression_ratio.si() <= 1.0 {
            let what = format!("a compression ratio of {} cannot be", self.compression_ratio.si());
            return Err(BuildError::at("compression_ratio", what));
        }
        let radius = 0.5 * self.stroke.si();
        if self.rod_length.si() <= radius {
            let what = "the rod must be longer than the crank radius, half the stroke";
            return Err(BuildError::at("rod_length", what));
        }
        let pressure = self.fuel_coefficient.si() * self.compression_ratio.si() * self.unit_pressure.si();
        // A published program computes the speed with its own pi, from revolutions.
        let omega = self.speed.si() * (ctx.pi / std::f64::consts::PI);
        let ratio = radius / self.rod_length.si();
        let forces = PinForces {
            gas: pressure * ctx.pi * ctx.bore * ctx.bore / 4.0,
            inertia: -self.inertia_factor.si()
                * self.piston_mass.si()
                * (STANDARD_GRAVITY / self.gravity.si())
                * omega
                * omega
                * radius
                * (1.0 + ratio),
        };
        let total = forces.total();
        if !total.is_finite() {
            return Err(BuildError::new(format!("the force on the pin is {total} N")));
        }
        if total <= 0.0 {
            let what = format!(
                "at this speed inertia ({:.3} kN) exceeds the gas force ({:.3} kN): the rule does not hold",
                1e-3 * forces.inertia,
                1e-3 * forces.gas
            );
            return Err(BuildError::at("speed", what).help("size the pin over a cycle: model `cycle`"));
        }
        Ok(PinLoadCase {
            design: PinInstant { theta: 2.0 * std::f64::consts::PI, pressure, forces },
            omega: Some(omega),
            crank_ratio: Some(ratio),
            ..PinLoadCase::default()
        })
    }
}
