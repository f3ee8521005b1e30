//! How mistakes are drawn: below the right columns, cut and broken to the width of the terminal, in colours only when asked.

use std::sync::Arc;

use gudgeon_case::{Diagnostic, Origin, Report, Source};
use gudgeon_core::file::Files;

/// The lines of one mistake in `line`, drawn in `width` columns.
fn drawn(line: &str, marked: &str, width: usize) -> Vec<String> {
    let text = format!("a = 1\n{line}\nb = 2\n");
    let start = text.find(marked).expect("stands in the line");
    let mistake = Diagnostic::new("wrong").at(Origin::File, Some(start..start + marked.len()));
    let source = Source { name: "c.toml".into(), text, files: Files::default() };
    let report = Report::new(vec![mistake], Arc::new(source), Arc::new([]));
    report.render_within(width, false).lines().map(str::to_owned).collect()
}

#[test]
fn the_underline_is_below_the_value() {
    // Tabs are drawn as four spaces; an umlaut takes one column, a combining accent none, a Chinese character two.
    for (line, marked, place, shown, below) in [
        ("\tbore\t= 5 bar", "5 bar", "2:9", "    bore    = 5 bar", "              ─────"),
        ("\"Öl\" = \"ä\" # é", "\"ä\"", "2:8", "\"Öl\" = \"ä\" # é", "       ───"),
        ("\"e\u{301}\" = 5 bar", "5 bar", "2:8", "\"e\u{301}\" = 5 bar", "      ─────"),
        ("\"孔径\" = \"寸\"", "\"寸\"", "2:8", "\"孔径\" = \"寸\"", "         ────"),
        (
            "a = \"\u{1b}[31m\u{202e}\"",
            "\"\u{1b}[31m\u{202e}\"",
            "2:5",
            "a = \"␛[31m\u{fffd}\"",
            "    ────────",
        ),
    ] {
        let place = format!("   ╭─[c.toml:{place}]");
        let wanted = ["  × wrong", &place, &format!(" 2 │ {shown}"), &format!("   · {below}"), "   ╰────"];
        assert_eq!(drawn(line, marked, 80), wanted);
    }
}

#[test]
fn a_long_line_is_cut_around_the_value() {
    let (before, after) = ("1, ".repeat(100), " # x".repeat(100));
    for width in [40, 41, 60, 110] {
        // A value between others, at the start, at the end, and one that is longer than the terminal.
        for (line, marked) in [
            (format!("{before}5 bar{after}"), "5 bar"),
            (format!("5 bar{after}"), "5 bar"),
            (format!("{before}5 bar"), "5 bar"),
            (format!("bore = {}", "µ".repeat(1000)), &"µ".repeat(1000)),
            (format!("bore = {}{after}", "寸".repeat(1000)), &"寸".repeat(1000)),
        ] {
            let lines = drawn(&line, marked, width);
            // Only the last line above has characters of two columns.
            let columns = |l: &str| l.chars().map(|c| if c == '寸' { 2 } else { 1 }).sum::<usize>();
            assert!(lines.iter().all(|l| columns(l) <= width), "{lines:#?}");
            let from = lines[3].find('─').expect("underlined");
            let underlined = lines[3].matches('─').count();
            let below = columns(&lines[3][..from]);
            let mut at = 0;
            let above: String = lines[2]
                .chars()
                .filter(|c| {
                    at += columns(&c.to_string());
                    at > below && at <= below + underlined
                })
                .collect();
            assert_eq!(columns(&above), underlined, "{lines:#?}");
            let wanted = above.strip_suffix('…').unwrap_or(&above);
            assert!(
                above == "5 bar" || wanted.chars().count() > 9 && marked.starts_with(wanted),
                "{lines:#?}"
            );
            assert!(lines[2].contains('…'));
        }
    }
}

#[test]
fn messages_and_advice_are_broken_to_the_width() {
    let words = "word ".repeat(40);
    let mistake = Diagnostic::new(format!("{words}\n    indented {words}")).help(words.clone());
    let report = |color| Report::unreadable("c.toml", mistake.clone()).render_within(50, color);
    let text = report(false);
    assert!(text.lines().all(|l| l.chars().count() <= 50), "{text}");
    assert_eq!(text.matches("word").count(), 120);
    let starts = |lead: &str| text.lines().filter(|l| l.starts_with(lead)).count();
    assert_eq!((starts("  × word"), starts("  help: word")), (1, 1), "{text}");
    assert!(starts("  │ word") >= 4 && starts("  │     ") >= 4 && starts("        word") >= 4, "{text}");
    // A width that no terminal has is as good as the least one, and a word that is longer stays whole.
    let path = "/a/very/long/path/that/nobody/could/copy/if/it/were/broken/case.toml";
    let long = Report::unreadable("c.toml", Diagnostic::new(format!("the file {path} is not there")));
    assert_eq!(long.render_within(0, false), format!("  × the file\n  │ {path}\n  │ is not there\n"));
    // Colours change nothing but colours, and are not there when nobody asked.
    assert!(!text.contains('\u{1b}'));
    let colored = report(true);
    let plain: String = colored.split('\u{1b}').map(after_code).collect();
    assert!(colored.contains('\u{1b}') && plain == text, "{plain}");
}

/// What follows the colour code that `part` may start with.
fn after_code(part: &str) -> &str {
    match part.strip_prefix('[').and_then(|p| p.split_once('m')) {
        Some((_, rest)) => rest,
        None => part,
    }
}
