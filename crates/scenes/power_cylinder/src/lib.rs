//! The scene `power_cylinder`: the rings and the skirt of one cylinder in one case. Kinematics and gas are those of the ring pack, given once.

pub mod case;

use std::time::Instant;

use gudgeon_core::BuildError;
use gudgeon_core::result::{ModelUse, RunResult, Value};
use serde_json::Value as Json;

use case::{Part, PowerCylinderCase};
use gudgeon_case::{Loaded, Refinement, Report, read_beside, scene_of};
use gudgeon_scene::{Checked, Explanation, Progress, RunError, SceneCase, check_source, explain};
use gudgeon_scene_piston_secondary::case::PistonSecondaryCase;
use gudgeon_scene_ring_pack::case::RingPackCase;

impl SceneCase for PowerCylinderCase {
    /// The rings and the skirt.
    type Built = (Checked, Checked);

    fn build(loaded: &Loaded<Self>) -> Result<(Checked, Checked), Vec<BuildError>> {
        parts(loaded)
    }

    fn explain(
        _: &Loaded<Self>,
        (rings, skirt): &mut (Checked, Checked),
        told: &mut Explanation,
    ) -> Result<Vec<ModelUse>, RunError> {
        let mut models = Vec::new();
        for (part, name) in [(&*rings, "rings"), (&*skirt, "skirt")] {
            let own = explain(part)?;
            told.runs.extend(own.runs);
            told.skipped.extend(own.skipped);
            told.states.extend(own.states);
            told.results.extend(own.results.iter().map(|r| named(name, r)));
            add_models(&mut models, own.models.into_iter().map(|m| m.used));
        }
        Ok(models)
    }

    /// Those of both parts, as changes to the parts.
    fn refinements(loaded: &Loaded<Self>) -> Vec<Refinement> {
        let Ok((rings, skirt)) = parts(loaded) else { return Vec::new() };
        let own = &loaded.value;
        let of = |case: &Checked, part: &Part, field: &str, name: &str| -> Vec<Refinement> {
            let level = |set: Vec<String>| {
                let all: Vec<String> = part.set.iter().chain(&set).map(|s| format!("{s:?}")).collect();
                vec![format!("{field}.set=[{}]", all.join(", "))]
            };
            case.case
                .refinements()
                .into_iter()
                .map(|r| Refinement {
                    what: format!("{} of the {name}", r.what),
                    levels: r.levels.into_iter().map(level).collect(),
                })
                .collect()
        };
        let mut all = of(&rings, &own.ring_pack, "ring_pack", "rings");
        all.extend(of(&skirt, &own.piston_secondary, "piston_secondary", "skirt"));
        all
    }

    fn result_names(_: &Loaded<Self>, (rings, skirt): &mut (Checked, Checked)) -> Option<Vec<String>> {
        let (rings, skirt) = (rings.case.result_names()?, skirt.case.result_names()?);
        let both = |name: &&str| [&rings, &skirt].iter().all(|p| p.iter().any(|r| r == name));
        let sums = ["friction_power", "fmep"].into_iter().filter(both).map(str::to_owned);
        let parts = [("rings", &rings), ("skirt", &skirt)];
        Some(sums.chain(parts.iter().flat_map(|(p, all)| all.iter().map(|r| named(p, r)))).collect())
    }

    fn run(
        _: &Loaded<Self>,
        (rings, skirt): (Checked, Checked),
        progress: &mut dyn FnMut(Progress),
    ) -> Result<RunResult, RunError> {
        let begin = Instant::now();
        let mut half = |name: &'static str, from: f64| {
            let mut tell = |p: Progress| {
                progress(Progress {
                    phase: format!("{name}: {}", p.phase),
                    fraction: from + 0.5 * p.fraction,
                });
            };
            let part = if from == 0.0 { &rings } else { &skirt };
            part.case.once(&mut tell)
        };
        let mut result = half("rings", 0.0)?;
        let other = half("skirt", 0.5)?;
        let power = |r: &RunResult| r.results.get("friction_power").map(|v| v.value);
        let total = power(&result).zip(power(&other));
        let fmep = |r: &RunResult| r.results.get("fmep").map(|v| v.value);
        let pressure = fmep(&result).zip(fmep(&other));
        let mut results = indexmap::IndexMap::new();
        let mut sum = |name: &str, value: Option<f64>, unit: &str, what: &str| {
            if let Some(value) = value {
                results.insert(name.to_owned(), Value { value, unit: unit.into(), what: what.into() });
            }
        };
        sum(
            "friction_power",
            total.map(|(a, b)| a + b),
            "W",
            "friction power of rings and skirt, one cylinder",
        );
        sum(
            "fmep",
            pressure.map(|(a, b)| a + b),
            "bar",
            "friction work of rings and skirt over swept volume",
        );
        results.extend(result.results.into_iter().map(|(k, v)| (named("rings", &k), v)));
        results.extend(other.results.into_iter().map(|(k, v)| (named("skirt", &k), v)));
        result.results = results;
        add_models(&mut result.models, other.models);
        result.skipped.extend(other.skipped);
        result.figures.extend(other.figures);
        result.tables.extend(other.tables);
        result.events.extend(other.events);
        result.events.sort_by(|a, b| a.theta_deg.total_cmp(&b.theta_deg));
        for note in other.solver.notes {
            // Both scenes have the same cylinder pressure.
            if !result.solver.notes.contains(&note) {
                result.solver.notes.push(note);
            }
        }
        let own = std::mem::take(&mut result.solver.counters);
        result.solver.counters = own.into_iter().map(|(k, n)| (named("rings", &k), n)).collect();
        result
            .solver
            .counters
            .extend(other.solver.counters.into_iter().map(|(k, n)| (named("skirt", &k), n)));
        if result.series.axis.values == other.series.axis.values {
            // The crank drive and the gas are told once.
            let known: Vec<String> = result.series.columns.iter().map(|c| c.name.clone()).collect();
            result
                .series
                .columns
                .extend(other.series.columns.into_iter().filter(|c| !known.contains(&c.name)));
        } else {
            result.tables.insert("skirt".into(), other.series);
        }
        result.seconds.insert("solve".into(), begin.elapsed().as_secs_f64());
        Ok(result)
    }
}

fn named(part: &str, name: &str) -> String {
    format!("{part}.{name}")
}

fn add_models(to: &mut Vec<ModelUse>, more: impl IntoIterator<Item = ModelUse>) {
    for m in more {
        if !to.contains(&m) {
            to.push(m);
        }
    }
}

/// Both cases, the skirt's with the crank drive and the gas of the rings'.
fn parts(loaded: &Loaded<PowerCylinderCase>) -> Result<(Checked, Checked), Vec<BuildError>> {
    let files = &loaded.source.files;
    let wrong = |field: &str, scene: &str| {
        vec![BuildError::at(format!("{field}.case"), format!("must be a case of the scene `{scene}`"))]
    };
    let part_of = |part: &Part, field: &str, more: &[String]| {
        let set: Vec<String> = part.set.iter().chain(more).cloned().collect();
        let told = |report: Report| {
            let told: Vec<String> = report.diagnostics.iter().map(|d| d.headline()).collect();
            vec![BuildError::at(format!("{field}.case"), format!("{}: {}", part.case, told.join("; ")))]
        };
        // Before the rest of it: a part that is a whole cylinder could be this case itself.
        let source = read_beside(files, &part.case).map_err(told)?;
        if scene_of(&source, &set).as_deref() != Some(field) {
            return Err(wrong(field, field));
        }
        check_source(part.case.clone(), source, &set).map_err(told)
    };
    let rings = part_of(&loaded.value.ring_pack, "ring_pack", &[])?;
    let pack = rings.of::<RingPackCase>().ok_or_else(|| wrong("ring_pack", "ring_pack"))?;
    let first = part_of(&loaded.value.piston_secondary, "piston_secondary", &[])?;
    let own =
        first.of::<PistonSecondaryCase>().ok_or_else(|| wrong("piston_secondary", "piston_secondary"))?;
    let shared = shared(pack, own).map_err(|e| {
        vec![BuildError::at("ring_pack.case", format!("its models cannot be handed on: {e}"))]
    })?;
    let skirt = part_of(&loaded.value.piston_secondary, "piston_secondary", &shared)?;
    Ok((rings, skirt))
}

/// What the skirt takes from the rings' case, as `--set` takes it.
fn shared(pack: &RingPackCase, skirt: &PistonSecondaryCase) -> Result<Vec<String>, serde_json::Error> {
    let e = &pack.engine;
    // The ring pack knows the distance of the pin's line from the crank axis, towards the anti-thrust side positive.
    let crank_offset = e.offset.si() + skirt.engine.pin_offset.si();
    Ok(vec![
        format!("engine.speed={:e} rad/s", e.speed.si()),
        format!("engine.bore={:e} m", e.bore.si()),
        format!("engine.crank_radius={:e} m", 0.5 * e.stroke.si()),
        format!("engine.rod_length={:e} m", e.rod_length.si()),
        format!("engine.crank_offset={crank_offset:e} m"),
        format!("engine.cylinders={}", e.cylinders),
        format!("gas.crankcase_pressure={:e} Pa", pack.gas.crankcase_pressure.si()),
        format!("models.kinematics={}", inline(&serde_json::to_value(&pack.models.kinematics)?)),
        format!(
            "models.cylinder_pressure={}",
            inline(&serde_json::to_value(&pack.models.cylinder_pressure)?)
        ),
    ])
}

/// A value as TOML on one line; what is null is left out.
fn inline(v: &Json) -> String {
    match v {
        Json::Object(o) => {
            let fields = o.iter().filter(|(_, v)| !v.is_null());
            let fields: Vec<String> = fields.map(|(k, v)| format!("{k} = {}", inline(v))).collect();
            format!("{{ {} }}", fields.join(", "))
        }
        Json::Array(a) => format!("[{}]", a.iter().map(inline).collect::<Vec<_>>().join(", ")),
        // JSON and TOML write text and numbers the same.
        other => other.to_string(),
    }
}

gudgeon_scene::register_scene! {
    PowerCylinderCase,
    name: "power_cylinder",
    summary: "rings and skirt of one cylinder",
    equations: "those of ring_pack and piston_secondary with one crank drive and one cylinder pressure",
    validity: "Rings and skirt do not act on each other but through the drive and the gas that they share.",
    references: [],
}
