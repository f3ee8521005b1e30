//! One file outside the physics crates is a full member of the program: listed, described, read from a case, validated
//! with places, run and compared.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

use std::path::{Path, PathBuf};
use std::process::Command;

use custom_model as _;
use gudgeon_case::load_str;
// Links the models.
use gudgeon as _;
use gudgeon_core::Registry;
use gudgeon_core::kinds::{Oil, OilSpec};
use gudgeon_scene_ring_pack::case::RingPackCase;
use serde_json::json;

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}
fn case_file() -> PathBuf {
    folder().join("measured-oil.toml")
}
fn oil(spec: serde_json::Value) -> Box<dyn Oil> {
    let spec: Box<dyn OilSpec> = serde_json::from_value(spec).expect("a valid specification");
    spec.build().expect("a possible oil")
}

#[test]
fn the_registry_lists_and_describes_it() {
    let registry = Registry::collect();
    assert_eq!(registry.verify(), Ok(()));
    let m = registry.model("oil", "reynolds_exponential").expect("linked");
    assert_eq!(Path::new(m.file).file_name().and_then(|f| f.to_str()), Some("reynolds_exponential.rs"));
    assert_eq!(m.references, ["reynolds1886"]);
    // The built-in oils are there as before.
    assert!(registry.model("oil", "vogel_grade").is_some());
}

/// What every model of Gudgeon keeps; an oil that nothing makes infinite.
#[test]
fn it_keeps_the_contract_of_a_model() {
    assert_eq!(gudgeon_testkit::check_crate("custom_model"), 1);
    let measured =
        oil(json!({ "model": "reynolds_exponential", "mu_cold": "18 mPa s", "mu_hot": "6 mPa s" }));
    gudgeon_testkit::assert_none(gudgeon_testkit::oil(&*measured));
}

#[test]
fn the_command_line_knows_it() {
    let run = |args: &[&str]| {
        let o =
            Command::new(env!("CARGO_BIN_EXE_custom-model")).args(args).output().expect("the program starts");
        assert_eq!(o.status.code(), Some(0), "{args:?}: {}", String::from_utf8_lossy(&o.stderr));
        String::from_utf8(o.stdout).expect("text")
    };
    assert!(run(&["models", "oil"]).contains("reynolds_exponential"));
    let page = run(&["describe", "oil/reynolds_exponential"]);
    for part in
        ["mu_cold (mu_hot/mu_cold)", "mu_cold: ", "required", "reynolds1886", "reynolds_exponential.rs"]
    {
        assert!(page.contains(part), "no `{part}` in\n{page}");
    }
    assert!(run(&["schema"]).contains(r#""const": "reynolds_exponential""#));
    let case = case_file();
    assert!(run(&["check", case.to_str().expect("text")]).contains("ok"));
}

#[test]
fn a_case_picks_it() {
    let c = gudgeon_scene::check(&case_file(), &[]).map_err(|r| r.to_string()).expect("a valid case");
    assert_eq!(
        c.of::<RingPackCase>().expect("a ring pack").models.oil.typetag_name(),
        "reynolds_exponential"
    );
    let e = gudgeon_scene::explain(&c).expect("a possible case");
    let m = e.models.iter().find(|m| m.used.kind == "oil").expect("friction needs an oil");
    assert_eq!(
        (m.used.model.as_str(), m.used.references[0].as_str()),
        ("reynolds_exponential", "reynolds1886")
    );
    // Defaults of the specification are filled in.
    assert_eq!(e.resolved["models"]["oil"]["hot"], json!("393.15 K"));
}

#[test]
fn mistakes_are_found_at_their_place() {
    let text = std::fs::read_to_string(case_file()).expect("the case stands beside the example");
    let places = |text: &str| -> Vec<(usize, String)> {
        let report =
            load_str::<RingPackCase>("case.toml", text, &folder(), &[]).expect_err("must be refused");
        let line = |d| report.place(d).map_or(0, |(_, line, _)| line);
        report.diagnostics.iter().map(|d| (line(d), d.headline())).collect()
    };
    let line_of =
        |text: &str, what: &str| 1 + text.lines().position(|l| l.starts_with(what)).expect("is there");

    let unknown = text.replace("mu_hot =", "mu_hto =");
    let found = places(&unknown);
    let line = line_of(&unknown, "mu_hto");
    assert!(found.iter().any(|(l, m)| *l == line && m.contains("`mu_hto`")), "{found:?}");

    let negative = text.replace("mu_hot = \"6", "mu_hot = \"-6");
    let found = places(&negative);
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].0, line_of(&negative, "mu_hot"), "{found:?}");

    // What only the model itself can see: every value is possible alone.
    let report = gudgeon_scene::check(&case_file(), &["models.oil.mu_hot=200 mPa s".into()])
        .err()
        .expect("must be refused");
    let d = &report.diagnostics[0];
    assert_eq!(d.path, "models.oil.mu_hot");
    assert!(d.message.contains("thinner"), "{}", d.message);
}

#[test]
fn it_runs_and_is_compared() {
    let swaps = [("models.oil.mu_hot".to_owned(), vec!["6 mPa s".to_owned(), "8 mPa s".to_owned()])];
    let c = gudgeon_study::compare(&case_file(), &[], &swaps, &mut gudgeon_scene::unwatched)
        .map_err(|r| r.to_string())
        .expect("both oils are possible");
    let film = |k: usize| {
        let r = c.variants[k].outcome.as_ref().expect("ran");
        assert!(r.models.iter().any(|m| m.kind == "oil" && m.model == "reynolds_exponential"));
        r.results["ring1.h_mean"].value
    };
    // Film thickness grows with viscosity; 8 instead of 6 mPa s at 120 degC cannot leave it within a percent.
    assert!(film(1) > 1.01 * film(0), "{} and {}", film(0), film(1));
}

#[test]
fn it_is_swapped_for_a_built_in_model_and_back() {
    // A model whose required keys the case does not have is a variant with a reason, not a failure of the comparison.
    let swaps = [("oil".to_owned(), vec!["reynolds_exponential".to_owned(), "constant".to_owned()])];
    let c = gudgeon_study::compare(&case_file(), &[], &swaps, &mut gudgeon_scene::unwatched)
        .map_err(|r| r.to_string())
        .expect("one oil is possible");
    assert!(c.variants[0].outcome.is_ok());
    let why = c.variants[1].why().expect("`constant` needs a viscosity");
    assert!(why.contains("viscosity"), "{why}");
    // With its key it is a case like any other.
    let set = [r#"models.oil={ model = "constant", viscosity = "5 mPa s" }"#.to_owned()];
    let c = gudgeon_scene::check(&case_file(), &set).map_err(|r| r.to_string()).expect("a valid case");
    assert_eq!(c.of::<RingPackCase>().expect("a ring pack").models.oil.typetag_name(), "constant");
}

#[test]
fn the_equation_passes_through_its_points() {
    let o = oil(json!({ "model": "reynolds_exponential", "mu_cold": "18 mPa s", "mu_hot": "6 mPa s" }));
    // Halfway the viscosity is the geometric mean.
    for (celsius, mu) in [(80.0, 18e-3), (100.0, (18e-3_f64 * 6e-3).sqrt()), (120.0, 6e-3)] {
        // A logarithm and an exponential of numbers near one, each good to an ulp or two.
        let value = o.viscosity(273.15 + celsius);
        assert!((value / mu - 1.0).abs() < 1e-14, "{value} at {celsius} degC, exact {mu}");
    }
}

#[test]
fn no_temperature_gives_nonsense() {
    let o = oil(json!({ "model": "reynolds_exponential", "mu_cold": "18 mPa s", "mu_hot": "6 mPa s" }));
    let mut last = f64::INFINITY;
    for k in 1..=3000 {
        let mu = o.viscosity(f64::from(k));
        assert!(mu.is_finite() && mu > 0.0 && mu <= last, "{mu} Pa s at {k} K");
        last = mu;
    }
    for (cold, hot) in [("10 mPa s", "20 mPa s"), ("10 mPa s", "10 mPa s"), ("100 Pa s", "1 mPa s")] {
        let spec: Box<dyn OilSpec> = serde_json::from_value(
            json!({ "model": "reynolds_exponential", "mu_cold": cold, "mu_hot": hot }),
        )
        .expect("readable");
        assert!(spec.build().is_err(), "{cold} and {hot}");
    }
}
