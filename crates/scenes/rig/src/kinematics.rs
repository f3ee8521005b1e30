use gudgeon_core::kinds::{KinematicsCtx, KinematicsSpec, Rig, RigCtx, RigOut, RigSpec, named};
use gudgeon_core::quantity::{Angle, Length, PosAngularSpeed, PosLength, quantity};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

/// Piston motion over one turn of the crank.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct KinematicsRig {
    /// Crankshaft speed.
    pub speed: PosAngularSpeed,
    /// Twice the crank radius.
    pub stroke: PosLength,
    /// Connecting-rod length between centres.
    pub rod_length: PosLength,
    /// Offset of the pin's line of motion from the crank axis.
    #[serde(default = "zero")]
    pub offset: Length,
    /// Crank angle of the results at a point.
    #[serde(default = "right_angle")]
    pub angle: Angle,
    /// The model.
    pub kinematics: Box<dyn KinematicsSpec>,
}

fn zero() -> Length {
    quantity(0.0)
}
fn right_angle() -> Angle {
    quantity(std::f64::consts::FRAC_PI_2)
}

#[register_model(
    name = "kinematics",
    summary = "piston position, velocity and acceleration over one turn",
    equations = "y(theta), v = dy/dt, a = dv/dt over one turn",
    validity = "Constant crank speed.",
    references = [],
    example = "speed = \"3000 rpm\"\nstroke = \"90 mm\"\nrod_length = \"144 mm\"\nkinematics = { model = \"exact_slider_crank\" }\n",
)]
impl RigSpec for KinematicsRig {
    fn models(&self) -> Vec<(&'static str, &'static str)> {
        vec![("kinematics", self.kinematics.typetag_name())]
    }
    fn build(&self, _: &RigCtx<'_>) -> Result<Box<dyn Rig>, Vec<BuildError>> {
        let ctx = KinematicsCtx {
            crank_radius: self.stroke.si() / 2.0,
            rod_length: self.rod_length.si(),
            offset: self.offset.si(),
            omega: self.speed.si(),
        };
        let motion = self.kinematics.build(&ctx).map_err(|e| vec![e])?;
        Ok(Box::new(Bench { motion, angle: self.angle.si() }))
    }
}

struct Bench {
    motion: Box<dyn gudgeon_core::kinds::Kinematics>,
    angle: f64,
}

/// Rows of the series: half a degree apart.
const ROWS: usize = 720;

impl Rig for Bench {
    fn results(&self) -> Vec<String> {
        named(&["stroke", "y_tdc", "y", "v", "a", "rod_angle", "v_max", "a_max"])
    }

    fn run(&mut self, out: &mut RigOut) -> Result<(), EvalError> {
        let k = &self.motion;
        let at = k.motion(self.angle);
        out.result("stroke", k.stroke(), "m", "distance between the dead centres");
        out.result("y_tdc", k.y_tdc(), "m", "highest position of the pin above the crank axis");
        out.result("y", at.y, "m", "height of the pin at `angle`");
        out.result("v", at.v, "m/s", "velocity at `angle`, towards the head positive");
        out.result("a", at.a, "m/s2", "acceleration at `angle`");
        out.result("rod_angle", at.rod_angle, "rad", "angle of the rod to the cylinder axis at `angle`");
        let theta: Vec<f64> = (0..=ROWS).map(|i| 360.0 * i as f64 / ROWS as f64).collect();
        let rows: Vec<_> = theta.iter().map(|t| k.motion(t.to_radians())).collect();
        out.result(
            "v_max",
            rows.iter().map(|m| m.v.abs()).fold(0.0, f64::max),
            "m/s",
            "highest speed of the rows of the series",
        );
        out.result(
            "a_max",
            rows.iter().map(|m| m.a.abs()).fold(0.0, f64::max),
            "m/s2",
            "highest acceleration of the rows of the series",
        );
        out.axis(gudgeon_core::result::CRANK_ANGLE, "deg", theta);
        out.column("piston.y", "m", rows.iter().map(|m| m.y).collect());
        out.column("piston.v", "m/s", rows.iter().map(|m| m.v).collect());
        out.column("piston.a", "m/s2", rows.iter().map(|m| m.a).collect());
        out.column("rod.angle", "rad", rows.iter().map(|m| m.rod_angle).collect());
        Ok(())
    }
}
