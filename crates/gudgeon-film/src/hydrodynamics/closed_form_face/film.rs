//! The running model: a face in both sliding directions.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{FaceForces, FaceIn, FaceOut, Hydrodynamics};

use super::cavity_shear::CavityShear;
use super::errors::{MODEL, finite};
use super::flow::Flow;
use super::shape::Shape;
use super::side::Side;
use crate::cavitation::Cavitation;

#[derive(Debug)]
pub(super) struct Film<S> {
    up: Side<S>,
    down: Side<S>,
    /// Length of the whole face, and where its film begins.
    whole: f64,
    from: f64,
    cavitation: Cavitation,
    shear: CavityShear,
}

impl<S: Shape> Film<S> {
    pub fn new(up: S, down: S, cavitation: Cavitation, shear: CavityShear) -> Self {
        let whole = up.length();
        Self { up: Side::new(up), down: Side::new(down), whole, from: 0.0, cavitation, shear }
    }

    /// Checks the inputs and turns them so that the liner moves along `+x`.
    fn enter(&mut self, inp: &FaceIn, v: f64) -> Result<(&mut Side<S>, Flow, bool), EvalError> {
        // One test for all: what is not finite leaves no finite sum.
        let sum = inp.h + inp.u + inp.p_bottom + inp.p_top + inp.p_cav + inp.mu + v;
        if !sum.is_finite() || inp.mu <= 0.0 {
            return Err(EvalError::fatal(
                MODEL,
                format!(
                    "these are no film: thickness {} m, sliding {} m/s, squeeze or load {v}, edges {} and {} Pa, viscosity {} Pa s",
                    inp.h, inp.u, inp.p_bottom, inp.p_top, inp.mu
                ),
            ));
        }
        let turned = inp.u < 0.0;
        let side = if turned { &mut self.down } else { &mut self.up };
        if inp.h + side.face.lowest() <= 0.0 {
            return Err(EvalError::recoverable(
                MODEL,
                format!("film of {} m leaves no gap at the nearest point", inp.h),
            ));
        }
        side.set_film(inp.h);
        let floor = if self.cavitation == Cavitation::FullSommerfeld { f64::NEG_INFINITY } else { 0.0 };
        let scale = 1.0 / (12.0 * inp.mu);
        let bottom = (inp.p_bottom - inp.p_cav).max(floor) * scale;
        let top = (inp.p_top - inp.p_cav).max(floor) * scale;
        let (pa, pb) = if turned { (top, bottom) } else { (bottom, top) };
        Ok((side, Flow { u: 0.5 * inp.u.abs(), v, pa, pb }, turned))
    }
}

/// Forces in the frame of the ring, when they are numbers.
fn checked<S: Shape>(
    mut o: FaceForces,
    turned: bool,
    side: &Side<S>,
    f: &Flow,
) -> Result<FaceForces, EvalError> {
    if turned {
        // The lower end is the trailing one then; the flux changes along the film with what it squeezes out.
        o.flux = f.v * side.face.length() - o.flux;
        o.ring_shear = -o.ring_shear;
        o.liner_shear = -o.liner_shear;
        o.slope_force = -o.slope_force;
    }
    finite(o.load + o.squeeze_damping + o.ring_shear + o.liner_shear + o.slope_force + o.flux, "film")?;
    Ok(o)
}

impl<S: Shape> Hydrodynamics for Film<S> {
    fn set_extent(&mut self, from: f64, to: f64) -> bool {
        if !(from >= 0.0 && to <= self.whole && from < to) {
            return false;
        }
        self.up.set_extent(from, to);
        self.down.set_extent(self.whole - to, self.whole - from);
        self.from = from;
        true
    }

    fn set_tilt(&mut self, tilt: f64) -> bool {
        // The mirrored face tilts the other way.
        self.up.tilt(tilt) && self.down.tilt(-tilt)
    }

    fn evaluate(&mut self, inp: &FaceIn, hdot: f64) -> Result<FaceOut, EvalError> {
        let (cavitation, shear, from) = (self.cavitation, self.shear, self.from);
        let (side, mut f, turned) = self.enter(inp, hdot)?;
        side.solve(&mut f, cavitation)?;
        let o = checked(side.forces(&f, cavitation, shear, inp.mu), turned, side, &f)?;
        let (high, (a, b)) = side.peak(&f);
        let len = side.face.length();
        Ok(FaceOut {
            load: o.load,
            squeeze_damping: o.squeeze_damping,
            ring_shear: o.ring_shear,
            liner_shear: o.liner_shear,
            slope_force: o.slope_force,
            flux: o.flux,
            p_max: finite(inp.p_cav + 12.0 * inp.mu * high, "pressure")?,
            full_film: if turned { (from + len - b, from + len - a) } else { (from + a, from + b) },
        })
    }

    fn forces(&mut self, inp: &FaceIn, hdot: f64) -> Result<FaceForces, EvalError> {
        let (cavitation, shear) = (self.cavitation, self.shear);
        let (side, mut f, turned) = self.enter(inp, hdot)?;
        side.solve(&mut f, cavitation)?;
        checked(side.forces(&f, cavitation, shear, inp.mu), turned, side, &f)
    }

    fn load(&mut self, inp: &FaceIn, hdot: f64) -> Result<(f64, f64), EvalError> {
        let cavitation = self.cavitation;
        let (side, mut f, _) = self.enter(inp, hdot)?;
        side.solve(&mut f, cavitation)?;
        let c = side.carried(&f);
        let k = 12.0 * inp.mu;
        finite(c.load + c.rate, "film")?;
        Ok((k * c.load, -(k * c.rate).min(0.0)))
    }

    fn squeeze_rate(&mut self, inp: &FaceIn, load: f64) -> Result<f64, EvalError> {
        let cavitation = self.cavitation;
        let (side, mut f, _) = self.enter(inp, load)?;
        let target = load / (12.0 * inp.mu);
        f.v = 0.0;
        side.squeeze(&mut f, cavitation, target)?;
        Ok(f.v)
    }

    fn carry(&mut self, inp: &FaceIn, load: f64) -> Result<(f64, FaceForces), EvalError> {
        let (cavitation, shear) = (self.cavitation, self.shear);
        let (side, mut f, turned) = self.enter(inp, load)?;
        let target = load / (12.0 * inp.mu);
        f.v = 0.0;
        side.squeeze(&mut f, cavitation, target)?;
        Ok((f.v, checked(side.forces(&f, cavitation, shear, inp.mu), turned, side, &f)?))
    }

    fn profile(&mut self, inp: &FaceIn, hdot: f64, out: &mut [(f64, f64, f64)]) -> Result<(), EvalError> {
        let (cavitation, from) = (self.cavitation, self.from);
        let (side, mut f, turned) = self.enter(inp, hdot)?;
        side.solve(&mut f, cavitation)?;
        let n = out.len();
        let len = side.face.length();
        let steps = n.saturating_sub(1).max(1);
        for (j, o) in out.iter_mut().enumerate() {
            let x = if j == steps { len } else { len * j as f64 / steps as f64 };
            let along = if turned { len - x } else { x };
            let i = side.face.piece_of(along);
            let p = inp.p_cav + 12.0 * inp.mu * side.pressure(&f, i, along);
            *o = (from + x, inp.h + side.face.drop(i, along), finite(p, "pressure")?);
        }
        Ok(())
    }
}
