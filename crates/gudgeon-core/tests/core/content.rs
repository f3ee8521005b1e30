//! Values of files: what is read, where reading stops, and why.

use gudgeon_core::content::{Content, Error, read};
use gudgeon_core::kinds::{Oil, OilSpec};
use gudgeon_core::{BuildError, Word, register_model, spec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

/// Another oil, thinned.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Blend {
    base: Box<dyn OilSpec>,
    #[serde(default)]
    share: f64,
}

#[register_model(name = "blend", summary = "thinned", equations = "-", validity = "-", references = [], example = "")]
impl OilSpec for Blend {
    fn build(&self) -> Result<Box<dyn Oil>, BuildError> {
        self.base.build()
    }
}

/// Water.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Water {}

#[register_model(name = "water", summary = "thin", equations = "-", validity = "-", references = [], example = "")]
impl OilSpec for Water {
    fn build(&self) -> Result<Box<dyn Oil>, BuildError> {
        Err(BuildError::new("not needed here"))
    }
}

#[derive(Debug, Deserialize)]
struct Case {
    oils: Vec<Box<dyn OilSpec>>,
    word: Option<Word<dyn OilSpec>>,
}

fn case(oils: serde_json::Value) -> Result<Case, Error> {
    read(&Content::from(&json!({ "oils": oils })))
}

#[test]
fn models_in_models_are_read_and_written() {
    let oil = json!({ "share": 0.25, "model": "blend", "base": { "model": "water" } });
    let read = case(json!([oil])).expect("two oils, one in the other");
    assert!(read.word.is_none());
    let written = serde_json::to_value(&read.oils[0]).expect("can be written");
    assert_eq!(written, json!({ "model": "blend", "base": { "model": "water" }, "share": 0.25 }));
    // From any other source the same.
    let from_json: Box<dyn OilSpec> = serde_json::from_value(oil).expect("the same in JSON");
    assert_eq!(serde_json::to_value(&from_json).ok(), Some(written));
}

#[test]
fn an_error_has_the_path_to_it_through_models_in_models() {
    let blend = |base: serde_json::Value| json!({ "model": "blend", "base": base });
    for (oils, path, text) in [
        (
            json!([blend(json!({ "model": "water" })), 3]),
            "oils.1",
            "a table with the key `model` is wanted here, not the number 3",
        ),
        (
            json!([blend(json!({ "model": "watr" }))]),
            "oils.0.base.model",
            "unknown word `watr`; valid ones: `blend`, `water`",
        ),
        (
            json!([blend(json!({ "model": true }))]),
            "oils.0.base.model",
            "a text in quotes is wanted here, not `true`",
        ),
        (json!([blend(json!({}))]), "oils.0.base", "missing key `model`"),
        (
            json!([blend(blend(json!({ "model": "water", "salt": 1 })))]),
            "oils.0.base.base",
            "unknown key `salt`; none is valid",
        ),
        (
            json!([blend(blend(json!([])))]),
            "oils.0.base.base",
            "a table with the key `model` is wanted here, not an array",
        ),
        (
            json!([{ "model": "blend", "base": { "model": "water" }, "share": "some" }]),
            "oils.0.share",
            "a number is wanted here, not the text `some`",
        ),
        (json!([{ "model": "blend" }]), "oils.0", "missing key `base`"),
        (json!({}), "oils", "an array is wanted here, not a table"),
    ] {
        let e = case(oils).expect_err(path);
        assert_eq!((e.path(), e.to_string().as_str()), (path, text));
    }
}

#[test]
fn a_model_is_chosen_by_a_word_or_a_table() {
    for word in [json!("water"), json!({ "model": "water" })] {
        let case: Case = read(&Content::from(&json!({ "oils": [], "word": word }))).expect("both are water");
        assert_eq!(case.word.expect("given").typetag_name(), "water");
    }
    let e = read::<Case>(&Content::from(&json!({ "oils": [], "word": "blend" })))
        .expect_err("blend has a key without default");
    assert_eq!((e.path(), e.to_string().as_str()), ("word", "missing key `base`"));
}

/// An error that passed through somebody else's type is not taken for the next one.
#[test]
fn an_error_that_left_does_not_come_back() {
    let theirs: Result<Box<dyn OilSpec>, _> = serde_json::from_value(json!({ "model": "oil" }));
    assert!(theirs.expect_err("no such oil").to_string().contains("unknown word `oil`"));
    let ours: Error = serde::de::Error::custom("another one");
    assert_eq!((ours.path(), ours.to_string().as_str()), ("", "another one"));
}

#[test]
fn numbers_keep_their_kind_and_limits() {
    assert_eq!(read::<u64>(&Content::Integer(7)).ok(), Some(7));
    assert_eq!(read::<f64>(&Content::Integer(7)).ok(), Some(7.0));
    assert_eq!(read::<f64>(&Content::Number(0.1)).ok(), Some(0.1));
    assert_eq!(read::<Option<f64>>(&Content::Nothing).ok(), Some(None));
    assert_eq!(read::<(f64, f64)>(&Content::from(&json!([1, 2]))).ok(), Some((1.0, 2.0)));
    for (content, text) in [
        (Content::Number(1.5), "a whole number from 0 to 255 is wanted here, not the number 1.5"),
        (Content::Integer(-1), "a whole number from 0 to 255 is wanted here, not the number -1"),
        (Content::Integer(256), "a whole number from 0 to 255 is wanted here, not the number 256"),
        (Content::Nothing, "a whole number from 0 to 255 is wanted here, not nothing"),
    ] {
        assert_eq!(read::<u8>(&content).expect_err(text).to_string(), text);
    }
    let three = Content::from(&json!([1, 2, 3]));
    assert!(
        read::<(f64, f64)>(&three).expect_err("one too many").to_string().starts_with("3 values stand here")
    );
    // Whole numbers beyond 64 bits with sign are numbers.
    assert_eq!(Content::from(&json!(u64::MAX)), Content::Number(u64::MAX as f64));
    assert_eq!(
        serde_json::from_str::<Content>("18446744073709551615").ok(),
        Some(Content::Number(u64::MAX as f64))
    );
    assert!(spec::plain_model::<dyn OilSpec>("water").is_ok());
}
