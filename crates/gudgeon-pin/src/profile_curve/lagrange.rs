use gudgeon_core::kinds::{ProfileCurve, ProfileCurveSpec};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// The polynomial through all points, as the published program draws it (`reimer1984`).
///
/// Between equal ordinates it overshoots, and beyond the last point it runs away with its highest power.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Lagrange {}

/// Maximum number of points: through more, a polynomial swings between them.
const MAX_POINTS: usize = 12;

#[register_model(
    name = "lagrange",
    summary = "polynomial through all points",
    equations = "y(x) = sum_i y_i prod_{j != i} (x - x_j)/(x_i - x_j)",
    validity = "A few points, at most 12; overshoots between equal ordinates and extrapolates with its highest power.",
    references = ["reimer1984"],
    example = "",
)]
impl ProfileCurveSpec for Lagrange {
    fn build(&self, x: &[f64], y: &[f64]) -> Result<Box<dyn ProfileCurve>, BuildError> {
        super::check(x, y)?;
        if x.len() > MAX_POINTS {
            let what = format!("a polynomial through {} points swings between them", x.len());
            return Err(BuildError::new(what)
                .help(format!("at most {MAX_POINTS} points, or the model `monotone_cubic`")));
        }
        Ok(Box::new(Polynomial { x: x.to_vec(), y: y.to_vec() }))
    }
}

#[derive(Debug)]
struct Polynomial {
    x: Vec<f64>,
    y: Vec<f64>,
}

impl ProfileCurve for Polynomial {
    fn value(&self, at: f64) -> f64 {
        let n = self.x.len();
        let basis = |i: usize| {
            (0..n).filter(|&j| j != i).map(|j| (at - self.x[j]) / (self.x[i] - self.x[j])).product::<f64>()
        };
        (0..n).map(|i| self.y[i] * basis(i)).sum()
    }
}
