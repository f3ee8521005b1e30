//! The piston around the pin: skirt, crown, main dimensions.

use gudgeon_core::BuildError;
use gudgeon_core::result::{Note, RunResult, Series};
use gudgeon_pin::piston::{
    Barrel, Clearance, GUIDES, STATIONS, Station, cap_depth, cap_rim, cap_volume, cap_volume_of_rim, ovality,
    proposed_ordinates,
};

use super::case::{Crown, PinCase, Skirt};
use super::output::{column, lines, refused, result};
use super::{draw, setup};
use gudgeon_scene::RunError;

/// Maximum number of rows of a profile.
const MAX_ROWS: f64 = 20_000.0;

/// What is wrong with the tables of the piston.
pub fn legal(case: &PinCase) -> Vec<BuildError> {
    let mut errors = Vec::new();
    if let Some(s) = &case.skirt {
        if let Err(e) = stations(case, s) {
            // The alloy itself is complained of with the pin.
            if e.field != "piston.alloy" || case.pin.is_none() {
                errors.push(e);
            }
        } else {
            let x: [f64; 5] = STATIONS.map(|f| f * s.height.si());
            if let Err(e) = case.models.profile_curve.build(&x, &[0.0; 5]) {
                errors.push(e.within("models.profile_curve"));
            }
        }
        if s.height.si() / s.step.si() > MAX_ROWS {
            errors.push(BuildError::at("skirt.step", "so small a step makes too many rows"));
        }
        if s.height.si() < s.step.si() {
            errors.push(BuildError::at("skirt.step", "the step is longer than the skirt"));
        }
        if s.surface_ratio.is_some_and(|r| r.si() > 0.2) {
            errors.push(
                BuildError::at("skirt.surface_ratio", "no skirt is that oval")
                    .help("the ratio is a number: 5.5 per mille is 0.0055"),
            );
        }
    }
    if let Some(c) = &case.crown
        && let Err(e) = recess(c)
    {
        errors.push(e.within("crown"));
    }
    if let Some(d) = &case.dimensions {
        for (g, v) in GUIDES.iter().zip(d.values()) {
            if v.is_some_and(|v| v > 3.0 * case.engine.bore.si()) {
                errors.push(
                    BuildError::at(format!("dimensions.{}", g.name), "more than three piston diameters")
                        .help("check the unit: a bare number is in metres"),
                );
            }
        }
    }
    errors
}

fn stations(case: &PinCase, s: &Skirt) -> Result<[Station; 5], BuildError> {
    let expansions = match (&s.expansions, setup::alloy(case)?) {
        (Some(e), _) => e.map(|e| e.si()),
        (None, Some(a)) => [a.expansion; 5],
        (None, None) => {
            return Err(BuildError::at("skirt", "the thermal expansion of the piston is not known")
                .help("give `skirt.expansions` or `piston.alloy`"));
        }
    };
    Ok(std::array::from_fn(|i| Station {
        height: STATIONS[i] * s.height.si(),
        temperature: s.temperatures[i].si(),
        expansion: expansions[i],
        wanted: s.wanted_clearances[i].si(),
    }))
}

/// Depth of a recess.
fn recess(c: &Crown) -> Result<f64, BuildError> {
    let depth = match (c.depth, c.volume) {
        (Some(_), Some(_)) => {
            return Err(BuildError::at("depth", "both `depth` and `volume` are given").help("keep one"));
        }
        (None, None) => return Err(BuildError::new("the recess has neither `depth` nor `volume`")),
        (Some(d), None) if d.si() > c.radius.si() => {
            return Err(BuildError::at("depth", "deeper than half the sphere"));
        }
        (Some(d), None) => d.si(),
        (None, Some(v)) => cap_depth(v.si(), c.radius.si())
            .ok_or_else(|| BuildError::at("volume", "more than half the sphere holds"))?,
    };
    if c.compression_ratio.si() <= 1.0 {
        return Err(BuildError::at("compression_ratio", "a compression ratio is above one"));
    }
    Ok(depth)
}

/// Runs what the case asks of the piston.
pub fn run(case: &PinCase, out: &mut RunResult) -> Result<(), RunError> {
    if let Some(s) = &case.skirt {
        skirt(case, s, out).map_err(|e| refused(vec![e]))?;
    }
    if let Some(c) = &case.crown {
        crown(case, c, out).map_err(|e| refused(vec![e]))?;
    }
    if let Some(d) = &case.dimensions {
        let bore = case.engine.bore.si();
        for (g, v) in GUIDES.iter().zip(d.values()) {
            let middle = 0.5 * (g.low + g.high);
            result(
                out,
                format!("guide_{}", g.name),
                1e3 * middle * bore,
                "mm",
                format!("{}, by the guide", g.what),
            );
            if let Some(v) = v {
                result(
                    out,
                    format!("adopted_{}", g.name),
                    100.0 * v / bore,
                    "%",
                    format!("{}, adopted, of the diameter", g.what),
                );
                let off = v / bore;
                // A quarter of the guide is the room that adopted pistons take.
                if off < 0.75 * g.low || off > 1.25 * g.high {
                    out.solver.notes.push(Note::caution(
                        "guide",
                        format!(
                            "{}: {:.2} mm is {:.1} % of the diameter; the guide says {:.0} to {:.0} %.",
                            g.what,
                            1e3 * v,
                            100.0 * off,
                            100.0 * g.low,
                            100.0 * g.high
                        ),
                    ));
                }
            }
        }
    }
    Ok(())
}

fn skirt(case: &PinCase, s: &Skirt, out: &mut RunResult) -> Result<(), BuildError> {
    let st = stations(case, s)?;
    let barrel = Barrel {
        bore: case.engine.bore.si(),
        temperature: s.cylinder_temperature.si(),
        expansion: s.cylinder_expansion.si(),
        assembly_temperature: s.assembly_temperature.si(),
        assembly_clearance: s.assembly_clearance.si(),
    };
    let c: [Clearance; 5] = st.map(|s| barrel.clearance(&s));
    let proposed = proposed_ordinates(&st, &c);
    let y = s.ordinates.map_or(proposed, |o| o.map(|v| v.si()));
    let oval = s.surface_ratio.map(|r| ovality(barrel.bore, r.si()));
    if let Some(o) = oval {
        result(out, "ovality", 1e6 * o, "um", "difference of the axes of the skirt");
    }
    let mut um = |name: &str, what: &str, of: &dyn Fn(usize) -> f64| {
        for i in 0..5 {
            // Sums of tens of micrometres: what is below a femtometre is rounding.
            let v = of(i);
            let v = if v.abs() < 1e-15 { 0.0 } else { v };
            result(out, format!("{name}_{}", i + 1), 1e6 * v, "um", format!("{what} at station {}", i + 1));
        }
    };
    um("growth", "growth of the piston over the cylinder", &|i| c[i].growth);
    um("assembly_clearance", "clearance at assembly that leaves the wanted one", &|i| c[i].theoretical);
    um("deviation", "clearance at assembly less that one", &|i| c[i].deviation);
    if let Some(z) = s.reference_offset {
        um("reference", "deviation less the number typed", &|i| c[i].deviation - z.si());
    }
    um("proposed_ordinate", "ordinate that the published program proposes", &|i| proposed[i]);
    um("warm_clearance", "clearance of the warm piston without a profile", &|i| c[i].warm);
    um("warm_proposed", "clearance of the warm piston with the proposed profile", &|i| {
        c[i].warm - proposed[i]
    });
    um("warm_profiled", "clearance of the warm piston with its profile", &|i| c[i].warm - y[i]);
    profile(case, s, &st, &y, out)?;
    shape(&barrel, s.height.si(), &st, &c, oval, out);
    draw::skirt(barrel.bore, s.height.si(), oval, out);
    Ok(())
}

/// Rows of the profile, and the other curves beside it.
fn profile(
    case: &PinCase,
    s: &Skirt,
    st: &[Station; 5],
    y: &[f64; 5],
    out: &mut RunResult,
) -> Result<(), BuildError> {
    let x: Vec<f64> = st.iter().map(|s| s.height).collect();
    let curve = case.models.profile_curve.build(&x, y)?;
    let (height, step) = (s.height.si(), s.step.si());
    let rows = (height / step + 1e-9).floor() as usize;
    let at: Vec<f64> = (0..=rows).map(|k| step * k as f64).collect();
    let values: Vec<f64> = at.iter().map(|x| curve.value(*x)).collect();
    for (k, v) in values.iter().enumerate() {
        result(
            out,
            format!("curve_{k}"),
            1e6 * v,
            "um",
            format!("profile {} mm above the open end", 1e-3 * (1e6 * at[k]).round()),
        );
    }
    // Material cannot be added: what stands proud is cut at the nominal diameter.
    let used: Vec<f64> = values.iter().map(|v| v.min(0.0)).collect();
    if values.iter().any(|v| *v > 1e-9) {
        let max = values.iter().copied().fold(0.0, f64::max);
        out.solver.notes.push(Note::caution("profile_cut", format!(
            "The curve stands proud of the nominal diameter by up to {:.2} um; the finished profile is cut there.",
            1e6 * max
        )));
    }
    let mut columns = vec![column("ordinate", "m", values), column("finished", "m", used)];
    let mut drawn = vec![
        ("this curve".to_owned(), "ordinate".to_owned()),
        ("finished".to_owned(), "finished".to_owned()),
    ];
    let registry = gudgeon_core::Registry::collect();
    for name in ["lagrange", "monotone_cubic", "linear"] {
        if name == case.models.profile_curve.typetag_name() || registry.model("profile_curve", name).is_none()
        {
            continue;
        }
        let spec: Box<dyn gudgeon_core::kinds::ProfileCurveSpec> =
            gudgeon_core::spec::plain_model(name).map_err(|e| BuildError::new(e.to_string()))?;
        let other = spec.build(&x, y)?;
        columns.push(column(name, "m", at.iter().map(|x| other.value(*x)).collect()));
        drawn.push((name.replace('_', " "), name.to_owned()));
    }
    out.tables.insert("skirt".into(), Series { axis: column("height", "m", at), columns });
    let drawn: Vec<(&str, &str)> = drawn.iter().map(|(a, b)| (a.as_str(), b.as_str())).collect();
    lines(
        out,
        "skirt",
        "Profile of the skirt",
        "ordinate on the diameter over the height above the open end; negative: material removed",
        &drawn,
    );
    Ok(())
}

/// The skirt as a film sees it: how far it stands behind its most prominent place, on the radius, cold and warm, from the upper edge down.
fn shape(
    barrel: &Barrel,
    height: f64,
    st: &[Station; 5],
    c: &[Clearance; 5],
    oval: Option<f64>,
    out: &mut RunResult,
) {
    let Some(t) = out.tables.get("skirt") else { return };
    let Some(finished) = t.get("finished") else { return };
    // Growth straight between the stations and beyond them.
    let growth = |x: f64| {
        let k = st.iter().filter(|s| s.height <= x).count().clamp(1, 4);
        let part = (x - st[k - 1].height) / (st[k].height - st[k - 1].height);
        c[k - 1].growth + part * (c[k].growth - c[k - 1].growth)
    };
    let rows = || t.axis.values.iter().zip(&finished.values).rev();
    let heights: Vec<f64> = rows().map(|(x, _)| *x).rev().collect();
    let below: Vec<f64> = rows().map(|(x, _)| height - x).collect();
    let cold: Vec<f64> = rows().map(|(_, y)| -0.5 * y).collect();
    let gap: Vec<f64> = rows().map(|(x, y)| 0.5 * (barrel.assembly_clearance - growth(*x) - y)).collect();
    let assembled: Vec<f64> = rows().map(|(_, y)| 0.5 * (barrel.assembly_clearance - y)).collect();
    let min = |v: &[f64]| v.iter().copied().fold(f64::INFINITY, f64::min);
    let (proud, tightest) = (min(&cold), min(&gap));
    let columns = vec![
        column("cold_drop", "m", cold.iter().map(|v| v - proud).collect()),
        column("warm_drop", "m", gap.iter().map(|v| v - tightest).collect()),
    ];
    result(
        out,
        "warm_gap",
        1e6 * tightest,
        "um",
        "smallest radial gap of the warm skirt, negative for interference",
    );
    if let Some(o) = oval {
        result(
            out,
            "oval_drop",
            0.5e6 * o,
            "um",
            "radial drop of the oval skirt across the thrust direction",
        );
    }
    let upwards = |v: &[f64]| v.iter().rev().copied().collect::<Vec<f64>>();
    let clearances =
        vec![column("cold_gap", "m", upwards(&assembled)), column("warm_gap", "m", upwards(&gap))];
    out.tables.insert(
        "skirt_clearance".into(),
        Series { axis: column("height", "m", heights), columns: clearances },
    );
    lines(
        out,
        "skirt_clearance",
        "Clearance of the skirt, cold and warm",
        "radial gap between finished profile and bore in the thrust direction, the bore at 0, over the height above the open end: at assembly, and when piston and cylinder have their working temperatures",
        &[("at assembly", "cold_gap"), ("warm", "warm_gap")],
    );
    out.tables.insert("skirt_shape".into(), Series { axis: column("depth", "m", below), columns });
    lines(
        out,
        "skirt_shape",
        "Shape of the skirt for its film",
        "radial drop behind the most prominent place over the depth below the upper edge",
        &[("cold", "cold_drop"), ("warm", "warm_drop")],
    );
}

fn crown(case: &PinCase, c: &Crown, out: &mut RunResult) -> Result<(), BuildError> {
    let depth = recess(c)?;
    let radius = c.radius.si();
    let (rim, volume) = (cap_rim(depth, radius), cap_volume(depth, radius));
    result(out, "recess_depth", 1e3 * depth, "mm", "depth of the recess");
    result(out, "recess_rim", 1e3 * rim, "mm", "radius of its rim");
    result(out, "recess_volume", 1e6 * volume, "cm3", "its volume");
    result(
        out,
        "recess_volume_of_rim",
        1e6 * cap_volume_of_rim(depth, rim),
        "cm3",
        "its volume, from rim and depth",
    );
    let bore = case.engine.bore.si();
    if 2.0 * rim > bore {
        out.solver.notes.push(Note::caution("recess", "The recess is wider than the piston."));
    }
    let swept = std::f64::consts::PI * bore * bore / 4.0 * c.stroke.si();
    let clearance = swept / (c.compression_ratio.si() - 1.0);
    result(out, "swept_volume", 1e6 * swept, "cm3", "swept volume");
    result(out, "clearance_volume", 1e6 * clearance, "cm3", "clearance volume with the nominal recess");
    if let Some(nominal) = c.nominal_volume {
        let actual = clearance + volume - nominal.si();
        if actual > 0.0 {
            result(
                out,
                "actual_compression_ratio",
                1.0 + swept / actual,
                "",
                "compression ratio with this recess",
            );
        }
        let without = clearance - nominal.si();
        if without > 0.0 {
            result(
                out,
                "flat_compression_ratio",
                1.0 + swept / without,
                "",
                "compression ratio without any recess",
            );
        }
    }
    Ok(())
}
