use gudgeon_core::kinds::{
    CylinderPressureCtx, CylinderPressureSpec, EngineCycle, KinematicsCtx, KinematicsSpec, PinLoadCase,
    PinLoadCtx, PinLoadSpec,
};
use gudgeon_core::quantity::{Length, Mass, NonNegative, PosAngularSpeed, PosLength, PosPressure, quantity};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

use super::search::over_cycle;

/// Gas and inertia over the cycle of an engine described here.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cycle {
    /// Crankshaft speed.
    pub speed: PosAngularSpeed,
    /// Twice the crank radius.
    pub stroke: PosLength,
    /// Connecting-rod length between centres.
    pub rod_length: PosLength,
    /// Offset of the pin's line of motion from the crank axis.
    #[serde(default = "centred")]
    pub offset: Length,
    /// Mass of the piston with its rings, without the pin.
    pub piston_mass: Mass<NonNegative>,
    /// Pressure below the piston.
    #[serde(default = "atmosphere")]
    pub crankcase_pressure: PosPressure,
    /// Piston motion.
    pub kinematics: Box<dyn KinematicsSpec>,
    /// Cylinder pressure.
    pub cylinder_pressure: Box<dyn CylinderPressureSpec>,
}

fn centred() -> Length {
    quantity(0.0)
}
fn atmosphere() -> PosPressure {
    quantity(101_325.0)
}

#[register_model(
    name = "cycle",
    summary = "gas and inertia over the cycle of an engine described in place",
    equations = "F_gas = (p - p_crankcase) pi D^2/4;  F_in = m a;  sized for max |F_gas + F_in|",
    validity = "Constant speed. The piston's whole mass without the pin loads the bosses.",
    references = [],
    example = "speed = \"4000 rpm\"\nstroke = \"79.3 mm\"\nrod_length = \"138.5 mm\"\npiston_mass = \"335 g\"\nkinematics = { model = \"exact_slider_crank\" }\ncylinder_pressure = { model = \"constant\", pressure = \"60 bar\" }\n",
)]
impl PinLoadSpec for Cycle {
    fn models(&self) -> Vec<(&'static str, &'static str)> {
        vec![
            ("kinematics", self.kinematics.typetag_name()),
            ("cylinder_pressure", self.cylinder_pressure.typetag_name()),
        ]
    }
    fn build(&self, ctx: &PinLoadCtx<'_>) -> Result<PinLoadCase, BuildError> {
        let mechanism = KinematicsCtx {
            crank_radius: 0.5 * self.stroke.si(),
            rod_length: self.rod_length.si(),
            offset: self.offset.si(),
            omega: self.speed.si(),
        };
        let kinematics = self.kinematics.build(&mechanism).map_err(|e| {
            // The mechanism is described here, not in the model.
            let place = match e.field.as_str() {
                "crank_radius" => "stroke",
                "offset" => "offset",
                _ => "rod_length",
            };
            BuildError { field: place.into(), ..e }
        })?;
        let chamber = CylinderPressureCtx {
            kinematics: kinematics.as_ref(),
            piston_area: ctx.pi * ctx.bore * ctx.bore / 4.0,
            files: ctx.files,
        };
        let pressure = self.cylinder_pressure.build(&chamber).map_err(|e| e.within("cylinder_pressure"))?;
        let engine = EngineCycle {
            bore: ctx.bore,
            kinematics,
            pressure,
            crankcase_pressure: self.crankcase_pressure.si(),
        };
        over_cycle(&engine, ctx.pi, self.piston_mass.si())
    }
}
