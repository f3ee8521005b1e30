//! From a case to the running sub-models.

use std::f64::consts::PI;

use gudgeon_core::BuildError;
use gudgeon_core::file::Files;
use gudgeon_core::kinds::{
    CylinderPressure, GrooveFriction, GrooveFrictionCtx, Kinematics, Oil, PinFriction, SecondaryMotion,
    SecondaryMotionCtx, ShearThinning, SkirtComplianceCtx, SkirtComplianceSpec, SkirtOil, SkirtProfile,
    SkirtProfileCtx,
};
use gudgeon_skirt::{Body, ContactGrid, Crank, Panel, Piston, Rigid, Rod, Side, SideSetup};

use super::assembly::Assembly;
use super::case::PistonSecondaryCase;
use super::layout::Layout;
use super::legal::{legal, radius, running_clearance};
use super::oil::OilKept;

/// Sides of the skirt, for people.
const SIDES: [&str; 2] = ["thrust side", "anti-thrust side"];

/// Builds the sub-models; with `elastic`, the skirt yields as its model says. `intervals` along and across each side take the place of those of the case.
///
/// # Errors
/// Everything that is wrong, with places.
pub fn assemble(
    case: &PistonSecondaryCase,
    files: &Files,
    elastic: bool,
    intervals: Option<[u32; 2]>,
) -> Result<Assembly, Vec<BuildError>> {
    let mut errors = legal(case);
    let clearance = running_clearance(case, radius(case));
    let (crank, body) = (crank(case).map_err(|e| vec![e])?, body(case).map_err(|e| vec![e])?);
    let parts = Parts::build(case, files, &crank, &body, clearance);
    // The mistakes of the common models are told once.
    let sides = match (&parts.profile, &parts.thinning) {
        (Ok(profile), Ok(_)) if errors.is_empty() => {
            both_sides(case, files, &**profile, elastic, intervals, clearance)
        }
        _ => Err(Vec::new()),
    };
    let sides = sides.map_err(|e| errors.extend(e)).ok();
    let parts = parts.checked(&mut errors);
    let (Some(parts), Some(sides)) = (parts, sides) else { return Err(errors) };
    let mu = parts.oil.viscosity(case.skirt.oil_temperature.si());
    if !(mu > 0.0 && mu.is_finite()) {
        errors.push(BuildError::at(
            "models.oil",
            format!("the viscosity at the oil's temperature is {mu} Pa s"),
        ));
    }
    if !errors.is_empty() {
        return Err(errors);
    }
    let period = parts.cylinder.period();
    let layout = Layout::new(&*parts.motion, &sides, parts.skirt_oil.is_some());
    let elastic = sides.iter().any(|s| s.elastic() > 0);
    let mut piston = Piston::new(sides, body, crank, parts.pin, parts.groove);
    if parts.skirt_oil.is_some() {
        piston.keep_oil().map_err(|e| vec![e])?;
    }
    Ok(Assembly {
        layout,
        elastic,
        piston,
        oil: parts.skirt_oil.map(|model| OilKept::new(model, period)),
        breakpoints: breakpoints(&*parts.kinematics, &*parts.cylinder),
        kinematics: parts.kinematics,
        profile: parts.profile,
        cylinder: parts.cylinder,
        motion: parts.motion,
        motion_name: case.models.secondary_motion.typetag_name(),
        area: case.engine.area(),
        mu,
        p_crankcase: case.gas.crankcase_pressure.si(),
        clearance,
        period,
        max_films: case.solver.max_film_evaluations,
    })
}

fn crank(case: &PistonSecondaryCase) -> Result<Crank, BuildError> {
    let c = case.engine.crank()?;
    Ok(Crank {
        radius: c.radius,
        rod_length: c.rod_length,
        omega: c.omega,
        pin_offset: c.pin_offset,
        crank_offset: c.crank_offset,
        rod: case.rod.as_ref().map_or_else(Rod::default, |r| Rod {
            mass: r.mass.si(),
            centre: r.gravity_distance.si(),
            inertia: r.inertia.si(),
        }),
    })
}

fn body(case: &PistonSecondaryCase) -> Result<Body, BuildError> {
    let p = case.piston.body(case.engine.crank()?.pin_offset)?;
    Ok(Body {
        piston_mass: p.mass,
        pin_mass: p.pin_mass,
        inertia: p.inertia,
        length: case.skirt.length.si(),
        pin: p.pin_depth,
        centre: p.gravity_depth,
        centre_offset: p.gravity_offset,
    })
}

/// Running sub-models beside the sides of the skirt, or why there is none.
struct Parts {
    kinematics: Result<Box<dyn Kinematics>, BuildError>,
    /// None where it cannot be built without kinematics.
    cylinder: Option<Result<Box<dyn CylinderPressure>, BuildError>>,
    profile: Result<Box<dyn SkirtProfile>, BuildError>,
    oil: Result<Box<dyn Oil>, BuildError>,
    thinning: Result<Box<dyn ShearThinning>, BuildError>,
    motion: Result<Box<dyn SecondaryMotion>, BuildError>,
    pin: Result<Box<dyn PinFriction>, BuildError>,
    groove: Result<Box<dyn GrooveFriction>, BuildError>,
    skirt_oil: Result<Option<Box<dyn SkirtOil>>, BuildError>,
}

/// The same, all of them built.
struct Checked {
    kinematics: Box<dyn Kinematics>,
    cylinder: Box<dyn CylinderPressure>,
    profile: Box<dyn SkirtProfile>,
    oil: Box<dyn Oil>,
    motion: Box<dyn SecondaryMotion>,
    pin: Box<dyn PinFriction>,
    groove: Box<dyn GrooveFriction>,
    skirt_oil: Option<Box<dyn SkirtOil>>,
}

impl Parts {
    fn build(case: &PistonSecondaryCase, files: &Files, crank: &Crank, body: &Body, clearance: f64) -> Self {
        let m = &case.models;
        let kinematics = case.engine.motion(&*m.kinematics);
        let cylinder = kinematics.as_ref().ok().map(|k| case.engine.gas(&*m.cylinder_pressure, &**k, files));
        let profile = SkirtProfileCtx { length: body.length, radius: radius(case), files };
        let start = [case.solver.start_top.si(), case.solver.start_bottom.si()];
        let motion = SecondaryMotionCtx::new(clearance, crank.omega, body.matrix()).starting_at(start);
        let groove = GrooveFrictionCtx { bore: case.engine.bore.si() };
        Self {
            kinematics,
            cylinder,
            profile: m.skirt_profile.build(&profile).map_err(|e| e.within("models.skirt_profile")),
            oil: m.oil.build().map_err(|e| e.within("models.oil")),
            thinning: m.shear_thinning.build().map_err(|e| e.within("models.shear_thinning")),
            motion: m.secondary_motion.build(&motion).map_err(|e| e.within("models.secondary_motion")),
            pin: m.pin_friction.build().map_err(|e| e.within("models.pin_friction")),
            groove: m.groove_friction.build(&groove).map_err(|e| e.within("models.groove_friction")),
            skirt_oil: m.skirt_oil.build().map_err(|e| e.within("models.skirt_oil")),
        }
    }

    /// All models; what is wrong with them goes to `errors`.
    fn checked(self, errors: &mut Vec<BuildError>) -> Option<Checked> {
        fn keep<T>(built: Result<T, BuildError>, errors: &mut Vec<BuildError>) -> Option<T> {
            built.map_err(|e| errors.push(e)).ok()
        }
        let kinematics = keep(self.kinematics, errors);
        let cylinder = self.cylinder.and_then(|c| keep(c, errors));
        let oil = keep(self.oil, errors);
        let motion = keep(self.motion, errors);
        let pin = keep(self.pin, errors);
        let groove = keep(self.groove, errors);
        let skirt_oil = keep(self.skirt_oil, errors);
        let profile = keep(self.profile, errors);
        keep(self.thinning, errors)?;
        Some(Checked {
            kinematics: kinematics?,
            cylinder: cylinder?,
            profile: profile?,
            oil: oil?,
            motion: motion?,
            pin: pin?,
            groove: groove?,
            skirt_oil: skirt_oil?,
        })
    }
}

/// Both sides of the skirt.
fn both_sides(
    case: &PistonSecondaryCase,
    files: &Files,
    profile: &dyn SkirtProfile,
    elastic: bool,
    intervals: Option<[u32; 2]>,
    clearance: f64,
) -> Result<[Side; 2], Vec<BuildError>> {
    let (s, m, solver) = (&case.skirt, &case.models, &case.solver);
    let thrust = s.half_angle_thrust;
    let half_angles = [thrust.si(), s.half_angle_anti_thrust.unwrap_or(thrust).si()];
    let one = |which: usize| {
        let panel = Panel { radius: radius(case), length: s.length.si(), half_angle: half_angles[which] };
        let [nx, ny] = intervals.unwrap_or([solver.intervals_along, solver.intervals_across]);
        let grid = panel.grid(nx as usize, ny as usize, solver.crowding.si());
        let ctx = SkirtComplianceCtx::new(&grid, panel.length, panel.radius, panel.half_angle, files)
            .named(SIDES[which])
            .relaxing(solver.shape_relaxation.si());
        let spec: &dyn SkirtComplianceSpec = if elastic { &*m.skirt_compliance } else { &Rigid {} };
        let compliance = spec.build(&ctx).map_err(|e| vec![e.within("models.skirt_compliance")])?;
        let pressure = |p: f64| p - case.gas.crankcase_pressure.si();
        Side::new(SideSetup {
            panel,
            sign: [1.0, -1.0][which],
            clearance,
            grid: &grid,
            film: &*m.film_2d,
            roughness: &*m.roughness,
            contact: &*m.contact,
            boundary_friction: m.boundary_friction.as_deref(),
            contact_grid: ContactGrid {
                pitch: solver.contact_pitch.si(),
                intervals: solver.contact_intervals as usize,
            },
            profile,
            compliance,
            shear_thinning: m.shear_thinning.build().ok(),
            p_cav: case.gas.cavitation_pressure.map_or(0.0, |p| pressure(p.si())),
            floor: s.film_floor.si(),
        })
        .map_err(|e| e.into_iter().map(|e| e.within("models")).collect::<Vec<_>>())
    };
    Ok([one(0)?, one(1)?])
}

/// Crank angles at which the piston turns round: with an offset pin not quite at multiples of half a turn.
fn dead_centres(kinematics: &dyn Kinematics, period: f64) -> Vec<f64> {
    let mut found = Vec::new();
    for k in 0..=(period / PI).round() as usize {
        let (mut low, mut high) = (k as f64 * PI - 0.5, k as f64 * PI + 0.5);
        let rising = kinematics.motion(high).v > 0.0;
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if (kinematics.motion(middle).v > 0.0) == rising { high = middle } else { low = middle }
        }
        if high > 0.0 && high < period {
            found.push(high);
        }
    }
    found
}

/// Crank angles where a right-hand side jumps or has a kink \[rad\].
fn breakpoints(kinematics: &dyn Kinematics, cylinder: &dyn CylinderPressure) -> Vec<f64> {
    let mut all = cylinder.kinks().to_vec();
    all.extend(dead_centres(kinematics, cylinder.period()));
    all.sort_by(f64::total_cmp);
    all.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    all
}
