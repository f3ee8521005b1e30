//! What deserialisation says, in the words of this program: names of Rust types are nobody's business.

use super::near::advice;

/// The words of a message of serde: `invalid value: integer `5000000000`, expected u32` as `the number 5000000000 is not a whole number
/// from 0 to 4294967295`.
pub fn plain(message: &str) -> String {
    let quoted = |text: &str| text.split('`').nth(1).map(str::to_owned);
    if let Some(rest) = message.strip_prefix("invalid type: ").or(message.strip_prefix("invalid value: "))
        && let Some((found, wanted)) = rest.rsplit_once(", expected ")
    {
        return format!("{} is wanted here, not {}", expected(wanted), unexpected(found));
    }
    for (start, what) in [("missing field ", "missing key"), ("duplicate field ", "second key")] {
        if let Some(key) = message.strip_prefix(start).and_then(quoted) {
            return format!("{what} `{key}`");
        }
    }
    for (start, what) in [("unknown field ", "unknown key"), ("unknown variant ", "unknown word")] {
        if let Some(rest) = message.strip_prefix(start) {
            let mut words = rest.split('`').skip(1).step_by(2);
            let name = words.next().unwrap_or_default();
            let valid: Vec<&str> = words.collect();
            let name = if valid.is_empty() {
                format!("`{name}`")
            } else {
                format!("`{name}`; {}", advice(name, &valid))
            };
            return format!("{what} {name}");
        }
    }
    message.to_owned()
}

/// What serde found.
fn unexpected(text: &str) -> String {
    let value = text.split('`').nth(1).or_else(|| text.split('"').nth(1));
    let kind = text.split([' ', '`', '"']).next().unwrap_or_default();
    match (kind, value) {
        ("integer" | "floating", Some(v)) => format!("the number {v}"),
        ("string", Some(v)) => format!("the text `{v}`"),
        ("boolean", Some(v)) => format!("`{v}`"),
        ("null" | "unit" | "Option", _) => "nothing".into(),
        ("map" | "struct" | "newtype" | "enum", _) => "a table".into(),
        ("sequence" | "tuple", _) => "an array".into(),
        _ => text.to_owned(),
    }
}

/// What serde wanted.
fn expected(text: &str) -> String {
    let unsigned = |bits: u32| format!("a whole number from 0 to {}", u64::MAX >> (64 - bits));
    let signed = |bits: u32| {
        let most = i64::MAX >> (64 - bits);
        format!("a whole number from {} to {most}", -most - 1)
    };
    match text.split(' ').next().unwrap_or_default() {
        "u8" => unsigned(8),
        "u16" => unsigned(16),
        "u32" => unsigned(32),
        "u64" | "usize" => unsigned(64),
        "i8" => signed(8),
        "i16" => signed(16),
        "i32" => signed(32),
        "i64" | "isize" => signed(64),
        "f32" | "f64" => "a number".into(),
        "struct" | "internally" | "adjacently" | "map" | "enum" => "a table".into(),
        "tuple" | "sequence" => "an array".into(),
        "unit" => "nothing".into(),
        "variant" => "one of the words".into(),
        _ if text == "a boolean" => "`true` or `false`".into(),
        _ if text == "a string" || text == "a borrowed string" => "a text in quotes".into(),
        _ if text == "a sequence" => "an array".into(),
        _ if text == "a map" => "a table".into(),
        _ => text.to_owned(),
    }
}
