//! The guide is fresh, its links lead somewhere, and its commands print what it says.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

use std::path::PathBuf;

use gudgeon_guide::commands::{self, Programs, differs, words};
use gudgeon_guide::reference::Facts;
use gudgeon_guide::{check, html, stage};

/// A folder below the target directory, so that pages that are run and staged can be looked at.
fn folder(name: &str) -> PathBuf {
    std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

/// One test after the other on two threads of its own: in parallel they would only wait for each other.
#[test]
fn the_guide_is_as_it_should_be() {
    let facts = Facts::collect().expect("registry, cases and benches");
    let mut wrong = check::stale(&facts.pages().expect("the contents")).expect("pages");
    wrong.extend(check::broken().expect("pages"));
    wrong.extend(check::stale_figures(&facts).expect("benches"));
    assert!(wrong.is_empty(), "`gudgeon-guide write` writes what is generated:\n{}", wrong.join("\n"));
}

#[test]
fn commands_print_what_the_guide_says() {
    let gudgeon = PathBuf::from(env!("CARGO_BIN_EXE_gudgeon-guide"));
    // Examples are built with the tests, beside the program.
    let programs = Programs { extended: gudgeon.with_file_name("examples/extended"), gudgeon };
    let ran = commands::run(&commands::pages().expect("pages"), &programs, &folder("guide-commands"));
    let ran = ran.expect("pages that can be run");
    assert!(ran.wrong.is_empty(), "\n{}", ran.wrong.join("\n\n"));
    assert!(ran.commands > 30 && ran.outputs > 20, "{ran:?}");
}

#[test]
fn the_book_holds_all_that_it_links_to() {
    let to = folder("guide-book");
    let copied = stage::stage(&to).expect("the sources");
    assert!(copied > 50, "documents and cases are linked: {copied}");
    for file in gudgeon_guide::files(&to, ".md").expect("pages") {
        let text = gudgeon_guide::read(&file).expect("a page");
        for link in gudgeon_guide::markdown::links(&text) {
            let path = link.target.split('#').next().unwrap_or_default();
            let there = path.is_empty() || path.contains("://") || file.with_file_name(path).exists();
            assert!(there, "{}:{}: {}", file.display(), link.line, link.target);
        }
    }
}

#[test]
fn outputs_are_compared_by_words_and_numbers() {
    assert_eq!(differs("a 1.00 m\n…\nend\n", "a 1.004 m\nb\nc\nend\n"), None);
    assert_eq!(differs("took …\n", "took 3 s\n"), None);
    assert!(differs("a 1.00 m\n", "a 1.04 m\n").is_some());
    assert!(differs("a\n", "a\nb\n").is_some());
    assert!(differs("a\nb\n", "a\n").is_some());
    assert!(differs("a\nc\n", "a\nb\nc\n").is_some());
}

#[test]
fn quotes_keep_words_together() {
    let all = words("gudgeon run a.toml --set x=\"2 mm\" 'b c'");
    assert_eq!(all, Some(["gudgeon", "run", "a.toml", "--set", "x=2 mm", "b c"].map(String::from).to_vec()));
    assert_eq!(words("\"a"), None);
}

#[test]
fn a_figure_may_move_by_the_width_of_its_line() {
    let curve = |y: f64| {
        let points: Vec<String> = (0..20).map(|n| format!("L{n}0.0 {:.1}", y + f64::from(n))).collect();
        format!("<path d=\"M0.0 {y:.1}{}\"/>", points.join(""))
    };
    assert!(check::same(&curve(50.0), &curve(51.0)));
    assert!(!check::same(&curve(50.0), &curve(60.0)));
    assert!(!check::same(&curve(50.0), ""));
}

#[test]
fn links_of_a_built_book_are_checked() {
    let book = folder("guide-html");
    let page = "<a href=\"b.html#there\">x</a> <a href=\"b.html#gone\">x</a> <img src=\"none.svg\"> <h2 id=\"here\">";
    gudgeon_guide::write(&book.join("a.html"), page).expect("a page");
    gudgeon_guide::write(&book.join("b.html"), "<h2 id=\"there\"><a href=\"a.html#here\">").expect("a page");
    let (count, broken) = html::broken(&book).expect("pages");
    assert_eq!((count, broken.len()), (4, 2), "{broken:?}");
}
