//! The running faces and the lands as the oil on the liner meets them.

use std::f64::consts::PI;

use gudgeon_core::BuildError;
use gudgeon_core::geometry::{BackVolume, PackGeometry};
use gudgeon_core::kinds::{OilFacePlace, OilLand};

use super::liner::LinerShape;
use super::ring::Ring;

/// Radial clearance of a land to the liner \[m\].
fn clearance(geo: &PackGeometry, piston_radius: f64) -> Option<f64> {
    Some((geo.bore_radius - piston_radius).max(0.0))
}

/// The running faces from the top down, where they are on the piston, and what room there is before their edges.
pub fn faces(geo: &PackGeometry, rings: &[Ring], pin_to_ring1: f64) -> Vec<OilFacePlace> {
    let mut all = Vec::new();
    for (i, (g, r)) in geo.rings.iter().zip(rings).enumerate() {
        let middle = pin_to_ring1 - r.spacing;
        let length = g.face.length();
        let lowest = i + 1 == geo.rings.len();
        for land in 0..g.lands {
            let bottom = match (g.lands, land) {
                (1, _) => middle - 0.5 * length,
                (_, 0) => middle + 0.5 * g.height - length,
                _ => middle - 0.5 * g.height,
            };
            // Oil between the lands or rails of an oil ring, and below the lowest ring, drains at once.
            let drained_below =
                lowest && land + 1 == g.lands || g.lands == 2 && land == 0 || g.back == BackVolume::OpenBelow;
            let drained_above = g.lands == 2 && land == 1 || g.back == BackVolume::OpenAbove;
            all.push(OilFacePlace {
                ring: i,
                land,
                profile: g.face.clone(),
                offset: bottom,
                clearance: [
                    if drained_below { None } else { clearance(geo, g.piston_radius_below) },
                    if drained_above { None } else { clearance(geo, g.piston_radius_above) },
                ],
            });
        }
    }
    all
}

/// Minimum height of a land \[m\], where grooves as high as their rings leave none.
const MIN_LAND: f64 = 0.1e-3;

/// Places of a stroke at which the growth of the liner is averaged.
const PLACES: usize = 64;

/// The lands from the crown down, that of height `crown` \[m\] first, and what is open past the ring below each: the end gap in the mean over a stroke of
/// `stroke` \[m\] down from `pin_to_ring1`.
pub fn lands(
    geo: &PackGeometry,
    rings: &[Ring],
    crown: f64,
    liner: &LinerShape,
    (pin_to_ring1, stroke): (f64, f64),
) -> Vec<OilLand> {
    let around = 2.0 * PI * geo.bore_radius;
    let growth = |i: usize| {
        let at =
            |k: usize| liner.at(pin_to_ring1 - rings[i].spacing - stroke * (k as f64 + 0.5) / PLACES as f64);
        2.0 * PI * (0..PLACES).map(at).sum::<f64>() / PLACES as f64
    };
    let height = |i: usize| match i {
        0 => crown,
        _ => {
            let apart = rings[i].spacing - rings[i - 1].spacing;
            (apart - 0.5 * (geo.rings[i - 1].height + geo.rings[i].height)).max(MIN_LAND)
        }
    };
    let land = |i: usize| {
        let g = &geo.rings[i];
        let rail = matches!(g.back, BackVolume::OpenBelow | BackVolume::OpenAbove);
        let lowest = i + 1 == rings.len() || g.back == BackVolume::OpenBelow;
        OilLand {
            height: height(i),
            gap: ((g.gap + growth(i)) / around).clamp(0.0, 1.0),
            drained: lowest && (g.lands == 2 || rail),
        }
    };
    (0..rings.len()).map(land).collect()
}

/// What keeps the oil from being followed: films that cannot be confined to a part of their face, faces that overlap.
pub fn refused(geo: &PackGeometry, rings: &mut [Ring], faces: &[OilFacePlace]) -> Option<BuildError> {
    for (i, r) in rings.iter_mut().enumerate() {
        let length = geo.rings[i].face.length();
        if !r.films.iter_mut().all(|f| f.set_extent(0.0, length)) {
            let what =
                format!("the film of ring {} cannot be confined to the part of its face that has oil", i + 1);
            return Some(BuildError::at("models.oil_transport", what).help(
                "use `hydrodynamics = { model = \"closed_form_face\" }`, or `oil_transport = { model = \"off\" }`",
            ));
        }
    }
    let over = faces.windows(2).find(|w| w[0].offset <= w[1].offset + w[1].profile.length())?;
    Some(BuildError::at(
        format!("rings.{}.face", over[1].ring),
        format!("the faces of ring {} and ring {} overlap", over[0].ring + 1, over[1].ring + 1),
    ))
}
