use gudgeon_core::EvalError;
use gudgeon_core::kinds::{FaceForces, FaceIn, Hydrodynamics};

/// Part of a value to which a model finds the same film twice, by another way or from another start: searches end at some 1e-12 of it.
const FOUND: f64 = 1e-9;
/// Part of the damping by which a difference quotient may differ where the film is smooth.
const QUOTIENT: f64 = 1e-3;

/// Complaints about a running film under a ring face, at the instant `inp`, for squeeze velocities up to `hdot` \[m/s\] either way:
///
/// - forces that are not finite, or others after another film;
/// - a load that rises with the squeeze velocity, a damping that is negative or not the difference quotient of the load;
/// - [`Hydrodynamics::forces`], [`Hydrodynamics::load`] and [`Hydrodynamics::carry`] that say something else than [`Hydrodynamics::evaluate`] and
///   [`Hydrodynamics::squeeze_rate`];
/// - a squeeze velocity for a load under which the film carries another one.
///
/// A refusal of the model is a complaint too.
#[must_use]
pub fn hydrodynamics(model: &mut dyn Hydrodynamics, inp: &FaceIn, hdot: f64) -> Vec<String> {
    film(model, inp, hdot).unwrap_or_else(|e| vec![e.to_string()])
}

fn film(model: &mut dyn Hydrodynamics, inp: &FaceIn, hdot: f64) -> Result<Vec<String>, EvalError> {
    let mut wrong = Vec::new();
    let mut last: Option<f64> = None;
    for k in -6..=6 {
        let rate = hdot * f64::from(k) / 6.0;
        let out = model.evaluate(inp, rate)?;
        let forces = out.forces();
        let all =
            [out.load, out.squeeze_damping, out.ring_shear, out.liner_shear, out.slope_force, out.p_max];
        if all.iter().any(|v| !v.is_finite()) {
            wrong.push(format!("not finite at {rate:e} m/s: {out:?}"));
            continue;
        }
        let size = 1e-12 + out.load.abs();
        if let Some(load) = last.filter(|load| out.load > load + FOUND * size) {
            wrong.push(format!("the load rises from {load:e} to {:e} N/m at {rate:e} m/s", out.load));
        }
        if out.squeeze_damping < 0.0 {
            wrong.push(format!("the damping is {:e} N s/m2 at {rate:e} m/s", out.squeeze_damping));
        }
        wrong.extend(damping(model, inp, rate, (out.load, out.squeeze_damping))?);
        wrong.extend(same(model, inp, rate, &forces)?);
        if model.resists() {
            wrong.extend(carried(model, inp, rate, out.load)?);
        }
        last = Some(out.load);
    }
    Ok(wrong)
}

/// The damping against a difference quotient, where both sides of it agree: elsewhere the film has a kink.
fn damping(
    model: &mut dyn Hydrodynamics,
    inp: &FaceIn,
    rate: f64,
    (load, damping): (f64, f64),
) -> Result<Vec<String>, EvalError> {
    if damping <= 0.0 || load <= 0.0 {
        return Ok(Vec::new());
    }
    let step = 1e-4 * load / damping;
    let (up, down) = (model.load(inp, rate + step)?.0, model.load(inp, rate - step)?.0);
    let (above, below) = ((load - up) / step, (down - load) / step);
    let smooth = (above - below).abs() < QUOTIENT * damping;
    let quotient = 0.5 * (above + below);
    Ok(if smooth && (quotient - damping).abs() > QUOTIENT * damping {
        vec![format!("the damping is {damping:e} N s/m2 at {rate:e} m/s, loads give {quotient:e}")]
    } else {
        Vec::new()
    })
}

/// The film again, by the shorter ways and after another film.
fn same(
    model: &mut dyn Hydrodynamics,
    inp: &FaceIn,
    rate: f64,
    first: &FaceForces,
) -> Result<Vec<String>, EvalError> {
    let mut wrong = Vec::new();
    let close = |a: f64, b: f64, size: f64| (a - b).abs() <= FOUND * size;
    let sizes = |f: &FaceForces| [f.load, f.squeeze_damping, f.ring_shear, f.liner_shear, f.slope_force];
    let other = FaceIn { h: 1.3 * inp.h, u: -inp.u, ..*inp };
    model.evaluate(&other, -rate)?;
    for (way, again) in
        [("forces", model.forces(inp, rate)?), ("evaluate", model.evaluate(inp, rate)?.forces())]
    {
        // Shear and slope force are sums of either sign: to the larger of them.
        let shear = first.ring_shear.abs().max(first.liner_shear.abs());
        let own = [first.load.abs(), first.squeeze_damping, shear, shear, shear];
        let differs =
            sizes(first).iter().zip(sizes(&again)).zip(own).any(|((a, b), s)| !close(*a, b, s + 1e-12));
        if differs {
            wrong.push(format!("`{way}` gives {again:?} at {rate:e} m/s, the film was {first:?} at first"));
        }
    }
    let (load, damping) = model.load(inp, rate)?;
    if !close(load, first.load, 1e-12 + first.load.abs())
        || !close(damping, first.squeeze_damping, 1e-12 + damping.abs())
    {
        wrong.push(format!("`load` gives {load:e} N/m and {damping:e} N s/m2 at {rate:e} m/s"));
    }
    Ok(wrong)
}

/// The velocity that carries the load of a film is its own, as far as the load tells.
fn carried(
    model: &mut dyn Hydrodynamics,
    inp: &FaceIn,
    rate: f64,
    load: f64,
) -> Result<Vec<String>, EvalError> {
    // A film that only its edges load says nothing of its velocity.
    let damping = model.evaluate(inp, rate)?.squeeze_damping;
    if damping <= 0.0 || load <= 0.0 {
        return Ok(Vec::new());
    }
    let found = model.squeeze_rate(inp, load)?;
    let (other, forces) = model.carry(inp, load)?;
    let mut wrong = Vec::new();
    for (way, rate, carries) in
        [("squeeze_rate", found, model.load(inp, found)?.0), ("carry", other, forces.load)]
    {
        if (carries - load).abs() > 10.0 * FOUND * load {
            wrong.push(format!(
                "`{way}` gives {rate:e} m/s for {load:e} N/m, where the film carries {carries:e} N/m"
            ));
        }
    }
    Ok(wrong)
}
