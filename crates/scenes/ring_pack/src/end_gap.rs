//! End gaps of running rings, before anything moves: a gap that closes makes the ring a spring between its own ends, for which there is no
//! model.

use std::f64::consts::PI;

use gudgeon_core::BuildError;
use gudgeon_core::geometry::PackGeometry;

use super::geometry::COLD;
use super::liner::LinerShape;
use crate::case::RingPackCase;

/// What closes in a liner of this shape: `g + 2π δ ≤ 0` for a ring, or a land that the liner touches, anywhere on the way of a ring.
/// `pin`: height of ring 1 above the pin; `spacing`: of each ring below ring 1; `stroke` \[m\].
pub(super) fn closed(
    case: &RingPackCase,
    geo: &PackGeometry,
    liner: &LinerShape,
    pin: f64,
    spacing: &[f64],
    stroke: f64,
) -> Vec<BuildError> {
    let mut errors = Vec::new();
    for (i, (ring, below)) in geo.rings.iter().zip(spacing).enumerate() {
        if ring.gap_area.is_some() {
            continue;
        }
        let (top, bottom) = (pin - below, pin - below - stroke);
        let inside = liner.position.iter().copied().filter(|x| (bottom..=top).contains(x));
        let least =
            [top, bottom].into_iter().chain(inside).map(|x| liner.at(x)).fold(f64::INFINITY, f64::min);
        let running = ring.gap + 2.0 * PI * least;
        if running <= 0.0 {
            errors.push(gap(case, i, ring.gap, least, running));
        }
        let radial = geo.bore_radius + least - ring.piston_radius_above;
        if radial <= 0.0 {
            let what = format!(
                "the liner shrinks by {:.4} mm in radius on the way of ring {}, onto the land above it: {:.4} mm are left",
                -1e3 * least,
                i + 1,
                1e3 * radial
            );
            errors.push(BuildError::at("liner.distortion", what));
        }
    }
    errors
}

fn gap(case: &RingPackCase, i: usize, nominal: f64, least: f64, running: f64) -> BuildError {
    let r = &case.rings[i];
    let mm = |v: f64| format!("{:.4} mm", 1e3 * v);
    let (field, from) = match (r.cold_gap, r.temperature) {
        (Some(cold), Some(t)) => {
            let growth = cold.si() - nominal;
            let hot = format!(
                "{} cold, less {} by which the ring grows from {:.0} to {:.0} degC",
                mm(cold.si()),
                mm(growth),
                COLD - 273.15,
                t.si() - 273.15
            );
            ("cold_gap", hot)
        }
        _ => ("gap", format!("{} at the nominal bore", mm(nominal))),
    };
    let liner = if least == 0.0 {
        "no growth of the liner".to_owned()
    } else {
        format!("{} where the liner grows least", mm(2.0 * PI * least))
    };
    let e = BuildError::at(
        format!("rings.{i}.{field}"),
        format!(
            "the end gap of ring {} closes when hot: {from}, plus {liner}, leaves {}",
            i + 1,
            mm(running)
        ),
    );
    let missing = mm(-running / PI);
    e.help(if case.liner.distortion.is_empty() {
        format!(
            "the growth of the liner is missing: declare it in `[[liner.distortion]]` (`position`, `diametral`, thermal growth included); \
             more than {missing} of diameter open this gap"
        )
    } else {
        format!("a larger gap, a cooler ring, or a liner that grows by {missing} more in diameter")
    })
}
