//! From a case to a line: specs become runtimes, names become indices, contradictions go back to their place in the file.

mod ends;
mod links;
mod nodes;
mod throws;

use std::f64::consts::PI;

use gudgeon_core::BuildError;
use gudgeon_core::file::Files;
use gudgeon_core::kinds::{Drive, Line, LineDrive};
use gudgeon_core::result::Note;
use gudgeon_torsion::drive::Reversed;
use gudgeon_torsion::tree::Tree;

use super::balance::balance;
use super::case::ShaftLineCase;
use nodes::Names;

pub use throws::throws_alone;

/// A line with what results need to know of it besides.
#[derive(Debug, Default)]
pub struct Assembled {
    /// The line.
    pub line: Line,
    /// Nominal shear stress by torque \[Pa/(N m)\] of each link, with its concentration factor; none where no diameter is given.
    pub stress: Vec<Option<f64>>,
    /// Shares of the inertias in the torque that holds the mean speed, see `balance`.
    pub balance: Vec<f64>,
    /// Period of all torques over the angle of the reference shaft \[rad\].
    pub period: f64,
    /// What a person should read.
    pub notes: Vec<Note>,
}

/// Builds the line.
///
/// # Errors
/// Everything that is wrong, each at its place in the case.
pub fn assemble(case: &ShaftLineCase, files: &Files) -> Result<Assembled, Vec<BuildError>> {
    let mut errors = Vec::new();
    let mut out = Assembled::default();
    nodes::add(case, files, &mut out, &mut errors);
    let names = Names::new(case, &out.line);
    names.check(&mut errors);
    // Names first, so that all that are wrong are told together.
    let ends = ends::find(case, &names, &mut errors);
    nodes::check_ratios(&out.line, &names, &mut errors);
    if errors.is_empty() {
        let ratios: Vec<f64> = out.line.nodes.iter().map(|n| n.ratio).collect();
        let find = |n: &str| names.find(n).map(|i| (i, ratios[i]));
        out.line.throws = throws::throws(case, files, case.speed.si(), &find, &mut errors);
    }
    links::add_shafts(case, &ends.shafts, &mut out, &mut errors);
    links::add_dampers(case, (&ends.dampers, &names), &mut out, &mut errors);
    add_drives(case, &ends.drives, &mut out.line, &mut errors);
    if errors.is_empty()
        && let Err(e) = Tree::new(&out.line)
    {
        errors.push(renamed(e));
    }
    match balance(case, &out.line) {
        Ok((shares, note)) => {
            out.balance = shares;
            out.notes.extend(note.filter(|_| errors.is_empty()));
        }
        Err(e) => errors.push(e),
    }
    out.period = period(&out.line);
    out.notes.extend(window_note(&out));
    if errors.is_empty() { Ok(out) } else { Err(errors) }
}

/// Drives and loads; on a shaft that turns backwards they count in its direction.
fn add_drives(case: &ShaftLineCase, at: &[Option<usize>], line: &mut Line, errors: &mut Vec<BuildError>) {
    for (k, d) in case.drives.iter().enumerate() {
        let Some(node) = at[k] else { continue };
        match d.drive.build() {
            Ok(drive) => {
                let factor = if d.load { -1.0 } else { 1.0 };
                let (phase, drive): (_, Box<dyn Drive>) = if line.nodes[node].ratio < 0.0 {
                    (-d.phase.si(), Box::new(Reversed::new(drive)))
                } else {
                    (d.phase.si(), drive)
                };
                line.drives.push(LineDrive { node, phase, factor, drive });
            }
            Err(e) => errors.push(e.within(&format!("drives.{k}.drive"))),
        }
    }
}

/// What the line calls a link is a shaft in the case.
pub fn renamed(mut e: BuildError) -> BuildError {
    if let Some(rest) = e.field.strip_prefix("links") {
        e.field = format!("shafts{rest}");
    }
    e
}

/// Lowest orders of the reference shaft that throws and given torques bring.
fn gears(line: &Line) -> impl Iterator<Item = f64> + '_ {
    let throws = line.throws.iter().filter(|t| !t.ends.is_empty() || !t.inertia.is_constant()).map(|t| {
        let base = if t.ends.is_empty() { 1.0 } else { 2.0 * PI / gudgeon_torsion::forcing::gas_period(t) };
        base * line.nodes[t.node].ratio.abs()
    });
    let drives = line.drives.iter().flat_map(|d| {
        let ratio = line.nodes[d.node].ratio.abs();
        d.drive.orders().iter().map(move |o| o.order * ratio)
    });
    throws.chain(drives)
}

/// Period of the reference shaft \[rad\] after which all torques repeat: one turn, or two where anything has half orders.
fn period(line: &Line) -> f64 {
    if gears(line).any(|o| (o - o.round()).abs() > 1e-9) { 4.0 * PI } else { 2.0 * PI }
}

/// Where an order does not repeat with the period.
fn window_note(a: &Assembled) -> Option<Note> {
    let odd = gears(&a.line).find(|o| {
        let per = o * a.period / (2.0 * PI);
        (per - per.round()).abs() > 1e-6
    });
    odd.map(|o| Note::caution("window", format!(
        "order {o:.6} of the reference shaft does not repeat within two turns: extremes are those of the window that is looked at"
    )))
}
