use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::geometry::{FlankOil, RingPlace};
use crate::states::Stateful;
use crate::{BuildError, EvalError, register_kind};

/// Configuration of a model of the oil between a ring and the flanks of its groove.
#[register_kind(
    name = "flank",
    summary = "oil between a ring and its groove flanks: the force it gives and the gap it leaves the gas"
)]
pub trait FlankSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model of one ring.
    ///
    /// # Errors
    /// Constants outside their range.
    fn build(&self, ctx: &FlankCtx) -> Result<Box<dyn Flank>, BuildError>;

    /// Whether the running model follows the volume of its oil.
    fn follows_oil(&self) -> bool {
        false
    }
}

/// What a [`FlankSpec`] is built for.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct FlankCtx {
    /// Zero-based number of the ring.
    pub ring: usize,
    /// Number of rings.
    pub rings: usize,
    /// Oil-filled fraction of the groove flanks, 0 to 1.
    pub oil_fill: f64,
    /// Radial width of the flank contact \[m\].
    pub width: f64,
    /// Viscosity of the oil in the groove \[Pa s\], at the temperature behind the ring.
    pub mu: f64,
    /// Crank speed \[rad/s\]; zero where there is no crank.
    pub omega: f64,
}

impl FlankCtx {
    /// Ring `ring` of `rings`, its oil-filled fraction, the radial width of its flanks \[m\] and the viscosity of the oil there \[Pa s\].
    #[must_use]
    pub const fn new(ring: usize, rings: usize, oil_fill: f64, width: f64, mu: f64) -> Self {
        Self { ring, rings, oil_fill, width, mu, omega: 0.0 }
    }

    /// Sets the crank speed \[rad/s\].
    #[must_use]
    pub const fn at_speed(mut self, omega: f64) -> Self {
        self.omega = omega;
        self
    }
}

/// What acts on the oil of the flanks at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct FlankIn<'a> {
    /// Where the ring is, with its velocity.
    pub place: &'a RingPlace,
    /// Absolute pressures above, behind and below the ring \[Pa\].
    pub pressure: [f64; 3],
}

impl<'a> FlankIn<'a> {
    /// A ring at a place between the pressures above, behind and below it \[Pa\].
    #[must_use]
    pub const fn new(place: &'a RingPlace, above: f64, behind: f64, below: f64) -> Self {
        Self { place, pressure: [above, behind, below] }
    }
}

/// Oil that came to the flanks of a ring and left them, per circumference: volumes \[m²\], or flows \[m²/s\].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FlankFlow {
    /// From groove, lands and wet walls onto the flanks.
    pub fed: f64,
    /// Blown out by gas, or given back to groove and lands.
    pub lost: f64,
}

/// A running model of the oil on the flanks of one ring.
///
/// A model with a finite volume of oil has it as states and says in [`Flank::oil`] how much of each gap the oil bridges: the ring feels that as a
/// force ([`FlankLaw`]), the gas as an opening that is closed. A model without states says nothing of the gas, which then passes a dry gap.
/// Rates are by crank angle \[1/rad\].
pub trait Flank: Stateful + Send {
    /// The force of the oil, for the motion of the ring.
    fn law(&self) -> Box<dyn FlankLaw>;

    /// Where the oil stands for the states `y` and a ring at `place`. Of that the pose and the clearance count: nobody asks again where only the film under the face has changed.
    fn oil(&self, _y: &[f64], _place: &RingPlace) -> FlankOil {
        FlankOil::default()
    }

    /// Rates `dy` of the states `y`, and the flows of oil per circumference \[m²/s\].
    ///
    /// # Errors
    /// States for which the model has no answer.
    fn rates(&mut self, _y: &[f64], _at: &FlankIn<'_>, _dy: &mut [f64]) -> Result<FlankFlow, EvalError> {
        Ok(FlankFlow::default())
    }

    /// Oil on both flanks per circumference \[m²\].
    fn volume(&self, _y: &[f64]) -> f64 {
        0.0
    }
}

/// The force of the oil on the flanks of one ring.
pub trait FlankLaw: Send {
    /// Force on the ring \[N\], towards the head positive, opposing `v`. `oil` where it stands, `s` height above the lower flank \[m\], `clearance`
    /// \[m\], `area` flank annulus \[m²\].
    fn force(&self, oil: &FlankOil, s: f64, v: f64, clearance: f64, area: f64) -> f64;

    /// The same for all velocities at a place, by coefficients: for those who look for a velocity. `None`: only [`FlankLaw::force`] knows.
    fn resistance(&self, _oil: &FlankOil, _s: f64, _clearance: f64, _area: f64) -> Option<FlankResistance> {
        None
    }

    /// The force \[N\], and how fast it falls with the velocity \[N s/m\]: 0 where only [`FlankLaw::force`] knows.
    fn force_and_damping(&self, oil: &FlankOil, s: f64, v: f64, clearance: f64, area: f64) -> (f64, f64) {
        match self.resistance(oil, s, clearance, area) {
            Some(films) => films.force_and_damping(v),
            None => (self.force(oil, s, v, clearance, area), 0.0),
        }
    }
}

/// Films on one flank that [`FlankResistance`] tells apart: of oil, and of the gas beside it.
pub const FLANK_FILMS: usize = 2;

/// A film between ring and flank at a given distance.
///
/// It resists an approach with the velocity `v` by `a v`, and a separation by `X/(1 + X/t)`, `X = d v`. An infinite tension `t` is no limit; where it
/// is zero or less the film resists a separation as it does an approach.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FlankFilm {
    /// Damping `a` of an approach \[N s/m\].
    pub approach: f64,
    /// Damping `d` of a slow separation \[N s/m\].
    pub apart: f64,
    /// Greatest force `t` that the film bears while it is drawn apart \[N\].
    pub tension: f64,
}

impl FlankFilm {
    /// Resistance to a separation with a speed \[m/s\], and its first two derivatives by that.
    #[inline]
    fn drawn(&self, speed: f64) -> [f64; 3] {
        if self.tension <= 0.0 {
            return [self.approach * speed, self.approach, 0.0];
        }
        if self.tension == f64::INFINITY {
            return [self.apart * speed, self.apart, 0.0];
        }
        let per = 1.0 / (self.tension + self.apart * speed);
        let slack = self.tension * per;
        let slope = self.apart * slack * slack;
        [self.apart * speed * slack, slope, -2.0 * slope * self.apart * per]
    }
}

/// What resists the motion of a ring in its groove, at a place and for all velocities: the films on the lower and on the upper flank.
///
/// Those on the flank that the ring goes to are squeezed, those on the one it leaves are drawn apart:
///
/// `F(v) = -sgn(v) [Σ a_i |v| + Σ d_i |v|/(1 + d_i |v|/t_i)]`
///
/// In each direction `|F|` grows with the speed and bends down, for coefficients that are not negative.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FlankResistance {
    /// Films on the lower flank.
    pub lower: [FlankFilm; FLANK_FILMS],
    /// Films on the upper flank.
    pub upper: [FlankFilm; FLANK_FILMS],
}

impl FlankResistance {
    /// One that is proportional to the velocity, with a damping \[N s/m\].
    #[must_use]
    pub fn linear(damping: f64) -> Self {
        // All of it by the film that is squeezed.
        let film = FlankFilm { approach: damping, apart: 0.0, tension: f64::INFINITY };
        let films = [film, FlankFilm::default()];
        Self { lower: films, upper: films }
    }

    /// Force on the ring \[N\] at a velocity \[m/s\], towards the head positive.
    #[must_use]
    #[inline]
    pub fn force(&self, v: f64) -> f64 {
        self.force_and_damping(v).0
    }

    /// Force on the ring \[N\] at a velocity \[m/s\], and how fast it falls with that \[N s/m\].
    #[must_use]
    #[inline]
    pub fn force_and_damping(&self, v: f64) -> (f64, f64) {
        let [resistance, damping, _] = self.at(v);
        (if v.is_sign_negative() { resistance } else { -resistance }, damping)
    }

    /// Resistance at a velocity \[m/s\]: the force against it \[N\], and the first \[N s/m\] and second \[N s²/m²\] derivative of that by the speed `|v|`. The
    /// sign of a zero tells the direction.
    #[must_use]
    #[inline]
    pub fn at(&self, v: f64) -> [f64; 3] {
        let speed = v.abs();
        let (ahead, behind) =
            if v.is_sign_negative() { (&self.lower, &self.upper) } else { (&self.upper, &self.lower) };
        let linear = ahead[0].approach + ahead[1].approach;
        let [a, b] = [behind[0].drawn(speed), behind[1].drawn(speed)];
        [linear * speed + a[0] + b[0], linear + a[1] + b[1], a[2] + b[2]]
    }
}
