//! What every registered model must keep, whoever wrote it: `models`, `describe`, `schema`, case files and reports rely
//! on nothing else. A new model is checked here without a line of its own, but for its name in `registered.txt`.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use gudgeon_core::{ModelInfo, Registry};
use serde_json::{Map, Value};

/// How the physics of each kind is switched off: its `off` model, or the model that takes its place by giving the
/// answer instead of computing it. A piston always moves and a pin always
/// bears, so `kinematics` and `pin_strength` have none; a bench without a model is none; of two conventions one holds.
const SWITCHED_OFF: &[(&str, Option<&str>)] = &[
    ("axial_gas", None),
    ("boundary_friction", Some("off")),
    ("cavitation_datum", None),
    ("compressibility", Some("off")),
    ("contact", Some("off")),
    ("coupling", Some("off")),
    ("cylinder_pressure", Some("constant")),
    ("drag", None),
    ("drive", Some("off")),
    ("fatigue", Some("off")),
    ("film_1d", Some("off")),
    ("film_2d", Some("off")),
    ("film_force", None),
    ("film_temperature", Some("given")),
    ("flank_damping", Some("off")),
    ("flank_friction", Some("off")),
    ("gas_flow", Some("prescribed")),
    ("groove_friction", Some("off")),
    ("hoop", None),
    ("hydrodynamics", Some("off")),
    ("kinematics", None),
    ("natural_frequencies", None),
    ("oil", Some("constant")),
    ("oil_transport", Some("off")),
    ("piezoviscosity", Some("off")),
    ("pin_friction", Some("off")),
    ("pin_load", Some("given")),
    ("pin_strength", None),
    ("piston_solver", None),
    ("profile_curve", None),
    ("radial_gas", None),
    ("radial_motion", None),
    ("rig", None),
    ("ring_motion", Some("seated")),
    ("ring_pack_solver", None),
    ("roughness", Some("off")),
    ("secondary_motion", Some("held")),
    ("shear_thinning", Some("off")),
    ("skirt_compliance", Some("rigid")),
    ("skirt_profile", Some("cylindrical")),
    ("throw_inertia", Some("off")),
    ("torsion", Some("off")),
    ("twin_land_friction", None),
];

fn path(m: &ModelInfo) -> String {
    format!("{}/{}", m.kind, m.name)
}

/// Calls `check` for every model and reports all complaints together.
fn for_every_model(check: impl Fn(&Registry, &'static ModelInfo) -> Vec<String>) {
    let registry = Registry::collect();
    let mut complaints = Vec::new();
    let mut models = 0;
    for kind in registry.kinds() {
        for m in registry.models(kind.kind) {
            models += 1;
            complaints.extend(check(&registry, m).into_iter().map(|c| format!("{}: {c}", path(m))));
        }
    }
    assert!(models > 0, "no model is linked");
    assert!(complaints.is_empty(), "\n{}", complaints.join("\n"));
}

/// The example as a specification: its TOML with the key that selects the model.
fn example(m: &ModelInfo) -> Result<Map<String, Value>, String> {
    let mut table: Map<String, Value> =
        toml::from_str(m.example).map_err(|e| format!("the example is not TOML: {e}"))?;
    if table.insert("model".into(), m.name.into()).is_some() {
        return Err("the example must not contain the key `model`".into());
    }
    Ok(table)
}

fn resolve(
    registry: &Registry,
    m: &ModelInfo,
    spec: Map<String, Value>,
) -> Result<Map<String, Value>, String> {
    let kind = registry.kind(m.kind).ok_or("its kind does not exist")?;
    match (kind.resolve)(Value::Object(spec)) {
        Ok(Value::Object(o)) => Ok(o),
        Ok(other) => Err(format!("resolves to {other}, which is no table")),
        Err(e) => Err(e.to_string()),
    }
}

/// The schema of a model and what it refers to.
fn schema(m: &ModelInfo) -> (Value, Map<String, Value>) {
    let mut g = schemars::SchemaGenerator::default();
    let s = (m.schema)(&mut g).to_value();
    (s, g.take_definitions(true))
}

fn properties(schema: &Value) -> Map<String, Value> {
    schema.get("properties").and_then(Value::as_object).cloned().unwrap_or_default()
}

fn required(schema: &Value) -> BTreeSet<String> {
    let names = schema.get("required").and_then(Value::as_array).into_iter().flatten();
    names.filter_map(Value::as_str).map(str::to_owned).collect()
}

#[test]
fn the_registry_does_not_contradict_itself() {
    assert_eq!(Registry::collect().verify(), Ok(()));
}

/// A model that is missing in the list was added without anyone noticing, or is no longer linked. `tests/wasm/run` compares the same file with what is
/// registered on WebAssembly.
#[test]
fn what_is_registered_is_the_list_of_registered_txt() {
    let found = gudgeon_models::registered();
    if found != include_str!("registered.txt") {
        let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("registered.txt");
        std::fs::write(&file, &found).expect("the folder for files of tests can be written");
        panic!(
            "not the list of crates/gudgeon-models/tests/registered.txt; what is registered now stands in {}",
            file.display()
        );
    }
}

/// On targets whose linker keeps what is referred to, and nothing else, a model that its crate's `link!` does not name is lost.
#[test]
fn every_crate_links_all_that_it_registers() {
    let registry = Registry::collect();
    let mut registered: BTreeMap<&str, usize> = BTreeMap::new();
    for m in registry.kinds().flat_map(|k| registry.models(k.kind)) {
        *registered.entry(m.crate_name()).or_default() += 1;
    }
    for s in gudgeon_scene::scenes() {
        *registered.entry(s.crate_name()).or_default() += 1;
    }
    assert_eq!(gudgeon_models::linked().collect::<BTreeMap<_, _>>(), registered);
    assert_eq!(gudgeon_models::link(), registered.values().sum::<usize>());
}

#[test]
fn every_physics_can_be_switched_off() {
    let registry = Registry::collect();
    let kinds: Vec<&str> = registry.kinds().map(|k| k.kind).collect();
    let listed: Vec<&str> = SWITCHED_OFF.iter().map(|(k, _)| *k).collect();
    assert_eq!(kinds, listed, "the list at the top of this file says how each kind is switched off");
    for (kind, model) in SWITCHED_OFF {
        if let Some(model) = model {
            assert!(registry.model(kind, model).is_some(), "{kind}/{model} does not exist");
        }
    }
}

#[test]
fn names_are_snake_case_and_equal_the_file_name() {
    for_every_model(|_, m| {
        let mut wrong = Vec::new();
        if !m.name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_') {
            wrong.push("the name is not snake_case".into());
        }
        let stem = Path::new(m.file).file_stem().and_then(|s| s.to_str()).unwrap_or_default();
        // `off` and `constant` exist in several kinds; a crate with more than one puts them into a folder or module.
        if stem != m.name {
            wrong.push(format!("stands in {}, the file should be {}.rs", m.file, m.name));
        }
        wrong
    });
}

#[test]
fn every_model_says_what_it_is() {
    for_every_model(|registry, m| {
        let mut wrong = Vec::new();
        for (what, text) in [("summary", m.summary), ("equations", m.equations), ("validity", m.validity)] {
            if text.trim().is_empty() {
                wrong.push(format!("has no {what}"));
            }
        }
        if m.summary.contains('\n') || m.summary.len() > 120 {
            wrong.push("the summary is not one line".into());
        }
        if registry.kind(m.kind).is_none_or(|k| k.summary.trim().is_empty()) {
            wrong.push("its kind has no summary".into());
        }
        wrong
    });
}

#[test]
fn examples_are_read_and_written_back_to_the_same() {
    for_every_model(|registry, m| {
        let check = || {
            let full = resolve(registry, m, example(m)?)?;
            let again = resolve(registry, m, full.clone())?;
            // The resolved form holds every value in SI with all its digits, so nothing may change a second time.
            if again != full { Err(format!("{full:?} reads back as {again:?}")) } else { Ok(()) }
        };
        check().err().into_iter().collect()
    });
}

#[test]
fn unknown_keys_are_refused() {
    for_every_model(|registry, m| {
        let check = || {
            let mut spec = example(m)?;
            spec.insert("no_such_key".into(), 1.into());
            match resolve(registry, m, spec) {
                Ok(_) => Err("accepts the key `no_such_key`; is `deny_unknown_fields` missing?".to_owned()),
                Err(e) if !e.contains("no_such_key") => Err(format!("does not name the unknown key: {e}")),
                Err(_) => Ok(()),
            }
        };
        check().err().into_iter().collect()
    });
}

#[test]
fn schema_and_reader_agree_about_keys() {
    for_every_model(|registry, m| {
        let mut wrong = Vec::new();
        let (schema, _) = schema(m);
        let (properties, required) = (properties(&schema), required(&schema));
        let full = match example(m).and_then(|e| resolve(registry, m, e)) {
            Ok(full) => full,
            Err(e) => return vec![e],
        };
        for key in full.keys().filter(|k| *k != "model" && !properties.contains_key(*k)) {
            wrong.push(format!("`{key}` is written but the schema does not know it"));
        }
        if schema.get("additionalProperties") != Some(&Value::Bool(false)) {
            wrong.push("the schema allows unknown keys".into());
        }
        for key in properties.keys().filter(|k| full.contains_key(*k)) {
            let mut less = full.clone();
            less.remove(key);
            match (resolve(registry, m, less), required.contains(key)) {
                (Ok(_), true) => wrong.push(format!("the schema requires `{key}`, the reader does not")),
                (Err(e), false) => {
                    wrong.push(format!("`{key}` has no default although the schema says so: {e}"))
                }
                (Err(e), true) if !e.contains(key.as_str()) => {
                    wrong.push(format!("the missing key `{key}` is not named: {e}"));
                }
                _ => {}
            }
        }
        for key in required.iter().filter(|k| !full.contains_key(*k)) {
            wrong.push(format!("the schema requires `{key}`, the example lacks it"));
        }
        wrong
    });
}

/// Complains about every key under `schema` that has no description, wherever it stands.
fn described(schema: &Value, definitions: &Map<String, Value>, place: &str, wrong: &mut Vec<String>) {
    let describes = |s: &Value| {
        let of = |key: &str| s.get(key).and_then(Value::as_str).unwrap_or_default().trim().to_owned();
        // A quantity without a doc comment still says of itself "a length, greater than zero".
        let own = format!("{}, {}", of("x-dimension"), of("x-bound"));
        !of("description").is_empty() && of("description") != own
    };
    for (key, p) in properties(schema) {
        let own = format!("{place}{key}");
        if !describes(&p) {
            wrong.push(format!("`{own}` has no description in the schema; write a doc comment"));
        }
        described(&p, definitions, &format!("{own}."), wrong);
    }
    if place.is_empty() {
        // What is referred to is described once, under its own name. Kinds are checked model by model.
        for (name, s) in definitions {
            if s.get("oneOf").is_none() {
                described(s, definitions, &format!("{name}."), wrong);
            }
            for choice in s.get("oneOf").and_then(Value::as_array).into_iter().flatten() {
                if let Some(word) = choice.get("const").filter(|_| !describes(choice)) {
                    wrong.push(format!("the word {word} of `{name}` has no description"));
                }
            }
            for word in s.get("enum").and_then(Value::as_array).into_iter().flatten() {
                wrong.push(format!("the word {word} of `{name}` has no description"));
            }
        }
    }
}

#[test]
fn every_parameter_is_described() {
    for_every_model(|_, m| {
        let (schema, definitions) = schema(m);
        let mut wrong = Vec::new();
        described(&schema, &definitions, "", &mut wrong);
        wrong
    });
}

/// The entries of a BibTeX file: key to text. Enough of the format for a file that this project writes itself.
fn bibliography(text: &str) -> BTreeMap<&str, &str> {
    let entries = text.split("\n@").skip(1);
    let entries = entries.filter_map(|e| {
        let (head, body) = e.split_once(',')?;
        Some((head.split_once('{')?.1.trim(), body))
    });
    entries.collect()
}

#[test]
fn a_parameter_without_description_is_noticed() {
    #[derive(schemars::JsonSchema)]
    #[expect(dead_code, reason = "only its schema is looked at")]
    struct Sloppy {
        silent: gudgeon_core::quantity::PosLength,
        /// Described.
        told: gudgeon_core::quantity::PosLength,
        inner: Inner,
    }
    /// A table in the table.
    #[derive(schemars::JsonSchema)]
    #[expect(dead_code, reason = "only its schema is looked at")]
    struct Inner {
        mute: f64,
    }
    let mut g = schemars::SchemaGenerator::default();
    let schema = <Sloppy as schemars::JsonSchema>::json_schema(&mut g).to_value();
    let mut wrong = Vec::new();
    described(&schema, &g.take_definitions(true), "", &mut wrong);
    let found: Vec<_> = wrong.iter().filter_map(|w| w.split('`').nth(1)).collect();
    assert_eq!(found, ["silent", "inner", "Inner.mute"], "{wrong:?}");
}

#[test]
fn every_reference_stands_in_the_bibliography() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../REFERENCES.bib");
    let text = std::fs::read_to_string(&file).expect("REFERENCES.bib stands at the root of the repository");
    let known = bibliography(&text);
    assert_eq!(known.len(), text.matches("\n@").count(), "a key stands twice");
    for (key, body) in &known {
        for field in ["author", "title", "year"] {
            let has = body.lines().any(|l| l.trim_start().starts_with(field));
            assert!(has, "{key} has no {field}");
        }
        assert_eq!(body.matches('{').count() + 1, body.matches('}').count(), "{key}: braces do not match");
    }
    for_every_model(|_, m| {
        let missing = m.references.iter().filter(|r| !known.contains_key(*r));
        missing.map(|r| format!("`{r}` is not in REFERENCES.bib")).collect()
    });
}
