//! The values of the case: what was run, in the units of the case.

use std::collections::BTreeMap;
use std::fmt::Write;

use gudgeon_core::result::InputUse;
use indexmap::IndexMap;

use crate::page::{esc, prose};

/// Members of a list that stand beside each other in one table; what is wider continues below.
const BESIDE: usize = 6;

/// Inputs of the members of one list (`rings`): by the rest of their path, then by number.
type Members<'a> = IndexMap<&'a str, BTreeMap<usize, Row<'a>>>;

/// One value, or the values of a list of numbers, with what they are.
#[derive(Default)]
struct Row<'a> {
    values: Vec<&'a str>,
    about: &'a str,
}

/// Everything that the case says and what it leaves to defaults, folded.
pub(crate) fn section(out: &mut String, inputs: &[InputUse]) {
    if inputs.is_empty() {
        return;
    }
    let (given, defaults): (Vec<&InputUse>, Vec<&InputUse>) = inputs.iter().partition(|i| i.given);
    let _ = write!(
        out,
        "<section id=\"inputs\"><details><summary><h2>Inputs: {} given, {} by default</h2></summary>",
        given.len(),
        defaults.len()
    );
    tables(out, &given);
    if !defaults.is_empty() {
        let _ = write!(out, "<details class=\"more\"><summary>Values by default</summary>");
        tables(out, &defaults);
        out.push_str("</details>");
    }
    out.push_str("</details></section>\n");
}

/// A path before, at and after its first number: `rings.0.cold_gap` as `rings`, 0, `cold_gap`.
fn parts(path: &str) -> (&str, Option<(usize, &str)>) {
    let mut from = 0;
    for part in path.split('.') {
        let end = from + part.len();
        if let Ok(n) = part.parse() {
            return (&path[..from.saturating_sub(1)], Some((n, path.get(end + 1..).unwrap_or_default())));
        }
        from = end + 1;
    }
    (path, None)
}

/// A path without the number at its end, that of a value in a list.
fn list(rest: &str) -> &str {
    rest.trim_end_matches(|c: char| c.is_ascii_digit() || c == '.')
}

fn tables(out: &mut String, inputs: &[&InputUse]) {
    let mut plain: IndexMap<&str, Row<'_>> = IndexMap::new();
    let mut families: IndexMap<&str, Members<'_>> = IndexMap::new();
    for i in inputs {
        let row = match parts(&i.path) {
            (head, Some((n, rest))) if !rest.is_empty() => {
                let of = families.entry(head).or_default().entry(list(rest)).or_default();
                of.entry(n).or_default()
            }
            (head, _) => plain.entry(head).or_default(),
        };
        row.values.push(&i.value);
        row.about = &i.about;
    }
    plain_table(out, &plain);
    for (family, rows) in &families {
        family_table(out, family, rows);
    }
}

fn plain_table(out: &mut String, rows: &IndexMap<&str, Row<'_>>) {
    if rows.is_empty() {
        return;
    }
    out.push_str("<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"table\"><table class=\"plain\"><tbody>");
    for (path, row) in rows {
        let _ = write!(
            out,
            "<tr><th scope=\"row\"><code>{}</code></th><td>{}</td><td class=\"what\">{}</td></tr>",
            esc(path),
            joined(row),
            prose(row.about)
        );
    }
    out.push_str("</tbody></table></div>");
}

fn family_table(out: &mut String, family: &str, rows: &Members<'_>) {
    let mut numbers: Vec<usize> = rows.values().flat_map(|r| r.keys().copied()).collect();
    numbers.sort_unstable();
    numbers.dedup();
    for beside in numbers.chunks(BESIDE) {
        let _ = write!(
            out,
            "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"table\"><table class=\"plain\"><thead><tr><th><code>{}</code></th>",
            esc(family)
        );
        for n in beside {
            let _ = write!(out, "<th>{}</th>", n + 1);
        }
        out.push_str("<td></td></tr></thead><tbody>");
        for (rest, row) in rows {
            let _ = write!(out, "<tr><th scope=\"row\"><code>{}</code></th>", esc(rest));
            for n in beside {
                let _ = write!(out, "<td>{}</td>", row.get(n).map_or_else(|| "–".into(), joined));
            }
            let about = row.values().next().map_or("", |r| r.about);
            let _ = write!(out, "<td class=\"what\">{}</td></tr>", prose(about));
        }
        out.push_str("</tbody></table></div>");
    }
}

fn joined(row: &Row<'_>) -> String {
    match row.values[..] {
        [only] => prose(only),
        _ => prose(&row.values.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn input(path: &str, value: &str, given: bool) -> InputUse {
        InputUse { path: path.into(), value: value.into(), about: "what <it> is".into(), given }
    }

    #[test]
    fn lists_stand_in_columns_and_defaults_apart() {
        let inputs = [
            input("engine.bore", "86 mm", true),
            input("rings.0.cold_gap", "0.3 mm", true),
            input("rings.1.cold_gap", "0.4 mm", true),
            input("rings.1.face.drop.0", "5 um", true),
            input("rings.1.face.drop.1", "6 um", true),
            input("phases.0", "0 deg", true),
            input("phases.1", "180 deg", true),
            input("solver.tolerance", "0.001", false),
        ];
        let mut out = String::new();
        section(&mut out, &inputs);
        assert!(out.contains("Inputs: 7 given, 1 by default"), "{out}");
        assert!(out.contains("<td>0.3 mm</td><td>0.4 mm</td>"), "{out}");
        assert!(out.contains("<td>–</td><td>5 µm, 6 µm</td>"), "{out}");
        assert!(out.contains("<td>0°, 180°</td>"), "{out}");
        assert!(out.contains("Values by default</summary><div"), "{out}");
        assert!(out.contains("what &lt;it&gt; is"), "{out}");
    }
}
