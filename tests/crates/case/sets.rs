//! Parameter sets: what a table takes over, what wins, what is refused and where.

use std::path::Path;

use gudgeon_case::{Loaded, Report, load_str, published};
use gudgeon_core::quantity::PosLength;
use gudgeon_core::sets::Sets;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

#[derive(Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Garage {
    cars: Vec<Car>,
}

#[derive(Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = Sets(r#"{
    "small": { "about": "a small one", "values": {
        "width": { "value": "1.6 m", "source": "someone2020" },
        "length": { "value": 3.7, "assumed": "they are" , "unless": ["half_length"] } } },
    "broken": { "about": "a width that is none", "values": { "width": { "value": "wide", "assumed": "for a test" } } } }"#))]
struct Car {
    width: PosLength,
    #[serde(default)]
    length: Option<PosLength>,
    #[serde(default)]
    half_length: Option<PosLength>,
}

fn load(text: &str, set: &[&str]) -> Result<Loaded<Garage>, Report> {
    let set: Vec<String> = set.iter().map(|s| (*s).to_owned()).collect();
    load_str("garage.toml", text, Path::new("."), &set)
}
fn cars(text: &str, set: &[&str]) -> Vec<(f64, Option<f64>)> {
    let loaded = load(text, set).expect("a case without mistakes");
    loaded.value.cars.iter().map(|c| (c.width.si(), c.length.map(|l| l.si()))).collect()
}
fn refused(text: &str) -> Report {
    load(text, &[]).expect_err("a mistake")
}

#[test]
fn a_table_takes_over_what_it_does_not_give() {
    assert_eq!(cars("[[cars]]\nset = \"small\"\n", &[]), [(1.6, Some(3.7))]);
    assert_eq!(cars("[[cars]]\nset = \"small\"\nwidth = \"2 m\"\n", &[]), [(2.0, Some(3.7))]);
    // An override wins like a key of the file, also over a set that another override names.
    assert_eq!(cars("[[cars]]\nset = \"small\"\n", &["cars.0.width=3"]), [(3.0, Some(3.7))]);
    assert_eq!(cars("[[cars]]\nwidth = 2\n", &["cars.0.set=small"]), [(2.0, Some(3.7))]);
    // Another way to say the same.
    assert_eq!(cars("[[cars]]\nset = \"small\"\nhalf_length = 2\n", &[]), [(1.6, None)]);
}

#[test]
fn what_was_taken_is_told() {
    let loaded = load("[[cars]]\nwidth = 2\n[[cars]]\nset = \"small\"\nwidth = 2\n", &[]).expect("a case");
    let [used] = &loaded.sets[..] else { panic!("one set: {:?}", loaded.sets) };
    assert_eq!(
        (used.path.as_str(), used.name.as_str(), used.own.as_slice()),
        ("cars.1", "small", &["width".to_owned()][..])
    );
    let assumed: Vec<String> = used.assumptions().collect();
    assert_eq!(assumed, ["cars.1.length = 3.7 of the set \"small\": assumed: they are."]);
    assert!(used.references().is_empty(), "the value with a source is the case's own");
}

#[test]
fn a_wrong_name_is_one_mistake_at_its_place() {
    let report = refused("[[cars]]\nset = \"smal\"\n");
    let [d] = &report.diagnostics[..] else { panic!("{:?}", report.diagnostics) };
    assert_eq!((d.path.as_str(), d.message.as_str()), ("cars.0.set", "there is no parameter set `smal`"));
    assert!(d.help.as_ref().is_some_and(|h| h.contains("did you mean `small`?")), "{:?}", d.help);
    assert_eq!(d.span, Some(15..21));
    let report = refused("[[cars]]\nset = 3\n");
    let [d] = &report.diagnostics[..] else { panic!("{:?}", report.diagnostics) };
    assert_eq!(d.message, "the name of a parameter set is wanted here, not an integer");
    // A value of a set that is wrong is a mistake where the set is named.
    let report = refused("[[cars]]\nset = \"broken\"\n");
    assert_eq!(report.diagnostics[0].span, Some(15..23), "{:?}", report.diagnostics);
    // Where there are none, the key is unknown.
    assert!(refused("set = \"small\"\ncars = []\n").diagnostics[0].message.contains("unknown key `set`"));
}

#[test]
fn editors_demand_nothing_that_a_set_gives() {
    let schema = published(&schemars::schema_for!(Car).to_value());
    assert_eq!(schema["properties"]["set"]["enum"], json!(["small", "broken"]));
    assert_eq!(
        (&schema["if"], &schema["else"]),
        (&json!({ "required": ["set"] }), &json!({ "required": ["width"] }))
    );
    assert!(schema.get("required").is_none() && schema.get("x-sets").is_none());
}
