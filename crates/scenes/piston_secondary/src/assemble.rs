//! From a case to the running sub-models.

use std::f64::consts::PI;

use gudgeon_core::file::Files;
use gudgeon_core::kinds::{
    CylinderPressure, CylinderPressureCtx, GrooveFrictionCtx, Kinematics, KinematicsCtx, Lateral,
    SkirtComplianceCtx, SkirtModes, SkirtProfile, SkirtProfileCtx,
};
use gudgeon_core::{BuildError, EvalError};
use gudgeon_skirt::{Body, ContactGrid, Crank, Instant, Panel, Piston, Rod, Side, SideSetup};

use super::case::{GravitySide, Method, PistonSecondaryCase};

/// The piston with what drives it.
pub struct Assembly {
    /// Piston with both sides of its skirt.
    pub piston: Piston,
    /// Motion along the bore.
    pub kinematics: Box<dyn Kinematics>,
    /// Shape of the skirt.
    pub profile: Box<dyn SkirtProfile>,
    /// Gas.
    pub cylinder: Box<dyn CylinderPressure>,
    /// How the motion across the bore comes about.
    pub lateral: Lateral,
    /// Area under the gas \[m²\].
    pub area: f64,
    /// Viscosity \[Pa s\].
    pub mu: f64,
    /// Crankcase pressure \[Pa\].
    pub p_crankcase: f64,
    /// Running radial clearance \[m\].
    pub clearance: f64,
    /// Length of the cycle \[rad\].
    pub period: f64,
    /// Crank angles where a right-hand side jumps or has a kink \[rad\].
    pub breakpoints: Vec<f64>,
    /// Whether the skirt yields.
    pub elastic: bool,
    /// Film evaluations after which a search is given up.
    pub most_films: u64,
}

/// Smallest and largest admitted intervals of a grid.
const INTERVALS: std::ops::RangeInclusive<u32> = 2..=1000;
/// Most maps of a cycle: each is as large as the grid of a side, and a page holds them all.
const MOST_MAPS: f64 = 20_000.0;

impl Assembly {
    /// What acts on the piston at crank angle `theta` \[rad\].
    #[must_use]
    pub fn instant(&self, theta: f64) -> Instant {
        let p = self.cylinder.pressure(theta) - self.p_crankcase;
        let motion = self.kinematics.motion(theta);
        self.piston.crank.instant(theta, &motion, p, self.area, self.mu)
    }

    /// Whether the films may be asked once more.
    ///
    /// # Errors
    /// They were asked too often.
    pub fn go_on(&self) -> Result<(), EvalError> {
        if self.piston.film_evaluations() <= self.most_films {
            return Ok(());
        }
        let what = format!(
            "given up after {} film evaluations: raise `solver.max_film_evaluations` to go on",
            self.most_films
        );
        Err(EvalError::fatal("piston_secondary", what))
    }

    /// Crank speed \[rad/s\].
    #[must_use]
    pub fn omega(&self) -> f64 {
        self.kinematics.omega()
    }
}

/// Radius of the skirt \[m\].
#[must_use]
pub fn radius(case: &PistonSecondaryCase) -> f64 {
    case.skirt.radius.map_or(0.5 * case.engine.bore.si() - case.skirt.clearance.si(), |r| r.si())
}

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
    let (e, p, s, m) = (&case.engine, &case.piston, &case.skirt, &case.models);
    let (radius, length) = (radius(case), s.length.si());
    let crank = Crank {
        radius: e.crank_radius.si(),
        rod_length: e.rod_length.si(),
        omega: e.speed.si(),
        pin_offset: e.pin_offset.si(),
        crank_offset: e.crank_offset.si(),
        rod: case.rod.as_ref().map_or_else(Rod::default, |r| Rod {
            mass: r.mass.si(),
            centre: r.gravity_distance.si(),
            inertia: r.inertia.si(),
        }),
    };
    let side = match p.gravity_side {
        GravitySide::Thrust => 1.0,
        GravitySide::AntiThrust => -1.0,
    };
    let body = Body {
        piston_mass: p.mass.si(),
        pin_mass: p.pin_mass.si(),
        inertia: p.inertia.si(),
        length,
        pin: p.pin_depth.si(),
        centre: p.gravity_depth.si(),
        centre_offset: side * p.gravity_offset.si(),
    };
    let area = 0.25 * PI * e.bore.si() * e.bore.si();
    let mut keep = |r: Result<(), BuildError>| {
        if let Err(e) = r {
            errors.push(e);
        }
    };
    let ctx = KinematicsCtx {
        crank_radius: crank.radius,
        rod_length: crank.rod_length,
        offset: crank.crank_offset - crank.pin_offset,
        omega: crank.omega,
    };
    let kinematics = m.kinematics.build(&ctx).map_err(|e| match e.field.as_str() {
        "" => e.within("models.kinematics"),
        _ => e.within("engine"),
    });
    let cylinder = match &kinematics {
        Ok(k) => {
            let ctx = CylinderPressureCtx { kinematics: &**k, piston_area: area, files };
            Some(m.cylinder_pressure.build(&ctx).map_err(|e| e.within("models.cylinder_pressure")))
        }
        Err(_) => None,
    };
    let profile = m
        .skirt_profile
        .build(&SkirtProfileCtx { length, radius, files })
        .map_err(|e| e.within("models.skirt_profile"));
    let oil = m.oil.build().map_err(|e| e.within("models.oil"));
    let thinning = m.shear_thinning.build().map_err(|e| e.within("models.shear_thinning"));
    let motion = m.secondary_motion.build().map_err(|e| e.within("models.secondary_motion"));
    let pin = m.pin_friction.build().map_err(|e| e.within("models.pin_friction"));
    let groove = m
        .groove_friction
        .build(&GrooveFrictionCtx { bore: e.bore.si() })
        .map_err(|e| e.within("models.groove_friction"));
    let mut sides = Vec::new();
    let clearance = running_clearance(case, radius);
    if clearance.is_nan() || clearance <= 0.0 {
        keep(Err(BuildError::at(
            "skirt.thermal",
            format!("the running clearance is {:.3} um", 1e6 * clearance),
        )));
    }
    let p_cav = case.gas.cavitation_pressure.map_or(0.0, |p| p.si() - case.gas.crankcase_pressure.si());
    if p_cav > 0.0 {
        let what = "films would cavitate above the pressure of the crankcase, which is that of their edges";
        keep(Err(BuildError::at("gas.cavitation_pressure", what)));
    }
    // The mistakes of the common models are told once.
    if let (Ok(profile), Ok(_), true) = (&profile, &thinning, errors.is_empty()) {
        let half = |side: usize| match (side, s.half_angle_anti_thrust) {
            (1, Some(a)) => a.si(),
            _ => s.half_angle_thrust.si(),
        };
        for which in 0..2 {
            let panel = Panel { radius, length, half_angle: half(which) };
            let solver = &case.solver;
            let [nx, ny] = intervals.unwrap_or([solver.intervals_along, solver.intervals_across]);
            let grid = panel.grid(nx as usize, ny as usize, solver.crowding.si());
            let modes = if elastic {
                m.skirt_compliance.build(&SkirtComplianceCtx {
                    grid: &grid,
                    length,
                    radius,
                    half_angle: panel.half_angle,
                    files,
                })
            } else {
                Ok(SkirtModes::default())
            };
            let modes = match modes {
                Ok(modes) => modes,
                Err(e) => {
                    errors.push(e.within("models.skirt_compliance"));
                    break;
                }
            };
            let built = Side::new(SideSetup {
                panel,
                sign: [1.0, -1.0][which],
                clearance,
                grid: &grid,
                film: &*m.film_2d,
                roughness: &*m.roughness,
                contact: &*m.contact,
                contact_grid: ContactGrid {
                    pitch: solver.contact_pitch.si(),
                    intervals: solver.contact_intervals as usize,
                },
                profile: &**profile,
                modes: &modes,
                shear_thinning: m.shear_thinning.build().ok(),
                p_cav,
                floor: s.film_floor.si(),
            });
            match built {
                Ok(side) => sides.push(side),
                Err(e) => {
                    errors.extend(e.into_iter().map(|e| e.within("models")));
                    break;
                }
            }
        }
    }
    let mut told = |e: Option<BuildError>| errors.extend(e);
    let kinematics = kinematics.map_err(|e| told(Some(e))).ok();
    let cylinder = cylinder.and_then(|c| c.map_err(|e| told(Some(e))).ok());
    let oil = oil.map_err(|e| told(Some(e))).ok();
    let motion = motion.map_err(|e| told(Some(e))).ok();
    let pin = pin.map_err(|e| told(Some(e))).ok();
    let groove = groove.map_err(|e| told(Some(e))).ok();
    let profile = profile.map_err(|e| told(Some(e))).ok();
    told(thinning.err());
    let sides: Result<[Side; 2], _> = sides.try_into();
    let (Some(kinematics), Some(profile), Some(cylinder), Some(oil), Some(motion)) =
        (kinematics, profile, cylinder, oil, motion)
    else {
        return Err(errors);
    };
    let (Some(pin), Some(groove), Ok(sides)) = (pin, groove, sides) else {
        return Err(errors);
    };
    let mu = oil.viscosity(s.oil_temperature.si());
    if !(mu > 0.0 && mu.is_finite()) {
        errors.push(BuildError::at(
            "models.oil",
            format!("the viscosity at the oil's temperature is {mu} Pa s"),
        ));
    }
    if !errors.is_empty() {
        return Err(errors);
    }
    let period = cylinder.period();
    let mut breakpoints = cylinder.kinks().to_vec();
    breakpoints.extend(dead_centres(&*kinematics, period));
    breakpoints.sort_by(f64::total_cmp);
    breakpoints.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    let elastic = sides.iter().any(|s| s.elastic() > 0);
    let mut piston = Piston::new(sides, body, crank, pin, groove);
    piston.relaxation = case.solver.shape_relaxation.si();
    Ok(Assembly {
        piston,
        kinematics,
        profile,
        cylinder,
        lateral: motion.lateral(),
        area,
        mu,
        p_crankcase: case.gas.crankcase_pressure.si(),
        clearance,
        period,
        breakpoints,
        elastic,
        most_films: case.solver.max_film_evaluations,
    })
}

/// What cannot move, or not from where it begins.
pub fn impossible(case: &PistonSecondaryCase, a: &mut Assembly) -> Vec<BuildError> {
    let mut errors = Vec::new();
    let s = &case.solver;
    let now = a.instant(0.0);
    let (inertial, moves) = (a.lateral == Lateral::Inertial, !matches!(a.lateral, Lateral::Held { .. }));
    // A film that cannot be solved between centred surfaces tells so when it runs.
    if moves && matches!(a.piston.resists(&now, inertial), Ok(false)) {
        let nothing = "this film does not resist the motion across the bore";
        if !inertial {
            let help = "`quasi_static` finds the velocities at which films carry the load: use another film, or `full_inertia` for a dry skirt";
            errors.push(BuildError::at("models.film_2d", nothing).help(help));
        } else if s.cycles == 0 {
            let what = format!("{nothing}: without damping it does not become periodic");
            errors.push(
                BuildError::at("models.film_2d", what).help("look at the transient with `solver.cycles`"),
            );
        }
    }
    let (place, start) = match a.lateral {
        Lateral::Held { e_top, e_bottom } => ("models.secondary_motion.e_", [e_top, e_bottom]),
        _ => ("solver.start_", [s.start_top.si(), s.start_bottom.si()]),
    };
    let mut x = vec![0.0; a.piston.coordinates()];
    x[..2].copy_from_slice(&start);
    if let Err(e) = a.piston.gaps(&x, now.speed) {
        let edge = if start[0].abs() >= start[1].abs() { "top" } else { "bottom" };
        errors.push(BuildError::at(format!("{place}{edge}"), e.to_string()));
    }
    errors
}

/// Radial clearance of the running engine \[m\].
#[must_use]
pub fn running_clearance(case: &PistonSecondaryCase, radius: f64) -> f64 {
    let cold = case.skirt.clearance.si();
    case.skirt.thermal.as_ref().map_or(cold, |t| {
        let grown = |expansion: f64, temperature: f64| expansion * (temperature - t.measured_at.si());
        cold + (radius + cold) * grown(t.bore_expansion.si(), t.bore.si())
            - radius * grown(t.skirt_expansion.si(), t.skirt.si())
    })
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

/// What is wrong with a case by itself.
fn legal(case: &PistonSecondaryCase) -> Vec<BuildError> {
    let mut errors = Vec::new();
    let mut say = |place: &str, what: String| errors.push(BuildError::at(place, what));
    let s = &case.solver;
    for (place, a) in [
        ("skirt.half_angle_thrust", Some(case.skirt.half_angle_thrust)),
        ("skirt.half_angle_anti_thrust", case.skirt.half_angle_anti_thrust),
    ] {
        if let Some(a) = a.filter(|a| a.si() >= 0.5 * PI) {
            say(place, format!("must be below 90 degrees, not {}", a.si().to_degrees()));
        }
    }
    for (place, n) in [
        ("solver.intervals_along", s.intervals_along),
        ("solver.intervals_across", s.intervals_across),
        ("solver.contact_intervals", s.contact_intervals),
    ] {
        if !INTERVALS.contains(&n) {
            say(place, format!("must be between {} and {}, not {n}", INTERVALS.start(), INTERVALS.end()));
        }
    }
    if !(0.0..=0.5).contains(&s.crowding.si()) {
        say("solver.crowding", format!("must be between 0 and 0.5, not {}", s.crowding.si()));
    }
    for (place, t) in [("solver.tolerance", s.tolerance.si()), ("solver.periodicity", s.periodicity.si())] {
        if !(1e-12..=0.1).contains(&t) {
            say(place, format!("must be between 1e-12 and 0.1, not {t}"));
        }
    }
    if s.max_cycles == 0 {
        say("solver.max_cycles", "at least one cycle is needed".into());
    }
    let steps = 4.0 * PI / s.step.si();
    if s.method == Method::BackwardEuler && !(36.0..=1e6).contains(&steps) {
        say("solver.step", format!("a cycle of {steps:.0} steps is none: between 7e-4 and 20 degrees"));
    }
    let parts = case.outputs.series_step.si() / s.step.si();
    if s.method == Method::BackwardEuler && (parts - parts.round()).abs() > 1e-6 {
        say("outputs.series_step", "rows of the series must be a whole number of `solver.step` apart".into());
    }
    if case.skirt.length.si() / s.contact_pitch.si() > 1e5 {
        say("solver.contact_pitch", "more than 100 000 rows of contact on the skirt".into());
    }
    let rows = 4.0 * PI / case.outputs.series_step.si();
    if !(8.0..=1e6).contains(&rows) {
        say("outputs.series_step", format!("a series of {rows:.0} rows a cycle is none"));
    }
    let maps = case.outputs.map_step.map_or(0.0, |m| 4.0 * PI / m.si());
    if maps > MOST_MAPS {
        say("outputs.map_step", format!("{maps:.0} maps a cycle are more than {MOST_MAPS:.0}"));
    }
    if radius(case) <= 0.0 {
        say("skirt.clearance", "the clearance is larger than the bore".into());
    }
    if s.method == Method::AsPublished {
        errors.push(
            BuildError::at(
                "solver.method",
                "the published scheme cannot run: an explicit method on accelerations behind a 500 Hz low-pass diverges within five degrees of crank angle",
            )
            .help("the films damp the motion at 1e6 to 5e7 1/s; use `implicit`, or `backward_euler` for the simplest scheme that can"),
        );
    }
    errors
}
