use std::f64::consts::FRAC_PI_2;

use gudgeon_core::kinds::{SkirtCompliance, SkirtComplianceCtx, SkirtComplianceSpec};
use gudgeon_core::quantity::PosStiffness;
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::elementary;
use serde::{Deserialize, Serialize};

use super::QuasiStaticShapes;
use super::points::Points;

/// Shapes in which the skirt yields, each with a stiffness of its own.
///
/// `δ = Σ q_k φ_k`, `K_k q_k = ∫ φ_k (p - p_crankcase) dA`. The shapes are given by formula, `φ = (x/L)^m cos(n π φ/(2 φ₀))` with `x` from the upper edge
/// down and `φ₀` half the angle of the side, or by a `file` of rows `height angle φ_1 φ_2 …` (metres, degrees) over a rectangular grid of points.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Modal {
    /// Stiffness of every shape.
    pub stiffness: Vec<PosStiffness>,
    /// Shapes by formula.
    #[serde(default)]
    #[schemars(length(max = 100))]
    pub shapes: Vec<Shape>,
    /// Shapes from a text file, relative to the folder of the case.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
}

/// A shape by formula.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Shape {
    /// Power of the height: 0 for the same all along, 2 for a skirt that bends from its upper edge.
    #[schemars(range(max = 100))]
    pub power: u32,
    /// Quarter waves from the middle to the flank: 0 for the same all across, 1 for none at the flanks.
    #[schemars(range(max = 100))]
    pub waves: u32,
}

#[register_model(
    name = "modal",
    summary = "shapes in which the skirt yields, each with a stiffness of its own",
    equations = "delta = sum q_k phi_k;  K_k q_k = int phi_k (p - p_crankcase) dA;  phi = (x/L)^m cos(n pi phi/(2 phi0)), or from a file",
    validity = "Linear elasticity without inertia; deflections by film pressure alone.",
    references = [],
    example = "stiffness = [\"300 N/um\", \"800 N/um\"]\nshapes = [{ power = 2, waves = 1 }, { power = 0, waves = 1 }]\n",
)]
impl SkirtComplianceSpec for Modal {
    fn build(&self, ctx: &SkirtComplianceCtx<'_>) -> Result<Box<dyn SkirtCompliance>, BuildError> {
        let stiffness: Vec<f64> = self.stiffness.iter().map(|k| k.si()).collect();
        let mut shapes = Vec::new();
        let (x, y) = (&ctx.grid.x, &ctx.grid.y);
        let mut add = |f: &dyn Fn(f64, f64) -> f64| {
            shapes.extend(y.iter().flat_map(|y| x.iter().map(move |x| f(*x, y / ctx.radius))));
        };
        let given = if let Some(file) = &self.file {
            if !self.shapes.is_empty() {
                return Err(BuildError::at("file", "the shapes are given twice, in a file and by formula"));
            }
            let points = Points::read(ctx.files, file, |_| stiffness.len())?;
            (0..stiffness.len()).for_each(|m| add(&|x, a| points.value(m, x, a)));
            stiffness.len()
        } else {
            for s in &self.shapes {
                let (power, waves) = (f64::from(s.power), f64::from(s.waves));
                add(&|x, a| {
                    let s = (x / ctx.length).clamp(0.0, 1.0);
                    elementary::powf(s, power) * elementary::cos(waves * FRAC_PI_2 * a / ctx.half_angle)
                });
            }
            self.shapes.len()
        };
        if given != stiffness.len() || given == 0 {
            let what = format!("{given} shapes and {} stiffnesses", stiffness.len());
            return Err(BuildError::at("stiffness", what).help("every shape needs one"));
        }
        Ok(Box::new(QuasiStaticShapes::new(ctx, shapes, stiffness)))
    }
}
