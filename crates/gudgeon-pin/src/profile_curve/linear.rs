use gudgeon_core::kinds::{ProfileCurve, ProfileCurveSpec};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// Straight between neighbouring points and beyond the outermost ones.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Linear {}

#[register_model(
    name = "linear",
    summary = "straight lines between the points",
    equations = "y(x) = y_i + (y_{i+1} - y_i)(x - x_i)/(x_{i+1} - x_i)",
    validity = "Any number of points; has corners.",
    references = [],
    example = "",
)]
impl ProfileCurveSpec for Linear {
    fn build(&self, x: &[f64], y: &[f64]) -> Result<Box<dyn ProfileCurve>, BuildError> {
        super::check(x, y)?;
        Ok(Box::new(Chords { x: x.to_vec(), y: y.to_vec() }))
    }
}

#[derive(Debug)]
struct Chords {
    x: Vec<f64>,
    y: Vec<f64>,
}

impl ProfileCurve for Chords {
    fn value(&self, at: f64) -> f64 {
        let k = self.x.partition_point(|x| *x <= at).clamp(1, self.x.len() - 1);
        let (x, y) = (&self.x[k - 1..=k], &self.y[k - 1..=k]);
        let t = (at - x[0]) / (x[1] - x[0]);
        y[0] + (y[1] - y[0]) * t
    }
}
