//! The ring pack as a scene: what it refuses, explains, runs and how its solvers compare.

use std::borrow::Cow;

use gudgeon_core::BuildError;
use gudgeon_core::kinds::EngineCycle;
use gudgeon_core::result::{Figure, FigureKind, Gradients, Lines, ModelUse, Note, RunResult};

use super::around::{Around, Varied};
use super::gas_balance::{self, GasBalance};
use super::headlines::headlines;
use super::pack::Pack;
use super::rails::TakenApart;
use super::solve::{elsewhere, solve, starts, wanted};
use super::solver::RingPackSolverSpec;
use super::twin::Twin;
use super::used::models_in_use;
use super::{assemble, draw, film_strokes, geometry, legal, liner_wear, meter, plausible, state_names};
use crate::case::RingPackCase;
use gudgeon_case::{Loaded, Refinement};
use gudgeon_scene::elsewhere::Elsewhere;
use gudgeon_scene::{
    Explanation, GradientError, MethodSetting, Progress, Reference, RunError, SceneCase, Stopped,
    WorkPrecision, default_solvers,
};

impl SceneCase for RingPackCase {
    type Built = Pack;

    fn build(loaded: &Loaded<Self>) -> Result<Pack, Vec<BuildError>> {
        let case = &loaded.value;
        let impossible = plausible::impossible(loaded);
        if !impossible.is_empty() {
            return Err(impossible);
        }
        let built = assemble::assemble(case, &loaded.source.files);
        let mut errors = legal(case);
        match built {
            Ok(pack) => {
                errors.extend(case.solver.method.refuses(&pack));
                if errors.is_empty() { Ok(pack) } else { Err(errors) }
            }
            Err(e) => Err(e.into_iter().chain(errors).collect()),
        }
    }

    fn doubts(loaded: &Loaded<Self>, pack: &mut Pack) -> Vec<Note> {
        plausible::unusual(loaded).into_iter().chain(pack.cylinder.notes()).collect()
    }

    fn explain(
        loaded: &Loaded<Self>,
        pack: &mut Pack,
        told: &mut Explanation,
    ) -> Result<Vec<ModelUse>, RunError> {
        let (used, skipped) = models_in_use(&*bodies(&loaded.value)?, &pack.plan);
        told.runs.clone_from(&pack.plan.runs);
        told.skipped = skipped;
        told.results.clone_from(&pack.plan.wanted);
        told.limits = loaded.value.solver.limits.explained();
        told.states = state_names(pack);
        Ok(used)
    }

    fn run(
        loaded: &Loaded<Self>,
        mut pack: Pack,
        progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
    ) -> Result<RunResult, RunError> {
        let case = &loaded.value;
        let bodies = bodies(case)?;
        if case.solver.method.works_at_once(&pack) {
            pack.twin = Twin::new(|| assemble::assemble(case, &loaded.source.files).ok());
        }
        let solved = solve(case, &mut pack, progress)?;
        pack.twin = None;
        let mut result = RunResult::default();
        (result.models, result.skipped) = models_in_use(&bodies, &pack.plan);
        result.results = solved.cycle.results(&pack, meter(case));
        result.balance = solved.cycle.totals.balance.clone();
        result.events = solved.cycle.events();
        result.events.extend(solved.retreats);
        result.events.sort_by(|a, b| a.theta_deg.total_cmp(&b.theta_deg));
        result.branches = solved.branches;
        result.solver = solved.report;
        result.solver.notes.splice(0..0, plausible::unusual(loaded));
        result.series = solved.record.series();
        result.headlines = headlines(&pack.names);
        if pack.plan.film {
            let films = film_strokes::table(&solved.cycle.measures, pack.period());
            result.tables.insert("films".into(), films);
            result.figures.push(film_strokes::figure(
                &solved.cycle.measures,
                pack.period(),
                &ring_names(&pack),
            ));
        }
        let balance = GasBalance::of(&pack, &solved.cycle);
        if let Some(figure) = gas_balance::figure(&balance, &ring_names(&pack)) {
            result.tables.insert("blow_by".into(), gas_balance::table(&balance));
            result.figures.push(figure);
        }
        if let Some(liner) = solved.liner {
            let lines =
                liner.columns.iter().map(|c| (c.name.replace("film_at_", "") + " deg", c.name.clone()));
            result.figures.push(Figure {
                title: "Oil on the liner".into(),
                hint: "at the dead centres, over the height above the lowest place of the gudgeon pin".into(),
                table: "liner".into(),
                kind: FigureKind::Lines(Lines {
                    x: "height".into(),
                    lines: lines.collect(),
                    log_y: true,
                    ..Lines::default()
                }),
            });
            result.tables.insert("liner".into(), liner);
        }
        let stroke = case.engine.crank().map_err(|e| RunError::refused(&[e]))?.radius * 2.0;
        let section = geometry::section(&bodies, &pack.geo, stroke);
        draw::figures(&mut result, &ring_names(&pack), section.bore_radius);
        liner_wear::figure(&mut result, &ring_names(&pack), &section, pack.omega);
        result.section = Some(section);
        result.seconds.insert("solve".into(), solved.seconds);
        Ok(result)
    }

    /// Numbers that the case leaves to its solver are filled in.
    fn refinements(loaded: &Loaded<Self>) -> Vec<Refinement> {
        let case = &loaded.value;
        let bodies = TakenApart::new(case).map_or(case.rings.len(), |apart| apart.case.rings.len());
        loaded.refinements_with(|all| case.solver.method.resolve(bodies, &mut all["solver"]))
    }

    fn elsewhere(loaded: &Loaded<Self>, pack: &mut Pack) -> Vec<Elsewhere> {
        elsewhere(&loaded.value, pack).into_iter().collect()
    }

    fn cycle(loaded: &Loaded<Self>) -> Option<Result<EngineCycle, BuildError>> {
        let (c, files) = (&loaded.value, &loaded.source.files);
        let (motion, gas) = (&*c.models.kinematics, &*c.models.cylinder_pressure);
        Some(c.engine.cycle(motion, gas, c.gas.crankcase_pressure, files))
    }

    fn result_names(_: &Loaded<Self>, pack: &mut Pack) -> Option<Vec<String>> {
        Some(pack.plan.wanted.clone())
    }

    fn gradients(
        loaded: &Loaded<Self>,
        mut pack: Pack,
        varied: &dyn Fn() -> Result<Vec<gudgeon_scene::Varied<Self>>, GradientError>,
        progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
    ) -> Result<Gradients, GradientError> {
        let case = &loaded.value;
        let mut varied: Vec<_> = varied()?
            .into_iter()
            .map(|v| Varied { step: v.step, pack: v.built, meter: meter(&v.loaded.value) })
            .collect();
        let wanted = wanted(case);
        let around = Around { meter: meter(case), varied: &mut varied };
        let start = starts(case, &pack)[0];
        let mut tell = |fraction| progress(Progress { phase: "derivatives".into(), fraction });
        case.solver.method.gradients(&mut pack, start, &wanted, around, &mut tell)
    }

    fn work_precision(loaded: &Loaded<Self>, pack: &mut Pack) -> Result<WorkPrecision, String> {
        let radau = |tolerance: f64| {
            vec![
                "solver.method=implicit".into(),
                "solver.integrator=radau5".into(),
                format!("solver.tolerance={tolerance:e}"),
                format!("solver.periodicity={tolerance:e}"),
            ]
        };
        Ok(WorkPrecision {
            settings: settings(&loaded.value, pack),
            reference: Some(Reference {
                set: radau(1e-8),
                check: radau(1e-7),
                is: "implicit system, Radau IIA order 5, tolerance 1e-8; differs from the same at 1e-7"
                    .into(),
                independent: true,
                told_as: Vec::new(),
            }),
            results: ["blow_by", "friction_power", "land2.p_max"].map(str::to_owned).to_vec(),
            ..WorkPrecision::default()
        })
    }
}

/// What the rings are called, crown first.
fn ring_names(pack: &Pack) -> Vec<String> {
    pack.names.rings.iter().map(|(name, _)| name.clone()).collect()
}

/// The case with three-piece rings taken apart.
fn bodies(case: &RingPackCase) -> Result<Cow<'_, RingPackCase>, RunError> {
    TakenApart::new(case).map(|apart| apart.case).map_err(|e| RunError::refused(&e))
}

/// Every registered solver that can solve the pack, at every accuracy.
fn settings(case: &RingPackCase, pack: &Pack) -> Vec<MethodSetting> {
    let own = case.solver.method.typetag_name();
    let table = serde_json::to_value(&case.solver.method).ok();
    default_solvers::<dyn RingPackSolverSpec>()
        .into_iter()
        .filter(|(_, s)| s.refuses(pack).is_empty())
        .flat_map(|(name, s)| {
            let mut given = table.clone().filter(|_| name == own);
            if let Some(o) = given.as_mut().and_then(|v| v.as_object_mut()) {
                o.remove("model");
            }
            s.settings(pack, given.as_ref())
        })
        .collect()
}

gudgeon_scene::register_scene! {
    RingPackCase,
    name: "ring_pack",
    summary: "a piston ring pack in one cylinder",
    equations: "gas: dm/dt = sum of flows, p V = m R T;  film: W_film(h, dh/dt) + W_contact(h) = W_gas + W_tension;  axial: m d2s/dt2 = F_gas + F_inertia + F_film + F_damping + F_flank",
    validity: "Rigid rings that keep their shape and do not twist, axially symmetric but for their gaps; radial inertia left out.",
    references: ["zottin1992", "tomanik1993"],
}
