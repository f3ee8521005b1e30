use gudgeon_core::kinds::{Rig, RigCtx, RigOut, RigSpec, RoughFlow, RoughShear, Roughness, RoughnessSpec};
use gudgeon_core::quantity::{PosLength, Ratio, quantity};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use crate::draw::{self, Scales, line};

/// Flow and shear factors of a roughness model over the separation of the surfaces.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RoughSurfaceRig {
    /// Length that separations are multiples of: the composite roughness, the amplitude of a waviness.
    pub height: PosLength,
    /// Smallest separation that is drawn, over `height`. May be negative.
    #[serde(default = "zero")]
    pub from: Ratio,
    /// Largest separation that is drawn, over `height`.
    #[serde(default = "eight")]
    pub to: Ratio,
    /// Separation of the results, over `height`.
    pub separation: Ratio,
    /// The model.
    pub roughness: Box<dyn RoughnessSpec>,
}

fn zero() -> Ratio {
    quantity(0.0)
}
fn eight() -> Ratio {
    quantity(8.0)
}

#[register_model(
    name = "rough_surface",
    summary = "flow and shear factors of rough surfaces over their separation",
    equations = "phi_x, phi_y, phi_f, phi_fs, phi_fp and h_T over H = h/height;  phi_s = (h_c - h_T)/height",
    validity = "That of the model. phi_s is that of Patir and Cheng when `height` is the composite roughness of the model.",
    references = ["patir1978", "patir1979"],
    example = "height = \"4 um\"\nseparation = 2.5\nroughness = { model = \"sawtooth_waviness\", amplitude = \"4 um\" }\n",
)]
impl RigSpec for RoughSurfaceRig {
    fn models(&self) -> Vec<(&'static str, &'static str)> {
        vec![("roughness", self.roughness.typetag_name())]
    }
    fn build(&self, _: &RigCtx<'_>) -> Result<Box<dyn Rig>, Vec<BuildError>> {
        let mut errors = Vec::new();
        if self.from.si() >= self.to.si() {
            errors.push(BuildError::at("to", "the largest separation is not larger than the smallest"));
        }
        match self.roughness.build() {
            Ok(roughness) if errors.is_empty() => Ok(Box::new(Bench {
                roughness,
                height: self.height.si(),
                ends: (self.from.si(), self.to.si()),
                at: self.separation.si(),
            })),
            Ok(_) => Err(errors),
            Err(e) => {
                errors.push(e.within("roughness"));
                Err(errors)
            }
        }
    }
}

struct Bench {
    roughness: Box<dyn Roughness>,
    height: f64,
    ends: (f64, f64),
    at: f64,
}

const MODEL: &str = "rough_surface";
const POINTS: usize = 401;

/// Names, and what they are.
const FACTORS: [(&str, &str); 8] = [
    ("phi_x", "pressure-flow factor along the sliding direction"),
    ("phi_y", "pressure-flow factor across the sliding direction"),
    ("phi_s", "shear-flow factor: what the moving liner carries beyond the film content, over `height`"),
    ("phi_f", "shear-stress factor of the sliding speed, mean of both surfaces"),
    ("phi_fs", "shear-stress factor of the sliding speed, liner against body"),
    ("phi_fp", "shear-stress factor of the pressure gradient"),
    ("content", "film content, the average gap, over `height`"),
    ("content_slope", "change of the film content with the separation"),
];

impl Bench {
    /// The [`FACTORS`] at separations over `height`.
    fn factors(&self, at: &[f64]) -> Result<[Vec<f64>; 8], EvalError> {
        let h: Vec<f64> = at.iter().map(|x| x * self.height).collect();
        let (mut flow, mut shear) = (RoughFlow::new(h.len()), RoughShear::new(h.len()));
        self.roughness.flow(&h, &mut flow)?;
        self.roughness.shear(&h, &mut shear)?;
        let carried = flow.transport.iter().zip(&flow.content).map(|(c, t)| (c - t) / self.height).collect();
        let content = flow.content.iter().map(|t| t / self.height).collect();
        Ok([
            flow.phi_x,
            flow.phi_y,
            carried,
            shear.phi_f,
            shear.phi_fs,
            shear.phi_fp,
            content,
            flow.content_derivative,
        ])
    }
}

impl Rig for Bench {
    fn results(&self) -> Vec<String> {
        FACTORS.iter().map(|(name, _)| (*name).to_owned()).collect()
    }

    fn run(&mut self, out: &mut RigOut) -> Result<(), EvalError> {
        let here = self.factors(&[self.at])?;
        for ((name, what), v) in FACTORS.iter().zip(here) {
            out.result(*name, v[0], "1", *what);
        }
        let at = draw::linear(self.ends.0, self.ends.1, POINTS);
        let rows = self.factors(&at)?;
        out.axis("H", "1", at);
        for ((name, _), v) in FACTORS.iter().zip(rows) {
            out.column(*name, "1", v);
        }
        let hint = "over the separation of the mean planes, in heights";
        let plain = Scales::default();
        draw::curves(
            out,
            "series",
            "Flow factors",
            hint,
            plain,
            &[line("phi_x, along", "phi_x"), line("phi_y, across", "phi_y"), line("phi_s, shear", "phi_s")],
        );
        draw::curves(
            out,
            "series",
            "Shear-stress factors",
            hint,
            plain,
            &[line("phi_f", "phi_f"), line("phi_fs", "phi_fs"), line("phi_fp", "phi_fp")],
        );
        draw::curves(
            out,
            "series",
            "Film content",
            "average gap in heights, and its slope",
            plain,
            &[line("content", "content"), line("slope", "content_slope")],
        );
        draw::finite(MODEL, out)
    }
}
