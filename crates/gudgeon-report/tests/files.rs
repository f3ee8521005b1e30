//! The result files: their shape, and that a page is made whatever a run has or lacks.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

mod common;

use std::fs;
use std::path::PathBuf;

use gudgeon_core::result::{
    ComparedCase, Comparison, Failure, Headline, Note, Refined, RunResult, Series, Variant, Verification,
};
use gudgeon_report::{
    OVER_CYCLE, ReportError, rewrite, summary_json, write_bench, write_comparison, write_run,
};
use serde_json::Value;

/// A fresh directory of this test's own.
fn scratch(name: &str) -> PathBuf {
    let dir = std::env::temp_dir().join(format!("gudgeon-report-{}-{name}", std::process::id()));
    let _ = fs::remove_dir_all(&dir);
    dir
}

fn read(path: impl AsRef<std::path::Path>) -> String {
    fs::read_to_string(path).unwrap()
}

/// The JSON that a page carries.
fn data(page: &str) -> Value {
    let start = page.find("id=\"data\">").unwrap() + "id=\"data\">".len();
    let end = start + page[start..].find("</script>").unwrap();
    serde_json::from_str(&page[start..end]).unwrap()
}

#[test]
fn summary_has_the_promised_shape() {
    let run = common::run(3);
    let summary: Value = serde_json::from_str(&summary_json(&run)).unwrap();
    let keys: Vec<&str> = summary.as_object().unwrap().keys().map(String::as_str).collect();
    assert_eq!(keys[..8], ["case", "gudgeon", "models", "skipped", "results", "balance", "solver", "notes"]);
    for additive in ["title", "source", "assumptions", "events", "branches", "section", "provenance"] {
        assert!(keys.contains(&additive), "{additive}");
    }
    assert_eq!(summary["results"]["blow_by"], serde_json::json!({ "value": 8.312, "unit": "l/min" }));
    assert_eq!(
        summary["models"][1],
        serde_json::json!({ "kind": "gas_flow", "model": "orifice_network", "references": ["furuhama1961"] })
    );
    assert_eq!(summary["skipped"][0]["what"], "asperity contact");
    assert!(summary["skipped"][0]["why"].is_string());
    let balance: Vec<&String> = summary["balance"].as_object().unwrap().keys().collect();
    assert_eq!(balance, ["gas_mass", "oil_mass", "flank_oil", "energy", "momentum"]);
    assert!(summary["balance"]["oil_mass"].is_null());
    assert_eq!(summary["solver"]["counters"]["steps"], 5210);
    assert!(!keys.contains(&"seconds"), "wall times would make two equal runs differ");
    assert_eq!(summary["section"]["rings"].as_array().unwrap().len(), 3);
}

#[test]
fn drawings_and_bars_travel_with_the_page() {
    use gudgeon_core::result::{Anchor, Bar, Figure, FigureKind, Frame, Shape, Style};
    let path = |x: f64, style| Shape::Path {
        points: vec![[x, 0.0], [x + 20.0, 0.0], [x + 20.0, 30.0], [x, 30.0]],
        closed: true,
        style,
    };
    let dimension =
        |from, to, offset: f64, text: &str| Shape::Dimension { from, to, offset, text: text.into() };
    let drawing = FigureKind::Drawing {
        apart: false,
        fixed: vec![
            path(0.0, Style::Cut),
            dimension([0.0, 30.0], [20.0, 30.0], 8.0, "20 mm"),
            dimension([0.0, 0.0], [0.0, 30.0], 8.0, "30 mm"),
            Shape::Text { at: [10.0, 15.0], text: "boss".into(), anchor: Anchor::Middle },
        ],
        frames: [25.0, 30.0, 35.0]
            .map(|x| Frame {
                at: None,
                label: format!("{x} mm"),
                shapes: vec![
                    path(x, Style::Metal),
                    Shape::Circle { centre: [x + 10.0, 15.0], radius: 5.0, style: Style::Hollow },
                ],
            })
            .to_vec(),
    };
    let bar = |label: &str, value, limit| Bar { label: label.into(), value, limit };
    let bars = FigureKind::Bars {
        unit: String::new(),
        bars: vec![
            bar("bending", 0.8, Some(1.0)),
            bar("shear", 1.2, Some(1.0)),
            bar("slenderness", 0.3, None),
        ],
    };
    let figure =
        |title: &str, kind| Figure { title: title.into(), hint: String::new(), table: String::new(), kind };
    let run = RunResult {
        case: "drawn".into(),
        figures: vec![figure("section", drawing), figure("utilisation", bars)],
        ..RunResult::default()
    };
    let dir = scratch("drawn");
    let files = write_run(&run, &dir).unwrap();
    let page = data(&read(&files.report));
    assert_eq!(page["figures"][0]["kind"]["drawing"]["frames"].as_array().unwrap().len(), 3);
    assert_eq!(page["figures"][1]["kind"]["bars"]["bars"][1]["value"], 1.2);
    // The page is made again from its files.
    let first = read(&files.report);
    rewrite(&dir).unwrap();
    assert_eq!(first, read(&files.report));
    if std::env::var_os("GUDGEON_KEEP_REPORT").is_none() {
        fs::remove_dir_all(dir).unwrap();
    }
}

#[test]
fn a_waterfall_travels_with_every_line_of_its_spectra() {
    use gudgeon_core::result::{Column, Figure, FigureKind, Series, Waterfall};

    let column =
        |name: &str, unit: &str, values: Vec<f64>| Column { name: name.into(), unit: unit.into(), values };
    // More rows than curves over the cycle keep.
    let (orders, speeds) = (60, 40);
    let of = |f: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
        (0..speeds).flat_map(|j| (0..orders).map(move |k| (j, k))).map(|(j, k)| f(j, k)).collect()
    };
    let table = Series {
        axis: column("order", "", of(&|_, k| k as f64)),
        columns: vec![
            column("speed", "rpm", of(&|j, _| 600.0 + j as f64)),
            column("shaft1.torque", "N m", of(&|j, k| (j * k) as f64)),
        ],
    };
    let kind = FigureKind::Waterfall(Waterfall {
        x: vec!["order".into()],
        y: "speed".into(),
        spectra: vec![("crank".into(), "shaft1.torque".into())],
    });
    let (title, hint) = ("spectra".to_owned(), String::new());
    let mut run = RunResult { case: "waterfall".into(), ..RunResult::default() };
    run.figures = vec![Figure { title, hint, table: "order_spectra".into(), kind }];
    run.tables.insert("order_spectra".into(), table);
    let dir = scratch("waterfall");
    let page = data(&read(write_run(&run, &dir).unwrap().report));
    assert_eq!(page["figures"][0]["kind"]["waterfall"]["spectra"][0][1], "shaft1.torque");
    let at = page["tables"]["order_spectra"]["columns"][1]["at"].as_u64().unwrap();
    // Four bytes a line, in base64.
    let text = page["arrays"][at as usize].as_str().unwrap();
    assert_eq!(text.trim_end_matches('=').len() * 3 / 4, 4 * orders * speeds);
    fs::remove_dir_all(dir).unwrap();
}

#[test]
fn a_page_leads_with_verdict_headlines_and_contents() {
    let dir = scratch("leads");
    let mut run = common::run(3);
    run.solver.notes = vec![Note::caution("floor", "a floor acted"), Note::info("said", "said in passing")];
    run.headlines = vec![
        Headline::one("Blow-by", "blow_by").over(&["blow_by.rate", "no.such"]),
        Headline::one("No such result", "nowhere"),
    ];
    let page = read(write_run(&run, &dir).unwrap().report);
    let first = &page[page.find("<section id=\"overview\"").unwrap()..page.find("<div id=\"bar\"").unwrap()];
    assert!(
        first.contains("verdict amber")
            && first.contains("Valid with 1 reservation")
            && first.contains("A floor acted")
    );
    assert!(!first.contains("said in passing"), "what is good to know stands with the notes");
    assert!(first.contains("<h3>Blow-by</h3>") && first.contains(">8.31 <span"));
    assert!(!first.contains("No such result"));
    assert!(first.find("<h1>").unwrap() < first.find("verdict").unwrap());
    // The contents name the sections that are there and no other.
    let nav = &page[page.find("<nav").unwrap()..page.find("</nav>").unwrap()];
    for id in nav.split("href=\"#").skip(1).map(|l| &l[..l.find('"').unwrap()]) {
        assert!(page.contains(&format!("<section id=\"{id}\"")), "{id}");
    }
    run.solver.notes = vec![Note::exceeded("verdict.x", "beyond the limit: x")];
    let page = read(write_run(&run, &dir).unwrap().report);
    assert!(page.contains("verdict red") && page.contains("A limit is not kept"));
    fs::remove_dir_all(dir).unwrap();
}

#[test]
fn no_number_in_json_is_other_than_finite() {
    let mut run = common::run(1);
    run.results.insert("lost".into(), common::value(f64::NAN, "N", ""));
    run.results.insert("endless".into(), common::value(f64::INFINITY, "N", ""));
    run.balance.energy = Some(f64::NAN);
    let text = summary_json(&run);
    let summary: Value = serde_json::from_str(&text).unwrap();
    assert!(summary["results"]["lost"]["value"].is_null());
    assert!(summary["results"]["endless"]["value"].is_null());
    assert!(summary["balance"]["energy"].is_null());
    assert!(!text.contains("NaN") && !text.contains("inf"));
}

#[test]
fn series_has_one_named_column_each_and_reads_back_exactly() {
    let dir = scratch("series");
    let run = common::run(2);
    let files = write_run(&run, &dir).unwrap();
    let text = read(&files.series);
    let mut lines = text.lines();
    let header = lines.next().unwrap();
    assert!(header.starts_with("theta[deg],piston.y[m],"));
    assert!(header.contains(",ring1.h_min[m],") && header.contains(",land2.p[Pa],"));
    assert_eq!(text.lines().count(), 1 + 721);
    let names: Vec<&str> = header.split(',').collect();
    let at = names.iter().position(|n| *n == "ring1.h_min[m]").unwrap();
    let column = run.series.get("ring1.h_min").unwrap();
    for (line, v) in lines.zip(&column.values) {
        let cell: f64 = line.split(',').nth(at).unwrap().parse().unwrap();
        assert_eq!(cell.to_bits(), v.to_bits());
    }
    fs::remove_dir_all(dir).unwrap();
}

#[test]
fn a_ragged_series_is_refused_and_nothing_is_written() {
    let dir = scratch("ragged");
    let mut run = common::run(1);
    run.series.columns[3].values.pop();
    let e = write_run(&run, &dir).unwrap_err();
    assert!(matches!(e, ReportError::Ragged { rows: 720, expected: 721, .. }), "{e}");
    assert!(!dir.exists());
}

/// Results of another periodic state are told beside the first: of values in per cent, of crank angles in degrees, the shorter way around.
#[test]
fn periodic_states_are_told_beside_the_first() {
    let dir = scratch("states");
    let page = read(write_run(&common::run(1), &dir).unwrap().report);
    let (_, section) = page.split_once("<section id=\"branches\">").unwrap();
    for told in ["all lands at 1 bar", "+18.7 %", "−56.1 %", "+8°"] {
        assert!(section.contains(told), "{told}");
    }
}

#[test]
fn text_of_a_case_cannot_become_markup_or_script() {
    let dir = scratch("escape");
    let nasty = "</script><script>alert(\"1\")</script> <b>'quoted'</b> & \u{2028} `<i>`";
    let mut run = common::run(1);
    run.title = nasty.into();
    run.case = nasty.into();
    run.source = nasty.into();
    run.assumptions = vec![nasty.into()];
    run.solver.notes = vec![Note::caution("x", nasty)];
    run.events[0].what = nasty.into();
    run.skipped[0].why = nasty.into();
    run.models[0].model = nasty.into();
    run.series.columns[0].name = nasty.into();
    run.results.insert(nasty.into(), common::value(1.0, nasty, nasty));
    run.branches[0].start = nasty.into();
    let page = read(write_run(&run, &dir).unwrap().report);
    assert!(!page.contains("<script>alert"));
    assert!(!page.contains("<b>'quoted'"));
    assert!(!page.contains("<i>"));
    // The data and the code: two elements, each closed once.
    assert_eq!(page.matches("<script").count(), 2);
    assert_eq!(page.matches("</script>").count(), 2);
    assert_eq!(data(&page)["events"][0]["what"], nasty);
    assert!(page.contains("&lt;/script&gt;&lt;script&gt;alert(&quot;1&quot;)"));

    let mut c = common::comparison();
    c.title = nasty.into();
    c.variants[1].label = nasty.into();
    c.variants[3].outcome = Err(Failure { message: nasty.into(), ..Failure::default() });
    let page = read(write_comparison(&c, &dir).unwrap().report);
    assert!(!page.contains("<script>alert") && page.matches("</script>").count() == 2);
    let mut b = common::bench();
    b.findings = vec![nasty.into()];
    b.points[0].setting = nasty.into();
    let page = read(write_bench(&b, &dir).unwrap().report);
    assert!(!page.contains("<script>alert") && page.matches("</script>").count() == 2);
    fs::remove_dir_all(dir).unwrap();
}

#[test]
fn a_page_loads_nothing() {
    let dir = scratch("offline");
    let pages = [
        read(write_run(&common::run(3), &dir).unwrap().report),
        read(write_comparison(&common::comparison(), &dir).unwrap().report),
        read(write_bench(&common::bench(), &dir).unwrap().report),
    ];
    for page in pages {
        assert!(page.contains("default-src 'none'"));
        for outside in ["src=\"", "url(http", "@import", "https://"] {
            assert!(!page.contains(outside), "{outside}");
        }
        // Links lead to places of the page.
        assert_eq!(page.matches("href=\"").count(), page.matches("href=\"#").count());
        // The name of the SVG language is the only address in a page, and it is never fetched.
        assert_eq!(page.matches("http://").count(), page.matches("http://www.w3.org/2000/svg").count());
    }
    fs::remove_dir_all(dir).unwrap();
}

#[test]
fn any_number_of_rings_and_any_missing_part_makes_a_page() {
    let dir = scratch("parts");
    for n in [1, 2, 3, 5] {
        let page = read(write_run(&common::run(n), &dir).unwrap().report);
        assert_eq!(data(&page)["section"]["rings"].as_array().unwrap().len(), n);
        assert!(page.contains(&format!("<th class=\"num\">ring {n}</th>")));
        assert!(page.len() < 700_000, "{n} rings: {} bytes", page.len());
    }
    // Nothing at all.
    let page = read(write_run(&RunResult::default(), &dir).unwrap().report);
    assert!(page.contains("This run has no curves."));
    assert_eq!(read(dir.join("series.csv")), "theta[deg]\n");
    // Angles without columns, columns without rows, a single row.
    let mut run = common::run(2);
    run.series.columns.clear();
    assert!(read(write_run(&run, &dir).unwrap().report).contains("This run has no curves."));
    run.series = Series::over_cycle(vec![], common::run(2).series.columns);
    run.series.columns.iter_mut().for_each(|c| c.values.clear());
    assert!(read(write_run(&run, &dir).unwrap().report).contains("This run has no curves."));
    // No section, no film, no motion.
    let mut run = common::run(3);
    run.section = None;
    run.series.columns.retain(|c| c.name.ends_with(".p"));
    let page = read(write_run(&run, &dir).unwrap().report);
    assert!(data(&page)["section"].is_null());
    fs::remove_dir_all(dir).unwrap();
}

#[test]
fn same_input_same_bytes_and_no_temporary_file_is_left() {
    let (a, b) = (scratch("same-a"), scratch("same-b"));
    for dir in [&a, &b] {
        write_run(&common::run(3), dir).unwrap();
        write_comparison(&common::comparison(), &dir.join("c")).unwrap();
        write_bench(&common::bench(), &dir.join("b")).unwrap();
    }
    for (sub, names) in [
        (".", vec![".gudgeon.json", "report.html", "series.csv", "summary.json", "timing.json"]),
        (
            "c",
            vec![
                ".gudgeon.json",
                "comparison.csv",
                "comparison.json",
                "report.html",
                "series.csv",
                "timing.json",
            ],
        ),
        ("b", vec![".gudgeon.json", "bench.csv", "bench.json", "report.html"]),
    ] {
        let mut found: Vec<String> = fs::read_dir(a.join(sub))
            .unwrap()
            .map(|e| e.unwrap())
            .filter(|e| e.file_type().unwrap().is_file())
            .map(|e| e.file_name().into_string().unwrap())
            .collect();
        found.sort();
        assert_eq!(found, names);
        for name in names {
            assert!(
                fs::read(a.join(sub).join(name)).unwrap() == fs::read(b.join(sub).join(name)).unwrap(),
                "{name}"
            );
        }
    }
    fs::remove_dir_all(a).unwrap();
    fs::remove_dir_all(b).unwrap();
}

#[test]
fn a_page_is_rebuilt_byte_for_byte_from_its_files() {
    let dir = scratch("rewrite");
    write_run(&common::run(3), &dir).unwrap();
    write_comparison(&common::comparison(), &dir.join("c")).unwrap();
    write_bench(&common::bench(), &dir.join("b")).unwrap();
    for sub in [dir.clone(), dir.join("c"), dir.join("b")] {
        let before = read(sub.join("report.html"));
        fs::remove_file(sub.join("report.html")).unwrap();
        assert_eq!(rewrite(&sub).unwrap(), sub.join("report.html"));
        assert!(before == read(sub.join("report.html")), "{}", sub.display());
    }
    fs::create_dir_all(dir.join("empty")).unwrap();
    assert!(matches!(rewrite(&dir.join("empty")).unwrap_err(), ReportError::NothingHere { .. }));
    fs::write(dir.join("summary.json"), "{\"case\": 1}").unwrap();
    assert!(matches!(rewrite(&dir).unwrap_err(), ReportError::Malformed { .. }));
    fs::remove_dir_all(dir).unwrap();
}

#[test]
fn a_comparison_states_differences_and_refusals() {
    let dir = scratch("comparison");
    let files = write_comparison(&common::comparison(), &dir).unwrap();
    let json: Value = serde_json::from_str(&read(&files.comparison)).unwrap();
    let blow_by = &json["results"]["blow_by"];
    assert!(blow_by["difference_percent"][0].is_null() && json["variants"][0]["base"].is_null());
    // 0.82 of the base by construction; what is left is rounding of the quotient.
    assert!((blow_by["difference_percent"][2].as_f64().unwrap() + 18.0).abs() < 1e-12);
    assert!(blow_by["values"][3].is_null());
    assert!(json["variants"][3]["run"].is_null());
    assert!(json["variants"][3]["error"].as_str().unwrap().starts_with("refused"));
    assert_eq!(json["variants"][2]["run"]["results"]["fmep"]["unit"], "bar");
    let table = read(&files.table);
    assert!(table.starts_with("result,unit,\"gas_flow=orifice_network, contact=off\","));
    // Two variants ran beside the base: five columns each.
    assert!(table.contains(&format!("\nsolver.steps,-,5210,5210,5210,{}\n", ",".repeat(10))));
    let series = read(&files.series);
    assert!(series.starts_with("variant,theta[deg],"));
    assert_eq!(series.lines().count(), 1 + 3 * 721);
    let page = read(&files.report);
    assert!(page.contains("−18.0 %") && page.contains("Did not run"));
    // Three variants share one cylinder pressure: it is stored once.
    let d = data(&page);
    let at = |k: usize| {
        let columns = d["variants"][k]["series"]["columns"].as_array().unwrap().clone();
        columns.iter().find(|c| c["name"] == "cylinder.p").unwrap()["at"].clone()
    };
    assert!(at(0) == at(1) && at(1) == at(2));
    fs::remove_dir_all(dir).unwrap();
}

/// Three runs of three results with known uncertainties, or none.
fn verified(first: Option<f64>, of: [[(f64, Option<f64>); 3]; 2]) -> Comparison {
    let base = [(8.0, first), (719.0, first), (0.0, first)];
    let names = [("blow_by", "l/min"), ("p_max_angle", "deg"), ("limits_broken", "1")];
    let variant = |(k, values): (usize, [(f64, Option<f64>); 3])| {
        let mut r = RunResult { case: "x".into(), gudgeon: "0".into(), ..RunResult::default() };
        let mut found = Verification::default();
        for ((name, unit), (value, uncertainty)) in names.iter().zip(values) {
            r.results.insert((*name).into(), common::value(value, unit, "what"));
            r.headlines.push(Headline::one(name, name));
            found.uncertainty.extend(uncertainty.map(|u| ((*name).to_owned(), u)));
        }
        if first.is_some() {
            found.refined.push(Refined { what: "tolerance".into(), levels: Vec::new() });
            r.verification = Some(found);
        }
        let (label, swaps) = (format!("a={k}"), vec![("a".to_owned(), k.to_string())]);
        Variant { label, case: 0, swaps, outcome: Ok(r) }
    };
    let variants: Vec<Variant> = [base, of[0], of[1]].into_iter().enumerate().map(variant).collect();
    let cases = vec![ComparedCase { name: "x".into(), title: "X".into() }];
    Comparison { case: "x".into(), cases, variants, ..Comparison::default() }
}

#[test]
fn differences_are_told_with_their_confidence() {
    let dir = scratch("confidence");
    let u = Some(0.25);
    let c = verified(u, [[(8.5, u), (1.0, u), (0.0, u)], [(10.0, u), (719.5, u), (2.0, None)]]);
    let files = write_comparison(&c, &dir).unwrap();
    let json: Value = serde_json::from_str(&read(&files.comparison)).unwrap();
    let (q, angle, count) =
        (&json["results"]["blow_by"], &json["results"]["p_max_angle"], &json["results"]["limits_broken"]);
    // 8.5 less 8 is as large as both uncertainties together, 10 less 8 is larger.
    assert_eq!(q["difference"], serde_json::json!([null, 0.5, 2.0]));
    assert_eq!(q["difference_uncertainty"], serde_json::json!([null, 0.5, 0.5]));
    assert_eq!(q["confidence"], serde_json::json!([null, "not_resolved", "resolved"]));
    assert_eq!(q["difference_percent"], serde_json::json!([null, 6.25, 25.0]));
    // Around the cycle, and never in per cent.
    assert_eq!(angle["difference"], serde_json::json!([null, 2.0, 0.5]));
    assert_eq!(angle["difference_percent"], serde_json::json!([null, null, null]));
    assert_eq!(angle["confidence"], serde_json::json!([null, "resolved", "not_resolved"]));
    assert_eq!(count["confidence"], serde_json::json!([null, "equal", "unknown"]));
    let table = read(&files.table);
    assert!(
        table
            .lines()
            .next()
            .unwrap()
            .contains("a=1: difference,a=1: difference uncertainty,a=1: difference [%]")
    );
    let line = table.lines().find(|l| l.starts_with("p_max_angle")).unwrap();
    assert_eq!(line, "p_max_angle,deg,719,1,719.5,2,0.5,,,resolved,0.5,0.5,,,not_resolved");
    let page = read(&files.report);
    for part in [
        "Of 6 differences of headline results 2 are resolved, 2 are not resolved, 1 is of unknown uncertainty, 1 is equal.",
        "<b>+2.0 l/min ± 0.5</b>",
        "<b>+2.0° ± 0.5</b><br>✓ resolved</td>",
        "≈ not resolved",
        "<code>--verify</code>",
        "independent",
    ] {
        assert!(page.contains(part), "{part}");
    }
    fs::remove_file(&files.report).unwrap();
    rewrite(&dir).unwrap();
    // Runs without rows are no variants of a file of series, so the data differ.
    let text = |page: &str| page.split("id=\"data\">").next().map(str::to_owned);
    assert!(text(&read(&files.report)) == text(&page));
    fs::remove_dir_all(dir).unwrap();
}

#[test]
fn without_refinement_no_difference_is_called_resolved() {
    let dir = scratch("unverified");
    let c =
        verified(None, [[(8.5, None), (1.0, None), (0.0, None)], [(10.0, None), (719.5, None), (2.0, None)]]);
    let page = read(write_comparison(&c, &dir).unwrap().report);
    assert!(page.contains("Of 6 differences of headline results 5 are of unknown uncertainty, 1 is equal."));
    assert!(page.contains("<b>+2°</b>") && page.contains("+25.0 %"));
    assert!(!page.contains("✓ <b>resolved") && !page.contains("independent"));
    fs::remove_dir_all(dir).unwrap();
}

#[test]
fn the_first_variant_that_ran_is_the_base() {
    let dir = scratch("base");
    let mut c =
        verified(None, [[(8.0, None), (1.0, None), (1.0, None)], [(10.0, None), (3.5, None), (2.0, None)]]);
    let message = "the end gap closes".to_owned();
    c.variants[0].outcome = Err(Failure { code: "impossible".into(), message, path: String::new() });
    let files = write_comparison(&c, &dir).unwrap();
    let json: Value = serde_json::from_str(&read(&files.comparison)).unwrap();
    assert_eq!(json["variants"][2]["base"], 2);
    assert_eq!(json["results"]["blow_by"]["difference_percent"], serde_json::json!([null, null, 25.0]));
    let page = read(&files.report);
    assert!(
        page.contains("the first that ran: ")
            && page.contains("has no result (<a href=\"#refused\">left out</a>)")
    );
    fs::remove_dir_all(dir).unwrap();
}

#[test]
fn several_cases_have_their_own_bases_and_a_table_of_shares() {
    let dir = scratch("cases");
    let files = write_comparison(&common::cases(), &dir).unwrap();
    let json: Value = serde_json::from_str(&read(&files.comparison)).unwrap();
    assert_eq!(json["cases"][1]["name"], "diesel_120, engine.speed=1500 rpm");
    let difference = &json["results"]["blow_by"]["difference_percent"];
    // The second case is twice the first; its differences are to its own base, within rounding of the quotient.
    assert!(difference[4].is_null());
    assert_eq!(json["variants"][6]["base"], 5);
    assert!((difference[6].as_f64().unwrap() + 18.0).abs() < 1e-12);
    assert_eq!(
        json["shares"][0]["effects"],
        serde_json::json!([[1], [2], [0, 1], [0, 2], [1, 2], [0, 1, 2]])
    );
    let page = read(&files.report);
    for part in [
        "Which choice matters",
        "<code>gas_flow</code> explains 92 %",
        "with the case",
        "and fmep",
        "Without contact=off in blow_by",
        "<summary>diesel_120, engine.speed=1500 rpm</summary>",
    ] {
        assert!(page.contains(part), "{part}");
    }
    // What was read back makes the same page.
    fs::remove_file(&files.report).unwrap();
    rewrite(&dir).unwrap();
    assert_eq!(read(&files.report), page);
    fs::remove_dir_all(dir).unwrap();
}

#[test]
fn of_many_variants_those_near_the_base_are_drawn() {
    let dir = scratch("many");
    let mut c = common::comparison();
    let base = c.variants[0].clone();
    c.variants = (0..20)
        .map(|k| {
            let mut v = base.clone();
            v.swaps = vec![("a".into(), (k / 5).to_string()), ("b".into(), (k % 5).to_string())];
            v
        })
        .collect();
    let page = read(write_comparison(&c, &dir).unwrap().report);
    // The base, three of the first choice, four of the second.
    assert_eq!(data(&page)["variants"].as_array().unwrap().len(), 8);
    assert!(page.contains("series.csv holds all 20"));
    fs::remove_dir_all(dir).unwrap();
}

#[test]
fn a_benchmark_keeps_its_failures_apart() {
    let dir = scratch("bench");
    let files = write_bench(&common::bench(), &dir).unwrap();
    let json: Value = serde_json::from_str(&read(&files.bench)).unwrap();
    let points = json["points"].as_array().unwrap();
    let failed: Vec<&Value> = points.iter().filter(|p| !p["failure"].is_null()).collect();
    assert_eq!(failed.len(), 1);
    assert!(failed[0]["seconds_per_cycle"].is_null());
    let table = read(&files.table);
    assert!(table.starts_with(
        "method,setting,default,seconds_per_cycle[s],seconds_total[s],cycles[-],error.blow_by[-],"
    ));
    assert_eq!(table.lines().count(), 1 + points.len());
    assert!(read(&files.report).contains("became negative"));
    fs::remove_dir_all(dir).unwrap();
}

/// The page of a run and Python draw from the same list; one that is no JSON would leave both without curves.
#[test]
fn curves_over_the_cycle_are_listed_once() {
    let list: Vec<Value> = serde_json::from_str(OVER_CYCLE).unwrap();
    let mut names: Vec<&str> = list.iter().map(|g| g["name"].as_str().unwrap()).collect();
    for g in &list {
        assert!(g["title"].is_string() && g["hint"].is_string(), "{g}");
        for column in g["columns"].as_array().unwrap() {
            assert!(column[0].is_string() && column[1].is_string(), "{g}");
            let colour = &column[2];
            // Where a colour counts from the number, there must be one.
            let counts = colour.as_i64().is_some_and(|c| c < 0);
            assert!(colour == "text" || colour.is_i64(), "{g}");
            assert!(!counts || column[0].as_str().unwrap().contains('#'), "{g}");
            assert!(column.get(3).is_none_or(|d| d == "dashed" || d == "dotted"), "{g}");
        }
    }
    let count = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), count);
    let dir = scratch("curves");
    let page = read(write_run(&common::run(3), &dir).unwrap().report);
    assert!(page.contains(OVER_CYCLE.trim_end()));
    fs::remove_dir_all(&dir).unwrap();
}
