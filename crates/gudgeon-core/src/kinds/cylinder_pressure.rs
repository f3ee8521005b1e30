use std::fmt::Debug;

use dyn_clone::DynClone;

use super::Kinematics;
use crate::file::Files;
use crate::result::Note;
use crate::{BuildError, register_kind};

/// What a [`CylinderPressureSpec`] is built for.
#[derive(Debug, Clone, Copy)]
pub struct CylinderPressureCtx<'a> {
    /// Piston motion; cylinder volume is `piston_area * (y_tdc - y) + clearance volume`.
    pub kinematics: &'a (dyn Kinematics + 'static),
    /// Piston area \[m²\].
    pub piston_area: f64,
    /// The files that the case names.
    pub files: &'a Files,
}

/// Configuration of a cylinder-pressure model.
#[register_kind(name = "cylinder_pressure", summary = "gas pressure in the cylinder over the cycle")]
pub trait CylinderPressureSpec: Debug + DynClone + Send + Sync {
    /// Checks the numbers and builds the running model.
    ///
    /// # Errors
    /// Tables that are not monotone or not positive, files that cannot be read, a compression ratio that cannot be.
    fn build(&self, ctx: &CylinderPressureCtx<'_>) -> Result<Box<dyn CylinderPressure>, BuildError>;
}

/// A running cylinder-pressure model.
pub trait CylinderPressure: Debug + DynClone + Send + Sync {
    /// Absolute pressure \[Pa\] at crank angle `theta` \[rad\], any real number.
    fn pressure(&self, theta: f64) -> f64;
    /// Pressure at `theta` of a model that goes by fixed crank angles, with the choice between these made at the angle
    /// `decided_at`. A published program evaluates its stages that way; other models have nothing to decide.
    fn pressure_decided_at(&self, decided_at: f64, theta: f64) -> f64 {
        let _ = decided_at;
        self.pressure(theta)
    }
    /// The same where the height \[m\] of the pin at `theta` is known already: that of the kinematics that the model was built with.
    fn pressure_at_height(&self, decided_at: f64, theta: f64, height: f64) -> f64 {
        let _ = height;
        self.pressure_decided_at(decided_at, theta)
    }
    /// Crank angles in `[0, period)` \[rad\], ascending, where the pressure or its slope jumps, and the tops of pulses so narrow that a
    /// step could pass over them: an integrator restarts there.
    fn kinks(&self) -> &[f64];
    /// Length of the cycle \[rad\]: 4π for four strokes.
    fn period(&self) -> f64;
    /// Crank angle \[rad\] in `[0, period]` of the highest pressure, and that pressure \[Pa\]. A model that knows it says so; this looks every
    /// quarter of a degree and on both sides of every kink, then between the neighbours of the highest value.
    fn highest(&self) -> (f64, f64) {
        highest_on_grid(self, 0.25_f64.to_radians())
    }
    /// Whether it is another one at another speed of the crank.
    fn depends_on_speed(&self) -> bool {
        true
    }
    /// What a person should know about how the pressure came about: a filter that acted, with how much.
    fn notes(&self) -> Vec<Note> {
        Vec::new()
    }
}
dyn_clone::clone_trait_object!(CylinderPressure);

/// [`CylinderPressure::highest`] of a model that knows of its highest pressure no more than that it is alone between two points `spacing` \[rad\] beside it: looks at points that far apart
/// and on both sides of every kink, then between the neighbours of the highest value.
pub fn highest_on_grid<P: CylinderPressure + ?Sized>(model: &P, spacing: f64) -> (f64, f64) {
    /// Steps of golden section: from two degrees to the rounding of the angle of a smooth top, some 1e-8.
    const STEPS: u32 = 40;
    const RATIO: f64 = 0.618_033_988_749_894_8;
    let parts = (model.period() / spacing).round().max(1.0);
    let width = model.period() / parts;
    let at = |theta: f64| (theta, model.pressure(theta));
    let greater = |a: (f64, f64), b: (f64, f64)| if b.1 > a.1 { b } else { a };
    let grid = (0..parts as usize).map(|k| at(k as f64 * width));
    // The resolution of an angle near the end of the cycle, twice over, to the left of a kink.
    let kinks = model.kinks().iter().flat_map(|k| [at(*k), at(k - 2.0 * f64::EPSILON * model.period())]);
    let best = grid.chain(kinks).reduce(greater).unwrap_or_else(|| at(0.0));
    let (mut a, mut b) = (best.0 - width, best.0 + width);
    let (mut c, mut d) = (at(b - RATIO * (b - a)), at(a + RATIO * (b - a)));
    for _ in 0..STEPS {
        if c.1 > d.1 {
            (b, d) = (d.0, c);
            c = at(b - RATIO * (b - a));
        } else {
            (a, c) = (c.0, d);
            d = at(a + RATIO * (b - a));
        }
    }
    let (theta, p) = greater(best, greater(c, d));
    (theta.rem_euclid(model.period()), p)
}
