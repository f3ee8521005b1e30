//! What is wrong with a value, in plain words.

use gudgeon_case::reason;
use gudgeon_core::content::{Content, read};

fn said<T: serde::de::DeserializeOwned + std::fmt::Debug>(json: &str) -> String {
    let value: Content = serde_json::from_str(json).expect("JSON");
    reason(&read::<T>(&value).expect_err("must be refused"))
}

#[derive(Debug, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    #[serde(rename = "near")]
    _near: u8,
}
#[derive(Debug, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
enum Word {
    FirstOne,
}

#[test]
fn types_of_the_program_are_not_named() {
    for (message, wanted) in [
        (
            said::<u32>("5000000000"),
            "a whole number from 0 to 4294967295 is wanted here, not the number 5000000000",
        ),
        (said::<i8>("-200"), "a whole number from -128 to 127 is wanted here, not the number -200"),
        (
            said::<u64>("1.5"),
            "a whole number from 0 to 18446744073709551615 is wanted here, not the number 1.5",
        ),
        (said::<f64>("true"), "a number is wanted here, not `true`"),
        (said::<bool>("\"x\""), "`true` or `false` is wanted here, not the text `x`"),
        (said::<String>("null"), "a text in quotes is wanted here, not nothing"),
        (said::<Vec<f64>>("{}"), "an array is wanted here, not a table"),
        (said::<Table>("3"), "a table is wanted here, not the number 3"),
        (said::<Table>("{}"), "missing key `near`"),
        (said::<Table>("{\"naer\": 1}"), "unknown key `naer`; did you mean `near`?"),
        (said::<Word>("\"second\""), "unknown word `second`; the only valid one is `first_one`"),
    ] {
        assert!(message.starts_with(wanted), "{message} | {wanted}");
    }
}
