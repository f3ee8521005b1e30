use gudgeon_core::geometry::FaceProfile;
use gudgeon_core::kinds::{FaceCtx, FaceIn, FaceOut, Hydrodynamics, HydrodynamicsSpec};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use super::check_face::check_face;

/// No oil film: it carries nothing, does not shear and does not resist being squeezed. A ring then rides on its solid contact alone; one
/// without contact as well keeps the film thickness it was given.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Off {}

#[register_model(
    name = "off",
    summary = "no film: no load, no friction; rings ride on their solid contact",
    equations = "p = p_cav",
    validity = "Dry rings; gas flow and axial motion alone.",
    references = [],
    example = "",
)]
impl HydrodynamicsSpec for Off {
    fn build(&self, ctx: &FaceCtx<'_>) -> Result<Box<dyn Hydrodynamics>, BuildError> {
        check_face(ctx.face)?;
        Ok(Box::new(NoFilm { face: ctx.face.clone() }))
    }
}

struct NoFilm {
    face: FaceProfile,
}

impl Hydrodynamics for NoFilm {
    fn evaluate(&mut self, inp: &FaceIn, _: f64) -> Result<FaceOut, EvalError> {
        Ok(FaceOut { p_max: inp.p_cav, ..FaceOut::default() })
    }
    fn squeeze_rate(&mut self, _: &FaceIn, _: f64) -> Result<f64, EvalError> {
        Ok(0.0)
    }
    fn resists(&self) -> bool {
        false
    }
    fn profile(&mut self, inp: &FaceIn, _: f64, out: &mut [(f64, f64, f64)]) -> Result<(), EvalError> {
        let dx = self.face.length() / out.len().saturating_sub(1).max(1) as f64;
        for (i, o) in out.iter_mut().enumerate() {
            let x = i as f64 * dx;
            *o = (x, inp.h + self.face.drop_at(x), inp.p_cav);
        }
        Ok(())
    }
}
