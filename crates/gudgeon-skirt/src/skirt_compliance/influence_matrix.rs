use gudgeon_core::kinds::{SkirtCompliance, SkirtComplianceCtx, SkirtComplianceSpec};
use gudgeon_core::quantity::{Fraction, Ratio, quantity};
use gudgeon_core::{BuildError, register_model};
use nalgebra::{DMatrix, SymmetricEigen};
use serde::{Deserialize, Serialize};

use super::QuasiStaticShapes;
use super::points::Points;

/// Deflections by unit forces, as a finite-element program gives them.
///
/// The file has one row per point, `height angle c_1 c_2 …`: metres below the upper edge, degrees from the middle, and the deflection of this point
/// \[m/N\] by a force on point 1, point 2, …, in the order of the rows. The points form a rectangular grid over the side. The matrix is
/// symmetric; its eigenvectors are shapes that yield independently, of which those that matter are kept:
///
/// `δ = Σ λ_k φ_k ∫ φ_k (p - p_crankcase) dA`, `λ_k ≥ rest λ_1`. Between the points run straight lines.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InfluenceMatrix {
    /// Text file, relative to the folder of the case.
    pub file: String,
    /// Most shapes that are kept.
    #[serde(default = "most")]
    #[schemars(range(min = 1, max = 100))]
    pub shapes: u32,
    /// Compliance, relative to the largest, below which a shape is left out.
    #[serde(default = "rest")]
    pub rest: Ratio<Fraction>,
}

fn most() -> u32 {
    12
}
fn rest() -> Ratio<Fraction> {
    quantity(1e-3)
}

/// Asymmetry of a matrix, relative to its largest entry, that is taken for rounding of the file.
const ASYMMETRY: f64 = 1e-3;

#[register_model(
    name = "influence_matrix",
    summary = "deflections by unit forces from a file, reduced to the shapes that matter",
    equations = "C = sum lambda_k v_k v_k';  delta = sum lambda_k phi_k int phi_k (p - p_crankcase) dA;  lambda_k >= rest lambda_1",
    validity = "Linear elasticity without inertia; deflections by film pressure alone.",
    references = [],
    example = "file = \"skirt-compliance.csv\"\n",
)]
impl SkirtComplianceSpec for InfluenceMatrix {
    fn build(&self, ctx: &SkirtComplianceCtx<'_>) -> Result<Box<dyn SkirtCompliance>, BuildError> {
        if !(1..=100).contains(&self.shapes) {
            return Err(BuildError::at("shapes", format!("must be between 1 and 100, not {}", self.shapes)));
        }
        let points = Points::read(ctx.files, &self.file, |rows| rows)?;
        let eigen = SymmetricEigen::new(self.compliance(&points)?);
        let n = points.len();
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]).then(a.cmp(b)));
        let top = eigen.eigenvalues[order[0]];
        if top.is_nan() || top <= 0.0 || eigen.eigenvalues[order[n - 1]] < -0.01 * top {
            let what = format!("{}: a skirt with this matrix would push back where it is pushed", self.file);
            return Err(BuildError::at("file", what));
        }
        let (mut shapes, mut stiffness) = (Vec::new(), Vec::new());
        for &m in order.iter().take(self.shapes as usize) {
            let lambda = eigen.eigenvalues[m];
            if lambda < self.rest.si().max(1e-9) * top {
                break;
            }
            let v = eigen.eigenvectors.column(m);
            let largest = v.iter().fold(0.0_f64, |a, b| if b.abs() > a.abs() { *b } else { a });
            for y in &ctx.grid.y {
                for x in &ctx.grid.x {
                    let at = points.weights(*x, y / ctx.radius);
                    shapes.push(at.iter().map(|(k, w)| w * v[*k]).sum::<f64>() / largest);
                }
            }
            stiffness.push(1.0 / (lambda * largest * largest));
        }
        Ok(Box::new(QuasiStaticShapes::new(ctx, shapes, stiffness)))
    }
}

impl InfluenceMatrix {
    /// The symmetric matrix of the file, and of its shapes those alone that a symmetric load excites where it is its own mirror image.
    fn compliance(&self, points: &Points) -> Result<DMatrix<f64>, BuildError> {
        let n = points.len();
        let given = DMatrix::from_fn(n, n, |i, j| points.values[j * n + i]);
        let largest = given.amax();
        let skew = (&given - given.transpose()).amax();
        if skew > ASYMMETRY * largest {
            let what = format!("{}: the matrix is not symmetric, by {skew:e} m/N", self.file);
            return Err(BuildError::at("file", what).help("force on i moves j as force on j moves i"));
        }
        let c = (&given + given.transpose()) * 0.5;
        let Some(to) = points.mirror() else { return Ok(c) };
        let mirrored = DMatrix::from_fn(n, n, |i, j| c[(to[i], to[j])]);
        if (&mirrored - &c).amax() >= ASYMMETRY * largest {
            return Ok(c);
        }
        let sum = |i: usize, j: usize| c[(i, j)] + c[(to[i], j)] + c[(i, to[j])] + c[(to[i], to[j])];
        Ok(DMatrix::from_fn(n, n, |i, j| 0.25 * sum(i, j)))
    }
}
