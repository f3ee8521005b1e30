//! Whether a ring pack makes sense for a gas-flow model.

use gudgeon_core::BuildError;
use gudgeon_core::geometry::{BackVolume, Drain, PackGeometry, RingGeometry, Vent};

use crate::spaces::back_volume;

/// Gap, piston and groove of a pack make sense for a gas-flow model that takes the film thickness `film` \[m\] at its smallest.
pub(crate) fn validate(pack: &PackGeometry, film: f64) -> Result<(), BuildError> {
    let n = pack.rings.len();
    if n == 0 {
        return Err(BuildError::new("a gas-flow model needs at least one ring"));
    }
    if pack.lands.len() != n + 1 {
        return Err(BuildError::new(format!(
            "{n} rings need {} spaces above, between and below, not {}",
            n + 1,
            pack.lands.len()
        )));
    }
    for (i, land) in pack.lands.iter().enumerate().take(n).skip(1) {
        validate_drain(land.vent, || format!("land {}", i + 1))?;
        if land.vent != Vent::Open && !(land.volume > 0.0 && land.volume.is_finite()) {
            return Err(BuildError::new(format!(
                "land {} has the gas volume {:e} m3, which must be greater than zero",
                i + 1,
                land.volume
            ))
            .help("give its height and the piston diameter, or its volume"));
        }
    }
    for (i, ring) in pack.rings.iter().enumerate() {
        validate_gap(i + 1, ring, pack.bore_radius, film)?;
        validate_back_volume(i + 1, ring, pack.bore_radius, film)?;
        validate_drain(ring.vent, || format!("the groove of ring {}", i + 1))?;
    }
    Ok(())
}

fn validate_gap(number: usize, ring: &RingGeometry, bore_radius: f64, film: f64) -> Result<(), BuildError> {
    let clearance = bore_radius - ring.piston_radius_above;
    match ring.gap_area {
        Some(a) if !(a >= 0.0 && a.is_finite()) => {
            Err(BuildError::new(format!("the gap area of ring {number} is {a:e} m2")))
        }
        None if clearance - film <= 0.0 || clearance.is_nan() => Err(BuildError::new(format!(
            "above ring {number} the piston has the radius {:.6} m in a liner of {bore_radius:.6} m: no clearance is left for \
             the end gap",
            ring.piston_radius_above
        ))),
        _ => Ok(()),
    }
}

fn validate_drain(vent: Vent, what: impl Fn() -> String) -> Result<(), BuildError> {
    let Vent::Drain(Drain { area, discharge }) = vent else { return Ok(()) };
    if area > 0.0 && area.is_finite() && discharge > 0.0 && discharge <= 1.0 {
        return Ok(());
    }
    Err(BuildError::new(format!(
        "{} has a drain of {area:e} m2 with the discharge coefficient {discharge}",
        what()
    )))
}

fn validate_back_volume(
    number: usize,
    ring: &RingGeometry,
    bore_radius: f64,
    film: f64,
) -> Result<(), BuildError> {
    let refused =
        |v: f64, why: String| BuildError::new(format!("the volume behind ring {number} is {v:e} m3: {why}"));
    match ring.back {
        _ if !ring.has_room() => Ok(()),
        BackVolume::Fixed(v) if !(v > 0.0 && v.is_finite()) => {
            Err(refused(v, "it must be greater than zero".to_owned()))
        }
        BackVolume::Geometric => {
            let v = back_volume(ring, bore_radius, film);
            if v > 0.0 && v.is_finite() {
                return Ok(());
            }
            let behind = ring.h_max(bore_radius) - film;
            let why = format!(
                "the radial distance behind it is {behind:e} m, the groove is {:e} m high at its root",
                ring.groove_height_inner
            );
            Err(refused(v, why).help("check groove root diameter, radial thickness and groove height"))
        }
        _ => Ok(()),
    }
}
