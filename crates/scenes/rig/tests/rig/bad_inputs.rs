//! Whatever a case says, a bench refuses it or gives finite numbers; it never panics. Every value of a case that runs is replaced by
//! nonsense and by extremes, one at a time, and then several at once.

use gudgeon_contact as _;
use gudgeon_core::file::Files;
use gudgeon_core::kinds::{RigCtx, RigOut, RigSpec};
use gudgeon_film as _;
use gudgeon_ring as _;
use gudgeon_scene_rig as _;
use toml::Value;

/// Cases with all keys that take numbers.
const CASES: &[&str] = &[
    r#"model = "contact_pair"
from = "-0.2 um"
to = "2 um"
separation = "0.4 um"
speed = "0.1 m/s"
contact = { model = "greenwood_tripp", roughness = "0.4 um", composite_modulus = "115 GPa", eta_beta_sigma = 0.05, sigma_over_beta = 1e-3, friction_coefficient = 0.1 }
boundary_friction = { model = "stribeck", static_coefficient = 0.15, kinetic_coefficient = 0.10, stribeck_speed = "0.1 m/s", rounding_speed = "0.01 m/s", exponent = 2.0 }"#,
    r#"model = "contact_pair"
to = "2 um"
separation = "0.4 um"
contact = { model = "crest_wedge", amplitude = "4 um", pitch = "0.25 mm", composite_modulus = "44 GPa", deflection = 1.077 }"#,
    r#"model = "rough_surface"
height = "0.5 um"
from = -1.0
to = 8.0
separation = 3.0
roughness = { model = "patir_cheng", liner_roughness = "0.3 um", body_roughness = "0.4 um" }"#,
    r#"model = "rough_surface"
height = "4 um"
from = -1.0
to = 8.0
separation = 3.0
roughness = { model = "sawtooth_waviness", amplitude = "4 um" }"#,
    r#"model = "lubricant"
temperature = "100 degC"
pressure = "50 MPa"
shear_rate = "1e6 1/s"
coldest = "20 degC"
hottest = "200 degC"
highest_pressure = "500 MPa"
highest_shear_rate = "1e8 1/s"
oil = { model = "vogel", a = "0.15 mPa s", b = 720.0, c = 71.0 }
piezoviscosity = { model = "roelands", exponent = 0.6 }
shear_thinning = { model = "carreau", critical_shear_rate = "1e6 1/s", exponent = 0.7, high_shear_ratio = 0.5 }
compressibility = { model = "dowson_higginson", a = "0.6 1/GPa", b = "1.7 1/GPa" }"#,
    r#"model = "gas_passage"
pressure = "50 bar"
ratio = 0.9
temperature = "400 K"
gamma = 1.4
gas_constant = "287 J/(kg K)"
passage = { law = "orifice", area = "0.3 mm2" }
orifice = { discharge = 0.86, laminar = 1e-3 }"#,
    r#"model = "gas_passage"
pressure = "10 bar"
ratio = 0.2
temperature = "450 K"
passage = { law = "blended_channel", width = "300 mm", height = "10 um", length = "2 mm", viscosity = "0.02 mPa s" }"#,
    r#"model = "gas_volumes"
gamma = 1.4
gas_constant = "287 J/(kg K)"
tolerance = 1e-4
run = { until = "time", duration = "0.01 s" }
volumes = [{ name = "vessel", volume = "200 mm3", temperature = "400 K", pressure = "50 bar" }]
boundaries = [{ name = "ambient", temperature = "400 K", pressure = "1 bar" }]
openings = [{ from = "vessel", to = "ambient", area = "0.02 mm2" }]"#,
    r#"model = "gas_volumes"
run = { until = "steady" }
volumes = [
    { name = "land2", volume = "200 mm3", temperature = "400 K", pressure = "50 bar" },
    { name = "land3", volume = "300 mm3", temperature = "400 K", pressure = "1 bar" },
]
boundaries = [{ name = "ambient", temperature = "400 K", pressure = "1 bar" }]
openings = [{ from = "land2", to = "land3", area = "0.02 mm2" }, { from = "land3", to = "ambient", area = "0.02 mm2" }]"#,
    r#"model = "gas_volumes"
tolerance = 1e-3
run = { until = "periodic", speed = "3000 rpm", period = "720 deg", angle = "380 deg" }
volumes = [{ name = "land2", volume = "600 mm3", temperature = "450 K", pressure = "1 bar" }]
boundaries = [
    { name = "chamber", temperature = "450 K", pressure = "1 bar", pulses = [{ height = "60 bar", at = "370 deg", width = "25 deg" }] },
    { name = "crankcase", temperature = "450 K", pressure = "1 bar" },
]
openings = [{ from = "chamber", to = "land2", area = "0.3 mm2" }, { from = "land2", to = "crankcase", area = "0.4 mm2" }]"#,
    r#"model = "flank"
clearance = "100 um"
area = "1000 mm2"
width = "3 mm"
oil_fill = 0.6
viscosity = "12 mPa s"
mass = "12 g"
load = "60 N"
height = "30 um"
velocity = "-0.1 m/s"
duration = "20 ms"
speed = "10 mm/s"
tolerance = 1e-6
flank = { model = "squeeze_film", roughness = "0.4 um", separation = 0.1, tension = "1 bar" }"#,
    r#"model = "flank"
clearance = "100 um"
area = "1000 mm2"
width = "3 mm"
viscosity = "12 mPa s"
load = "60 N"
height = "30 um"
duration = "20 ms"
tolerance = 1e-6
flank = { model = "tangent_degrees" }"#,
];

/// What replaces a value.
const REPLACEMENTS: &[&str] = &[
    "0.0",
    "-1.0",
    "1e300",
    "-1e300",
    "1e-300",
    "5e-324",
    "1.7976931348623157e308",
    "inf",
    "-inf",
    "nan",
    "1e12",
    "1e-12",
    "\"\"",
    "\"nan\"",
    "\"inf m\"",
    "\"1e999 mm\"",
    "\"-0\"",
    "\"none\"",
    "true",
    "[]",
    "{}",
    "\"1 furlong\"",
];

/// Runs a case: `Ok` of finite results, or why it was refused.
fn attempt(case: &Value) -> Result<RigOut, String> {
    let spec: Box<dyn RigSpec> = case.clone().try_into().map_err(|e: toml::de::Error| e.to_string())?;
    let ctx = RigCtx { files: &Files::default() };
    let mut rig = spec.build(&ctx).map_err(|e| {
        assert!(!e.is_empty(), "refused without a reason");
        e.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
    })?;
    let mut out = RigOut::default();
    rig.run(&mut out).map_err(|e| e.to_string())?;
    for (name, v) in &out.results {
        assert!(v.value.is_finite(), "{name} is {} for\n{case}", v.value);
    }
    for t in std::iter::once(&out.series).chain(out.tables.values()) {
        for c in std::iter::once(&t.axis).chain(&t.columns) {
            assert_eq!(c.values.len(), t.axis.values.len(), "{} for\n{case}", c.name);
            assert!(c.values.iter().all(|v| v.is_finite()), "{} for\n{case}", c.name);
        }
    }
    Ok(out)
}

/// Calls `f` with every leaf of a case but the names of models.
fn leaves(v: &Value, path: &mut Vec<String>, f: &mut dyn FnMut(&[String])) {
    match v {
        Value::Table(t) => {
            for (k, v) in t {
                if k == "model" {
                    continue;
                }
                path.push(k.clone());
                leaves(v, path, f);
                path.pop();
            }
        }
        Value::Array(a) => {
            for (i, v) in a.iter().enumerate() {
                path.push(i.to_string());
                leaves(v, path, f);
                path.pop();
            }
        }
        _ => f(path),
    }
}

fn put(case: &mut Value, path: &[String], new: Value) {
    let mut at = case;
    for step in path {
        at = match at {
            Value::Table(t) => t.get_mut(step).expect("a key"),
            Value::Array(a) => &mut a[step.parse::<usize>().expect("a number")],
            _ => panic!("a leaf has no parts"),
        };
    }
    *at = new;
}

/// A replacement, with the unit of the value that it replaces when that has one and it is a number.
fn replacement(text: &str, old: &Value) -> Value {
    let table: toml::Table = toml::from_str(&format!("v = {text}")).expect("replacements are TOML");
    let new = table["v"].clone();
    match (old, &new) {
        (Value::String(s), Value::Float(_)) if s.starts_with(|c: char| c.is_ascii_digit() || c == '-') => {
            let unit = s.split_once(' ').map_or("", |(_, u)| u);
            Value::String(format!("{text} {unit}").trim().to_owned())
        }
        _ => new,
    }
}

fn at<'a>(case: &'a Value, path: &[String]) -> &'a Value {
    path.iter().fold(case, |v, step| match v {
        Value::Array(a) => &a[step.parse::<usize>().expect("a number")],
        _ => &v[step.as_str()],
    })
}

fn read(case: &str) -> Value {
    Value::Table(toml::from_str(case).expect("the cases are TOML"))
}

#[test]
fn the_cases_themselves_run() {
    for case in CASES {
        let out = attempt(&read(case)).unwrap_or_else(|e| panic!("{e}\n{case}"));
        assert!(!out.results.is_empty() && !out.figures.is_empty(), "{case}");
    }
}

#[test]
fn every_value_replaced() {
    let (mut refused, mut ran) = (0, 0);
    for case in CASES {
        let case = read(case);
        let mut paths = Vec::new();
        leaves(&case, &mut Vec::new(), &mut |p| paths.push(p.to_vec()));
        for path in &paths {
            for text in REPLACEMENTS {
                let mut changed = case.clone();
                put(&mut changed, path, replacement(text, at(&case, path)));
                match attempt(&changed) {
                    Ok(_) => ran += 1,
                    Err(e) => {
                        assert!(!e.is_empty());
                        refused += 1;
                    }
                }
            }
        }
    }
    // Both happen: the replacements are neither all nonsense nor all harmless.
    assert!(refused > 1000 && ran > 300, "{refused} refused, {ran} ran");
}

#[test]
fn several_values_replaced() {
    // Knuth's MMIX generator.
    let mut state = 7u64;
    let mut next = |n: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 33) as usize) % n
    };
    // Numbers only: nonsense would hide what the others do.
    const NUMBERS: [&str; 8] = ["0.0", "1e300", "1e-300", "5e-324", "1e12", "1e-12", "1e-3", "1e3"];
    for case in CASES {
        let case = read(case);
        let mut paths = Vec::new();
        leaves(&case, &mut Vec::new(), &mut |p| {
            let text =
                at(&case, p).as_str().is_none_or(|s| s.starts_with(|c: char| c.is_ascii_digit() || c == '-'));
            if text {
                paths.push(p.to_vec());
            }
        });
        for _ in 0..60 {
            let mut changed = case.clone();
            for _ in 0..2 + next(2) {
                let path = &paths[next(paths.len())];
                put(&mut changed, path, replacement(NUMBERS[next(NUMBERS.len())], at(&case, path)));
            }
            let _ = attempt(&changed);
        }
    }
}

#[test]
fn refusals_name_the_place() {
    let fields = |case: &str| {
        let spec: Box<dyn RigSpec> = read(case).try_into().expect("reads");
        match spec.build(&RigCtx { files: &Files::default() }) {
            Ok(_) => panic!("built"),
            Err(e) => e.into_iter().map(|e| e.field).collect::<Vec<_>>(),
        }
    };
    // Everything that is wrong at once.
    assert_eq!(
        fields(
            "model = \"gas_volumes\"\nrun = { until = \"time\", speed = \"1 rpm\" }\ngamma = 3.0\n\
             volumes = [{ name = \"a\", volume = \"1 l\", temperature = \"300 K\", pressure = \"1 bar\" }, \
             { name = \"a\", volume = \"1 l\", temperature = \"300 K\", pressure = \"1 bar\" }]\n\
             openings = [{ from = \"a\", to = \"b\", area = \"1 mm2\" }]"
        ),
        ["volumes.1.name", "openings.0.to", "run.duration", "run.speed", "gamma"]
    );
    assert_eq!(
        fields(
            "model = \"gas_passage\"\npressure = \"1 bar\"\nratio = 0.5\ntemperature = \"300 K\"\n\
             orifice = { discharge = 1.5 }\npassage = { law = \"channel\", area = \"1 mm2\", width = \"1 mm\" }"
        ),
        ["orifice.discharge", "passage.area", "passage.height", "passage.length"]
    );
    assert_eq!(
        fields(
            "model = \"flank\"\nclearance = \"0.1 mm\"\narea = \"1 mm2\"\nwidth = \"3 mm\"\nviscosity = \"1 mPa s\"\n\
             load = \"60 N\"\nheight = \"1 mm\"\nvelocity = \"1 m/s\"\nduration = \"1 s\"\ntolerance = 1.0\nflank = { model = \"dry\" }"
        ),
        ["height", "velocity", "tolerance"]
    );
    assert_eq!(
        fields(
            "model = \"lubricant\"\ntemperature = \"300 K\"\ncoldest = \"400 K\"\nhottest = \"300 K\"\n\
             oil = { model = \"constant\", viscosity = \"1 mPa s\" }\n\
             compressibility = { model = \"dowson_higginson\", a = \"2 1/GPa\", b = \"1 1/GPa\" }"
        ),
        ["hottest", "compressibility.a"]
    );
    assert_eq!(
        fields("model = \"contact_pair\"\nto = \"-1 um\"\nseparation = 0.0\ncontact = { model = \"off\" }"),
        ["to"]
    );
    assert_eq!(
        fields(
            "model = \"rough_surface\"\nheight = \"1 um\"\nseparation = 1.0\nfrom = 9.0\nroughness = { model = \"off\" }"
        ),
        ["to"]
    );
}
