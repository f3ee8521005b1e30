//! Parameter sets at the command line: listed, named by a case, overridden, recorded; and what every set must keep.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

fn gudgeon(args: &[&str]) -> Output {
    let mut c = Command::new(env!("CARGO_BIN_EXE_gudgeon"));
    c.args(args).env("NO_COLOR", "1").output().expect("the program starts")
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
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}
fn case(name: &str) -> String {
    root().join(format!("cases/{name}.toml")).display().to_string()
}

/// Table, name of the set, the set.
fn all_sets() -> Vec<(String, String, Value)> {
    let mut out = Vec::new();
    for table in json(&["models", "--sets", "--json"]).as_array().expect("a list") {
        let of = table["of"].as_str().expect("a name");
        for (name, set) in table["sets"].as_object().expect("sets") {
            out.push((of.to_owned(), name.clone(), set.clone()));
        }
    }
    out
}

/// A number is cited, or assumed, or both where a source is interpreted; what is cited stands in the bibliography.
#[test]
fn every_value_of_a_set_has_its_origin() {
    let bibliography = fs::read_to_string(root().join("REFERENCES.bib")).expect("it stands at the root");
    let sets = all_sets();
    assert!(sets.len() >= 15, "{}", sets.len());
    for (of, name, set) in sets {
        for (key, v) in set["values"].as_object().expect("values") {
            let at = format!("{of}, {name}, {key}");
            match v["source"].as_str() {
                Some(source) => assert!(bibliography.contains(&format!("{{{source},")), "{at}: [{source}]"),
                None => assert!(
                    v["assumed"].as_str().is_some_and(|a| a.len() > 4),
                    "{at}: neither source nor reason"
                ),
            }
        }
    }
}

/// Every set of a model builds it, where the keys that it leaves open are given.
#[test]
fn every_set_of_a_model_can_be_used() {
    let places = [
        ("oil/walther", "rigs/lubricant", "rig.oil"),
        ("shear_thinning/cross", "rigs/lubricant", "rig.shear_thinning"),
        ("contact/greenwood_tripp", "turbo-diesel-120", "models.contact"),
        ("contact/greenwood_williamson", "turbo-diesel-120", "models.contact"),
        ("contact/load_sharing", "turbo-diesel-120", "models.contact"),
        ("contact/kogut_etsion", "turbo-diesel-120", "models.contact"),
        ("contact/abbott_firestone", "turbo-diesel-120", "models.contact"),
        ("contact/crest_wedge", "ea111-1400", "models.contact"),
    ];
    for (of, name, _) in all_sets() {
        let Some((_, model)) = of.split_once('/') else { continue };
        let (_, file, path) = places.iter().find(|p| p.0 == of).expect("a model with sets gets a line here");
        // No set has the profile of a surface.
        let open = match model {
            "abbott_firestone" => ", height = [-1e-6, 1e-6], material_ratio = [1, 0]",
            _ => "",
        };
        let set = format!("{path}={{ model = \"{model}\", set = \"{name}\"{open} }}");
        let o = gudgeon(&["check", &case(file), "--set", &set]);
        assert_eq!(o.status.code(), Some(0), "{set}: {}", stderr(&o));
    }
}

/// Composite moduli of the surfaces are those of the moduli and Poisson's ratios that their origin names.
#[test]
fn composite_moduli_follow_from_their_materials() {
    let of = |e1: f64, nu1: f64, e2: f64, nu2: f64| ((1.0 - nu1 * nu1) / e1 + (1.0 - nu2 * nu2) / e2).recip();
    let iron = (100.0, 0.26);
    let pairs = [
        ("steel_on_grey_iron", of(230.0, 0.3, iron.0, iron.1)),
        ("nitrided_steel_on_grey_iron", of(230.0, 0.3, iron.0, iron.1)),
        ("chromium_on_grey_iron", of(250.0, 0.21, iron.0, iron.1)),
        ("molybdenum_on_grey_iron", of(150.0, 0.3, iron.0, iron.1)),
        ("chromium_nitride_on_grey_iron", of(300.0, 0.2, iron.0, iron.1)),
        ("nodular_iron_on_grey_iron", of(150.0, 0.28, iron.0, iron.1)),
        ("grey_iron_on_grey_iron", of(100.0, 0.26, iron.0, iron.1)),
        ("steel_on_steel", of(210.0, 0.3, 210.0, 0.3)),
        ("aluminium_on_grey_iron", of(75.0, 0.33, iron.0, iron.1)),
        ("hypereutectic_on_grey_iron", of(83.0, 0.33, iron.0, iron.1)),
        ("high_copper_on_grey_iron", of(80.0, 0.33, iron.0, iron.1)),
        ("aluminium_on_nickel_silicon", of(75.0, 0.33, 75.0, 0.33)),
    ];
    let mut checked = 0;
    for (of, name, set) in all_sets() {
        let Some(told) = set["values"]["composite_modulus"]["value"].as_str() else { continue };
        let (_, exact) = pairs.iter().find(|p| p.0 == name).expect("a pair of materials gets a line here");
        let told: f64 = told.strip_suffix(" GPa").expect("in GPa").parse().expect("a number");
        // Told in whole GPa.
        assert!((told - exact).abs() <= 0.5, "{of}, {name}: {told} GPa, {exact} GPa by its materials");
        checked += 1;
    }
    assert!(checked >= pairs.len());
}

/// The sets of engine and piston are what the cases say that print the same source.
#[test]
fn sets_of_engines_are_those_of_the_cases() {
    for (file, set, speed) in
        [("ea111-1400", "ea111_1400", "2500 rpm"), ("zhu-motored-1000", "zhu_83", "1000 rpm")]
    {
        let file = case(file);
        let engine = format!("engine={{ speed = \"{speed}\", set = \"{set}\" }}");
        let piston = format!("piston={{ set = \"{set}\" }}");
        let by_set = json(&["explain", &file, "--json", "--set", &engine, "--set", &piston]);
        let as_it_is = json(&["explain", &file, "--json"]);
        for table in ["engine", "piston"] {
            assert_eq!(by_set["resolved"][table], as_it_is["resolved"][table], "{set}");
        }
        assert_eq!(by_set["sets"].as_array().map(Vec::len), Some(2));
    }
}

#[test]
fn sets_are_listed_and_described() {
    let list = stdout(&gudgeon(&["models", "oil", "--sets"]));
    for part in [
        "oil/walther",
        "set = \"0W-20\"",
        "set = \"5W-30\"",
        "set = \"10W-40\"",
        "set = \"15W-40\"",
        "[saej300]",
        "assumed:",
    ] {
        assert!(list.contains(part), "{part} missing in {list}");
    }
    assert!(!list.contains("contact/"), "only what was asked for");
    let page = stdout(&gudgeon(&["describe", "oil/walther"]));
    assert!(page.contains("Parameter sets\n") && page.contains("set = \"5W-30\""), "{page}");
    assert!(stdout(&gudgeon(&["models", "engine", "--sets"])).contains("ea111_1400"));
    for (name, help) in [("gas_flow", "has no parameter sets"), ("engin", "did you mean `engine`?")] {
        let o = gudgeon(&["models", name, "--sets"]);
        assert!(o.status.code() == Some(2) && stderr(&o).contains(help), "{name}: {}", stderr(&o));
    }
}

/// What a case gives itself wins, wherever it gives it; a wrong name is one mistake at its place, with the nearest right one.
#[test]
fn a_case_names_a_set_and_may_override_it() {
    let file = case("turbo-diesel-120");
    let oil = "models.oil={ model = \"walther\", set = \"5W-30\", density = 900 }";
    let v = json(&["explain", &file, "--json", "--set", oil, "--set", "models.oil.nu_hot=11.5"]);
    let resolved = &v["resolved"]["models"]["oil"];
    assert_eq!(resolved["density"], 900.0);
    assert_eq!(resolved["nu_hot"], 11.5);
    assert_eq!(resolved["nu_cold"], 63.0);
    assert_eq!(v["sets"][0]["own"], serde_json::json!(["nu_hot", "density"]));
    let text = stdout(&gudgeon(&["explain", &file, "--set", oil]));
    assert!(text.contains("models.oil = \"5W-30\"") && text.contains("[saej300]"), "{text}");

    let wrong = "models.oil={ model = \"walther\", set = \"5W-3O\" }";
    let o = gudgeon(&["check", &file, "--set", wrong]);
    let said = stderr(&o);
    assert_eq!(o.status.code(), Some(2));
    assert!(
        said.contains("there is no parameter set `5W-3O`") && said.contains("did you mean `5W-30`?"),
        "{said}"
    );
    assert!(!said.contains("missing") && said.contains("[--set:1:"), "one mistake, at its place: {said}");
}

/// A run records what its sets gave, counts the assumed ones among its assumptions and cites the others with the model; it is repeated
/// from its record.
#[test]
fn a_run_records_its_sets() {
    let folder = std::env::temp_dir().join(format!("gudgeon-sets-{}", std::process::id()));
    let _ = fs::remove_dir_all(&folder);
    let out = |name: &str| folder.join(name).display().to_string();
    let set = "rig.oil={ model = \"walther\", set = \"15W-40\" }";
    let first = gudgeon(&["run", &case("rigs/lubricant"), "--set", set, "--out", &out("a"), "-q"]);
    assert!(first.status.success(), "{}", stderr(&first));
    let summary = folder.join("a/summary.json");
    let text = fs::read_to_string(&summary).expect("written");
    let v: Value = serde_json::from_str(&text).expect("JSON");
    let used = &v["provenance"]["sets"][0];
    assert_eq!((used["path"].as_str(), used["name"].as_str()), (Some("rig.oil"), Some("15W-40")));
    assert_eq!(used["values"]["nu_hot"]["value"], "14.4");
    let assumed = v["assumptions"].as_array().expect("a list");
    assert!(
        assumed.iter().any(|a| a.as_str().is_some_and(|a| a.starts_with("rig.oil.nu_cold = 108.0"))),
        "{assumed:?}"
    );
    let again = gudgeon(&["run", &summary.display().to_string(), "--out", &out("b"), "-q"]);
    assert!(again.status.success(), "{}", stderr(&again));
    assert_eq!(fs::read_to_string(folder.join("b/summary.json")).expect("written"), text, "to the byte");
    let _ = fs::remove_dir_all(&folder);
}
