use gudgeon_core::kinds::{ProfileCurve, ProfileCurveSpec};
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::table::Pchip;
use serde::{Deserialize, Serialize};

/// Piecewise cubic that keeps the shape of the points: it rises where they rise and never overshoots.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MonotoneCubic {}

#[register_model(
    name = "monotone_cubic",
    summary = "shape-preserving cubic, straight beyond the points",
    equations = "cubic between neighbours with slopes from the weighted harmonic mean of the secants",
    validity = "Any number of points; slope continuous, curvature not.",
    references = ["fritsch1980"],
    example = "",
)]
impl ProfileCurveSpec for MonotoneCubic {
    fn build(&self, x: &[f64], y: &[f64]) -> Result<Box<dyn ProfileCurve>, BuildError> {
        super::check(x, y)?;
        let curve = Pchip::new(x.to_vec(), y.to_vec()).map_err(|e| BuildError::new(e.to_string()))?;
        let end = |at: f64| (at, curve.eval(at));
        let ends = [end(x[0]), end(x[x.len() - 1])];
        Ok(Box::new(Shaped { ends, curve }))
    }
}

#[derive(Debug)]
struct Shaped {
    curve: Pchip,
    /// Abscissa, and ordinate with slope, of the outermost points.
    ends: [(f64, (f64, f64)); 2],
}

impl ProfileCurve for Shaped {
    fn value(&self, at: f64) -> f64 {
        let [first, last] = self.ends;
        let (x, (y, slope)) = if at < first.0 {
            first
        } else if at > last.0 {
            last
        } else {
            return self.curve.value(at);
        };
        y + slope * (at - x)
    }
}
