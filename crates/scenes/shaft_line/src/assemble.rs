//! From a case to a line: specs become runtimes, names become indices, contradictions go back to their place in the file.

use std::f64::consts::PI;

use gudgeon_core::BuildError;
use gudgeon_core::file::Files;
use gudgeon_core::kinds::{
    CouplingSpec, CylinderPressureCtx, Drive, GasEnd, KinematicsCtx, Line, LineDrive, LineLink, LineNode,
    LineThrow, ThrowCtx,
};
use gudgeon_core::quantity::quantity;
use gudgeon_core::result::Note;
use gudgeon_torsion::CrankEnd;
use gudgeon_torsion::coupling::Linear;
use gudgeon_torsion::drive::Reversed;
use gudgeon_torsion::shaft::{Piece, stiffness, weakest};

use super::balance::balance;
use super::case::{ShaftCase, ShaftLineCase, Side};
use super::tors;

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

/// Builds the throws of a case at a mean speed \[rad/s\], on inertias by `find`.
fn throws(
    case: &ShaftLineCase,
    files: &Files,
    speed: f64,
    find: &dyn Fn(&str) -> Option<(usize, f64)>,
    errors: &mut Vec<BuildError>,
) -> Vec<LineThrow> {
    let mut all = Vec::new();
    for (k, t) in case.throws.iter().enumerate() {
        let here = format!("throws.{k}");
        if t.at.is_empty() {
            errors.push(BuildError::at(format!("{here}.at"), "names no inertia"));
        }
        if !t.phases.is_empty() && t.phases.len() != t.at.len() {
            let what = format!("{} phases for {} throws", t.phases.len(), t.at.len());
            errors.push(BuildError::at(format!("{here}.phases"), what));
            continue;
        }
        let ctx = ThrowCtx {
            crank_radius: t.crank_radius.si(),
            rod_length: t.rod_length.si(),
            offset: t.offset.si(),
            crank_inertia: t.crank_inertia.si(),
            rod_mass: t.rod_mass.si(),
            rod_centre: t.rod_centre.si(),
            rod_inertia: t.rod_inertia.map(|i| i.si()),
            reciprocating_mass: t.reciprocating_mass.si(),
        };
        let spec = t.throw_inertia.as_ref().unwrap_or(&case.models.throw_inertia);
        let inertia = match spec.build(&ctx) {
            Ok(i) => i,
            Err(e) => {
                errors.push(e.within(&here));
                continue;
            }
        };
        for (i, name) in t.at.iter().enumerate() {
            let Some((node, ratio)) = find(name) else { continue };
            if ratio < 0.0 {
                let what = format!("`{name}` turns backwards, which a throw does not");
                let e = BuildError::at(format!("{here}.at.{i}"), what);
                errors.push(
                    e.help("vibration does not know the sign of a ratio: give that shaft a positive one"),
                );
                continue;
            }
            let kinematics = case.models.kinematics.build(&KinematicsCtx {
                crank_radius: t.crank_radius.si(),
                rod_length: t.rod_length.si(),
                offset: t.offset.si(),
                omega: speed * ratio.abs(),
            });
            let kinematics = match kinematics {
                Ok(k) => k,
                Err(e) => {
                    errors.push(e.within(&here));
                    break;
                }
            };
            let mut ends = Vec::new();
            for (j, e) in t.ends.iter().enumerate() {
                let place = format!("{here}.ends.{j}");
                let (bore, rod) = (e.bore.si(), e.rod_diameter.si());
                let area = 0.25 * PI * (bore - rod) * (bore + rod);
                if area <= 0.0 {
                    let what = "the rod fills the bore";
                    errors.push(BuildError::at(format!("{place}.rod_diameter"), what));
                    continue;
                }
                let motion = match e.side {
                    Side::Head => kinematics.clone(),
                    Side::Crank => Box::new(CrankEnd { head: kinematics.clone() }),
                };
                let ctx = CylinderPressureCtx { kinematics: &*motion, piston_area: area, files };
                match e.cylinder_pressure.build(&ctx) {
                    Ok(pressure) => ends.push(GasEnd {
                        pressure,
                        area,
                        back_pressure: e.back_pressure.si(),
                        factor: e.factor.si(),
                        crank_radius: t.crank_radius.si(),
                        obliquity: case.conventions.obliquity,
                        kinematics: motion,
                    }),
                    // One throw is enough to say it.
                    Err(error) if i == 0 => errors.push(error.within(&format!("{place}.cylinder_pressure"))),
                    Err(_) => {}
                }
            }
            let phase = t.phases.get(i).map_or(0.0, |p| p.si());
            all.push(LineThrow { node, phase, inertia: inertia.clone(), ends });
        }
    }
    all
}

/// The throws alone, each on its own, at a mean speed \[rad/s\]: for results that need no line.
///
/// # Errors
/// As [`assemble`].
pub fn throws_alone(
    case: &ShaftLineCase,
    files: &Files,
    speed: f64,
) -> Result<Vec<LineThrow>, Vec<BuildError>> {
    let mut errors = Vec::new();
    let ratio = |name: &str| case.inertias.iter().find(|i| i.name == name).map_or(1.0, |i| i.ratio.si());
    let throws = throws(case, files, speed, &|name| Some((0, ratio(name))), &mut errors);
    if errors.is_empty() { Ok(throws) } else { Err(errors) }
}

fn coupling(
    s: &ShaftCase,
    default_damping: f64,
    here: &str,
    errors: &mut Vec<BuildError>,
) -> Option<Box<dyn CouplingSpec>> {
    let given = [s.stiffness.is_some(), !s.pieces.is_empty(), s.coupling.is_some()];
    if given.iter().filter(|g| **g).count() != 1 {
        let what = "exactly one of `stiffness`, `pieces` and `coupling` says how stiff it is";
        errors.push(BuildError::at(here, what));
        return None;
    }
    if let Some(c) = &s.coupling {
        if s.damping.is_some() || s.loss_factor.si() != 0.0 {
            errors.push(BuildError::at(here, "with `coupling` the damping belongs to it"));
        }
        return Some(c.clone());
    }
    let k = match s.stiffness {
        Some(k) => k.si(),
        None => {
            for (i, p) in s.pieces.iter().enumerate() {
                if p.bore.si() >= p.diameter.si() {
                    let what = "the bore is as wide as the shaft";
                    errors.push(BuildError::at(format!("{here}.pieces.{i}.bore"), what));
                    return None;
                }
            }
            stiffness(&pieces(s), s.shear_modulus.si())
        }
    };
    if !k.is_finite() {
        errors.push(BuildError::at(here, "the stiffness is too large to compute"));
        return None;
    }
    Some(Box::new(Linear {
        stiffness: quantity(k),
        damping: quantity(s.damping.map_or(default_damping, |d| d.si())),
        loss_factor: s.loss_factor,
    }))
}

fn pieces(s: &ShaftCase) -> Vec<Piece> {
    s.pieces
        .iter()
        .map(|p| Piece { length: p.length.si(), diameter: p.diameter.si(), bore: p.bore.si() })
        .collect()
}

/// Builds the line.
///
/// # Errors
/// Everything that is wrong, each at its place in the case.
pub fn assemble(case: &ShaftLineCase, files: &Files) -> Result<Assembled, Vec<BuildError>> {
    let mut errors = Vec::new();
    let mut out = Assembled::default();
    let line = &mut out.line;
    if let Some(file) = &case.tors {
        match tors::read(files, file) {
            Ok(import) => {
                out.notes.extend(import.report.iter().map(|r| Note::caution("tors", format!("{file}: {r}"))));
                *line = import.line;
                out.stress = import.stress;
            }
            Err(e) => errors.push(BuildError::at("tors", e)),
        }
    }
    for i in &case.inertias {
        line.nodes.push(LineNode {
            name: i.name.clone(),
            inertia: i.inertia.si(),
            damping: i.damping.si(),
            ground: i.ground.si(),
            ratio: i.ratio.si(),
        });
    }
    for d in &case.dampers {
        let ratio = line.nodes.iter().find(|n| n.name == d.at).map_or(1.0, |n| n.ratio);
        let node =
            LineNode { name: d.name.clone(), inertia: d.inertia.si(), damping: 0.0, ground: 0.0, ratio };
        line.nodes.push(node);
    }
    let names: Vec<String> = line.nodes.iter().map(|n| n.name.clone()).collect();
    let known: Vec<&str> = names.iter().map(String::as_str).collect();
    for (i, n) in known.iter().enumerate() {
        if known[..i].contains(n) {
            let own = i.saturating_sub(known.len() - case.inertias.len() - case.dampers.len());
            errors.push(BuildError::at(
                format!("inertias.{own}.name"),
                format!("`{n}` is the name of another inertia"),
            ));
        }
    }
    let find = |name: &str| known.iter().position(|n| *n == name);
    let mut need = |name: &str, place: String| {
        let found = find(name);
        if found.is_none() {
            let what = format!("there is no inertia `{name}`; {}", gudgeon_case::advice(name, &known));
            errors.push(BuildError::at(place, what));
        }
        found
    };
    // Names first, so that all that are wrong are told together.
    let ends: Vec<Option<[usize; 2]>> = case
        .shafts
        .iter()
        .enumerate()
        .map(|(k, s)| {
            let a = need(&s.from, format!("shafts.{k}.from"));
            let b = need(&s.to, format!("shafts.{k}.to"));
            Some([a?, b?])
        })
        .collect();
    let damper_at: Vec<Option<usize>> =
        case.dampers.iter().enumerate().map(|(k, d)| need(&d.at, format!("dampers.{k}.at"))).collect();
    let drive_at: Vec<Option<usize>> =
        case.drives.iter().enumerate().map(|(k, d)| need(&d.at, format!("drives.{k}.at"))).collect();
    for (k, t) in case.throws.iter().enumerate() {
        for (i, name) in t.at.iter().enumerate() {
            need(name, format!("throws.{k}.at.{i}"));
        }
    }
    let ratios: Vec<f64> = line.nodes.iter().map(|n| n.ratio).collect();
    for (i, r) in ratios.iter().enumerate() {
        if *r == 0.0 {
            let own = i.saturating_sub(ratios.len() - case.inertias.len() - case.dampers.len());
            errors.push(BuildError::at(
                format!("inertias.{own}.ratio"),
                "a ratio of zero: the inertia would not turn",
            ));
        }
    }
    if errors.is_empty() {
        line.throws = throws(case, files, case.speed.si(), &|n| find(n).map(|i| (i, ratios[i])), &mut errors);
    }
    let default_damping = match case.conventions.damping_factor {
        Some(factor) => {
            let k = case.shafts.first().and_then(|s| s.stiffness).map(|k| k.si());
            match (k, line.throws.first()) {
                (Some(k), Some(t)) => 2.0 * factor.si() * (k * t.inertia.mean()).sqrt(),
                _ => {
                    if errors.is_empty() {
                        let what = "needs a first shaft with `stiffness` and a throw";
                        errors.push(BuildError::at("conventions.damping_factor", what));
                    }
                    0.0
                }
            }
        }
        None => 0.0,
    };
    for (k, s) in case.shafts.iter().enumerate() {
        let here = format!("shafts.{k}");
        let name = if s.name.is_empty() { format!("shaft {}", line.links.len() + 1) } else { s.name.clone() };
        if line.links.iter().any(|l| l.name == name) {
            errors.push(BuildError::at(
                format!("{here}.name"),
                format!("`{name}` is the name of another shaft"),
            ));
        }
        let Some(nodes) = ends[k] else { continue };
        let Some(spec) = coupling(s, default_damping, &here, &mut errors) else { continue };
        match spec.build() {
            Ok(coupling) => line.links.push(LineLink { name, nodes, coupling }),
            Err(e) => {
                let inside = if s.coupling.is_some() { format!("{here}.coupling") } else { here.clone() };
                errors.push(e.within(&inside));
            }
        }
        let own = pieces(s);
        let section = match s.diameter {
            Some(d) if s.bore.si() >= d.si() => {
                errors.push(BuildError::at(format!("{here}.bore"), "the bore is as wide as the shaft"));
                None
            }
            Some(d) => Some(Piece { length: 1.0, diameter: d.si(), bore: s.bore.si() }),
            None => weakest(&own).copied(),
        };
        out.stress.push(section.map(|p| p.stress(1.0) * s.stress_concentration.si()));
    }
    for (k, d) in case.dampers.iter().enumerate() {
        let here = format!("dampers.{k}");
        let Some(at) = damper_at[k] else { continue };
        let Some(own) = find(&d.name) else { continue };
        let spec: Box<dyn CouplingSpec> = match &d.coupling {
            Some(c) => {
                if d.stiffness.si() != 0.0 || d.damping.si() != 0.0 {
                    errors.push(BuildError::at(&*here, "with `coupling` stiffness and damping belong to it"));
                }
                c.clone()
            }
            None => Box::new(Linear {
                stiffness: d.stiffness,
                damping: quantity(d.damping.si()),
                loss_factor: quantity(0.0),
            }),
        };
        match spec.build() {
            Ok(coupling) => {
                line.links.push(LineLink { name: d.name.clone(), nodes: [at, own], coupling });
                out.stress.push(None);
            }
            Err(e) => errors.push(e.within(&format!("{here}.coupling"))),
        }
    }
    for (k, d) in case.drives.iter().enumerate() {
        let Some(node) = drive_at[k] else { continue };
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
    if errors.is_empty()
        && let Err(e) = gudgeon_torsion::tree::Tree::new(line)
    {
        errors.push(renamed(e));
    }
    match balance(case, line) {
        Ok((shares, note)) => {
            out.balance = shares;
            out.notes.extend(note.filter(|_| errors.is_empty()));
        }
        Err(e) => errors.push(e),
    }
    out.period = period(line);
    let odd = gears(line).find(|o| {
        let per = o * out.period / (2.0 * PI);
        (per - per.round()).abs() > 1e-6
    });
    if let Some(o) = odd {
        out.notes.push(Note::caution("window", format!(
            "order {o:.6} of the reference shaft does not repeat within two turns: extremes are those of the window that is looked at"
        )));
    }
    if errors.is_empty() { Ok(out) } else { Err(errors) }
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
