//! From a case to a design: models built, load evaluated, contradictions at their places.

use gudgeon_core::BuildError;
use gudgeon_core::file::Files;
use gudgeon_core::kinds::{
    EngineCycle, Fatigue, PinLoadCase, PinLoadCtx, PinSize, PinStrength, PinStrengthCtx,
};
use gudgeon_pin::design::{Design, Range, Relief};
use gudgeon_pin::piston::{ALLOYS, Alloy, find_alloy};
use gudgeon_pin::stock::{MAX_COMBINATIONS, Sizes};

use super::case::{Method, Optimise, Pin, PinCase, RangeCase};
use gudgeon_case::{advice, read_beside, scene_of};

/// What a pin needs besides its dimensions.
pub struct Setup {
    pub load: PinLoadCase,
    pub strength: Box<dyn PinStrength>,
    pub fatigue: Box<dyn Fatigue>,
    pub relief: Option<Relief>,
    pub pi: f64,
    pub bore: f64,
    pub density: f64,
    pub boss_gap: f64,
    pub limits: [f64; 8],
    /// The dimensions given.
    pub given: Option<PinSize>,
    pub length: Range,
    pub outer: Range,
    pub inner: Range,
    pub min_wall: f64,
    pub tolerance: PinSize,
}

impl Setup {
    /// The design that the case asks for.
    pub fn design(&self) -> Design<'_> {
        Design {
            strength: &*self.strength,
            load: self.load.design.forces,
            limits: self.limits,
            density: self.density,
            pi: self.pi,
            relief: self.relief,
            boss_gap: self.boss_gap,
            length: self.length,
            outer: self.outer,
            inner: self.inner,
            min_wall: self.min_wall,
            tolerance: self.tolerance,
        }
    }
}

/// Part of the boss gap and of the piston diameter that a length keeps clear of by default: formulas end there.
const CLEAR: f64 = 1e-6;
/// Default outer diameters over that of the piston.
const OUTER: (f64, f64) = (0.15, 0.5);
/// Maximum number of points of a sweep.
const MAX_POINTS: u32 = 5000;

/// Minimum step of the published search \[m\].
const MIN_STEP: f64 = 1e-10;

/// The alloy of the piston, when one is named.
pub fn alloy(case: &PinCase) -> Result<Option<&'static Alloy>, BuildError> {
    let Some(name) = &case.piston.alloy else { return Ok(None) };
    find_alloy(name).map(Some).ok_or_else(|| {
        let known: Vec<&str> = ALLOYS.iter().map(|a| a.name).collect();
        BuildError::at("piston.alloy", format!("there is no alloy `{name}`")).help(advice(name, &known))
    })
}

/// Builds what the case says of its pin; nothing when it has none.
pub fn setup(case: &PinCase, files: &Files) -> Result<Option<Setup>, Vec<BuildError>> {
    let mut errors = Vec::new();
    let alloy = alloy(case).map_err(|e| errors.push(e));
    let Some(pin) = &case.pin else {
        if case.optimise.is_some() {
            errors.push(BuildError::at("optimise", "there is no pin to optimise: a table `pin` is needed"));
        }
        return if errors.is_empty() { Ok(None) } else { Err(errors) };
    };
    let (bore, pi) = (case.engine.bore.si(), case.conventions.circle_ratio.si());
    if (pi / std::f64::consts::PI - 1.0).abs() > 1e-3 {
        errors.push(BuildError::at(
            "conventions.circle_ratio",
            format!("{pi} is not the ratio of circumference to diameter"),
        ));
    }
    let strength = strength(case, pin, pi).map_err(|e| errors.push(e)).ok();
    let fatigue = case.models.fatigue.build().map_err(|e| errors.push(e.within("models.fatigue"))).ok();
    let load = load(case, files, bore, pi).map_err(|e| errors.push(e)).ok();
    // Without its alloy the density of the piston is another mistake's.
    let relief = match alloy {
        Ok(alloy) => relief(pin, alloy, bore).map_err(|e| errors.push(e)).ok().flatten(),
        Err(()) => None,
    };
    let gap = pin.boss_gap.si();
    if gap >= bore {
        errors.push(BuildError::at("pin.boss_gap", "the bosses are further apart than the piston is wide"));
    }
    let given = given(case, pin, bore, strength.as_deref(), &mut errors);
    let default = Optimise::default();
    let o = case.optimise.as_ref().unwrap_or(&default);
    let ranges = ranges(o, bore, gap, &mut errors);
    let limits = case.limits.values();
    optimisable(case, o, &limits, &mut errors);
    let (Some(strength), Some(fatigue), Some(load), true) = (strength, fatigue, load, errors.is_empty())
    else {
        return Err(errors);
    };
    let out = Setup {
        load,
        strength,
        fatigue,
        relief,
        pi,
        bore,
        density: pin.density.si(),
        boss_gap: gap,
        limits,
        given,
        length: ranges.length,
        outer: ranges.outer,
        inner: ranges.inner,
        min_wall: o.min_wall.si(),
        tolerance: ranges.tolerance,
    };
    few_enough(o, &out)?;
    Ok(Some(out))
}

/// Refuses a stock with more combinations than a search looks at.
fn few_enough(o: &Optimise, setup: &Setup) -> Result<(), Vec<BuildError>> {
    match &o.stock {
        Some(s) if sizes(s).combinations(&setup.design()) > MAX_COMBINATIONS => {
            let what = format!("more than {MAX_COMBINATIONS} combinations of sizes");
            let help = "a coarser `length_step`, shorter lists";
            Err(vec![BuildError::at("optimise.stock", what).help(help)])
        }
        _ => Ok(()),
    }
}

/// Admitted dimensions and their tolerances, SI.
struct Ranges {
    length: Range,
    outer: Range,
    inner: Range,
    tolerance: PinSize,
}

/// The ranges of a case, cut to what is possible; complains where nothing is left.
fn ranges(o: &Optimise, bore: f64, gap: f64, errors: &mut Vec<BuildError>) -> Ranges {
    let t = &o.tolerance;
    let tolerance = PinSize { length: t.length.si(), outer: t.outer.si(), inner: t.inner.si() };
    let given = |range: Option<RangeCase>, otherwise: (f64, f64)| {
        let otherwise = Range { low: otherwise.0, high: otherwise.1 };
        range.map_or(otherwise, |r| Range { low: r.from.si(), high: r.to.si() })
    };
    let (clear, widest) = (gap + tolerance.length, bore - tolerance.length);
    let possible = Range { low: clear * (1.0 + CLEAR), high: widest * (1.0 - CLEAR) };
    let length = cut(given(o.length, (0.0, bore)), "length", possible, errors);
    let possible = Range { low: 2.0 * tolerance.outer + 1e-3 * bore, high: 2.0 * bore };
    let outer = cut(given(o.outer, (OUTER.0 * bore, OUTER.1 * bore)), "outer", possible, errors);
    let possible = Range { low: 0.0, high: 2.0 * bore };
    let inner = cut(given(o.inner, (0.0, 2.0 * bore)), "inner", possible, errors);
    Ranges { length, outer, inner, tolerance }
}

/// The part of a range that is possible; complains when there is none.
fn cut(r: Range, name: &str, possible: Range, errors: &mut Vec<BuildError>) -> Range {
    if r.low > r.high {
        errors.push(BuildError::at(format!("optimise.{name}"), "`from` lies above `to`"));
    } else if r.high <= possible.low || r.low >= possible.high {
        let what = format!(
            "no {name} between {:.4} and {:.4} mm is possible here: it lies between {:.4} and {:.4} mm",
            1e3 * r.low,
            1e3 * r.high,
            1e3 * possible.low,
            1e3 * possible.high
        );
        errors.push(BuildError::at(format!("optimise.{name}"), what));
    }
    Range { low: r.low.max(possible.low), high: r.high.min(possible.high) }
}

/// Sizes of the stock in SI.
pub fn sizes(s: &super::case::Stock) -> Sizes {
    Sizes {
        outer: s.outer.iter().map(|v| v.si()).collect(),
        inner: s.inner.iter().map(|v| v.si()).collect(),
        length_step: s.length_step.map(|v| v.si()),
    }
}

fn strength(case: &PinCase, pin: &Pin, pi: f64) -> Result<Box<dyn PinStrength>, BuildError> {
    let ctx = PinStrengthCtx {
        boss_gap: pin.boss_gap.si(),
        rod_width: pin.rod_width.si(),
        boss_bore: pin.boss_bore,
        modulus: pin.modulus.si(),
        poisson: pin.poisson.si(),
        pi,
    };
    case.models.pin_strength.build(&ctx).map_err(|e| match e.field.as_str() {
        // The surroundings of the pin are the case's, not the model's.
        "boss_gap" | "rod_width" | "modulus" | "poisson" => e.within("pin"),
        _ => e.within("models.pin_strength"),
    })
}

fn load(case: &PinCase, files: &Files, bore: f64, pi: f64) -> Result<PinLoadCase, BuildError> {
    let Some(spec) = &case.models.pin_load else {
        return Err(BuildError::at("models", "nothing loads the pin: `models.pin_load` is missing")
            .help("for instance `pin_load = { model = \"given\", gas = \"50 kN\" }`"));
    };
    let cycle_of = |name: &str| other_cycle(files, name);
    spec.build(&PinLoadCtx { bore, pi, files, cycle_of: &cycle_of }).map_err(|e| e.within("models.pin_load"))
}

/// The cycle of one cylinder that a case of another scene describes.
fn other_cycle(files: &Files, name: &str) -> Result<EngineCycle, BuildError> {
    let first = |r: gudgeon_case::Report| match r.diagnostics.into_iter().next() {
        Some(d) => {
            BuildError { help: d.help.clone(), ..BuildError::new(format!("`{name}`: {}", d.headline())) }
        }
        None => BuildError::new(format!("`{name}` cannot be read")),
    };
    let source = read_beside(files, name).map_err(first)?;
    let scene = scene_of(&source, &[]).unwrap_or_default();
    let case = gudgeon_scene::load(source, &[]).map_err(first)?;
    let Some(cycle) = case.cycle() else {
        let what = format!("`{name}` is a case of the scene `{scene}`, which describes no cycle");
        return Err(BuildError::new(what).help("name a case with an engine and a cylinder pressure"));
    };
    cycle.map_err(|e| BuildError::new(format!("`{name}`: {e}")))
}

fn relief(pin: &Pin, alloy: Option<&Alloy>, bore: f64) -> Result<Option<Relief>, BuildError> {
    let Some(r) = &pin.relief else { return Ok(None) };
    let density = match (r.density, alloy) {
        (Some(d), _) => d.si(),
        (None, Some(a)) => a.density,
        (None, None) => {
            return Err(BuildError::at("pin.relief", "the density of the piston is not known")
                .help("give `pin.relief.density` or `piston.alloy`"));
        }
    };
    Ok(Some(Relief { bore, height: r.height.si(), density }))
}

/// The dimensions of the case, when all three are given; complains where they are needed or cannot be.
fn given(
    case: &PinCase,
    pin: &Pin,
    bore: f64,
    strength: Option<&dyn PinStrength>,
    errors: &mut Vec<BuildError>,
) -> Option<PinSize> {
    let (Some(length), Some(outer), Some(inner)) = (pin.length, pin.outer, pin.inner) else {
        let needed = case.optimise.as_ref().is_none_or(|o| o.method == Method::AsPublished);
        if needed {
            let names = [
                ("length", pin.length.is_none()),
                ("outer", pin.outer.is_none()),
                ("inner", pin.inner.is_none()),
            ];
            let missing: Vec<&str> = names.iter().filter(|(_, m)| *m).map(|(n, _)| *n).collect();
            let what = format!("the pin has no {}", missing.join(", "));
            let help = "give them, or let `[optimise]` find them with the method `exact`";
            errors.push(BuildError::at("pin", what).help(help));
        }
        return None;
    };
    let size = PinSize { length: length.si(), outer: outer.si(), inner: inner.si() };
    let mm = |v: f64| 1e3 * v;
    if size.length <= pin.boss_gap.si() {
        let what = format!(
            "a pin {} mm long does not reach bosses {} mm apart",
            mm(size.length),
            mm(pin.boss_gap.si())
        );
        errors.push(BuildError::at("pin.length", what));
    } else if size.length >= bore {
        let what = format!("a pin {} mm long does not fit a piston of {} mm", mm(size.length), mm(bore));
        errors.push(BuildError::at("pin.length", what));
    }
    if size.inner >= size.outer {
        let what =
            format!("a bore of {} mm leaves no wall in a pin of {} mm", mm(size.inner), mm(size.outer));
        errors.push(BuildError::at("pin.inner", what));
    } else if let Some(m) = strength
        && size.inner < m.min_bore_ratio() * size.outer
    {
        let what = format!(
            "the model `{}` holds for bores of {} of the outer diameter or more",
            case.models.pin_strength.typetag_name(),
            m.min_bore_ratio()
        );
        errors.push(BuildError::at("pin.inner", what).help("`elastic_ring` holds for solid pins too"));
    }
    if size.outer >= bore {
        errors.push(BuildError::at("pin.outer", "the pin is thicker than the piston"));
    }
    Some(size)
}

/// Whether what is asked of the search can be done.
fn optimisable(case: &PinCase, o: &Optimise, limits: &[f64; 8], errors: &mut Vec<BuildError>) {
    if case.optimise.is_none() {
        return;
    }
    // Without one of these the wall may vanish, and the lightest pin with it.
    if ![1, 2, 4, 5, 6, 7].iter().any(|k| limits[*k].is_finite()) && o.min_wall.si() == 0.0 {
        errors.push(
            BuildError::at("limits", "nothing keeps the pin's wall from vanishing")
                .help("limit a stress, the ovalisation or the deflection, or give `optimise.min_wall`"),
        );
    }
    for (k, q) in o.pareto.iter().enumerate() {
        if !limits[*q as usize].is_finite() {
            let what = format!("`{}` is not limited", q.name());
            errors.push(BuildError::at(format!("optimise.pareto.{k}"), what));
        }
    }
    if o.sweep_points > MAX_POINTS || o.sweep_points == 1 {
        errors.push(BuildError::at("optimise.sweep_points", format!("0, or 2 to {MAX_POINTS} points")));
    }
    let s = &o.steps;
    for (name, v) in [("length", s.length.si()), ("coarse", s.coarse.si()), ("fine", s.fine.si())] {
        if v < MIN_STEP {
            errors.push(BuildError::at(
                format!("optimise.steps.{name}"),
                "steps of less than 0.1 nm never end",
            ));
        }
    }
    if o.certificate.si() > 0.1 || o.certificate.si() < 1e-9 {
        errors.push(BuildError::at("optimise.certificate", "a gap between 1e-9 and 0.1 can be proved"));
    }
}
