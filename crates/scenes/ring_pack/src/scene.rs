//! The ring pack as a scene: what it refuses, explains, runs and races.

use gudgeon_core::BuildError;
use gudgeon_core::result::{Figure, FigureKind, ModelUse, RunResult};

use super::used::models_in_use;
use super::{assemble, geometry, legal, meter, pack::Pack, solve, state_names};
use crate::case::{Method, RingPackCase, Scheme};
use gudgeon_case::{Loaded, Refinement};
use gudgeon_scene::{
    Explanation, IntegratorName, MethodSetting, Progress, RunError, SceneCase, WorkPrecision,
};

impl SceneCase for RingPackCase {
    type Built = Pack;

    fn build(loaded: &Loaded<Self>) -> Result<Pack, Vec<BuildError>> {
        let built = assemble::assemble(&loaded.value, &loaded.source.files);
        let also = legal(&loaded.value);
        match built {
            Ok(pack) if also.is_empty() => Ok(pack),
            Ok(_) => Err(also),
            Err(e) => Err(e.into_iter().chain(also).collect()),
        }
    }

    fn explain(
        loaded: &Loaded<Self>,
        pack: &mut Pack,
        told: &mut Explanation,
    ) -> Result<Vec<ModelUse>, RunError> {
        let (used, skipped) = models_in_use(&loaded.value, &pack.plan);
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
        progress: &mut dyn FnMut(Progress),
    ) -> Result<RunResult, RunError> {
        let case = &loaded.value;
        let solved = solve(case, &mut pack, progress)?;
        let mut result = RunResult::default();
        (result.models, result.skipped) = models_in_use(case, &pack.plan);
        result.results = solved.cycle.results(&pack, meter(case));
        result.balance = solved.cycle.totals.balance.clone();
        result.events = solved.cycle.events();
        result.events.extend(solved.retreats);
        result.events.sort_by(|a, b| a.theta_deg.total_cmp(&b.theta_deg));
        result.branches = solved.branches;
        result.solver = solved.report;
        result.series = solved.record.series();
        if let Some(liner) = solved.liner {
            let lines =
                liner.columns.iter().map(|c| (c.name.replace("film_at_", "") + " deg", c.name.clone()));
            result.figures.push(Figure {
                title: "Oil on the liner".into(),
                hint: "at the dead centres, over the height above the lowest place of the gudgeon pin".into(),
                table: "liner".into(),
                kind: FigureKind::Lines {
                    x: "height".into(),
                    lines: lines.collect(),
                    log_x: false,
                    log_y: true,
                },
            });
            result.tables.insert("liner".into(), liner);
        }
        result.section = Some(geometry::section(case, &pack.geo));
        result.seconds.insert("solve".into(), solved.seconds);
        Ok(result)
    }

    /// The steps of a published scheme are the source's where the case names none.
    fn refinements(loaded: &Loaded<Self>) -> Vec<Refinement> {
        let case = &loaded.value;
        loaded.refinements_with(|resolved| {
            if case.solver.steps_per_degree == 0 {
                let own = match case.solver.scheme {
                    Scheme::SubstepMarch => case.rings.len() + 1,
                    Scheme::DegreeMarch => 1,
                };
                resolved["solver"]["steps_per_degree"] = own.into();
            }
        })
    }

    fn result_names(_: &Loaded<Self>, pack: &mut Pack) -> Option<Vec<String>> {
        Some(pack.plan.wanted.clone())
    }

    fn work_precision(loaded: &Loaded<Self>, pack: &mut Pack) -> Option<WorkPrecision> {
        let radau = |tolerance: f64| {
            vec![
                "solver.method=implicit".into(),
                "solver.integrator=radau5".into(),
                format!("solver.tolerance={tolerance:e}"),
                format!("solver.periodicity={tolerance:e}"),
            ]
        };
        Some(WorkPrecision {
            methods: METHODS.to_vec(),
            settings: settings(&loaded.value, pack.decision_interval().is_some()),
            reference: radau(1e-8),
            reference_check: radau(1e-7),
            reference_is: "implicit system, Radau IIA order 5, tolerance 1e-8; differs from the same at 1e-7",
            results: vec!["blow_by", "friction_power", "land2.p_max"],
        })
    }
}

/// Methods that are compared.
const METHODS: [&str; 3] = ["implicit, order 3", "implicit, order 5", "as_published"];

/// Every solver at every accuracy.
fn settings(case: &RingPackCase, discrete: bool) -> Vec<MethodSetting> {
    let mut all = Vec::new();
    let default = case.solver.tolerance.si();
    let orders: [(&str, &str, IntegratorName, &[f64]); 2] = [
        (METHODS[0], "rodas3", IntegratorName::Rodas3, &[1e-2, 3e-3, 1e-3, 3e-4, 1e-4]),
        (METHODS[1], "rodas5p", IntegratorName::Rodas5p, &[1e-2, 1e-3, 1e-4, 1e-5, 1e-6]),
    ];
    for (method, name, integrator, tolerances) in orders {
        for &t in tolerances {
            all.push(MethodSetting {
                method,
                setting: format!("tolerance {t:.0e}"),
                is_default: (t / default - 1.0).abs() < 1e-9
                    && case.solver.integrator.at(default) == integrator,
                set: vec![
                    "solver.method=implicit".into(),
                    format!("solver.integrator={name}"),
                    format!("solver.tolerance={t:e}"),
                    format!("solver.periodicity={t:e}"),
                ],
            });
        }
    }
    let rings = case.rings.len() as u32;
    let published = case.solver.method == Method::AsPublished;
    // The published scheme and its own refinement. The scheme follows from whether anything is decided in steps.
    let (scheme, own) = if discrete { ("degree_march", 1) } else { ("substep_march", rings + 1) };
    for factor in [1u32, 2, 4, 8] {
        let steps = own * factor;
        let gas = if published && case.solver.gas_steps > 0 { case.solver.gas_steps } else { 0 };
        all.push(MethodSetting {
            method: METHODS[2],
            setting: format!("{steps} steps per degree"),
            is_default: factor == 1,
            set: vec![
                "solver.method=as_published".into(),
                format!("solver.scheme={scheme}"),
                format!("solver.steps_per_degree={steps}"),
                format!("solver.gas_steps={gas}"),
                "solver.passes=720".into(),
                // The scheme as printed has no limit in a keystone groove; this variant of its flank rule has.
                "solver.clamp=inward".into(),
                format!("solver.cycles={}", if discrete { 8 } else { 3 }),
            ],
        });
    }
    all
}

gudgeon_scene::register_scene! {
    RingPackCase,
    name: "ring_pack",
    summary: "a piston ring pack in one cylinder",
    equations: "gas: dm/dt = sum of flows, p V = m R T;  film: W_film(h, dh/dt) + W_contact(h) = W_gas + W_tension;  axial: m d2s/dt2 = F_gas + F_inertia + F_film + F_damping + F_flank",
    validity: "Rigid rings that keep their shape and do not twist, axially symmetric but for their gaps; radial inertia left out.",
    references: ["zottin1992", "tomanik1993"],
}
