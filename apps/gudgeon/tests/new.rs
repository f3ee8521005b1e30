//! Templates, completions and manual pages: what a person meets before the first case.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

fn gudgeon(at: &Path, args: &[&str]) -> Output {
    let mut c = Command::new(env!("CARGO_BIN_EXE_gudgeon"));
    c.args(args).current_dir(at).env("NO_COLOR", "1").output().expect("the program starts")
}
fn stdout(o: &Output) -> String {
    String::from_utf8(o.stdout.clone()).expect("text")
}
fn stderr(o: &Output) -> String {
    String::from_utf8(o.stderr.clone()).expect("text")
}

/// A folder for a test, empty at its start.
fn scratch(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("gudgeon-{name}-{}", std::process::id()));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("the temporary folder can be written");
    folder
}

fn templates() -> Vec<String> {
    let o = gudgeon(Path::new("."), &["new", "--json"]);
    let v: Value = serde_json::from_slice(&o.stdout).expect("JSON");
    v.as_array().expect("a list").iter().map(|t| t["template"].as_str().expect("a name").to_owned()).collect()
}

/// A result, the least and the greatest value that it may have.
type Bound = (&'static str, f64, f64);

/// Each template written, checked and run as it is; its results stand between bounds that any machine of its class keeps.
#[test]
fn every_template_runs_as_it_is_and_gives_believable_results() {
    // Wide, for they say that a template is no nonsense, not that it is one engine.
    let bounds: &[(&str, &[Bound])] = &[
        // Blow-by of a sound engine is some thousandths of its charge; rings cost 0.05 to 0.4 bar; peak pressures of the class.
        (
            "petrol-engine",
            &[("blow_by_share", 1e-3, 1e-2), ("fmep", 0.05, 0.4), ("cylinder.p_max", 45.0, 90.0)],
        ),
        ("diesel", &[("blow_by_share", 1e-3, 1e-2), ("fmep", 0.05, 0.4), ("cylinder.p_max", 120.0, 220.0)]),
        // All limits of the template are kept; the first mode of such a line lies between 20 and 80 Hz.
        ("compressor-line", &[("limits_broken", 0.0, 0.0), ("mode.1.frequency", 20.0, 80.0)]),
        // A skirt stays in its clearance but for the barrel, and costs about as much as the rings.
        ("skirt", &[("fmep", 0.02, 0.3), ("tilt_max", 5.0, 200.0), ("h_min", 0.5, 20.0)]),
        // Within the range asked for, and no limit exceeded by more than rounding.
        ("pin", &[("outer", 18.0, 28.0), ("utilisation", 0.99, 1.0 + 1e-9), ("pin_mass", 50.0, 250.0)]),
    ];
    let names: Vec<&str> = bounds.iter().map(|(n, _)| *n).collect();
    assert_eq!(templates(), names, "a new template gets a line here");
    let folder = scratch("new-run");
    for (name, results) in bounds {
        let file = format!("{name}.toml");
        let o = gudgeon(&folder, &["new", name]);
        assert!(o.status.success(), "{name}: {}", stderr(&o));
        for next in ["check", "explain", "run"] {
            assert!(stdout(&o).contains(&format!("gudgeon {next} {file}")), "{}", stdout(&o));
        }
        let o = gudgeon(&folder, &["check", &file]);
        assert!(o.status.success() && o.stderr.is_empty(), "{name}: {}", stderr(&o));
        let o = gudgeon(&folder, &["run", &file, "--json"]);
        assert!(o.status.success(), "{name}: {}", stderr(&o));
        let v: Value = serde_json::from_slice(&o.stdout).expect("nothing but JSON");
        for (result, least, greatest) in *results {
            let value = v["results"][result]["value"].as_f64().expect(result);
            assert!((*least..=*greatest).contains(&value), "{name}: {result} = {value}");
        }
        assert!(!v["assumptions"].as_array().expect("a list").is_empty(), "{name} says what it assumes");
    }
    let _ = fs::remove_dir_all(&folder);
}

/// There is a comment for every second key at least: what the number is, where it is found, what is usual.
#[test]
fn templates_explain_their_lines() {
    let o = gudgeon(Path::new("."), &["new", "--json"]);
    let v: Value = serde_json::from_slice(&o.stdout).expect("JSON");
    for t in v.as_array().expect("a list") {
        let text = t["text"].as_str().expect("text");
        let (name, about) = (&t["template"], t["about"].as_str().expect("text"));
        assert!(text.starts_with(&format!("# {about}\n")) && about.len() < 100, "{name}");
        // Rings and shafts repeat their keys, which are explained the first time.
        let keys: BTreeSet<&str> = text
            .lines()
            .filter(|l| !l.starts_with('#'))
            .filter_map(|l| Some(l.split_once(" = ")?.0))
            .collect();
        let comments = text.lines().filter(|l| l.contains("# ")).count();
        assert!(2 * comments >= keys.len(), "{name}: {comments} comments on {} keys", keys.len());
    }
}

#[test]
fn new_lists_templates_and_overwrites_nothing() {
    let folder = scratch("new-list");
    let o = gudgeon(&folder, &["new"]);
    let list = stdout(&o);
    for name in templates() {
        assert!(list.lines().any(|l| l.trim_start().starts_with(&name)), "{name} missing in {list}");
    }
    assert_eq!(fs::read_dir(&folder).expect("a folder").count(), 0, "a list writes nothing");

    fs::write(folder.join("mine.toml"), "mine").expect("written");
    let o = gudgeon(&folder, &["new", "pin", "mine.toml"]);
    assert_eq!(o.status.code(), Some(2));
    assert!(stderr(&o).contains("`mine.toml` exists and is not overwritten"), "{}", stderr(&o));
    assert_eq!(fs::read_to_string(folder.join("mine.toml")).expect("there"), "mine");

    let o = gudgeon(&folder, &["new", "disel"]);
    assert_eq!(o.status.code(), Some(2));
    assert!(stderr(&o).contains("did you mean `diesel`?"), "{}", stderr(&o));
    let o = gudgeon(&folder, &["new", "pin", "nowhere/pin.toml"]);
    assert_eq!(o.status.code(), Some(2));
    assert!(stderr(&o).contains("cannot be written"), "{}", stderr(&o));
    let _ = fs::remove_dir_all(&folder);
}

#[test]
fn completions_and_manual_pages_know_every_command() {
    let folder = scratch("man");
    let help = stdout(&gudgeon(&folder, &["--help"]));
    let commands: Vec<&str> = help
        .lines()
        .skip_while(|l| *l != "Commands:")
        .skip(1)
        .take_while(|l| l.starts_with("  "))
        .filter_map(|l| l.split_whitespace().next())
        .filter(|c| *c != "help")
        .collect();
    assert!(commands.len() > 10, "{commands:?}");
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let o = gudgeon(&folder, &["completions", shell]);
        let script = stdout(&o);
        assert!(o.status.success() && o.stderr.is_empty());
        for c in &commands {
            assert!(script.contains(c), "{shell}: no {c}");
        }
        assert!(script.contains("swap"), "{shell}: no options");
    }
    assert!(stdout(&gudgeon(&folder, &["man"])).contains(".TH gudgeon 1"));
    let o = gudgeon(&folder, &["man", "--out", "man/man1"]);
    assert!(o.status.success(), "{}", stderr(&o));
    for c in commands {
        let page = fs::read_to_string(folder.join(format!("man/man1/gudgeon-{c}.1"))).expect("a page");
        let parts = [format!(".TH gudgeon-{c} 1"), format!("\\fBgudgeon {c}\\fR")];
        assert!(parts.iter().all(|part| page.contains(part)), "{page}");
    }
    assert!(folder.join("man/man1/gudgeon-study-run.1").is_file());
    let _ = fs::remove_dir_all(&folder);
}
