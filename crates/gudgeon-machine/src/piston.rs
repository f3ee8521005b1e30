//! Piston and pin.

use gudgeon_core::BuildError;
use gudgeon_core::quantity::{
    Length, NonNegative, PosDensity, PosInertia, PosLength, PosMass, PosTemperature, PosVolume,
};
use gudgeon_core::sets::Sets;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::engine::given;

/// Piston, from the crown down.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = Sets(include_str!("piston.json")))]
pub struct Piston {
    /// Lands above each ring, top land first: as many as there are rings.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 20))]
    pub lands: Vec<Land>,
    /// Height of the middle of ring 1 above the gudgeon pin. Needed when the liner is distorted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pin_to_ring1: Option<Length>,
    /// Mass of the piston without pin.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass: Option<PosMass>,
    /// Moment of inertia of the piston about its centre of gravity, for tilting.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inertia: Option<PosInertia>,
    /// Mass of the pin.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pin_mass: Option<PosMass>,
    /// Depth of the pin below the upper edge of the skirt.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pin_depth: Option<Length>,
    /// Depth of the centre of gravity below the upper edge of the skirt.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gravity_depth: Option<Length>,
    /// Distance of the centre of gravity of the piston across the bore, from what `gravity_from` says; 0 when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gravity_offset: Option<Length<NonNegative>>,
    /// On which side of it; `anti_thrust` when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gravity_side: Option<GravitySide>,
    /// What `gravity_offset` is measured from; the `pin` when absent. A sweep of `engine.pin_offset` with `bore` moves the pin alone; with `pin` it moves the centre of gravity as well.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gravity_from: Option<GravityFrom>,
    /// Alloy, which gives density and thermal expansion where they are not given: `m124_cast`, `m124_forged`, `m138_cast`, …
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub alloy: Option<String>,
    /// Mass over the cube of the diameter, for the estimate of the piston's mass; 0.55 g/cm3, that of light pistons, when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub apparent_density: Option<PosDensity>,
}

/// A piston land, running (hot) dimensions.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Land {
    /// Diameter. Give this or `clearance`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub diameter: Option<PosLength>,
    /// Radial clearance to the bore. Give this or `diameter`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clearance: Option<PosLength>,
    /// Axial height. Gives the gas volume with the clearance, unless `volume` is given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height: Option<PosLength>,
    /// Gas volume.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub volume: Option<PosVolume>,
    /// Gas temperature (that of the piston surface).
    pub temperature: PosTemperature,
}

/// What the distance of the centre of gravity across the bore is measured from.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum GravityFrom {
    /// From the axis of the pin, as Loureiro (2009) and Zhu (1992) give it.
    #[default]
    Pin,
    /// From the axis of the bore, as a drawing of the piston gives it: the distance from the pin is this less the pin offset.
    Bore,
}

/// The side on which the centre of gravity stands: a fact of the piston, to be read off its drawing. Most pistons are nearly symmetric, and their centre stands within some tenths of a millimetre of the axis of the bore.
/// Loureiro (2009) gives the distance alone, and none of the two sides meets all his figures.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum GravitySide {
    /// Towards the anti-thrust side: between a pin offset to the thrust side and the axis of the bore (the source's `s_G = -1`). The inertia of
    /// the piston along the bore counteracts the moment of the gas about the pin. The EA111 piston is periodic within 8 cycles, its upper edge
    /// crosses to the anti-thrust side about firing top dead centre, and lower waves drag less, as in the source; the motored piston of Zhu rests
    /// on the wrong side.
    #[default]
    AntiThrust,
    /// Towards the thrust side, beyond a pin offset to that side (`s_G = +1`: the source's equation 59 with its own sign of the inertia
    /// force). Both moments add. The motored piston rests on the side of the source. The mean lateral position of the EA111 piston restores itself over
    /// some 20 cycles, passes the source's values near his fourth one, and ends nearer to the thrust side with half as much friction again; lower
    /// waves then drag more.
    Thrust,
}

/// Masses of a piston and where they are, depths counted from the upper edge of the skirt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// Mass of the piston without pin \[kg\].
    pub mass: f64,
    /// Moment of inertia of the piston about its centre of gravity \[kg m²\].
    pub inertia: f64,
    /// Mass of the pin \[kg\].
    pub pin_mass: f64,
    /// Depth of the pin \[m\].
    pub pin_depth: f64,
    /// Depth of the centre of gravity \[m\].
    pub gravity_depth: f64,
    /// Distance of the centre of gravity from the pin \[m\], towards the thrust side positive.
    pub gravity_offset: f64,
}

/// Mass over the cube of the diameter of a light piston \[kg/m³\] (Reimer 1984).
const LIGHT: f64 = 550.0;

impl Piston {
    /// Masses and where they are, with the pin `pin_offset` \[m\] from the axis of the bore, towards the thrust side positive.
    ///
    /// # Errors
    /// The key that is missing: `mass`, `inertia`, `pin_mass`, `pin_depth` or `gravity_depth`.
    pub fn body(&self, pin_offset: f64) -> Result<Body, BuildError> {
        let side = match self.gravity_side() {
            GravitySide::Thrust => 1.0,
            GravitySide::AntiThrust => -1.0,
        };
        let from = match self.gravity_from.unwrap_or_default() {
            GravityFrom::Pin => 0.0,
            GravityFrom::Bore => -pin_offset,
        };
        Ok(Body {
            mass: given(self.mass, "piston", "mass")?.si(),
            inertia: given(self.inertia, "piston", "inertia")?.si(),
            pin_mass: given(self.pin_mass, "piston", "pin_mass")?.si(),
            pin_depth: given(self.pin_depth, "piston", "pin_depth")?.si(),
            gravity_depth: given(self.gravity_depth, "piston", "gravity_depth")?.si(),
            gravity_offset: side * self.gravity_offset.map_or(0.0, |d| d.si()) + from,
        })
    }

    /// The side on which the centre of gravity stands.
    #[must_use]
    pub fn gravity_side(&self) -> GravitySide {
        self.gravity_side.unwrap_or_default()
    }

    /// Mass over the cube of the diameter \[kg/m³\].
    #[must_use]
    pub fn apparent_density(&self) -> f64 {
        self.apparent_density.map_or(LIGHT, |d| d.si())
    }
}
