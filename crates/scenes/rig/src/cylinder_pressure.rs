use gudgeon_core::kinds::{
    CylinderPressure, CylinderPressureCtx, CylinderPressureSpec, Kinematics, KinematicsCtx, KinematicsSpec,
    Rig, RigCtx, RigOut, RigSpec, named,
};
use gudgeon_core::quantity::{Angle, Length, PosAngularSpeed, PosLength, quantity};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

/// Cylinder pressure over one cycle.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CylinderPressureRig {
    /// Crankshaft speed.
    pub speed: PosAngularSpeed,
    /// Cylinder bore.
    pub bore: PosLength,
    /// Twice the crank radius.
    pub stroke: PosLength,
    /// Connecting-rod length between centres.
    pub rod_length: PosLength,
    /// Offset of the pin's line of motion from the crank axis.
    #[serde(default = "zero")]
    pub offset: Length,
    /// Crank angle of the result `p`.
    #[serde(default = "firing")]
    pub angle: Angle,
    /// Piston motion.
    pub kinematics: Box<dyn KinematicsSpec>,
    /// The model.
    pub cylinder_pressure: Box<dyn CylinderPressureSpec>,
}

fn zero() -> Length {
    quantity(0.0)
}
fn firing() -> Angle {
    quantity(2.0 * std::f64::consts::PI)
}

#[register_model(
    name = "cylinder_pressure",
    summary = "cylinder pressure over one cycle, with its peak and work",
    equations = "imep = (1/V_d) int p dV over the cycle",
    validity = "The work is a sum over the rows of the series and the kinks of the model.",
    references = [],
    example = "speed = \"2000 rpm\"\nbore = \"120 mm\"\nstroke = \"140 mm\"\nrod_length = \"220 mm\"\n\
              kinematics = { model = \"exact_slider_crank\" }\ncylinder_pressure = { model = \"constant\", pressure = \"2 bar\" }\n",
)]
impl RigSpec for CylinderPressureRig {
    fn models(&self) -> Vec<(&'static str, &'static str)> {
        vec![
            ("kinematics", self.kinematics.typetag_name()),
            ("cylinder_pressure", self.cylinder_pressure.typetag_name()),
        ]
    }
    fn build(&self, ctx: &RigCtx<'_>) -> Result<Box<dyn Rig>, Vec<BuildError>> {
        let area = std::f64::consts::PI / 4.0 * self.bore.si().powi(2);
        let motion = self
            .kinematics
            .build(&KinematicsCtx {
                crank_radius: self.stroke.si() / 2.0,
                rod_length: self.rod_length.si(),
                offset: self.offset.si(),
                omega: self.speed.si(),
            })
            .map_err(|e| vec![e])?;
        let pressure = self
            .cylinder_pressure
            .build(&CylinderPressureCtx { kinematics: &*motion, piston_area: area, files: ctx.files })
            .map_err(|e| vec![e.within("cylinder_pressure")])?;
        Ok(Box::new(Bench { motion, pressure, area, angle: self.angle.si() }))
    }
}

struct Bench {
    motion: Box<dyn Kinematics>,
    pressure: Box<dyn CylinderPressure>,
    area: f64,
    angle: f64,
}

/// Rows of the series per degree.
const PER_DEGREE: f64 = 2.0;

impl Rig for Bench {
    fn results(&self) -> Vec<String> {
        named(&["p_max", "p_max_angle", "p", "work", "imep"])
    }

    fn run(&mut self, out: &mut RigOut) -> Result<(), EvalError> {
        let period = self.pressure.period();
        let n = (period.to_degrees() * PER_DEGREE).round().max(2.0) as usize;
        let mut theta: Vec<f64> = (0..=n).map(|i| period * i as f64 / n as f64).collect();
        theta.extend(self.pressure.kinks());
        theta.sort_by(f64::total_cmp);
        theta.dedup_by(|a, b| (*a - *b).abs() < 1e-12);
        let p: Vec<f64> = theta.iter().map(|t| self.pressure.pressure(*t)).collect();
        let y: Vec<f64> = theta.iter().map(|t| self.motion.motion(*t).y).collect();
        // Volume falls as the pin rises.
        let work: f64 =
            (1..theta.len()).map(|i| -self.area * 0.5 * (p[i] + p[i - 1]) * (y[i] - y[i - 1])).sum();
        let (at, peak) = self.pressure.highest();
        out.notes.extend(self.pressure.notes());
        out.result("p_max", peak / 1e5, "bar", "highest pressure");
        out.result("p_max_angle", at.to_degrees(), "deg", "crank angle of the highest pressure");
        out.result("p", self.pressure.pressure(self.angle) / 1e5, "bar", "pressure at `angle`");
        out.result("work", work, "J", "indicated work of one cycle");
        out.result(
            "imep",
            work / (self.area * self.motion.stroke()) / 1e5,
            "bar",
            "indicated mean effective pressure",
        );
        out.axis(gudgeon_core::result::CRANK_ANGLE, "deg", theta.iter().map(|t| t.to_degrees()).collect());
        out.column("cylinder.p", "Pa", p);
        out.column("piston.y", "m", y);
        Ok(())
    }
}
