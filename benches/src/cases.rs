//! The cases that stand for the scenes.

use std::path::{Path, PathBuf};

use gudgeon_core::result::RunResult;
use gudgeon_models as _;
use gudgeon_scene::{Checked, Threads, number, run, unwatched, with_threads};

/// A shipped case with some values changed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Case {
    /// What it is called among the others.
    pub name: String,
    /// Its file in `cases/`, without extension.
    pub file: String,
    /// `--set` arguments.
    pub set: Vec<String>,
    /// What makes its neighbours: see [`Case::neighbours`].
    pub near: Near,
}

/// What makes a case one of its neighbours, which differ from it in the last digits of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Near {
    /// It has none: it does the same work whatever its last digits are.
    Alone,
    /// The number at this path.
    At(&'static str),
    /// Each of these `--set` arguments.
    Set(&'static [&'static str]),
}

/// Neighbours of a case that has its numbers from another one.
const TOP_RING: &[&str] = &[
    "ring_pack.set=[\"rings.0.mass=42.99999999999997 g\"]",
    "ring_pack.set=[\"rings.0.mass=42.99999999999999 g\"]",
    "ring_pack.set=[\"rings.0.mass=43.00000000000001 g\"]",
    "ring_pack.set=[\"rings.0.mass=43.00000000000003 g\"]",
];

/// Faces that always find oil.
pub const FLOODED: &str = "models.oil_transport.model=off";

/// One case of every scene.
#[must_use]
pub fn one_a_scene() -> Vec<Case> {
    vec![
        Case::shipped("pin-85-alcohol-optimise").near(Near::At("engine.bore")),
        Case::shipped("turbo-diesel-120-skirt").near(Near::At("engine.speed")),
        Case::shipped("turbo-diesel-120-power-cylinder").near(Near::Set(TOP_RING)),
        Case::shipped("rigs/journal-2d").near(Near::At("rig.eccentricity")),
        Case::shipped("turbo-diesel-120").near(Near::At("engine.speed")),
        Case::shipped("compressor-4-throw").near(Near::At("speed")),
    ]
}

/// The cases whose work is counted: every scene at its defaults, other solvers and models of it, and the benches that search or step.
#[must_use]
pub fn counted() -> Vec<Case> {
    let mut all = one_a_scene();
    all.extend([
        Case::shipped("ea111-1400").near(Near::At("engine.speed")),
        Case::shipped("geared-train").near(Near::At("speed")),
        Case::shipped("pin-120-turbo-diesel"),
        Case::shipped("turbo-diesel-120-as-published").near(Near::At("engine.speed")),
        Case::shipped("rigs/flank-landing").near(Near::At("rig.load")),
        Case::shipped("rigs/gas-blow-down"),
        Case::shipped("rigs/gas-five-volumes").near(Near::At("rig.tolerance")),
        Case::shipped("rigs/slider-2d-textured").near(Near::At("rig.speed")),
        Case::shipped("rigs/slider-starved").near(Near::At("rig.speed")),
        Case::shipped("rigs/squeeze-plates"),
    ]);
    let diesel = |name: &str, set: &[&str]| {
        Case::shipped("turbo-diesel-120")
            .changed(&format!("turbo-diesel-120, {name}"), set)
            .near(Near::At("engine.speed"))
    };
    all.push(diesel("flooded", &[FLOODED]));
    all.push(diesel("flooded, tolerance 1e-6", &[FLOODED, "solver.tolerance=1e-6"]));
    let own = [FLOODED, "solver.integrator=sdirk2", "solver.tolerance=3e-3", "solver.periodicity=3e-3"];
    all.push(diesel("flooded, own stages", &own));
    let halves = [FLOODED, "solver.integrator=waveform", "solver.tolerance=1e-2", "solver.periodicity=1e-2"];
    all.push(diesel("flooded, in halves", &halves));
    let coarse = ["solver.intervals_along=16", "solver.intervals_across=12"];
    let elastic = Case::shipped("ea111-1400-compliant").changed("ea111-1400-compliant, 16 x 12", &coarse);
    all.push(elastic.near(Near::At("engine.speed")));
    let in_time = ["models.torsion.model=implicit", "time.duration=0.1 s", "time.interval=1 ms"];
    all.push(
        Case::shipped("compressor-4-throw")
            .changed("compressor-4-throw, implicit", &in_time)
            .near(Near::At("speed")),
    );
    all
}

/// The cases whose instructions are counted, the shortest first: valgrind takes some fifty times as long as the processor.
#[must_use]
pub fn instructed() -> Vec<Case> {
    let diesel = Case::shipped("turbo-diesel-120").changed("turbo-diesel-120, flooded", &[FLOODED]);
    vec![Case::shipped("pin-85-alcohol-optimise"), Case::shipped("rigs/journal-2d"), diesel]
}

/// The root of the project.
#[must_use]
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

impl Case {
    /// A case as it is shipped.
    #[must_use]
    pub fn shipped(file: &str) -> Self {
        Self { name: file.into(), file: file.into(), set: Vec::new(), near: Near::Alone }
    }

    /// The same under another name, with some values changed.
    #[must_use]
    pub fn changed(mut self, name: &str, set: &[&str]) -> Self {
        self.name = name.into();
        self.set.extend(set.iter().map(|s| (*s).to_owned()));
        self
    }

    /// The same with neighbours.
    #[must_use]
    pub fn near(mut self, near: Near) -> Self {
        self.near = near;
        self
    }

    /// Its file.
    #[must_use]
    pub fn path(&self) -> PathBuf {
        root().join("cases").join(format!("{}.toml", self.file))
    }

    /// Reads and checks it.
    ///
    /// # Errors
    /// What is wrong with it, as text.
    pub fn check(&self) -> Result<Checked, String> {
        gudgeon_scene::check(&self.path(), &self.set).map_err(|e| format!("{}: {e}", self.name))
    }

    /// Runs it without its sweeps.
    ///
    /// # Errors
    /// What is wrong with it or stopped it, as text.
    pub fn run(&self) -> Result<RunResult, String> {
        run_alone(&self.check()?).map_err(|e| format!("{}: {e}", self.name))
    }

    /// The case and its neighbours: runs that differ as they do after a sum is added in another order, or with another library of sines. What
    /// their solvers count differs by chance.
    ///
    /// # Errors
    /// A case that cannot be read, a number that is not there, as text.
    pub fn neighbours(&self) -> Result<Vec<Self>, String> {
        let set: Vec<String> = match self.near {
            Near::Alone => Vec::new(),
            Near::Set(all) => all.iter().map(|s| (*s).to_owned()).collect(),
            Near::At(path) => {
                let (value, unit) = given(&self.check()?.case.resolved(), path)
                    .ok_or_else(|| format!("{}: there is no number at {path}", self.name))?;
                let near = |k: f64| format!("{path}={:?} {unit}", value * (1.0 + k * f64::EPSILON));
                [-3.0, -1.0, 1.0, 3.0].map(near).into()
            }
        };
        let changed = set.iter().map(|s| self.clone().changed(&self.name, &[s.as_str()]));
        Ok([self.clone()].into_iter().chain(changed).collect())
    }
}

/// The number at a path of a resolved case, `engine.speed`, and its unit.
#[must_use]
pub fn given(resolved: &serde_json::Value, path: &str) -> Option<(f64, String)> {
    let value = resolved.pointer(&format!("/{}", path.replace('.', "/")))?;
    match value.as_str() {
        Some(text) => number(text).map(|(n, unit)| (n, unit.to_owned())),
        None => Some((value.as_f64()?, String::new())),
    }
}

/// Runs a case without its sweeps, on one core: work and times are compared.
///
/// # Errors
/// What stopped it, as text.
pub fn run_alone(checked: &Checked) -> Result<RunResult, String> {
    with_threads(Threads::One, || run::run_alone(checked, &mut unwatched)).map_err(|e| e.to_string())
}
