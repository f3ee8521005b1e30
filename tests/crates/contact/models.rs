//! Every contact model of this crate through the front door: registry, case syntax, defaults, refusals.

use gudgeon_core::Registry;
use gudgeon_core::kinds::{Contact, ContactSpec};

fn read(toml: &str) -> Result<Box<dyn ContactSpec>, toml::de::Error> {
    toml::from_str(toml)
}

fn build(toml: &str) -> Box<dyn Contact> {
    read(toml).expect("reads").build().expect("builds")
}

#[test]
fn every_model_is_described_and_its_example_runs() {
    let registry = Registry::collect();
    let mine: Vec<_> = registry.models("contact").iter().map(|m| m.name).collect();
    assert_eq!(
        mine,
        [
            "abbott_firestone",
            "crest_wedge",
            "film_floor",
            "greenwood_tripp",
            "greenwood_williamson",
            "kogut_etsion",
            "linear_penalty",
            "load_sharing",
            "off",
            "roughness_threshold"
        ]
    );
    if let Err(e) = registry.verify() {
        // This crate links no other kind's models, so only complaints about contact count.
        assert!(!e.iter().any(|e| e.to_string().contains("contact")), "{e:?}");
    }
    for m in registry.models("contact") {
        let model = build(&format!("model = \"{}\"\n{}", m.name, m.example));
        let h = [0.0, 1e-7, 1e-6, 1e-5, 1.0];
        let mut p = [f64::NAN; 5];
        model.pressure(&h, &mut p);
        assert!(p.iter().all(|p| p.is_finite() && *p >= 0.0), "{}", m.name);
        assert!(p.windows(2).all(|w| w[1] <= w[0]), "{}", m.name);
        assert!(model.range() >= 0.0 && model.range().is_finite());
        // Beyond the range nothing is carried: 1e-12 of the value at zero is the contract.
        let mut far = [f64::NAN];
        model.pressure(&[model.range()], &mut far);
        assert!(far[0] <= 1e-12 * p[0], "{}", m.name);
    }
}

#[test]
fn a_resolved_specification_reads_back() {
    let registry = Registry::collect();
    let kind = registry.kind("contact").expect("exists");
    for m in registry.models("contact") {
        let spec: toml::Table =
            toml::from_str(&format!("model = \"{}\"\n{}", m.name, m.example)).expect("parses");
        let once = (kind.resolve)(serde_json::to_value(spec).expect("json")).expect("resolves");
        let twice = (kind.resolve)(once.clone()).expect("resolves again");
        assert_eq!(once, twice);
    }
}

#[test]
fn switches() {
    let t = build("model = \"roughness_threshold\"\nroughness = \"0.2 um\"");
    assert_eq!(
        (t.floor(), t.friction_coefficient(), t.floor_replaces_film(), t.range()),
        (Some(0.2e-6), 0.10, true, 0.0)
    );
    let f = build("model = \"film_floor\"");
    assert_eq!(
        (f.floor(), f.friction_coefficient(), f.floor_replaces_film(), f.range()),
        (Some(1e-7), 0.0, false, 0.0)
    );
    let o = build("model = \"off\"");
    assert_eq!(
        (o.floor(), o.friction_coefficient(), o.floor_replaces_film(), o.range()),
        (None, 0.0, false, 0.0)
    );
    let g = build(
        "model = \"greenwood_tripp\"\nroughness = \"0.4 um\"\ncomposite_modulus = \"115 GPa\"\nasperity_density = \"3.1e5 1/mm2\"\nasperity_radius = \"0.4 mm\"\nintegral = \"hu1994\"",
    );
    // The power law ends at four roughness heights; the product is rounded once.
    assert!((g.range() / 1.6e-6 - 1.0).abs() < 1e-15);
    assert_eq!((g.floor(), g.friction_coefficient(), g.floor_replaces_film()), (None, 0.10, false));
}

#[test]
fn refusals_name_the_fault() {
    let e = |t: &str| read(t).err().map(|e| e.to_string()).unwrap_or_default();
    assert!(e("model = \"off\"\nroughness = 1").contains("unknown key `roughness`"));
    assert!(e("model = \"roughness_threshold\"").contains("missing key `roughness`"));
    assert!(e("model = \"roughness_threshold\"\nroughness = \"0 um\"").contains("greater than zero"));
    assert!(e("model = \"film_floor\"\nfriction_coefficient = -0.1").contains("zero or greater"));
    assert!(e("model = \"greenwood_tripp\"\nroughness = \"1 um\"\ncomposite_modulus = \"1 GPa\"\nintegral = \"hu\"").contains("hu1994"));
}
