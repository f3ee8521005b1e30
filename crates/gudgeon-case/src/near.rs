//! The name a person probably meant.

/// The candidate nearest to `word`, when one is near enough to be a typo of it: same letters in another case or with
/// other separators, one the beginning of the other, or few edits apart.
#[must_use]
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let plain = |s: &str| s.to_lowercase().replace(['-', ' ', '.'], "_");
    let w = plain(word);
    if w.is_empty() {
        return None;
    }
    let length = w.chars().count();
    candidates
        .into_iter()
        .filter_map(|c| {
            let p = plain(c);
            let edits = strsim::damerau_levenshtein(&w, &p);
            // A typo changes about one letter in four. A stem (`clear` for `clearance`) lacks more, and may be misspelt too.
            let typo = edits <= 1 + length / 4 && edits < length;
            let contained = length >= 3 && w.starts_with(&p) && p.chars().count() >= 3;
            let stem = length >= 3 && p.starts_with(&w)
                || length >= 4
                    && (length..=length + 1).any(|n| {
                        let head: String = p.chars().take(n).collect();
                        strsim::damerau_levenshtein(&w, &head) <= 1
                    });
            (typo || contained || stem).then_some(((!typo, edits), c))
        })
        .min_by_key(|(rank, _)| *rank)
        .map(|(_, c)| c)
}

/// `` `a`, `b` `` for a message.
#[must_use]
pub fn list<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    names.into_iter().map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ")
}

/// Advice after an unknown name: the nearest one when there is one, then all of them.
#[must_use]
pub fn advice(word: &str, names: &[&str]) -> String {
    let all = match names {
        [] => "nothing is valid here".to_owned(),
        [one] => format!("the only valid one is `{one}`"),
        many if many.len() <= LISTED => format!("valid: {}", list(many.iter().copied())),
        many => {
            let few = akin(word, many);
            format!("valid, among {} in all: {}", many.len(), list(few.into_iter()))
        }
    };
    match nearest(word, names.iter().copied()) {
        Some(near) if names.len() > 1 => format!("did you mean `{near}`? {all}"),
        Some(near) => format!("did you mean `{near}`?"),
        None => all,
    }
}

/// Names that are all listed, and as many as stand for more.
const LISTED: usize = 60;
const SHOWN: usize = 12;

/// Names that begin like a word, up to its first point; the first of all where none does.
fn akin<'a>(word: &str, names: &[&'a str]) -> Vec<&'a str> {
    let head = word.split_once('.').map_or(word, |w| w.0);
    let mut few: Vec<&str> =
        names.iter().filter(|n| n.split('.').next() == Some(head)).take(SHOWN).copied().collect();
    if few.is_empty() {
        few.extend(names.iter().take(SHOWN));
    }
    few
}
