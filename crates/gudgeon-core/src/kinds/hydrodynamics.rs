use std::fmt::Debug;

use dyn_clone::DynClone;

use super::{Rheology, RheologyScope};
use crate::geometry::FaceProfile;
use crate::{BuildError, EvalError, register_kind};

/// What a [`HydrodynamicsSpec`] is built for: one running face of one ring.
#[derive(Debug, Clone, Copy)]
pub struct FaceCtx<'a> {
    /// Shape of the face.
    pub face: &'a FaceProfile,
}

/// Configuration of a ring-face film model.
#[register_kind(name = "hydrodynamics", summary = "oil film between a ring face and the liner")]
pub trait HydrodynamicsSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model of one face.
    ///
    /// # Errors
    /// A face shape that the model cannot represent.
    fn build(&self, ctx: &FaceCtx<'_>) -> Result<Box<dyn Hydrodynamics>, BuildError>;

    /// What the film can have besides a constant viscosity between smooth walls.
    fn scope(&self) -> RheologyScope {
        RheologyScope::default()
    }

    /// Builds the running model of one face with oil and surfaces that are more than that.
    ///
    /// # Errors
    /// As [`HydrodynamicsSpec::build`]; anything that is not in its [`HydrodynamicsSpec::scope`].
    fn build_with(
        &self,
        ctx: &FaceCtx<'_>,
        rheology: &Rheology,
    ) -> Result<Box<dyn Hydrodynamics>, BuildError> {
        match rheology.beyond(self.scope()) {
            None => self.build(ctx),
            Some(kind) => Err(BuildError::new(format!("this film has no `{kind}`"))),
        }
    }
}

/// One film at an instant, in the frame of the ring, `x` from the bottom edge to the top edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FaceIn {
    /// Film thickness at zero drop \[m\]: `h(x) = h + drop(x)`. Between rough surfaces the mean gap there.
    pub h: f64,
    /// Velocity of the liner along `+x` seen from the ring \[m/s\]: minus the piston velocity.
    pub u: f64,
    /// Absolute pressure at the bottom edge \[Pa\].
    pub p_bottom: f64,
    /// Absolute pressure at the top edge \[Pa\].
    pub p_top: f64,
    /// Absolute pressure below which the film cavitates \[Pa\].
    pub p_cav: f64,
    /// Dynamic viscosity \[Pa s\].
    pub mu: f64,
}

/// What a film does, per metre of circumference.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FaceOut {
    /// `∫ (p - p_cav) dx` \[N/m\].
    pub load: f64,
    /// Squeeze damping `-∂load/∂ḣ` \[N s/m²\], never negative.
    pub squeeze_damping: f64,
    /// Viscous force on the **ring** along `+x`, `∫ (μu/h - h p'/2) dx` \[N/m\].
    pub ring_shear: f64,
    /// Viscous force on the **liner** along `-x`, `∫ (μu/h + h p'/2) dx` \[N/m\]: what a liner load cell feels, and what the
    /// crank pays for but for the end term `[p h]`.
    pub liner_shear: f64,
    /// Pressure force on the sloping ring face along `+x`, `-∫ p h' dx` \[N/m\], with `p` above `p_cav`.
    pub slope_force: f64,
    /// See [`FaceForces::flux`].
    pub flux: f64,
    /// Highest absolute pressure \[Pa\].
    pub p_max: f64,
    /// Extent of the full film: `x` of its lower and upper end \[m\].
    pub full_film: (f64, f64),
}

/// The part of [`FaceOut`] that the motion of a ring depends on.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FaceForces {
    /// See [`FaceOut::load`].
    pub load: f64,
    /// See [`FaceOut::squeeze_damping`].
    pub squeeze_damping: f64,
    /// See [`FaceOut::ring_shear`].
    pub ring_shear: f64,
    /// See [`FaceOut::liner_shear`].
    pub liner_shear: f64,
    /// See [`FaceOut::slope_force`].
    pub slope_force: f64,
    /// Flux of oil along `+x` at the lower end of the film, seen from the ring, per metre of circumference \[m²/s\]; zero from a
    /// model that does not know its flux.
    pub flux: f64,
}

impl FaceOut {
    /// Load and friction alone.
    #[must_use]
    pub const fn forces(&self) -> FaceForces {
        FaceForces {
            load: self.load,
            squeeze_damping: self.squeeze_damping,
            ring_shear: self.ring_shear,
            liner_shear: self.liner_shear,
            slope_force: self.slope_force,
            flux: self.flux,
        }
    }
}

/// A running ring-face film.
///
/// [`Hydrodynamics::forces`], [`Hydrodynamics::load`] and [`Hydrodynamics::carry`] say nothing that
/// [`Hydrodynamics::evaluate`] and [`Hydrodynamics::squeeze_rate`] do not; a model overrides them where less is less work.
/// A model may start its search from the film it found last, but what it finds must not depend on that by more than
/// rounding: integrators difference it.
pub trait Hydrodynamics: Send {
    /// Load and friction for a given squeeze velocity `hdot = ∂h/∂t` \[m/s\].
    ///
    /// # Errors
    /// No solution for these inputs (Recoverable), or inputs that are not numbers (Fatal).
    fn evaluate(&mut self, inp: &FaceIn, hdot: f64) -> Result<FaceOut, EvalError>;

    /// The squeeze velocity \[m/s\] at which the film carries `load` \[N/m\] (measured above `p_cav`, as in
    /// [`FaceOut::load`]). Load falls monotonically with `hdot`; the default brackets and then runs a safeguarded Newton.
    ///
    /// # Errors
    /// As [`Hydrodynamics::evaluate`], or no convergence.
    fn squeeze_rate(&mut self, inp: &FaceIn, load: f64) -> Result<f64, EvalError>;

    /// Whether there is a film at all, one that resists being squeezed.
    fn resists(&self) -> bool {
        true
    }

    /// Confines the film to the face between `from` and `to` \[m\]: beyond, the face is dry and the pressure of the edge reaches
    /// to the end of the film. Until the next call everything else speaks of that part alone, in coordinates of the whole face.
    /// Whether the model can do that; one that cannot stays as it was.
    fn set_extent(&mut self, _from: f64, _to: f64) -> bool {
        false
    }

    /// Tilts the face by an angle \[rad\], positive when its top edge comes closer to the liner, about its narrowest place: `h` stays the film thickness
    /// at the narrowest place, which moves. Until the next call everything else speaks of that face. Whether the model can do that; one that cannot
    /// stays as it was.
    fn set_tilt(&mut self, tilt: f64) -> bool {
        tilt == 0.0
    }

    /// [`Hydrodynamics::evaluate`] without pressures and extent.
    ///
    /// # Errors
    /// As [`Hydrodynamics::evaluate`].
    fn forces(&mut self, inp: &FaceIn, hdot: f64) -> Result<FaceForces, EvalError> {
        Ok(self.evaluate(inp, hdot)?.forces())
    }

    /// [`FaceOut::load`] \[N/m\] and [`FaceOut::squeeze_damping`] \[N s/m²\] alone.
    ///
    /// # Errors
    /// As [`Hydrodynamics::evaluate`].
    fn load(&mut self, inp: &FaceIn, hdot: f64) -> Result<(f64, f64), EvalError> {
        let o = self.forces(inp, hdot)?;
        Ok((o.load, o.squeeze_damping))
    }

    /// [`Hydrodynamics::squeeze_rate`] and [`Hydrodynamics::forces`] there, in one call: a model that has the film in hand
    /// after finding the velocity need not solve it again.
    ///
    /// # Errors
    /// As those two.
    fn carry(&mut self, inp: &FaceIn, load: f64) -> Result<(f64, FaceForces), EvalError> {
        let hdot = self.squeeze_rate(inp, load)?;
        Ok((hdot, self.forces(inp, hdot)?))
    }

    /// Film thickness and absolute pressure along the face, for plots: `out[i] = (x, h, p)` at `out.len()` equal spacings.
    ///
    /// # Errors
    /// As [`Hydrodynamics::evaluate`].
    fn profile(&mut self, inp: &FaceIn, hdot: f64, out: &mut [(f64, f64, f64)]) -> Result<(), EvalError>;
}
