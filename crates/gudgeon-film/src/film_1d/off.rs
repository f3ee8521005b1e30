use gudgeon_core::kinds::{Film1d, Film1dCtx, Film1dIn, Film1dOut, Film1dSpec, FilmField};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use super::line::Line;

/// No oil film: it carries nothing, does not shear and lets nothing through. The inputs must still make a line.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Off {}

#[register_model(
    name = "off",
    summary = "no film: no load, no friction, no flux",
    equations = "p = p_cav,  theta = 0",
    validity = "Solid contact and gas alone.",
    references = [],
    example = "",
)]
impl Film1dSpec for Off {
    fn build(&self, ctx: &Film1dCtx<'_>) -> Result<Box<dyn Film1d>, BuildError> {
        ctx.check()?;
        Ok(Box::new(NoFilm { line: Line::new("off", ctx) }))
    }
}

struct NoFilm {
    line: Line,
}

impl Film1d for NoFilm {
    fn solve(&mut self, inp: &Film1dIn<'_>) -> Result<Film1dOut, EvalError> {
        self.line.enter(inp, true)?;
        Ok(self.line.without_oil())
    }

    fn field(&self) -> FilmField<'_> {
        self.line.field()
    }

    fn full_content(&self, _: &[f64], _: &[f64], content: &mut [f64]) {
        // No film holds no oil.
        content.fill(0.0);
    }
}
