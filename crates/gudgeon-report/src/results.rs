//! All results of a run as tables: those that stand alone, families with a column a member, values at crank angles.

use std::fmt::Write;

use indexmap::IndexMap;

use crate::number::{capital, certain, unit};
use crate::page::{self, esc};
use crate::summary::{ResultValue, Summary};

/// Members of a family that stand beside each other in one table; what is wider continues below.
const BESIDE: usize = 6;

/// What the name of a result says: the members that it belongs to, `("ring", "1")`, and the rest of it.
fn place(name: &str) -> (Vec<(&str, String)>, String) {
    let parts: Vec<&str> = name.split('.').collect();
    let (mut members, mut rest): (Vec<(&str, String)>, Vec<&str>) = (Vec::new(), Vec::new());
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    let mut k = 0;
    while k < parts.len() {
        let part = parts[k];
        let word = part.trim_end_matches(|c: char| c.is_ascii_digit());
        let number = &part[word.len()..];
        if digits(part) && rest.last().is_some_and(|r| !r.is_empty()) {
            // `mode.3.frequency`
            members.push((rest.pop().unwrap_or_default(), part.to_owned()));
        } else if !word.is_empty() && digits(number) && (k > 0 || parts.len() > 1) {
            // `order0.5` of a four-stroke engine
            let decimals = parts.get(k + 1).filter(|next| digits(next) && k + 2 == parts.len());
            members.push((word, decimals.map_or_else(|| number.to_owned(), |d| format!("{number}.{d}"))));
            k += usize::from(decimals.is_some());
        } else {
            rest.push(part);
        }
        k += 1;
    }
    (members, rest.join("."))
}

/// `ring1` as `ring 1`.
pub(crate) fn subject(name: &str) -> String {
    let word = name.trim_end_matches(|c: char| c.is_ascii_digit());
    match &name[word.len()..] {
        number if !number.is_empty() && !word.is_empty() => format!("{word} {number}"),
        _ => name.replace('_', " "),
    }
}

/// Numbers of members in their order.
fn in_order(numbers: impl Iterator<Item = String>) -> Vec<String> {
    let mut all: Vec<(f64, String)> = numbers.map(|n| (n.parse().unwrap_or(f64::INFINITY), n)).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all.dedup();
    all.into_iter().map(|(_, n)| n).collect()
}

/// Parts of a cylinder: what the names of their results begin with, and their titles.
const PARTS: [(&str, &str); 2] = [("rings.", "Rings"), ("skirt.", "Skirt")];

/// Results that make a list too long for one column.
const LONG: usize = 12;

/// Full name and value of a result.
type Named<'a> = (&'a str, &'a ResultValue);
/// Results of one family (`ring`, `land`): by the rest of their name, then by number.
type Family<'a> = IndexMap<String, IndexMap<String, Named<'a>>>;
/// Results of two families, `mode` and `order`: by the number of the one, then of the other.
type Matrix<'a> = IndexMap<(String, String), Named<'a>>;

/// All results, folded.
pub(crate) fn section(out: &mut String, s: &Summary) {
    if s.results.is_empty() {
        return;
    }
    let _ = write!(
        out,
        "<section id=\"results\"><details><summary><h2>All {} results</h2></summary>",
        s.results.len()
    );
    // A cylinder has the results of its parts behind those of the whole.
    let part = |name: &str| PARTS.iter().find(|(p, _)| name.strip_prefix(p).is_some()).copied();
    for (prefix, title) in std::iter::once(("", "")).chain(PARTS) {
        let own: Vec<(&str, &str, &ResultValue)> = s
            .results
            .iter()
            .filter(|(name, _)| part(name).map_or("", |(p, _)| p) == prefix)
            .map(|(name, v)| (name.as_str(), &name[prefix.len()..], v))
            .collect();
        if own.is_empty() {
            continue;
        }
        if !title.is_empty() {
            let _ = write!(out, "<h3>{title}</h3>");
        }
        part_results(out, s, &own);
    }
    out.push_str("</details></section>\n");
}

/// Results of one part: full name, name within the part, value.
fn part_results(out: &mut String, s: &Summary, own: &[(&str, &str, &ResultValue)]) {
    let mut plain: Vec<Named<'_>> = Vec::new();
    let mut families: IndexMap<&str, Family<'_>> = IndexMap::new();
    let mut matrices: IndexMap<(String, &str, &str), Matrix<'_>> = IndexMap::new();
    let mut angles: IndexMap<&str, IndexMap<&str, Named<'_>>> = IndexMap::new();
    for &(name, short, v) in own {
        if let Some((what, angle)) = short.split_once('@') {
            angles.entry(angle).or_default().insert(what, (name, v));
            continue;
        }
        let (members, rest) = place(short);
        match &members[..] {
            [] => plain.push((name, v)),
            [(family, n)] => {
                families.entry(family).or_default().entry(rest).or_default().insert(n.clone(), (name, v));
            }
            [(rows, m), (columns, n), ..] => {
                matrices.entry((rest, rows, columns)).or_default().insert((m.clone(), n.clone()), (name, v));
            }
        }
    }
    out.push_str("<div class=\"results\">");
    // A long list stands in two columns, when nothing else stands beside it.
    let column =
        if families.is_empty() && plain.len() > LONG { plain.len().div_ceil(2) } else { plain.len() };
    plain_tables(out, s, &plain, column);
    if !families.is_empty() {
        out.push_str("<div class=\"families\">");
    }
    for (family, rows) in &families {
        family_table(out, s, family, rows);
    }
    out.push_str(if families.is_empty() { "</div>" } else { "</div></div>" });
    for ((_, rows, columns), values) in &matrices {
        matrix_table(out, s, (rows, columns), values);
    }
    at_angles(out, s, &angles);
}

/// Results that two numbers tell apart: a row a member of the one family, a column a member of the other.
fn matrix_table(out: &mut String, s: &Summary, (rows, columns): (&str, &str), values: &Matrix<'_>) {
    let told: Vec<String> = values
        .iter()
        .filter_map(|((m, n), (name, _))| {
            Some(nameless(&nameless(s.descriptions.get(*name)?, rows, m), columns, n))
        })
        .collect();
    let unit_of = values.values().next().map_or("", |(_, v)| v.unit.as_str());
    let _ = write!(
        out,
        "<h3>{} <span class=\"unit\">{}</span></h3>",
        esc(&capital(&shared(&told, rows))),
        esc(&unit(unit_of))
    );
    let across = in_order(values.keys().map(|k| k.1.clone()));
    for part in across.chunks(2 * BESIDE) {
        out.push_str("<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"table\"><table class=\"plain\"><thead><tr><td></td>");
        for n in part {
            let _ = write!(out, "<th class=\"num\">{} {n}</th>", esc(columns));
        }
        out.push_str("</tr></thead><tbody>");
        for m in in_order(values.keys().map(|k| k.0.clone())) {
            let _ = write!(out, "<tr><th scope=\"row\">{} {m}</th>", esc(rows));
            for n in part {
                let v = values.get(&(m.clone(), n.clone()));
                let text = v.map_or_else(|| "–".into(), |(_, v)| certain(v.value, v.uncertainty, 4));
                let _ = write!(out, "<td class=\"num\">{text}</td>");
            }
            out.push_str("</tr>");
        }
        out.push_str("</tbody></table></div>");
    }
}

/// Results that stand alone, `column` to a table.
fn plain_tables(out: &mut String, s: &Summary, plain: &[(&str, &ResultValue)], column: usize) {
    for part in plain.chunks(column.max(1)) {
        out.push_str("<table class=\"plain key\"><tbody>");
        for (name, v) in part {
            let what = s.descriptions.get(*name).map_or("", String::as_str);
            let _ = write!(
                out,
                "<tr><th scope=\"row\">{}<code>{}</code></th>{}</tr>",
                if what.is_empty() { String::new() } else { format!("{} ", page::prose(&capital(what))) },
                esc(name),
                page::value_cells(Some(v))
            );
        }
        out.push_str("</tbody></table>");
    }
}

/// Results that every member of a family has: a column a member.
fn family_table(out: &mut String, s: &Summary, family: &str, rows: &Family<'_>) {
    let numbers = in_order(rows.values().flat_map(|r| r.keys().cloned()));
    for beside in numbers.chunks(BESIDE) {
        let _ = write!(
            out,
            "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"table\"><table class=\"plain\"><thead><tr><th>Per {}</th><td></td>",
            esc(family)
        );
        for n in beside {
            let _ = write!(out, "<th class=\"num\">{} {n}</th>", esc(family));
        }
        out.push_str("</tr></thead><tbody>");
        for (rest, row) in rows {
            family_row(out, s, (family, rest), row, beside);
        }
        out.push_str("</tbody></table></div>");
    }
}

/// One result of the members `beside` each other.
fn family_row(
    out: &mut String,
    s: &Summary,
    (family, rest): (&str, &str),
    row: &IndexMap<String, Named<'_>>,
    beside: &[String],
) {
    let told: Vec<String> = row
        .iter()
        .filter_map(|(n, (name, _))| Some(without_member(s.descriptions.get(*name)?, family, n)))
        .collect();
    let what = shared(&told, family);
    let _ = write!(
        out,
        "<tr><th scope=\"row\">{}<code>{}</code></th>",
        if what.is_empty() { String::new() } else { format!("{} ", page::prose(&capital(&what))) },
        esc(rest)
    );
    // Before the numbers, where it stays in sight when there are many.
    let u = row.values().next().map_or("", |(_, v)| v.unit.as_str());
    let _ = write!(out, "<td class=\"unit\">{}</td>", esc(&unit(u)));
    for n in beside {
        let text = row.get(n).map_or_else(|| "–".into(), |(_, v)| certain(v.value, v.uncertainty, 4));
        let _ = write!(out, "<td class=\"num\">{text}</td>");
    }
    out.push_str("</tr>");
}

/// Results at crank angles: one row each.
fn at_angles(out: &mut String, s: &Summary, angles: &IndexMap<&str, IndexMap<&str, (&str, &ResultValue)>>) {
    let Some(first) = angles.values().next() else { return };
    out.push_str("<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"table\"><table class=\"plain angles\"><thead><tr><th class=\"num\">At crank angle</th>");
    for (what, (name, v)) in first {
        let title = s.descriptions.get(*name).map_or("", String::as_str);
        let _ = write!(
            out,
            "<th class=\"num\" title=\"{}\"><code>{}</code> <span class=\"unit\">{}</span></th>",
            esc(title),
            esc(what),
            esc(&unit(&v.unit))
        );
    }
    out.push_str("</tr></thead><tbody>");
    for (angle, row) in angles {
        let _ = write!(out, "<tr><th class=\"num\" scope=\"row\">{}°</th>", esc(angle));
        for what in first.keys() {
            let text = row.get(what).map_or_else(|| "–".into(), |(_, v)| certain(v.value, v.uncertainty, 4));
            let _ = write!(out, "<td class=\"num\">{text}</td>");
        }
        out.push_str("</tr>");
    }
    out.push_str("</tbody></table></div>");
}

/// One description for all members: what differs between theirs is the name of each.
fn shared(told: &[String], family: &str) -> String {
    let Some((first, rest)) = told.split_first() else { return String::new() };
    if rest.iter().all(|other| other == first) {
        return first.clone();
    }
    let words: Vec<&str> = first.split(' ').collect();
    let (mut lead, mut end) = (words.len(), words.len());
    for other in rest.iter().filter(|other| *other != first) {
        let same = |(a, b): &(&&str, &str)| **a == *b;
        lead = words[..lead].iter().zip(other.split(' ')).take_while(same).count();
        end = words[words.len() - end..].iter().rev().zip(other.rsplit(' ')).take_while(same).count();
    }
    if lead == words.len() {
        return first.clone();
    }
    let end = end.min(words.len() - lead);
    let name = format!("the {family}");
    let parts = [&words[..lead], &[name.as_str()], &words[words.len() - end..]];
    parts.concat().join(" ")
}

/// A row of a table per ring must not speak of ring 1.
fn without_member(text: &str, family: &str, n: &str) -> String {
    let name = [family, " ", n].concat();
    const LEADS: [&str; 8] = [", in ", " of ", " on ", " at ", " in ", " past ", " behind ", ", "];
    if let Some(front) = text.strip_suffix(&name)
        && let Some(rest) = LEADS.into_iter().find_map(|lead| front.strip_suffix(lead))
    {
        return rest.to_owned();
    }
    nameless(text, family, n)
}

/// A text that speaks of any member of a family instead of one.
fn nameless(text: &str, family: &str, n: &str) -> String {
    let name = [family, " ", n].concat();
    // Most texts do not name it, which a search tells that looks for nothing else.
    if text.contains(&name) { text.replace(&name, &["the ", family].concat()) } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::{place, shared};

    #[test]
    fn names_tell_their_members() {
        let of = |name| {
            let (members, rest) = place(name);
            (members.iter().map(|(f, n)| format!("{f} {n}")).collect::<Vec<_>>().join(", "), rest)
        };
        let is =
            |name, members: &str, rest: &str| assert_eq!(of(name), (members.to_owned(), rest.to_owned()));
        is("blow_by", "", "blow_by");
        is("ring2.h_min", "ring 2", "h_min");
        is("mode.3.frequency", "mode 3", "frequency");
        is("envelope.shaft12.speed", "shaft 12", "envelope.speed");
        is("critical_speed.mode2.order11", "mode 2, order 11", "critical_speed");
        is("shaft1.order0.5", "shaft 1, order 0.5", "");
        is("fatigue2", "", "fatigue2");
    }

    #[test]
    fn descriptions_of_members_are_shared() {
        let told = |t: &[&str]| shared(&t.iter().map(|s| (*s).to_owned()).collect::<Vec<_>>(), "shaft");
        assert_eq!(
            told(&["mean torque of motor shaft", "mean torque of crank 1-2"]),
            "mean torque of the shaft"
        );
        let at_rest = ["torque of order 2 in crank 1-2 at rest", "torque of order 2 in coupling at rest"];
        assert_eq!(told(&at_rest), "torque of order 2 in the shaft at rest");
        assert_eq!(told(&["mean torque", "mean torque"]), "mean torque");
        assert_eq!(told(&["mean torque"]), "mean torque");
        assert_eq!(told(&[]), "");
    }
}
