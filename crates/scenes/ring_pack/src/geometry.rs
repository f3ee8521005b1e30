//! From the case file's dimensions to a resolved [`PackGeometry`].

use std::f64::consts::PI;

use gudgeon_core::BuildError;
use gudgeon_core::geometry::{BackVolume, Chamfer, LandGeometry, PackGeometry, RingGeometry, Vent};
use gudgeon_core::result::{PackSection, SectionRing};
use gudgeon_numerics::elementary;

use super::vent::vent;
use crate::case::{ChamferShape, Ring, RingDesign, RingPackCase};
use gudgeon_machine::Land;

/// Temperature at which cold gaps are measured \[K\] (zottin1992, 20 degC).
pub(super) const COLD: f64 = 293.15;

/// Resolves the geometry; reports every contradiction, not only the first.
pub fn resolve(case: &RingPackCase) -> Result<PackGeometry, Vec<BuildError>> {
    let mut errors = Vec::new();
    let n = case.rings.len();
    if n == 0 {
        return Err(vec![
            BuildError::at("rings", "a ring pack needs at least one ring").help("add a `[[rings]]` table"),
        ]);
    }
    if case.piston.lands.len() != n {
        return Err(vec![
            BuildError::at(
                "piston.lands",
                format!("there are {n} rings but {} lands", case.piston.lands.len()),
            )
            .help("give one `[[piston.lands]]` for the land above each ring, top land first"),
        ]);
    }
    let bore_radius = case.engine.bore.si() / 2.0;
    let radii: Vec<f64> = case
        .piston
        .lands
        .iter()
        .enumerate()
        .map(|(i, l)| land_radius(l, bore_radius).map_err(|e| e.within(&format!("piston.lands.{i}"))))
        .filter_map(|r| r.map_err(|e| errors.push(e)).ok())
        .collect();
    if radii.len() != n {
        return Err(errors);
    }
    let mut rings = Vec::with_capacity(n);
    for (i, r) in case.rings.iter().enumerate() {
        let below = radii[(i + 1).min(n - 1)];
        match ring(r, bore_radius, radii[i], below, &mut |e| errors.push(e.within(&format!("rings.{i}")))) {
            Some(g) => rings.push(g),
            None => continue,
        }
    }
    let mut lands = Vec::with_capacity(n + 1);
    for (i, l) in case.piston.lands.iter().enumerate() {
        let volume = match (i, l.volume, l.height) {
            (_, Some(v), _) => v.si(),
            (0, None, _) => 0.0,
            (_, None, Some(h)) => PI * h.si() * (bore_radius * bore_radius - radii[i] * radii[i]),
            (_, None, None) => {
                errors.push(
                    BuildError::at(
                        format!("piston.lands.{i}"),
                        format!("land {} has neither `height` nor `volume`", i + 1),
                    )
                    .help("a land between two rings needs its axial height or its gas volume"),
                );
                continue;
            }
        };
        // The space between rails is that of their groove.
        let rail = case.rings[i].design == RingDesign::LowerRail;
        let vent = if rail { vent(&case.rings[i]).unwrap_or_default() } else { Vent::Closed };
        lands.push(LandGeometry { volume, temperature: l.temperature.si(), vent });
    }
    let temperature = case.gas.crankcase_temperature.si();
    lands.push(LandGeometry { volume: 0.0, temperature, vent: Vent::Closed });
    if case.gas.gamma.si() <= 1.0 {
        errors
            .push(BuildError::at("gas.gamma", format!("`{}` must be greater than one", case.gas.gamma.si())));
    }
    if errors.is_empty() {
        Ok(PackGeometry {
            bore_radius,
            rings,
            lands,
            gamma: case.gas.gamma.si(),
            gas_constant: case.gas.gas_constant.si(),
        })
    } else {
        Err(errors)
    }
}

fn land_radius(l: &Land, bore_radius: f64) -> Result<f64, BuildError> {
    let r = match (l.diameter, l.clearance) {
        (Some(_), Some(_)) => {
            return Err(BuildError::at("clearance", "both `diameter` and `clearance` are given")
                .help("keep one of them"));
        }
        (Some(d), None) => d.si() / 2.0,
        (None, Some(c)) => bore_radius - c.si(),
        (None, None) => {
            return Err(BuildError::new("the land has neither `diameter` nor `clearance`")
                .help("give its running diameter or its radial clearance to the bore"));
        }
    };
    if r <= 0.0 || r >= bore_radius {
        let field = if l.diameter.is_some() { "diameter" } else { "clearance" };
        return Err(BuildError::at(
            field,
            format!(
                "a land of {:.3} mm diameter does not fit a bore of {:.3} mm",
                2e3 * r,
                2e3 * bore_radius
            ),
        ));
    }
    if bore_radius - r > 0.1 * bore_radius {
        let field = if l.diameter.is_some() { "diameter" } else { "clearance" };
        return Err(BuildError::at(
            field,
            format!(
                "the land leaves a radial clearance of {:.3} mm, more than a tenth of the bore's radius",
                1e3 * (bore_radius - r)
            ),
        )
        .help("check the units of the bore and of the land: a bare number is in metres"));
    }
    Ok(r)
}

fn ring(
    r: &Ring,
    bore_radius: f64,
    above: f64,
    below: f64,
    fail: &mut dyn FnMut(BuildError),
) -> Option<RingGeometry> {
    let mut ok = true;
    let mut check = |result: Result<(), BuildError>| {
        if let Err(e) = result {
            ok = false;
            fail(e);
        }
    };
    let (width, height) = (r.width.si(), r.height.si());
    let g = &r.groove;
    let slopes = (elementary::tan(g.upper_angle.si()), elementary::tan(g.lower_angle.si()));
    let sealed = r.design == RingDesign::ThreePiece;
    // A number that is not known is complained about once and stands as zero until the end.
    let gap = running_gap(r, bore_radius).unwrap_or_else(|e| {
        check(Err(e));
        0.0
    });
    let root_radius = root_radius(r, bore_radius).unwrap_or_else(|e| {
        check(Err(e));
        0.0
    });
    check(fits(root_radius, width, bore_radius));
    let behind = bore_radius - root_radius - width;
    let axial = Axial::new(r, slopes, (above - root_radius, below - root_radius), behind);
    let axial = axial.unwrap_or_else(|e| {
        check(Err(e));
        Axial::tight(r, slopes)
    });
    check(axial.moves(r, slopes, behind));
    let face = match r.face.profile(height) {
        Ok(p) => p,
        Err(e) => {
            check(Err(e.within("face")));
            return None;
        }
    };
    let vent = vent(r).unwrap_or_else(|e| {
        check(Err(e.within("groove")));
        Vent::Closed
    });
    let lands = if r.design == RingDesign::TwinLand { 2 } else { 1 };
    check(faces_fit(lands, face.length(), height));
    let (vent, expander_slope) = match r.design {
        RingDesign::UpperRail => (Vent::Closed, ear_slope(r)),
        RingDesign::LowerRail => (Vent::Closed, -ear_slope(r)),
        _ => (vent, 0.0),
    };
    ok.then(|| RingGeometry {
        height,
        width,
        mass: r.mass.si(),
        tangential_force: r.tangential_force.si(),
        gap,
        gap_area: r.gap_area.map(|a| a.si()),
        piston_radius_above: above,
        piston_radius_below: below,
        root_radius,
        slope_upper: slopes.0,
        slope_lower: slopes.1,
        groove_height_inner: axial.groove_inner,
        clearance_inner: axial.clearance_inner,
        leak_upper: g.leak_upper.si(),
        leak_lower: g.leak_lower.si(),
        leak_face: r.face_leak.si(),
        chamfer: Chamfer { area_lower: chamfer(g.chamfer_lower), area_upper: chamfer(g.chamfer_upper) },
        back: back(r),
        vent,
        back_temperature: g.temperature.si(),
        oil_fill: g.oil_fill.si(),
        face,
        lands,
        rails: if sealed { 2 } else { 1 },
        has_clearance: !sealed,
        expander_slope,
    })
}

/// Axial over radial force of the ears of an expander on a rail.
fn ear_slope(r: &Ring) -> f64 {
    r.expander.map_or(0.0, |e| elementary::tan(e.ear_angle.si()))
}

/// End gap in the running engine \[m\]: given, or the cold gap less the growth of the ring's circumference.
fn running_gap(r: &Ring, bore_radius: f64) -> Result<f64, BuildError> {
    match (r.gap, r.cold_gap, r.temperature) {
        (Some(_), Some(_), _) => {
            Err(BuildError::at("gap", "both `gap` and `cold_gap` are given").help("keep one of them"))
        }
        (Some(g), None, _) => Ok(g.si()),
        (None, Some(g0), Some(t)) => {
            Ok(g0.si() - r.expansion.si() * (2.0 * PI * bore_radius - g0.si()) * (t.si() - COLD))
        }
        (None, Some(_), None) => {
            Err(BuildError::at("cold_gap", "a `cold_gap` needs the ring's running `temperature`"))
        }
        (None, None, _) if r.gap_area.is_some() => Ok(0.0),
        (None, None, _) => Err(BuildError::new("the ring has no end gap")
            .help("give `gap`, or `cold_gap` with `temperature`, or `gap_area`")),
    }
}

/// Radius of the root of the groove \[m\]: given, or by the volume behind the ring.
fn root_radius(r: &Ring, bore_radius: f64) -> Result<f64, BuildError> {
    let (width, g) = (r.width.si(), &r.groove);
    match (g.root_diameter, g.back_volume) {
        (Some(d), _) => Ok(d.si() / 2.0),
        // Lumped data: π (R_in² - R_g²) b.
        (None, Some(v)) => {
            let r_in = bore_radius - width;
            Ok((r_in * r_in - v.si() / (PI * r.height.si())).max(0.0).sqrt())
        }
        (None, None) if r.design == RingDesign::ThreePiece => Ok(bore_radius - width - 0.5e-3),
        (None, None) => {
            Err(BuildError::at("groove", "the groove has neither `root_diameter` nor `back_volume`"))
        }
    }
}

fn fits(root_radius: f64, width: f64, bore_radius: f64) -> Result<(), BuildError> {
    if root_radius + width < bore_radius {
        return Ok(());
    }
    Err(BuildError::at(
        "groove.root_diameter",
        format!(
            "a ring {:.3} mm thick on a root of {:.3} mm does not fit a bore of {:.3} mm",
            1e3 * width,
            2e3 * root_radius,
            2e3 * bore_radius
        ),
    ))
}

/// Heights of groove and ring at their inner ends (zottin1992 section 2.2).
struct Axial {
    /// Height of the groove at its root \[m\].
    groove_inner: f64,
    /// Axial clearance at the inner end of the ring \[m\].
    clearance_inner: f64,
}

impl Axial {
    /// A groove as high as the ring.
    fn tight(r: &Ring, (c1, c2): (f64, f64)) -> Self {
        Self { groove_inner: r.height.si() - (c1 + c2) * r.width.si(), clearance_inner: 0.0 }
    }

    /// By flank slopes, the `depths` of the groove below both lands and the distance `behind` the ring \[m\].
    fn new(
        r: &Ring,
        (c1, c2): (f64, f64),
        (depth_above, depth_below): (f64, f64),
        behind: f64,
    ) -> Result<Self, BuildError> {
        let g = &r.groove;
        let tight = Self::tight(r, (c1, c2));
        match (g.height, g.clearance) {
            (Some(_), Some(_)) => {
                Err(BuildError::at("groove.clearance", "both `height` and `clearance` are given")
                    .help("keep one of them"))
            }
            (Some(b), None) => {
                let inner = b.si() - (c1 * depth_above + c2 * depth_below);
                Ok(Self { groove_inner: inner, clearance_inner: inner - tight.groove_inner })
            }
            (None, Some(c)) => {
                let rc = c.si() - (c1 + c2) * behind;
                Ok(Self { groove_inner: tight.groove_inner + rc, clearance_inner: rc })
            }
            (None, None) if r.design == RingDesign::ThreePiece => Ok(tight),
            (None, None) => Err(BuildError::at("groove", "the groove has neither `height` nor `clearance`")),
        }
    }

    /// Whether the ring has room to move.
    fn moves(&self, r: &Ring, (c1, c2): (f64, f64), behind: f64) -> Result<(), BuildError> {
        let clearance = self.clearance_inner + (c1 + c2) * behind;
        let sealed = r.design == RingDesign::ThreePiece;
        if sealed || !ok_number(behind) || clearance > 0.0 {
            return Ok(());
        }
        Err(BuildError::at(
            if r.groove.height.is_some() { "groove.height" } else { "groove.clearance" },
            format!("the ring has an axial clearance of {:.4} mm in its groove", 1e3 * clearance),
        )
        .help(format!("a ring of {:.4} mm needs a higher groove", 1e3 * r.height.si())))
    }
}

fn faces_fit(lands: usize, length: f64, height: f64) -> Result<(), BuildError> {
    if lands != 2 || 2.0 * length <= height * (1.0 + 1e-9) {
        return Ok(());
    }
    Err(BuildError::at(
        "face.length",
        format!("two lands of {:.4} mm do not fit a ring of {:.4} mm", 1e3 * length, 1e3 * height),
    ))
}

/// Area that a chamfer opens at the end gap \[m²\].
fn chamfer(c: Option<ChamferShape>) -> f64 {
    c.map_or(0.0, |c| 0.5 * c.length.si() * c.length.si() * elementary::tan(c.angle.si()))
}

fn back(r: &Ring) -> BackVolume {
    match (r.design, r.groove.back_volume) {
        (RingDesign::ThreePiece, _) => BackVolume::Sealed,
        (RingDesign::UpperRail, _) => BackVolume::OpenBelow,
        (RingDesign::LowerRail, _) => BackVolume::OpenAbove,
        (_, Some(v)) => BackVolume::Fixed(v.si()),
        (_, None) => BackVolume::Geometric,
    }
}

fn ok_number(v: f64) -> bool {
    v.is_finite() && v > 0.0
}

/// Height of the land above ring 1 \[m\], 6 mm where the case says none.
pub fn crown_height(case: &RingPackCase) -> f64 {
    case.piston.lands[0].height.map_or(6e-3, |h| h.si())
}

/// The section that reports draw.
pub fn section(case: &RingPackCase, pack: &PackGeometry, stroke: f64) -> PackSection {
    let top_land = crown_height(case);
    let mut y = top_land;
    let mut rings = Vec::with_capacity(pack.rings.len());
    for (i, (r, g)) in case.rings.iter().zip(&pack.rings).enumerate() {
        let behind = g.h_max(pack.bore_radius);
        let clearance = g.clearance_inner + (g.slope_upper + g.slope_lower) * behind;
        let axial = if g.has_clearance { g.height } else { g.height * 6.0 };
        let groove_height = axial + clearance.max(0.0);
        let points = 21;
        rings.push(SectionRing {
            height: axial,
            width: g.width,
            groove_bottom: y + groove_height,
            groove_height,
            groove_depth: g.piston_radius_above - g.root_radius,
            clearance: clearance.max(0.0),
            face_drop: (0..points)
                .map(|k| g.face.drop_at(g.face.length() * k as f64 / (points - 1) as f64))
                .collect(),
            face_length: g.face.length(),
            lands: g.lands.max(g.rails),
        });
        y += groove_height;
        let _ = r;
        y += match case.piston.lands.get(i + 1) {
            Some(l) => l.height.map_or_else(
                || {
                    l.volume.map_or(3e-3, |v| {
                        let rp = pack.rings[i].piston_radius_below;
                        (v.si() / (PI * (pack.bore_radius * pack.bore_radius - rp * rp))).clamp(1e-3, 20e-3)
                    })
                },
                |h| h.si(),
            ),
            None => 6e-3,
        };
    }
    PackSection { bore_radius: pack.bore_radius, top_land, length: y, stroke, rings }
}
