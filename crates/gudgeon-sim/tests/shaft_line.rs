//! The scene `shaft_line`: what runs, what is skipped, what is refused, transients and limits.

use std::path::{Path, PathBuf};

use gudgeon_core::result::RunResult;
use gudgeon_sim::{check, explain, run};

fn case(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases").join(name)
}

fn once(name: &str, set: &[&str]) -> RunResult {
    let set: Vec<String> = set.iter().map(|s| (*s).to_owned()).collect();
    let c = check(&case(name), &set).unwrap_or_else(|r| panic!("{r}"));
    run(&c, &mut |_| {}).unwrap_or_else(|e| panic!("{e}"))
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
    for title in ["Verdict", "Mode shapes", "Interference diagram", "Torque in the shafts", "Shear stress"] {
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
    let base = ["models.throw_inertia.model=mean", "range={ orders = 12 }", "limits={}"];
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
    let r = run(&c, &mut |_| {}).expect("runs");
    assert!(r.solver.notes.iter().any(|n| n.text.contains("e.s: colour not read")), "{:?}", r.solver.notes);
    assert!(r.results.contains_key("mode.2.frequency") && !r.results.contains_key("mode.3.frequency"));
    let c = check(&file, &["shafts=[]".into(), "inertias=[]".into()]).unwrap_or_else(|r| panic!("{r}"));
    let r = run(&c, &mut |_| {}).expect("runs");
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
        ("models.torsion={ model = \"modal\", modes = 0 }", "at least one mode"),
        ("limits.torque.0.shaft=x", "there is no shaft `x`"),
        ("range.to=\"100 rpm\"", "must be above `from`"),
        ("inertias.0.ratio=0", "would not turn"),
        ("shafts.0.pieces=[{ length = 1, diameter = 0.1 }]", "exactly one of"),
        ("drives.0.drive={ model = \"linear\", intercept = 1 }", "`intercept` and `slope`"),
        ("range.points=1", "between 2 and 20000"),
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
        run(&c, &mut |_| {}).expect("runs").results["mode.1.omega"].value
    };
    let mut exact = set.clone();
    exact[7] = format!("speed={omega:?}");
    let c = check(&case("compressor-4-throw.toml"), &exact).unwrap_or_else(|r| panic!("{r}"));
    let e = run(&c, &mut |_| {}).expect_err("a resonance").to_string();
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
