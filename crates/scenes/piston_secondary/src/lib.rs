//! The scene `piston_secondary`: lateral motion and tilt of one piston on the films and crests of its skirt.
//!
//! `assemble` builds the sub-models, `march` finds the periodic motion, `record` turns a cycle into results, `draw` into pictures.

pub mod assemble;
pub mod case;
mod draw;
pub mod march;
mod notes;
pub mod plan;
pub mod record;
pub mod results;
pub mod row;
pub mod survey;
pub mod trajectory;

use gudgeon_core::kinds::Lateral;
use gudgeon_core::result::{ModelUse, Note, RunResult, Skipped, SolverReport};
use gudgeon_core::{BuildError, Registry};

use assemble::{Assembly, assemble, impossible};
use case::{Method, PistonSecondaryCase};
use gudgeon_case::Loaded;
use gudgeon_scene::{Explanation, MethodSetting, Progress, RunError, SceneCase, WorkPrecision, model_use};
use march::Purpose;
use plan::ResultInfo;
use record::Record;
use row::Look;
use survey::Survey;

impl SceneCase for PistonSecondaryCase {
    /// The piston as its models have it. A run builds others beside it: on coarser films, or with a rigid skirt.
    type Built = Assembly;

    fn build(loaded: &Loaded<Self>) -> Result<Assembly, Vec<BuildError>> {
        let mut a = assemble(&loaded.value, &loaded.source.files, true, None)?;
        let mut errors = impossible(&loaded.value, &mut a);
        errors.extend(plan::wanted(&loaded.value, &a).err().unwrap_or_default());
        if errors.is_empty() { Ok(a) } else { Err(errors) }
    }

    fn explain(
        loaded: &Loaded<Self>,
        a: &mut Assembly,
        told: &mut Explanation,
    ) -> Result<Vec<ModelUse>, RunError> {
        let case = &loaded.value;
        let wanted = wanted(case, a)?;
        let why = |what: &str, why: &str| Skipped { what: what.into(), why: why.into() };
        told.runs.push(why("films of both sides", "their forces move the piston"));
        let (mut skipped, more) = skipped(case, a, &wanted);
        told.runs.extend(more);
        told.skipped.append(&mut skipped);
        told.results = wanted.into_iter().map(|r| r.name).collect();
        if !matches!(a.lateral, Lateral::Held { .. }) {
            told.states = vec!["e_top".into(), "e_bottom".into()];
            for (side, name) in a.piston.sides.iter().zip(["thrust", "anti-thrust"]) {
                told.states.extend((1..=side.elastic()).map(|k| format!("shape {k} of the {name} side")));
            }
        }
        if a.lateral == Lateral::Inertial {
            told.states.extend(["e_top_rate".into(), "e_bottom_rate".into()]);
        }
        Ok(models(case))
    }

    fn result_names(loaded: &Loaded<Self>, a: &mut Assembly) -> Option<Vec<String>> {
        Some(wanted(&loaded.value, a).ok()?.into_iter().map(|r| r.name).collect())
    }

    fn run(
        loaded: &Loaded<Self>,
        _: Assembly,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<RunResult, RunError> {
        let case = &loaded.value;
        let built = |elastic: bool, intervals: Option<[u32; 2]>| {
            assemble(case, &loaded.source.files, elastic, intervals).map_err(refused)
        };
        let mut a = built(false, None)?;
        let wanted = wanted(case, &a)?;
        let flows = wanted.iter().any(|r| r.flow);
        let periodic = case.solver.cycles == 0 && !matches!(a.lateral, Lateral::Held { .. });
        let coarse = coarse(case);
        let mut search = Search::default();
        let mut elastic = case.models.skirt_compliance.typetag_name() != "rigid";
        let mut skipped_more = Vec::new();
        let mut start: Option<Vec<f64>> = None;
        if elastic {
            let mut hard = built(false, coarse)?;
            let soft = built(true, coarse)?.piston;
            let (shapes, inertial) = (soft.coordinates() - 2, hard.lateral == Lateral::Inertial);
            let found = search.run(
                "rigid skirt",
                case,
                &mut hard,
                None,
                Purpose::Look,
                coarse.is_some(),
                progress,
            )?;
            let (yielding, yields_first) = record::yielding(&mut hard, &found.trajectory, &soft)?;
            elastic = yielding >= case.solver.rigid_below.si();
            if periodic {
                let mut s = found.start[..2].to_vec();
                if elastic {
                    s.extend(&yields_first);
                    debug_assert_eq!(s.len(), 2 + shapes, "one amplitude a shape");
                }
                s.extend(if inertial { &found.start[2..4] } else { &[] });
                start = Some(s);
            }
            if !elastic {
                skipped_more.push(Skipped {
                    what: "yielding of the skirt".into(),
                    why: format!(
                        "the pressures on the rigid skirt would move its surface by {:.2} % of the gap at most, below {:.3} %: `solver.rigid_below`",
                        100.0 * yielding,
                        100.0 * case.solver.rigid_below.si()
                    ),
                });
            }
        }
        let looked_at = elastic || start.is_none();
        if let (true, true, Some(_)) = (periodic, looked_at, coarse) {
            // A start that is wrong costs cycles; one that is not found costs nothing more.
            let mut a = built(elastic, coarse)?;
            let from = start.as_deref();
            if let Ok(found) = search.run("coarse film", case, &mut a, from, Purpose::Start, true, progress) {
                start = Some(found.start);
            }
        }
        if elastic {
            a = built(true, None)?;
        }
        let phase = if elastic { "elastic skirt" } else { "rigid skirt" };
        let found = search.run(phase, case, &mut a, start.as_deref(), Purpose::Results, false, progress)?;
        let mut result = RunResult { models: models(case), ..RunResult::default() };
        (result.skipped, _) = skipped(case, &a, &wanted);
        result.skipped.extend(skipped_more);
        let bends = a.breakpoints.clone();
        let mut look = Look::new(&mut a, &found.trajectory, flows);
        let before = work(&look.a.piston);
        // Results come first: no row that is shown can change them.
        let (told, notes) = Survey::new(&mut look, &bends)
            .and_then(|s| {
                let told = results::tell(&s, &mut look, case, &wanted, found.periodicity_error)?;
                let notes = notes::notes(&s, &mut look, told.peaks)?;
                Ok((told, notes))
            })
            .map_err(|e| look.stopped(e))?;
        let record = Record::new(&mut look, case, told.peaks, flows).map_err(|e| look.stopped(e))?;
        for ((name, now), before) in work(&look.a.piston).into_iter().zip(before) {
            *search.counters.entry(name.to_owned()).or_default() += now - before.1;
        }
        (result.results, result.events) = (told.results, told.events);
        result.solver = SolverReport {
            method: match case.solver.method {
                Method::Implicit => "implicit",
                Method::BackwardEuler => "backward_euler",
                Method::AsPublished => "as_published",
            }
            .into(),
            counters: search.counters,
            notes: a.cylinder.notes().into_iter().chain(found.notes.iter().cloned()).collect(),
        };
        result.solver.notes.extend(notes);
        result.solver.notes.push(Note::info(
            "centre_of_gravity",
            format!(
                "Centre of gravity {:.3} mm from the pin on its {} side",
                1e3 * case.piston.gravity_offset.si(),
                match case.piston.gravity_side {
                    case::GravitySide::Thrust => "thrust",
                    case::GravitySide::AntiThrust => "anti-thrust",
                }
            ),
        ));
        draw::figures(&a, &record, &mut result);
        result.series = record.series();
        result.seconds.insert("solve".into(), search.seconds);
        Ok(result)
    }

    fn work_precision(loaded: &Loaded<Self>, _: &mut Assembly) -> Option<WorkPrecision> {
        let fine = |tolerance: f64, along: u32, across: u32| {
            vec![
                "solver.method=implicit".into(),
                "solver.integrator=rodas5p".into(),
                format!("solver.tolerance={tolerance:e}"),
                format!("solver.intervals_along={along}"),
                format!("solver.intervals_across={across}"),
            ]
        };
        Some(WorkPrecision {
            methods: METHODS.to_vec(),
            settings: settings(&loaded.value),
            reference: fine(1e-6, 80, 64),
            reference_check: fine(1e-5, 56, 48),
            reference_is: "implicit, order 5, tolerance 1e-6 and 80 x 64 intervals of the film; differs from 1e-5 and 56 x 48",
            results: vec!["friction_power", "friction_force_min", "p_max"],
        })
    }
}

/// Methods of the race.
const METHODS: [&str; 4] =
    ["implicit, order 3", "implicit, order 5", "backward Euler", "backward Euler, published film"];

/// Every method with the films that its steps deserve.
fn settings(case: &PistonSecondaryCase) -> Vec<MethodSetting> {
    let mut all = Vec::new();
    let s = &case.solver;
    let mesh = |along: u32, across: u32| {
        [format!("solver.intervals_along={along}"), format!("solver.intervals_across={across}")]
    };
    for (method, name, points) in [
        (METHODS[0], "rodas3", &[(1e-2, 12, 10), (3e-3, 16, 12), (1e-3, 20, 16), (3e-4, 32, 20)][..]),
        (METHODS[1], "rodas5p", &[(1e-3, 20, 16), (1e-4, 32, 20), (1e-5, 48, 32)]),
    ] {
        for &(t, along, across) in points {
            let own =
                s.method == Method::Implicit && (along, across) == (s.intervals_along, s.intervals_across);
            let mut set = vec![
                "solver.method=implicit".into(),
                format!("solver.integrator={name}"),
                format!("solver.tolerance={t:e}"),
            ];
            set.extend(mesh(along, across));
            all.push(MethodSetting {
                method,
                setting: format!("tolerance {t:.0e}, {along} x {across}"),
                is_default: own && method == METHODS[0] && (t / s.tolerance.si() - 1.0).abs() < 1e-9,
                set,
            });
        }
    }
    for (method, film, points) in [
        (
            METHODS[2],
            "{ model = \"direct\", cavitation = \"half_sommerfeld\" }",
            &[(2.0, 12, 10), (1.0, 16, 12), (0.5, 20, 16)][..],
        ),
        (METHODS[3], "{ model = \"central_differences\" }", &[(0.5, 9, 9), (0.5, 13, 13)]),
    ] {
        for &(step, along, across) in points {
            let mut set = vec![
                "solver.method=backward_euler".into(),
                format!("solver.step={step} deg"),
                format!("models.film_2d={film}"),
                "outputs.series_step=2 deg".into(),
            ];
            set.extend(mesh(along, across));
            all.push(MethodSetting {
                method,
                setting: format!("steps of {step} deg, {along} x {across}"),
                is_default: false,
                set,
            });
        }
    }
    all
}

fn refused(e: Vec<BuildError>) -> RunError {
    RunError::Refused(e.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))
}

fn wanted(case: &PistonSecondaryCase, a: &Assembly) -> Result<Vec<ResultInfo>, RunError> {
    plan::wanted(case, a).map_err(refused)
}

/// Intervals of a film that is coarse enough to look for a start with, when that of the case is much finer.
fn coarse(case: &PistonSecondaryCase) -> Option<[u32; 2]> {
    let s = &case.solver;
    let [along, across] = COARSE;
    let much_finer = s.intervals_along * s.intervals_across >= 4 * along * across;
    (s.cycles == 0 && much_finer).then(|| [s.intervals_along.min(along), s.intervals_across.min(across)])
}

/// Forces within some percent, at a hundredth of the work of 64 x 48.
const COARSE: [u32; 2] = [16, 12];

/// What the films of a piston took so far.
fn work(piston: &gudgeon_skirt::Piston) -> [(&'static str, u64); 3] {
    [
        ("film_evaluations", piston.film_evaluations()),
        ("contact_sums", piston.sides.iter().map(|s| s.contact_sums).sum()),
        ("newton_steps", piston.newton_steps),
    ]
}

/// What all motions of a run took together.
#[derive(Default)]
struct Search {
    counters: indexmap::IndexMap<String, u64>,
    seconds: f64,
}

impl Search {
    /// A motion for `purpose`; `coarse`: on a film that is not that of the case.
    #[allow(clippy::too_many_arguments, reason = "a motion and how it is told")]
    fn run(
        &mut self,
        phase: &str,
        case: &PistonSecondaryCase,
        a: &mut Assembly,
        start: Option<&[f64]>,
        purpose: Purpose,
        coarse: bool,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<march::Found, RunError> {
        let mut tell = |fraction: f64| progress(Progress { phase: phase.to_owned(), fraction });
        let found = march::run(case, a, start, purpose, &mut tell)?;
        self.seconds += found.seconds;
        let s = &found.stats;
        let cycles = if coarse { "coarse_cycles" } else { "cycles" };
        for (name, n) in [
            ("steps", s.steps),
            ("rejected", s.rejected),
            ("rhs", s.rhs),
            ("jacobians", s.jacobians),
            (cycles, found.cycles.ceil() as u64),
        ]
        .into_iter()
        .chain(work(&a.piston))
        {
            *self.counters.entry(name.to_owned()).or_default() += n;
        }
        let nodes = a.piston.sides.iter().map(|s| s.nodes() as u64).sum();
        self.counters.insert("nodes".into(), nodes);
        Ok(found)
    }
}

/// What is left out, and what runs besides the films.
fn skipped(case: &PistonSecondaryCase, a: &Assembly, wanted: &[ResultInfo]) -> (Vec<Skipped>, Vec<Skipped>) {
    let (mut out, mut runs) = (Vec::new(), Vec::new());
    let m = &case.models;
    let mut say = |runs_it: bool, what: &str, why: &str| {
        let s = Skipped { what: what.into(), why: why.into() };
        if runs_it { runs.push(s) } else { out.push(s) }
    };
    let off = |name: &str| name == "off";
    let contact = !off(m.contact.typetag_name());
    say(
        contact,
        "solid contact",
        if contact { "summed where the gap is within its range" } else { "the contact model is `off`" },
    );
    let pin = !off(m.pin_friction.typetag_name());
    say(pin, "friction of the pin", if pin { "it turns the piston" } else { "the model is `off`" });
    let rings = !off(m.groove_friction.typetag_name());
    say(
        rings,
        "friction of the rings in their grooves",
        if rings { "it holds the piston" } else { "the model is `off`" },
    );
    let rod = case.rod.is_some();
    say(rod, "inertia of the rod", if rod { "it presses the pin aside" } else { "the rod has no mass" });
    let flow = wanted.iter().any(|r| r.flow);
    say(
        flow,
        "flow of oil over the edges of the skirt",
        if flow { "a wanted result needs it" } else { "no wanted result needs it" },
    );
    match a.lateral {
        Lateral::Inertial => say(true, "inertia across the bore", "`full_inertia`"),
        Lateral::QuasiStatic => {
            say(
                false,
                "inertia across the bore",
                "`quasi_static`: films and rod are in balance at every instant",
            );
        }
        Lateral::Held { .. } => {
            say(false, "motion across the bore", "`held`: the skirt stands where it is told")
        }
    }
    let whole = a.piston.sides.iter().all(|s| s.nodes() == s.grid().len());
    say(
        whole,
        "one half of each side",
        if whole {
            "an odd number of intervals, or a shape that is no mirror image"
        } else {
            "it is the mirror image of the other"
        },
    );
    (out, runs)
}

/// The models in use.
fn models(case: &PistonSecondaryCase) -> Vec<ModelUse> {
    let registry = Registry::collect();
    let m = &case.models;
    [
        ("kinematics", m.kinematics.typetag_name()),
        ("cylinder_pressure", m.cylinder_pressure.typetag_name()),
        ("secondary_motion", m.secondary_motion.typetag_name()),
        ("film_2d", m.film_2d.typetag_name()),
        ("roughness", m.roughness.typetag_name()),
        ("contact", m.contact.typetag_name()),
        ("skirt_profile", m.skirt_profile.typetag_name()),
        ("skirt_compliance", m.skirt_compliance.typetag_name()),
        ("pin_friction", m.pin_friction.typetag_name()),
        ("groove_friction", m.groove_friction.typetag_name()),
        ("oil", m.oil.typetag_name()),
        ("shear_thinning", m.shear_thinning.typetag_name()),
    ]
    .into_iter()
    .map(|(kind, model)| model_use(&registry, kind, model))
    .collect()
}

gudgeon_scene::register_scene! {
    PistonSecondaryCase,
    name: "piston_secondary",
    summary: "the lateral motion and the tilt of a piston in its bore",
    equations: "forces and moments of films, contact, rod, gas and friction balance mass times acceleration in two coordinates e_t, e_b and one for every shape of an elastic side",
    validity: "Motion in the plane of the rod; one viscosity for both sides; inertia of shapes left out.",
    references: ["loureiro2009", "zhu1992"],
}
