//! Throws with their gas spaces.

use std::f64::consts::PI;

use gudgeon_core::BuildError;
use gudgeon_core::file::Files;
use gudgeon_core::kinds::{
    CylinderPressureCtx, GasEnd, Kinematics, KinematicsCtx, LineThrow, ThrowCtx, ThrowInertia,
};
use gudgeon_torsion::CrankEnd;

use crate::case::{EndCase, ShaftLineCase, Side, ThrowCase};

/// Node and speed ratio of an inertia by its name.
type Find<'a> = &'a dyn Fn(&str) -> Option<(usize, f64)>;

/// Builds the throws of a case at a mean speed \[rad/s\], on inertias by `find`.
pub(super) fn throws(
    case: &ShaftLineCase,
    files: &Files,
    speed: f64,
    find: Find<'_>,
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
        let inertia = match inertia(case, t) {
            Ok(i) => i,
            Err(e) => {
                errors.push(e.within(&here));
                continue;
            }
        };
        let mut built: Option<(f64, LineThrow)> = None;
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
            let phase = t.phases.get(i).map_or(0.0, |p| p.si());
            if let Some((of, throw)) = &built
                && *of == ratio.abs()
            {
                all.push(throw.alike(node, phase));
                continue;
            }
            let kinematics = match kinematics(case, t, speed * ratio.abs()) {
                Ok(k) => k,
                Err(e) => {
                    errors.push(e.within(&here));
                    break;
                }
            };
            // One throw is enough to report an error of a gas space.
            let ends = ends(case, files, (t, &here), &|| kinematics.clone(), i == 0, errors);
            let throw = LineThrow::new(node, phase, inertia.clone(), ends);
            built = Some((ratio.abs(), throw.clone()));
            all.push(throw);
        }
    }
    all
}

fn inertia(case: &ShaftLineCase, t: &ThrowCase) -> Result<Box<dyn ThrowInertia>, BuildError> {
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
    t.throw_inertia.as_ref().unwrap_or(&case.models.throw_inertia).build(&ctx)
}

fn kinematics(case: &ShaftLineCase, t: &ThrowCase, omega: f64) -> Result<Box<dyn Kinematics>, BuildError> {
    case.models.kinematics.build(&KinematicsCtx {
        crank_radius: t.crank_radius.si(),
        rod_length: t.rod_length.si(),
        offset: t.offset.si(),
        omega,
    })
}

/// Gas spaces of a throw that can be built.
fn ends(
    case: &ShaftLineCase,
    files: &Files,
    (t, here): (&ThrowCase, &str),
    kinematics: &dyn Fn() -> Box<dyn Kinematics>,
    report: bool,
    errors: &mut Vec<BuildError>,
) -> Vec<GasEnd> {
    let mut ends = Vec::new();
    for (j, e) in t.ends.iter().enumerate() {
        let place = format!("{here}.ends.{j}");
        let (bore, rod) = (e.bore.si(), e.rod_diameter.si());
        let area = 0.25 * PI * (bore - rod) * (bore + rod);
        if area <= 0.0 {
            errors.push(BuildError::at(format!("{place}.rod_diameter"), "the rod fills the bore"));
            continue;
        }
        let motion = motion(e, kinematics());
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
            Err(error) if report => errors.push(error.within(&format!("{place}.cylinder_pressure"))),
            Err(_) => {}
        }
    }
    ends
}

/// Motion of the piston towards an end.
fn motion(e: &EndCase, head: Box<dyn Kinematics>) -> Box<dyn Kinematics> {
    match e.side {
        Side::Head => head,
        Side::Crank => Box::new(CrankEnd { head }),
    }
}

/// The throws alone, each on its own, at a mean speed \[rad/s\]: for results that need no line.
///
/// # Errors
/// As [`assemble`](super::assemble()).
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
