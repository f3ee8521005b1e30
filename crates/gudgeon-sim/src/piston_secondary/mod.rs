//! The scene `piston_secondary`: lateral motion and tilt of one piston on the films and crests of its skirt.
//!
//! `assemble` builds the sub-models, `march` finds the periodic motion, `record` turns a cycle into results, `draw` into pictures.

pub mod assemble;
pub mod case;
mod draw;
pub mod march;
pub mod plan;
pub mod record;

use std::time::Instant;

use gudgeon_core::kinds::Lateral;
use gudgeon_core::result::{ModelUse, RunResult, Skipped, SolverReport};
use gudgeon_core::{BuildError, Registry};

use crate::load::Loaded;
use crate::run::{Explanation, Progress, RunError, model_use};
use crate::scene::SceneCase;
use crate::study::{Contender, Race};
use assemble::{Assembly, assemble};
use case::{Method, PistonSecondaryCase};
use plan::ResultInfo;

/// Part of the film by which a skirt may yield that is taken for rigid.
const YIELDING: f64 = 0.02;

impl SceneCase for PistonSecondaryCase {
    fn legal(loaded: &Loaded<Self>) -> Vec<BuildError> {
        match assemble(&loaded.value, &loaded.source.folder, true) {
            Ok(a) => plan::wanted(&loaded.value, &a).err().unwrap_or_default(),
            Err(e) => e,
        }
    }

    fn explain(loaded: &Loaded<Self>, told: &mut Explanation) -> Result<Vec<ModelUse>, RunError> {
        let case = &loaded.value;
        let a = build(loaded, true)?;
        let wanted = wanted(case, &a)?;
        let why = |what: &str, why: &str| Skipped { what: what.into(), why: why.into() };
        told.runs.push(why("films of both sides", "their forces move the piston"));
        let (mut skipped, more) = skipped(case, &a, &wanted);
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

    fn run(loaded: &Loaded<Self>, progress: &mut dyn FnMut(Progress)) -> Result<RunResult, RunError> {
        let begin = Instant::now();
        let case = &loaded.value;
        let mut a = build(loaded, false)?;
        let yields = case.models.skirt_compliance.typetag_name() != "rigid";
        let wanted = wanted(case, &a)?;
        let flows = wanted.iter().any(|r| r.flow);
        let built = begin.elapsed().as_secs_f64();
        let mut phase = "rigid skirt".to_owned();
        let mut tell = |fraction: f64| progress(Progress { phase: phase.clone(), fraction });
        let mut found = march::run(case, &mut a, None, flows && !yields, &mut tell)?;
        let mut seconds = found.seconds;
        let mut counters = work(&a, &found);
        let mut skipped_more = Vec::new();
        if yields {
            let soft = build(loaded, true)?;
            let (part, start) = would_yield(&found, &mut a, soft)?;
            if part.0 >= YIELDING {
                phase = "elastic skirt".into();
                a = part.1;
                let mut tell = |fraction: f64| progress(Progress { phase: phase.clone(), fraction });
                found = march::run(case, &mut a, Some(&start), flows, &mut tell)?;
                seconds += found.seconds;
                for (name, n) in work(&a, &found) {
                    counters.entry(name).and_modify(|m| *m += n).or_insert(n);
                }
            } else {
                skipped_more.push(Skipped {
                    what: "yielding of the skirt".into(),
                    why: format!(
                        "the pressures on the rigid skirt would move its surface by {:.2} % of the gap at most, below {:.0} %",
                        100.0 * part.0,
                        100.0 * YIELDING
                    ),
                });
                if flows {
                    let start = found.start.clone();
                    let mut tell = |fraction: f64| progress(Progress { phase: phase.clone(), fraction });
                    found = march::run(case, &mut a, Some(&start), true, &mut tell)?;
                }
            }
        }
        let mut result = RunResult { models: models(case), ..RunResult::default() };
        (result.skipped, _) = skipped(case, &a, &wanted);
        result.skipped.extend(skipped_more);
        result.results = found.record.results(&a, case, &wanted, found.periodicity_error);
        result.events = found.record.events();
        result.solver = SolverReport {
            method: match case.solver.method {
                Method::Implicit => "implicit",
                Method::BackwardEuler => "backward_euler",
                Method::AsPublished => "as_published",
            }
            .into(),
            counters,
            notes: found.notes.clone(),
        };
        result.solver.notes.push(format!(
            "Centre of gravity {:.3} mm from the pin on its {} side",
            1e3 * case.piston.gravity_offset.si(),
            match case.piston.gravity_side {
                case::GravitySide::Thrust => "thrust",
                case::GravitySide::AntiThrust => "anti-thrust",
            }
        ));
        draw::figures(&a, &found.record, &mut result);
        result.series = found.record.series();
        result.seconds.insert("build".into(), built);
        result.seconds.insert("solve".into(), seconds);
        Ok(result)
    }

    fn race(&self) -> Option<Race> {
        let fine = |tolerance: f64, along: u32, across: u32| {
            vec![
                "solver.method=implicit".into(),
                "solver.integrator=rodas5p".into(),
                format!("solver.tolerance={tolerance:e}"),
                format!("solver.intervals_along={along}"),
                format!("solver.intervals_across={across}"),
            ]
        };
        Some(Race {
            methods: METHODS.to_vec(),
            contenders: contenders(self),
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
fn contenders(case: &PistonSecondaryCase) -> Vec<Contender> {
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
            all.push(Contender {
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
            all.push(Contender {
                method,
                setting: format!("steps of {step} deg, {along} x {across}"),
                is_default: false,
                set,
            });
        }
    }
    all
}

fn build(loaded: &Loaded<PistonSecondaryCase>, elastic: bool) -> Result<Assembly, RunError> {
    assemble(&loaded.value, &loaded.source.folder, elastic).map_err(refused)
}

fn refused(e: Vec<BuildError>) -> RunError {
    RunError::Refused(e.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))
}

fn wanted(case: &PistonSecondaryCase, a: &Assembly) -> Result<Vec<ResultInfo>, RunError> {
    plan::wanted(case, a).map_err(refused)
}

fn work(a: &Assembly, found: &march::Found) -> indexmap::IndexMap<String, u64> {
    let s = &found.stats;
    [
        ("steps", s.steps),
        ("rejected", s.rejected),
        ("rhs", s.rhs),
        ("jacobians", s.jacobians),
        ("film_evaluations", a.piston.film_evaluations()),
        ("contact_sums", a.piston.sides.iter().map(|s| s.contact_sums).sum()),
        ("newton_steps", a.piston.newton_steps),
        ("cycles", found.cycles.ceil() as u64),
        ("nodes", a.piston.sides.iter().map(|s| s.nodes() as u64).sum()),
    ]
    .into_iter()
    .map(|(k, n)| (k.to_owned(), n))
    .collect()
}

/// How far the skirt `soft` would yield to the pressures of the rigid one, as part of the gap, and a start for its motion.
#[allow(clippy::type_complexity, reason = "the skirt is handed through")]
fn would_yield(
    found: &march::Found,
    rigid: &mut Assembly,
    soft: Assembly,
) -> Result<((f64, Assembly), Vec<f64>), RunError> {
    let n = soft.piston.coordinates();
    let mut most = 0.0_f64;
    let mut start = found.start.clone();
    start.truncate(2);
    start.resize(n, 0.0);
    start.extend(found.start.get(2..4).unwrap_or_default());
    let (top, bottom) = (found.record.column("skirt.e_top"), found.record.column("skirt.e_bottom"));
    let (vt, vb) = (found.record.column("skirt.e_top_rate"), found.record.column("skirt.e_bottom_rate"));
    for (k, &t) in found.record.rows().iter().enumerate().take(top.len()) {
        let now = rigid.instant(t);
        let eval = |source| RunError::Eval { theta_deg: t.to_degrees(), source };
        rigid.piston.summary(&now, &[top[k], bottom[k]], &[vt[k], vb[k]]).map_err(eval)?;
        let mut at = 2;
        for (hard, own) in rigid.piston.sides.iter().zip(&soft.piston.sides) {
            let q = own.yields_to(hard);
            most = most.max(own.part_of_gap(&q, hard));
            if k == 0 {
                start[at..at + q.len()].copy_from_slice(&q);
            }
            at += q.len();
        }
    }
    Ok(((most, soft), start))
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
