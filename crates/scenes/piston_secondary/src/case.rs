//! What a case of the scene `piston_secondary` may say.

use gudgeon_core::kinds::{
    BoundaryFrictionSpec, ContactSpec, CylinderPressureSpec, Film2dSpec, GrooveFrictionSpec, KinematicsSpec,
    OilSpec, PinFrictionSpec, RoughnessSpec, SecondaryMotionSpec, ShearThinningSpec, SkirtComplianceSpec,
    SkirtOilSpec, SkirtProfileSpec,
};
use gudgeon_core::quantity::{
    Angle, Length, NonNegative, PosAngle, PosExpansion, PosInertia, PosLength, PosMass, PosPressure,
    PosRatio, PosTemperature, PosTime, Pressure, Ratio, quantity,
};
use gudgeon_core::sets::Sets;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use crate::solver::PistonSolverSpec;
use gudgeon_machine::{Engine, Piston};
use gudgeon_scene::{SolverCommon, SolverTable, case_file};

case_file! {
    /// The lateral motion and the tilt of a piston in its bore.
    pub struct PistonSecondaryCase {
        /// Crank drive.
        #[schemars(extend("required" = ["speed", "bore", "rod_length"]))]
        pub engine: Engine,
        /// Piston and pin.
        #[schemars(extend(
            "required" = ["mass", "inertia", "pin_mass", "pin_depth", "gravity_depth"],
            "x-used" = ["mass", "inertia", "pin_mass", "pin_depth", "gravity_depth", "gravity_offset", "gravity_side", "gravity_from"],
        ))]
        pub piston: Piston,
        /// Connecting rod; without mass when absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub rod: Option<Rod>,
        /// Skirt.
        pub skirt: Skirt,
        /// Crankcase.
        #[serde(default)]
        pub gas: Gas,
        /// Sub-models.
        pub models: Models,
        /// How the equations are solved.
        #[serde(default)]
        pub solver: Solver,
        /// What is wanted.
        #[serde(default)]
        pub outputs: Outputs,
    }
}

/// Connecting rod.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rod {
    /// Mass.
    pub mass: PosMass,
    /// Distance of its centre of gravity from the gudgeon pin.
    pub gravity_distance: Length<NonNegative>,
    /// Moment of inertia about its centre of gravity.
    pub inertia: PosInertia,
}

/// Skirt.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Skirt {
    /// Radius; that of the bore less the clearance when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius: Option<PosLength>,
    /// Height from the upper to the lower edge.
    pub length: PosLength,
    /// Angle that the thrust side covers to the left and to the right of its middle, below 90 degrees.
    pub half_angle_thrust: PosAngle,
    /// The same of the anti-thrust side; that of the thrust side when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub half_angle_anti_thrust: Option<PosAngle>,
    /// Radial clearance: in the running engine, or cold with `thermal`.
    pub clearance: PosLength,
    /// Thermal growth that changes a cold clearance.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thermal: Option<Thermal>,
    /// Temperature of the oil.
    #[serde(default = "warm")]
    pub oil_temperature: PosTemperature,
    /// Film that smooth surfaces cannot squeeze out. Models of rough surfaces have a limit of their own.
    #[serde(default = "film_floor")]
    pub film_floor: PosLength,
}

/// Thermal growth of skirt and bore.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = Sets(include_str!("thermal.json")))]
pub struct Thermal {
    /// Temperature of the skirt.
    pub skirt: PosTemperature,
    /// Temperature of the bore.
    pub bore: PosTemperature,
    /// Temperature at which the clearance was measured.
    #[serde(default = "room")]
    pub measured_at: PosTemperature,
    /// Expansion coefficient of the skirt.
    #[serde(default = "aluminium")]
    pub skirt_expansion: PosExpansion,
    /// Expansion coefficient of the bore.
    #[serde(default = "cast_iron")]
    pub bore_expansion: PosExpansion,
}

/// Crankcase.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Gas {
    /// Pressure in the crankcase, and at all edges of the skirt.
    pub crankcase_pressure: PosPressure,
    /// Pressure at which films cavitate; that of the crankcase when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cavitation_pressure: Option<Pressure>,
}

impl Default for Gas {
    fn default() -> Self {
        Self { crankcase_pressure: quantity(101_325.0), cavitation_pressure: None }
    }
}

/// Sub-models.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Models {
    /// Piston motion along the bore.
    #[serde(default = "default_kinematics")]
    pub kinematics: Box<dyn KinematicsSpec>,
    /// Cylinder pressure.
    pub cylinder_pressure: Box<dyn CylinderPressureSpec>,
    /// Motion across the bore.
    #[serde(default = "default_secondary_motion")]
    pub secondary_motion: Box<dyn SecondaryMotionSpec>,
    /// Film of either side. `half_sommerfeld` and `full_sommerfeld` cavitation is found by superposition, much faster than the others.
    #[serde(default = "default_film_2d")]
    pub film_2d: Box<dyn Film2dSpec>,
    /// Rough or wavy surfaces; the skirt is the body.
    #[serde(default = "default_roughness")]
    pub roughness: Box<dyn RoughnessSpec>,
    /// Solid contact of skirt and liner. No default: it needs the roughness of the surfaces.
    pub contact: Box<dyn ContactSpec>,
    /// How its friction depends on sliding speed, load and real area; absent: the coefficient of the contact model at every speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub boundary_friction: Option<Box<dyn BoundaryFrictionSpec>>,
    /// Shape of the skirt.
    #[serde(default = "default_skirt_profile")]
    pub skirt_profile: Box<dyn SkirtProfileSpec>,
    /// How the skirt yields.
    #[serde(default = "default_skirt_compliance")]
    pub skirt_compliance: Box<dyn SkirtComplianceSpec>,
    /// Where the oil of the skirt comes from, and whether its films keep it. Films that keep it need a `film_2d` with `mass_conserving` cavitation.
    #[serde(default = "default_skirt_oil")]
    pub skirt_oil: Box<dyn SkirtOilSpec>,
    /// Friction of the gudgeon pin.
    #[serde(default = "default_pin_friction")]
    pub pin_friction: Box<dyn PinFrictionSpec>,
    /// Friction of the rings in their grooves.
    #[serde(default = "default_groove_friction")]
    pub groove_friction: Box<dyn GrooveFrictionSpec>,
    /// Lubricant.
    pub oil: Box<dyn OilSpec>,
    /// Fall of its viscosity with the shear rate of sliding.
    #[serde(default = "default_shear_thinning")]
    pub shear_thinning: Box<dyn ShearThinningSpec>,
}

/// What every solver of a piston in its bore is told.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SolverKeys {
    /// Distance from the periodic motion that is admitted, as part of the clearance.
    #[schemars(extend("x-refine" = { "group": "tolerance", "factor": 0.1 }))]
    pub periodicity: PosRatio,
    /// Most cycles of the search for the periodic motion.
    #[schemars(range(max = 1000))]
    pub max_cycles: u32,
    /// This many cycles from the start, the last one shown, whether or not it is periodic; 0: until the motion is periodic.
    #[schemars(range(max = 1000))]
    pub cycles: u32,
    /// Film evaluations after which a search is given up, ten to twenty seconds on 20 x 16 intervals; each search of a run (rigid, coarse, the skirt as
    /// it is) counts its own. A motion takes some thousand where its films follow by superposition, some hundred thousand where they do not.
    #[schemars(range(max = 1_000_000_000))]
    pub max_film_evaluations: u64,
    /// Displacement of the upper edge at the start, towards the anti-thrust side.
    pub start_top: Length,
    /// Displacement of the lower edge at the start.
    pub start_bottom: Length,
    /// Intervals of the film along the height of the skirt.
    #[schemars(range(min = 2, max = 1000), extend("x-refine" = { "group": "film grid", "factor": 2, "levels": 2 }))]
    pub intervals_along: u32,
    /// Intervals of the film across each side. With an even number, one half of a symmetric side is solved.
    #[schemars(range(min = 2, max = 1000), extend("x-refine" = { "group": "film grid", "factor": 2, "levels": 2 }))]
    pub intervals_across: u32,
    /// How much closer nodes lie at half the height than in the mean, 0 to 0.5; below 0, to -0.5, they lie closer at both edges: with -0.5 the first of `n` intervals
    /// is `3/n²` of the height. A skirt that touches with an edge has its highest pressure beside it.
    pub crowding: Ratio,
    /// Distance of the rows in which solid contact is summed, the first one at the upper edge: the pitch of machining grooves.
    pub contact_pitch: PosLength,
    /// Intervals of a row.
    #[schemars(range(min = 2, max = 1000), extend("x-refine" = { "group": "contact grid", "factor": 2 }))]
    pub contact_intervals: u32,
    /// Part of the gap by which the pressures on a rigid skirt may move the surface of one that yields for it to be taken for rigid; 0: never.
    pub rigid_below: Ratio<NonNegative>,
    /// Time in which an elastic shape without load comes back to rest: a little inner damping, without which nothing would hold a surface under
    /// a cavity. What yields lags by it behind its pressure, 0.015 deg of crank angle at 2500 rpm by the default.
    pub shape_relaxation: PosTime,
}

impl Default for SolverKeys {
    fn default() -> Self {
        Self {
            periodicity: quantity(1e-4),
            max_cycles: 60,
            cycles: 0,
            max_film_evaluations: 300_000,
            start_top: quantity(0.0),
            start_bottom: quantity(0.0),
            intervals_along: 20,
            intervals_across: 16,
            crowding: quantity(0.0),
            contact_pitch: quantity(0.25e-3),
            contact_intervals: 20,
            rigid_below: quantity(0.02),
            shape_relaxation: quantity(1e-6),
        }
    }
}

impl SolverCommon for SolverKeys {
    const DEFAULT: &'static str = "implicit";
    const RENAMED: &'static [(&'static str, &'static str)] = &[(
        "as_published",
        "the published scheme cannot run: an explicit method on accelerations behind a 500 Hz low-pass diverges within five degrees of crank angle, \
         for the films damp the motion at 1e6 to 5e7 1/s; use `implicit`, or `backward_euler` for the simplest scheme that can",
    )];
}

/// How the equations are solved.
pub type Solver = SolverTable<SolverKeys, dyn PistonSolverSpec>;

/// What is wanted.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Outputs {
    /// Names of results; `all` for every one that the scene has. What no wanted result needs is not computed.
    pub results: Vec<String>,
    /// Crank angle between rows of the series. Results do not depend on it.
    pub series_step: PosAngle,
    /// Crank angles at which positions and forces are results of their own: `e_top@390`, `side_force@390`, …
    #[schemars(length(max = 1000))]
    pub at: Vec<Angle>,
    /// Crank angle between the maps of film pressure that are kept; they are not kept when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub map_step: Option<PosAngle>,
}

impl Default for Outputs {
    fn default() -> Self {
        Self {
            results: vec!["all".into()],
            series_step: quantity(1f64.to_radians()),
            at: Vec::new(),
            map_step: Some(quantity(5f64.to_radians())),
        }
    }
}

fn warm() -> PosTemperature {
    quantity(373.15)
}
fn room() -> PosTemperature {
    quantity(293.15)
}
fn film_floor() -> PosLength {
    quantity(1e-7)
}
fn aluminium() -> PosExpansion {
    quantity(21e-6)
}
fn cast_iron() -> PosExpansion {
    quantity(11e-6)
}

gudgeon_core::default_model! {
    default_kinematics: dyn KinematicsSpec = "exact_slider_crank";
    default_secondary_motion: dyn SecondaryMotionSpec = "quasi_static";
    default_roughness: dyn RoughnessSpec = "off";
    default_skirt_profile: dyn SkirtProfileSpec = "cylindrical";
    default_skirt_compliance: dyn SkirtComplianceSpec = "rigid";
    default_skirt_oil: dyn SkirtOilSpec = "off";
    default_pin_friction: dyn PinFrictionSpec = "off";
    default_groove_friction: dyn GrooveFrictionSpec = "off";
    default_shear_thinning: dyn ShearThinningSpec = "off";
    default_solver: dyn PistonSolverSpec = "implicit";
}

fn default_film_2d() -> Box<dyn Film2dSpec> {
    let spec = serde_json::json!({ "model": "direct", "cavitation": "half_sommerfeld" });
    match gudgeon_core::spec::model((&spec).into()) {
        Ok(m) => m,
        Err(e) => panic!("built-in default `direct`: {e}"),
    }
}
