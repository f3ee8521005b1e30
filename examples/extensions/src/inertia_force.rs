//! A scene: the inertia force of a reciprocating mass over the crank angle.

use std::time::Instant;

use gudgeon_case::Loaded;
use gudgeon_core::kinds::{Kinematics, KinematicsCtx, KinematicsSpec};
use gudgeon_core::quantity::{Length, PosAngularSpeed, PosLength, PosMass, quantity};
use gudgeon_core::result::{Column, Figure, FigureKind, Lines, ModelUse, RunResult, Series, Skipped, Value};
use gudgeon_core::{BuildError, Registry};
use gudgeon_scene::{
    Explanation, Progress, RunError, SceneCase, Stopped, case_file, model_use, register_scene,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

case_file! {
    /// The inertia force of a reciprocating mass.
    pub struct InertiaForceCase {
        /// Crank drive.
        pub engine: Drive,
        /// Reciprocating mass.
        pub mass: PosMass,
        /// Sub-models.
        #[serde(default)]
        pub models: Models,
    }
}

/// Crank drive.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Drive {
    /// Crankshaft speed.
    pub speed: PosAngularSpeed,
    /// Twice the crank radius.
    pub stroke: PosLength,
    /// Connecting-rod length between centres.
    pub rod_length: PosLength,
    /// Offset of the pin's line of motion from the crank axis.
    #[serde(default = "none")]
    pub offset: Length,
}

fn none() -> Length {
    quantity(0.0)
}

/// Sub-models.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Models {
    /// Piston motion.
    #[serde(default = "default_kinematics")]
    pub kinematics: Box<dyn KinematicsSpec>,
}

impl Default for Models {
    fn default() -> Self {
        Self { kinematics: default_kinematics() }
    }
}

gudgeon_core::default_model! {
    default_kinematics: dyn KinematicsSpec = "exact_slider_crank";
}

/// Names and meanings of the results.
const RESULTS: [(&str, &str); 2] = [
    ("force_max", "largest inertia force, towards the head"),
    ("force_min", "smallest inertia force, towards the head"),
];

impl SceneCase for InertiaForceCase {
    type Built = Box<dyn Kinematics>;

    fn build(loaded: &Loaded<Self>) -> Result<Self::Built, Vec<BuildError>> {
        let e = &loaded.value.engine;
        let ctx = KinematicsCtx {
            crank_radius: 0.5 * e.stroke.si(),
            rod_length: e.rod_length.si(),
            offset: e.offset.si(),
            omega: e.speed.si(),
        };
        loaded
            .value
            .models
            .kinematics
            .build(&ctx)
            .map_err(|e| vec![BuildError { field: "engine".into(), ..e }])
    }

    fn explain(
        loaded: &Loaded<Self>,
        _: &mut Self::Built,
        told: &mut Explanation,
    ) -> Result<Vec<ModelUse>, RunError> {
        told.runs.push(Skipped { what: "kinematics".into(), why: "its acceleration is the force".into() });
        told.results = RESULTS.map(|(name, _)| name.to_owned()).into();
        Ok(models(&loaded.value))
    }

    fn result_names(_: &Loaded<Self>, _: &mut Self::Built) -> Option<Vec<String>> {
        Some(RESULTS.map(|(name, _)| name.to_owned()).into())
    }

    fn run(
        loaded: &Loaded<Self>,
        drive: Self::Built,
        _: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
    ) -> Result<RunResult, RunError> {
        let begin = Instant::now();
        let mass = loaded.value.mass.si();
        let degrees: Vec<f64> = (0..=360).map(f64::from).collect();
        let force: Vec<f64> = degrees.iter().map(|d| -mass * drive.motion(d.to_radians()).a).collect();
        let mut result = RunResult { models: models(&loaded.value), ..RunResult::default() };
        let extremes = [
            force.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            force.iter().copied().fold(f64::INFINITY, f64::min),
        ];
        for ((name, what), value) in RESULTS.into_iter().zip(extremes) {
            result.results.insert(name.into(), Value { value, unit: "N".into(), what: what.into() });
        }
        let column = Column { name: "force".into(), unit: "N".into(), values: force };
        result.series = Series::over_cycle(degrees, vec![column]);
        result.figures.push(Figure {
            title: "Inertia force".into(),
            hint: String::new(),
            table: "series".into(),
            kind: FigureKind::Lines(Lines {
                x: result.series.axis.name.clone(),
                lines: vec![("force".into(), "force".into())],

                ..Lines::default()
            }),
        });
        result.solver.method = "closed form".into();
        result.seconds.insert("solve".into(), begin.elapsed().as_secs_f64());
        Ok(result)
    }
}

fn models(case: &InertiaForceCase) -> Vec<ModelUse> {
    vec![model_use(&Registry::collect(), "kinematics", case.models.kinematics.typetag_name())]
}

register_scene! {
    InertiaForceCase,
    name: "inertia_force",
    summary: "the inertia force of a reciprocating mass",
    equations: "F = -m a(theta)",
    validity: "A mass that moves with the gudgeon pin; constant crank speed.",
    references: [],
}
