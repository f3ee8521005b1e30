//! Values as TOML on one line.

use serde_json::Value;

/// A value as TOML; nulls in tables are left out.
#[must_use]
pub fn inline(value: &Value) -> String {
    match value {
        Value::Null => "\"\"".to_owned(),
        Value::Bool(b) => b.to_string(),
        Value::Number(n) => match n.as_i64() {
            Some(i) => i.to_string(),
            None => float(n.as_f64().unwrap_or(f64::NAN)),
        },
        Value::String(s) => toml::Value::String(s.clone()).to_string(),
        Value::Array(a) => format!("[{}]", a.iter().map(inline).collect::<Vec<_>>().join(", ")),
        Value::Object(o) => {
            let plain = |k: &str| {
                !k.is_empty() && k.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-')
            };
            let key =
                |k: &str| if plain(k) { k.to_owned() } else { toml::Value::String(k.to_owned()).to_string() };
            let all =
                o.iter().filter(|(_, v)| !v.is_null()).map(|(k, v)| format!("{} = {}", key(k), inline(v)));
            format!("{{ {} }}", all.collect::<Vec<_>>().join(", "))
        }
    }
}

/// A number that TOML reads back to the same bits.
#[must_use]
pub fn float(v: f64) -> String {
    if v.is_nan() { "nan".to_owned() } else { format!("{v:?}") }
}

/// A number with four digits, which is all that anybody would type.
#[must_use]
pub fn rounded(v: f64) -> f64 {
    format!("{v:.3e}").parse().unwrap_or(v)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_reads_back() {
        let v = serde_json::json!({
            "a b": [1, 2.5, 1e-7, 1e300, true, "x \"y\" 'z'"], "empty": {}, "list": [{ "k": "1 mm" }], "none": null,
        });
        let back: toml::Table = format!("v = {}", inline(&v)).parse().expect("TOML");
        let mut wanted = v;
        wanted.as_object_mut().expect("a table").remove("none");
        assert_eq!(serde_json::to_value(&back["v"]).expect("values"), wanted);
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!(float(rounded(0.123_456)), "0.1235");
        assert_eq!(float(rounded(1.0)), "1.0");
        assert_eq!(float(-1e-9), "-1e-9");
    }
}
