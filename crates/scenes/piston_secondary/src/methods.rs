//! Run time against error: every registered solver at its settings, beside a solution far finer than all of them.

use gudgeon_scene::{MethodSetting, Reference, WorkPrecision, default_solvers};

use super::case::{PistonSecondaryCase, PistonSolverSpec};
use super::solver::mesh;

/// Methods, settings and reference for diagrams of run time against error.
#[must_use]
pub fn work_precision(case: &PistonSecondaryCase) -> WorkPrecision {
    WorkPrecision {
        settings: settings(case),
        reference: Some(Reference {
            set: fine(1e-6, 80, 64),
            check: fine(1e-5, 56, 48),
            is: "Radau IIA order 5, tolerance 1e-6, on 80 x 64 intervals of the film; differs from 1e-5 and 56 x 48".into(),
            independent: true,
            told_as: Vec::new(),
        }),
        results: ["friction_power", "friction_force_min", "p_max"].map(str::to_owned).to_vec(),
        ..WorkPrecision::default()
    }
}

/// Motion and film far finer than any setting, in time by a method that is not raced.
fn fine(tolerance: f64, along: u32, across: u32) -> Vec<String> {
    let mut set: Vec<String> = vec![
        "solver.method=implicit".into(),
        "solver.integrator=radau5".into(),
        format!("solver.tolerance={tolerance:e}"),
    ];
    set.extend(mesh(along, across));
    set
}

/// The settings of the solver of the case stand for the case where they are its own.
fn settings(case: &PistonSecondaryCase) -> Vec<MethodSetting> {
    let own = case.solver.method.typetag_name();
    let film = [case.solver.intervals_along, case.solver.intervals_across];
    let of = |(name, default): (&str, Box<dyn PistonSolverSpec>)| {
        if name == own { case.solver.method.settings(Some(film)) } else { default.settings(None) }
    };
    default_solvers::<dyn PistonSolverSpec>().into_iter().flat_map(of).collect()
}
