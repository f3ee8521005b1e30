//! Registered models.

use gudgeon_core::kinds::{Oil, OilSpec};
use gudgeon_core::quantity::{PosLength, PosViscosity};
use gudgeon_core::{BuildError, ModelInfo, Registry, register_model};
use gudgeon_testkit::{Bibliography, assert_none, check_all, check_crate, contract, undescribed};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// As it should be, in a file of its name.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Contract {
    /// Dynamic viscosity.
    viscosity: PosViscosity,
    /// Its part above a threshold.
    #[serde(default)]
    part: f64,
}

#[register_model(
    name = "contract",
    summary = "an oil that does not know its temperature",
    equations = "mu = constant",
    validity = "tests",
    references = ["somebody2000"],
    example = "viscosity = \"0.1 Pa s\"\n"
)]
impl OilSpec for Contract {
    fn build(&self) -> Result<Box<dyn Oil>, BuildError> {
        Err(BuildError::new("never asked"))
    }
}

fn right() -> ModelInfo {
    ModelInfo { ..*Registry::collect().model("oil", "contract").expect("registered above") }
}

#[test]
fn a_good_model_passes_and_is_counted() {
    assert_eq!(check_crate("testkit"), 1);
    assert_eq!(check_all(), 1);
}

#[test]
#[should_panic(expected = "no model of the crate `elsewhere` is linked")]
fn a_crate_that_is_not_linked_is_noticed() {
    check_crate("elsewhere");
}

type Spoil = fn(&mut ModelInfo);

#[test]
fn everything_wrong_is_told() {
    let registry = Registry::collect();
    let spoiled: [(&str, Spoil); 10] = [
        ("not snake_case", |m| m.name = "Contract"),
        ("the file should be contract.rs", |m| m.file = "src/other.rs"),
        ("has no summary", |m| m.summary = " "),
        ("the summary is not one line", |m| m.summary = "a\nb"),
        ("has no equations", |m| m.equations = ""),
        ("has no validity", |m| m.validity = ""),
        ("its kind has no summary", |m| m.kind = "nothing"),
        ("the example is not TOML", |m| m.example = "= 1"),
        ("must not contain the key `model`", |m| m.example = "model = \"contract\""),
        ("viscosity", |m| m.example = ""),
    ];
    assert_none(contract(&registry, &right()));
    for (complaint, spoil) in spoiled {
        let mut m = right();
        spoil(&mut m);
        let found = contract(&registry, &m);
        assert!(found.iter().any(|c| c.contains(complaint)), "{complaint}: {found:?}");
    }
}

/// A schema that is not that of the reader.
#[derive(JsonSchema)]
#[expect(dead_code, reason = "only its schema is looked at")]
struct Other {
    /// The reader has no such key.
    length: PosLength,
    /// The reader has a default.
    part: f64,
}

#[test]
fn a_schema_that_is_not_the_readers_is_noticed() {
    let mut m = right();
    m.schema = |g| <Other as JsonSchema>::json_schema(g);
    let found = contract(&Registry::collect(), &m);
    for complaint in [
        "`viscosity` is written but the schema does not know it",
        "the schema allows unknown keys",
        "the schema requires `part`, the reader does not",
        "the schema requires `length`, the example lacks it",
    ] {
        assert!(found.iter().any(|c| c == complaint), "{complaint}: {found:?}");
    }
}

#[test]
fn a_parameter_without_description_is_noticed() {
    #[derive(JsonSchema)]
    #[expect(dead_code, reason = "only its schema is looked at")]
    struct Sloppy {
        silent: PosLength,
        /// Described.
        told: PosLength,
        inner: Inner,
    }
    /// A table in the table.
    #[derive(JsonSchema)]
    #[expect(dead_code, reason = "only its schema is looked at")]
    struct Inner {
        mute: f64,
    }
    let mut g = schemars::SchemaGenerator::default();
    let schema = <Sloppy as JsonSchema>::json_schema(&mut g).to_value();
    let wrong = undescribed(&schema, &g.take_definitions(true));
    let found: Vec<_> = wrong.iter().filter_map(|w| w.split('`').nth(1)).collect();
    assert_eq!(found, ["silent", "inner", "Inner.mute"], "{wrong:?}");
}

#[test]
fn references_are_looked_up() {
    let good = "@book{somebody2000,\n  author = {A},\n  title = {B},\n  year = 2000\n}\n";
    let b = Bibliography::read(good);
    assert_none(b.complaints());
    assert_none(b.missing(&right()));
    let other =
        Bibliography::read("@book{else1999,\n  author = {A}},\n  year = 2000\n}\n@book{else1999,\n}\n");
    assert_eq!(other.missing(&right()), ["`somebody2000` is not in the bibliography"]);
    let found = other.complaints().join("; ");
    for complaint in ["stands twice", "has no title"] {
        assert!(found.contains(complaint), "{found}");
    }
    assert!(
        Bibliography::read("@a{k,\n author={}}\n title={}\n year=1\n}\n")
            .complaints()
            .join("")
            .contains("braces")
    );
}
