//! What a case of the scene `pin` may say.

use gudgeon_core::kinds::{
    BossBore, FatigueSpec, PinLoadSpec, PinQuantity, PinStrengthSpec, ProfileCurveSpec,
};
use gudgeon_core::quantity::{
    Fraction, Length, NonNegative, PosDensity, PosExpansion, PosLength, PosPressure, PosRatio,
    PosTemperature, PosVolume, Ratio, quantity,
};
use gudgeon_core::sets::Sets;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use gudgeon_machine::{Engine, Piston};
use gudgeon_scene::case_file;

case_file! {
    /// Design of a gudgeon pin and of the piston around it. Give any of `pin`, `skirt`, `crown` and `dimensions`.
    pub struct PinCase {
        /// Engine, whose bore is the nominal diameter of the piston.
        #[schemars(extend("x-used" = ["bore"]))]
        pub engine: Engine,
        /// Piston.
        #[serde(default)]
        #[schemars(extend("x-used" = ["alloy", "apparent_density"]))]
        pub piston: Piston,
        /// Gudgeon pin: evaluated as it stands, or the start of `optimise`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub pin: Option<Pin>,
        /// Greatest admitted values.
        #[serde(default)]
        pub limits: Limits,
        /// The lightest pin that keeps the limits.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub optimise: Option<Optimise>,
        /// Clearance, profile and ovality of the skirt.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub skirt: Option<Skirt>,
        /// Recess in the crown.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub crown: Option<Crown>,
        /// Main dimensions, beside the guide.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub dimensions: Option<Dimensions>,
        /// Sub-models.
        #[serde(default)]
        pub models: Models,
        /// Constants in which a published program differs.
        #[serde(default)]
        pub conventions: Conventions,
    }
}

/// Gudgeon pin.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = Sets(include_str!("pin.json")))]
pub struct Pin {
    /// Length. Needed to evaluate a pin and to start the published search.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length: Option<PosLength>,
    /// Outer diameter. Needed like the length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outer: Option<PosLength>,
    /// Inner diameter, 0 for a solid pin. Needed like the length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inner: Option<Length<NonNegative>>,
    /// Free distance between the piston bosses.
    pub boss_gap: PosLength,
    /// Width of the small end of the connecting rod.
    pub rod_width: PosLength,
    /// Form of the bore of the bosses.
    #[serde(default)]
    pub boss_bore: BossBore,
    /// Young's modulus.
    #[serde(default = "steel_modulus")]
    pub modulus: PosPressure,
    /// Poisson's ratio.
    #[serde(default = "steel_poisson")]
    pub poisson: Ratio<Fraction>,
    /// Density.
    #[serde(default = "steel_density")]
    pub density: PosDensity,
    /// Whether the pin turns slowly in its bores, so that every fibre sees its stress in both signs.
    #[serde(default)]
    pub turns: bool,
    /// Flats cut from the sides of the piston beyond the ends of the pin; their mass is weighed against the pin's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub relief: Option<ReliefCase>,
}

/// Flats on the sides of the piston.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ReliefCase {
    /// Height of the flats.
    pub height: PosLength,
    /// Density of the piston; that of its alloy when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density: Option<PosDensity>,
}

fn steel_modulus() -> PosPressure {
    quantity(206e9)
}
fn steel_poisson() -> Ratio<Fraction> {
    quantity(0.3)
}
fn steel_density() -> PosDensity {
    quantity(7850.0)
}

/// Greatest admitted values; what is not given is not limited.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Limits {
    /// Mean pressure in the bosses.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub boss_pressure: Option<PosPressure>,
    /// Shortening of the diameter under the load.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ovalisation: Option<PosLength>,
    /// Deflection of the middle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub deflection: Option<PosLength>,
    /// Mean pressure in the small end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rod_pressure: Option<PosPressure>,
    /// Longitudinal bending stress.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bending_stress: Option<PosPressure>,
    /// Hoop stress from ovalisation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ovalisation_stress: Option<PosPressure>,
    /// Transverse shear stress.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shear_stress: Option<PosPressure>,
    /// Resultant of both bending stresses.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub resultant_stress: Option<PosPressure>,
}

impl Limits {
    /// In the order of [`PinQuantity::ALL`]; infinite where nothing is limited.
    #[must_use]
    pub fn values(&self) -> [f64; 8] {
        let p = |v: Option<PosPressure>| v.map_or(f64::INFINITY, PosPressure::si);
        let l = |v: Option<PosLength>| v.map_or(f64::INFINITY, PosLength::si);
        [
            p(self.boss_pressure),
            l(self.ovalisation),
            l(self.deflection),
            p(self.rod_pressure),
            p(self.bending_stress),
            p(self.ovalisation_stress),
            p(self.shear_stress),
            p(self.resultant_stress),
        ]
    }
}

/// Search for the lightest pin.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(extend("x-renamed" = { "least_wall": "min_wall" }))]
pub struct Optimise {
    /// How it is searched.
    pub method: Method,
    /// Admitted lengths; from the gap between the bosses to the piston diameter when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length: Option<RangeCase>,
    /// Admitted outer diameters; from 0.15 to 0.5 of the piston diameter when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outer: Option<RangeCase>,
    /// Admitted inner diameters; any when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inner: Option<RangeCase>,
    /// Thinnest wall.
    pub min_wall: Length<NonNegative>,
    /// Half widths of the tolerances: limits are kept in every corner.
    pub tolerance: Tolerance,
    /// Sizes that can be had; the lightest pin of these is searched too.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stock: Option<Stock>,
    /// Limits over which the lightest pin is drawn (Pareto front): the limit goes from 0.7 to 1.3 of its value.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub pareto: Vec<PinQuantity>,
    /// Outer diameters of the sweep, over the admitted range; 0 for none.
    #[schemars(range(max = 5000))]
    pub sweep_points: u32,
    /// Gap, over the pin's mass, to which it is proved that no lighter pin exists anywhere in the ranges.
    pub certificate: PosRatio,
    /// Steps of the published search.
    pub steps: StepsCase,
}

impl Default for Optimise {
    fn default() -> Self {
        Self {
            method: Method::Exact,
            length: None,
            outer: None,
            inner: None,
            min_wall: quantity(0.0),
            tolerance: Tolerance::default(),
            stock: None,
            pareto: Vec::new(),
            sweep_points: 86,
            certificate: quantity(1e-6),
            steps: StepsCase::default(),
        }
    }
}

/// Searches.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Exact optimum of length and both diameters, with its proof.
    #[default]
    Exact,
    /// The published search at the outer diameter of `pin`: raise the length, then reduce the bore, by steps.
    AsPublished,
}

/// From and to.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RangeCase {
    /// Smallest value.
    pub from: Length<NonNegative>,
    /// Greatest value; equal to `from` where the dimension is given.
    pub to: PosLength,
}

/// Half widths of tolerances.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Tolerance {
    /// Of the length.
    pub length: Length<NonNegative>,
    /// Of the outer diameter.
    pub outer: Length<NonNegative>,
    /// Of the inner diameter.
    pub inner: Length<NonNegative>,
}

impl Default for Tolerance {
    fn default() -> Self {
        Self { length: quantity(0.0), outer: quantity(0.0), inner: quantity(0.0) }
    }
}

/// Sizes that can be had. A dimension without sizes stays free.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Stock {
    /// Outer diameters.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub outer: Vec<PosLength>,
    /// Inner diameters.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub inner: Vec<Length<NonNegative>>,
    /// The length is a multiple of this.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length_step: Option<PosLength>,
}

/// Steps of the published search.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct StepsCase {
    /// Rise of the length.
    pub length: PosLength,
    /// Coarse reduction of the bore.
    pub coarse: PosLength,
    /// Fine reduction of the bore.
    pub fine: PosLength,
    /// Numbers as the original computer kept them.
    pub arithmetic: Arithmetic,
}

impl Default for StepsCase {
    fn default() -> Self {
        Self {
            length: quantity(0.1e-3),
            coarse: quantity(0.1e-3),
            fine: quantity(0.005e-3),
            arithmetic: Arithmetic::Double,
        }
    }
}

/// Accumulation of length and bore.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Arithmetic {
    /// Double precision.
    #[default]
    Double,
    /// A mantissa of 32 bits, in millimetres: the original computer.
    Mantissa32,
}

/// Skirt.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Skirt {
    /// Height of the skirt. Stations stand at 0, 0.25, 0.5, 0.82 and 0.94 of it, from the open end.
    pub height: PosLength,
    /// Temperature of the piston at the stations, open end first.
    pub temperatures: [PosTemperature; 5],
    /// Thermal expansion of the piston at the stations; that of its alloy when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expansions: Option<[PosExpansion; 5]>,
    /// Wanted clearance of the warm piston at the stations, on the diameter.
    pub wanted_clearances: [Length; 5],
    /// Temperature of the cylinder.
    pub cylinder_temperature: PosTemperature,
    /// Thermal expansion of the cylinder.
    #[serde(default = "cast_iron")]
    pub cylinder_expansion: PosExpansion,
    /// Temperature at assembly.
    #[serde(default = "room")]
    pub assembly_temperature: PosTemperature,
    /// Clearance at assembly, on the diameter.
    pub assembly_clearance: Length,
    /// What the published program takes from the deviations for its "reference values".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference_offset: Option<Length>,
    /// Ordinates of the profile at the stations, on the diameter, negative where material is removed; the program's proposal when
    /// absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ordinates: Option<[Length; 5]>,
    /// Distance of the rows of the profile.
    #[serde(default = "row_step")]
    pub step: PosLength,
    /// Area of the round skirt over that of the oval one, less one; `0.0055` is 5.5 per mille. A guide: 3 per mille for plain pistons of
    /// aspirated engines, 3 to 4 turbocharged, 4 to 7 with controlled expansion.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub surface_ratio: Option<PosRatio>,
}

fn cast_iron() -> PosExpansion {
    quantity(11e-6)
}
fn room() -> PosTemperature {
    quantity(293.15)
}
fn row_step() -> PosLength {
    quantity(2e-3)
}

/// Spherical recess in the crown. Give its `depth` or its `volume`.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Crown {
    /// Radius of the sphere.
    pub radius: PosLength,
    /// Depth of the recess.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub depth: Option<PosLength>,
    /// Volume of the recess.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub volume: Option<PosVolume>,
    /// Stroke, for the clearance volume.
    pub stroke: PosLength,
    /// Compression ratio wanted with the recess.
    pub compression_ratio: PosRatio,
    /// Volume of the recess that the compression ratio counts with.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub nominal_volume: Option<PosVolume>,
}

/// Adopted main dimensions, each beside the guide of practice.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Dimensions {
    /// Total height.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub total_height: Option<PosLength>,
    /// Crown to first groove.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub top_land: Option<PosLength>,
    /// Wall between first and second groove.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub first_wall: Option<PosLength>,
    /// Thickness of the crown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub crown_thickness: Option<PosLength>,
    /// Pin axis to crown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub compression_height: Option<PosLength>,
    /// Height of the skirt.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub skirt_height: Option<PosLength>,
}

impl Dimensions {
    /// In the order of [`gudgeon_pin::piston::GUIDES`].
    #[must_use]
    pub fn values(&self) -> [Option<f64>; 6] {
        [
            self.total_height,
            self.top_land,
            self.first_wall,
            self.crown_thickness,
            self.compression_height,
            self.skirt_height,
        ]
        .map(|v| v.map(PosLength::si))
    }
}

/// Sub-models.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Models {
    /// Force on the pin. Needed with `pin`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pin_load: Option<Box<dyn PinLoadSpec>>,
    /// Strength of the pin.
    pub pin_strength: Box<dyn PinStrengthSpec>,
    /// Fatigue of the pin over the cycle.
    pub fatigue: Box<dyn FatigueSpec>,
    /// Curve through the ordinates of the skirt.
    pub profile_curve: Box<dyn ProfileCurveSpec>,
}

impl Default for Models {
    fn default() -> Self {
        Self {
            pin_load: None,
            pin_strength: default_pin_strength(),
            fatigue: default_fatigue(),
            profile_curve: default_profile_curve(),
        }
    }
}

/// Constants in which a published program differs.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Conventions {
    /// Ratio of circumference to diameter; the program of reimer1984 has 3.14159267.
    pub circle_ratio: PosRatio,
}

impl Default for Conventions {
    fn default() -> Self {
        Self { circle_ratio: quantity(std::f64::consts::PI) }
    }
}

gudgeon_core::default_model! {
    default_pin_strength: dyn PinStrengthSpec = "thin_ring";
    default_fatigue: dyn FatigueSpec = "off";
    default_profile_curve: dyn ProfileCurveSpec = "monotone_cubic";
}
