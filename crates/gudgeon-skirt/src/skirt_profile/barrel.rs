use gudgeon_core::kinds::{SkirtProfile, SkirtProfileCtx, SkirtProfileSpec};
use gudgeon_core::quantity::{Fraction, Length, NonNegative, Ratio, quantity};
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::elementary;
use serde::{Deserialize, Serialize};

/// Barrel of two parabolas, and oval.
///
/// `f = t ((s₀ - s)/s₀)²` above the widest place and `b ((s - s₀)/(1 - s₀))²` below it, plus `o sin² φ`, with `s` from 0 at the upper edge to 1 at
/// the lower edge and `φ` from the middle of the side.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Barrel {
    /// Drop at the upper edge.
    #[serde(default = "none")]
    pub top: Length<NonNegative>,
    /// Drop at the lower edge.
    #[serde(default = "none")]
    pub bottom: Length<NonNegative>,
    /// Part of the height, from the upper edge, where the skirt is widest.
    #[serde(default = "half")]
    pub widest: Ratio<Fraction>,
    /// Drop at 90 degrees from the middle of the side (half the difference of the diameters).
    #[serde(default = "none")]
    pub ovality: Length<NonNegative>,
}

fn none() -> Length<NonNegative> {
    quantity(0.0)
}
fn half() -> Ratio<Fraction> {
    quantity(0.5)
}

#[register_model(
    name = "barrel",
    summary = "barrel of two parabolas, and oval",
    equations = "f = t ((s0 - s)/s0)^2 above s0, b ((s - s0)/(1 - s0))^2 below;  + o sin^2(phi)",
    validity = "Hot shape.",
    references = ["loureiro2009"],
    example = "top = \"20 um\"\nbottom = \"10 um\"\novality = \"150 um\"\n",
)]
impl SkirtProfileSpec for Barrel {
    fn build(&self, ctx: &SkirtProfileCtx<'_>) -> Result<Box<dyn SkirtProfile>, BuildError> {
        Ok(Box::new(Shape { spec: self.clone(), length: ctx.length }))
    }
}

#[derive(Debug)]
struct Shape {
    spec: Barrel,
    length: f64,
}

impl SkirtProfile for Shape {
    fn depth(&self, x: f64, angle: f64) -> f64 {
        let (s, s0) = (x / self.length, self.spec.widest.si());
        let part = |way: f64, whole: f64| if whole > 0.0 { (way / whole).powi(2) } else { 0.0 };
        let along = if s < s0 {
            self.spec.top.si() * part(s0 - s, s0)
        } else {
            self.spec.bottom.si() * part(s - s0, 1.0 - s0)
        };
        along + self.spec.ovality.si() * elementary::sin(angle).powi(2)
    }
    fn is_symmetric(&self) -> bool {
        true
    }
}
