//! What a case file may say. Every field's doc comment is its documentation in `gudgeon schema`.

use gudgeon_core::face::Face;
use gudgeon_core::kinds::{
    BoundaryFrictionSpec, CompressibilitySpec, ContactSpec, CylinderPressureSpec, EvaporationSpec,
    FilmTemperatureSpec, FlankFrictionSpec, FlankSpec, GasFlowSpec, HydrodynamicsSpec, KinematicsSpec,
    OilSpec, OilTransportSpec, PiezoviscositySpec, RadialMotionSpec, RingMotionSpec, RoughnessSpec,
    ShearThinningSpec,
};
use gudgeon_core::quantity::{
    Angle, Fraction, Length, NonNegative, PosAngle, PosArea, PosExpansion, PosForce, PosGasConstant,
    PosLength, PosMass, PosPressure, PosRatio, PosTemperature, PosVolume, Ratio, quantity,
};
use gudgeon_core::sets::Sets;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use crate::conventions::Conventions;
pub use crate::limits::Limits;
pub use crate::solver::RingPackSolverSpec;
use gudgeon_machine::{Engine, Piston};
use gudgeon_scene::{SolverCommon, SolverTable, case_file};

case_file! {
    /// A piston ring pack in one cylinder.
    pub struct RingPackCase {
        /// Engine.
        #[schemars(extend("required" = ["speed", "bore", "rod_length"]))]
        pub engine: Engine,
        /// Piston, from the crown down.
        #[schemars(extend("required" = ["lands"], "x-used" = ["lands", "pin_to_ring1"]))]
        pub piston: Piston,
        /// Cylinder liner.
        #[serde(default)]
        pub liner: Liner,
        /// Gas and crankcase.
        #[serde(default)]
        pub gas: Gas,
        /// Rings, from the crown down.
        #[schemars(length(max = 20))]
        pub rings: Vec<Ring>,
        /// Sub-models.
        pub models: Models,
        /// Conventions in which published programs differ. The defaults are the physically correct ones.
        #[serde(default)]
        pub conventions: Conventions,
        /// How the equations are solved.
        #[serde(default)]
        pub solver: Solver,
        /// What is wanted.
        #[serde(default)]
        pub outputs: Outputs,
    }
}

/// Cylinder liner.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Liner {
    /// Growth of the bore along the liner, thermal growth included; linear between the points.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub distortion: Vec<Distortion>,
}

/// Bore growth at one height.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Distortion {
    /// Height above the gudgeon pin at top dead centre.
    pub position: Length,
    /// Growth of the diameter.
    pub diametral: Length,
}

/// Gas and crankcase.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Gas {
    /// Ratio of specific heats.
    pub gamma: PosRatio,
    /// Specific gas constant.
    pub gas_constant: PosGasConstant,
    /// Crankcase pressure.
    pub crankcase_pressure: PosPressure,
    /// Crankcase gas temperature.
    pub crankcase_temperature: PosTemperature,
    /// Gas temperature at the blow-by meter; turns a mass flow into litres per minute.
    pub meter_temperature: PosTemperature,
    /// Pressure at the blow-by meter.
    pub meter_pressure: PosPressure,
}

impl Default for Gas {
    fn default() -> Self {
        Self {
            gamma: quantity(1.4),
            gas_constant: quantity(287.0),
            crankcase_pressure: quantity(101_325.0),
            crankcase_temperature: quantity(373.15),
            meter_temperature: quantity(298.15),
            meter_pressure: quantity(101_325.0),
        }
    }
}

/// A ring with its groove.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = Sets(include_str!("ring.json")))]
pub struct Ring {
    /// Name for reports.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Kind of ring.
    #[serde(default)]
    pub design: RingDesign,
    /// Mass of the whole ring.
    pub mass: PosMass,
    /// Axial thickness; of one rail for a three-piece oil ring.
    pub height: PosLength,
    /// Radial thickness.
    pub width: PosLength,
    /// Tangential (closing) force of the whole ring, its spring or expander included.
    pub tangential_force: PosForce,
    /// End gap in the running engine at the undistorted bore. Give this, or `cold_gap` with temperature and expansion.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gap: Option<PosLength>,
    /// End gap in the undistorted bore at 20 degC.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cold_gap: Option<PosLength>,
    /// Running temperature of the ring (closes a cold gap).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub temperature: Option<PosTemperature>,
    /// Thermal expansion coefficient of the ring (closes a cold gap).
    #[serde(default = "cast_iron_expansion")]
    pub expansion: PosExpansion,
    /// Flow area of the end gap, instead of gap times land clearance.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gap_area: Option<PosArea>,
    /// Running face.
    pub face: Face,
    /// Expander of a `three_piece` ring, whose rails then move each on its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expander: Option<Expander>,
    /// Groove.
    pub groove: Groove,
    /// Equivalent leak height between running face and liner.
    #[serde(default = "zero_nn")]
    pub face_leak: Length<NonNegative>,
    /// Models of this ring alone, instead of those of the pack.
    #[serde(default)]
    pub models: RingModels,
}

/// Kinds of ring.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RingDesign {
    /// One running face, gas behind the ring.
    #[default]
    Compression,
    /// Oil ring with two lands; slots join the space between them with that behind the ring.
    TwinLand,
    /// Two rails on an expander. With `expander` each rail is a ring of its own: the upper one seals against the upper flank of the groove, the lower one
    /// against the lower flank, and the space between them is that of the groove; results count them as two rings. Without it one rail is modelled with
    /// half the force and counted twice, without axial clearance.
    ThreePiece,
    /// The upper rail of a ring with `expander`, as the scene takes it apart.
    #[serde(skip)]
    UpperRail,
    /// The lower rail.
    #[serde(skip)]
    LowerRail,
}

/// Expander of a three-piece oil ring: the spring and spacer between its two rails.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Expander {
    /// Mass; the rest of the mass of the ring is that of both rails.
    pub mass: PosMass,
    /// Axial height of the spacer between the rails: what rails and spacer leave of the groove is their axial clearance.
    pub height: PosLength,
    /// Angle of the ears that push the rails outwards: they press each rail onto its flank with `tan(angle)` times the radial force on it. 0: no
    /// side sealing but by gas and oil. Friction between ears and rail is left out.
    pub ear_angle: Angle,
}

/// A ring groove, running dimensions.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Groove {
    /// Axial height at the outer diameter of the piston. Gives the axial clearance, unless `clearance` is given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height: Option<PosLength>,
    /// Axial clearance of the ring.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clearance: Option<PosLength>,
    /// Diameter of the groove root. Gives the volume behind the ring, unless `back_volume` is given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub root_diameter: Option<PosLength>,
    /// Volume behind the ring, axial clearance included.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub back_volume: Option<PosVolume>,
    /// Inclination of the upper flank, positive when the groove opens outwards (keystone).
    #[serde(default = "zero_angle")]
    pub upper_angle: Angle,
    /// Inclination of the lower flank.
    #[serde(default = "zero_angle")]
    pub lower_angle: Angle,
    /// Gas temperature behind the ring.
    pub temperature: PosTemperature,
    /// Whether holes or slots that need no number open the groove to the crankcase: it then has its pressure, at every speed and load. Left out, that
    /// of an oil ring is vented and that of a compression ring closed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub vented: Option<bool>,
    /// Holes or slots of a given size from the groove to the crankcase, instead of `vented`: gas that they pass is blow-by.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drain: Option<DrainHoles>,
    /// Equivalent leak height of the ring seated on the upper flank.
    #[serde(default = "zero_nn")]
    pub leak_upper: Length<NonNegative>,
    /// Equivalent leak height of the ring seated on the lower flank.
    #[serde(default = "zero_nn")]
    pub leak_lower: Length<NonNegative>,
    /// Oil-filled fraction of the flanks.
    #[serde(default = "half")]
    pub oil_fill: Ratio<Fraction>,
    /// Chamfer of the upper groove edge.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chamfer_upper: Option<ChamferShape>,
    /// Chamfer of the lower groove edge.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chamfer_lower: Option<ChamferShape>,
}

/// Holes or slots that lead to the crankcase: `holes` of a `diameter`, or an `area`.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DrainHoles {
    /// Number of holes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 1000))]
    pub holes: Option<u32>,
    /// Their diameter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub diameter: Option<PosLength>,
    /// Area of all holes and slots together.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub area: Option<PosArea>,
    /// Effective over geometric area, in place of the discharge coefficient that `gas_flow` has for the gaps of rings. 0.8: a hole drilled a few
    /// diameters deep, which loses half of a dynamic pressure at its mouth and one behind it.
    #[serde(default = "drilled")]
    pub discharge: Ratio<Fraction>,
}

/// A chamfer of a groove edge; opens an area `length² tan(angle) / 2` at the end gap of a ring seated on that side.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ChamferShape {
    /// Angle to the flank.
    pub angle: PosAngle,
    /// Radial length.
    pub length: PosLength,
}

/// Models of one ring.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RingModels {
    /// Axial motion of this ring.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ring_motion: Option<Box<dyn RingMotionSpec>>,
    /// Film of this ring.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hydrodynamics: Option<Box<dyn HydrodynamicsSpec>>,
    /// Solid contact of this ring.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact: Option<Box<dyn ContactSpec>>,
    /// Friction of the solid contact of this ring.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub boundary_friction: Option<Box<dyn BoundaryFrictionSpec>>,
    /// Roughness of this ring and the liner in the film.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub roughness: Option<Box<dyn RoughnessSpec>>,
}

/// Models of the pack.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Models {
    /// Piston motion.
    #[serde(default = "default_kinematics")]
    pub kinematics: Box<dyn KinematicsSpec>,
    /// Cylinder pressure.
    pub cylinder_pressure: Box<dyn CylinderPressureSpec>,
    /// Gas flow between lands.
    #[serde(default = "default_gas_flow")]
    pub gas_flow: Box<dyn GasFlowSpec>,
    /// Axial motion of the rings.
    #[serde(default = "default_ring_motion")]
    pub ring_motion: Box<dyn RingMotionSpec>,
    /// Motion of the rings towards the liner and off it.
    #[serde(default = "default_radial_motion")]
    pub radial_motion: Box<dyn RadialMotionSpec>,
    /// Oil between ring and groove flanks.
    #[serde(default = "default_flank")]
    pub flank: Box<dyn FlankSpec>,
    /// Friction of the groove flanks against radial motion.
    #[serde(default = "default_flank_friction")]
    pub flank_friction: Box<dyn FlankFrictionSpec>,
    /// Film under the ring faces.
    #[serde(default = "default_hydrodynamics")]
    pub hydrodynamics: Box<dyn HydrodynamicsSpec>,
    /// Flow and shear factors of rough surfaces in these films, the ring being the body; absent: smooth. The film thickness is the mean gap.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub roughness: Option<Box<dyn RoughnessSpec>>,
    /// Oil on the liner and under the faces.
    #[serde(default = "default_oil_transport")]
    pub oil_transport: Box<dyn OilTransportSpec>,
    /// Oil that evaporates from the liner above ring 1, where `oil_transport` follows it.
    #[serde(default = "default_evaporation")]
    pub evaporation: Box<dyn EvaporationSpec>,
    /// Solid contact of ring faces and liner. No default: it needs the roughness of the surfaces.
    pub contact: Box<dyn ContactSpec>,
    /// How the friction of solid contact depends on sliding speed, load and real area; absent: the coefficient of the contact model at every speed,
    /// its sign rounded over `solver.limits.friction_speed`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub boundary_friction: Option<Box<dyn BoundaryFrictionSpec>>,
    /// Lubricant.
    pub oil: Box<dyn OilSpec>,
    /// Fall of its viscosity with the shear rate; absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shear_thinning: Option<Box<dyn ShearThinningSpec>>,
    /// Rise of its viscosity with pressure; absent: none. The film model has to know it, as `gridded_face` does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub piezoviscosity: Option<Box<dyn PiezoviscositySpec>>,
    /// Rise of its density with pressure; absent: none. The film model has to know it, as `gridded_face` does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compressibility: Option<Box<dyn CompressibilitySpec>>,
    /// Temperature of the films.
    pub film_temperature: Box<dyn FilmTemperatureSpec>,
}

/// What every solver of a ring pack is told.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SolverKeys {
    /// Pressures of all lands from which the cycle is started. Each start is run to its periodic state; those that
    /// differ are reported, the first is the result. Empty: one start at crankcase pressure, and a second at 6 bar when
    /// the axial motion is decided in steps (such models have several periodic states). Where one is named or taken,
    /// `--verify` tries a second one.
    #[schemars(length(max = 100))]
    pub starts: Vec<PosPressure>,
    /// Floors, caps and drags, with their reasons.
    pub limits: Limits,
}

impl SolverCommon for SolverKeys {
    const DEFAULT: &'static str = "implicit";
    const RENAMED: &'static [(&'static str, &'static str)] = &[(
        "as_published",
        "the published schemes are methods of their own: write `method = \"substep_march\"` (zottin1992) or `method = \"degree_march\"` (tomanik1993) \
         and leave `scheme` out",
    )];
}

/// How the equations are solved.
pub type Solver = SolverTable<SolverKeys, dyn RingPackSolverSpec>;

/// What is wanted.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Outputs {
    /// Names of results; `all` for every one that the scene has. What no wanted result needs is not computed.
    pub results: Vec<String>,
    /// Crank angle between rows of the series. No result depends on it.
    pub series_step: PosAngle,
    /// Whether to tell the oil that passes each ring by the formulas of tomanik1993, for passages that are full of oil: upper limits, of use beside
    /// the source alone.
    pub oil_formulas: bool,
    /// A ring counts as on a groove flank while its distance from it is at most this share of its axial clearance, in results and
    /// events. Oil lets a ring come down ever more slowly, the gap going with the time to the power -1/2, so that it never touches; at a
    /// tenth of the clearance, the default, it rests on its film of oil. At most 0.5.
    pub seat: Ratio<Fraction>,
}

impl Default for Outputs {
    fn default() -> Self {
        Self {
            results: vec!["all".into()],
            series_step: quantity(1f64.to_radians()),
            oil_formulas: false,
            seat: quantity(0.1),
        }
    }
}

fn zero_nn() -> Length<NonNegative> {
    quantity(0.0)
}
fn zero_angle() -> Angle {
    quantity(0.0)
}
fn drilled() -> Ratio<Fraction> {
    quantity(0.8)
}
fn half() -> Ratio<Fraction> {
    quantity(0.5)
}
fn cast_iron_expansion() -> PosExpansion {
    quantity(11e-6)
}

gudgeon_core::default_model! {
    default_kinematics: dyn KinematicsSpec = "exact_slider_crank";
    default_gas_flow: dyn GasFlowSpec = "narrow_channel";
    default_ring_motion: dyn RingMotionSpec = "newton_groove";
    default_radial_motion: dyn RadialMotionSpec = "film_balance";
    default_flank: dyn FlankSpec = "wetted_strip";
    default_flank_friction: dyn FlankFrictionSpec = "off";
    default_oil_transport: dyn OilTransportSpec = "off";
    default_evaporation: dyn EvaporationSpec = "off";
    default_hydrodynamics: dyn HydrodynamicsSpec = "closed_form_face";
    default_solver: dyn RingPackSolverSpec = "implicit";
}
