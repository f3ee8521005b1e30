//! From a case to an assembled [`Pack`]: every sub-model built, every contradiction reported.

use std::f64::consts::PI;
use std::sync::Arc;

use gudgeon_core::file::Files;
use gudgeon_core::geometry::{FlankOil, PackGeometry, RingGeometry};
use gudgeon_core::kinds::{
    CylinderPressure, FaceCtx, FilmTemperature, FilmTemperatureCtx, Flank, FlankCtx, FlankFriction, FlankLaw,
    GasFlow, GasFlowCtx, GasIn, GasOut, Hydrodynamics, Kinematics, Oil, OilTransport, OilTransportCtx,
    RadialMotion, RadialMotionCtx, RingForces, RingMotion, RingMotionCtx, RingPose, RingResponse,
    real_area_is_known,
};
use gudgeon_core::states::{Signals, Stateful};
use gudgeon_core::{BuildError, EvalError};

use super::case::{RingDesign, RingPackCase};
use super::contact_line::{ContactLine, MeanPlanes};
use super::distortion::liner_shape;
use super::instant::{Counters, Instant, RingInstant, SeatLog};
use super::layout::Layout;
use super::liner::LinerShape;
use super::pack::Pack;
use super::plan::{Facts, Names, Plan, Told, plan, wanted};
use super::rails::TakenApart;
use super::rheology::{factors_end, rheology};
use super::ring::Ring;
use super::rubbing::FaceFriction;
use super::{end_gap, evaporation, geometry, oil_faces, rails};

/// A ring without axial clearance, and the flanks of a ring that no oil there moves.
struct Clamped;

impl Flank for Clamped {
    fn law(&self) -> Box<dyn FlankLaw> {
        Box::new(Self)
    }
}

impl FlankLaw for Clamped {
    fn force(&self, _: &FlankOil, _: f64, _: f64, _: f64, _: f64) -> f64 {
        0.0
    }
}

impl Stateful for Clamped {}

impl RingMotion for Clamped {
    fn moves(&self) -> bool {
        false
    }
    fn uses_film_force(&self) -> bool {
        false
    }
    fn uses_gravity(&self) -> bool {
        false
    }
    fn pose(&self, _: &[f64], clearance: f64) -> RingPose {
        RingPose::seated(0.0, clearance)
    }
    fn rates(&mut self, _: &[f64], _: &RingForces, _: &mut [f64]) -> Result<RingResponse, EvalError> {
        Ok(RingResponse::default())
    }
}

/// Builds the pack.
///
/// # Errors
/// Everything about the case that cannot be, with the place in the case.
pub fn assemble(case: &RingPackCase, files: &Files) -> Result<Pack, Vec<BuildError>> {
    let apart = TakenApart::new(case)?;
    assemble_bodies(&apart.case, files).map_err(|e| apart.located(e))
}

/// The same for a case whose rings are single bodies.
fn assemble_bodies(case: &RingPackCase, files: &Files) -> Result<Pack, Vec<BuildError>> {
    let drive = Drive::new(case, files)?;
    let oils = Oils::new(case, &drive)?;
    let mut flanks = flanks(case, &drive, &*oils.oil)?;
    let motions = motions(case, &drive, &flanks)?;
    for (flank, motion) in flanks.iter_mut().zip(&motions) {
        if !motion.uses_damping() {
            *flank = Box::new(Clamped);
        }
    }
    let m = &case.models;
    let moving = motions.iter().filter(|m| m.moves());
    let facts = Facts {
        gas: (m.gas_flow.typetag_name(), drive.gas.uses_film_height()),
        motion: (m.ring_motion.typetag_name(), moving.clone().any(|m| m.uses_film_force())),
        moving: moving.count(),
        dynamic: motions.iter().filter(|m| m.uses_damping()).count(),
        wet: flanks.iter().filter(|f| !f.states().is_empty()).count(),
    };
    let mut plan = plan(&drive.wanted, facts);
    plan.runs.extend(rails::told(case));
    let mut rings = rings(case, &drive, &oils, &plan, motions, flanks)?;
    if let Some(e) = rings.iter_mut().enumerate().find_map(|(i, r)| untiltable(i, r)) {
        return Err(vec![e]);
    }
    let (liner, pin_to_ring1) = liner(case, &drive, &rings)?;
    let oil_pack = oil_pack(case, (&drive, &*oils.temperature), &plan, &mut rings, (&liner, pin_to_ring1))?;
    pack(case, drive, oils, plan, rings, (liner, pin_to_ring1), oil_pack)
}

/// A ring that twists on a film that cannot be tilted.
fn untiltable(i: usize, ring: &mut Ring) -> Option<BuildError> {
    let twists = ring.motion.states().iter().any(|s| s.changes.meets(Signals::TWIST));
    let tilts = |ring: &mut Ring, tilt: f64| ring.films.iter_mut().all(|f| f.set_tilt(tilt));
    // An angle like any other; the film stands upright again afterwards.
    if !twists || tilts(ring, 1e-6) && tilts(ring, 0.0) {
        return None;
    }
    let what = format!("ring {} twists, and its film cannot be tilted", i + 1);
    let help = "use `hydrodynamics = { model = \"closed_form_face\" }` on a face that is not flat";
    Some(BuildError::at("models.hydrodynamics", what).help(help))
}

/// Crank drive and gas: what everything else is built for.
struct Drive {
    wanted: Vec<super::plan::ResultInfo>,
    geo: PackGeometry,
    omega: f64,
    kinematics: Box<dyn Kinematics>,
    cylinder: Box<dyn CylinderPressure>,
    gas: Box<dyn GasFlow>,
}

impl Drive {
    fn new(case: &RingPackCase, files: &Files) -> Result<Self, Vec<BuildError>> {
        let mut errors = Vec::new();
        let m = &case.models;
        let told = Told {
            liner: m.oil_transport.follows_oil(),
            vapour: evaporation::acts(m),
            flanks: m.flank.follows_oil(),
            formulas: case.outputs.oil_formulas,
        };
        let wanted = kept(&mut errors, wanted(&case.outputs.results, &Names::of(case), told));
        let geo = kept(&mut errors, geometry::resolve(case));
        let motion = case.engine.motion(&*case.models.kinematics);
        let kinematics = kept(&mut errors, motion.map_err(|e| vec![e]));
        let (Some(wanted), Some(geo), Some(kinematics)) = (wanted, geo, kinematics) else {
            return Err(errors);
        };
        errors.extend(improper(case));
        let cylinder = case.engine.gas(&*m.cylinder_pressure, &*kinematics, files).map_err(|e| vec![e]);
        let gas = m.gas_flow.build(&GasFlowCtx { pack: &geo }).map_err(|e| vec![e.within("models.gas_flow")]);
        let (cylinder, gas) = (kept(&mut errors, cylinder), kept(&mut errors, gas));
        match (cylinder, gas) {
            (Some(cylinder), Some(gas)) if errors.is_empty() => {
                let omega = kinematics.omega();
                Ok(Self { wanted, geo, omega, kinematics, cylinder, gas })
            }
            _ => Err(errors),
        }
    }

    /// Clearance of a ring on the undistorted liner \[m\].
    fn clearance(&self, g: &RingGeometry) -> f64 {
        g.clearance_inner + (g.slope_upper + g.slope_lower) * g.h_max(self.geo.bore_radius)
    }
}

/// The value, or nothing with its errors kept.
fn kept<T>(errors: &mut Vec<BuildError>, found: Result<T, Vec<BuildError>>) -> Option<T> {
    found.map_err(|e| errors.extend(e)).ok()
}

/// Numbers of the case that mean nothing.
fn improper(case: &RingPackCase) -> Vec<BuildError> {
    let mut errors = Vec::new();
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
    errors
}

/// Oil, and the temperature of the films.
struct Oils {
    oil: Box<dyn Oil>,
    temperature: Box<dyn FilmTemperature>,
}

impl Oils {
    fn new(case: &RingPackCase, drive: &Drive) -> Result<Self, Vec<BuildError>> {
        let (m, geo) = (&case.models, &drive.geo);
        let mut errors = Vec::new();
        let oil = kept(&mut errors, m.oil.build().map_err(|e| vec![e.within("models.oil")]));
        let lands: Vec<f64> = geo.lands.iter().map(|l| l.temperature).collect();
        let faces: Vec<f64> = geo.rings.iter().map(|g| g.lands as f64 * g.face.length()).collect();
        let ctx = FilmTemperatureCtx::new(&lands, drive.kinematics.stroke()).faces(
            &faces,
            2.0 * PI * geo.bore_radius,
            drive.omega,
        );
        let temperature =
            m.film_temperature.build(&ctx).map_err(|e| vec![e.within("models.film_temperature")]);
        match (oil, kept(&mut errors, temperature)) {
            (Some(oil), Some(temperature)) => Ok(Self { oil, temperature }),
            _ => Err(errors),
        }
    }
}

/// All of them, or every error.
fn all<T>(made: impl Iterator<Item = Result<T, BuildError>>) -> Result<Vec<T>, Vec<BuildError>> {
    let (mut all, mut errors) = (Vec::new(), Vec::new());
    for one in made {
        match one {
            Ok(one) => all.push(one),
            Err(e) => errors.push(e),
        }
    }
    if errors.is_empty() { Ok(all) } else { Err(errors) }
}

/// The oil on the flanks of every ring.
fn flanks(case: &RingPackCase, drive: &Drive, oil: &dyn Oil) -> Result<Vec<Box<dyn Flank>>, Vec<BuildError>> {
    let n = case.rings.len();
    all((0..n).map(|i| {
        let g = &drive.geo.rings[i];
        let ctx = FlankCtx::new(i, n, g.oil_fill, g.width, oil.viscosity(g.back_temperature));
        let flank = case.models.flank.build(&ctx.at_speed(drive.omega));
        let flank = flank.map_err(|e| e.within("models.flank"))?;
        Ok(if g.has_clearance { flank } else { Box::new(Clamped) as Box<dyn Flank> })
    }))
}

/// The motion of every ring in its groove.
fn motions(
    case: &RingPackCase,
    drive: &Drive,
    flanks: &[Box<dyn Flank>],
) -> Result<Vec<Box<dyn RingMotion>>, Vec<BuildError>> {
    all(flanks.iter().enumerate().map(|(i, flank)| motion(case, drive, flank.law(), i)))
}

fn motion(
    case: &RingPackCase,
    drive: &Drive,
    damping: Box<dyn FlankLaw>,
    i: usize,
) -> Result<Box<dyn RingMotion>, BuildError> {
    let (ring, g, m) = (&case.rings[i], &drive.geo.rings[i], &case.models);
    if !g.has_clearance {
        return match ring.models.ring_motion {
            None => Ok(Box::new(Clamped)),
            Some(_) => Err(BuildError::at(
                format!("rings.{i}.models.ring_motion"),
                "a three-piece oil ring has no axial clearance and cannot move",
            )),
        };
    }
    let (spec, place) = match &ring.models.ring_motion {
        Some(s) => (s, format!("rings.{i}.models.ring_motion")),
        None => (&m.ring_motion, "models.ring_motion".to_owned()),
    };
    let r_in = g.root_radius + g.h_max(drive.geo.bore_radius);
    let r_out = r_in + g.width;
    let ctx = RingMotionCtx::new(i, g.mass, drive.clearance(g), drive.omega, damping).section(
        g.height,
        g.width,
        0.5 * (r_in + r_out),
        PI * (r_out * r_out - r_in * r_in),
    );
    let ctx = match ring.design {
        RingDesign::UpperRail => ctx.pressed_onto(1.0),
        RingDesign::LowerRail => ctx.pressed_onto(0.0),
        _ => ctx,
    };
    spec.build(ctx).map_err(|e| e.within(&place))
}

/// Everything of every ring.
fn rings(
    case: &RingPackCase,
    drive: &Drive,
    oils: &Oils,
    plan: &Plan,
    motions: Vec<Box<dyn RingMotion>>,
    flanks: Vec<Box<dyn Flank>>,
) -> Result<Vec<Ring>, Vec<BuildError>> {
    let mut errors = Vec::new();
    let mut rings = Vec::with_capacity(motions.len());
    let spacings = spacings(case, drive);
    let mut planes = None;
    for (i, (motion, flank)) in motions.into_iter().zip(flanks).enumerate() {
        let none = || Ok(FaceModels::default());
        let films = if plan.film { films(case, drive, i, &mut planes) } else { none() };
        let films = kept(&mut errors, films);
        let friction = case.models.flank_friction.build();
        let friction = kept(&mut errors, friction.map_err(|e| vec![e.within("models.flank_friction")]));
        if let (Some(films), Some(friction)) = (films, friction) {
            match ring(case, drive, oils, i, (films, friction, motion, flank), spacings[i]) {
                Ok(r) => rings.push(r),
                Err(e) => errors.push(e),
            }
        }
    }
    if errors.is_empty() { Ok(rings) } else { Err(errors) }
}

/// What is between a face and the liner.
#[derive(Default)]
struct FaceModels {
    /// Films of the lands.
    films: Vec<Box<dyn Hydrodynamics>>,
    /// Film thickness below which their flow factors are held \[m\].
    factors_end: Option<f64>,
    /// Contact of the whole face.
    contact: ContactLine,
    /// Its friction.
    rubbing: Option<FaceFriction>,
}
/// All models of a ring but that of its radial motion.
type RingParts = (FaceModels, Box<dyn FlankFriction>, Box<dyn RingMotion>, Box<dyn Flank>);

fn ring(
    case: &RingPackCase,
    drive: &Drive,
    oils: &Oils,
    i: usize,
    (face, friction, motion, flank): RingParts,
    spacing: f64,
) -> Result<Ring, BuildError> {
    let fixed = oils.temperature.is_constant();
    let FaceModels { films, factors_end, contact, rubbing } = face;
    Ok(Ring {
        resists: films.iter().any(|f| f.resists()),
        radial: radial(case, drive, i, &contact)?,
        films,
        contact,
        rubbing,
        factors_end,
        counts: (motion.uses_film_force(), motion.uses_gravity()),
        motion,
        flank,
        motion_name: case.rings[i]
            .models
            .ring_motion
            .as_ref()
            .unwrap_or(&case.models.ring_motion)
            .typetag_name(),
        friction: (!friction.is_off()).then_some(friction),
        pull: 0.0,
        expander: 0.0,
        spacing,
        mu: fixed.then(|| oils.oil.viscosity(oils.temperature.temperature(i, 0.0, &[]))),
        nominal_film: case.solver.limits.nominal_film.si(),
    })
}

/// Film thickness of the first instant \[m\], and how far above a floor of the contact it is at least.
const FIRST_FILM: (f64, f64) = (3e-6, 1.5);

fn radial(
    case: &RingPackCase,
    drive: &Drive,
    i: usize,
    contact: &ContactLine,
) -> Result<Box<dyn RadialMotion>, BuildError> {
    let (first, above) = FIRST_FILM;
    let first = first.max(contact.floor.unwrap_or(0.0) * above);
    let around = 2.0 * PI * drive.geo.bore_radius;
    let ctx = RadialMotionCtx::new(i, drive.omega, first, (&case.solver.limits).into())
        .body(drive.geo.rings[i].mass, around);
    case.models.radial_motion.build(&ctx).map_err(|e| e.within("models.radial_motion"))
}

/// `planes` is that of the contact model of all rings without one of their own, once made.
fn films(
    case: &RingPackCase,
    drive: &Drive,
    i: usize,
    planes: &mut Option<Arc<MeanPlanes>>,
) -> Result<FaceModels, Vec<BuildError>> {
    let (g, own, m) = (&drive.geo.rings[i], &case.rings[i].models, &case.models);
    let mut errors = Vec::new();
    let mut films = Vec::new();
    let (spec, place) = match &own.hydrodynamics {
        Some(s) => (s, format!("rings.{i}.models.hydrodynamics")),
        None => (&m.hydrodynamics, "models.hydrodynamics".to_owned()),
    };
    let rheology = rheology(case, i, &**spec).map_err(|e| vec![e])?;
    for _ in 0..g.lands {
        match spec.build_with(&FaceCtx { face: &g.face }, &rheology) {
            Ok(f) => films.push(f),
            Err(e) => errors.push(e.within(&place)),
        }
    }
    let contact = contact(case, drive, i, planes).map_err(|e| errors.push(e));
    match contact {
        Ok((contact, rubbing)) if errors.is_empty() => {
            Ok(FaceModels { films, factors_end: factors_end(&rheology), contact, rubbing })
        }
        _ => Err(errors),
    }
}

/// Solid contact of the face of a ring, and its friction where the case has a model for it.
fn contact(
    case: &RingPackCase,
    drive: &Drive,
    i: usize,
    planes: &mut Option<Arc<MeanPlanes>>,
) -> Result<(ContactLine, Option<FaceFriction>), BuildError> {
    let (g, own, m) = (&drive.geo.rings[i], &case.rings[i].models, &case.models);
    let (spec, place) = match &own.contact {
        Some(s) => (s, format!("rings.{i}.models.contact")),
        None => (&m.contact, "models.contact".to_owned()),
    };
    let contact = spec.build().map_err(|e| e.within(&place))?;
    let new = || Arc::new(MeanPlanes::new(&*contact));
    let planes = if own.contact.is_some() { &new() } else { planes.get_or_insert_with(new) };
    let line = ContactLine::new(&*contact, planes, &g.face, g.lands);
    let (friction, place) = match (&own.boundary_friction, &m.boundary_friction) {
        (Some(f), _) => (f, format!("rings.{i}.models.boundary_friction")),
        (None, Some(f)) => (f, "models.boundary_friction".to_owned()),
        (None, None) => return Ok((line, None)),
    };
    let model = friction.build().map_err(|e| e.within(&place))?;
    real_area_is_known(&*model, &*contact, spec.typetag_name()).map_err(|e| e.within(&place))?;
    let line = if model.uses_real_area() { line.with_area(&*contact, &g.face, g.lands) } else { line };
    Ok((line, Some(FaceFriction { model, length: g.lands as f64 * g.face.length() })))
}

/// Height of a land that the case does not say \[m\], and grooves of a three-piece ring over the thickness of a rail.
const UNTOLD: (f64, f64) = (3e-3, 6.0);

/// Distances of the rings below ring 1 \[m\], from middle of groove to middle of groove.
fn spacings(case: &RingPackCase, drive: &Drive) -> Vec<f64> {
    let groove = |k: usize| {
        let g = &drive.geo.rings[k];
        let ring = g.height * if g.rails == 2 { UNTOLD.1 } else { 1.0 };
        case.rings[k].groove.height.map_or(ring + drive.clearance(g), |h| h.si())
    };
    let mut spacing = 0.0;
    (0..case.rings.len())
        .map(|i| {
            if i > 0 {
                let land = case.piston.lands[i].height.map_or(UNTOLD.0, |h| h.si());
                spacing += 0.5 * groove(i - 1) + land + 0.5 * groove(i);
            }
            spacing
        })
        .collect()
}

/// The distortion of the liner, on which end gaps stay open.
fn liner(case: &RingPackCase, drive: &Drive, rings: &[Ring]) -> Result<(LinerShape, f64), Vec<BuildError>> {
    let stroke = drive.kinematics.stroke();
    let spacings: Vec<f64> = rings.iter().map(|r| r.spacing).collect();
    let lowest = spacings.last().copied().unwrap_or(0.0);
    let (shape, pin) = liner_shape(case, stroke, lowest).map_err(|e| vec![e])?;
    if drive.gas.uses_end_gaps() {
        let closed = end_gap::closed(case, &drive.geo, &shape, pin, &spacings, stroke);
        if !closed.is_empty() {
            return Err(closed);
        }
    }
    Ok((shape, pin))
}

/// The oil on the liner, where films are solved and it is followed.
fn oil_pack(
    case: &RingPackCase,
    (drive, temperature): (&Drive, &dyn FilmTemperature),
    plan: &Plan,
    rings: &mut [Ring],
    (shape, pin_to_ring1): (&LinerShape, f64),
) -> Result<Option<Box<dyn OilTransport>>, Vec<BuildError>> {
    let faces = oil_faces::faces(&drive.geo, rings, pin_to_ring1);
    let (top, stroke) = (drive.kinematics.y_tdc(), drive.kinematics.stroke());
    let crown = geometry::crown_height(case);
    let lands = oil_faces::lands(&drive.geo, rings, crown, shape, (pin_to_ring1, stroke));
    let vapour = evaporation::model(case, &*drive.kinematics).map_err(|e| vec![e])?;
    let volatile =
        evaporation::volatile(vapour.as_deref(), temperature, top + pin_to_ring1).map_err(|e| vec![e])?;
    let pin = (top - stroke, top);
    let ctx = OilTransportCtx { faces: &faces, lands: &lands, pin, omega: drive.omega, volatile };
    let spec = &case.models.oil_transport;
    let model = spec.build(&ctx).map_err(|e| vec![e.within("models.oil_transport")])?;
    let Some(model) = model.filter(|_| plan.film) else { return Ok(None) };
    match oil_faces::refused(&drive.geo, rings, &faces) {
        None => Ok(Some(model)),
        Some(e) => Err(vec![e]),
    }
}

/// Everything together, with the states of the gas at 1 bar.
fn pack(
    case: &RingPackCase,
    drive: Drive,
    oils: Oils,
    plan: Plan,
    mut rings: Vec<Ring>,
    (liner, pin_to_ring1): (LinerShape, f64),
    oil_pack: Option<Box<dyn OilTransport>>,
) -> Result<Pack, Vec<BuildError>> {
    let Drive { geo, omega, kinematics, cylinder, gas, .. } = drive;
    let Oils { oil, temperature } = oils;
    let layout = Layout::new(&*gas, &rings, plan.film, oil_pack.as_deref(), &*temperature);
    let (n, states, gas_states) = (rings.len(), layout.n, layout.gas.len());
    let laws = case.conventions.build()?;
    for (ring, g) in rings.iter_mut().zip(&geo.rings) {
        ring.pull = laws.hoop.radial_force(g.tangential_force / g.rails as f64);
        ring.expander = g.expander_slope * ring.pull;
    }
    let mut pack = Pack {
        laws,
        y_tdc: kinematics.y_tdc(),
        limits: (&case.solver.limits).into(),
        omega,
        kinematics,
        cylinder,
        gas,
        oil,
        film_temperature: temperature,
        rings,
        liner,
        pin_to_ring1,
        p_crankcase: case.gas.crankcase_pressure.si(),
        oil_pack,
        plan,
        layout,
        names: Names::of(case),
        gas_scale: vec![1.0; gas_states],
        seat_log: vec![SeatLog::default(); n],
        at: Instant {
            theta: 0.0,
            piston: Default::default(),
            gas: GasOut::new(n),
            dm: vec![0.0; gas_states],
            places: vec![Default::default(); n],
            rings: vec![RingInstant::default(); n],
        },
        dy: vec![0.0; states],
        counters: Counters::default(),
        gas_state: vec![0.0; gas_states],
        hard_floor: false,
        state: vec![f64::NAN; states],
        complete: false,
        twin: None,
        between: None,
        films: vec![0.0; n],
        viscosities: vec![0.0; n],
        trial: Vec::with_capacity(states),
        geo,
    };
    weigh(&mut pack)?;
    Ok(pack)
}

/// States of the gas at 1 bar, their scale; also the first evaluation of every geometry-dependent number.
fn weigh(pack: &mut Pack) -> Result<(), Vec<BuildError>> {
    let mut y = vec![0.0; pack.layout.n];
    pack.initial(1e5, &mut y);
    let reference = vec![1e5; pack.n_rings() + 1];
    let inp = GasIn { p_cylinder: 1e5, p_crankcase: 1e5, rings: &pack.at.places };
    pack.gas.at_pressures(&inp, &reference, &mut pack.gas_state);
    pack.gas_scale.copy_from_slice(&pack.gas_state);
    let Some(k) = pack.gas_scale.iter().position(|m| !(m.is_finite() && *m > 0.0)) else { return Ok(()) };
    let name = &pack.layout.states[pack.layout.gas.start + k].name;
    Err(vec![
        BuildError::new(format!("the {name} at 1 bar is not positive"))
            .help("check land heights and diameters, groove depth and ring thickness"),
    ])
}
