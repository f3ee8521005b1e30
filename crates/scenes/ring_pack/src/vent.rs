//! The way of the gas in a groove to the crankcase, as the case says it.

use std::f64::consts::PI;

use gudgeon_core::BuildError;
use gudgeon_core::geometry::{Drain, Vent};

use crate::case::{DrainHoles, Ring, RingDesign};

/// How the groove of a ring is open to the crankcase.
///
/// # Errors
/// What contradicts itself, with its place in the groove.
pub fn vent(ring: &Ring) -> Result<Vent, BuildError> {
    let oil_ring = ring.design != RingDesign::Compression;
    if ring.design == RingDesign::ThreePiece {
        let key = if ring.groove.vented.is_some() { "vented" } else { "drain" };
        let given = ring.groove.vented.is_some() || ring.groove.drain.is_some();
        let what = "a ring of one rail that stands for two has no gas behind it";
        return if given { Err(BuildError::at(key, what).help("leave it out")) } else { Ok(Vent::Closed) };
    }
    match (ring.groove.vented, &ring.groove.drain) {
        (Some(_), Some(_)) => {
            Err(BuildError::at("vented", "both `vented` and `drain` are given").help("keep one of them"))
        }
        (None, Some(holes)) => Ok(Vent::Drain(drain(holes).map_err(|e| e.within("drain"))?)),
        (Some(true), None) => Ok(Vent::Open),
        (None, None) if oil_ring => Ok(Vent::Open),
        (Some(false) | None, None) => Ok(Vent::Closed),
    }
}

fn drain(d: &DrainHoles) -> Result<Drain, BuildError> {
    let discharge = d.discharge.si();
    if discharge <= 0.0 {
        let what = "a drain with the discharge coefficient 0 passes nothing";
        return Err(BuildError::at("discharge", what).help("leave the drain out and write `vented = false`"));
    }
    let area = match (d.area, d.holes, d.diameter) {
        (Some(area), None, None) => area.si(),
        (None, Some(n), Some(diameter)) if n > 0 => f64::from(n) * 0.25 * PI * diameter.si() * diameter.si(),
        (Some(_), ..) => {
            return Err(BuildError::at("area", "the drain is given twice")
                .help("keep `area`, or `holes` with `diameter`"));
        }
        _ => {
            return Err(BuildError::new("the drain has no size")
                .help("give `holes`, one or more, and their `diameter`; or the `area` of all slots"));
        }
    };
    Ok(Drain { area, discharge })
}
