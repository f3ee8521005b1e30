//! The scene `shaft_line`: what runs, what is skipped, what is refused, transients and limits.

use std::path::{Path, PathBuf};

use gudgeon_core::result::{FigureKind, Lines, Mark, NoteLevel, RunResult, Series};
use gudgeon_scene::{check, explain, run};

fn case(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases").join(name)
}

fn once(name: &str, set: &[&str]) -> RunResult {
    let set: Vec<String> = set.iter().map(|s| (*s).to_owned()).collect();
    let c = check(&case(name), &set).unwrap_or_else(|r| panic!("{r}"));
    run(&c, &mut gudgeon_scene::unwatched).unwrap_or_else(|e| panic!("{e}"))
}

fn refused(set: &[&str]) -> String {
    refused_of("compressor-4-throw.toml", set)
}

fn refused_of(name: &str, set: &[&str]) -> String {
    let set: Vec<String> = set.iter().map(|s| (*s).to_owned()).collect();
    match check(&case(name), &set) {
        Ok(_) => "accepted".into(),
        Err(r) => r.to_string() + &r.diagnostics.iter().map(|d| d.headline()).collect::<Vec<_>>().join("; "),
    }
}

#[test]
fn constant_speed_without_torsion_builds_no_line() {
    let r = once(
        "compressor-4-throw.toml",
        &["models.torsion.model=off", "outputs.groups=[\"throws\"]", "limits={}"],
    );
    for counter in ["lines_built", "time_steps", "linear_solutions"] {
        assert_eq!(r.solver.counters[counter], 0, "{counter}");
    }
    assert!((r.results["throw1.mean_torque"].value + 430.622294).abs() < 1e-5);
    assert!(!r.results.contains_key("mode.1.frequency"));
    assert!(r.skipped.iter().any(|s| s.what == "shaft line"));
    // Asked for frequencies the line is built, and nothing but that.
    let r = once(
        "compressor-4-throw.toml",
        &["models.torsion.model=off", "outputs.groups=[\"natural_frequencies\"]", "limits={}"],
    );
    assert_eq!(r.solver.counters["lines_built"], 1);
    assert_eq!(r.solver.counters["linear_solutions"], 0);
    assert!(!r.results.contains_key("throw1.mean_torque") && r.results.contains_key("mode.6.frequency"));
}

#[test]
fn a_linear_steady_question_takes_no_time_step() {
    let r = once("compressor-4-throw.toml", &[]);
    assert_eq!(r.solver.counters["time_steps"], 0);
    assert!(r.solver.counters["linear_solutions"] > 24, "orders and the speed range");
    assert!(r.results["limits_broken"].value >= 1.0 && r.solver.notes[0].topic == "verdict");
    assert!(r.tables.contains_key("critical_speeds") && r.tables.contains_key("orders"));
    for title in [
        "Verdict",
        "Mode shapes",
        "Campbell diagram",
        "Modes",
        "Critical speeds",
        "Torque in the shafts",
        "Shear stress",
    ] {
        assert!(r.figures.iter().any(|f| f.title == title), "{title}");
    }
    // The free motion of a linear line in closed form neither.
    let r = once("compressor-4-throw-as-published-free.toml", &["models.torsion={ model = \"propagator\" }"]);
    assert_eq!(r.solver.counters["time_steps"], 0);
    assert!((r.results["mean_speed"].value - 268.766_776_629).abs() < 1e-8);
}

#[test]
fn the_same_case_gives_the_same_bytes() {
    let a = once("compressor-4-throw.toml", &[]);
    let b = once("compressor-4-throw.toml", &[]);
    assert_eq!((a.results, a.series, a.tables), (b.results, b.series, b.tables));
}

#[test]
fn every_torsion_model_answers_the_compressor() {
    let base = [
        "models.torsion={ model = \"orders\" }",
        "models.throw_inertia.model=mean",
        "range={ orders = 12 }",
        "limits={}",
    ];
    let with = |more: &[&str]| once("compressor-4-throw.toml", &[&base[..], more].concat());
    let orders = with(&[]);
    let amplitude = |r: &RunResult, shaft: usize| r.results[&format!("shaft{shaft}.torque_amplitude")].value;
    let balance = with(&["models.torsion={ model = \"harmonic_balance\" }"]);
    let modal = with(&["models.torsion={ model = \"modal\" }"]);
    for s in 1..=6 {
        let a = amplitude(&orders, s);
        // Gas by the true angle against the mean one; modes without coupling by damping.
        assert!((amplitude(&balance, s) / a - 1.0).abs() < 0.03, "{s}");
        assert!((amplitude(&modal, s) / a - 1.0).abs() < 0.1, "{s}");
    }
    // Started in its periodic motion the line keeps it: closed form to rounding (the kinks beyond order 12 are the
    // same in both), error control nearly.
    let time =
        "time={ duration = \"0.12 s\", interval = \"0.2 ms\", window = \"0.06 s\", start_steady = true }";
    let hold = format!(
        "drives=[{{ at = \"motor\", drive = {{ model = \"constant\", torque = {} }} }}]",
        -4.0 * orders.results["throw1.mean_torque"].value
    );
    let held = with(&[&hold]);
    let closed = with(&[time, &hold, "models.torsion={ model = \"propagator\" }"]);
    let stepped = with(&[time, &hold, "models.torsion={ model = \"implicit\", tolerance = 1e-7 }"]);
    for i in 1..=7 {
        let name = format!("inertia{i}.speed_swing");
        let a = held.results[&name].value;
        assert!((closed.results[&name].value / a - 1.0).abs() < 2e-3, "{name}: rows 0.2 ms apart");
        assert!((stepped.results[&name].value / a - 1.0).abs() < 0.05, "{name}: gas by the true angle");
    }
}

#[test]
fn a_held_line_over_time_has_the_periodic_motion() {
    let once = |set: &[&str]| once("compressor-2-throw-coupling.toml", set);
    let response = r#"outputs.groups=["response"]"#;
    let periodic = once(&[response, "range.orders=96"]);
    let held = once(&[
        response,
        "models.torsion={ model = \"implicit\", tolerance = 1e-7 }",
        "time.hold_speed=true",
        // A top between instants 20 us apart is missed by 2e-6 at order 2.
        "time.window_interval=0.02 ms",
    ]);
    for name in ["inertia1.speed_swing", "inertia2.speed_swing", "shaft1.torque_amplitude"] {
        // Orders above 96 and the tolerance are some 1e-6 here, and the start is forgotten after 3 s; at the speed that the motor finds by
        // itself the swing of its rotor is 2e-4 larger.
        let (a, b) = (held.results[name].value, periodic.results[name].value);
        assert!((a / b - 1.0).abs() < 2e-5, "{name}: {a} and {b}");
    }
    assert!(!held.results.contains_key("drive2.torque"), "what holds the speed is no drive of the case");
}

#[test]
fn a_start_from_rest_reaches_the_speed_of_the_motor() {
    let set = [
        "range={ orders = 12 }",
        "limits={}",
        "models.torsion={ model = \"implicit\", tolerance = 1e-5 }",
        "drives=[{ at = \"motor\", drive = { model = \"induction_motor\", synchronous = \"1015 rpm\", breakdown_torque = \"12 kN m\", breakdown_slip = \"30 %\" } }]",
        "time={ duration = \"12 s\", interval = \"20 ms\", window = \"1 s\", start_speeds = [\"1 rad/s\"] }",
    ];
    let r = once("compressor-4-throw.toml", &set);
    let speed = r.results["mean_speed"].value;
    // Between the slip of the mean load and synchronous speed.
    assert!(speed > 100.0 && speed < 106.3, "{speed}");
    assert!(r.solver.counters["time_steps"] > 100);
    // Mean motor torque carries the mean of the gas, 1722 N m, once the speed stands.
    assert!(
        (r.results["drive1.torque"].value - 1722.5).abs() < 100.0,
        "{}",
        r.results["drive1.torque"].value
    );
    assert!(r.results["shaft1.torque_peak"].value > r.results["shaft1.torque_amplitude"].value);
}

#[test]
fn double_acting_unloading_and_staging() {
    let end = |side: &str, model: &str| {
        format!(
            "{{ side = \"{side}\", bore = \"0.305 m\", rod_diameter = \"{}\", cylinder_pressure = {model} }}",
            if side == "crank" { "0.06 m" } else { "0 m" }
        )
    };
    let ideal = "{ model = \"ideal_valves\", suction = \"1 bar\", discharge = \"6 bar\", clearance = { fraction = 0.08 } }";
    let open = "{ model = \"ideal_valves\", suction = \"1 bar\", discharge = \"6 bar\", clearance = { fraction = 0.08 }, held_open = true }";
    let lossy = "{ model = \"valve_losses\", suction = \"1 bar\", discharge = \"6 bar\", clearance = { fraction = 0.08 }, suction_area = \"80 cm2\", discharge_area = \"60 cm2\" }";
    let work = |ends: &[String]| {
        let set = format!("throws.0.ends=[{}]", ends.join(", "));
        let r = once("compressor-4-throw.toml", &[&set, "outputs.groups=[\"throws\"]", "limits={}"]);
        -r.results["throw1.work"].value
    };
    let (head, crank) = (work(&[end("head", ideal)]), work(&[end("crank", ideal)]));
    // The crank end has the same cycle on an area smaller by the rod: work goes with the swept volume.
    let area = 1.0 - (0.06_f64 / 0.305).powi(2);
    assert!((crank / head - area).abs() < 1e-9, "{crank} {head}");
    assert!((work(&[end("head", ideal), end("crank", ideal)]) - head - crank).abs() < 1e-9 * head);
    // An unloaded end takes no work, valve losses add some.
    assert!(work(&[end("head", open)]).abs() < 1e-9 * head);
    let with_losses = work(&[end("head", lossy)]);
    assert!(with_losses > head && with_losses < 1.2 * head, "{with_losses} {head}");
    // Closed form: n/(n-1) p_s (V_max - V_4) ((p_d/p_s)^((n-1)/n) - 1).
    let swept = std::f64::consts::PI * 0.305 * 0.305 / 4.0 * 0.18;
    let v4 = 0.08 * swept * 6.0_f64.powf(1.0 / 1.4);
    let exact = 3.5 * 1e5 * (1.08 * swept - v4) * (6.0_f64.powf(0.4 / 1.4) - 1.0);
    assert!((head / exact - 1.0).abs() < 1e-10, "{head} {exact}");
}

#[test]
fn tors_files_are_imported_with_a_report() {
    let folder = std::env::temp_dir().join("gudgeon-shaft-line-tors");
    std::fs::create_dir_all(&folder).expect("a folder");
    let tors = r#"{"components": [{"name": "e", "elements": [
        {"name": "a", "type": "Disk", "inertia": 0.8, "damping": 0},
        {"name": "s", "type": "ShaftDiscrete", "stiffness": 200000, "damping": 1, "colour": "red"},
        {"name": "b", "type": "Disk", "inertia": 0.05, "damping": 0}]}], "structure": []}"#;
    std::fs::write(folder.join("two.json"), tors).expect("written");
    let text = "scene = \"shaft_line\"\nspeed = \"1000 rpm\"\ntors = \"two.json\"\n\n[[inertias]]\nname = \"pump\"\ninertia = \"0.4 kg m2\"\n\n[[shafts]]\nfrom = \"e.b\"\nto = \"pump\"\nstiffness = \"1 kN m/rad\"\n";
    let file = folder.join("case.toml");
    std::fs::write(&file, text).expect("written");
    let c = check(&file, &[]).unwrap_or_else(|r| panic!("{r}"));
    let r = run(&c, &mut gudgeon_scene::unwatched).expect("runs");
    assert!(r.solver.notes.iter().any(|n| n.text.contains("e.s: colour not read")), "{:?}", r.solver.notes);
    assert!(r.results.contains_key("mode.2.frequency") && !r.results.contains_key("mode.3.frequency"));
    let c = check(&file, &["shafts=[]".into(), "inertias=[]".into()]).unwrap_or_else(|r| panic!("{r}"));
    let r = run(&c, &mut gudgeon_scene::unwatched).expect("runs");
    // Two discs: ω = √(k (1/J₁ + 1/J₂)).
    assert!((r.results["mode.1.omega"].value / 2_061.552_812_808_830_3 - 1.0).abs() < 1e-14);
    let lost = check(&file, &["tors=\"none.json\"".into()]);
    assert!(lost.err().is_some_and(|r| r.to_string().contains("none.json")
        || r.diagnostics.iter().any(|d| d.headline().contains("none.json"))));
}

#[test]
fn mistakes_are_told_at_their_place() {
    for (set, word) in [
        ("shafts.0.to=couplin", "did you mean `coupling`"),
        ("shafts.1.to=motor", "not connected"),
        ("shafts.0.stiffness=-1", "zero or greater"),
        ("throws.0.rod_length=\"0.05 m\"", "cannot turn"),
        ("throws.0.phases=[0]", "1 phases for 4 throws"),
        ("throws.0.ends.0.cylinder_pressure.discharge=\"1 bar\"", "must be above"),
        ("models.torsion={ model = \"runge_kutta\", step = 1e-5 }", "needs a table `time`"),
        ("models.torsion={ model = \"modal\", modes = 0 }", "`0` must be at least 1"),
        ("limits.torque.0.shaft=x", "there is no shaft `x`"),
        ("range.to=\"100 rpm\"", "must be above `from`"),
        ("inertias.0.ratio=0", "would not turn"),
        ("shafts.0.pieces=[{ length = 1, diameter = 0.1 }]", "exactly one of"),
        ("drives.0.drive={ model = \"linear\", intercept = 1 }", "`intercept` and `slope`"),
        ("range.points=1", "`1` must be at least 2"),
    ] {
        let told = refused(&[set]);
        assert!(told.contains(word), "{set}: {told}");
    }
    let time = "time={ duration = 1, interval = 1e-3 }";
    for (set, word) in [
        (["models.torsion={ model = \"propagator\" }", time], "varies with the angle"),
        (["models.torsion={ model = \"runge_kutta\", step = 1e-9 }", time], "steps"),
        (["models.torsion={ model = \"implicit\" }", "time={ duration = 1, interval = 1e-7 }"], "rows"),
    ] {
        let told = refused(&set);
        assert!(told.contains(word), "{set:?}: {told}");
    }
}

#[test]
fn an_undamped_resonance_that_is_hit_is_refused() {
    let set: Vec<String> = [
        "limits={}",
        "conventions={}",
        "drives=[]",
        "models.throw_inertia.model=mean",
        "throws.0.phases=[]",
        "range={ orders = 1 }",
        // The exact first frequency of the line, within rounding.
        "speed=\"261.5183528700733 rad/s\"",
        "outputs.groups=[\"response\"]",
    ]
    .map(String::from)
    .to_vec();
    let c = check(&case("compressor-4-throw.toml"), &set).unwrap_or_else(|r| panic!("{r}"));
    let told = explain(&c).expect("explains");
    assert!(told.skipped.iter().any(|s| s.what == "time steps"));
    // The speed to the last digit comes from the line itself.
    let omega = {
        let set: Vec<String> =
            set[..6].iter().cloned().chain(["outputs.groups=[\"natural_frequencies\"]".into()]).collect();
        let c = check(&case("compressor-4-throw.toml"), &set).unwrap_or_else(|r| panic!("{r}"));
        run(&c, &mut gudgeon_scene::unwatched).expect("runs").results["mode.1.omega"].value
    };
    let mut exact = set.clone();
    exact[7] = format!("speed={omega:?}");
    let c = check(&case("compressor-4-throw.toml"), &exact).unwrap_or_else(|r| panic!("{r}"));
    let e = run(&c, &mut gudgeon_scene::unwatched).expect_err("a resonance").to_string();
    assert!(e.contains("undamped natural frequency") && e.contains("order 1"), "{e}");
}

#[test]
fn gears_over_time_turn_as_one_and_carry_what_is_behind_them() {
    let mut set: Vec<String> = [
        r#"models.torsion={ model = "implicit" }"#,
        r#"time={ duration = "0.3 s", interval = "1 ms", window = "0.2 s", start_steady = true }"#,
        r#"shafts.7.coupling={ model = "linear", stiffness = "20 kN m/rad", damping = "40 N m s/rad" }"#,
        r#"dampers.0.coupling={ model = "linear", stiffness = "20 kN m/rad", damping = "60 N m s/rad" }"#,
        r#"outputs.groups=["response"]"#,
    ]
    .map(String::from)
    .to_vec();
    set.extend([0, 1, 2, 3, 4, 5, 6, 9, 11].map(|k| format!("shafts.{k}.loss_factor=0")));
    let r = once("geared-train.toml", &set.iter().map(String::as_str).collect::<Vec<_>>());
    let of = |name: &str| r.results[name].value;
    let pinion = of("inertia9.speed_end");
    for (i, ratio) in [(10, -0.5), (12, -1.5)] {
        // Rigid meshes: one state, so exactly.
        assert!((of(&format!("inertia{i}.speed_end")) - ratio * pinion).abs() < 1e-12 * pinion);
    }
    // Loads act against the rotation, also where that is backwards: the generator's torque brakes.
    assert!((of("drive4.torque") - 110.0).abs() < 1e-9, "{}", of("drive4.torque"));
    // The mesh carries the generator's torque and its vibration; a rigid link has a torque though it has no twist.
    let mesh = of("shaft11.torque_peak") - of("shaft11.torque_amplitude");
    assert!((mesh - 165.0).abs() < 0.3 * 165.0, "{mesh}");
    assert!(of("shaft11.twist_peak") < 1e-9 && !r.results.contains_key("shaft11.stiffness"));
    // A loss factor has no meaning there, and the refusal says what has.
    let short: Vec<&str> = set[..2].iter().map(String::as_str).collect();
    let told = refused_of("geared-train.toml", &short);
    assert!(told.contains("harmonic motion only"), "{told}");
    // A throw on a shaft that turns backwards.
    let told = refused_of("geared-train.toml", &["throws.0.at.0=wheel"]);
    assert!(told.contains("turns backwards"), "{told}");
}

/// The text of a note.
fn note<'a>(r: &'a RunResult, topic: &str) -> &'a str {
    r.solver.notes.iter().find(|n| n.topic == topic).map_or("", |n| n.text.as_str())
}

#[test]
fn the_verdict_counts_every_speed_of_the_operating_range() {
    let r = once("geared-train.toml", &[]);
    let all = note(&r, "verdict");
    assert!(
        all.contains("2 of 12 limits are not kept") && all.contains("from 600.00 rpm to 2000.00 rpm"),
        "{all}"
    );
    // Neither shows at the mean speed.
    let generator = note(&r, "verdict.stress_in_generator_shaft");
    assert!(generator.contains("order 4") || generator.contains("order 2"), "{generator}");
    let crank = note(&r, "verdict.stress_in_crank_4_5");
    assert!(crank.contains("at 2000.00 rpm") && crank.contains("45.7"), "{crank}");
    // The envelope is what the mean speed gives when it is set to where the envelope has its top.
    let speed = r.results["envelope.shaft12.speed"].value;
    assert!((speed - 760.0).abs() < 10.0, "{speed}");
    let set = format!("speed=\"{speed:?} rpm\"");
    let there = once("geared-train.toml", &[&set, "operating={ from = \"600 rpm\", to = \"600 rpm\" }"]);
    let (top, own) = (
        r.results["envelope.shaft12.stress_amplitude"].value,
        there.results["shaft12.stress_amplitude"].value,
    );
    // The speed in rpm and back: rounding, at a top where the slope is zero.
    assert!((top / own - 1.0).abs() < 1e-9, "{top} {own}");
}

#[test]
fn a_dense_sweep_finds_no_more_than_the_verdict() {
    let r = once("geared-train.toml", &[]);
    let set = [
        "range.points=7001",
        "limits={}",
        "outputs.groups=[\"speed_range\"]",
        "operating={ from = \"600 rpm\", to = \"600 rpm\" }",
    ];
    let dense = once("geared-train.toml", &set);
    let table = &dense.tables["speed_range"];
    for n in 1..=13 {
        let top = r.results[&format!("envelope.shaft{n}.torque_amplitude")].value;
        let rows = &table.get(&format!("shaft{n}.torque_amplitude")).expect("a column").values;
        let brute = rows.iter().copied().fold(0.0, f64::max);
        // 0.2 rpm apart: of the narrowest peak (1 % damping at 600 rpm, 6 rpm wide) half a step misses (0.1/6)² < 3e-4; and nothing
        // is above the verdict's by more than its own 1e-6.
        assert!(top >= brute * (1.0 - 1e-6) && top <= brute * (1.0 + 3e-4), "{n}: {top} {brute}");
    }
}

#[test]
fn the_order_of_listing_changes_nothing() {
    let text = std::fs::read_to_string(case("geared-train.toml")).expect("the case");
    let text = text.split("[[checks]]").next().expect("a text");
    // Blocks of inertias, shafts and drives the other way round.
    let turned = |text: &str, head: &str| -> String {
        let parts: Vec<&str> = text.split("\n\n").collect();
        let places: Vec<usize> =
            (0..parts.len()).filter(|i| parts[*i].trim_start().starts_with(head)).collect();
        let mut new = parts.clone();
        for (i, j) in places.iter().zip(places.iter().rev()) {
            new[*i] = parts[*j];
        }
        new.join("\n\n")
    };
    let back =
        ["[[inertias]]", "[[shafts]]", "[[drives]]"].iter().fold(text.to_owned(), |t, h| turned(&t, h));
    let folder = std::env::temp_dir().join("gudgeon-shaft-line-backwards");
    std::fs::create_dir_all(&folder).expect("a folder");
    let file = folder.join("backwards.toml");
    std::fs::write(&file, back).expect("written");
    let c = check(&file, &[]).unwrap_or_else(|r| panic!("{r}"));
    let there = run(&c, &mut gudgeon_scene::unwatched).expect("runs");
    let here = once("geared-train.toml", &[]);
    // Numbers of names turn round: 12 shafts and 13 inertias, the damper stays the last of both.
    let renamed = |name: &str| -> String {
        let of = |part: &str| {
            for (head, n) in [("shaft", 12), ("inertia", 13)] {
                if let Some(Ok(k)) = part.strip_prefix(head).map(str::parse::<usize>) {
                    return format!("{head}{}", if k <= n { n + 1 - k } else { k });
                }
            }
            part.to_owned()
        };
        name.split('.').map(of).collect::<Vec<_>>().join(".")
    };
    assert_eq!(here.results.len(), there.results.len());
    for (name, v) in &here.results {
        let other = there.results.get(&renamed(name)).unwrap_or_else(|| panic!("{name}"));
        // Signs of torques in a shaft do not turn, for its ends keep their names. A residual is rounding itself; torques that
        // cancel are judged by the largest of the shafts.
        let scale = if name == "holzer_residual" { 1.0 } else { v.value.abs() };
        let slack = if v.unit == "N m" { 1e-12 * 3000.0 } else { 1e-15 };
        assert!((v.value - other.value).abs() <= 1e-9 * scale + slack, "{name}: {} {}", v.value, other.value);
    }
}

#[test]
fn a_resonance_narrower_than_the_grid_is_found() {
    // A pulsating torque on the second of two inertias behind a viscously damped shaft, damping ratio 5e-5: at 1000 rpm the peak
    // is 0.1 rpm wide, on a grid of 12.5 rpm. Torque in the shaft by the torque on J2: k φ = J1/(J1 + J2) T V, V of one inertia.
    let (j1, j2, zeta, torque) = (2.0_f64, 1.0_f64, 5e-5_f64, 30.0_f64);
    let j = j1 * j2 / (j1 + j2);
    // Order 3 meets the mode at 1003.7 rpm, off the grid.
    let w = 3.0 * 1003.7 * std::f64::consts::PI / 30.0;
    let (k, c) = (j * w * w, 2.0 * zeta * j * w);
    let text = format!(
        r#"scene = "shaft_line"
speed = "900 rpm"
[operating]
from = "600 rpm"
to = "1800 rpm"
[[inertias]]
name = "a"
inertia = {j1}
[[inertias]]
name = "b"
inertia = {j2}
[[shafts]]
name = "ab"
from = "a"
to = "b"
stiffness = {k:?}
damping = {c:?}
[[drives]]
at = "b"
drive = {{ model = "harmonics", orders = [{{ order = 3, amplitude = {torque} }}] }}
[models]
torsion = {{ model = "orders" }}
[[limits.torque]]
shaft = "ab"
amplitude = 100
source = "a test"
"#
    );
    let folder = std::env::temp_dir().join("gudgeon-shaft-line-narrow");
    std::fs::create_dir_all(&folder).expect("a folder");
    let file = folder.join("narrow.toml");
    std::fs::write(&file, text).expect("written");
    let c = check(&file, &[]).unwrap_or_else(|r| panic!("{r}"));
    let r = run(&c, &mut gudgeon_scene::unwatched).expect("runs");
    let found = r.results["envelope.shaft1.torque_amplitude"].value;
    // Spring and damper carry √(1 + (2 ζ r)²) of the spring alone: 5e-9 at the peak.
    let exact = j1 / (j1 + j2) * torque * 0.5 / (zeta * (1.0 - zeta * zeta).sqrt());
    assert!((found / exact - 1.0).abs() < 1e-6, "{found} {exact}");
    assert!((r.results["envelope.shaft1.speed"].value / 1003.7 - 1.0).abs() < 1e-7);
    assert!(note(&r, "verdict.torque_in_ab").contains("order 3"));
    // Without any damping it has no bound, which is said and stops nothing.
    let c = check(&file, &["shafts.0.damping=0".into()]).unwrap_or_else(|r| panic!("{r}"));
    let r = run(&c, &mut gudgeon_scene::unwatched).expect("runs");
    assert!(note(&r, "verdict.torque_in_ab").contains("without bound"), "{:?}", r.solver.notes);
    assert_eq!(r.results["limits_broken"].value, 1.0);
}

#[test]
fn load_steps_are_read_like_set_and_judged_each() {
    let steps = |set: &str| format!("load_steps=[{{ name = \"head ends open\", set = [{set}] }}]");
    let open = steps("\"throws.0.ends.0.cylinder_pressure.held_open=true\"");
    let set = [open.as_str(), "limits.separation=[]"];
    let r = once("compressor-4-throw.toml", &set);
    assert_eq!(r.tables["load_steps"].axis.values, [1.0, 2.0]);
    assert_eq!(r.solver.counters["lines_built"], 2, "each load step is built once");
    // What the step gives is what the case gives when it is changed.
    let alone = once(
        "compressor-4-throw.toml",
        &["throws.0.ends.0.cylinder_pressure.held_open=true", "limits.separation=[]"],
    );
    let column = r.tables["load_steps"].get("stress in crank 2-3").expect("a limit");
    let own = alone.results["shaft5.stress_amplitude"].value / 35.0;
    assert!((column.values[1] / own - 1.0).abs() < 1e-9, "{} {own}", column.values[1]);
    for (set, word) in [
        ("\"throws.0.ends.0.cylinder_pressure.held_opn=true\"", "held_open"),
        ("\"drives.0.drive.rated.torque=\\\"5 m\\\"\"", "load step `head ends open`"),
        ("\"limits={}\"", "one for all load steps"),
        ("\"shafts.1.to=motor\"", "not connected"),
    ] {
        let told = refused(&[&steps(set)]);
        assert!(told.contains(word) && told.contains("load_steps.0.set"), "{set}: {told}");
    }
    let told = refused(&["load_steps=[{ name = \"a\" }, { name = \"a\" }]"]);
    assert!(told.contains("another load step"), "{told}");
}

#[test]
fn orders_say_what_they_leave_out() {
    let r = once("compressor-4-throw.toml", &[]);
    // Time integration with an independent program (SciPy): 9666 N m.
    assert!((r.results["shaft3.torque_max"].value / 9666.0 - 1.0).abs() < 1e-3);
    assert!(note(&r, "left_out").is_empty());
    let r =
        once("compressor-4-throw.toml", &["models.torsion={ model = \"orders\" }", "range={}", "limits={}"]);
    assert!(note(&r, "left_out").contains("harmonic_balance"), "{:?}", r.solver.notes);
    // Nothing varies: the default costs what `orders` costs.
    let set = ["models.throw_inertia.model=mean", "throws=[]", "range={}", "limits={}", "conventions={}"];
    let [plain, whole] = ["orders", "harmonic_balance"].map(|m| {
        let model = format!("models.torsion={{ model = \"{m}\" }}");
        once("compressor-4-throw.toml", &[&set[..], &[model.as_str()]].concat())
    });
    assert_eq!(plain.solver.counters["linear_solutions"], whole.solver.counters["linear_solutions"]);
    assert_eq!(plain.results, whole.results);
}

#[test]
fn one_definition_of_separation() {
    let r = once(
        "geared-train.toml",
        &[
            "limits={ separation = [{ margin = \"5 %\", orders = [1.5], source = \"x\" }] }",
            "range.interference_orders=1.5",
            "operating={ from = \"1800 rpm\", to = \"1800 rpm\" }",
        ],
    );
    let distance = r.results["distance_to_critical"].value.abs();
    let used = r.results["worst_utilisation"].value;
    // The nearest of the orders 0.5, 1 and 1.5 is that of the limit, or the limit is farther.
    assert!(5.0 / used >= distance * (1.0 - 1e-12), "{used} {distance}");
    let critical = r.results["nearest_critical_speed"].value;
    assert!((distance - 100.0 * (critical / 1800.0 - 1.0).abs()).abs() < 1e-9, "{distance} {critical}");
    // A critical speed within the range counts as zero, and is accepted where the vibration keeps its limits.
    let kept = "limits={ separation = [{ margin = \"5 %\", orders = [4.5], source = \"x\" }], stress = [{ amplitude = \"400 MPa\", source = \"y\" }] }";
    let r = once("geared-train.toml", &[kept]);
    assert_eq!(r.results["limits_broken"].value, 0.0, "{:?}", r.solver.notes);
    let accepted = r.solver.notes.iter().filter(|n| n.topic.starts_with("verdict.accepted.mode"));
    assert!(
        accepted.clone().count() > 0 && accepted.clone().all(|n| n.level == NoteLevel::Caution),
        "{:?}",
        r.solver.notes
    );
    let strict = kept.replace("source = \"x\"", "source = \"x\", accept_by_response = false");
    assert_eq!(once("geared-train.toml", &[&strict]).results["limits_broken"].value, 1.0);
    let without = once(
        "geared-train.toml",
        &["limits={ separation = [{ margin = \"5 %\", orders = [4.5], source = \"x\" }] }"],
    );
    assert_eq!(without.results["limits_broken"].value, 1.0, "no limit says that the vibration is harmless");
}

#[test]
fn the_speed_that_is_held_says_where() {
    let r = once(
        "compressor-4-throw.toml",
        &["drives=[]", "range={}", "limits={}", "outputs.groups=[\"response\"]"],
    );
    assert!(note(&r, "balance").contains("balance_at"));
    // Four throws' work through the motor shaft when the motor holds the speed.
    let set =
        ["drives=[]", "range={}", "limits={}", "balance_at=motor", "models.torsion={ model = \"orders\" }"];
    let r = once("compressor-4-throw.toml", &set);
    let mean = -4.0 * r.results["throw1.mean_torque"].value;
    assert!((r.results["shaft1.mean_torque"].value / mean - 1.0).abs() < 1e-12);
    assert!(refused(&["balance_at=moter"]).contains("did you mean `motor`"));
    assert!(refused(&["throws.0.ends.0.cylinder_pressure.exponent=17"]).contains("between 1"));
}

#[test]
fn a_sweep_of_a_result_that_is_none_is_refused_with_the_nearest() {
    let sweep = "sweeps=[{ path = \"title\", values = [\"a\"], results = [\"shaft2.torque_amplitud\"] }]";
    let told = refused_of("geared-train.toml", &[sweep]);
    assert!(told.contains("there is no result `shaft2.torque_amplitud`"), "{told}");
}

#[test]
fn spectra_over_the_speed_are_those_of_every_order() {
    // Two inertias, viscously damped, with pulsating torques of two orders on the second. Torque in the shaft by the torque T on J2:
    // J1/(J1 + J2) T √(1 + (2 ζ r)²)/√((1 - r²)² + (2 ζ r)²), r the frequency over the natural one.
    let (j1, j2, zeta) = (2.0_f64, 1.0_f64, 0.02_f64);
    let j = j1 * j2 / (j1 + j2);
    let natural = 3.0 * 1000.0 * std::f64::consts::PI / 30.0;
    let (k, c) = (j * natural * natural, 2.0 * zeta * j * natural);
    let torques = [(2.0, 40.0), (3.0, 30.0)];
    let text = format!(
        r#"scene = "shaft_line"
speed = "900 rpm"
[range]
from = "600 rpm"
to = "1800 rpm"
points = 121
[[inertias]]
name = "a"
inertia = {j1}
[[inertias]]
name = "b"
inertia = {j2}
[[shafts]]
name = "ab"
from = "a"
to = "b"
stiffness = {k:?}
damping = {c:?}
[[drives]]
at = "b"
drive = {{ model = "harmonics", orders = [{{ order = 2, amplitude = 40 }}, {{ order = 3, amplitude = 30 }}] }}
[models]
torsion = {{ model = "orders" }}
"#
    );
    let folder = std::env::temp_dir().join("gudgeon-shaft-line-spectra");
    std::fs::create_dir_all(&folder).expect("a folder");
    let file = folder.join("spectra.toml");
    std::fs::write(&file, text).expect("written");
    let r = run(&check(&file, &[]).unwrap_or_else(|r| panic!("{r}")), &mut gudgeon_scene::unwatched)
        .expect("runs");
    let table = &r.tables["order_spectra"];
    let of = |name: &str| &table.get(name).expect(name).values;
    let (frequency, speed, torque) = (of("frequency"), of("speed"), of("shaft1.torque"));
    for (row, order) in table.axis.values.iter().enumerate() {
        let t = torques.iter().find(|t| t.0 == *order).expect("an order that is excited").1;
        // Rounding of a product.
        assert!((frequency[row] - order * speed[row] / 60.0).abs() < 1e-9, "row {row}");
        let ratio = 2.0 * std::f64::consts::PI * frequency[row] / natural;
        let (loss, rest) = (2.0 * zeta * ratio, 1.0 - ratio * ratio);
        let exact = j1 / (j1 + j2) * t * loss.hypot(1.0) / rest.hypot(loss);
        // A direct solution of two equations: rounding, as near to the resonance as its damping.
        assert!((torque[row] / exact - 1.0).abs() < 1e-9, "row {row}: {} {exact}", torque[row]);
    }
    // Few enough for a page, ascending, both orders at each speed, and the peak of the diagram among them.
    assert!(torque.len() <= 2 * 36 && speed.windows(2).all(|w| w[0] <= w[1]));
    assert!(speed.chunks(2).all(|w| w[0] == w[1]));
    let top = |v: &[f64]| v.iter().copied().fold(0.0, f64::max);
    let diagram =
        |order: u32| &r.tables["speed_range"].get(&format!("shaft1.order{order}")).expect("drawn").values;
    assert_eq!(top(torque), top(diagram(2)).max(top(diagram(3))));
}

/// Label, numbers and texts of the rows of a table in the report.
fn told(r: &RunResult, title: &str) -> Vec<(String, Vec<Option<f64>>, Vec<String>)> {
    let figure = r.figures.iter().find(|f| f.title == title).unwrap_or_else(|| panic!("no table {title}"));
    let FigureKind::Table { rows, texts, .. } = &figure.kind else { panic!("{title} is no table") };
    let texts = |k: usize| texts.iter().map(|t| t.1[k].clone()).collect();
    rows.iter().enumerate().map(|(k, (label, values))| (label.clone(), values.clone(), texts(k))).collect()
}

#[test]
fn every_limit_is_told_with_what_is_found_and_allowed() {
    let r = once("compressor-6-throw.toml", &[]);
    let rows = told(&r, "Limits");
    let worst = rows.iter().filter_map(|row| row.1[0]).fold(0.0, f64::max);
    assert_eq!(worst, r.results["worst_utilisation"].value);
    let heat =
        rows.iter().find(|row| row.0.starts_with("heat of")).expect("the coupling has a limit on heat");
    // What was judged is a result, and not only the heat at the mean speed.
    let found = r.results["envelope.shaft1.heat"].value;
    assert!(
        found >= r.results["shaft1.heat"].value && heat.2[0].starts_with(&format!("{found:.0}")[..2]),
        "{heat:?}"
    );
    assert!(heat.2[1].ends_with(" W") && !heat.2[3].is_empty(), "{heat:?}");
    // The peak that was judged stands in the table behind the curves.
    let envelope = &r.tables["envelope"];
    let drawn =
        envelope.columns.iter().filter(|c| c.name.starts_with("shaft1.step") && c.name.ends_with(".heat"));
    let top = drawn.flat_map(|c| c.values.iter().copied()).fold(0.0, f64::max);
    assert!((top / found - 1.0).abs() < 1e-12, "{top} {found}");
}

#[test]
fn curves_over_the_speed_reach_the_envelope() {
    let r = once("compressor-6-throw.toml", &["load_steps=[]"]);
    let top = r.results["envelope.shaft3.torque_amplitude"].value;
    let curve = r.tables["speed_range"].get("shaft3.torque_amplitude").expect("drawn");
    let drawn = curve.values.iter().copied().fold(0.0, f64::max);
    // The peak is a point of both.
    assert!((drawn / top - 1.0).abs() < 1e-12, "{drawn} {top}");
    let strongest = r.results["strongest_critical_speed"].value;
    let table = &r.tables["critical_speeds"];
    let torque = table.get("torque_amplitude").expect("weighed");
    let of = |k: usize| {
        (table.axis.values[k] >= 600.0 && table.axis.values[k] <= 1000.0).then(|| torque.values[k])
    };
    let most = (0..torque.values.len()).filter_map(of).fold(0.0, f64::max);
    let at = table.axis.values.iter().position(|w| *w == strongest).expect("one of the table");
    assert_eq!(torque.values[at], most);
}

/// The curves of a figure and what it marks.
fn drawn<'a>(r: &'a RunResult, title: &str) -> &'a Lines {
    let figure = r.figures.iter().find(|f| f.title == title).unwrap_or_else(|| panic!("no figure {title}"));
    let FigureKind::Lines(lines) = &figure.kind else { panic!("{title} has no curves") };
    lines
}

#[test]
fn every_shaft_has_a_curve_for_every_load_step() {
    let r = once("compressor-6-throw.toml", &[]);
    let table = &r.tables["shafts_over_speed"];
    let values = |column: &str| &table.get(column).unwrap_or_else(|| panic!("no {column}")).values;
    for (title, n) in [
        ("rubber coupling over the speed: torque", 1),
        ("crankshaft over the speed: stress", 2),
        ("crank 1-2 over the speed: stress", 3),
        ("crank 5-6 over the speed: stress", 7),
    ] {
        let lines = drawn(&r, title);
        let names: Vec<&str> = lines.lines.iter().map(|l| l.0.as_str()).collect();
        assert_eq!(
            names,
            [
                "full load",
                "head ends of stage 1 open",
                "all valves held open",
                "broken suction valve in throw 6"
            ]
        );
        assert!(lines.marks.iter().any(|m| matches!(m, Mark::Limit { .. })), "{title}");
        assert!(lines.marks.iter().any(|m| matches!(m, Mark::Band { kept_free: false, .. })), "{title}");
        let (label, over) = lines.over.as_ref().expect("an envelope");
        assert_eq!(label, "envelope");
        let top = |i: usize| lines.lines.iter().map(|l| values(&l.1)[i]).fold(0.0, f64::max);
        assert!(values(over).iter().enumerate().all(|(i, v)| *v == top(i)), "{title}");
        let what = if n == 1 { "torque" } else { "stress" };
        let largest = r.results[&format!("envelope.shaft{n}.{what}_amplitude")].value;
        let within =
            table.axis.values.iter().zip(values(over)).filter(|(w, _)| (600.0..=1000.0).contains(*w));
        let peak = within.map(|(_, v)| *v).fold(0.0, f64::max);
        // The largest of all load steps is a point of the curves; what is left is rounding of its unit.
        assert!((peak / largest - 1.0).abs() < 1e-12, "{title}: {peak} {largest}");
    }
    // Each curve is that of its own load step: run alone, it is that step. Both solve the same equations to a tolerance of 1e-10 from other starts; resonances enlarge that.
    let open = "throws.0.ends.0.cylinder_pressure.held_open=true";
    let other = "throws.1.ends.0.cylinder_pressure.held_open=true";
    let alone = once("compressor-6-throw.toml", &["load_steps=[]", open, other]);
    let reference = &alone.tables["speed_range"];
    let at = |t: &Series, column: &str, speed: f64| {
        let k = t.axis.values.iter().position(|w| (w - speed).abs() < 1e-9).expect("a speed of the diagram");
        t.get(column).expect("drawn").values[k]
    };
    for speed in [500.0, 800.0, 1100.0] {
        let own = at(reference, "shaft3.stress_amplitude", speed);
        let step = at(table, "shaft3.step2.stress_amplitude", speed);
        assert!((step / own - 1.0).abs() < 1e-6, "{speed}: {step} {own}");
        assert!((at(table, "shaft3.step1.stress_amplitude", speed) / own - 1.0).abs() > 1e-3, "{speed}");
    }
    // One load step has no envelope.
    let one = drawn(&alone, "crank 1-2 over the speed: stress");
    assert!(one.over.is_none() && one.lines.len() == 1);
}

#[test]
fn a_limit_of_a_shaft_stands_before_that_of_all_and_load_steps_part_limits() {
    let limits = |own: &str| {
        format!(
            "limits={{ stress = [{{ amplitude = \"40 MPa\", source = \"all\" }}, {{ shaft = \"crank 1-2\", amplitude = \"60 MPa\", source = \"own\"{own} }}] }}"
        )
    };
    let steps = "load_steps=[{ name = \"full\" }, { name = \"open\", set = [\"throws.0.ends.0.cylinder_pressure.held_open=true\"] }]";
    let sources = |r: &RunResult| -> Vec<String> {
        let own = told(r, "Limits").into_iter().filter(|row| row.0.starts_with("stress in crank 1-2"));
        own.map(|row| row.2[row.2.len() - 1].clone()).collect()
    };
    assert_eq!(sources(&once("compressor-6-throw.toml", &[&limits(""), steps])), ["own"]);
    let parted = once("compressor-6-throw.toml", &[&limits(", load_steps = [\"open\"]"), steps]);
    assert_eq!(sources(&parted), ["all", "own"]);
    let own = drawn(&parted, "crank 1-2 over the speed: stress");
    let marked: Vec<(f64, &str)> = own
        .marks
        .iter()
        .filter_map(|m| if let Mark::Limit { y, label } = m { Some((*y, label.as_str())) } else { None })
        .collect();
    assert_eq!(marked, [(40.0, "limit in full"), (60.0, "limit in open")]);
    let rows = told(&parted, "Limits");
    let labels: Vec<&String> = rows.iter().map(|r| &r.0).collect();
    assert!(labels.iter().enumerate().all(|(k, l)| !labels[..k].contains(l)), "{labels:?}");
    let own = rows.iter().find(|row| row.2[3] == "own").expect("told");
    assert_eq!(own.2[2], "open");
    let wrong = refused_of("compressor-6-throw.toml", &[&limits(", load_steps = [\"opn\"]"), steps]);
    assert!(wrong.contains("did you mean `open`"), "{wrong}");
}

#[test]
fn throws_say_where_their_outer_dead_centres_are() {
    let r = once(
        "compressor-6-throw.toml",
        &["load_steps=[]", "limits={}", "operating={ from = \"1000 rpm\", to = \"1000 rpm\" }"],
    );
    let at: Vec<f64> = told(&r, "Throws").iter().filter_map(|row| row.1[1]).collect();
    assert_eq!(at.len(), 6);
    let pairs = |deg: f64| at.iter().filter(|d| **d == deg).count();
    assert_eq!([pairs(0.0), pairs(120.0), pairs(240.0)], [2, 2, 2], "{at:?}");
    // The gas torque of a throw is that of its own angle: at its outer dead centre there is none.
    assert!(!told(&r, "Gas loads").is_empty());
}

#[test]
fn a_viscous_damper_moves_the_critical_speeds() {
    let damper = "dampers=[{ name = \"damper\", at = \"throw 6\", inertia = \"4 kg m2\", damping = \"3.5 kN m s/rad\" }]";
    let r = once("compressor-6-throw.toml", &["load_steps=[]", damper]);
    let value = |name: &str| r.results[name].value;
    let (damped, undamped) = (value("mode.2.damped_frequency"), value("mode.2.frequency"));
    let critical = value("critical_speed.mode2.order9");
    // The motor of the case has no damping of its own, so both are the same eigenvalue.
    assert!((critical / (60.0 * damped / 9.0) - 1.0).abs() < 1e-9, "{critical} {damped}");
    assert!(damped < 0.9 * undamped && note(&r, "with_damping").starts_with("damper damps"));
    let bare = once("compressor-6-throw.toml", &["load_steps=[]"]);
    assert_eq!(value("mode.2.nodes"), bare.results["mode.2.nodes"].value, "the ring is no place at rest");
}
