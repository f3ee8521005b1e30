//! A plain shaft as a line.

use gudgeon_core::BuildError;
use gudgeon_core::kinds::{CouplingSpec, Line, LineLink, LineNode};
use gudgeon_core::quantity::{Quantity, quantity};

use crate::coupling::{Linear, Off};

/// A shaft of inertias \[kg m²\] one after the other, joined by stiffnesses \[N m/rad\]: `stiffness[i]` stands between inertias i and i + 1,
/// and is infinite for a rigid joint.
///
/// Damping, gears, branches, throws and drives are added to the fields of the line.
///
/// # Errors
/// Another number of stiffnesses than of gaps between the inertias; a stiffness that is negative or no number.
pub fn chain(inertia: &[f64], stiffness: &[f64]) -> Result<Line, BuildError> {
    if stiffness.len() + 1 != inertia.len() {
        let what = format!("{} stiffnesses do not join {} inertias", stiffness.len(), inertia.len());
        return Err(BuildError::at("links", what));
    }
    let node = |(i, j): (usize, &f64)| LineNode {
        name: format!("inertia {}", i + 1),
        inertia: *j,
        damping: 0.0,
        ground: 0.0,
        ratio: 1.0,
    };
    let nodes = inertia.iter().enumerate().map(node).collect();
    let link = |(i, k): (usize, &f64)| {
        let coupling = if *k == f64::INFINITY {
            Off {}.build()?
        } else {
            let stiffness =
                Quantity::new(*k).map_err(|e| BuildError::at(format!("links.{i}"), e.to_string()))?;
            Linear { stiffness, damping: quantity(0.0), loss_factor: quantity(0.0) }.build()?
        };
        Ok(LineLink { name: format!("shaft {}", i + 1), nodes: [i, i + 1], coupling })
    };
    let links = stiffness.iter().enumerate().map(link).collect::<Result<_, BuildError>>()?;
    Ok(Line { nodes, links, ..Line::default() })
}
