//! Methods that `bench` races, each with the films that its steps deserve.

use gudgeon_scene::{MethodSetting, WorkPrecision};

use super::case::{Method, PistonSecondaryCase};

/// The race of a case.
#[must_use]
pub fn race(case: &PistonSecondaryCase) -> WorkPrecision {
    let fine = |tolerance: f64, along: u32, across: u32| {
        vec![
            "solver.method=implicit".into(),
            "solver.integrator=rodas5p".into(),
            format!("solver.tolerance={tolerance:e}"),
            format!("solver.intervals_along={along}"),
            format!("solver.intervals_across={across}"),
        ]
    };
    let mut settings = implicit(case);
    settings.extend(backward_euler());
    WorkPrecision {
        methods: METHODS.to_vec(),
        settings,
        reference: fine(1e-6, 80, 64),
        reference_check: fine(1e-5, 56, 48),
        reference_is: "implicit, order 5, tolerance 1e-6 and 80 x 64 intervals of the film; differs from 1e-5 and 56 x 48",
        results: vec!["friction_power", "friction_force_min", "p_max"],
    }
}

/// Methods of the race.
const METHODS: [&str; 4] =
    ["implicit, order 3", "implicit, order 5", "backward Euler", "backward Euler, published film"];

/// Intervals of the film along and across.
fn mesh(along: u32, across: u32) -> [String; 2] {
    [format!("solver.intervals_along={along}"), format!("solver.intervals_across={across}")]
}

fn implicit(case: &PistonSecondaryCase) -> Vec<MethodSetting> {
    let mut all = Vec::new();
    let s = &case.solver;
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
    all
}

fn backward_euler() -> Vec<MethodSetting> {
    let mut all = Vec::new();
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
