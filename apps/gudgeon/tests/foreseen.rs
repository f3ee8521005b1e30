//! What can be known from the input is refused before anything runs, with exit code 2 and its place, and nothing is written; sizes are
//! bounded.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, Instant};

use serde_json::Value;

/// An empty folder of its own, removed at the end.
struct Folder(PathBuf);
impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("gudgeon-foreseen-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).expect("the temporary folder can be written");
        Self(path)
    }
    fn write(&self, name: &str, text: &str) {
        fs::write(self.0.join(name), text).expect("written");
    }
    fn run(&self, args: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_gudgeon"))
            .args(args)
            .current_dir(&self.0)
            .env("NO_COLOR", "1")
            .output()
            .expect("the program starts")
    }
    /// What is said when `run` and `check` refuse a case; nothing may be written.
    fn refused(&self, case: &str, set: &[&str]) -> String {
        let before = fs::read_dir(&self.0).expect("exists").count();
        let mut said = String::new();
        for command in ["check", "run"] {
            let mut args = vec![command, case];
            args.extend(set.iter().flat_map(|s| ["--set", s]));
            let o = self.run(&args);
            assert_eq!(o.status.code(), Some(2), "{args:?}: {}", stderr(&o));
            assert!(o.stdout.is_empty(), "{args:?}");
            said = flat(&stderr(&o));
        }
        assert_eq!(fs::read_dir(&self.0).expect("exists").count(), before, "nothing is written");
        said
    }
}
impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}
fn stderr(o: &Output) -> String {
    String::from_utf8_lossy(&o.stderr).into_owned()
}
/// Without the line breaks and bars that long messages get.
fn flat(text: &str) -> String {
    text.replace(['│', '╰', '╭', '·'], " ").split_whitespace().collect::<Vec<_>>().join(" ")
}
fn base() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/broken/base.toml");
    fs::read_to_string(path).expect("the base is in the repository")
}
fn case(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases").join(name).display().to_string()
}
fn holds(said: &str, parts: &[&str]) {
    for part in parts {
        assert!(said.contains(part), "`{part}` is not in: {said}");
    }
}

#[test]
fn an_end_gap_that_closes_hot() {
    let folder = Folder::new("gap");
    let said = folder.refused(&case("turbo-diesel-120.toml"), &["liner.distortion=[]"]);
    holds(
        &said,
        &["rings.0.cold_gap", "the end gap of ring 1 closes when hot", "by which the ring grows from 20 to"],
    );
    holds(&said, &["the growth of the liner is missing", "`[[liner.distortion]]`"]);
    folder.write("case.toml", &base());
    // The base has 0.4 mm cold; the ring grows by 0.449 mm to 150 degC and the liner gives at least 0.157 mm.
    let said = folder.refused("case.toml", &["rings.1.temperature=\"200 degC\""]);
    holds(
        &said,
        &["rings.1.cold_gap", "the end gap of ring 2 closes when hot", "where the liner grows least"],
    );
    // Gas that is given instead of computed passes no gap.
    let gas = "models.gas_flow={ model = \"prescribed\", lands = [\"3 bar\"] }";
    let o = folder.run(&["check", "case.toml", "--set", "rings.1.temperature=\"200 degC\"", "--set", gas]);
    let other = stderr(&o);
    assert!(!other.contains("closes when hot"), "{other}");
}

#[test]
fn every_value_of_a_sweep() {
    let folder = Folder::new("sweep");
    let with = |sweep: &str| folder.write("case.toml", &format!("{}\n{sweep}", base()));
    with(
        "[[sweeps]]\npath = \"rings.1.temperature\"\nvalues = [\n\"150 degC\",\n\"160 degC\",\n\"210 degC\",\n]\n",
    );
    // A gap that closes is no mistake of the file: its point is left out by the run, and told.
    let o = folder.run(&["check", "case.toml"]);
    assert!(o.status.success(), "{}", stderr(&o));
    let o = folder.run(&["run", "case.toml", "--set", "models.oil_transport.model=off", "--out", "left-out"]);
    assert!(o.status.success(), "{}", stderr(&o));
    let told = String::from_utf8_lossy(&o.stdout);
    holds(
        &told,
        &["1 of 3 points of the sweep", "left out, for it cannot be", "the end gap of ring 2 closes"],
    );
    // Values that all make none are.
    with("[[sweeps]]\npath = \"rings.1.temperature\"\nvalues = [\"200 degC\", \"210 degC\"]\n");
    let said = folder.refused("case.toml", &[]);
    holds(&said, &["sweeps.0", "2 of 2 points cannot be run", "rings.1.cold_gap: the end gap of ring 2"]);
    with("[[sweeps]]\npath = \"engine.bore\"\nvalues = [\"100 mm\", \"100 bar\"]\n");
    holds(&folder.refused("case.toml", &[]), &["sweeps.0.values.1", "`bar` is not a unit of a length"]);
    with("[[sweeps]]\npath = \"rings.1.temperature\"\nfrom = \"250 degC\"\nto = \"300 degC\"\npoints = 9\n");
    holds(&folder.refused("case.toml", &[]), &["sweeps.0:", "9 of 9 points cannot be run"]);
    // Of two sweeps the one that is to blame.
    with(
        "[[sweeps]]\npath = \"engine.speed\"\nvalues = [\"1000 rpm\", \"2000 rpm\"]\n\
         [[sweeps]]\npath = \"models.gas_flow.model\"\nvalues = [\"narrow_channel\", \"banana\"]\n",
    );
    let said = folder.refused("case.toml", &[]);
    holds(&said, &["sweeps.1.values.1", "2 of 4 points", "there is no gas_flow model `banana`"]);
    // However many points there are, a thousand of them are tried: on a rig, which is built in no time.
    let rig = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/rigs/lubricant.toml");
    let rig = fs::read_to_string(rig).expect("shipped");
    let one = rig.split("[[sweeps]]").next().unwrap_or_default();
    let many = "[[sweeps]]\npath = \"rig.pressure\"\nfrom = \"0 MPa\"\nto = \"500 MPa\"\npoints = 100000\n";
    folder.write("case.toml", &format!("{one}{many}"));
    let o = folder.run(&["check", "case.toml"]);
    assert!(o.status.success(), "{}", stderr(&o));
}

#[test]
fn results_that_the_case_does_not_have() {
    let folder = Folder::new("results");
    let sweep =
        "[[sweeps]]\npath = \"engine.speed\"\nvalues = [\"1000 rpm\"]\nresults = [\"blow_by\", \"blowby\"]\n";
    folder.write("case.toml", &format!("{}\n{sweep}", base()));
    let said = folder.refused("case.toml", &[]);
    holds(&said, &["sweeps.0.results.1: there is no result `blowby`", "did you mean `blow_by`?"]);
    folder.write("case.toml", &base());
    let o = folder.run(&["bench", "case.toml", "--results", "blow_by,blowby"]);
    assert_eq!(o.status.code(), Some(2));
    holds(&flat(&stderr(&o)), &["there is no result `blowby`", "did you mean `blow_by`?"]);
    // A result that is not among the wanted ones is not there either.
    let o =
        folder.run(&["bench", "case.toml", "--set", "outputs.results=[\"blow_by\"]", "--results", "fmep"]);
    assert_eq!(o.status.code(), Some(2));
    assert!(!folder.0.join("out").exists());
}

#[test]
fn contenders_that_are_none() {
    let folder = Folder::new("contenders");
    folder.write("case.toml", &base());
    for (contender, said) in [
        ("gas_flow=narow_channel", "did you mean `narrow_channel`?"),
        ("models.gas_flov=narrow_channel", "did you mean `gas_flow`?"),
        // In the option that was written, not in `--set`.
        ("gas_flow=narow_channel", "--contender:1:23"),
        ("gas_flow", "is not a path with values"),
        ("gas_flow=a,,b", "has an empty value"),
    ] {
        let o = folder.run(&["bench", "case.toml", "--contender", contender]);
        assert_eq!(o.status.code(), Some(2), "{contender}");
        holds(&flat(&stderr(&o)), &[said]);
        assert!(!stderr(&o).contains("--set"), "{}", stderr(&o));
    }
    // A change of the case itself is one of `--set` all the same, and a value of `compare` one of `--swap`.
    let o = folder.run(&[
        "bench",
        "case.toml",
        "--set",
        "engine.speed=1 bar",
        "--contender",
        "gas_flow=narow_channel",
    ]);
    holds(&stderr(&o), &["--set:1:"]);
    let o = folder.run(&[
        "compare",
        "case.toml",
        "--set",
        "engine.speed=1500 rpm",
        "--swap",
        "gas_flow=narow_channel",
    ]);
    assert_eq!(o.status.code(), Some(2));
    holds(&stderr(&o), &["--swap:1:23"]);
    assert!(!folder.0.join("out").exists(), "nothing is written");
}

#[test]
fn several_cases_have_a_folder_each_and_a_summary() {
    let folder = Folder::new("several");
    let cases = [case("rigs/slider-straight.toml"), case("rigs/flank-landing.toml")];
    let o = folder.run(&["bench", &cases[0], &cases[1], "--out", "raced"]);
    assert_eq!(o.status.code(), Some(0), "{}", stderr(&o));
    for name in ["slider-straight", "flank-landing"] {
        for file in ["bench.json", "bench.csv", "report.html"] {
            assert!(folder.0.join("raced").join(name).join(file).is_file(), "{name}/{file}");
        }
    }
    let told = String::from_utf8_lossy(&o.stdout).into_owned();
    let summary: Vec<&str> = told.lines().rev().take(3).collect();
    assert!(summary[2].contains("achieved/asked") && summary[2].contains("worst error"), "{told}");
    assert!(summary.iter().take(2).all(|line| line.contains("reached")), "{told}");
}

#[test]
fn benches_that_ask_a_film_for_what_it_does_not_know() {
    let folder = Folder::new("films");
    let starved = case("rigs/slider-starved.toml");
    for model in ["elrod_adams", "complementarity\", cavitation = \"half_sommerfeld"] {
        let set = format!("rig.film_1d={{ model = \"{model}\" }}");
        let said = folder.refused(&starved, &["sweeps=[]", &set]);
        holds(&said, &["rig.left.oil_film", "knows no inlet that starves", "front_tracking"]);
    }
    let squeeze = case("rigs/squeeze-plates.toml");
    let said = folder.refused(&squeeze, &["sweeps=[]", "rig.film_1d={ model = \"front_tracking\" }"]);
    holds(&said, &["rig.film_1d.model", "`front_tracking` knows no gap that changes in this way"]);
}

#[test]
fn pins_that_no_search_can_find() {
    let folder = Folder::new("pins");
    let pin = case("pin-85-alcohol-optimise.toml");
    let said = folder.refused(
        &pin,
        &["optimise.outer={ from = \"10 mm\", to = \"12 mm\" }", "optimise.stock.length_step=\"1 mm\""],
    );
    holds(&said, &["optimise.outer: no pin of the ranges keeps the limits", "outer diameter of 12.0000 mm"]);
    // What could be cannot be refused.
    let o = folder.run(&["check", &pin]);
    assert!(o.status.success(), "{}", stderr(&o));
    let said = folder.refused(
        &case("pin-85-alcohol-optimise-as-published.toml"),
        &["pin.outer=\"15 mm\"", "pin.inner=\"9 mm\""],
    );
    holds(&said, &["pin.outer: no pin of 15.0000 mm outer diameter keeps the limits"]);
}

#[test]
fn memory_of_a_speed_range() {
    let folder = Folder::new("range");
    let said = folder.refused(&case("geared-train.toml"), &["range.orders=2000", "range.points=20000"]);
    holds(&said, &["range.points: 20000 speeds of 2000 orders in 13 shafts", "at most 2e7", "fewer points"]);
}

#[test]
fn a_cylinder_that_names_itself() {
    let folder = Folder::new("self");
    folder.write(
        "case.toml",
        "scene = \"power_cylinder\"\n[ring_pack]\ncase = \"case.toml\"\n[piston_secondary]\ncase = \"case.toml\"\n",
    );
    let said = folder.refused("case.toml", &[]);
    holds(&said, &["ring_pack.case", "must be a case of the scene `ring_pack`", "case.toml:3:8"]);
}

#[test]
fn combinations_of_a_comparison() {
    let folder = Folder::new("combinations");
    folder.write("case.toml", &base());
    let values: Vec<String> = (1..=40).map(|k| format!("{k}000 rpm")).collect();
    let swap = format!("engine.speed={}", values.join(","));
    let o = folder.run(&["compare", "case.toml", "--swap", &swap, "--swap", &swap, "--swap", &swap]);
    assert_eq!(o.status.code(), Some(2), "{}", stderr(&o));
    holds(&flat(&stderr(&o)), &["the swaps make 64000 combinations, at most 1000 are compared"]);
    assert!(!folder.0.join("out").exists());
}

/// Files that once took more than twenty seconds each; a tenth of their size takes a hundredth of a square law. The bound is for a busy
/// machine: on a free one each is read in a tenth of it.
#[test]
fn long_files_with_one_mistake_a_line() {
    let folder = Folder::new("long");
    let lines = 100_000;
    let numbered = |f: &dyn Fn(usize) -> String| (0..lines).map(f).collect::<String>();
    for (name, text, least) in [
        ("keys", format!("scene = \"ring_pack\"\n{}", "title = \"x\"\n".repeat(lines)), 50),
        ("tables", format!("scene = \"ring_pack\"\n{}", numbered(&|k| format!("[t{k}]\n"))), 50),
        ("table", format!("scene = \"ring_pack\"\n{}", "[t]\n".repeat(lines)), 1),
        ("rings", format!("{}\n{}", base(), "[[rings]]\n".repeat(lines)), 1),
        ("names", numbered(&|k| format!("key{k} = {k}\n")), 50),
    ] {
        folder.write("case.toml", &text);
        let begin = Instant::now();
        let o = folder.run(&["check", "case.toml", "--json"]);
        let took = begin.elapsed();
        assert_eq!(o.status.code(), Some(2), "{name}");
        let v: Value = serde_json::from_slice(&o.stdout).expect("JSON on standard output");
        let found = v["mistakes"].as_array().expect("a list").len();
        assert!((least..=50).contains(&found), "{name}: {found} mistakes");
        assert!(o.stderr.len() < 100_000, "{name}: {} bytes", o.stderr.len());
        assert!(took < Duration::from_secs(10), "{name}: {took:?}");
    }
    folder.write("case.toml", &" ".repeat((4 << 20) + 1));
    holds(&folder.refused("case.toml", &[]), &["is too large to be a case file", "at most 4 MiB"]);
}

#[cfg(unix)]
#[test]
fn files_that_are_none() {
    let folder = Folder::new("special");
    let fifo = folder.0.join("pipe");
    let made = Command::new("mkfifo").arg(&fifo).status();
    let pipe = if made.is_ok_and(|s| s.success()) { "pipe" } else { "/dev/zero" };
    for name in [pipe, "/dev/zero"] {
        holds(&folder.refused(name, &[]), &["no regular file but a pipe, a socket or a device"]);
    }
    folder.write("case.toml", &base());
    let set = format!("models.cylinder_pressure={{ model = \"table\", file = \"{pipe}\" }}");
    holds(&folder.refused("case.toml", &[&set]), &["models.cylinder_pressure.file", "no regular file"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_device_is_a_failure() {
    let full = || fs::OpenOptions::new().write(true).open("/dev/full").expect("there is one");
    for args in [&["models", "--json"][..], &["schema"], &["describe", "rig/slider"]] {
        let o = Command::new(env!("CARGO_BIN_EXE_gudgeon"))
            .args(args)
            .stdout(full())
            .output()
            .expect("the program starts");
        assert_eq!(o.status.code(), Some(1), "{args:?}");
        holds(&stderr(&o), &["standard output could not be written"]);
    }
}

#[test]
fn results_stay_inside_their_folder() {
    let folder = Folder::new("dots");
    folder.write("...toml", &base());
    let o = folder.run(&["run", "...toml", "--set", "outputs.results=[\"blow_by\"]", "--quiet"]);
    assert!(o.status.success(), "{}", stderr(&o));
    assert!(folder.0.join("out/case/summary.json").is_file() && !folder.0.join("summary.json").exists());
}

#[test]
fn values_that_no_ring_pack_has() {
    let folder = Folder::new("plausible");
    folder.write("case.toml", &base());
    let impossible = [
        ("rings.0.cold_gap=\"450 mm\"", "of the bore"),
        ("rings.0.tangential_force=\"30000 N\"", "more than steel carries"),
        ("rings.0.mass=\"9 kg\"", "osmium"),
        ("rings.0.face.drop=\"9 mm\"", "of drop on a face"),
        ("engine.bore=120", "did you mean `\"120 mm\"`?"),
        ("rings.1.cold_gap=0.45", "did you mean `\"0.45 mm\"`?"),
    ];
    for (set, said) in impossible {
        let told = folder.refused("case.toml", &[set]);
        holds(&told, &[set.split('=').next().expect("a path"), said, "usual: "]);
        assert!(
            told.contains("1 mistake") || told.matches('×').count() == 1,
            "no mistakes that follow from it: {told}"
        );
    }
    let unusual = [
        ("rings.0.gap=\"9 mm\"", "`rings.0.gap`: 9 mm of end gap"),
        ("rings.0.tangential_force=\"900 N\"", "`rings.0.tangential_force`: 900 N press the ring"),
        ("engine.speed=2000", "mean piston speed"),
        ("gas.crankcase_pressure=\"0.02 bar\"", "`gas.crankcase_pressure`"),
    ];
    for (set, said) in unusual {
        let o = folder.run(&["check", "case.toml", "--set", set]);
        assert!(o.status.success() && flat(&stderr(&o)).contains(said), "{set}: {}", stderr(&o));
    }
    let o = folder.run(&["check", "case.toml"]);
    assert!(
        o.status.success() && o.stderr.is_empty(),
        "nothing is odd about the case itself: {}",
        stderr(&o)
    );
}
