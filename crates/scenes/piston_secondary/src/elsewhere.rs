//! Other starts of a piston: one in ten has two periodic motions, and which one a search finds, its start decides.

use gudgeon_scene::elsewhere::Elsewhere;

use super::assembly::Assembly;
use super::case::PistonSecondaryCase;

/// Displacements of the upper and lower edge over the clearance. Of 200 pistons that differ at random 20 have a second motion: the first of these starts leads to it from 17,
/// one of the others from the rest.
const STARTS: [[f64; 2]; 3] = [[0.5, -0.5], [0.5, 0.5], [-0.5, -0.5]];
/// Starts nearer than this part of the clearance are one.
const ONE: f64 = 0.1;

/// The starts of `case` beside its own; none where its cycles are counted, or nothing moves.
pub(super) fn elsewhere(case: &PistonSecondaryCase, a: &Assembly) -> Vec<Elsewhere> {
    let s = &case.solver;
    if s.cycles > 0 || a.layout.n == 0 {
        return Vec::new();
    }
    let own = [s.start_top.si(), s.start_bottom.si()];
    let starts = STARTS.iter().map(|start| start.map(|part| part * a.clearance));
    let others = starts.filter(|start| own.iter().zip(start).any(|(x, y)| (x - y).abs() > ONE * a.clearance));
    others.map(|start| Elsewhere { starts: [own, start].map(named), set: set(start) }).collect()
}

/// The settings of a start.
fn set([top, bottom]: [f64; 2]) -> Vec<String> {
    vec![format!("solver.start_top={top:.6e} m"), format!("solver.start_bottom={bottom:.6e} m")]
}

/// A start in words.
fn named([top, bottom]: [f64; 2]) -> String {
    format!("the upper edge at {:.2} um and the lower one at {:.2} um", 1e6 * top, 1e6 * bottom)
}
