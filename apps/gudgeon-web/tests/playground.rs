//! The functions behind the page, on this machine.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

use gudgeon_web::{CASES, Playground, answer, shown};
use serde_json::{Value, json};

/// A playground with all models, and the answer to a question.
fn ask(p: &mut Playground, question: &Value) -> Value {
    gudgeon_models::link();
    serde_json::from_str(&answer(p, &question.to_string())).expect("an answer is JSON")
}

fn text(file: &str) -> String {
    let found = CASES.iter().find(|(name, _)| *name == file);
    found.unwrap_or_else(|| panic!("{file} comes with the page")).1.to_owned()
}

fn open(file: &str, text: &str) -> Value {
    ask(&mut Playground::default(), &json!({ "ask": "open", "file": file, "text": text }))
}

fn change(file: &str, text: &str, set: &[&str]) -> Value {
    ask(&mut Playground::default(), &json!({ "ask": "change", "file": file, "text": text, "set": set }))
}

#[test]
fn every_case_opens_with_sliders_and_choices() {
    for (file, text) in CASES {
        let told = open(file, text);
        let sliders = told["sliders"].as_array().unwrap_or_else(|| panic!("{file}: {told}"));
        let first: Vec<&Value> = sliders.iter().filter(|s| s["first"] == true).collect();
        // A case that only names other cases has no numbers.
        assert!(sliders.is_empty() || !first.is_empty(), "{file}: no slider is shown");
        assert!(first.len() <= 10, "{file}: {} sliders", first.len());
        for s in sliders {
            let of = |key: &str| s[key].as_f64().unwrap_or(f64::NAN);
            assert!(of("low") <= of("value") && of("value") <= of("high") && of("step") > 0.0, "{file}: {s}");
        }
    }
}

#[test]
fn what_a_scene_shows_first_exists_in_a_case_of_it() {
    let opened: Vec<Value> = CASES.iter().map(|(file, text)| open(file, text)).collect();
    for shown in shown::SHOWN {
        let paths: Vec<&str> = opened
            .iter()
            .filter(|case| case["scene"] == shown.scene)
            .flat_map(|case| case["sliders"].as_array().into_iter().flatten())
            .filter_map(|s| s["path"].as_str())
            .collect();
        for pattern in shown.sliders {
            assert!(
                paths.iter().any(|p| shown::fits(pattern, p)),
                "{}: no case has `{pattern}`",
                shown.scene
            );
        }
    }
}

#[test]
fn a_slider_writes_its_value_into_the_text() {
    let before = text("turbo-diesel-120.toml");
    let after = change("turbo-diesel-120.toml", &before, &["engine.speed=\"1800 rpm\""]);
    let after = after["text"].as_str().expect("a text");
    assert_eq!(after, before.replacen("speed = \"2000 rpm\"", "speed = \"1800 rpm\"", 1));
}

#[test]
fn a_model_that_needs_keys_gets_them_from_its_example() {
    let before = text("turbo-diesel-120.toml");
    let told = change("turbo-diesel-120.toml", &before, &["models.oil.model=\"constant\""]);
    let after = told["text"].as_str().unwrap_or_else(|| panic!("{told}"));
    let opened = open("turbo-diesel-120.toml", after);
    assert!(opened["sliders"].is_array(), "{opened}\n{after}");
    assert!(!told["added"].as_array().expect("a list").is_empty(), "{told}");
}

#[test]
fn every_model_of_the_diesel_can_be_chosen_or_says_why_not() {
    let before = text("turbo-diesel-120.toml");
    let opened = open("turbo-diesel-120.toml", &before);
    for c in opened["choices"].as_array().expect("choices").iter().filter(|c| c["kind"] != "") {
        for word in c["words"].as_array().expect("words") {
            let (path, name) = (c["path"].as_str().expect("a path"), word[0].as_str().expect("a word"));
            let told = change("turbo-diesel-120.toml", &before, &[&format!("{path}=\"{name}\"")]);
            let after = told["text"].as_str().unwrap_or_else(|| panic!("{path}={name}: {told}"));
            let opened = open("turbo-diesel-120.toml", after);
            let refused = opened["refused"].as_array().is_some_and(|all| all[0]["line"].is_number());
            assert!(opened["sliders"].is_array() || refused, "{path}={name}: {opened}");
        }
    }
}

#[test]
fn a_mistake_has_its_line_and_advice() {
    let wrong = text("turbo-diesel-120.toml").replace("\"narrow_channel\"", "\"narow_channel\"");
    let told = open("turbo-diesel-120.toml", &wrong);
    let line = 1 + wrong.lines().position(|l| l.contains("narow")).expect("stands in it");
    assert_eq!(told["refused"][0]["line"], line);
    assert_eq!(told["refused"][0]["column"], 9);
    assert!(
        told["refused"][0]["help"].as_str().is_some_and(|h| h.contains("did you mean `narrow_channel`?"))
    );
}

#[test]
fn a_run_tells_what_the_command_line_tells() {
    let file = "rigs/slider-straight.toml";
    let mut p = Playground::default();
    let none = ask(&mut p, &json!({ "ask": "files" }));
    assert!(none["failed"].is_string(), "{none}");
    let told = ask(&mut p, &json!({ "ask": "run", "file": file, "text": text(file) }));
    let files = ask(&mut p, &json!({ "ask": "files" }));
    let summary: Value = serde_json::from_str(files["summary.json"].as_str().expect("a file")).expect("JSON");
    for r in told["results"].as_array().expect("results") {
        let name = r["name"].as_str().expect("a name");
        assert_eq!(summary["results"][name]["value"], r["value"], "{name}");
    }
    assert!(files["report.html"].as_str().is_some_and(|page| page.starts_with("<!DOCTYPE html>")));
    assert!(told["data"]["figures"].as_array().is_some_and(|f| !f.is_empty()));
}

#[test]
fn a_preview_says_its_settings_and_is_not_kept() {
    let mut p = Playground::default();
    let file = "turbo-diesel-120.toml";
    let told = ask(&mut p, &json!({ "ask": "run", "file": file, "text": text(file), "preview": true }));
    assert_eq!(told["preview"], json!(["models.oil_transport.model=off", "solver.tolerance=1e-2"]));
    assert!(ask(&mut p, &json!({ "ask": "files" }))["failed"].is_string());
    // A pin has nothing to be quicker with.
    let pin = "pin-85-alcohol.toml";
    let told = ask(&mut p, &json!({ "ask": "run", "file": pin, "text": text(pin), "preview": true }));
    assert!(told["failed"].is_string(), "{told}");
}

#[test]
fn a_case_finds_the_case_that_it_names() {
    let file = "pin-120-turbo-diesel.toml";
    let told = ask(&mut Playground::default(), &json!({ "ask": "run", "file": file, "text": text(file) }));
    assert!(told["results"].as_array().is_some_and(|r| !r.is_empty()), "{told}");
}

#[test]
fn nothing_that_a_page_sends_breaks_the_program() {
    let mut p = Playground::default();
    for question in [json!({}), json!({ "ask": "fly" }), json!({ "ask": "text", "file": "../x" })] {
        assert!(ask(&mut p, &question)["failed"].is_string(), "{question}");
    }
    for text in ["", "é", "scene = \"rig\"", "[[", "scene = 3\n[[x]]\n"] {
        let opened = ask(&mut p, &json!({ "ask": "open", "file": "x.toml", "text": text }));
        assert!(opened["refused"].is_array(), "{text}: {opened}");
        let help = ask(&mut p, &json!({ "ask": "help", "text": text, "offset": 1 }));
        assert!(help["path"].is_string(), "{text}: {help}");
        let changed = ask(
            &mut p,
            &json!({ "ask": "change", "file": "x.toml", "text": text, "set": ["engine.speed=1"] }),
        );
        assert!(changed["refused"].is_array(), "{text}: {changed}");
    }
}
