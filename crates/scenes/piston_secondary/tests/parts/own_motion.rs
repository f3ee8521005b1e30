//! Lateral motions that the scene has never seen: a damper across the bore, and a liner that yields on a mount of its own.

use std::path::Path;

use gudgeon_contact as _;
use gudgeon_core::kinds::{
    AddedForces, LateralLoads, LateralPartials, LateralPose, SecondaryMotion, SecondaryMotionCtx,
    SecondaryMotionSpec,
};
use gudgeon_core::quantity::{PosMass, PosStiffness};
use gudgeon_core::result::RunResult;
use gudgeon_core::states::{Signals, StateInfo, Stateful};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_film as _;
use gudgeon_kinematics as _;
use gudgeon_scene::{check, run};
use gudgeon_scene_piston_secondary as _;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The balance of forces, with a damper at both edges.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Damped {
    /// Damping of each edge \[N s/m\].
    damping: f64,
    /// Whether partial derivatives are told.
    #[serde(default)]
    exact: bool,
}

#[register_model(
    name = "damped",
    summary = "balance of forces with a damper at each edge",
    equations = "0 = forces - d v",
    validity = "A test.",
    references = [],
    example = "damping = 1e4\n",
)]
impl SecondaryMotionSpec for Damped {
    fn build(&self, ctx: &SecondaryMotionCtx) -> Result<Box<dyn SecondaryMotion>, BuildError> {
        let state = |name: &str| StateInfo::new(name).absolute(1.0).changes(Signals::FILM_THICKNESS);
        Ok(Box::new(Damper { states: [state("e_top"), state("e_bottom")], spec: self.clone(), ctx: *ctx }))
    }
}

struct Damper {
    states: [StateInfo; 2],
    spec: Damped,
    ctx: SecondaryMotionCtx,
}

impl Stateful for Damper {
    fn states(&self) -> &[StateInfo] {
        &self.states
    }
}

impl SecondaryMotion for Damper {
    fn pose(&self, y: &[f64]) -> LateralPose {
        LateralPose::new([self.ctx.clearance * y[0], self.ctx.clearance * y[1]])
    }
    fn added(&self, _: &[f64]) -> AddedForces {
        AddedForces::new([0.0; 2], [[self.spec.damping, 0.0], [0.0, self.spec.damping]])
    }
    fn rates(&mut self, _: &[f64], piston: &mut dyn LateralLoads, dy: &mut [f64]) -> Result<(), EvalError> {
        let v = piston.balance()?;
        for k in 0..2 {
            dy[k] = v[k] / (self.ctx.clearance * self.ctx.omega);
        }
        Ok(())
    }
    fn partials(&mut self, _: &[f64], piston: &LateralPartials<'_>, jac: &mut [f64]) -> bool {
        for (k, v) in piston.by_e.iter().enumerate() {
            (jac[k], jac[2 + k]) = (v[0] / self.ctx.omega, v[1] / self.ctx.omega);
        }
        self.spec.exact
    }
}

/// The balance of forces in a liner that stands on springs: a third coordinate with inertia.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct SprungLiner {
    /// Mass of the liner.
    mass: PosMass,
    /// Stiffness of its mount.
    stiffness: PosStiffness,
}

#[register_model(
    name = "sprung_liner",
    summary = "balance of forces in a liner that stands on a spring and a damper",
    equations = "0 = forces;  m u'' = -S - k u - 2 sqrt(k m) u', S the force of the skirt on the piston",
    validity = "A test.",
    references = [],
    example = "mass = \"2 kg\"\nstiffness = \"100 N/um\"\n",
)]
impl SecondaryMotionSpec for SprungLiner {
    fn build(&self, ctx: &SecondaryMotionCtx) -> Result<Box<dyn SecondaryMotion>, BuildError> {
        let gap = |name: &str| StateInfo::new(name).absolute(1.0).changes(Signals::FILM_THICKNESS);
        let states =
            [gap("e_top"), gap("e_bottom"), gap("liner"), StateInfo::new("liner_rate").absolute(1.0)];
        Ok(Box::new(Sprung { states, mass: self.mass.si(), stiffness: self.stiffness.si(), ctx: *ctx }))
    }
}

/// States: displacements of both edges and of the liner in clearances, its velocity in clearances per radian.
struct Sprung {
    states: [StateInfo; 4],
    mass: f64,
    stiffness: f64,
    ctx: SecondaryMotionCtx,
}

impl Stateful for Sprung {
    fn states(&self) -> &[StateInfo] {
        &self.states
    }
}

impl SecondaryMotion for Sprung {
    /// What the films see: the piston relative to the liner.
    fn pose(&self, y: &[f64]) -> LateralPose {
        let c = self.ctx.clearance;
        LateralPose::new([c * (y[0] - y[2]), c * (y[1] - y[2])])
    }
    fn rates(&mut self, y: &[f64], piston: &mut dyn LateralLoads, dy: &mut [f64]) -> Result<(), EvalError> {
        let (c, omega) = (self.ctx.clearance, self.ctx.omega);
        let v = piston.balance()?;
        let [top, bottom] = piston.skirt_forces();
        let damping = 2.0 * (self.stiffness * self.mass).sqrt();
        let force = -(top + bottom) - self.stiffness * c * y[2] - damping * c * omega * y[3];
        dy[0] = v[0] / (c * omega) + y[3];
        dy[1] = v[1] / (c * omega) + y[3];
        dy[2] = y[3];
        dy[3] = force / (self.mass * c * omega * omega);
        Ok(())
    }
}

/// Runs the case with a coarse film.
fn motion(model: &str, more: &[&str]) -> RunResult {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../cases/zhu-motored-1000.toml");
    let mut set: Vec<String> = [
        "solver.intervals_along=10",
        "solver.intervals_across=8",
        "outputs.map_step=90 deg",
        "outputs.results=[\"e_top_max\", \"e_bottom_mean\", \"tilt_max\", \"friction_work\"]",
    ]
    .map(String::from)
    .to_vec();
    set.push(format!("models.secondary_motion={model}"));
    set.extend(more.iter().map(|s| (*s).to_owned()));
    let checked = check(&case, &set).unwrap_or_else(|e| panic!("{model}: {e}"));
    run(&checked, &mut gudgeon_scene::unwatched).unwrap_or_else(|e| panic!("{model}: {e}"))
}

fn value(r: &RunResult, name: &str) -> f64 {
    r.results[name].value
}

const RESULTS: [&str; 4] = ["e_top_max", "e_bottom_mean", "tilt_max", "friction_work"];

#[test]
fn a_damper_slows_the_motion_across_the_bore() {
    let built_in = motion("{ model = \"quasi_static\" }", &[]);
    let none = motion("{ model = \"damped\", damping = 0.0, exact = true }", &[]);
    for name in RESULTS {
        // The same equations. The derivative by time is a difference quotient of the integrator here: steps differ within the tolerance of 1e-3.
        let (a, b) = (value(&built_in, name), value(&none, name));
        assert!((a - b).abs() < 5e-3 * (1.0 + b.abs()), "{name}: {a} {b}");
    }
    let range = |r: &RunResult| {
        let e = &r.series.get("skirt.e_top").expect("a column").values;
        e.iter().fold(f64::NEG_INFINITY, |m, v| m.max(*v)) - e.iter().fold(f64::INFINITY, |m, v| m.min(*v))
    };
    // The first turn from the middle: with so much damping deviations from the periodic motion fade over more cycles than its search takes.
    let first = ["solver.cycles=1"];
    let free = motion("{ model = \"damped\", damping = 0.0, exact = true }", &first);
    let damped = motion("{ model = \"damped\", damping = 1e6, exact = true }", &first);
    assert!(range(&damped) < 0.8 * range(&free), "{} {}", range(&damped), range(&free));
    // Without partial derivatives of its own, by difference quotients: the same motion.
    let quotients = motion("{ model = \"damped\", damping = 1e6 }", &first);
    for name in RESULTS {
        let (a, b) = (value(&damped, name), value(&quotients, name));
        assert!((a - b).abs() < 5e-3 * (1.0 + b.abs()), "{name}: {a} {b}");
    }
    // The model is told by its name.
    assert!(damped.models.iter().any(|m| m.model == "damped"));
}

#[test]
fn a_stiff_mount_is_none() {
    let fixed = motion("{ model = \"quasi_static\" }", &[]);
    let stiff = motion("{ model = \"sprung_liner\", mass = \"2 kg\", stiffness = \"1e6 N/um\" }", &[]);
    for name in RESULTS {
        let (a, b) = (value(&fixed, name), value(&stiff, name));
        // 1 kN on 1e6 N/um moves the liner by a nanometre; steps differ within the tolerance of 1e-3.
        assert!((a - b).abs() < 1e-2 * (1.0 + b.abs()), "{name}: {a} {b}");
    }
    let names: Vec<_> = stiff.models.iter().map(|m| m.model.clone()).collect();
    assert!(names.iter().any(|n| n == "sprung_liner"), "{names:?}");
}

#[test]
fn backward_euler_refuses_what_it_cannot_step() {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../cases/zhu-motored-1000.toml");
    let set =
        ["models.secondary_motion={ model = \"damped\", damping = 1e4 }", "solver.method=backward_euler"]
            .map(String::from);
    let refused = check(&case, &set).err().expect("refused").to_string();
    assert!(refused.contains("`backward_euler` steps lateral motions"), "{refused}");
}
