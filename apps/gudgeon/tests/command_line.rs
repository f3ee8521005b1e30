//! The commands as a person or a script meets them: what goes to which stream, exit codes, files.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use serde_json::Value;

fn command(args: &[&str]) -> Command {
    let mut c = Command::new(env!("CARGO_BIN_EXE_gudgeon"));
    c.args(args).env("NO_COLOR", "1");
    c
}
fn gudgeon(args: &[&str]) -> Output {
    command(args).output().expect("the program starts")
}
fn stdout(o: &Output) -> String {
    String::from_utf8(o.stdout.clone()).expect("text")
}
fn stderr(o: &Output) -> String {
    String::from_utf8(o.stderr.clone()).expect("text")
}
fn json(args: &[&str]) -> Value {
    let o = gudgeon(args);
    assert_eq!(o.status.code(), Some(0), "{args:?}: {}", stderr(&o));
    serde_json::from_slice(&o.stdout).expect("nothing but JSON on standard output")
}
fn base() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/broken/base.toml")
}

/// `(kind, model)` of everything registered.
fn all_models() -> Vec<(String, String)> {
    let list = json(&["models", "--json"]);
    let text = |v: &Value| v.as_str().expect("text").to_owned();
    list.as_array()
        .expect("kinds")
        .iter()
        .flat_map(|k| {
            let models = k["models"].as_array().expect("models");
            models.iter().map(|m| (text(&k["kind"]), text(&m["model"]))).collect::<Vec<_>>()
        })
        .collect()
}

#[test]
fn every_kind_has_models_and_every_model_a_page() {
    let all = all_models();
    let text = stdout(&gudgeon(&["models"]));
    let mut kinds = std::collections::BTreeSet::new();
    for (kind, model) in &all {
        assert!(text.contains(&format!("{kind}: ")) && text.contains(model), "{kind}/{model}");
        let o = gudgeon(&["describe", &format!("{kind}/{model}")]);
        assert_eq!(o.status.code(), Some(0));
        let page = stdout(&o);
        for part in [
            "Equations",
            "Validity",
            "Parameters",
            "Example",
            "References",
            "Source",
            &format!(" = \"{model}\"\n"),
        ] {
            assert!(page.contains(part), "{kind}/{model}: no {part}");
        }
        assert!(page.lines().all(|l| l.chars().count() <= 160), "{kind}/{model}: a line is too long");
        // The same in JSON: of one model a kind, for each is a run of the program.
        if kinds.insert(kind) {
            let d = json(&["describe", &format!("{kind}/{model}"), "--json"]);
            assert_eq!(
                (d["kind"].as_str(), d["model"].as_str()),
                (Some(kind.as_str()), Some(model.as_str()))
            );
        }
    }
    for kind in ["gas_flow", "hydrodynamics", "contact", "ring_motion", "cylinder_pressure", "oil"] {
        assert!(all.iter().any(|(k, _)| k == kind), "{kind} has no model: is its crate linked?");
    }
    // The kind alone lists its models; a name that only one kind has needs no kind.
    assert!(stdout(&gudgeon(&["describe", "gas_flow"])).contains("orifice_network"));
    assert!(stdout(&gudgeon(&["describe", "orifice_network"])).starts_with("gas_flow/orifice_network\n"));
}

#[test]
fn wrong_names_get_the_right_ones() {
    for (args, help) in [
        (&["models", "gasflow"][..], "did you mean `gas_flow`?"),
        (&["describe", "gas_flow/banana"], "`orifice_network`"),
        (&["describe", "gas_flow/orifice_netwrok"], "did you mean `orifice_network`?"),
        (&["describe", "gas/orifice_network"], "did you mean `gas_flow`?"),
        (&["describe", "narow_channel"], "did you mean `narrow_channel`?"),
        (&["describe", "off"], "`contact/off`"),
    ] {
        let o = gudgeon(args);
        assert_eq!(o.status.code(), Some(2), "{args:?}");
        assert!(o.stdout.is_empty() && stderr(&o).contains(help), "{args:?}: {}", stderr(&o));
    }
    for args in [&[][..], &["rnu"], &["run"], &["run", "x", "--sett", "a=b"], &["compare", "x"]] {
        assert_eq!(gudgeon(args).status.code(), Some(2), "{args:?}");
    }
    let case = base();
    let case = case.to_str().expect("text");
    for swap in ["gas_flow", "gas_flow=", "=a", "gas_flow=a,,b"] {
        let o = gudgeon(&["compare", case, "--swap", swap]);
        assert_eq!(o.status.code(), Some(2), "{swap}");
        assert!(stderr(&o).contains("--swap PATH=A,B,C"), "{swap}: {}", stderr(&o));
    }
    let o = gudgeon(&["report", env!("CARGO_MANIFEST_DIR")]);
    assert_eq!(o.status.code(), Some(2), "{}", stderr(&o));
}

#[test]
fn the_schema_knows_every_model() {
    let text = json(&["schema"]).to_string();
    for (kind, model) in all_models() {
        assert!(text.contains(&format!("{{\"const\":\"{model}\"}}")), "{kind}/{model}");
    }
}

#[test]
fn explain_names_every_value() {
    let case = base();
    let case = case.to_str().expect("text");
    let text = stdout(&gudgeon(&["explain", case, "--set", "models.gas_flow.model=narrow_channel"]));
    for part in ["engine.bore = \"0.1 m\"", "narrow_channel", "Skipped", "greenwood_tripp"] {
        assert!(text.contains(part), "{part} missing in {text}");
    }
    let v = json(&["explain", case, "--json"]);
    assert_eq!(v["resolved"]["engine"]["cylinders"], 4);
}

#[test]
fn dropped_keys_are_told() {
    let case = base();
    let case = case.to_str().expect("text");
    let o = gudgeon(&["check", case, "--set", "models.contact.model=off"]);
    assert_eq!(o.status.code(), Some(0), "{}", stderr(&o));
    assert!(stderr(&o).contains("note: models.contact: `off` does not have `roughness`"), "{}", stderr(&o));
}

#[test]
fn a_reader_that_leaves_early_is_no_error() {
    let mut child = command(&["schema"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    // One byte, then the pipe closes while most of the schema is still to be written.
    let mut pipe = child.stdout.take().expect("piped");
    pipe.read_exact(&mut [0]).expect("readable");
    drop(pipe);
    let o = child.wait_with_output().expect("ends");
    assert_eq!((o.status.code(), stderr(&o)), (Some(0), String::new()));
}

#[test]
fn a_run_writes_its_files_where_it_says() {
    let folder = std::env::temp_dir().join(format!("gudgeon-run-{}", std::process::id()));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("the temporary folder can be written");
    let case = fs::canonicalize(base()).expect("the base is in the repository");
    let run = |args: &[&str]| command(args).current_dir(&folder).output().expect("the program starts");
    let case = case.to_str().expect("text");
    let o = run(&["run", case]);
    assert_eq!(o.status.code(), Some(0), "{}", stderr(&o));
    assert!(stderr(&o).is_empty(), "no progress where there is no terminal: {}", stderr(&o));
    assert!(
        stdout(&o).contains("blow_by") && stdout(&o).trim_end().ends_with("out/base/report.html"),
        "{}",
        stdout(&o)
    );
    for file in ["summary.json", "series.csv", "report.html"] {
        assert!(folder.join("out/base").join(file).is_file(), "{file}");
    }
    let o = run(&["run", case, "--json", "--out", "there"]);
    let v: Value = serde_json::from_slice(&o.stdout).expect("nothing but JSON");
    assert!(v["results"]["blow_by"]["value"].is_f64());
    assert!(folder.join("there/summary.json").is_file());
    let o = run(&["run", case, "--quiet", "--out", "there"]);
    // What a person must know is told all the same, and nothing else.
    assert!(o.status.success() && o.stdout.is_empty());
    assert!(stderr(&o).lines().all(|l| l.starts_with("note: ")), "{}", stderr(&o));
    fs::remove_file(folder.join("there/report.html")).expect("written before");
    let o = run(&["report", "there"]);
    assert!(o.status.success() && folder.join("there/report.html").is_file(), "{}", stderr(&o));
    let _ = fs::remove_dir_all(&folder);
}

/// Mistakes that a validator of the part of JSON Schema that ours uses finds: one for each rule that is broken, as editors count.
fn validate(schema: &Value, root: &Value, v: &Value, errors: &mut Vec<String>) {
    let Some(s) = schema.as_object() else { return };
    let text = |key: &str| s.get(key).and_then(Value::as_str);
    if let Some(r) = text("$ref") {
        let target = root.pointer(r.trim_start_matches('#')).expect("the definition is there");
        validate(target, root, v, errors);
    }
    let is = |t: &Value| match t.as_str().expect("a type") {
        "object" => v.is_object(),
        "array" => v.is_array(),
        "string" => v.is_string(),
        "number" => v.is_number(),
        "integer" => v.is_i64() || v.is_u64(),
        "boolean" => v.is_boolean(),
        other => panic!("the schema has the type {other}"),
    };
    let typed = match s.get("type") {
        Some(Value::Array(all)) => all.iter().any(is),
        Some(one) => is(one),
        None => true,
    };
    if !typed {
        errors.push(format!("{v} is not {}", s["type"]));
    }
    if s.get("enum").and_then(Value::as_array).is_some_and(|all| !all.contains(v)) {
        errors.push(format!("{v} is no valid word"));
    }
    if s.get("const").is_some_and(|c| c != v) {
        errors.push(format!("{v} is not {}", s["const"]));
    }
    for key in ["oneOf", "anyOf", "not", "patternProperties", "unevaluatedProperties"] {
        assert!(!s.contains_key(key), "`{key}` tells more than the mistake that was made");
    }
    if let Some(o) = v.as_object() {
        for key in s.get("required").and_then(Value::as_array).into_iter().flatten() {
            if !o.contains_key(key.as_str().expect("a key")) {
                errors.push(format!("{key} is missing"));
            }
        }
        let known = s.get("properties").and_then(Value::as_object);
        for (key, v) in o {
            match (known.and_then(|k| k.get(key)), s.get("additionalProperties")) {
                (Some(p), _) => validate(p, root, v, errors),
                (None, Some(Value::Bool(false))) => errors.push(format!("`{key}` is unknown")),
                (None, Some(other)) => validate(other, root, v, errors),
                (None, None) => {}
            }
        }
    }
    for (item, v) in v.as_array().into_iter().flatten().map(|v| (s.get("items"), v)) {
        item.into_iter().for_each(|i| validate(i, root, v, errors));
    }
    for part in s.get("allOf").and_then(Value::as_array).into_iter().flatten() {
        validate(part, root, v, errors);
    }
    if let Some(condition) = s.get("if") {
        let mut no = Vec::new();
        validate(condition, root, v, &mut no);
        let next = s.get(if no.is_empty() { "then" } else { "else" });
        next.into_iter().for_each(|part| validate(part, root, v, errors));
    }
}

#[test]
fn one_mistake_is_one_message_in_an_editor() {
    let schema = json(&["schema"]);
    let text = fs::read_to_string(base()).expect("the base is in the repository");
    let found = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        let case: toml::Table = text.replacen(from, to, 1).parse().expect("TOML");
        let mut errors = Vec::new();
        validate(&schema, &schema, &serde_json::to_value(case).expect("JSON"), &mut errors);
        errors
    };
    assert_eq!(found("", ""), Vec::<String>::new());
    for (from, to) in [
        ("model = \"orifice_network\"", "model = \"orifice_netwrok\""),
        ("gap_split = 0.5", "gap_splat = 0.5"),
        ("scene = \"ring_pack\"", "scene = \"ring_peck\""),
        ("method = \"implicit\"", "method = \"fast\""),
        ("cylinders = 4", "cylinders = \"4\""),
        ("width = \"4 mm\"\n", ""),
    ] {
        let errors = found(from, to);
        assert_eq!(errors.len(), 1, "{to}: {errors:?}");
    }
}

/// Pointers to all texts in a document.
fn texts(v: &Value, at: &str, out: &mut Vec<String>) {
    match v {
        Value::String(_) => out.push(at.to_owned()),
        Value::Array(a) => a.iter().enumerate().for_each(|(i, v)| texts(v, &format!("{at}/{i}"), out)),
        Value::Object(o) => o.iter().for_each(|(key, v)| texts(v, &format!("{at}/{key}"), out)),
        _ => {}
    }
}

/// A word that nobody knows, in the place of any text of any case, is at most one mistake: of a title none, of the name of a model, a
/// shape, a convention exactly one.
#[test]
fn one_wrong_word_is_one_message_in_every_case() {
    let schema = json(&["schema"]);
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    for case in ["turbo-diesel-120-as-published", "pin-85-alcohol", "geared-train", "rigs/slider-pocket"] {
        let text = fs::read_to_string(root.join(format!("{case}.toml"))).expect("a shipped case");
        let table: toml::Table = text.parse().expect("TOML");
        let whole = serde_json::to_value(table).expect("JSON");
        let mut places = Vec::new();
        texts(&whole, "", &mut places);
        for place in places {
            let mut case = whole.clone();
            *case.pointer_mut(&place).expect("found there") = "nonsuch".into();
            let mut errors = Vec::new();
            validate(&schema, &schema, &case, &mut errors);
            assert!(errors.len() <= 1, "{place}: {errors:?}");
            let chooses =
                place.ends_with("/model") || place.ends_with("/shape") || place.contains("conventions");
            assert!(!chooses || errors.len() == 1, "{place}: no mistake found");
        }
    }
}

#[test]
fn shapes_are_described_by_their_own_key() {
    let page = stdout(&gudgeon(&["describe", "rig/slider"]));
    assert!(page.contains("profile: a table with the key `shape`, one of, required"), "{page}");
    for part in
        ["shape = \"linear\": Straight from", "shape = \"pocket\"", "h_out: a length", "depth: a length"]
    {
        assert!(page.contains(part), "{part} missing in {page}");
    }
    assert!(stdout(&gudgeon(&["describe", "rig/squeeze_film"])).contains("mode = \"oscillation\""));
    let list = stdout(&gudgeon(&["models", "rig"]));
    assert!(list.contains("slider: profile.shape is linear, step, exponential"), "{list}");
    let v = json(&["models", "rig", "--json"]);
    let models = v[0]["models"].as_array().expect("models");
    let slider = models.iter().find(|m| m["model"] == "slider").expect("there is one");
    assert_eq!(slider["tables"][0]["key"], "shape");
}

#[test]
fn every_count_and_every_list_has_a_maximum() {
    fn look(v: &Value, path: &str, unbounded: &mut Vec<String>) {
        if let Some(o) = v.as_object() {
            let is = |t: &str| match o.get("type") {
                Some(Value::Array(all)) => all.iter().any(|x| x == t),
                one => one.is_some_and(|x| x == t),
            };
            if is("integer") && !o.contains_key("maximum") || is("array") && !o.contains_key("maxItems") {
                unbounded.push(path.to_owned());
            }
            for (k, v) in o.iter().filter(|(k, _)| !["default", "enum", "const"].contains(&k.as_str())) {
                look(v, &format!("{path}/{k}"), unbounded);
            }
        }
        for (k, v) in v.as_array().into_iter().flatten().enumerate() {
            look(v, &format!("{path}/{k}"), unbounded);
        }
    }
    let mut unbounded = Vec::new();
    look(&json(&["schema"]), "", &mut unbounded);
    assert!(unbounded.is_empty(), "{unbounded:#?}");
}

/// A folder for a test, empty at its start.
fn scratch(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("gudgeon-{name}-{}", std::process::id()));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("the temporary folder can be written");
    folder
}

#[test]
fn a_run_is_repeated_from_its_summary_to_the_byte() {
    let folder = scratch("repeat");
    let run = |at: &Path, args: &[&str]| command(args).current_dir(at).output().expect("the program starts");
    let case = fs::canonicalize(base()).expect("the base is in the repository");
    let case = case.to_str().expect("text");
    let o = run(&folder, &["run", case, "--set", "engine.speed=\"1777 rpm\"", "--out", "first", "-q"]);
    assert_eq!(o.status.code(), Some(0), "{}", stderr(&o));
    // Elsewhere, from the summary alone.
    let other = folder.join("elsewhere");
    fs::create_dir(&other).expect("written");
    fs::copy(folder.join("first/summary.json"), other.join("kept.json")).expect("copied");
    let o = run(&other, &["run", "kept.json", "--out", "second", "-q"]);
    assert_eq!(o.status.code(), Some(0), "{}", stderr(&o));
    for file in ["summary.json", "series.csv", "report.html"] {
        let bytes = |p: PathBuf| fs::read(p).expect("written");
        assert_eq!(bytes(folder.join("first").join(file)), bytes(other.join("second").join(file)), "{file}");
    }
    let page = fs::read_to_string(folder.join("first/report.html")).expect("written");
    assert!(page.contains("<b>Changed</b> <code>engine.speed=&quot;1777 rpm&quot;</code>"));
    let v: Value =
        serde_json::from_slice(&fs::read(folder.join("first/summary.json")).expect("written")).expect("JSON");
    let p = &v["provenance"];
    assert_eq!(p["file"], "base.toml");
    assert_eq!(p["overrides"][0], "engine.speed=\"1777 rpm\"");
    let speed = p["resolved"]["engine"]["speed"].as_str().expect("text").to_owned();
    assert!(speed.starts_with("186.08") && speed.ends_with("rad/s"), "{speed}");
    // A record that was changed is no record.
    let text = fs::read_to_string(other.join("kept.json")).expect("written").replace("scene = ", "scene  = ");
    fs::write(other.join("kept.json"), text).expect("written");
    let o = run(&other, &["run", "kept.json", "-q"]);
    assert_eq!(o.status.code(), Some(2));
    assert!(stderr(&o).contains("its hash is another"), "{}", stderr(&o));
    let _ = fs::remove_dir_all(&folder);
}

#[test]
fn a_folder_belongs_to_one_case_and_holds_one_kind_of_results() {
    let folder = scratch("owner");
    let run = |args: &[&str]| command(args).current_dir(&folder).output().expect("the program starts");
    for at in ["a", "b"] {
        fs::create_dir(folder.join(at)).expect("written");
        fs::copy(base(), folder.join(at).join("x.toml")).expect("copied");
    }
    assert_eq!(run(&["run", "a/x.toml", "-q"]).status.code(), Some(0));
    let before = fs::read(folder.join("out/x/summary.json")).expect("written");
    let o = run(&["run", "b/x.toml", "-q"]);
    assert_eq!(o.status.code(), Some(2));
    assert!(stderr(&o).contains("holds the results of another case, `a/x.toml`"), "{}", stderr(&o));
    assert_eq!(fs::read(folder.join("out/x/summary.json")).expect("still there"), before);
    // The same case under another name of its path; and a comparison into the folder of a run.
    assert_eq!(run(&["run", "./a/../a/x.toml", "-q"]).status.code(), Some(0));
    let o = run(&["compare", "a/x.toml", "--swap", "engine.speed=\"1900 rpm\"", "--out", "out/x", "-q"]);
    assert_eq!(o.status.code(), Some(0), "{}", stderr(&o));
    assert!(folder.join("out/x/comparison.json").is_file() && !folder.join("out/x/summary.json").exists());
    let _ = fs::remove_dir_all(&folder);
}

#[test]
fn several_cases_tell_which_choice_matters() {
    let folder = scratch("shares");
    fs::copy(base(), folder.join("x.toml")).expect("copied");
    let args = [
        "compare",
        "x.toml",
        "x.toml,engine.speed=1900 rpm",
        "--swap",
        "gas_flow=orifice_network,{ model = \"narrow_channel\" },prescribed",
        "--results",
        "blow_by",
    ];
    let o = command(&args).current_dir(&folder).output().expect("the program starts");
    // `prescribed` computes no flow: without its pressures there is no such pack; it is left out, told, and no failure.
    assert_eq!(o.status.code(), Some(0), "{}", stderr(&o));
    let text = stdout(&o);
    for part in [
        "Which choice matters",
        "gas_flow",
        "with case",
        "without gas_flow=prescribed in blow_by",
        "left out",
    ] {
        assert!(text.contains(part), "no `{part}` in:\n{text}");
    }
    let file = fs::read(folder.join("out/x-compare/comparison.json")).expect("written");
    let v: Value = serde_json::from_slice(&file).expect("JSON");
    assert_eq!(v["cases"][1]["name"], "x, engine.speed=1900 rpm");
    assert_eq!(v["variants"][1]["label"], "x: gas_flow=narrow_channel");
    assert_eq!(v["shares"][0]["rows"][0]["combinations"], 4);
    let wrong = ["compare", "x.toml", "--swap", "engine.cylinders=2", "--results", "blow_bye"];
    let o = command(&wrong).current_dir(&folder).output().expect("the program starts");
    assert_eq!(o.status.code(), Some(2));
    assert!(stderr(&o).contains("there is no result `blow_bye`"), "{}", stderr(&o));
    let _ = fs::remove_dir_all(&folder);
}

#[test]
fn a_case_finds_its_comparisons_and_a_broken_one_fails() {
    let folder = scratch("validate");
    let run = |args: &[&str]| command(args).current_dir(&folder).output().expect("the program starts");
    fs::create_dir(folder.join("validation")).expect("written");
    fs::copy(base(), folder.join("x.toml")).expect("copied");
    let comparisons = |expect: &str| {
        let text = format!("case = \"../x.toml\"\n[[checks]]\nexpect = [{expect}]\n");
        fs::write(folder.join("validation/x.toml"), text).expect("written");
    };
    let one = |result: &str, value: &str, verdict: &str| {
        format!(
            "{{ result = \"{result}\", value = {value}, tolerance = 0.5, source = \"made up\", verdict = \"{verdict}\" }}"
        )
    };
    comparisons(&one("blow_by", "1e9", "not_reproduced"));
    let o = run(&["validate", "x.toml", "--json"]);
    assert_eq!(o.status.code(), Some(0), "{}", stderr(&o));
    let v: Value = serde_json::from_slice(&o.stdout).expect("JSON");
    assert_eq!(
        (&v[0]["runs"], &v[0]["checks"][0]["verdict"]),
        (&Value::from(1), &Value::from("not_reproduced"))
    );
    comparisons(&one("blow_by", "1e9", "reproduced"));
    let o = run(&["validate"]);
    assert_eq!(o.status.code(), Some(1));
    assert!(stderr(&o).contains("blow_by") && stderr(&o).contains("admitted"), "{}", stderr(&o));
    comparisons(&one("blow_buy", "1", "reproduced"));
    let o = run(&["validate"]);
    assert_eq!(o.status.code(), Some(1));
    assert!(stderr(&o).contains("did you mean `blow_by`?"), "{}", stderr(&o));
    comparisons("");
    fs::remove_file(folder.join("x.toml")).expect("there");
    let o = run(&["validate"]);
    assert_eq!(o.status.code(), Some(2), "{}", stderr(&o));
    let _ = fs::remove_dir_all(&folder);
}

#[test]
fn a_point_that_fails_is_a_row_of_its_sweep() {
    let folder = scratch("sweep");
    let case = fs::canonicalize(base()).expect("the base is in the repository");
    let o = command(&["run", case.to_str().expect("text"), "--out", "out", "-q"])
        // One cycle does not come to the periodic motion.
        .args(["--set", "sweeps=[{path=\"solver.max_cycles\", values=[\"1\", \"40\"]}]"])
        .current_dir(&folder)
        .output()
        .expect("the program starts");
    assert_eq!(o.status.code(), Some(1), "{}", stderr(&o));
    assert!(stderr(&o).contains("1 of 2 points of the sweep"), "{}", stderr(&o));
    let text = fs::read_to_string(folder.join("out/sweep.csv")).expect("written");
    let rows: Vec<Vec<&str>> = text.lines().map(|l| l.split(',').collect()).collect();
    assert_eq!(rows[0].last(), Some(&"exit[1]"));
    let ends: Vec<(&str, &str)> = rows[1..].iter().map(|r| (r[0], r[r.len() - 1])).collect();
    assert_eq!(ends, [("1", "1"), ("40", "0")]);
    let _ = fs::remove_dir_all(&folder);
}

#[test]
fn derivatives_have_the_same_units_everywhere() {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/rigs/slider-barrel.toml");
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("gradient-units");
    let (case, folder) = (case.to_str().expect("text"), out.to_str().expect("text"));
    let args = ["gradient", case, "--set", "rig.panels=25", "--by", "rig.speed", "--results", "load"];
    let o = gudgeon(&[&args[..], &["--out", folder]].concat());
    assert_eq!(o.status.code(), Some(0), "{}", stderr(&o));
    // A load per width by a speed.
    let wanted = "(N/m)/(m/s)";
    assert!(stdout(&o).contains(wanted), "{}", stdout(&o));
    let table = fs::read_to_string(out.join("gradients.csv")).expect("a table");
    let rows: Vec<Vec<&str>> = table.lines().map(|l| l.split(',').collect()).collect();
    let column = rows[0].iter().position(|name| *name == "derivative_unit").expect("a column");
    assert_eq!(rows[1][column], wanted);
    assert_eq!(
        json(&[&args[..], &["--json"]].concat())["results"]["load"]["by_unit"],
        serde_json::json!([wanted])
    );
}

#[test]
fn scenes_and_their_tables_are_described() {
    let scenes = ["ring_pack", "piston_secondary", "power_cylinder", "shaft_line", "pin"];
    for scene in scenes {
        let page = stdout(&gudgeon(&["describe", scene]));
        for part in ["Equations", "Validity", "Keys", "title: text", "sweeps: array of tables"] {
            assert!(page.contains(part), "{scene}: no {part} in {page}");
        }
    }
    let page = stdout(&gudgeon(&["describe", "ring_pack.rings.face"]));
    assert!(page.contains("shape: one word of") && page.contains("`taper`: "), "{page}");
    // Indices of arrays may be there, as in messages.
    assert_eq!(
        stdout(&gudgeon(&["describe", "ring_pack.rings.0.face"])).lines().skip(1).collect::<Vec<_>>(),
        page.lines().skip(1).collect::<Vec<_>>()
    );
    let v = json(&["describe", "shaft_line.throws", "--json"]);
    assert_eq!(v["schema"]["properties"]["crank_radius"]["x-dimension"], "a length");
    let o = gudgeon(&["describe", "ring_pack.ring"]);
    assert!(o.status.code() == Some(2) && stderr(&o).contains("did you mean `rings`?"), "{}", stderr(&o));
}

/// The example of a model stands where a case has it: among the models, on a bench, in a table of its own, as a solver.
#[test]
fn examples_stand_where_a_case_has_them() {
    for (model, place) in [
        ("oil/walther", "[models.oil]\nmodel = \"walther\"\n"),
        ("rig/slider", "[rig]\nmodel = \"slider\"\n"),
        ("coupling/linear", "[shafts.coupling]\nmodel = \"linear\"\n"),
        ("drive/constant", "[drives.drive]\nmodel = \"constant\"\n"),
        ("hoop/correct", "[conventions.hoop]\nmodel = \"correct\"\n"),
        ("film_1d/off", "[rig.film_1d]\nmodel = \"off\"\n"),
        ("ring_pack_solver/implicit", "[solver]\nmethod = \"implicit\"\n"),
        ("piston_solver/backward_euler", "[solver]\nmethod = \"backward_euler\"\n"),
    ] {
        let example = json(&["describe", model, "--json"])["example"].as_str().expect("text").to_owned();
        assert!(example.starts_with(place), "{place} missing in {example}");
        let page = stdout(&gudgeon(&["describe", model]));
        for line in example.lines() {
            assert!(page.contains(&format!("\n  {line}\n")), "{line} missing in {page}");
        }
    }
}
