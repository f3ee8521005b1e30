//! What the terminal tells of sweeps and comparisons: every variant, and how results go.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Runs the program on a case of the repository, results into a folder that is taken away again.
fn gudgeon(name: &str, command: &str, case: &str, args: &[&str], locale: &str) -> Output {
    let out: PathBuf = std::env::temp_dir().join(format!("gudgeon-trends-{name}-{}", std::process::id()));
    let _ = fs::remove_dir_all(&out);
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../cases/{case}.toml"));
    let mut c = Command::new(env!("CARGO_BIN_EXE_gudgeon"));
    c.arg(command).arg(case).args(args).arg("--out").arg(&out).env("LC_ALL", locale).env_remove("NO_COLOR");
    let o = c.output().expect("the program starts");
    let _ = fs::remove_dir_all(&out);
    o
}
fn stdout(o: &Output) -> String {
    assert!(o.status.success(), "{}", String::from_utf8_lossy(&o.stderr));
    String::from_utf8(o.stdout.clone()).expect("text")
}

/// The line of a table that begins with a word.
fn row<'a>(text: &'a str, first: &str) -> Vec<&'a str> {
    // The table of trends comes after that of the results, which begins with the same words.
    let found = text
        .lines()
        .rev()
        .map(|l| l.split_whitespace().collect::<Vec<_>>())
        .find(|w| w.first() == Some(&first));
    found.unwrap_or_else(|| panic!("no `{first}` in {text}"))
}

#[test]
fn a_sweep_of_one_input_tells_how_results_go() {
    let text = stdout(&gudgeon("one", "run", "rigs/slider-2d-exponential", &[], "C.UTF-8"));
    assert!(text.contains("Over rig.intervals_x; change from the first to the last"), "{text}");
    assert_eq!(row(&text, "rig.intervals_x"), ["rig.intervals_x", "8", "16", "32", "64", "128", "256"]);
    // A finer grid finds more load, ever less of it; six values, the first the lowest and the last the highest.
    let load = row(&text, "load");
    assert_eq!((load.len(), load[7], load[8]), (11, "72.399", "rises"), "{load:?}");
    assert!(load[9].starts_with('+') && load[10] == "%", "{load:?}");
    // Another program gets the same text whatever the locale; blocks are for terminals.
    assert_eq!(
        without_times(&text),
        without_times(&stdout(&gudgeon("c", "run", "rigs/slider-2d-exponential", &[], "C")))
    );
    assert!(text.is_ascii(), "{text}");
}

/// Lines with wall times and folders differ from run to run.
fn without_times(text: &str) -> Vec<&str> {
    text.lines().filter(|l| !l.contains(" runs, ") && !l.contains("report.html")).collect()
}

#[test]
fn a_sweep_of_two_inputs_is_a_grid_each() {
    let text = stdout(&gudgeon("two", "run", "rigs/lubricant", &[], "C"));
    assert!(text.contains("viscosity [mPa s] over rig.pressure [MPa]"), "{text}");
    // Every value of the second input, by the name of its model, and 6 of the 51 pressures.
    for model in ["barus", "roelands", "off"] {
        assert!(row(&text, model).len() >= 8, "{text}");
    }
    assert!(text.contains("least 9.5904 at 0, barus; greatest 77712 at 500, barus"), "{text}");
    // 18 values of the second input: twelve lines and a word on the others.
    let sweeps = "sweeps=[{ path = \"rig.pressure\", from = \"0 MPa\", to = \"100 MPa\", points = 3, results = [\"viscosity\"] }, \
                  { path = \"rig.temperature\", from = \"40 degC\", to = \"125 degC\", points = 18 }]";
    let text = stdout(&gudgeon("map", "run", "rigs/lubricant", &["--set", sweeps], "C"));
    assert!(text.contains("6 more values of rig.temperature in sweep.csv"), "{text}");
    assert_eq!(text.lines().filter(|l| l.trim_end().ends_with('%')).count(), 12, "{text}");
}

#[test]
fn a_comparison_tells_every_combination() {
    let speeds = "rig.speed=1 m/s,2 m/s,3 m/s,4 m/s,5 m/s,6 m/s,7 m/s";
    let text = stdout(&gudgeon("all", "compare", "rigs/slider-straight", &["--swap", speeds], "C"));
    for n in 1..=7 {
        let line =
            text.lines().rev().find(|l| l.trim_start().starts_with(&format!("({n})"))).expect("a line each");
        assert!(line.trim_end().ends_with(&format!("rig.speed={n} m/s")), "{line}");
        assert!(n == 1 || line.contains('%'), "the change to the first: {line}");
    }
    assert!(text.contains("more results in the report"), "{text}");
    // Results that are named, and no others.
    let text = stdout(&gudgeon(
        "named",
        "compare",
        "rigs/slider-straight",
        &["--swap", speeds, "--results", "load"],
        "C",
    ));
    let head = text.lines().find(|l| l.contains("load [")).expect("a head");
    assert_eq!(head.split_whitespace().count(), 2, "{head}");
    // Few combinations stand side by side with all their results.
    let text =
        stdout(&gudgeon("few", "compare", "rigs/slider-straight", &["--swap", "rig.speed=1 m/s,2 m/s"], "C"));
    assert!(text.contains("to (1)") && !text.contains("more results in the report"), "{text}");
}
