//! Inputs far outside of what engines are: each one runs to finite results that close their gas balance, or is refused with a reason.
//! Nothing panics, nothing is NaN, nothing takes longer than a minute.

#![allow(clippy::print_stdout, reason = "what became of each case is for reading")]

use std::path::{Path, PathBuf};
use std::sync::mpsc;
use std::time::{Duration, Instant};

use crate::common::*;
use gudgeon_scene::{check, run};

const CASE: &str = "turbo-diesel-120/flooded";
const LIMIT: Duration = Duration::from_secs(60);

/// Runs one case and says what became of it; `Err` when that is not allowed.
fn outcome(path: &Path, overrides: &[String]) -> Result<String, String> {
    let (tell, told) = mpsc::channel();
    let (path, overrides) = (path.to_owned(), overrides.to_vec());
    let begin = Instant::now();
    std::thread::spawn(move || {
        let result = std::panic::catch_unwind(|| {
            let c = check(&path, &overrides).map_err(|r| {
                format!(
                    "refused: {}",
                    r.diagnostics.iter().map(|d| d.headline()).collect::<Vec<_>>().join("; ")
                )
            })?;
            run(&c, &mut gudgeon_scene::unwatched).map_err(|e| format!("failed: {e}"))
        });
        // Nobody listens any more when the time was up.
        let _ = tell.send(result);
    });
    let result = told.recv_timeout(LIMIT).map_err(|_| format!("not done after {} s", LIMIT.as_secs()))?;
    let seconds = begin.elapsed().as_secs_f64();
    let r = match result.map_err(|_| "it panicked".to_owned())? {
        Ok(r) => r,
        // A refusal names a cause: a place in the case, or a quantity; "failed: " alone would not do.
        // Between boundaries of positive pressure no volume can be emptied: an explicit march with too long steps may say so,
        // an implicit solver that does blames the wrong thing.
        Err(e) if e.contains("the integration stopped") && e.contains("holds a mass of") => {
            return Err(format!("a refusal that misses the cause: {e}"));
        }
        Err(e) if e.len() > 30 => return Ok(format!("{e} ({seconds:.1} s)")),
        Err(e) => return Err(format!("an unclear refusal: {e}")),
    };
    if let Some((k, v)) = r.results.iter().find(|(_, v)| !v.value.is_finite()) {
        return Err(format!("{k} is {}", v.value));
    }
    if let Some(c) = r.series.columns.iter().find(|c| c.values.iter().any(|v| !v.is_finite())) {
        return Err(format!("the column {} is not finite", c.name));
    }
    let closure = r.balance.gas_mass.unwrap_or(0.0);
    if closure > 1e-9 {
        return Err(format!("the gas balance closes to {closure:.1e} only"));
    }
    Ok(format!(
        "blow-by {:.3e} l/min, periodicity {:.0e}, closure {closure:.0e}, {} ({seconds:.1} s)",
        r.results.get("blow_by_per_cylinder").map_or(f64::NAN, |v| v.value),
        r.results.get("periodicity_error").map_or(f64::NAN, |v| v.value),
        if r.solver.notes.is_empty() {
            "no notes".to_owned()
        } else {
            r.solver.notes.iter().map(|n| n.text.as_str()).collect::<Vec<_>>().join("; ")
        },
    ))
}

/// Runs all, two at a time, and fails with a list of those that misbehaved.
fn all(cases: Vec<(String, PathBuf, Vec<String>)>) {
    let next = std::sync::atomic::AtomicUsize::new(0);
    let lines = std::sync::Mutex::new(vec![Ok(String::new()); cases.len()]);
    std::thread::scope(|s| {
        for _ in 0..2 {
            s.spawn(|| {
                loop {
                    let k = next.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
                    let Some((_, path, overrides)) = cases.get(k) else { break };
                    let o = outcome(path, overrides);
                    lines.lock().expect("no worker panics")[k] = o;
                }
            });
        }
    });
    let lines = lines.into_inner().expect("no worker panics");
    let mut bad = Vec::new();
    for ((name, ..), line) in cases.iter().zip(lines) {
        match line {
            Ok(l) => println!("{name}: {l}"),
            Err(l) => {
                println!("{name}: DEFECT: {l}");
                bad.push(format!("{name}: {l}"));
            }
        }
    }
    assert!(bad.is_empty(), "{} of {} cases misbehave:\n  {}", bad.len(), cases.len(), bad.join("\n  "));
}

fn set(name: &str, overrides: &[&str]) -> (String, PathBuf, Vec<String>) {
    let mut o = overrides_of(CASE, &["solver.max_cycles=10"]);
    o.extend(overrides.iter().map(|s| (*s).to_owned()));
    (name.to_owned(), case_file(CASE), o)
}

#[test]
fn speeds() {
    let at = |n: f64, more: &[&str]| {
        let speed = format!("engine.speed={n} rpm");
        set(&format!("{n} rpm {more:?}"), &[&[speed.as_str()], more].concat())
    };
    let mut cases: Vec<_> = [10.0, 20_000.0, 200_000.0].map(|n| at(n, &[])).into();
    // At 1 rpm the oil ring shuts and opens some thousand times a cycle, as it does at 10 rpm; oil that fills the groove keeps it from that.
    cases.push(at(1.0, &["models.flank.model=squeeze_film"]));
    all(cases);
}

#[test]
fn clearances() {
    all(vec![
        set(
            "axial clearances x 1e-3",
            &[
                "rings.0.groove.height=3.4145 mm",
                "rings.1.groove.height=3.00007 mm",
                "rings.2.groove.height=4.00005 mm",
            ],
        ),
        set(
            "axial clearances x 1e3",
            &[
                "rings.0.groove.height=103.4 mm",
                "rings.1.groove.height=73 mm",
                "rings.2.groove.height=54 mm",
                r#"liner.distortion=[{position="70 mm", diametral="0.2 mm"}, {position="-500 mm", diametral="0.12 mm"}]"#,
            ],
        ),
        set(
            "land clearances x 1e-3",
            &[
                "piston.lands.0.diameter=119.9993 mm",
                "piston.lands.1.diameter=119.9994 mm",
                "piston.lands.2.diameter=119.9995 mm",
            ],
        ),
        set(
            "land clearances x 1e3",
            &[
                "piston.lands.0.diameter=0.1 mm",
                "piston.lands.1.diameter=0.1 mm",
                "piston.lands.2.diameter=0.1 mm",
            ],
        ),
        set(
            "gap areas x 1e-3",
            &["rings.0.gap_area=0.0002 mm2", "rings.1.gap_area=0.0002 mm2", "rings.2.gap_area=0.0002 mm2"],
        ),
        set(
            "gap areas x 1e3",
            &["rings.0.gap_area=200 mm2", "rings.1.gap_area=200 mm2", "rings.2.gap_area=200 mm2"],
        ),
        set(
            "leak heights of 1 mm",
            &[
                "rings.0.groove.leak_upper=1 mm",
                "rings.0.groove.leak_lower=1 mm",
                "rings.1.groove.leak_upper=1 mm",
                "rings.1.groove.leak_lower=1 mm",
            ],
        ),
        set(
            "no leak at the flanks",
            &[
                "rings.0.groove.leak_upper=0 um",
                "rings.0.groove.leak_lower=0 um",
                "rings.1.groove.leak_upper=0 um",
                "rings.1.groove.leak_lower=0 um",
                "rings.2.groove.leak_upper=0 um",
            ],
        ),
    ]);
}

#[test]
fn volumes() {
    all(vec![
        set("lands x 1e-3", &["piston.lands.1.volume=0.9 mm3", "piston.lands.2.volume=0.4 mm3"]),
        set("lands x 1e3", &["piston.lands.1.volume=902 cm3", "piston.lands.2.volume=376 cm3"]),
        set("grooves x 1e-3", &["rings.0.groove.back_volume=1 mm3", "rings.1.groove.back_volume=1 mm3"]),
        set("grooves x 1e3", &["rings.0.groove.back_volume=1000 cm3", "rings.1.groove.back_volume=1000 cm3"]),
    ]);
}

#[test]
fn pressures() {
    let step = |from: f64, to: f64| {
        format!(
            "models.cylinder_pressure={{model=\"table\", unit=\"bar\", theta_deg=[0, 360, 360.01, 540, 540.01, 719], pressure=[{from}, {from}, {to}, {to}, {from}, {from}]}}"
        )
    };
    all(vec![
        set("a step of 100 bar within 0.01 deg", &[&step(1.0, 101.0)]),
        set("a step of 1000 bar within 0.01 deg", &[&step(1.0, 1001.0)]),
        set("a step down to 0.01 bar", &[&step(1.0, 0.01)]),
        set("constant cylinder pressure", &[&step(1.01325, 1.01325)]),
        set("start at 0.01 bar", &["solver.starts=[\"0.01 bar\"]"]),
        set("start at 1000 bar", &["solver.starts=[\"1000 bar\"]"]),
        set("crankcase at 0.001 bar", &["gas.crankcase_pressure=0.001 bar"]),
        set("crankcase at 100 bar", &["gas.crankcase_pressure=100 bar"]),
    ]);
}

#[test]
fn rings() {
    all(vec![
        set(
            "flat faces",
            &[
                "rings.0.face.drop=0 um",
                "rings.0.face.offset=0 mm",
                "rings.1.face.drop=0 um",
                "rings.2.face.drop=0 um",
                "rings.2.face.offset=0 mm",
            ],
        ),
        set(
            "barrels of 1 mm",
            &["rings.0.face.drop=1 mm", "rings.1.face.drop=1 mm", "rings.2.face.drop=1 mm"],
        ),
        set("masses x 1e-3", &["rings.0.mass=43 mg", "rings.1.mass=37 mg", "rings.2.mass=44 mg"]),
        set("masses x 1e3", &["rings.0.mass=43 kg", "rings.1.mass=37 kg", "rings.2.mass=44 kg"]),
        set(
            "tensions x 1e-3",
            &[
                "rings.0.tangential_force=0.022 N",
                "rings.1.tangential_force=0.018 N",
                "rings.2.tangential_force=0.060 N",
            ],
        ),
        set(
            "tensions x 1e3",
            &[
                "rings.0.tangential_force=22 kN",
                "rings.1.tangential_force=18 kN",
                "rings.2.tangential_force=60 kN",
            ],
        ),
        set(
            "oil at -10 degC",
            &["models.film_temperature.tdc=-10 degC", "models.film_temperature.bdc=-10 degC"],
        ),
        set(
            "oil at 500 degC",
            &["models.film_temperature.tdc=500 degC", "models.film_temperature.bdc=500 degC"],
        ),
        set("no groove oil", &["models.flank.model=dry"]),
    ]);
}

/// Inertia of no account: the motion between two flanks is fast against everything else.
#[test]
fn rings_of_a_few_micrograms() {
    let masses = ["rings.0.mass=0.043 mg", "rings.1.mass=0.037 mg", "rings.2.mass=0.044 mg"];
    all(vec![set("masses x 1e-6", &masses)]);
}

/// 200 Pa s: films push the rings to the bottom of their grooves.
#[test]
fn frozen_oil() {
    let cold = ["models.film_temperature.tdc=-20 degC", "models.film_temperature.bdc=-20 degC"];
    all(vec![set("oil at -20 degC", &cold)]);
}

#[test]
fn numbers_of_rings() {
    let text = std::fs::read_to_string(case_file(CASE)).expect("the case");
    let base: toml::Table = toml::from_str(&text).expect("TOML");
    let with = |n: usize| -> PathBuf {
        let mut case = base.clone();
        // Rings of the pack in turn, the oil ring last.
        let pick = |k: usize| if k + 1 == n { 2 } else { k % 2 };
        let list = |case: &toml::Table, of: &str| -> Vec<toml::Value> {
            let all = match of.split_once('.') {
                Some((t, k)) => case[t].get(k),
                None => case.get(of),
            };
            let all = all.and_then(toml::Value::as_array).expect("a list").clone();
            (0..n).map(|k| all[if of == "rings" { pick(k) } else { k.min(2) }].clone()).collect()
        };
        let (rings, lands) = (list(&case, "rings"), list(&case, "piston.lands"));
        case.insert("rings".into(), toml::Value::Array(rings));
        let piston = case.get_mut("piston").and_then(toml::Value::as_table_mut).expect("a piston");
        piston.insert("lands".into(), toml::Value::Array(lands));
        let path = scratch().join(format!("extremes-{n}-rings.toml"));
        std::fs::write(&path, toml::to_string(&case).expect("TOML")).expect("writes");
        path
    };
    all([1, 2, 4, 5, 8]
        .iter()
        .map(|n| (format!("{n} rings"), with(*n), overrides_of(CASE, &["solver.max_cycles=10"])))
        .collect());
}

#[test]
fn published_schemes() {
    let march = |name: &str, case: &str, more: &[&str]| {
        let o = more.iter().map(|s| (*s).to_owned()).collect();
        (name.to_owned(), case_file(case), o)
    };
    let (z, t) = ("turbo-diesel-120-as-published", "alcohol-1600-3000");
    let quick = ["solver.cycles=2", "solver.gas_steps=20", "solver.starts=[\"1 bar\"]"];
    let with = |more: &[&'static str]| quick.iter().copied().chain(more.iter().copied()).collect::<Vec<_>>();
    all(vec![
        march("zottin, 1 rpm", z, &["engine.speed=1 rpm"]),
        march("zottin, 20 000 rpm", z, &["engine.speed=20000 rpm"]),
        march("zottin, lands x 1e-3", z, &["piston.lands.1.volume=0.9 mm3", "piston.lands.2.volume=0.4 mm3"]),
        march(
            "zottin, masses x 1e-3",
            z,
            &["rings.0.mass=43 mg", "rings.1.mass=37 mg", "rings.2.mass=44 mg"],
        ),
        march("zottin, start at 1000 bar", z, &["solver.starts=[\"1000 bar\"]"]),
        march("tomanik, 1 rpm", t, &with(&["engine.speed=1 rpm"])),
        march("tomanik, 20 000 rpm", t, &with(&["engine.speed=20000 rpm"])),
        march(
            "tomanik, lands x 1e-3",
            t,
            &with(&["piston.lands.1.volume=0.16 mm3", "piston.lands.2.volume=0.079 mm3"]),
        ),
        march(
            "tomanik, clearances x 1e3",
            t,
            &with(&["rings.0.groove.clearance=30 mm", "rings.1.groove.clearance=30 mm"]),
        ),
        march(
            "tomanik, start at 1000 bar",
            t,
            &["solver.cycles=2", "solver.gas_steps=20", "solver.starts=[\"1000 bar\"]"],
        ),
    ]);
}
