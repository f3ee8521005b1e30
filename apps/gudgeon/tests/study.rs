//! `gudgeon study`: folders that are filled by threads, by arrays of jobs, and after a kill, always with the same bytes.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn gudgeon(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_gudgeon"))
        .args(args)
        .current_dir(root())
        .output()
        .expect("the program starts")
}

fn done(args: &[&str]) -> String {
    let out = gudgeon(args);
    assert!(out.status.success(), "{args:?}: {}", String::from_utf8_lossy(&out.stderr));
    String::from_utf8(out.stdout).expect("text")
}

/// A folder of this test alone.
fn folder(name: &str) -> PathBuf {
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("study-{name}"));
    let _ = fs::remove_dir_all(&dir);
    fs::create_dir_all(&dir).expect("a folder");
    dir
}

/// A study file in `dir` on a slider of 25 panels, whose runs take a millisecond.
fn study_file(dir: &Path, more: &str) -> String {
    let case = root().join("cases/rigs/slider-barrel.toml").canonicalize().expect("the case");
    let text = format!("cases = [\"{}\"]\nset = [\"rig.panels=25\"]\n{more}", case.display());
    let path = dir.join("study.toml");
    fs::write(&path, text).expect("written");
    path.display().to_string()
}

/// 2 x 60 points in parts of 10.
const GRID: &str = r#"
results = ["load", "moving_shear"]
part = 10
[[inputs]]
path = "rig.film_1d.model"
values = ["front_tracking", "complementarity"]
[[inputs]]
path = "rig.speed"
from = "1 m/s"
to = "60 m/s"
points = 60
"#;

/// The parts of a study, by name.
fn parts(study: &str) -> BTreeMap<String, Vec<u8>> {
    let all = fs::read_dir(Path::new(study).join("parts")).expect("parts").filter_map(Result::ok);
    let named = all.map(|e| (e.file_name().to_string_lossy().into_owned(), e.path()));
    // Parts that are being written are hidden, and gone the next moment.
    let done = named.filter(|(name, _)| !name.starts_with('.'));
    done.map(|(name, path)| (name, fs::read(path).expect("read"))).collect()
}

/// A study of `more`, made in a folder of its own.
fn made(name: &str, more: &str) -> (PathBuf, String) {
    let dir = folder(name);
    let study = dir.join("out").display().to_string();
    done(&["study", "new", &study, &study_file(&dir, more)]);
    (dir, study)
}

#[test]
fn threads_and_jobs_make_the_same_bytes() {
    let (_, alone) = made("alone", GRID);
    done(&["study", "run", &alone, "--threads", "1"]);
    let wanted = parts(&alone);
    assert_eq!(wanted.len(), 12);

    let (_, threads) = made("threads", GRID);
    done(&["study", "run", &threads, "--threads", "3"]);
    assert!(parts(&threads) == wanted, "three threads");

    let (_, jobs) = made("jobs", GRID);
    for job in ["3/3", "1/3"] {
        done(&["study", "run", &jobs, "--part", job]);
    }
    assert!(done(&["study", "status", &jobs]).starts_with("80 of 120 points done, 8 of 12 parts"));
    assert_eq!(gudgeon(&["study", "collect", &jobs]).status.code(), Some(2), "parts are missing");
    done(&["study", "run", &jobs]);
    assert!(parts(&jobs) == wanted, "three jobs");

    let told = done(&["study", "collect", &jobs, "--csv"]);
    assert!(told.contains("120 rows") && told.contains("share of the variance"), "{told}");
    let table = fs::read_to_string(Path::new(&jobs).join("table.csv")).expect("a table");
    let mut lines = table.lines();
    assert_eq!(
        lines.next(),
        Some(
            "point,case,rig.film_1d.model,rig.speed [m/s],code,message,wrong,notes,reservations,load [N/m],moving_shear [N/m]"
        )
    );
    assert!(lines.next().is_some_and(|l| l.starts_with("0,slider-barrel,front_tracking,1,,,,,")));
    assert_eq!(lines.count(), 119);
}

#[test]
fn a_study_that_was_killed_goes_on() {
    // 40 points of some 20 ms each.
    let more = GRID
        .replace("\"front_tracking\", \"complementarity\"", "\"elrod_adams\"")
        .replace("points = 60", "points = 40");
    let (_, whole) = made("whole", &more);
    done(&["study", "run", &whole]);

    let (_, killed) = made("killed", &more);
    for _ in 0..2 {
        let before = parts(&killed).len();
        let mut child = Command::new(env!("CARGO_BIN_EXE_gudgeon"))
            .args(["study", "run", &killed, "--threads", "1", "--quiet"])
            .stderr(Stdio::null())
            .spawn()
            .expect("the program starts");
        while parts(&killed).len() == before && child.try_wait().expect("its state").is_none() {
            std::thread::sleep(Duration::from_millis(1));
        }
        // SIGKILL on Unix: nothing can be put in order.
        child.kill().expect("killed");
        child.wait().expect("ended");
    }
    done(&["study", "run", &killed]);
    assert!(parts(&killed) == parts(&whole));
}

#[test]
fn a_damaged_part_and_one_of_another_study_are_run_again() {
    let (_, study) = made("damaged", GRID);
    done(&["study", "run", &study]);
    let wanted = parts(&study);
    let (_, other) = made("other", &GRID.replace("60 m/s", "61 m/s"));
    done(&["study", "run", &other]);
    let place = |study: &str, k: usize| Path::new(study).join(format!("parts/part-{k:06}.parquet"));
    fs::write(place(&study, 3), b"PAR1").expect("written");
    fs::copy(place(&other, 5), place(&study, 5)).expect("copied");
    assert!(done(&["study", "status", &study]).starts_with("100 of 120 points"));
    done(&["study", "run", &study]);
    assert!(parts(&study) == wanted);
}

#[cfg(unix)]
#[test]
fn the_scripts_for_clusters_fill_the_folder() {
    let (_, wanted) = made("script-wanted", GRID);
    done(&["study", "run", &wanted]);
    let stand_in = root().join("apps/gudgeon/tests/stand_in");
    let scripts: [(&str, &[&str]); 2] = [
        ("slurm", &["sbatch", "--array=1-5", "cases/studies/slurm-array.sh"]),
        ("hyperqueue", &["bash", "cases/studies/hyperqueue.sh"]),
    ];
    for (name, command) in scripts {
        let (_, study) = made(name, GRID);
        let path = format!("{}:{}", stand_in.display(), std::env::var("PATH").unwrap_or_default());
        let out = Command::new("env")
            .args(command)
            .arg(&study)
            .args((name == "hyperqueue").then_some("4"))
            .env("PATH", path)
            .env("GUDGEON", env!("CARGO_BIN_EXE_gudgeon"))
            .current_dir(root())
            .output()
            .expect("the script starts");
        assert!(out.status.success(), "{name}: {}", String::from_utf8_lossy(&out.stderr));
        assert!(parts(&study) == parts(&wanted), "{name}");
    }
}

#[test]
fn lists_cases_failures_and_curves() {
    let dir = folder("list");
    fs::write(
        dir.join("points.csv"),
        "rig.speed [m/s], rig.viscosity\n# a comment\n1, 10 mPa s\n2, 20 mPa s\n3, thin\n",
    )
    .expect("written");
    let case = root().join("cases/rigs/slider-barrel.toml").canonicalize().expect("the case");
    let text = format!(
        "list = \"points.csv\"\ncurves = [\"p\"]\nresults = [\"load\"]\n\
         cases = [{{ file = \"{0}\", name = \"coarse\", set = [\"rig.panels=25\"] }}, {{ file = \"{0}\", name = \"fine\" }}]\n",
        case.display()
    );
    let file = dir.join("study.toml");
    fs::write(&file, text).expect("written");
    let study = dir.join("out").display().to_string();
    done(&["study", "new", &study, &file.display().to_string()]);
    let ran = gudgeon(&["study", "run", &study]);
    assert_eq!(ran.status.code(), Some(1), "two points failed");
    done(&["study", "collect", &study, "--csv", "--quiet"]);
    let table = fs::read_to_string(Path::new(&study).join("table.csv")).expect("a table");
    let rows: Vec<&str> = table.lines().collect();
    assert_eq!(
        rows[0],
        "point,case,rig.speed [m/s],rig.viscosity,code,message,wrong,notes,reservations,load [N/m]"
    );
    assert!(rows[2].starts_with("1,coarse,2,20 mPa s,,,,,"), "{}", rows[2]);
    assert!(
        rows[3].starts_with("2,coarse,3,thin,refused,") && rows[3].contains("rig.viscosity"),
        "{}",
        rows[3]
    );
    assert!(rows[4].starts_with("3,fine,1,10 mPa s,"), "{}", rows[4]);
    assert!(parts(&study).contains_key("curves-000000.parquet"));
    // Two of six combinations have no result: the shares are those of the four others, in text, JSON and page.
    let told = done(&["study", "collect", &study]);
    let without = "without list=row 3: not all points with it have a result to use";
    assert!(told.contains("2 of 6 points failed") && told.contains(without), "{told}");
    assert!(told.contains("case × list"), "{told}");
    let read = |name: &str| fs::read_to_string(Path::new(&study).join(name)).expect("written");
    let all: serde_json::Value = serde_json::from_str(&read("analysis.json")).expect("JSON");
    let shares = &all["groups"][0]["results"][0]["dependence"]["shares"];
    assert_eq!(shares["points"], 4);
    assert_eq!(shares["left_out"], serde_json::json!(["list=row 3"]));
    let sum: f64 =
        shares["effects"].as_array().expect("effects").iter().filter_map(|e| e["share"].as_f64()).sum();
    // Sums of four numbers.
    assert!((sum - 1.0).abs() < 1e-14, "{shares}");
    assert!(read("report.html").contains(without));
}

#[test]
fn a_grid_of_one_good_point_has_no_shares() {
    let more = "results = [\"load\"]\n[[inputs]]\npath = \"rig.speed\"\nvalues = [\"1 m/s\", \"fast\", \"faster\"]\n";
    let (_, study) = made("one-good", more);
    assert_eq!(gudgeon(&["study", "run", &study]).status.code(), Some(1), "two points failed");
    let told = done(&["study", "collect", &study]);
    assert!(told.contains("too few points have this result to tell any input apart"), "{told}");
}

#[test]
fn a_wrong_study_is_refused_with_its_place_and_nothing_is_made() {
    let dir = folder("wrong");
    let study = dir.join("out").display().to_string();
    let design = "[design]\nmethod = \"sobol\"\npoints = 8\n[[inputs]]\npath = \"rig.speed\"\n";
    let wrong: [(&str, &str); 12] = [
        (
            "results = [\"lod\"]\n[[inputs]]\npath = \"rig.speed\"\nvalues = [\"1 m/s\"]\n",
            "did you mean `load`",
        ),
        ("[[inputs]]\npath = \"rig.sped\"\nvalues = [\"1 m/s\"]\n", "rig.sped"),
        ("[[inputs]]\npath = \"rig.speed\"\nfrom = \"1 m/s\"\nto = \"2 m\"\npoints = 3\n", "same unit"),
        (
            "[[inputs]]\npath = \"rig.speed\"\nvalues = [\"1 m/s\"]\ndistribution = { shape = \"uniform\", from = \"1 m/s\", to = \"2 m/s\" }\n",
            "design",
        ),
        (
            &format!(
                "{design}distribution = {{ shape = \"normal\", mean = \"1 m/s\", deviation = \"-1 m/s\" }}\n"
            ),
            "deviation",
        ),
        (
            &format!(
                "{design}distribution = {{ shape = \"nrmal\", mean = \"1 m/s\", deviation = \"1 m/s\" }}\n"
            ),
            "normal",
        ),
        (&format!("{design}from = \"1 m/s\"\n"), "to"),
        ("list = \"nothing.csv\"\n", "nothing.csv"),
        // Keys that an input shares with a sweep.
        (
            "[[inputs]]\npath = \"rig.speed\"\nvalue = [\"1 m/s\"]\n",
            "did you mean `values`? valid: `path`, `values`, `from`, `to`, `points`, `spacing`, `distribution`",
        ),
        (
            "[[inputs]]\npath = \"rig.speed\"\nfrom = \"1 m/s\"\nto = \"2 m/s\"\npoints = \"many\"\n",
            "inputs.0.points",
        ),
        ("[[inputs]]\nvalues = [\"1 m/s\"]\n", "inputs.0: missing key `path`"),
        (
            "[[inputs]]\npath = \"rig.speed\"\nvalues = [\"1 m/s\"]\nresults = [\"load\"]\n",
            "inputs.0: unknown key `results`",
        ),
    ];
    for (more, told) in wrong {
        let out = gudgeon(&["study", "new", &study, &study_file(&dir, more)]);
        let said = String::from_utf8_lossy(&out.stderr).into_owned();
        assert_eq!(out.status.code(), Some(2), "{more}: {said}");
        assert!(said.contains(told) && said.contains("study.toml:"), "{more}: {said}");
        assert!(!Path::new(&study).exists(), "{more}");
    }
}

#[test]
fn a_linear_study_tells_spread_and_shares() {
    // The load of a slider goes with speed and viscosity alike (cavitation apart): equal relative deviations have equal parts of the variance.
    let more = "results = [\"load\"]\n[design]\nmethod = \"linear\"\n\
                [[inputs]]\npath = \"rig.speed\"\ndistribution = { shape = \"normal\", mean = \"10 m/s\", deviation = \"0.1 m/s\" }\n\
                [[inputs]]\npath = \"rig.viscosity\"\ndistribution = { shape = \"normal\", mean = \"10 mPa s\", deviation = \"0.1 mPa s\" }\n";
    let (_, study) = made("linear", more);
    done(&["study", "run", &study]);
    done(&["study", "collect", &study, "--quiet"]);
    let text = fs::read_to_string(Path::new(&study).join("analysis.json")).expect("an analysis");
    let all: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let linear = &all["groups"][0]["results"][0]["dependence"]["linear"];
    for k in 0..2 {
        let share = linear["inputs"][k]["share"].as_f64().expect("a share");
        // Both enter as their product; the differences of runs behind the derivatives have errors of 1e-6.
        assert!((share - 0.5).abs() < 1e-4, "{linear}");
    }
    let (value, deviation) =
        (linear["value"].as_f64().expect("load"), linear["deviation"].as_f64().expect("deviation"));
    assert!(deviation > 0.005 * value && deviation < 0.03 * value, "{linear}");
    let words = "[design]\nmethod = \"linear\"\n[[inputs]]\npath = \"rig.film_1d.model\"\nvalues = [\"front_tracking\"]\n";
    let dir = folder("linear-words");
    let out = gudgeon(&["study", "new", &dir.join("out").display().to_string(), &study_file(&dir, words)]);
    assert!(String::from_utf8_lossy(&out.stderr).contains("nothing is differentiated by a choice"));
}

#[test]
fn every_shipped_study_can_be_made() {
    let dir = folder("shipped");
    let mut seen = 0;
    for entry in fs::read_dir(root().join("cases/studies")).expect("the folder").filter_map(Result::ok) {
        let path = entry.path();
        if path.extension().is_some_and(|e| e == "toml") {
            let study = dir.join(path.file_stem().expect("a name")).display().to_string();
            done(&["study", "new", &study, &path.display().to_string()]);
            seen += 1;
        }
    }
    assert!(seen >= 4, "{seen} studies");
}

#[test]
fn a_folder_keeps_its_study() {
    let (dir, study) = made("kept", GRID);
    // The same once more is no mistake; another one is.
    done(&["study", "new", &study, &study_file(&dir, GRID)]);
    let other = gudgeon(&[
        "study",
        "new",
        &study,
        &study_file(&dir, &GRID.replace("61", "62").replace("60 m/s", "62 m/s")),
    ]);
    assert_eq!(other.status.code(), Some(2));
    let record = Path::new(&study).join("study.json");
    let text = fs::read_to_string(&record).expect("a record").replace("60 m/s", "99 m/s");
    fs::write(&record, text).expect("written");
    assert!(!gudgeon(&["study", "run", &study]).status.success());
}

#[test]
fn a_file_of_the_other_kind_is_named() {
    let dir = folder("kinds");
    let study = study_file(&dir, GRID);
    let case = root().join("cases/rigs/slider-barrel.toml").display().to_string();
    let out = dir.join("out").display().to_string();
    for (args, says) in [
        (vec!["run", &study], "this is the file of a study, not a case"),
        (vec!["study", "new", &out, &case], "this is a case, not the file of a study"),
        (vec!["study", "run", &study], "is a file, not the folder of a study"),
    ] {
        let o = gudgeon(&args);
        let told = String::from_utf8_lossy(&o.stderr);
        assert_eq!(o.status.code(), Some(2), "{args:?}: {told}");
        // One mistake, not one for every key that the other kind does not have.
        assert!(told.contains(says) && told.matches('×').count() == 1, "{args:?}: {told}");
    }
    assert!(!Path::new(&out).exists());
}
