//! Conventions in which published programs differ, each a registered kind of model.

use gudgeon_core::kinds::{
    AxialGas, AxialGasSpec, CavitationDatum, CavitationDatumSpec, Drag, DragSpec, FilmForce, FilmForceSpec,
    Hoop, HoopSpec, RadialGas, RadialGasSpec, TwinLandFriction, TwinLandFrictionSpec,
};
use gudgeon_core::{BuildError, Word};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Conventions in which published programs differ, each chosen by a word. The defaults are the physically correct ones.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Conventions {
    /// Contact pressure from the tangential force.
    pub hoop: Word<dyn HoopSpec>,
    /// Area and pressure distribution of the axial gas force.
    pub axial_gas: Word<dyn AxialGasSpec>,
    /// Where gas presses radially.
    pub radial_gas: Word<dyn RadialGasSpec>,
    /// Force of the film in the ring's axial balance.
    pub film_force: Word<dyn FilmForceSpec>,
    /// Friction that friction power counts.
    pub drag: Word<dyn DragSpec>,
    /// Pressure at which films cavitate.
    pub cavitation_datum: Word<dyn CavitationDatumSpec>,
    /// Friction of a twin-land ring.
    pub twin_land_friction: Word<dyn TwinLandFrictionSpec>,
}

gudgeon_core::default_model! {
    default_hoop: dyn HoopSpec = "correct";
    default_axial_gas: dyn AxialGasSpec = "laminar_profile";
    default_radial_gas: dyn RadialGasSpec = "back_face_and_gap";
    default_film_force: dyn FilmForceSpec = "total";
    default_drag: dyn DragSpec = "liner";
    default_cavitation_datum: dyn CavitationDatumSpec = "gauge";
    default_twin_land_friction: dyn TwinLandFrictionSpec = "both_lands";
}

impl Default for Conventions {
    fn default() -> Self {
        Self {
            hoop: Word(default_hoop()),
            axial_gas: Word(default_axial_gas()),
            radial_gas: Word(default_radial_gas()),
            film_force: Word(default_film_force()),
            drag: Word(default_drag()),
            cavitation_datum: Word(default_cavitation_datum()),
            twin_land_friction: Word(default_twin_land_friction()),
        }
    }
}

impl Conventions {
    /// The running laws, or what is wrong with each.
    pub fn build(&self) -> Result<Laws, Vec<BuildError>> {
        let mut errors = Vec::new();
        macro_rules! law {
            ($name:ident) => {
                self.$name
                    .build()
                    .map_err(|e| errors.push(e.within(concat!("conventions.", stringify!($name)))))
                    .ok()
            };
        }
        let laws = (
            law!(hoop),
            law!(axial_gas),
            law!(radial_gas),
            law!(film_force),
            law!(drag),
            law!(cavitation_datum),
            law!(twin_land_friction),
        );
        let (
            Some(hoop),
            Some(axial_gas),
            Some(radial_gas),
            Some(film_force),
            Some(drag),
            Some(cavitation_datum),
            Some(twin_land_friction),
        ) = laws
        else {
            return Err(errors);
        };
        Ok(Laws { hoop, axial_gas, radial_gas, film_force, drag, cavitation_datum, twin_land_friction })
    }

    /// Kind and name of those that forces along the groove follow.
    pub fn axial(&self) -> [(&'static str, &'static str); 1] {
        [("axial_gas", self.axial_gas.typetag_name())]
    }

    /// Kind and name of those that a film and its friction follow.
    pub fn film(&self) -> [(&'static str, &'static str); 6] {
        [
            ("hoop", self.hoop.typetag_name()),
            ("radial_gas", self.radial_gas.typetag_name()),
            ("film_force", self.film_force.typetag_name()),
            ("drag", self.drag.typetag_name()),
            ("cavitation_datum", self.cavitation_datum.typetag_name()),
            ("twin_land_friction", self.twin_land_friction.typetag_name()),
        ]
    }
}

/// The running laws of the forces on rings.
#[derive(Debug)]
pub struct Laws {
    /// Ring tension.
    pub hoop: Box<dyn Hoop>,
    /// Axial gas force.
    pub axial_gas: Box<dyn AxialGas>,
    /// Radial gas load.
    pub radial_gas: Box<dyn RadialGas>,
    /// Film in the axial balance.
    pub film_force: Box<dyn FilmForce>,
    /// Friction that counts.
    pub drag: Box<dyn Drag>,
    /// Cavitation pressure.
    pub cavitation_datum: Box<dyn CavitationDatum>,
    /// Shares of running faces.
    pub twin_land_friction: Box<dyn TwinLandFriction>,
}
