//! Cylinder and crank drive.

use std::f64::consts::PI;

use gudgeon_core::BuildError;
use gudgeon_core::file::Files;
use gudgeon_core::kinds::{
    CylinderPressure, CylinderPressureCtx, CylinderPressureSpec, EngineCycle, Kinematics, KinematicsCtx,
    KinematicsSpec,
};
use gudgeon_core::quantity::{Length, PosAngularSpeed, PosLength, PosPressure, quantity};
use gudgeon_core::sets::Sets;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Engine.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-renamed" = { "offset": "crank_offset" }), transform = Sets(include_str!("engine.json")))]
pub struct Engine {
    /// Crankshaft speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed: Option<PosAngularSpeed>,
    /// Cylinder bore.
    pub bore: PosLength,
    /// Twice the crank radius. Give this or `crank_radius`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stroke: Option<PosLength>,
    /// Crank radius. Give this or `stroke`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub crank_radius: Option<PosLength>,
    /// Connecting-rod length between centres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rod_length: Option<PosLength>,
    /// Distance of the pin from the axis of the bore, towards the thrust side positive. After top dead centre the crank pin moves to the other
    /// side.
    #[serde(default = "zero")]
    pub pin_offset: Length,
    /// Distance of the crank axis from the axis of the bore, towards the thrust side positive. The line on which the pin moves is
    /// `crank_offset - pin_offset` away from the crank axis.
    #[serde(default = "zero")]
    pub crank_offset: Length,
    /// Number of cylinders, for the engine totals.
    #[serde(default = "one")]
    #[schemars(range(min = 1, max = 1000))]
    pub cylinders: u32,
}

const fn one() -> u32 {
    1
}
fn zero() -> Length {
    quantity(0.0)
}

/// The crank drive in numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crank {
    /// Crank radius \[m\].
    pub radius: f64,
    /// Connecting-rod length between centres \[m\].
    pub rod_length: f64,
    /// Crank speed \[rad/s\].
    pub omega: f64,
    /// Distance of the pin from the axis of the bore \[m\], towards the thrust side positive.
    pub pin_offset: f64,
    /// Distance of the crank axis from the axis of the bore \[m\], towards the thrust side positive.
    pub crank_offset: f64,
}

impl Engine {
    /// The crank drive.
    ///
    /// # Errors
    /// Speed, rod length, or both of stroke and crank radius are missing; stroke and crank radius are both given.
    pub fn crank(&self) -> Result<Crank, BuildError> {
        Ok(Crank {
            radius: self.radius()?,
            rod_length: given(self.rod_length, "engine", "rod_length")?.si(),
            omega: given(self.speed, "engine", "speed")?.si(),
            pin_offset: self.pin_offset.si(),
            crank_offset: self.crank_offset.si(),
        })
    }

    fn radius(&self) -> Result<f64, BuildError> {
        match (self.stroke, self.crank_radius) {
            (Some(s), None) => Ok(0.5 * s.si()),
            (None, Some(r)) => Ok(r.si()),
            (None, None) => Err(BuildError::at("engine", "missing key `stroke`")
                .help("give `stroke`, or `crank_radius`, the half of it")),
            (Some(_), Some(_)) => Err(BuildError::at(
                "engine.crank_radius",
                "the stroke is twice the crank radius: give one of the two",
            )),
        }
    }

    /// Area of the bore \[m²\].
    #[must_use]
    pub fn area(&self) -> f64 {
        0.25 * PI * self.bore.si() * self.bore.si()
    }

    /// The piston motion, for a model that stands at `models.kinematics`.
    ///
    /// # Errors
    /// As [`Self::crank`]; a mechanism that cannot turn, at the key of `engine` that it is about.
    pub fn motion(&self, model: &dyn KinematicsSpec) -> Result<Box<dyn Kinematics>, BuildError> {
        let crank = self.crank()?;
        let ctx = KinematicsCtx {
            crank_radius: crank.radius,
            rod_length: crank.rod_length,
            offset: crank.crank_offset - crank.pin_offset,
            omega: crank.omega,
        };
        // The mechanism is the engine's, not the model's.
        model.build(&ctx).map_err(|e| match e.field.as_str() {
            "" => e.within("models.kinematics"),
            "crank_radius" if self.stroke.is_some() => BuildError { field: "engine.stroke".into(), ..e },
            "omega" => BuildError { field: "engine.speed".into(), ..e },
            "offset" => BuildError { field: "engine.crank_offset".into(), ..e },
            _ => e.within("engine"),
        })
    }

    /// The cylinder pressure, for a model that stands at `models.cylinder_pressure`.
    ///
    /// # Errors
    /// What the model refuses.
    pub fn gas(
        &self,
        model: &dyn CylinderPressureSpec,
        kinematics: &(dyn Kinematics + 'static),
        files: &Files,
    ) -> Result<Box<dyn CylinderPressure>, BuildError> {
        let ctx = CylinderPressureCtx { kinematics, piston_area: self.area(), files };
        model.build(&ctx).map_err(|e| e.within("models.cylinder_pressure"))
    }

    /// The cycle of one cylinder: what a case of another scene may take from this one.
    ///
    /// # Errors
    /// As [`Self::motion`] and [`Self::gas`].
    pub fn cycle(
        &self,
        kinematics: &dyn KinematicsSpec,
        pressure: &dyn CylinderPressureSpec,
        crankcase: PosPressure,
        files: &Files,
    ) -> Result<EngineCycle, BuildError> {
        let kinematics = self.motion(kinematics)?;
        let pressure = self.gas(pressure, &*kinematics, files)?;
        Ok(EngineCycle { bore: self.bore.si(), kinematics, pressure, crankcase_pressure: crankcase.si() })
    }
}

/// A value that a scene needs, or which key is missing in the table at `place`.
pub(crate) fn given<T>(value: Option<T>, place: &str, key: &str) -> Result<T, BuildError> {
    value.ok_or_else(|| BuildError::at(place, format!("missing key `{key}`")))
}
