//! The shipped cases that changes start from, with the schemas of their scenes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use gudgeon_case::scene_of;
use gudgeon_core::schemars::SchemaGenerator;
use gudgeon_scene::scenes;
use serde_json::Value;

/// What shortens cases whose name begins so. The physics stays; what is left out is length alone.
const SHORTER: &[(&str, &[&str])] = &[
    // 200 gas steps a degree from two starts take ten times as long as any other ring pack.
    ("alcohol-1600", &["solver.gas_steps=40", "solver.starts=[\"1 bar\"]"]),
    // Skirts on grids of their sources take seconds, yielding ones a minute.
    ("ea111-1400", &["solver.intervals_along=20", "solver.intervals_across=16"]),
    ("turbo-diesel-120-skirt", &["solver.intervals_along=20", "solver.intervals_across=16"]),
    ("zhu-motored-1000", &["solver.intervals_along=20", "solver.intervals_across=16"]),
    // Three periods of a cavity on 800 panels.
    ("squeeze-plates", &["rig.panels=200", "rig.motion.steps=1000"]),
    // A published transient of 5 s, of which a tenth shows the same.
    ("compressor-4-throw-as-published", &["time.duration=0.5 s"]),
    // Four load steps, each over a wide range of speeds.
    ("compressor-6-throw", &["range.points=31", "operating.from=950 rpm"]),
    // Fine diagrams over the speed, each point with the orders of a whole response.
    ("compressor-", &["range.points=31"]),
];

/// The folder of study files, which name cases and are none.
const STUDIES: &str = "studies";

/// A shipped case.
#[derive(Debug, Clone)]
pub struct Base {
    /// File below the folder of cases.
    pub file: String,
    /// Its scene.
    pub scene: String,
    /// What shortens it.
    pub shortened: Vec<String>,
    /// Every value of it, so shortened, in SI units.
    pub resolved: Value,
    /// The results that it can be asked for.
    pub results: Vec<String>,
}

/// All shipped cases and what may be said in them.
#[derive(Debug)]
pub struct Corpus {
    /// The folder of cases.
    pub folder: PathBuf,
    /// The cases, in the order of their names.
    pub bases: Vec<Base>,
    /// Schemas of the scenes by name.
    pub schemas: BTreeMap<String, Value>,
    /// Definitions that the schemas refer to.
    pub definitions: Value,
}

/// The folder of the cases in this checkout.
#[must_use]
pub fn shipped() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases")
}

impl Corpus {
    /// Reads all cases of a folder and of its sub-folders.
    ///
    /// # Errors
    /// A folder that cannot be read, a case that the program refuses.
    pub fn read(folder: &Path) -> Result<Self, String> {
        let mut generator = SchemaGenerator::default();
        let schemas =
            scenes().iter().map(|s| (s.name.to_owned(), (s.schema)(&mut generator).to_value())).collect();
        let definitions = Value::Object(generator.take_definitions(true));
        let mut files = Vec::new();
        collect(folder, "", &mut files)?;
        files.sort();
        let bases = files.iter().map(|f| base(folder, f)).collect::<Result<_, _>>()?;
        Ok(Self { folder: folder.to_owned(), bases, schemas, definitions })
    }

    /// The cases of a scene.
    pub fn of_scene<'a>(&'a self, scene: &'a str) -> impl Iterator<Item = &'a Base> {
        self.bases.iter().filter(move |b| b.scene == scene)
    }

    /// A case by its file.
    #[must_use]
    pub fn base(&self, file: &str) -> Option<&Base> {
        self.bases.iter().find(|b| b.file == file)
    }
}

fn collect(folder: &Path, below: &str, out: &mut Vec<String>) -> Result<(), String> {
    let told = |e: std::io::Error| format!("{}: {e}", folder.display());
    for entry in std::fs::read_dir(folder).map_err(told)? {
        let path = entry.map_err(told)?.path();
        let Some(name) = path.file_name().and_then(|n| n.to_str()) else { continue };
        let name = if below.is_empty() { name.to_owned() } else { format!("{below}/{name}") };
        if path.is_dir() {
            if name != STUDIES {
                collect(&path, &name, out)?;
            }
        } else if name.ends_with(".toml") {
            out.push(name);
        }
    }
    Ok(())
}

fn base(folder: &Path, file: &str) -> Result<Base, String> {
    let path = folder.join(file);
    let stem = file.rsplit('/').next().unwrap_or(file);
    let shorter = SHORTER.iter().find(|(start, _)| stem.starts_with(start)).map_or(&[][..], |(_, set)| set);
    // A sweep repeats the case; its points are cases that the fuzzer draws anyway.
    let mut shortened: Vec<String> = shorter.iter().map(|s| (*s).to_owned()).collect();
    let plain = gudgeon_scene::check(&path, &shortened).map_err(|r| r.to_string())?;
    if !plain.case.heading().sweeps.is_empty() {
        shortened.push("sweeps=[]".into());
    }
    let checked = gudgeon_scene::check(&path, &shortened).map_err(|r| r.to_string())?;
    let told = gudgeon_scene::explain(&checked).map_err(|e| format!("{file}: {e}"))?;
    let scene = scene_of(checked.case.source(), &[]).unwrap_or_default();
    Ok(Base { file: file.to_owned(), scene, shortened, resolved: told.resolved, results: told.results })
}
