//! What several topics share.

use gudgeon_core::quantity::quantity;
use gudgeon_gas::{Orifice, OrificeFormula, OrificeLaw};

/// Gas constant of air \[J/(kg K)\].
pub const R: f64 = 287.0;

/// Deterministic numbers in 0…1 (Knuth's MMIX generator, upper bits).
pub struct Lcg(pub u64);

impl Lcg {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn between(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.next()
    }

    /// Evenly in its logarithm.
    pub fn log_between(&mut self, a: f64, b: f64) -> f64 {
        a * (b / a).powf(self.next())
    }
}

pub fn law(formula: OrificeFormula, discharge: f64, eps: f64, gamma: f64) -> OrificeLaw {
    Orifice { discharge: quantity(discharge), law: formula, laminar: quantity(eps), ..Orifice::default() }
        .build(gamma, R)
        .expect("builds")
}

pub fn isentropic(eps: f64) -> OrificeLaw {
    law(OrificeFormula::Isentropic, 1.0, eps, 1.4)
}

/// One classical Runge-Kutta step.
pub fn rk4(y: &mut [f64], t: f64, dt: f64, mut f: impl FnMut(f64, &[f64], &mut [f64])) {
    let n = y.len();
    let (mut k, mut z, mut sum) = (vec![0.0; n], y.to_vec(), vec![0.0; n]);
    for (stage, weight) in [(0.0, 1.0), (0.5, 2.0), (0.5, 2.0), (1.0, 1.0)] {
        for i in 0..n {
            z[i] = y[i] + stage * dt * k[i];
        }
        f(t + stage * dt, &z, &mut k);
        for i in 0..n {
            sum[i] += weight * k[i];
        }
    }
    for i in 0..n {
        y[i] += dt / 6.0 * sum[i];
    }
}
