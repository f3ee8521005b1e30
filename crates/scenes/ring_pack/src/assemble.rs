//! From a case to an assembled [`Pack`]: every sub-model built, every contradiction reported.

use std::f64::consts::PI;

use gudgeon_core::BuildError;
use gudgeon_core::file::Files;
use gudgeon_core::geometry::{BackVolume, PackGeometry};
use gudgeon_core::kinds::{
    CylinderPressureCtx, FaceCtx, FilmTemperatureCtx, FlankDampingCtx, GasFlowCtx, GasIn, GasOut,
    KinematicsCtx, Motion, RingMotion, RingMotionCtx,
};
use gudgeon_core::result::{ModelUse, Skipped};

use super::contact_line::ContactLine;
use super::end_gap;
use super::geometry;
use super::hold::Hold;
use super::oil::{FacePlace, OilPack};
use super::pack::{Counters, Instant, Layout, LinerShape, Pack, RingInstant, RingModel, SeatLog};
use super::plan::{Facts, Plan, plan, wanted};
use crate::case::{Method, RingDesign, RingPackCase};

/// A ring without axial clearance.
struct Clamped;
impl RingMotion for Clamped {
    fn motion(&self) -> Motion {
        Motion::Fixed { e: 0.0 }
    }
    fn uses_film_force(&self) -> bool {
        false
    }
    fn uses_gravity(&self) -> bool {
        false
    }
    fn flank_reaction(&self, _: f64, _: f64, _: f64) -> f64 {
        0.0
    }
    fn seat(&self, _: &gudgeon_core::kinds::AxialForces) -> f64 {
        0.0
    }
}

/// Builds the pack.
///
/// # Errors
/// Everything about the case that cannot be, with the place in the case.
pub fn assemble(case: &RingPackCase, files: &Files) -> Result<Pack, Vec<BuildError>> {
    let mut errors = Vec::new();
    let want =
        wanted(&case.outputs.results, case.rings.len(), case.models.oil_transport.typetag_name() != "off")
            .map_err(|e| errors.extend(e))
            .ok();
    let geo = geometry::resolve(case).map_err(|e| errors.extend(e)).ok();
    let m = &case.models;
    let omega = case.engine.speed.si();
    let r = case.engine.stroke.si() / 2.0;
    let ctx = KinematicsCtx {
        crank_radius: r,
        rod_length: case.engine.rod_length.si(),
        offset: case.engine.offset.si(),
        omega,
    };
    let kinematics = m.kinematics.build(&ctx).map_err(|e| {
        // The mechanism is the engine's, not the model's.
        let place = match e.field.as_str() {
            "crank_radius" => "engine.stroke",
            "offset" => "engine.offset",
            _ => "engine.rod_length",
        };
        let e = BuildError { field: place.into(), ..e };
        errors.push(e);
    });
    let (Some(want), Some(geo), Ok(kinematics)) = (want, geo, kinematics) else { return Err(errors) };
    let n = geo.rings.len();
    if case.engine.cylinders == 0 {
        errors.push(BuildError::at("engine.cylinders", "an engine has at least one cylinder"));
    }
    if case.outputs.series_step.si() > PI / 2.0 || case.outputs.series_step.si() < 1e-4 {
        errors.push(
            BuildError::at("outputs.series_step", "rows of a series cannot be that far apart or that close")
                .help("between 0.006 deg and 90 deg"),
        );
    }
    if case.outputs.seat.si() > 0.5 {
        errors.push(
            BuildError::at("outputs.seat", "a ring would be on both flanks at once")
                .help("at most 0.5 of the clearance; 0.1 when it is left out"),
        );
    }
    let ctx = CylinderPressureCtx {
        kinematics: kinematics.as_ref(),
        piston_area: PI * geo.bore_radius * geo.bore_radius,
        files,
    };
    let at = |place: &str| {
        let place = place.to_owned();
        move |e: BuildError| e.within(&place)
    };
    let cylinder =
        m.cylinder_pressure.build(&ctx).map_err(at("models.cylinder_pressure")).map_err(|e| errors.push(e));
    let gas = m
        .gas_flow
        .build(&GasFlowCtx { pack: &geo })
        .map_err(at("models.gas_flow"))
        .map_err(|e| errors.push(e));

    // Axial motion per ring.
    let mut motions: Vec<Box<dyn RingMotion>> = Vec::with_capacity(n);
    for (i, (ring, g)) in case.rings.iter().zip(&geo.rings).enumerate() {
        if !g.has_clearance {
            if ring.models.ring_motion.is_some() {
                errors.push(BuildError::at(
                    format!("rings.{i}.models.ring_motion"),
                    "a three-piece oil ring has no axial clearance and cannot move",
                ));
            }
            motions.push(Box::new(Clamped));
            continue;
        }
        let (spec, place) = match &ring.models.ring_motion {
            Some(s) => (s, format!("rings.{i}.models.ring_motion")),
            None => (&m.ring_motion, "models.ring_motion".to_owned()),
        };
        let behind = g.h_max(geo.bore_radius);
        let r_in = g.root_radius + behind;
        let r_out = r_in + g.width;
        let ctx = RingMotionCtx {
            mass: g.mass,
            clearance: g.clearance_inner + (g.slope_upper + g.slope_lower) * behind,
            flank_area: PI * (r_out * r_out - r_in * r_in),
            ring: i,
        };
        match spec.build(&ctx) {
            Ok(b) => motions.push(b),
            Err(e) => errors.push(e.within(&place)),
        }
    }
    let (Ok(cylinder), Ok(gas)) = (cylinder, gas) else { return Err(errors) };
    if !errors.is_empty() {
        return Err(errors);
    }
    let moves = |m: &dyn RingMotion| !matches!(m.motion(), Motion::Fixed { .. });
    let facts = Facts {
        gas: (m.gas_flow.typetag_name(), gas.uses_film_height()),
        motion: (
            m.ring_motion.typetag_name(),
            motions.iter().any(|m| moves(m.as_ref()) && m.uses_film_force()),
        ),
        moving: motions.iter().filter(|m| moves(m.as_ref())).count(),
        dynamic: motions.iter().filter(|m| m.motion() == Motion::Dynamic).count(),
    };
    let plan = plan(&want, facts);

    let oil = m.oil.build().map_err(at("models.oil")).map_err(|e| errors.push(e));
    let land_temperatures: Vec<f64> = geo.lands.iter().map(|l| l.temperature).collect();
    let ctx = FilmTemperatureCtx { land_temperatures: &land_temperatures, stroke: kinematics.stroke() };
    let film_temperature =
        m.film_temperature.build(&ctx).map_err(at("models.film_temperature")).map_err(|e| errors.push(e));
    let oil_model = m.oil_transport.build().map_err(at("models.oil_transport")).map_err(|e| errors.push(e));
    let (Ok(oil), Ok(film_temperature), Ok(oil_model)) = (oil, film_temperature, oil_model) else {
        return Err(errors);
    };

    let mut spacing = 0.0;
    let mut rings = Vec::with_capacity(n);
    for (i, motion) in motions.into_iter().enumerate() {
        let g = &geo.rings[i];
        let own = &case.rings[i].models;
        let behind = g.h_max(geo.bore_radius);
        let clearance0 = g.clearance_inner + (g.slope_upper + g.slope_lower) * behind;
        let mut films = Vec::new();
        let mut contact = ContactLine::default();
        if plan.film {
            let (spec, place) = match &own.hydrodynamics {
                Some(s) => (s, format!("rings.{i}.models.hydrodynamics")),
                None => (&m.hydrodynamics, "models.hydrodynamics".to_owned()),
            };
            for _ in 0..g.lands {
                match spec.build(&FaceCtx { face: &g.face }) {
                    Ok(f) => films.push(f),
                    Err(e) => errors.push(e.within(&place)),
                }
            }
            let (spec, place) = match &own.contact {
                Some(s) => (s, format!("rings.{i}.models.contact")),
                None => (&m.contact, "models.contact".to_owned()),
            };
            match spec.build() {
                Ok(c) => contact = ContactLine::new(c.as_ref(), &g.face, g.lands),
                Err(e) => errors.push(e.within(&place)),
            }
        }
        let mu_groove = oil.viscosity(g.back_temperature);
        let ctx = FlankDampingCtx { ring: i, rings: n, oil_fill: g.oil_fill, width: g.width, mu: mu_groove };
        let damping = m.flank_damping.build(&ctx).map_err(at("models.flank_damping"));
        let friction = m.flank_friction.build().map_err(at("models.flank_friction"));
        match (damping, friction) {
            (Ok(damping), Ok(friction)) => {
                let mu = film_temperature
                    .is_constant()
                    .then(|| oil.viscosity(film_temperature.temperature(i, 0.0)));
                let kind = motion.motion();
                let nominal_film = case.solver.limits.nominal_film.si();
                let resists = films.iter().any(|f| f.resists());
                rings.push(RingModel {
                    films,
                    resists,
                    contact,
                    motion,
                    kind,
                    damping,
                    friction,
                    spacing,
                    clearance0,
                    mu,
                    nominal_film,
                });
            }
            (d, f) => errors.extend(d.err().into_iter().chain(f.err())),
        }
        // Middle of this groove to the middle of the next.
        let groove = |k: usize| {
            let g = &geo.rings[k];
            let c = g.clearance_inner + (g.slope_upper + g.slope_lower) * g.h_max(geo.bore_radius);
            case.rings[k]
                .groove
                .height
                .map_or(g.height * if g.rails == 2 { 6.0 } else { 1.0 } + c, |h| h.si())
        };
        if i + 1 < n {
            let land = case.piston.lands[i + 1].height.map_or(3e-3, |h| h.si());
            spacing += 0.5 * groove(i) + land + 0.5 * groove(i + 1);
        }
    }
    let liner = liner_shape(case, kinematics.stroke(), spacing).map_err(|e| errors.push(e));
    if let Ok((shape, pin)) = &liner
        && gas.uses_end_gaps()
    {
        let spacings: Vec<f64> = rings.iter().map(|r| r.spacing).collect();
        errors.extend(end_gap::closed(case, &geo, shape, *pin, &spacings, kinematics.stroke()));
    }
    if !errors.is_empty() || rings.len() != n {
        return Err(errors);
    }
    let Ok((liner, pin_to_ring1)) = liner else { return Err(errors) };

    // Layout.
    let gas_states = gas.n_states();
    let mut layout =
        Layout { gas: gas_states, film: vec![None; n], axial: vec![None; n], oil: None, n: gas_states };
    if plan.film {
        for (i, r) in rings.iter().enumerate() {
            if !r.films.is_empty() {
                layout.film[i] = Some(layout.n);
                layout.n += 1;
            }
        }
    }
    for (i, r) in rings.iter().enumerate() {
        if r.kind == Motion::Dynamic {
            layout.axial[i] = Some(layout.n);
            layout.n += 2;
        }
    }
    let mut oil_pack = None;
    if plan.film
        && let Some(model) = oil_model
    {
        for (i, r) in rings.iter_mut().enumerate() {
            let length = geo.rings[i].face.length();
            if !r.films.iter_mut().all(|f| f.set_extent(0.0, length)) {
                return Err(vec![
                    BuildError::at(
                        "models.oil_transport",
                        format!("the film of ring {} cannot be confined to the part of its face that has oil", i + 1),
                    )
                    .help("use `hydrodynamics = { model = \"closed_form_face\" }`, or `oil_transport = { model = \"off\" }`"),
                ]);
            }
        }
        let faces = faces(&geo, &rings, pin_to_ring1);
        if let Some(w) = faces.windows(2).find(|w| w[0].offset <= w[1].offset + w[1].profile.length()) {
            return Err(vec![BuildError::at(
                format!("rings.{}.face", w[1].ring),
                format!("the faces of ring {} and ring {} overlap", w[0].ring + 1, w[1].ring + 1),
            )]);
        }
        let (top, stroke) = (kinematics.y_tdc(), kinematics.stroke());
        let oil = OilPack::new(model, faces, top - stroke, top, layout.n);
        layout.oil = Some(layout.n);
        layout.n += oil.states();
        oil_pack = Some(oil);
    }
    let states = layout.n;
    let places = vec![gudgeon_core::geometry::RingPlace::default(); n];
    let mut pack = Pack {
        conv: case.conventions,
        limits: (&case.solver.limits).into(),
        omega,
        kinematics,
        cylinder,
        gas,
        oil,
        film_temperature,
        rings,
        liner,
        pin_to_ring1,
        p_crankcase: case.gas.crankcase_pressure.si(),
        oil_pack,
        plan,
        layout,
        mass_scale: vec![1.0; gas_states],
        seats: vec![0.0; n],
        seat_log: vec![SeatLog::default(); n],
        at: Instant {
            theta: 0.0,
            piston: Default::default(),
            gas: GasOut::new(n),
            dm: vec![0.0; gas_states],
            places,
            rings: vec![RingInstant::default(); n],
        },
        counters: Counters::default(),
        masses: vec![0.0; gas_states],
        hard_floor: case.solver.method == Method::AsPublished,
        state: vec![f64::NAN; states],
        holds: vec![Hold::Free; n],
        hold_tolerance: 0.0,
        tangents: vec![0.0; n],
        geo,
    };
    // Masses at 1 bar, the scale of the gas states; also the first evaluation of every geometry-dependent number.
    let mut y = vec![0.0; pack.layout.n];
    pack.initial(1e5, &mut y);
    let reference = vec![1e5; n + 1];
    let inp = GasIn { p_cylinder: 1e5, p_crankcase: 1e5, rings: &pack.at.places };
    pack.gas.initial(&inp, &reference, &mut pack.masses);
    pack.mass_scale.copy_from_slice(&pack.masses);
    if let Some(k) = pack.mass_scale.iter().position(|m| !(m.is_finite() && *m > 0.0)) {
        let name = pack.gas.state_names().get(k).cloned().unwrap_or_default();
        return Err(vec![
            BuildError::new(format!("the gas volume `{name}` is not positive"))
                .help("check land heights and diameters, groove depth and ring thickness"),
        ]);
    }
    if let Some(e) = super::too_long(case, &pack) {
        return Err(vec![e]);
    }
    Ok(pack)
}

/// Radial clearance of a land to the liner \[m\].
fn clearance(geo: &PackGeometry, piston_radius: f64) -> Option<f64> {
    Some((geo.bore_radius - piston_radius).max(0.0))
}

/// The running faces from the top down, where they are on the piston, and what room there is before their edges.
fn faces(geo: &PackGeometry, rings: &[RingModel], pin_to_ring1: f64) -> Vec<FacePlace> {
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
            // Oil between the lands of an oil ring, and below the lowest ring, drains at once.
            let drained_below = lowest && land + 1 == g.lands || g.lands == 2 && land == 0;
            let drained_above = g.lands == 2 && land == 1;
            all.push(FacePlace {
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

fn liner_shape(case: &RingPackCase, stroke: f64, spacing: f64) -> Result<(LinerShape, f64), BuildError> {
    let table = &case.liner.distortion;
    let pin = case.piston.pin_to_ring1.map_or(0.0, |p| p.si());
    if table.is_empty() {
        return Ok((LinerShape::default(), pin));
    }
    if case.piston.pin_to_ring1.is_none() {
        return Err(BuildError::at("piston", "a distorted liner needs `pin_to_ring1`")
            .help("the heights of `liner.distortion` count from the gudgeon pin at top dead centre"));
    }
    if table.len() < 2 {
        return Err(BuildError::at("liner.distortion", "a distortion table needs at least two points"));
    }
    let mut points: Vec<(f64, f64)> =
        table.iter().map(|d| (d.position.si(), d.diametral.si() / 2.0)).collect();
    let descending = points[1].0 < points[0].0;
    for (k, pair) in points.windows(2).enumerate() {
        if pair[0].0 == pair[1].0 || (pair[1].0 < pair[0].0) != descending {
            return Err(BuildError::at(
                format!("liner.distortion.{}.position", k + 1),
                "positions must all fall or all rise",
            ));
        }
    }
    if descending {
        points.reverse();
    }
    let (low, high) = (pin - stroke - spacing, pin);
    let (first, last) = (points[0].0, points[points.len() - 1].0);
    if first > low + 1e-9 || last < high - 1e-9 {
        return Err(BuildError::at(
            "liner.distortion",
            format!(
                "the rings travel from {:.1} mm to {:.1} mm, but the table spans {:.1} mm to {:.1} mm",
                1e3 * high,
                1e3 * low,
                1e3 * last,
                1e3 * first
            ),
        )
        .help("add points that cover the whole travel"));
    }
    let (position, growth) = points.into_iter().unzip();
    Ok((LinerShape { position, growth }, pin))
}

/// The models that run and the parts that do not, for `explain` and the results.
#[must_use]
pub fn models_in_use(case: &RingPackCase, plan: &Plan) -> (Vec<ModelUse>, Vec<Skipped>) {
    let registry = gudgeon_core::Registry::collect();
    let m = &case.models;
    let own = |f: fn(&crate::case::RingModels) -> Option<&'static str>| -> Vec<&'static str> {
        case.rings.iter().filter_map(|r| f(&r.models)).collect()
    };
    let mut used: Vec<(&str, &str)> = vec![
        ("kinematics", m.kinematics.typetag_name()),
        ("cylinder_pressure", m.cylinder_pressure.typetag_name()),
        ("gas_flow", m.gas_flow.typetag_name()),
    ];
    let mut pack_and_own = |kind: &'static str, name: &'static str, own: Vec<&'static str>| {
        if own.len() < case.rings.len() {
            used.push((kind, name));
        }
        for o in own {
            if !used.contains(&(kind, o)) {
                used.push((kind, o));
            }
        }
    };
    let mut skipped = plan.skipped.clone();
    if plan.axial {
        pack_and_own(
            "ring_motion",
            m.ring_motion.typetag_name(),
            own(|r| r.ring_motion.as_ref().map(|s| s.typetag_name())),
        );
        if !plan.skipped.iter().any(|s| s.what == "flank_damping") {
            pack_and_own("flank_damping", m.flank_damping.typetag_name(), Vec::new());
        }
    }
    if plan.film {
        pack_and_own(
            "hydrodynamics",
            m.hydrodynamics.typetag_name(),
            own(|r| r.hydrodynamics.as_ref().map(|s| s.typetag_name())),
        );
        pack_and_own(
            "contact",
            m.contact.typetag_name(),
            own(|r| r.contact.as_ref().map(|s| s.typetag_name())),
        );
        pack_and_own("oil", m.oil.typetag_name(), Vec::new());
        pack_and_own("oil_transport", m.oil_transport.typetag_name(), Vec::new());
        pack_and_own("film_temperature", m.film_temperature.typetag_name(), Vec::new());
        pack_and_own("flank_friction", m.flank_friction.typetag_name(), Vec::new());
    }
    for (i, r) in case.rings.iter().enumerate() {
        match r.design {
            RingDesign::ThreePiece => skipped.push(Skipped {
                what: format!("axial motion of ring {}", i + 1),
                why: "a three-piece oil ring has no axial clearance: its groove is treated as sealed, gas passes its gaps alone, and blow-by is less than past a ring that leaks at its flanks".into(),
            }),
            RingDesign::TwinLand => skipped.push(Skipped {
                what: format!("gas volume behind ring {}", i + 1),
                why: "the groove of an oil ring drains to below the ring".into(),
            }),
            RingDesign::Compression => {}
        }
    }
    let models =
        used.into_iter().map(|(kind, model)| gudgeon_scene::model_use(&registry, kind, model)).collect();
    (models, skipped)
}

/// Whether a ring keeps gas behind it.
#[must_use]
pub fn has_back_volume(back: BackVolume) -> bool {
    matches!(back, BackVolume::Geometric | BackVolume::Fixed(_))
}
