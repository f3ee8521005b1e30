//! Benches of films along and across the motion: any text gives an error or numbers, and what is symmetric is solved once.

use gudgeon_core::file::Files;
use gudgeon_core::kinds::{RigCtx, RigOut, RigSpec};
use gudgeon_scene_rig as _;

/// From the text of a case to results, or why not.
fn run(text: &str) -> Result<RigOut, String> {
    let spec: Box<dyn RigSpec> = toml::from_str(text).map_err(|e| e.to_string())?;
    let errors = |e: Vec<gudgeon_core::BuildError>| {
        e.iter().map(|e| format!("{}: {e}", e.field)).collect::<Vec<_>>().join("\n")
    };
    let mut rig = spec.build(&RigCtx { files: &Files::default() }).map_err(errors)?;
    let mut out = RigOut::default();
    rig.run(&mut out).map_err(|e| e.to_string())?;
    Ok(out)
}

const SLIDER: &[(&str, &str)] = &[
    ("model", "\"slider_2d\""),
    ("length", "\"10 mm\""),
    ("width", "\"8 mm\""),
    ("profile", "{ shape = \"linear\", h_in = \"20 um\", h_out = \"10 um\" }"),
    ("dimples", "{ along = 2, across = 3, depth = \"4 um\", fraction = 0.5 }"),
    ("speed", "\"5 m/s\""),
    ("squeeze", "\"1 mm/s\""),
    ("viscosity", "\"10 mPa s\""),
    ("p_inlet", "\"1 bar\""),
    ("p_outlet", "\"1 bar\""),
    ("p_side", "\"1 bar\""),
    ("p_cav", "\"0.3 bar\""),
    ("inlet_fill", "1.0"),
    ("intervals_x", "12"),
    ("intervals_y", "10"),
    ("roughness", "{ model = \"sawtooth_waviness\", amplitude = \"2 um\" }"),
    ("film_2d", "{ model = \"multigrid\" }"),
];

const JOURNAL: &[(&str, &str)] = &[
    ("model", "\"journal_2d\""),
    ("radius", "\"25 mm\""),
    ("width", "\"30 mm\""),
    ("clearance", "\"25 um\""),
    ("eccentricity", "0.7"),
    ("speed", "\"3000 rpm\""),
    ("viscosity", "\"10 mPa s\""),
    ("p_supply", "\"2 bar\""),
    ("p_side", "\"1 bar\""),
    ("p_cav", "\"0.3 bar\""),
    ("intervals_x", "24"),
    ("intervals_y", "8"),
    ("film_2d", "{ model = \"multigrid\" }"),
];

const SKIRT: &[(&str, &str)] = &[
    ("model", "\"skirt\""),
    ("radius", "\"43 mm\""),
    ("length", "\"50 mm\""),
    ("half_angle", "\"50 deg\""),
    ("clearance", "\"30 um\""),
    ("barrel", "\"20 um\""),
    ("e_top", "\"18 um\""),
    ("e_bottom", "\"10 um\""),
    ("e_top_rate", "\"1 mm/s\""),
    ("e_bottom_rate", "\"-1 mm/s\""),
    ("speed", "\"8 m/s\""),
    ("viscosity", "\"10 mPa s\""),
    ("p_edge", "\"1 bar\""),
    ("p_cav", "\"0.3 bar\""),
    ("pin", "\"20 mm\""),
    ("intervals_x", "12"),
    ("intervals_y", "10"),
    ("crowding", "0.1"),
    ("film_2d", "{ model = \"multigrid\" }"),
];

fn text(keys: &[(&str, &str)], changed: &str, value: &str) -> String {
    let line = |(k, v): &(&str, &str)| format!("{k} = {}\n", if *k == changed { value } else { v });
    let mut all: String = keys.iter().map(line).collect();
    if !changed.is_empty() && keys.iter().all(|(k, _)| *k != changed) {
        all.push_str(&format!("{changed} = {value}\n"));
    }
    all
}

fn number(out: &RigOut, name: &str) -> f64 {
    out.results[name].value
}

#[test]
fn any_value_gives_an_error_or_numbers() {
    let values = [
        "0",
        "-1",
        "1",
        "1e-300",
        "1e300",
        "-1e300",
        "1e-9",
        "1e9",
        "nan",
        "inf",
        "\"nan m\"",
        "\"1e999 m\"",
        "\"\"",
        "\"x\"",
        "[]",
        "{}",
        "true",
        "2",
        "3",
        "5",
        "4294967296",
    ];
    for keys in [SLIDER, JOURNAL, SKIRT] {
        run(&text(keys, "", "")).unwrap();
        let (mut refused, mut ran) = (0, 0);
        for (key, _) in keys {
            for value in values {
                match run(&text(keys, key, value)) {
                    Err(e) => {
                        assert!(!e.is_empty(), "{key} = {value}");
                        refused += 1;
                    }
                    Ok(out) => {
                        let all = out.tables.values().chain([&out.series]);
                        let columns = all.flat_map(|t| t.columns.iter().chain([&t.axis]));
                        let finite = columns.flat_map(|c| &c.values).all(|v| v.is_finite())
                            && out.results.values().all(|v| v.value.is_finite());
                        assert!(finite, "{key} = {value}");
                        ran += 1;
                    }
                }
            }
        }
        // Neither everything is refused nor everything let through.
        assert!(refused > 50 && ran > 20, "{refused} {ran}");
    }
}

#[test]
fn contradictions_are_named() {
    let refused = |keys, key, value, word: &str| {
        let e = run(&text(keys, key, value)).unwrap_err();
        assert!(e.contains(word), "{key} = {value}: {e}");
    };
    refused(SLIDER, "inlet_fill", "0.5", "inlet_fill");
    refused(SLIDER, "intervals_x", "1", "intervals_x");
    refused(SLIDER, "intervals_y", "4000", "intervals_y");
    refused(SLIDER, "dimples", "{ along = 0, across = 1, depth = 0.0, fraction = 0.5 }", "dimples.along");
    refused(
        SLIDER,
        "dimples",
        "{ along = 1, across = 1, depth = 0.0, fraction = 0.5, rim = 0.004 }",
        "dimples.rim",
    );
    refused(SLIDER, "film_2d", "{ model = \"multigrid\", tolerance = 1.0 }", "film_2d.tolerance");
    refused(JOURNAL, "eccentricity", "1.0", "eccentricity");
    refused(JOURNAL, "supply", "\"sides\"", "p_supply");
    refused(SKIRT, "half_angle", "\"90 deg\"", "half_angle");
    refused(SKIRT, "crowding", "0.6", "crowding");
    refused(SKIRT, "e_top", "\"70 um\"", "touch");
    // Everything at once.
    let both = text(SKIRT, "crowding", "0.6").replace("50 deg", "95 deg");
    let e = run(&both).unwrap_err();
    assert!(e.contains("crowding") && e.contains("half_angle"), "{e}");
}

#[test]
fn smooth_surfaces_shear_as_the_model_says() {
    // Factors of very small waves are those of smooth surfaces.
    for keys in [SLIDER, SKIRT] {
        let off = run(&text(keys, "roughness", "{ model = \"off\" }")).unwrap();
        let small = "{ model = \"sawtooth_waviness\", amplitude = \"0.1 nm\" }";
        let wavy = run(&text(keys, "roughness", small)).unwrap();
        for (name, value) in &off.results {
            if name == "residual" {
                continue;
            }
            // (Ω/h)² is 1e-10; the solver stops at 1e-9.
            let apart = (value.value - number(&wavy, name)).abs();
            assert!(
                apart <= 2e-8 * value.value.abs() + 1e-12,
                "{name}: {} {}",
                value.value,
                number(&wavy, name)
            );
        }
    }
}

#[test]
fn sides_supply_a_bearing_that_does_not_rupture() {
    // Without cavitation the film knows no groove, where the pressure of the widest gap is that of the sides by symmetry.
    let keys = text(
        JOURNAL,
        "film_2d",
        "{ model = \"multigrid\", cavitation = \"full_sommerfeld\", tolerance = 1e-12 }",
    );
    let groove = run(&keys.replace("2 bar", "1 bar")).unwrap();
    let closed = run(&keys.replace("p_supply = \"2 bar\"", "supply = \"sides\"")).unwrap();
    for name in ["load", "friction", "p_max"] {
        let (a, b) = (number(&groove, name), number(&closed, name));
        // Residuals of 1e-12; the weights of the integral of the friction are of fourth order at ends, and there are no ends in a ring:
        // a part of (2 pi/24)^4.
        let tolerance = if name == "friction" { 1e-5 } else { 1e-9 };
        assert!((a / b - 1.0).abs() < tolerance, "{name}: {a} {b}");
    }
    assert!((number(&closed, "attitude") - 90.0).abs() < 1e-6);
}

#[test]
fn starved_pads_carry_less() {
    // The gap closes to one half: with 0.8 of what fills the inlet it is full from 0.4 of the length on, a bit later for what the sides lose.
    let keys = text(SLIDER, "p_cav", "\"1 bar\"").replace("squeeze = \"1 mm/s\"", "squeeze = 0.0");
    let full = run(&keys).unwrap();
    let starved = run(&keys.replace("inlet_fill = 1.0", "inlet_fill = 0.8")).unwrap();
    assert!(number(&starved, "load") < 0.9 * number(&full, "load"));
    assert!(number(&starved, "load") > 0.0 && number(&starved, "cavity") > number(&full, "cavity"));
}

/// A journal bearing whose supply, sides and cavity stand at one pressure.
fn bare_journal(around: usize, film: &str) -> String {
    let keys = text(JOURNAL, "film_2d", film);
    let keys = keys
        .replace("\"2 bar\"", "\"0 bar\"")
        .replace("\"1 bar\"", "\"0 bar\"")
        .replace("\"0.3 bar\"", "\"0 bar\"");
    let grid = format!("intervals_x = {around}\nintervals_y = {}", around / 3);
    keys.replace("intervals_x = 24", &grid).replace("intervals_y = 8\n", "")
}

#[test]
fn flow_over_the_sides_is_of_second_order() {
    for (film, least) in [
        ("{ model = \"direct\", cavitation = \"mass_conserving\", tolerance = 1e-12 }", 1.6),
        ("{ model = \"direct\", cavitation = \"swift_stieber\", tolerance = 1e-12 }", 1.6),
        ("{ model = \"direct\", cavitation = \"half_sommerfeld\", tolerance = 1e-12 }", 1.6),
    ] {
        let flow =
            [24, 48, 96, 192].map(|n| number(&run(&bare_journal(n, film)).unwrap(), "side_flow_number"));
        let change = [flow[1] - flow[0], flow[2] - flow[1], flow[3] - flow[2]];
        // Over two halvings; the end of the film moves by whole intervals, which makes single ratios uneven.
        let order = 0.5 * (change[0] / change[2]).abs().log2();
        assert!(order > least, "{film}: {flow:?} {order}");
    }
}

#[test]
fn a_bearing_conserves_its_oil() {
    let r = run(&bare_journal(48, "{ model = \"direct\", tolerance = 1e-13 }")).unwrap();
    // Steady, full at the groove on both ends of the line: what comes in there leaves over the sides, but for what leaves at the end of the line.
    let (inflow, side) = (number(&r, "inflow_number"), number(&r, "side_flow_number"));
    assert!(side > 0.0 && side < inflow, "{side} {inflow}");
}

#[test]
fn cavities_are_what_is_torn() {
    let share = |cavitation: &str| {
        let film = format!("{{ model = \"direct\", cavitation = \"{cavitation}\" }}");
        number(&run(&bare_journal(24, &film)).unwrap(), "cavity")
    };
    // A film that never ruptures has none, whatever stands at the cavitation pressure at its edges.
    assert_eq!(share("full_sommerfeld"), 0.0);
    // By symmetry one half of the film is cut off, the edges beside it with it.
    assert!((share("half_sommerfeld") - 50.0).abs() < 100.0 / 24.0);
}

#[test]
fn a_bearing_that_runs_empty_is_no_bearing() {
    let keys = bare_journal(24, "{ model = \"multigrid\" }")
        .replace("eccentricity = 0.7", "eccentricity = 0.3")
        .replace("p_supply = \"0 bar\"", "supply = \"sides\"");
    let e = run(&keys).unwrap_err();
    // The solver may find that nothing tells how much oil is left, or a film that carries nothing.
    assert!(e.contains("no steady film") || e.contains("runs empty"), "{e}");
    let fed = keys.replace("p_side = \"0 bar\"", "p_side = \"1 bar\"");
    assert!(number(&run(&fed).unwrap(), "load") > 100.0);
}

#[test]
fn a_cavity_above_all_edges_is_refused_at_its_place() {
    for keys in [SLIDER, JOURNAL] {
        let e = run(&text(keys, "p_cav", "\"3 bar\"")).unwrap_err();
        assert!(e.starts_with("p_cav: "), "{e}");
    }
}
