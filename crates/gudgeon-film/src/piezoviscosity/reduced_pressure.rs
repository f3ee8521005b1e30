//! The reduced pressure of an oil that thickens with pressure.

use std::sync::Arc;

use gudgeon_core::EvalError;
use gudgeon_core::kinds::Piezoviscosity;
use gudgeon_numerics::elementary;

/// `Π(p) = ∫_0^p dp/f(p)`, `f = μ(p)/μ(0)`: with it Reynolds' equation of an oil that thickens with pressure is that of a constant viscosity.
///
/// Between the points of a ladder of pressures `ln f` is taken as straight, which is exact for Barus' law. The first steps have 1 MPa, each further one 3 %
/// more, so that `f` of Roelands' law is met within 5e-5 up to 100 MPa. Below ambient pressure `f = 1`.
#[derive(Debug)]
pub struct ReducedPressure {
    law: Arc<dyn Piezoviscosity>,
    /// Viscosity for which the ladder stands \[Pa s\].
    mu0: f64,
    /// Pressures \[Pa\], and what belongs to them: `ln f` and `Π`.
    pressure: Vec<f64>,
    log: Vec<f64>,
    reduced: Vec<f64>,
}

/// First step of the ladder \[Pa\], growth from step to step, and steps: to 3.7 GPa.
const LADDER: (f64, f64, usize) = (1e6, 1.03, 160);
/// Steps that are added at a time.
const CHUNK: usize = 20;
/// Logarithm of the thickening at which the ladder ends.
const THICKEST: f64 = 6.907_755_278_982_137;

impl ReducedPressure {
    /// Of a law.
    pub fn new(law: Arc<dyn Piezoviscosity>) -> Self {
        let (pressure, log, reduced) = (vec![0.0], vec![0.0], vec![0.0]);
        Self { law, mu0: f64::NAN, pressure, log, reduced }
    }

    /// Sets the viscosity at ambient pressure \[Pa s\].
    pub fn set(&mut self, mu0: f64) {
        if mu0 != self.mu0 {
            self.mu0 = mu0;
            self.pressure.truncate(1);
            self.log.truncate(1);
            self.reduced.truncate(1);
        }
    }

    /// Adds steps to the ladder; whether there were any left.
    fn extend(&mut self) -> Result<bool, EvalError> {
        let (first, growth, steps) = LADDER;
        let from = self.pressure.len();
        let to = (from + CHUNK).min(steps + 1);
        if from == to || self.log[from - 1] >= THICKEST {
            return Ok(false);
        }
        let mut new = [0.0; CHUNK];
        for (p, k) in new.iter_mut().zip(from..to) {
            *p = first * (growth.powi(k as i32) - 1.0) / (growth - 1.0);
        }
        let (mut factor, mut slope) = ([1.0; CHUNK], [0.0; CHUNK]);
        let n = to - from;
        self.law.factor(self.mu0, &new[..n], &mut factor[..n], &mut slope[..n])?;
        for (&p, f) in new[..n].iter().zip(factor) {
            let k = self.pressure.len() - 1;
            if self.log[k] >= THICKEST {
                break;
            }
            let (step, log) = (p - self.pressure[k], elementary::ln(f));
            let reduced =
                self.reduced[k] + step * elementary::exp(-self.log[k]) * mean_decay(log - self.log[k]);
            self.pressure.push(p);
            self.log.push(log);
            self.reduced.push(reduced);
        }
        Ok(true)
    }

    /// The last rung: pressure, reduced pressure and thickening, with which it goes on.
    fn top(&self) -> (f64, f64, f64) {
        let k = self.pressure.len() - 1;
        (self.pressure[k], self.reduced[k], elementary::exp(self.log[k]))
    }

    /// `Π` \[Pa\] of a pressure above ambient \[Pa\].
    ///
    /// # Errors
    /// What the law refuses.
    pub fn of(&mut self, pressure: f64) -> Result<f64, EvalError> {
        if pressure <= 0.0 {
            return Ok(pressure);
        }
        while self.top().0 < pressure {
            if !self.extend()? {
                let (p, reduced, f) = self.top();
                return Ok(reduced + (pressure - p) / f);
            }
        }
        let k = self.pressure.partition_point(|p| *p < pressure) - 1;
        let (step, rise) = (self.pressure[k + 1] - self.pressure[k], self.log[k + 1] - self.log[k]);
        let along = pressure - self.pressure[k];
        Ok(self.reduced[k] + along * elementary::exp(-self.log[k]) * mean_decay(rise * along / step))
    }

    /// Pressure above ambient \[Pa\] and `f` there, for a reduced pressure \[Pa\].
    ///
    /// # Errors
    /// What the law refuses.
    pub fn back(&mut self, reduced: f64) -> Result<(f64, f64), EvalError> {
        if reduced <= 0.0 {
            return Ok((reduced, 1.0));
        }
        while self.top().1 < reduced {
            if !self.extend()? {
                let (p, last, f) = self.top();
                return Ok((p + f * (reduced - last), f));
            }
        }
        let k = self.reduced.partition_point(|r| *r < reduced) - 1;
        let (step, rise) = (self.pressure[k + 1] - self.pressure[k], self.log[k + 1] - self.log[k]);
        // (1 - exp(-b t))/b = y with b = rise/step: t = -ln(1 - b y)/b.
        let y = (reduced - self.reduced[k]) * elementary::exp(self.log[k]);
        let b = rise / step;
        let along =
            if (b * y).abs() < 1e-6 { y * (1.0 + 0.5 * b * y) } else { -elementary::ln_1p(-b * y) / b };
        Ok((self.pressure[k] + along, elementary::exp(self.log[k] + b * along)))
    }
}

/// `(1 - exp(-x))/x`.
fn mean_decay(x: f64) -> f64 {
    if x.abs() < 1e-5 { 1.0 - 0.5 * x } else { -elementary::exp_m1(-x) / x }
}
