use gudgeon_core::kinds::{GasFlow, GasIn, GasOut, GasPartials, GasPassage, GasSpace, GasWay};

use crate::differences::{Tolerance, partials};

/// Complaints about a running gas flow at one instant `inp` with the land pressures `p_land` \[Pa\] (one a land, cylinder first, crankcase last):
///
/// - a result that is not finite, or that changes when it is asked again after another instant;
/// - gas that appears or vanishes: the rates of the masses do not add up to what comes in less what goes out;
/// - passages, where the model names them, that do not pass what it says of its rings, of the crankcase and of all it stores;
/// - [`GasFlow::rates_moved`] or [`GasFlow::rates_standing`] that differs from [`GasFlow::rates`];
/// - partial derivatives that differ from differences over 1e-5 of each mass by more than `tolerance`.
///
/// Choose pressures that differ from land to land: at equal ones many laws have a kink.
///
/// A refusal of the model is a complaint too.
#[must_use]
pub fn gas_flow(
    model: &mut dyn GasFlow,
    inp: &GasIn<'_>,
    p_land: &[f64],
    tolerance: Tolerance,
) -> Vec<String> {
    gas(model, inp, p_land, tolerance).unwrap_or_else(|e| vec![e.to_string()])
}

fn gas(
    model: &mut dyn GasFlow,
    inp: &GasIn<'_>,
    p_land: &[f64],
    tolerance: Tolerance,
) -> Result<Vec<String>, gudgeon_core::EvalError> {
    let (n, masses, rings) = (model.states().len(), model.n_masses(), inp.rings.len());
    let mut wrong = Vec::new();
    if masses > n {
        wrong.push(format!("{masses} masses among {n} states"));
        return Ok(wrong);
    }
    let mut m = vec![0.0; n];
    model.at_pressures(inp, p_land, &mut m);
    let asked = |model: &mut dyn GasFlow, m: &[f64], inp: &GasIn<'_>| {
        let (mut d, mut out) = (vec![0.0; n], with_passages(model, rings));
        model.rates(inp, m, &mut d, &mut out).map(|()| (d, out))
    };
    let (d, out) = asked(model, &m, inp)?;
    let other = GasIn { p_cylinder: 2.0 * inp.p_cylinder, ..*inp };
    let elsewhere = asked(model, &m, &other)?;
    if asked(model, &m, inp)? != (d.clone(), out.clone()) {
        wrong.push("the same instant has other rates after another instant".into());
    }
    let (mut standing, mut standing_out) = (vec![0.0; n], with_passages(model, rings));
    model.rates_standing(&other, &m, &mut standing, &mut standing_out)?;
    if (standing, standing_out) != elsewhere {
        wrong.push("rates_standing differs from rates".into());
    }
    model.rates(inp, &m, &mut vec![0.0; n], &mut with_passages(model, rings))?;
    let all = [&d, &out.p_land, &out.p_back, &out.flow_in, &out.flow_out, &out.passages];
    if all.iter().any(|v| v.iter().any(|x| !x.is_finite())) {
        wrong.push(format!("not finite: {d:?}, {out:?}"));
    }
    if rings > 0 {
        let stored: f64 = d[..masses].iter().sum();
        let passed = out.flow_in[0] - out.flow_out[rings - 1];
        // Each rate is a sum of a few flows, each rounded once.
        let size: f64 = d[..masses].iter().map(|x| x.abs()).sum::<f64>()
            + out.flow_in[0].abs()
            + out.flow_out[rings - 1].abs();
        let admitted = 16.0 * f64::EPSILON * size;
        if (stored - passed).abs() > admitted {
            wrong.push(format!("the volumes gain {stored:e} kg/s, {passed:e} kg/s come in"));
        }
    }
    wrong.extend(passages(model.passages(), &d[..masses], &out));
    for ring in 0..rings {
        let (mut moved, mut moved_out) = (vec![0.0; n], with_passages(model, rings));
        model.rates_moved(ring, inp, &m, &mut moved, &mut moved_out)?;
        if (&moved, &moved_out) != (&d, &out) {
            wrong.push(format!("rates_moved of ring {ring} differs from rates, nothing having moved"));
        }
    }
    let mut p = GasPartials::new(rings, n);
    p.passages = vec![0.0; model.passages().len() * n];
    if n > 0 && model.partials(inp, &m, &mut p)? {
        wrong.extend(gas_partials(model, inp, &m, &p, tolerance)?);
    }
    Ok(wrong)
}

/// Buffers that ask for the flow through every passage.
fn with_passages(model: &dyn GasFlow, rings: usize) -> GasOut {
    GasOut { passages: vec![0.0; model.passages().len()], ..GasOut::new(rings) }
}

/// Passages that do not pass what comes to the rings and to the crankcase, or do not leave in the spaces between what is stored there.
fn passages(all: &[GasPassage], stored: &[f64], out: &GasOut) -> Vec<String> {
    let rings = out.flow_in.len();
    if all.is_empty() || rings == 0 {
        return Vec::new();
    }
    let each = || all.iter().zip(&out.passages);
    let into = |space: GasSpace| -> f64 {
        let side = |there: GasSpace| f64::from(u8::from(there == space));
        each().map(|(p, flow)| (side(p.to) - side(p.from)) * flow).sum()
    };
    // Sums of a few flows, each rounded once.
    let admitted = 64.0 * f64::EPSILON * out.passages.iter().map(|flow| flow.abs()).sum::<f64>();
    let mut wrong = Vec::new();
    let mut compare = |what: String, told: f64, passed: f64| {
        if (told - passed).abs() > admitted {
            wrong.push(format!("{what}: {told:e} kg/s, and its passages pass {passed:e} kg/s"));
        }
    };
    for (i, told) in out.flow_in.iter().enumerate() {
        let own = || each().filter(|(p, _)| p.ring == i);
        let flank = |way| matches!(way, GasWay::UpperFlank | GasWay::LowerFlank | GasWay::Groove);
        let first = own().find(|(p, _)| flank(p.way)).map_or(0.0, |(_, flow)| *flow);
        let direct = own().filter(|(p, _)| !flank(p.way) && p.way != GasWay::Drain);
        compare(format!("flow into ring {i}"), *told, first + direct.map(|(_, flow)| flow).sum::<f64>());
    }
    compare("blow-by".into(), out.flow_out[rings - 1], into(GasSpace::Land(rings)));
    let between = (1..rings).map(GasSpace::Land).chain((0..rings).map(GasSpace::Behind));
    compare("what is stored".into(), stored.iter().sum(), between.map(into).sum());
    wrong
}

fn gas_partials(
    model: &mut dyn GasFlow,
    inp: &GasIn<'_>,
    m: &[f64],
    p: &GasPartials,
    tolerance: Tolerance,
) -> Result<Vec<String>, gudgeon_core::EvalError> {
    let (n, rings) = (m.len(), inp.rings.len());
    let given = [&p.d_state, &p.p_land, &p.p_back, &p.flow_in, &p.flow_out, &p.passages];
    let given = given.map(|v| v.as_slice()).concat();
    let step: Vec<f64> = m.iter().map(|m| 1e-5 * m.abs()).collect();
    let mut failed = None;
    let (mut d, mut out) = (vec![0.0; n], with_passages(model, rings));
    let f = |m: &[f64], all: &mut [f64]| {
        if let Err(e) = model.rates(inp, m, &mut d, &mut out) {
            failed = Some(e);
        }
        all.copy_from_slice(
            &[&d, &out.p_land, &out.p_back, &out.flow_in, &out.flow_out, &out.passages]
                .map(|v| v.as_slice())
                .concat(),
        );
    };
    let wrong = partials(f, m, &step, &given, tolerance);
    failed.map_or(Ok(wrong), Err)
}
