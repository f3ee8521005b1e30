use gudgeon_core::kinds::{Film2d, Film2dCtx, Film2dGrid, Film2dIn, Film2dOut, Film2dSpec, FilmMode};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use super::flux::Flux;
use super::problem::Problem;

/// No oil between the surfaces: the pressure is `p_cav`, nothing shears.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Off {}

#[register_model(
    name = "off",
    summary = "no film: no load, no friction",
    equations = "p = p_cav,  theta = 0",
    validity = "Dry surfaces, or a part whose film does not matter.",
    references = [],
    example = "",
)]
impl Film2dSpec for Off {
    fn build(&self, ctx: &Film2dCtx<'_>) -> Result<Box<dyn Film2d>, BuildError> {
        let problem = Problem::new(ctx.grid, Flux::Face)?;
        let n = problem.len();
        Ok(Box::new(NoFilm { grid: problem.grid, pressure: vec![0.0; n], fill: vec![0.0; n] }))
    }
}

struct NoFilm {
    grid: Film2dGrid,
    pressure: Vec<f64>,
    fill: Vec<f64>,
}

impl Film2d for NoFilm {
    fn grid(&self) -> &Film2dGrid {
        &self.grid
    }
    fn solve(&mut self, inp: &Film2dIn<'_>) -> Result<Film2dOut, EvalError> {
        self.pressure.fill(inp.p_cav);
        Ok(Film2dOut { p_max: inp.p_cav, iterations: 1, ..Film2dOut::default() })
    }
    fn pressure(&self) -> &[f64] {
        &self.pressure
    }
    fn fill(&self) -> &[f64] {
        &self.fill
    }
    fn solve_many(
        &mut self,
        _: &Film2dIn<'_>,
        _: &[FilmMode<'_>],
        p: &mut [f64],
    ) -> Result<usize, EvalError> {
        p.fill(0.0);
        Ok(0)
    }
    fn reset(&mut self) {}
}
