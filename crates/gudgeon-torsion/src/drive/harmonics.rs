use gudgeon_core::kinds::{Drive, DriveSpec, DriveTorque, OrderTorque};
use gudgeon_core::quantity::{Angle, Ratio, Torque, quantity};
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::elementary;
use serde::{Deserialize, Serialize};

/// A torque given by its harmonics over the angle of its inertia: harmonic tables of engine makers, propeller blades, torque ripple.
///
/// `T = mean + Σ amplitude cos(order θ - phase)`. The phase of the whole (a firing angle φ) is that of the place where it stands: it
/// turns order n by nφ.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Harmonics {
    /// Mean torque.
    #[serde(default = "none")]
    pub mean: Torque,
    /// The harmonics.
    pub orders: Vec<Harmonic>,
}

/// One harmonic.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Harmonic {
    /// Cycles per turn, a multiple of a half.
    pub order: f64,
    /// Amplitude.
    pub amplitude: Torque,
    /// Angle of its own turn by which it lags behind a cosine.
    #[serde(default = "zero")]
    pub phase: Angle,
    /// Factor on the amplitude.
    #[serde(default = "one")]
    pub factor: Ratio,
}

fn none() -> Torque {
    quantity(0.0)
}
fn zero() -> Angle {
    quantity(0.0)
}
fn one() -> Ratio {
    quantity(1.0)
}

#[register_model(
    name = "harmonics",
    summary = "torque by its harmonics over the angle",
    equations = "T = T_0 + sum_n A_n cos(n theta - phi_n)",
    validity = "Orders are multiples of a half.",
    references = ["den_hartog1956"],
    example = "mean = \"100 N m\"\norders = [{ order = 3, amplitude = \"160 N m\" }, { order = 4.5, amplitude = \"90 N m\", phase = \"30 deg\" }]\n",
)]
impl DriveSpec for Harmonics {
    fn build(&self) -> Result<Box<dyn Drive>, BuildError> {
        let mut orders = Vec::new();
        for (i, h) in self.orders.iter().enumerate() {
            let half = (2.0 * h.order).round();
            if !(h.order.is_finite() && half > 0.0 && (2.0 * h.order - half).abs() < 1e-12 && half < 2e4) {
                let what = format!("an order of {} cannot be, it must be a multiple of a half", h.order);
                return Err(BuildError::at(format!("orders.{i}.order"), what));
            }
            let a = h.amplitude.si() * h.factor.si();
            let (sin, cos) = elementary::sin_cos(h.phase.si());
            orders.push(OrderTorque { order: 0.5 * half, cosine: a * cos, sine: a * sin });
        }
        Ok(Box::new(Series { mean: self.mean.si(), orders }))
    }
}

#[derive(Debug, Clone)]
struct Series {
    mean: f64,
    orders: Vec<OrderTorque>,
}

impl Drive for Series {
    fn torque(&self, theta: f64, _: f64) -> DriveTorque {
        let term = |o: &OrderTorque| {
            let (sin, cos) = elementary::sin_cos(o.order * theta);
            o.cosine * cos + o.sine * sin
        };
        DriveTorque { torque: self.mean + self.orders.iter().map(term).sum::<f64>(), slope: 0.0 }
    }
    fn orders(&self) -> &[OrderTorque] {
        &self.orders
    }
    fn is_linear(&self) -> bool {
        self.orders.is_empty()
    }
}
