//! What a case of the scene `shaft_line` may say.

use gudgeon_core::kinds::{
    CouplingSpec, CylinderPressureSpec, DriveSpec, KinematicsSpec, NaturalFrequenciesSpec, Obliquity,
    ThrowInertiaSpec, TorsionSpec,
};
use gudgeon_core::quantity::{
    Angle, AngularSpeed, Fraction, Inertia, Length, Mass, NonNegative, PosAngularSpeed, PosInertia,
    PosLength, PosPressure, PosRatio, PosTime, PosTorque, Power, Ratio, TorsionalDamping, TorsionalStiffness,
    quantity,
};
use gudgeon_core::sets::Sets;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use gudgeon_scene::case_file;

case_file! {
    /// A shaft line of a compressor, an engine or anything else that twists.
    pub struct ShaftLineCase {
        /// Mean speed of the reference shaft, that of inertias with ratio 1.
        pub speed: PosAngularSpeed,
        /// Name of the inertia on which the torque acts that holds the mean speed. Without it the drives give that torque; without a
        /// drive the cylinders of an engine that has loads, by their mean gas torque; without either all inertias by their size, as in a
        /// line that speeds up.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub balance_at: Option<String>,
        /// File in openTorsion's TORS format whose inertias and shafts come before those given here.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub tors: Option<String>,
        /// Inertias.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        #[schemars(length(max = 2000))]
        pub inertias: Vec<InertiaCase>,
        /// Shafts, couplings and gear meshes between them.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        #[schemars(length(max = 2000))]
        pub shafts: Vec<ShaftCase>,
        /// Dampers, each an inertia on a link of its own.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        #[schemars(length(max = 2000))]
        pub dampers: Vec<DamperCase>,
        /// Crank throws.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        #[schemars(length(max = 2000))]
        pub throws: Vec<ThrowCase>,
        /// Motors, loads and given torques.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        #[schemars(length(max = 2000))]
        pub drives: Vec<DriveCase>,
        /// Sub-models.
        #[serde(default)]
        pub models: Models,
        /// Conventions of a published program. The defaults are the physically correct ones.
        #[serde(default)]
        pub conventions: Conventions,
        /// Orders and speeds that are looked at.
        #[serde(default)]
        pub range: Range,
        /// Speeds at which the line runs: limits are judged over all of them.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub operating: Option<Operating>,
        /// Load steps: limits are judged in each.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        pub load_steps: Vec<LoadStepCase>,
        /// Start and length of a motion over time.
        #[serde(default)]
        pub time: Option<TimeCase>,
        /// Limits that results are held against.
        #[serde(default)]
        pub limits: Limits,
        /// What is wanted.
        #[serde(default)]
        pub outputs: Outputs,
    }
}

/// An inertia.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InertiaCase {
    /// Name, by which shafts, throws and drives find it.
    pub name: String,
    /// Moment of inertia; throws on it add theirs.
    #[serde(default = "no_inertia")]
    pub inertia: Inertia<NonNegative>,
    /// Damping against the ground.
    #[serde(default = "no_damping")]
    pub damping: TorsionalDamping<NonNegative>,
    /// Stiffness against the ground, for lines that are held.
    #[serde(default = "no_stiffness")]
    pub ground: TorsionalStiffness<NonNegative>,
    /// Speed by that of the reference shaft; negative where a gear turns it round.
    #[serde(default = "one")]
    pub ratio: Ratio,
}

/// What joins two inertias.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShaftCase {
    /// Name for reports; otherwise `shaft` and its number.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Name of the inertia that drives when the torque is positive.
    pub from: String,
    /// Name of the other one. Where their speed ratios differ this is a gear mesh.
    pub to: String,
    /// Stiffness. Give this, or `pieces`, or `coupling`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<TorsionalStiffness<NonNegative>>,
    /// Cylindrical pieces one after the other, which give the stiffness and the stress.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pieces: Vec<PieceCase>,
    /// Any law of torque, instead of stiffness and damping.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coupling: Option<Box<dyn CouplingSpec>>,
    /// Viscous damping between the two ends.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping: Option<TorsionalDamping<NonNegative>>,
    /// Loss factor of the stiffness.
    #[serde(default = "no_ratio")]
    pub loss_factor: Ratio<NonNegative>,
    /// Shear modulus, for `pieces`.
    #[serde(default = "steel")]
    pub shear_modulus: PosPressure,
    /// Outer diameter where the stress is wanted; without it the weakest of the pieces counts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub diameter: Option<PosLength>,
    /// Bore there.
    #[serde(default = "no_length")]
    pub bore: Length<NonNegative>,
    /// Stress concentration factor on the nominal shear stress.
    #[serde(default = "one_pos")]
    pub stress_concentration: PosRatio,
}

/// A cylindrical piece of a shaft.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PieceCase {
    /// Length.
    pub length: PosLength,
    /// Outer diameter.
    pub diameter: PosLength,
    /// Diameter of the bore.
    #[serde(default = "no_length")]
    pub bore: Length<NonNegative>,
}

/// A damper: an inertia that is joined to one of the line.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DamperCase {
    /// Name of its inertia.
    pub name: String,
    /// Name of the inertia it sits on.
    pub at: String,
    /// Its moment of inertia.
    pub inertia: PosInertia,
    /// Stiffness of a tuned damper; zero for a viscous one.
    #[serde(default = "no_stiffness")]
    pub stiffness: TorsionalStiffness<NonNegative>,
    /// Viscous damping.
    #[serde(default = "no_damping")]
    pub damping: TorsionalDamping<NonNegative>,
    /// Any law of torque, instead of stiffness and damping.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coupling: Option<Box<dyn CouplingSpec>>,
}

/// Equal throws on one or several inertias.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = Sets(include_str!("throw.json")))]
pub struct ThrowCase {
    /// Names of the inertias.
    pub at: Vec<String>,
    /// Angle of each crank when the shaft is at zero, counted from the outer dead centre of that throw's own cylinder in the direction of
    /// rotation; empty: all zero. The two throws of a balanced-opposed pair have the same value, although their cranks stand 180 degrees apart: both
    /// pistons are at outer dead centre together. The report prints the shaft angle at which each piston is there.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub phases: Vec<Angle>,
    /// Crank radius.
    pub crank_radius: PosLength,
    /// Rod length between centres.
    pub rod_length: PosLength,
    /// Offset of the pin's line of motion from the crank axis.
    #[serde(default = "no_offset")]
    pub offset: Length,
    /// Inertia of the crank of one throw about its axis.
    #[serde(default = "no_inertia")]
    pub crank_inertia: Inertia<NonNegative>,
    /// Rod mass.
    #[serde(default = "no_mass")]
    pub rod_mass: Mass<NonNegative>,
    /// Distance of the rod's mass centre from the big end, by the rod length.
    #[serde(default = "third")]
    pub rod_centre: Ratio<Fraction>,
    /// Inertia of the rod about its mass centre; without it that of its two masses.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rod_inertia: Option<Inertia<NonNegative>>,
    /// Mass of all that moves with the piston.
    #[serde(default = "no_mass")]
    pub reciprocating_mass: Mass<NonNegative>,
    /// Inertia over the crank angle, instead of that of `models`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub throw_inertia: Option<Box<dyn ThrowInertiaSpec>>,
    /// Gas spaces: one for a single-acting cylinder, two for a double-acting one; more for stages in line.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub ends: Vec<EndCase>,
}

/// One gas space of a cylinder.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EndCase {
    /// Which side of the piston.
    #[serde(default)]
    pub side: Side,
    /// Cylinder bore.
    pub bore: PosLength,
    /// Diameter of a rod that goes through this space.
    #[serde(default = "no_length")]
    pub rod_diameter: Length<NonNegative>,
    /// Pressure on the other side of the gas area. The other end of a double-acting cylinder counts for itself: there this is the
    /// pressure around the machine at both.
    #[serde(default = "one_atmosphere")]
    pub back_pressure: PosPressure,
    /// Factor on the gas torque: efficiency of a driving piston, its inverse for a driven one.
    #[serde(default = "one_pos")]
    pub factor: PosRatio,
    /// Gas pressure. Stages and unloaded ends differ here.
    pub cylinder_pressure: Box<dyn CylinderPressureSpec>,
}

/// Side of a piston.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// Away from the crank.
    #[default]
    Head,
    /// Towards the crank, where the piston rod is.
    Crank,
}

/// A torque on an inertia. Torque, angle and speed count in the direction in which the inertia turns.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DriveCase {
    /// Name of the inertia.
    pub at: String,
    /// Whether the torque is a load, given positive and taken off.
    #[serde(default)]
    pub load: bool,
    /// Angle added to that of the inertia: minus the firing angle of a cylinder.
    #[serde(default = "no_angle")]
    pub phase: Angle,
    /// The torque.
    pub drive: Box<dyn DriveSpec>,
}

/// Sub-models of the line.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Models {
    /// Response of the line.
    pub torsion: Box<dyn TorsionSpec>,
    /// Natural frequencies.
    pub natural_frequencies: Box<dyn NaturalFrequenciesSpec>,
    /// Inertia of throws.
    pub throw_inertia: Box<dyn ThrowInertiaSpec>,
    /// Piston motion.
    pub kinematics: Box<dyn KinematicsSpec>,
}

impl Default for Models {
    fn default() -> Self {
        Self {
            torsion: Box::new(gudgeon_torsion::torsion::HarmonicBalance::default()),
            natural_frequencies: Box::new(gudgeon_torsion::natural_frequencies::Eigenvalues::default()),
            throw_inertia: Box::new(gudgeon_torsion::throw_inertia::Exact {}),
            kinematics: Box::new(gudgeon_kinematics::ExactSliderCrank {}),
        }
    }
}

/// Conventions in which a published program differs.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[derive(Default)]
pub struct Conventions {
    /// Sign of the rod's obliquity in the lever of the gas force.
    pub obliquity: Obliquity,
    /// Factor ξ of a published rule: every shaft without damping of its own gets `2 ξ √(k₁ I₀)`, k₁ the stiffness of the first shaft,
    /// I₀ the mean inertia of the first throw.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damping_factor: Option<Ratio<NonNegative>>,
}

/// Orders and speeds that are looked at.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Range {
    /// Highest order of forced vibration.
    #[schemars(extend("x-refine" = { "group": "orders", "factor": 2 }))]
    pub orders: PosRatio,
    /// Highest order of the interference diagram.
    pub interference_orders: PosRatio,
    /// Lowest speed of the interference diagram and of the forced vibration over speed; speeds at which limits count are those of
    /// `operating`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from: Option<PosAngularSpeed>,
    /// Highest speed of both.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to: Option<PosAngularSpeed>,
    /// Speeds between them.
    #[schemars(range(min = 2, max = 20_000))]
    pub points: usize,
}

impl Default for Range {
    fn default() -> Self {
        Self {
            orders: quantity(24.0),
            interference_orders: quantity(12.0),
            from: None,
            to: None,
            points: 201,
        }
    }
}

/// Speeds at which a line runs, as the owner of the machine may use them: not those of the diagrams, which `range` gives. Without it
/// limits are judged over `range` where that has `from` and `to`, otherwise at the mean speed alone.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Operating {
    /// Lowest speed of the reference shaft.
    pub from: PosAngularSpeed,
    /// Highest speed; equal to `from` for a line that runs at one speed.
    pub to: PosAngularSpeed,
}

/// A way in which the machine is loaded. The case as it stands is one too, named `as it stands`, unless a step without changes gives it
/// a name.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LoadStepCase {
    /// Name for verdict and reports.
    pub name: String,
    /// Changes to the machine as `--set` takes them: valves held open, pressures, drives, a failed cylinder.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub set: Vec<String>,
}

/// Motion over time.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TimeCase {
    /// Length.
    pub duration: PosTime,
    /// Time between rows of the series.
    pub interval: PosTime,
    /// Length of the window at the end in which extremes are looked for; a tenth of the whole when not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub window: Option<PosTime>,
    /// Time between the instants looked at in the window; `interval` when not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub window_interval: Option<PosTime>,
    /// Speeds of the inertias at the start; empty: all at the mean speed; one value: the same for all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub start_speeds: Vec<AngularSpeed>,
    /// Whether to start in the periodic motion of the mean speed (of the model `orders`) instead.
    #[serde(default)]
    pub start_steady: bool,
    /// Whether a constant torque beside the drives holds the mean speed of the case, as in a periodic motion: that of `harmonic_balance`, where it
    /// acts there. Otherwise the line runs at the speed at which its drives and loads balance.
    #[serde(default)]
    pub hold_speed: bool,
}

/// Limits, each with its source. A result beyond a limit is said in the verdict; the run goes on.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Limits {
    /// Distance of natural frequencies from excitations.
    pub separation: Vec<SeparationLimit>,
    /// Stress in shafts.
    pub stress: Vec<StressLimit>,
    /// Torque in couplings and shafts.
    pub torque: Vec<TorqueLimit>,
    /// Heat in couplings and dampers.
    pub heat: Vec<HeatLimit>,
    /// Coefficient of speed fluctuation.
    pub irregularity: Vec<SpeedFluctuationLimit>,
}

/// Natural frequencies keep away from multiples of the speed, or from given frequencies.
///
/// The distance is that between natural frequency and excitation by the excitation, `|f_n - f|/f`, at the operating speed where it is least;
/// zero where they meet within the operating range. Natural frequencies are undamped, with a viscous damper those with damping.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SeparationLimit {
    /// Smallest admitted distance, by the frequency of the excitation.
    pub margin: PosRatio,
    /// Orders of the speed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub orders: Vec<f64>,
    /// Fixed frequencies: the line frequency and twice it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub frequencies: Vec<gudgeon_core::quantity::PosFrequency>,
    /// Whether a distance that is not kept is accepted where the forced vibration there keeps every limit on torque, stress, heat and speed
    /// fluctuation: with a reservation, as practice has it. `false`: it is not kept.
    #[serde(default = "yes", skip_serializing_if = "is_yes")]
    pub accept_by_response: bool,
    /// Names of the load steps in which it counts, `as it stands` for the case itself; empty: all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub load_steps: Vec<String>,
    /// Where the limit comes from.
    pub source: String,
}

/// A stress is not exceeded.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StressLimit {
    /// Name of the shaft; empty: all that have a diameter and no limit on stress of their own in that load step.
    #[serde(default)]
    pub shaft: String,
    /// Largest admitted vibratory stress: half of peak to peak, concentration factor included.
    pub amplitude: PosPressure,
    /// Names of the load steps in which it counts, `as it stands` for the case itself; empty: all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub load_steps: Vec<String>,
    /// Where the limit comes from.
    pub source: String,
}

/// A torque is not exceeded.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TorqueLimit {
    /// Name of the shaft or coupling.
    pub shaft: String,
    /// Largest admitted vibratory torque: half of peak to peak.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub amplitude: Option<PosTorque>,
    /// Largest admitted torque of all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub peak: Option<PosTorque>,
    /// Names of the load steps in which it counts, `as it stands` for the case itself; empty: all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub load_steps: Vec<String>,
    /// Where the limit comes from.
    pub source: String,
}

/// A coupling does not get too hot.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HeatLimit {
    /// Name of the shaft, coupling or damper.
    pub shaft: String,
    /// Largest admitted heat.
    pub power: Power<gudgeon_core::quantity::Positive>,
    /// Names of the load steps in which it counts, `as it stands` for the case itself; empty: all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub load_steps: Vec<String>,
    /// Where the limit comes from.
    pub source: String,
}

/// The speed of an inertia stays even.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpeedFluctuationLimit {
    /// Name of the inertia: generator, flywheel, propeller.
    pub inertia: String,
    /// Largest admitted coefficient of speed fluctuation: highest less lowest speed, by the mean.
    pub coefficient: PosRatio,
    /// Names of the load steps in which it counts, `as it stands` for the case itself; empty: all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub load_steps: Vec<String>,
    /// Where the limit comes from.
    pub source: String,
}

/// What is wanted.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Outputs {
    /// Groups of results; empty: all that the models give.
    pub groups: Vec<Group>,
}

/// A group of results.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Group {
    /// Torque, work and inertia of the throws at constant speed. Needs no line.
    Throws,
    /// Natural frequencies, shapes, critical speeds.
    NaturalFrequencies,
    /// Vibration at the mean speed, or motion over time: what the torsion model answers.
    Response,
    /// Vibration over the speed range.
    SpeedRange,
}

const fn yes() -> bool {
    true
}
#[allow(clippy::trivially_copy_pass_by_ref, reason = "as serde asks for it")]
const fn is_yes(value: &bool) -> bool {
    *value
}
fn no_inertia() -> Inertia<NonNegative> {
    quantity(0.0)
}
fn no_damping() -> TorsionalDamping<NonNegative> {
    quantity(0.0)
}
fn no_stiffness() -> TorsionalStiffness<NonNegative> {
    quantity(0.0)
}
fn no_mass() -> Mass<NonNegative> {
    quantity(0.0)
}
fn no_length() -> Length<NonNegative> {
    quantity(0.0)
}
fn no_offset() -> Length {
    quantity(0.0)
}
fn no_angle() -> Angle {
    quantity(0.0)
}
fn no_ratio() -> Ratio<NonNegative> {
    quantity(0.0)
}
fn one() -> Ratio {
    quantity(1.0)
}
fn one_pos() -> PosRatio {
    quantity(1.0)
}
fn third() -> Ratio<Fraction> {
    quantity(1.0 / 3.0)
}
fn steel() -> PosPressure {
    quantity(79.3e9)
}
fn one_atmosphere() -> PosPressure {
    quantity(101_325.0)
}
