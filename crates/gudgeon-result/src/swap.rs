//! Values of swaps for people.

/// A value of a swap, short: a table `{ model = "closed_form_face", cavitation = "half_sommerfeld" }` becomes
/// `closed_form_face cavitation=half_sommerfeld`, anything else stays as it is.
#[must_use]
pub fn short_value(text: &str) -> String {
    let inner = text.trim().strip_prefix('{').and_then(|t| t.strip_suffix('}'));
    let Some(inner) = inner.filter(|t| !t.contains(['{', '[', '\''])) else { return text.to_owned() };
    let words: Option<Vec<String>> = inner
        .split(',')
        .map(|pair| {
            let (key, value) = pair.split_once('=')?;
            let (key, value) = (key.trim(), value.trim().trim_matches('"'));
            Some(if key == "model" { value.to_owned() } else { format!("{key}={value}") })
        })
        .collect();
    words.map_or_else(|| text.to_owned(), |w| w.join(" "))
}
