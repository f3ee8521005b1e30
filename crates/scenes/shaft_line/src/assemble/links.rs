//! Shafts and dampers: the links of the line.

use gudgeon_core::BuildError;
use gudgeon_core::kinds::{CouplingSpec, Line, LineLink};
use gudgeon_core::quantity::quantity;
use gudgeon_torsion::coupling::Linear;
use gudgeon_torsion::shaft::{Piece, stiffness, weakest};

use super::Assembled;
use super::nodes::Names;
use crate::case::{DamperCase, ShaftCase, ShaftLineCase};

/// Adds the shafts whose ends are known.
pub(super) fn add_shafts(
    case: &ShaftLineCase,
    ends: &[Option<[usize; 2]>],
    out: &mut Assembled,
    errors: &mut Vec<BuildError>,
) {
    let default_damping = default_damping(case, &out.line, errors);
    for (k, s) in case.shafts.iter().enumerate() {
        let here = format!("shafts.{k}");
        let links = &mut out.line.links;
        let name = if s.name.is_empty() { format!("shaft {}", links.len() + 1) } else { s.name.clone() };
        if links.iter().any(|l| l.name == name) {
            let what = format!("`{name}` is the name of another shaft");
            errors.push(BuildError::at(format!("{here}.name"), what));
        }
        let Some(nodes) = ends[k] else { continue };
        let Some(spec) = coupling(s, default_damping, &here, errors) else { continue };
        match spec.build() {
            Ok(coupling) => links.push(LineLink { name, nodes, coupling }),
            Err(e) => {
                let inside = if s.coupling.is_some() { format!("{here}.coupling") } else { here.clone() };
                errors.push(e.within(&inside));
            }
        }
        out.stress.push(stress(s, &here, errors));
    }
}

/// Damping of shafts that give none: of the first shaft and the first throw, by `conventions.damping_factor`.
fn default_damping(case: &ShaftLineCase, line: &Line, errors: &mut Vec<BuildError>) -> f64 {
    let Some(factor) = case.conventions.damping_factor else { return 0.0 };
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

/// Nominal shear stress by torque, with its concentration factor; none where no diameter is given.
fn stress(s: &ShaftCase, here: &str, errors: &mut Vec<BuildError>) -> Option<f64> {
    let section = match s.diameter {
        Some(d) if s.bore.si() >= d.si() => {
            errors.push(BuildError::at(format!("{here}.bore"), "the bore is as wide as the shaft"));
            None
        }
        Some(d) => Some(Piece { length: 1.0, diameter: d.si(), bore: s.bore.si() }),
        None => weakest(&pieces(s)).copied(),
    };
    section.map(|p| p.stress(1.0) * s.stress_concentration.si())
}

/// Adds the links of the dampers whose place is known.
pub(super) fn add_dampers(
    case: &ShaftLineCase,
    (at, names): (&[Option<usize>], &Names),
    out: &mut Assembled,
    errors: &mut Vec<BuildError>,
) {
    for (k, d) in case.dampers.iter().enumerate() {
        let here = format!("dampers.{k}");
        let Some(at) = at[k] else { continue };
        let Some(own) = names.find(&d.name) else { continue };
        match damper_coupling(d, &here, errors).build() {
            Ok(coupling) => {
                out.line.links.push(LineLink { name: d.name.clone(), nodes: [at, own], coupling });
                out.stress.push(None);
            }
            Err(e) => errors.push(e.within(&format!("{here}.coupling"))),
        }
    }
}

fn damper_coupling(d: &DamperCase, here: &str, errors: &mut Vec<BuildError>) -> Box<dyn CouplingSpec> {
    match &d.coupling {
        Some(c) => {
            if d.stiffness.si() != 0.0 || d.damping.si() != 0.0 {
                errors.push(BuildError::at(here, "with `coupling` stiffness and damping belong to it"));
            }
            c.clone()
        }
        None => Box::new(Linear {
            stiffness: d.stiffness,
            damping: quantity(d.damping.si()),
            loss_factor: quantity(0.0),
        }),
    }
}
