//! The scene `power_cylinder`: the rings and the skirt of one cylinder in one case. Kinematics and gas are those of the ring pack, given once.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]

pub mod case;

use gudgeon_core::file::Files;
use gudgeon_core::kinds::EngineCycle;
use gudgeon_core::quantity::quantity;
use gudgeon_core::result::{Headline, ModelUse, Note, RunResult, Value};
use gudgeon_core::{BuildError, Stopwatch};

use case::{Part, PowerCylinderCase};
use gudgeon_case::{Level, Loaded, Refinement, Report, UsedSet, read_beside, scene_of};
use gudgeon_machine::Engine;
use gudgeon_scene::elsewhere::Elsewhere;
use gudgeon_scene::{
    Checked, Explanation, Progress, RunError, Scene, SceneCase, Stopped, WorkPrecision, check_case, explain,
    load,
};
use gudgeon_scene_piston_secondary::case::PistonSecondaryCase;
use gudgeon_scene_ring_pack::case::RingPackCase;

/// Headlines of each part that stand on the first page.
const FROM_EACH: usize = 4;

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

    /// That of the rings.
    fn cycle(loaded: &Loaded<Self>) -> Option<Result<EngineCycle, BuildError>> {
        match read_part(&loaded.source.files, &loaded.value.ring_pack, "ring_pack") {
            Ok(rings) => rings.cycle(),
            Err(wrong) => wrong.into_iter().next().map(Err),
        }
    }

    /// Its own and those of both parts.
    fn sets(loaded: &Loaded<Self>) -> Vec<UsedSet> {
        let mut all = loaded.sets.clone();
        let own = &loaded.value;
        for (part, field) in [(&own.ring_pack, "ring_pack"), (&own.piston_secondary, "piston_secondary")] {
            let sets = read_part(&loaded.source.files, part, field).map_or_else(|_| Vec::new(), |c| c.sets());
            all.extend(sets.into_iter().map(|s| UsedSet { path: format!("{field}.{}", s.path), ..s }));
        }
        all
    }

    /// Those of the rings and of the skirt.
    fn elsewhere(loaded: &Loaded<Self>, (rings, skirt): &mut (Checked, Checked)) -> Vec<Elsewhere> {
        let own = &loaded.value;
        let parts = [
            (rings, &own.ring_pack, "ring_pack", "the rings"),
            (skirt, &own.piston_secondary, "piston_secondary", "the skirt"),
        ];
        let of = |(checked, part, field, name): (&mut Checked, &Part, &str, &str)| {
            let placed = |start: String| format!("{name}: {start}");
            let placed = |e: Elsewhere| Elsewhere {
                starts: e.starts.map(placed),
                set: vec![part_with(part, field, &e.set)],
            };
            checked.case.elsewhere().into_iter().map(placed).collect::<Vec<_>>()
        };
        parts.into_iter().flat_map(of).collect()
    }

    /// Those of both parts, as changes to the parts.
    fn refinements(loaded: &Loaded<Self>) -> Vec<Refinement> {
        let Ok((rings, skirt)) = parts(loaded) else { return Vec::new() };
        let own = &loaded.value;
        let of = |case: &Checked, part: &Part, field: &str, name: &str| -> Vec<Refinement> {
            let level = |l: Level| Level { set: vec![part_with(part, field, &l.set)], ..l };
            let levels = |all: Vec<Level>| -> Vec<Level> { all.into_iter().map(level).collect() };
            case.case
                .refinements()
                .into_iter()
                .map(|r| Refinement {
                    what: format!("{} of the {name}", r.what),
                    own: level(r.own),
                    levels: levels(r.levels),
                    coarser: levels(r.coarser),
                })
                .collect()
        };
        let mut all = of(&rings, &own.ring_pack, "ring_pack", "rings");
        all.extend(of(&skirt, &own.piston_secondary, "piston_secondary", "skirt"));
        all
    }

    fn work_precision(loaded: &Loaded<Self>, _: &mut (Checked, Checked)) -> Result<WorkPrecision, String> {
        let (rings, skirt) = (&loaded.value.ring_pack.case, &loaded.value.piston_secondary.case);
        Err(format!(
            "the two parts of a power cylinder do not feel each other and are raced alone: `gudgeon bench {rings} {skirt}`"
        ))
    }

    fn result_names(_: &Loaded<Self>, (rings, skirt): &mut (Checked, Checked)) -> Option<Vec<String>> {
        let (rings, skirt) = (rings.case.result_names()?, skirt.case.result_names()?);
        let both = |name: &&str| [&rings, &skirt].iter().all(|p| p.iter().any(|r| r == name));
        let sums = ["friction_power", "fmep"].into_iter().filter(both).map(str::to_owned);
        let parts = [("rings", &rings), ("skirt", &skirt)];
        Some(sums.chain(parts.iter().flat_map(|(p, all)| all.iter().map(|r| named(p, r)))).collect())
    }

    fn run(
        loaded: &Loaded<Self>,
        (rings, skirt): (Checked, Checked),
        progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
    ) -> Result<RunResult, RunError> {
        let begin = Stopwatch::start();
        let mut half = |part: &Checked, name: &'static str, from: f64| {
            let mut tell = |p: Progress| {
                progress(Progress {
                    phase: format!("{name}: {}", p.phase),
                    fraction: from + 0.5 * p.fraction,
                })
            };
            part.case.once(&mut tell)
        };
        let mut result = half(&rings, "rings", 0.0)?;
        let (skirt, fed) = fed_by_rings(loaded, &result, skirt).map_err(|e| RunError::refused(&e))?;
        let other = half(&skirt, "skirt", 0.5)?;
        result.solver.notes.extend(fed);
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
        result.headlines = headlines(&result.headlines, other.headlines);
        result.balance.skirt_oil = other.balance.skirt_oil;
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
        result.seconds.insert("solve".into(), begin.seconds());
        Ok(result)
    }
}

/// The change of a case that changes a part of it further.
fn part_with(part: &Part, field: &str, set: &[String]) -> String {
    let all: Vec<String> = part.set.iter().chain(set).map(|s| format!("{s:?}")).collect();
    format!("{field}.set=[{}]", all.join(", "))
}

/// Headlines of the whole, then the first of the rings and of the skirt.
fn headlines(rings: &[Headline], skirt: Vec<Headline>) -> Vec<Headline> {
    let part = |all: &[Headline], name: &str, title: &str| -> Vec<Headline> {
        let own = all.iter().take(FROM_EACH).cloned().map(|h| h.within(name));
        own.map(|h| Headline { title: format!("{title}: {}", h.title), ..h }).collect()
    };
    let whole = [
        Headline::one("Friction power", "friction_power"),
        Headline::one("Friction mean effective pressure", "fmep"),
    ];
    [&whole[..], &part(rings, "rings", "Rings"), &part(&skirt, "skirt", "Skirt")].concat()
}

/// The skirt with the film that the rings leave to it, where it asks for one and they tell it, and what a person should know of that.
fn fed_by_rings(
    loaded: &Loaded<PowerCylinderCase>,
    rings: &RunResult,
    skirt: Checked,
) -> Result<(Checked, Option<Note>), Vec<BuildError>> {
    let Some(film) = left_above(rings) else { return Ok((skirt, None)) };
    let asks = |case: &PistonSecondaryCase| case.models.skirt_oil.clone().take_from_rings(film);
    if !skirt.of::<PistonSecondaryCase>().is_some_and(asks) {
        return Ok((skirt, None));
    }
    let text = format!(
        "The rings leave {:.3} um of oil on the liner above the skirt on the way up, which it meets",
        1e6 * film
    );
    let note = Note::info("film_from_rings", text).amount("film", 1e6 * film, "um");
    let (_, skirt) = parts_with(loaded, Some(film))?;
    Ok((skirt, Some(note)))
}

/// Mean film \[m\] over the way up that the lowest ring leaves on the liner; none where the rings do not follow their oil.
fn left_above(rings: &RunResult) -> Option<f64> {
    let columns = &rings.series.columns;
    let left = columns.iter().rfind(|c| c.name.starts_with("ring") && c.name.ends_with(".oil_left"))?;
    let speed = columns.iter().find(|c| c.name == "piston.v")?;
    let (mut oil, mut way) = (0.0, 0.0);
    for (v, film) in speed.values.iter().zip(&left.values).filter(|(v, _)| **v > 0.0) {
        oil += v * film;
        way += v;
    }
    (way > 0.0).then(|| oil / way)
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
    parts_with(loaded, None)
}

/// The same, the skirt's also with the film \[m\] that the rings leave to it.
fn parts_with(
    loaded: &Loaded<PowerCylinderCase>,
    film: Option<f64>,
) -> Result<(Checked, Checked), Vec<BuildError>> {
    let (own, files) = (&loaded.value, &loaded.source.files);
    let rings = checked(read_part(files, &own.ring_pack, "ring_pack")?, &own.ring_pack, "ring_pack")?;
    let pack = rings.of::<RingPackCase>().ok_or_else(|| other_scene("ring_pack"))?;
    let mut skirt = read_part(files, &own.piston_secondary, "piston_secondary")?;
    let to = skirt.value_mut().downcast_mut::<PistonSecondaryCase>();
    let to = to.ok_or_else(|| other_scene("piston_secondary"))?;
    share(pack, to);
    if let Some(film) = film {
        to.models.skirt_oil.take_from_rings(film);
    }
    let skirt = checked(skirt, &own.piston_secondary, "piston_secondary")?;
    Ok((rings, skirt))
}

fn other_scene(field: &str) -> Vec<BuildError> {
    vec![BuildError::at(format!("{field}.case"), format!("must be a case of the scene `{field}`"))]
}

/// A part as its file and its changes give it; the part at `field` is of the scene of that name.
fn read_part(files: &Files, part: &Part, field: &str) -> Result<Box<dyn Scene>, Vec<BuildError>> {
    // Before the rest of it: a part that is a whole cylinder could be this case itself.
    let source = read_beside(files, &part.case).map_err(|r| refused(&r, part, field))?;
    if scene_of(&source, &part.set).as_deref() != Some(field) {
        return Err(other_scene(field));
    }
    load(source, &part.set).map_err(|r| refused(&r, part, field))
}

fn checked(case: Box<dyn Scene>, part: &Part, field: &str) -> Result<Checked, Vec<BuildError>> {
    check_case(part.case.clone(), case).map_err(|r| refused(&r, part, field))
}

/// What is wrong with a part, told of the key that names it.
fn refused(report: &Report, part: &Part, field: &str) -> Vec<BuildError> {
    let told: Vec<String> = report.diagnostics.iter().map(|d| d.headline()).collect();
    vec![BuildError::at(format!("{field}.case"), format!("{}: {}", part.case, told.join("; ")))]
}

/// Gives the skirt the crank drive and the gas of the rings. Where the pin stands in the piston, the skirt's case says.
fn share(pack: &RingPackCase, skirt: &mut PistonSecondaryCase) {
    let pin_offset = skirt.engine.pin_offset;
    // The line of the pin stays where the rings' case has it.
    let moved = pin_offset.si() - pack.engine.pin_offset.si();
    let crank_offset = quantity(pack.engine.crank_offset.si() + moved);
    skirt.engine = Engine { pin_offset, crank_offset, ..pack.engine.clone() };
    skirt.gas.crankcase_pressure = pack.gas.crankcase_pressure;
    skirt.models.kinematics = pack.models.kinematics.clone();
    skirt.models.cylinder_pressure = pack.models.cylinder_pressure.clone();
}

gudgeon_scene::register_scene! {
    PowerCylinderCase,
    name: "power_cylinder",
    summary: "rings and skirt of one cylinder",
    equations: "those of ring_pack and piston_secondary with one crank drive and one cylinder pressure",
    validity: "Rings and skirt do not act on each other but through the drive and the gas that they share, and the oil that the rings leave to the skirt.",
    references: [],
}

gudgeon_core::link!(PowerCylinderCase,);
